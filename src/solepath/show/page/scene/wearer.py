"""Holds what a page shows of the wearer: the position in the world frame, and the place on the floor plan, m."""

from __future__ import annotations

from typing import Any

from attrs import define, evolve, field

from ....events import Placed, TrackRevised, WearerMoved
from ....events.activity import Ride
from ....recording import printable
from ....types.attrs import NOT_SAVED
from ..messages import members, plain
from .bending import Bend, bent, span_of
from .lists import GrowingList, TrackPoint, add_position, new_track

MAX_CANDIDATES = 40

PlacePoint = tuple[float, str, float, float, float]
"""(t, level, x, y, z) in s and m."""


@define
class WearerScene:
    """The tracks of the wearer.

    `track` has a point for each stride, `places` one for each decided place; both have start and end of a ride."""

    moved: WearerMoved | None = None
    is_revised: bool = False
    """True from a revision of the track until the next stride: the covariance is then not known."""
    track: GrowingList[TrackPoint] = field(factory=new_track)
    places: GrowingList[PlacePoint] = field(factory=lambda: GrowingList(thins=True))
    level: str | None = None
    """Level of the last place whose level is decided; None after the place was lost."""
    _place_frame: tuple[Placed | None, dict[str, Any] | None] = field(default=(None, None), metadata=NOT_SAVED)

    def add_position(self, event: WearerMoved) -> None:
        """Add the position of the wearer after a stride."""
        self.moved, self.is_revised = event, False
        add_position(self.track, event.t, event.position)

    def revise(self, event: TrackRevised, bend: Bend) -> None:
        """Bend the track, and go to the end of the revised path."""
        self.track.replace(bent(self.track.items, bend))
        if self.moved is None or not event.nodes:
            return
        position = (event.nodes[-1].x, event.nodes[-1].y, self.moved.position[2])
        self.moved, self.is_revised = evolve(self.moved, t=event.t, known_at=event.known_at, position=position), True
        add_position(self.track, event.t, position)

    def ride(self, ride: Ride) -> None:
        """Draw the height of a ride over its time, although it is known some strides after the ride.

        Positions since the ride are that much higher. Places since then are left out: they are those before it."""
        height, t_start, t = ride.height, round(ride.t_start, 3), round(ride.t, 3)
        if height is None:
            return
        track, places = self.track.items, self.places.items
        end, after = span_of([point[0] for point in track], t_start, t)
        if end:
            _, x, y, z = track[end - 1]
            raised = [(*point[:3], round(point[3] + height, 3)) for point in track[after:]]
            self.track.replace([*track[:end], (t_start, x, y, z), (t, x, y, round(z + height, 3)), *raised])
        end, _ = span_of([place[0] for place in places], t_start, t)
        if end:
            _, level, x, y, z = places[end - 1]
            self.places.replace([*places[:end], (t_start, level, x, y, z), (t, level, x, y, round(z + height, 3))])

    def add_place(self, event: Placed) -> bool:
        """Add a place on the plan if it is decided; return whether another level than before is."""
        if event.decided:
            x, y, z = event.position
            self.places.add((round(event.t, 3), event.level, round(x, 3), round(y, 3), round(z, 3)))
        before = self.level
        if event.level_decided:
            self.level = event.level
        return self.level != before

    def wearer_frame(self) -> dict[str, Any] | None:
        """Return the member "wearer" of a frame."""
        if self.moved is None:
            return None
        frame = members(self.moved, "t", "position", "covariance", covariance=6)
        return frame | {"covariance": None} if self.is_revised else frame

    def place_frame(self, place: Placed | None) -> dict[str, Any] | None:
        """Return the member "place" of a frame; None while the place is not known."""
        if place is not self._place_frame[0]:
            self._place_frame = (place, None if place is None else _place(place))
        return self._place_frame[1]


def _place(place: Placed) -> dict[str, Any]:
    names = {"room": place.room, "door": place.door}
    return {
        **members(place, "level", "position", "spread", spread=2),
        **{key: None if name is None else printable(name) for key, name in names.items()},
        "decided": place.decided,
        "candidates": [
            members(one, "level", "heading", "weight") | {"x": plain(one.position[0]), "y": plain(one.position[1])}
            for one in place.candidates[:MAX_CANDIDATES]
        ],
    }
