"""The position of the wearer: in the track's own frame, and on the floor plan."""

from __future__ import annotations

from typing import Any

from attrs import define, field

from ....events import Candidate, Placed, WearerMoved
from ..messages import rounded, rounded_all
from .lists import ThinnedTrack, WalkedTrack

MAX_CANDIDATES = 40

PlacePoint = tuple[float | None, str, float | None, float | None, float | None]
"""(t, level, x, y, z) in s and m."""


@define
class WearerScene:
    """Tracks of the wearer.

    `track` has a point for each stride, `places` one for each place on a level that all its candidates share."""

    moved: WearerMoved | None = None
    track: WalkedTrack = field(factory=WalkedTrack)
    places: ThinnedTrack[PlacePoint] = field(factory=ThinnedTrack)
    level: str | None = None
    """The last level that all candidates shared."""
    _place_frame: tuple[Placed | None, dict[str, Any] | None] = (None, None)

    def stepped(self, event: WearerMoved) -> None:
        """Add the position of the wearer after a stride."""
        self.moved = event
        self.track.add_position(event.t, event.position)

    def found(self, event: Placed) -> str | None:
        """Add a place on the plan; return its level when that is new and all candidates share it."""
        if any([one.level != event.level for one in event.candidates]):
            return None
        x, y, z = rounded_all(event.position)
        self.places.add((rounded(event.t), event.level, x, y, z))
        if event.level == self.level:
            return None
        self.level = event.level
        return event.level

    def lose(self) -> None:
        """Forget the level: there is no place any more."""
        self.level = None

    def wearer_frame(self) -> dict[str, Any] | None:
        """Return the member "wearer" of a frame."""
        moved = self.moved
        if moved is None:
            return None
        return {
            "t": rounded(moved.t),
            "position": rounded_all(moved.position),
            "covariance": rounded_all(moved.covariance, 6),
        }

    def place_frame(self, place: Placed | None) -> dict[str, Any] | None:
        """Return the member "place" of a frame; None while it is not known."""
        if place is not self._place_frame[0]:
            self._place_frame = (place, None if place is None else _place(place))
        return self._place_frame[1]


def _place(place: Placed) -> dict[str, Any]:
    return {
        "level": place.level,
        "position": rounded_all(place.position),
        "decided": len(place.candidates) <= 1,
        "spread": rounded(place.spread, 2),
        "candidates": [_candidate(one) for one in place.candidates[:MAX_CANDIDATES]],
    }


def _candidate(one: Candidate) -> dict[str, Any]:
    x, y, z = rounded_all(one.position)
    return {
        "level": one.level,
        "x": x,
        "y": y,
        "z": z,
        "heading": rounded(one.heading),
        "weight": rounded(one.weight),
        "origin": one.origin,
    }
