"""State of a session: the wearer, and the decoders of the worn devices."""

from __future__ import annotations

from ..link.decoder import Decoder
from ..types import Site
from ..types.attrs import define, field
from .wearer import WearerParts

VERSION = 3
"""Version of the state, increased by 1 with every release that changes state or settings; no other can be restored."""


@define
class SessionState:
    """The whole state of a session."""

    wearer: WearerParts
    now: float | None = field(default=None, init=False)
    """Newest known time, s, packets' clock; None before the first."""
    decoders: dict[Site, Decoder] = field(factory=dict, init=False)
    finished: bool = field(default=False, init=False)
