"""All that a session remembers: the wearer, and the decoders of what is worn."""

from __future__ import annotations

from ..link.decoder import Decoder
from ..types import Site
from ..types.attrs import define, field
from .wearer import WearerParts

VERSION = 3
"""Of all that is remembered: one more for every release that remembers something else, or has other settings. A state
of another version is refused."""


@define
class SessionState:
    """All that a session remembers."""

    wearer: WearerParts
    now: float | None = field(default=None, init=False)
    """The latest moment that anything is known of, s."""
    decoders: dict[Site, Decoder] = field(factory=dict, init=False)
    finished: bool = field(default=False, init=False)
