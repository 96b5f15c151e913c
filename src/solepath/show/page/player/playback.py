"""How a recording is played."""

from __future__ import annotations

from typing import Any

from attrs import define

from ..messages import rounded


@define
class Playback:
    """Where a player stands, in the recording's own time, s; the player writes it. `state`: "playing", "paused" or
    "ended". `speed`: times real time. `seeking`: where it is on its way to; None when it is not."""

    start: float
    end: float
    t: float
    state: str = "paused"
    speed: float = 1.0
    seeking: float | None = None

    def frame(self) -> dict[str, Any]:
        """As "playback" of a frame."""
        return {
            "begin": rounded(self.start),
            "end": rounded(self.end),
            "t": rounded(self.t),
            "state": self.state,
            "speed": rounded(self.speed),
            "seeking": rounded(self.seeking),
        }
