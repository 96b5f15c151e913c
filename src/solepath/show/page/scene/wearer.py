"""Where the wearer is: in the track's own frame, and on the floor plan."""

from __future__ import annotations

from typing import Any

from attrs import define, field

from ....events import Candidate, Placed, WearerMoved
from ..messages import rounded, rounded_all
from .lists import ThinnedTrack, WalkedTrack

MOST_CANDIDATES = 40

PlacePoint = tuple[float | None, str, float | None, float | None, float | None]
"""(t, level, x, y, z) in s and m."""


@define
class WearerScene:
    """The wearer's track has a point for each step, the places one for each step whose level is decided."""

    moved: WearerMoved | None = None
    track: WalkedTrack = field(factory=WalkedTrack)
    places: ThinnedTrack[PlacePoint] = field(factory=ThinnedTrack)
    level: str | None = None
    """The last one that there was no doubt of."""
    _place_frame: tuple[Placed | None, dict[str, Any] | None] = (None, None)

    def stepped(self, event: WearerMoved) -> None:
        """Where the wearer is after a step."""
        self.moved = event
        self.track.add_position(event.t, event.position)

    def found(self, event: Placed) -> str | None:
        """A place on the plan; the level where it is another one than before, and beyond doubt."""
        if any([one.level != event.level for one in event.candidates]):
            return None
        x, y, z = rounded_all(event.position)
        self.places.add((rounded(event.t), event.level, x, y, z))
        if event.level == self.level:
            return None
        self.level = event.level
        return event.level

    def lose(self) -> None:
        """There is no place any more."""
        self.level = None

    def wearer_frame(self) -> dict[str, Any] | None:
        """As "wearer" of a frame."""
        moved = self.moved
        if moved is None:
            return None
        return {
            "t": rounded(moved.t),
            "position": rounded_all(moved.position),
            "covariance": rounded_all(moved.covariance, 6),
        }

    def place_frame(self, place: Placed | None) -> dict[str, Any] | None:
        """As "place" of a frame; None while it is not known."""
        if place is not self._place_frame[0]:
            self._place_frame = (place, None if place is None else _place(place))
        return self._place_frame[1]


def _place(place: Placed) -> dict[str, Any]:
    return {
        "level": place.level,
        "position": rounded_all(place.position),
        "decided": len(place.candidates) <= 1,
        "spread": rounded(place.spread, 2),
        "candidates": [_candidate(one) for one in place.candidates[:MOST_CANDIDATES]],
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
