"""The interface between the decoder and the link of one device."""

from __future__ import annotations

from typing import Any, Protocol

from ..events import LinkEvent
from ..types import Sample

Output = list[Sample | LinkEvent]
"""Samples and link events in the order in which they are returned."""


class DeviceLink(Protocol):
    """A link of one device at one site: values of its channels in, samples on one clock out. A plain record."""

    @property
    def name(self) -> str:
        """Name of the device, as in its channels."""

    @property
    def may_be_silent(self) -> bool:
        """True if the device may send nothing for long."""

    @property
    def unsettled_until(self) -> float | None:
        """Time up to which sample times are not comparable with another device's, s; None where all are."""

    def flush(self, known_at: float) -> Output:
        """Return the samples that still wait for data which will not come."""

    def restart_clock(self) -> None:
        """Discard the clock fit, because the receiver's clock was set back."""

    def handle_reconnection(self) -> None:
        """Prepare for counters that restarted, because the device was connected again."""

    def set_firmware(self, firmware: str) -> None:
        """Set the firmware revision that the device reported; most links do not use it."""
        return

    def driver_signature(self) -> Any:
        """Return the `Driver.signature` that a saved link must find again; None for devices without a driver."""
        return None
