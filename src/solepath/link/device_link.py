"""The interface between the decoder and the link of one device."""

from __future__ import annotations

from typing import Any, Protocol

from ..events import LinkEvent
from ..types import Sample

Output = list[Sample | LinkEvent]
"""Samples and link events in the order in which they are returned."""


class DeviceLink(Protocol):
    """A plain record that turns the values of one device's channels into samples on one clock."""

    @property
    def name(self) -> str:
        """Name of the device, as in its channels."""

    @property
    def may_be_silent(self) -> bool:
        """True if the device may send nothing for a long time, which is then no StreamStale."""

    @property
    def unsettled_until(self) -> float | None:
        """Time up to which sample times are not comparable with another device's, s; None when all are comparable."""

    def flush(self, known_at: float) -> Output:
        """Return the samples that still wait for other data, as known at `known_at`, s."""

    def restart_clock(self) -> None:
        """Discard the clock fit, because the receiver's clock restarted."""

    def handle_reconnection(self) -> None:
        """Prepare for counters that may have restarted, because the device was connected again."""

    def set_firmware(self, firmware: str) -> None:
        """Set the firmware revision that the device reported, which most links ignore."""
        return

    def driver_signature(self) -> Any:
        """Return the signature of the driver that the link was made with; None for devices without a driver."""
        return None
