"""State of a session: the wearer, and the decoders of the worn devices."""

from __future__ import annotations

from ..link.decoder import Decoder
from ..types import Site
from ..types.attrs import define, field
from .wearer import WearerParts

VERSION = 3
"""Version of the state: one more for every release with other state or other settings.

A state of another version is rejected."""


@define
class SessionState:
    """The whole state of a session."""

    wearer: WearerParts
    now: float | None = field(default=None, init=False)
    """Newest time that is known, s."""
    decoders: dict[Site, Decoder] = field(factory=dict, init=False)
    finished: bool = field(default=False, init=False)
