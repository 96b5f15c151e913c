"""Identification of an attribute without discovery, from its values, as far as they prove it.

Only an insole's values do: its frames and its INFO have a magic and a CRC. Of other devices only the length is known,
which proves nothing; the caller must name their attributes."""

from __future__ import annotations

from contextlib import suppress

from attrs import define, field

from ...link.devices.reassembly import Reassembly
from ...types import Foot
from ...wire.error import WireError
from ...wire.fragment import is_fragment, parse_fragment
from ...wire.insole import parse_frame
from ...wire.insole_info import parse_info
from .att import AttOperation

MAX_VALUES = 300
"""Number of values of one attribute that are examined; it covers the sixteen fragments of a frame many times."""
PROVING_FRAMES = 2
"""Number of frames with a correct CRC that prove an insole.

One in 2^16 arbitrary values that start with the magic has a correct CRC by chance."""


@define
class ValueEvidence:
    """The values of one attribute: their number, their lengths, and what the first ones decode as."""

    count: int = 0
    """Number of values that were notified."""
    lengths: set[int] = field(factory=set)
    """Lengths of the values examined, bytes."""
    frames: int = 0
    """Number of values or fragments that completed an insole frame."""
    foot: Foot | None = None
    """Foot of the insole, as its values report it."""
    is_info: bool = False
    """True if a value was an INFO record."""
    read: bytes | None = None
    """The value that was read last."""
    _pieces: Reassembly = field(factory=Reassembly)

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
        if self.count > MAX_VALUES:
            return
        self.lengths.add(len(data))
        with suppress(WireError):
            whole: bytes | None = data
            if is_fragment(data):
                whole, _ = self._pieces.feed(parse_fragment(data))
            if whole is not None:
                self.foot = parse_frame(whole).foot
                self.frames += 1

    @property
    def channel(self) -> str | None:
        """Channel that the values prove the attribute to be; None without proof."""
        if self.is_info:
            return "insole/info"
        return "insole/frame" if self.frames >= PROVING_FRAMES else None
