"""How a recording is played."""

from __future__ import annotations

from typing import Any

from attrs import define

from ..messages import shown


@define
class Playback:
    """Where a player stands, in the recording's own time, s; the player writes it. `state`: "playing", "paused" or
    "ended". `speed`: times real time. `seeking`: where it is on its way to; None when it is not."""

    begin: float
    end: float
    t: float
    state: str = "paused"
    speed: float = 1.0
    seeking: float | None = None

    def frame(self) -> dict[str, Any]:
        """As "playback" of a frame."""
        return {
            "begin": shown(self.begin),
            "end": shown(self.end),
            "t": shown(self.t),
            "state": self.state,
            "speed": shown(self.speed),
            "seeking": shown(self.seeking),
        }
