"""Identification of an attribute by its values, when the log does not hold its discovery.

Only an insole's values prove what they are, because its frames and its INFO have a magic and a CRC. Attributes of other
devices must be named by the caller."""

from __future__ import annotations

from contextlib import suppress

from attrs import define, field

from ...types import Foot
from ...wire.error import WireError
from ...wire.fragment import Reassembly, is_fragment, parse_fragment
from ...wire.insole import parse_frame
from ...wire.insole_info import parse_info
from .att import AttOperation

MAX_EXAMINED_VALUES = 300
"""Largest number of values of one attribute that are examined; a frame has at most 16 fragments."""
MIN_PROVING_FRAMES = 2
"""Smallest number of frames with a correct CRC that proves an insole.

Of 2^16 arbitrary values that start with the magic, about one has a correct CRC by chance."""


@define
class ValueEvidence:
    """A summary of the values of one attribute, which may show that the attribute is an insole's."""

    count: int = 0
    """Number of values that were notified."""
    lengths: set[int] = field(factory=set)
    """Lengths of the values examined, bytes."""
    frame_count: int = 0
    """Number of values that are a correct insole frame, or whose fragment completes one."""
    foot: Foot | None = None
    """Foot that the insole reported; None without an insole."""
    is_info: bool = False
    """True if a value was an INFO record."""
    read: bytes | None = None
    """Newest value that was read, not notified."""
    _reassembly: Reassembly = field(factory=Reassembly)

    def add_value(self, operation: AttOperation, data: bytes) -> None:
        """Add a value and examine it."""
        if operation is AttOperation.WRITTEN:
            return
        if operation is AttOperation.READ:
            self.read = data
            with suppress(WireError):
                self.foot = parse_info(data).foot
                self.is_info = True
            return
        self.count += 1
        if self.count > MAX_EXAMINED_VALUES:
            return
        self.lengths.add(len(data))
        with suppress(WireError):
            frame_data: bytes | None = data
            if is_fragment(data):
                frame_data, _ = self._reassembly.feed(parse_fragment(data))
            if frame_data is not None:
                self.foot = parse_frame(frame_data).foot
                self.frame_count += 1

    @property
    def channel(self) -> str | None:
        """Name of the attribute's channel; None if the values do not prove it."""
        if self.is_info:
            return "insole/info"
        return "insole/frame" if self.frame_count >= MIN_PROVING_FRAMES else None
