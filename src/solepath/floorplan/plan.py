"""A floor plan as plain records: levels with walls, doors and rooms, and the stairs and lifts that join them.

Plan frame: x and y in m, right handed, z up; a level's z is its `elevation`. Readers of three formats (reading.py) make
these records, and so can a program. Walls are solid: where one can go through, a reader has cut the door out of them
(doors.py). What a plan must and should be is in checks.py.
"""

from __future__ import annotations

from enum import Enum

from ..saving.codec import checksum, save
from ..types.attrs import evolve, field, frozen

Point = tuple[float, float]
"""(x, y) in m, plan frame."""


class FloorPlanError(ValueError):
    """A floor plan cannot be read or used: one line with the file, the feature and what does not fit."""


@frozen
class Wall:
    """A straight solid wall without thickness."""

    start: Point
    end: Point


@frozen
class Door:
    """A straight opening that one can walk through; where it lies on a wall, the wall has a gap."""

    start: Point
    end: Point
    name: str = ""


class ConnectorKind(Enum):
    """How a connector takes one to another level."""

    STAIRS = "stairs"
    LIFT = "lift"


@frozen
class ConnectorStop:
    """Where a connector meets a level. `place`: where one steps on and off. `outline`: of the stairwell or the cabin on
    this level, a ring whose last point is not the first again; empty when it is not known."""

    level: str
    place: Point
    outline: tuple[Point, ...] = ()


@frozen
class Connector:
    """Stairs or a lift. `stops`: from the lowest to the highest. `flights`: of stairs, per storey; None when it is not
    known. `rise`: m, of one step of the stairs; None when it is not known."""

    kind: ConnectorKind
    name: str
    stops: tuple[ConnectorStop, ...]
    flights: int | None = None
    rise: float | None = None


@frozen
class Level:
    """One storey. `ordinal`: its place in the order of storeys, 0 at the ground. `elevation`: of its floor, m, in the
    plan's z. `rooms`: outlines within which one can walk, rings whose last point is not the first again; empty when
    nothing is known of them."""

    id: str
    name: str
    ordinal: int
    elevation: float
    walls: tuple[Wall, ...]
    doors: tuple[Door, ...] = ()
    rooms: tuple[tuple[Point, ...], ...] = ()


@frozen
class Anchor:
    """Where on the Earth the plan is. `latitude`, `longitude`: of the plan's origin (0, 0), degrees, WGS84. `bearing`:
    rad, clockwise from true north to the plan's +y; with 0, +x is east and +y is north."""

    latitude: float
    longitude: float
    bearing: float = 0.0


@frozen
class FloorPlan:
    """A building. `levels`: from the lowest to the highest. `connectors`: what joins them. `anchor`: None when nobody
    knows where the building is, and nobody has to. `heights_known`: False where the file tells no elevations and the
    reader has put one storey's usual height between the levels: then nothing may be corrected by them. `remarks`: what
    a reader had to say of the file, one line each; plans are equal whatever they are."""

    name: str
    levels: tuple[Level, ...]
    connectors: tuple[Connector, ...] = ()
    anchor: Anchor | None = None
    heights_known: bool = True
    remarks: tuple[str, ...] = field(default=(), eq=False)

    def __deepcopy__(self, memo: object) -> FloorPlan:
        """Itself: nothing in it can change, and it may have 100,000 walls."""
        return self

    @property
    def fingerprint(self) -> int:
        """The same for equal plans, on every machine; another, but for one chance in 2^32, for others. It is computed
        anew, in a time that grows with the plan."""
        return checksum(save(evolve(self, remarks=())))

    @property
    def origin(self) -> Point:
        """A round place, m, near which the plan is, wherever its zero may be: what is kept in few digits is kept from
        there."""
        for level in self.levels:
            for x, y in [wall.start for wall in level.walls[:1]] + [room[0] for room in level.rooms[:1] if room]:
                return x // 1.0, y // 1.0
        for x, y in [stop.place for one in self.connectors[:1] for stop in one.stops[:1]]:
            return x // 1.0, y // 1.0
        return 0.0, 0.0

    def level(self, name: str) -> Level:
        """The level with this id. FloorPlanError when there is none."""
        for level in self.levels:
            if level.id == name:
                return level
        known = ", ".join(level.id for level in self.levels)
        raise FloorPlanError(f"the plan has no level {name!r}, only {known or 'none at all'}")


@frozen
class Start:
    """Where a wearer sets out. `place`: m, plan frame. `heading`: rad, counter-clockwise from the plan's +x, of the
    wearer's first heading; None when it is not known. `spread`: how far off `place` may be, m (rms)."""

    level: str
    place: Point
    heading: float | None = None
    spread: float = 0.5
