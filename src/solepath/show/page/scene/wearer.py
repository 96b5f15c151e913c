"""Holds what a page shows of the wearer: the position in the world frame, and the place on the floor plan, m."""

from __future__ import annotations

from typing import Any

from attrs import define, evolve, field

from ....events import Candidate, Placed, TrackRevised, WearerMoved
from ....recording import printable
from ....types.attrs import NOT_SAVED
from ..messages import rounded, rounded_all
from .bending import Bend
from .lists import ThinnedTrack, WalkedTrack

MAX_CANDIDATES = 40
DECIDED_WEIGHT = 0.995
"""Share from which on the likeliest candidate is where the wearer is: unlikely ones would make the mark flicker."""

PlacePoint = tuple[float | None, str, float | None, float | None, float | None]
"""(t, level, x, y, z) in s and m."""


@define
class WearerScene:
    """The tracks of the wearer.

    `track` has a point for each stride. `places` has a point for each place whose candidates are all on one level."""

    moved: WearerMoved | None = None
    is_revised: bool = False
    """True from a revision of the track until the next stride: the covariance is then not known."""
    track: WalkedTrack = field(factory=WalkedTrack)
    places: ThinnedTrack[PlacePoint] = field(factory=ThinnedTrack)
    level: str | None = None
    """The last level that all candidates shared."""
    _place_frame: tuple[Placed | None, dict[str, Any] | None] = field(default=(None, None), metadata=NOT_SAVED)

    def add_position(self, event: WearerMoved) -> None:
        """Add the position of the wearer after a stride."""
        self.moved, self.is_revised = event, False
        self.track.add_position(event.t, event.position)

    def revise(self, event: TrackRevised, bend: Bend) -> None:
        """Bend the track, and go to the end of the revised path."""
        self.track.replace(bend.apply(self.track.points))
        if self.moved is None or not event.nodes:
            return
        position = (event.nodes[-1].x, event.nodes[-1].y, self.moved.position[2])
        self.moved, self.is_revised = evolve(self.moved, t=event.t, known_at=event.known_at, position=position), True
        self.track.add_position(event.t, position)

    def add_place(self, event: Placed) -> str | None:
        """Add a place on the plan; return its level if that is new and shared by all candidates, else None."""
        if any([candidate.level != event.level for candidate in event.candidates]):
            return None
        x, y, z = rounded_all(event.position)
        self.places.add((rounded(event.t), event.level, x, y, z))
        if event.level == self.level:
            return None
        self.level = event.level
        return event.level

    def forget_level(self) -> None:
        """Forget the level, since the place is lost."""
        self.level = None

    def wearer_frame(self) -> dict[str, Any] | None:
        """Return the member "wearer" of a frame."""
        moved = self.moved
        if moved is None:
            return None
        return {
            "t": rounded(moved.t),
            "position": rounded_all(moved.position),
            "covariance": None if self.is_revised else rounded_all(moved.covariance, 6),
        }

    def place_frame(self, place: Placed | None) -> dict[str, Any] | None:
        """Return the member "place" of a frame; None while the place is not known."""
        if place is not self._place_frame[0]:
            self._place_frame = (place, None if place is None else _place(place))
        return self._place_frame[1]


def _place(place: Placed) -> dict[str, Any]:
    return {
        "level": place.level,
        "room": None if place.room is None else printable(place.room),
        "door": None if place.door is None else printable(place.door),
        "position": rounded_all(place.position),
        "decided": len(place.candidates) <= 1 or place.candidates[0].weight >= DECIDED_WEIGHT,
        "spread": rounded(place.spread, 2),
        "candidates": [_candidate(candidate) for candidate in place.candidates[:MAX_CANDIDATES]],
    }


def _candidate(candidate: Candidate) -> dict[str, Any]:
    x, y, z = rounded_all(candidate.position)
    return {
        "level": candidate.level,
        "x": x,
        "y": y,
        "z": z,
        "heading": rounded(candidate.heading),
        "weight": rounded(candidate.weight),
        "origin": candidate.origin,
    }
