"""Holds the time and the speed at which a recording is played."""

from __future__ import annotations

from typing import Any

from attrs import define

from ..messages import members, plain


@define
class Playback:
    """The time and the speed of a player, which writes the fields; times are on the recording's clock, s.

    `state` is "playing", "paused" or "ended". `speed` is in multiples of real time. `seeking` is the target of a seek
    that has not ended; None when there is none."""

    start: float
    end: float
    t: float
    state: str = "paused"
    speed: float = 1.0
    seeking: float | None = None

    def frame(self) -> dict[str, Any]:
        """Return the member "playback" of a frame."""
        return {"begin": plain(self.start), **members(self, "end", "t", "state", "speed", "seeking")}
