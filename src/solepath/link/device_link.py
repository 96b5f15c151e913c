"""What a decoder asks of the link of one device, whichever it is."""

from __future__ import annotations

from typing import Any, Protocol

from ..events import LinkEvent
from ..types import Sample

Output = list[Sample | LinkEvent]


class DeviceLink(Protocol):
    """One device at one site: values of its channels in, samples on one clock out. A plain record."""

    @property
    def name(self) -> str:
        """Of the device, as in its channels."""

    @property
    def may_be_silent(self) -> bool:
        """Whether the device may send nothing for long."""

    @property
    def unsettled_until(self) -> float | None:
        """The times of samples up to this one, s, cannot be compared with another device's; None where all can."""

    def flush(self, known_at: float) -> Output:
        """What still waits for more, which will not come."""

    def restart_clock(self) -> None:
        """The receiver's clock was set back: what was fitted to it is of no use."""

    def handle_reconnection(self) -> None:
        """The device was connected anew."""

    def set_firmware(self, firmware: str) -> None:
        """The device said which firmware it has; most links have no use for that."""
        return

    def driver_signature(self) -> Any:
        """What a declared device's saved link must find again in its driver (`Driver.signature`); None of others."""
        return None
