"""What an attribute that nobody declared may be: told from its values, as far as they prove it.

Only an insole's do: its frames and its INFO carry a magic and a CRC. Of other devices the length is all that there is
to go by, which proves nothing; those must be named by whoever knows.
"""

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
"""Values of one attribute; the sixteen fragments of a frame are among them many times."""
PROVING_FRAMES = 2
"""Frames with a sound CRC: one in 2^16 arbitrary values that begin with the magic has it by chance."""


@define
class ValueEvidence:
    """The values of one attribute: how many, how long, and what the first ones decode as."""

    count: int = 0
    """Values that were notified."""
    lengths: set[int] = field(factory=set)
    frames: int = 0
    foot: Foot | None = None
    """Whose insole it is, by its own word."""
    is_info: bool = False
    read: bytes | None = None
    """The value that was read last."""
    _pieces: Reassembly = field(factory=Reassembly)

    def add_value(self, operation: AttOperation, data: bytes) -> None:
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
        """What the values prove the attribute to be."""
        if self.is_info:
            return "insole/info"
        return "insole/frame" if self.frames >= PROVING_FRAMES else None
