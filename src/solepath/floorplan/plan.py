"""A floor plan as plain records: levels with walls, doors and rooms, and the stairs and elevators that join them.

Plan frame: x and y in m, right handed, z up; a level's z is its `elevation`. Importers of three formats
(importers/reading.py) make these records; a program can make them too. Walls are solid: an importer cuts every door out
of them (doors.py). checks.py has the requirements on a plan."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import Enum

from ..saving.codec import checksum, save
from ..types.attrs import evolve, field, frozen, limited, limits

Point = tuple[float, float]
"""(x, y) in m, plan frame."""
MAX_COORDINATE = 1e7
"""Largest absolute coordinate from the plan's origin, m: national grids have up to 1e7."""
MAX_LATITUDE = 89.0
"""Largest absolute latitude of an anchor, degrees: east is not defined at a pole."""

Line = tuple[float, float, float, float]
"""A straight line from (ax, ay) to (bx, by), m, plan frame."""


class FloorPlanError(ValueError):
    """Raised when a floor plan cannot be read or used; its one line names the file, the feature and the fault."""


@contextmanager
def naming(name: str) -> Iterator[None]:
    """Put a name before the line of each FloorPlanError in this context."""
    try:
        yield
    except FloorPlanError as error:
        raise FloorPlanError(f"{name} {error}") from None


@frozen
class Wall:
    """A straight solid wall without thickness."""

    start: Point
    end: Point

    @property
    def line(self) -> Line:
        """The wall from end to end."""
        return (*self.start, *self.end)


@frozen
class Door(Wall):
    """A straight opening to walk through, from post to post; if it lies on a wall, the wall has a gap."""

    name: str = ""


class ConnectorKind(Enum):
    """Kind of a connector between levels."""

    STAIRS = "stairs"
    LIFT = "lift"


@frozen
class ConnectorStop:
    """The part of a connector on one level.

    `place` is where a person steps on and off. `outline` is that of the stairwell or the elevator cabin on this level,
    a ring that does not repeat its first point; empty when unknown."""

    level: str
    place: Point
    outline: tuple[Point, ...] = ()


@frozen
class Connector:
    """Stairs or an elevator.

    `stops` go from the lowest to the highest. `flights` is the number of flights of stairs per storey, None when
    unknown. `rise` is the height of one tread of the stairs, m, None when unknown."""

    kind: ConnectorKind
    name: str
    stops: tuple[ConnectorStop, ...]
    flights: int | None = None
    rise: float | None = None

    @property
    def label(self) -> str:
        """Kind and name, for messages."""
        return f"{self.kind.value} {self.name!r}"


@frozen
class Level:
    """One storey of a building.

    `ordinal` is its number in the order of storeys, 0 at the ground. `elevation` is its floor's z, m, plan frame.
    `rooms` are outlines within which a person can walk, rings that do not repeat their first point; empty when
    unknown. `room_names` are their names in the same order, "" for a room without one; empty when no name is known."""

    id: str
    name: str
    ordinal: int = field(metadata=limits(-100_000, 100_000))
    elevation: float
    walls: tuple[Wall, ...]
    doors: tuple[Door, ...] = ()
    rooms: tuple[tuple[Point, ...], ...] = ()
    room_names: tuple[str, ...] = ()

    def contradiction(self) -> str | None:
        """Return what is wrong with the number of names (types/checking.py)."""
        names, rooms = len(self.room_names), len(self.rooms)
        return None if names in (0, rooms) else f" has {names} names of rooms and {rooms} rooms"


def with_rooms(level: Level, rooms: Sequence[tuple[tuple[Point, ...], str]]) -> Level:
    """Return the level with these rooms, each an outline, m, plan frame, and its name, "" for a room without one."""
    names = tuple([name for _, name in rooms])
    return evolve(level, rooms=tuple([ring for ring, _ in rooms]), room_names=names if any(names) else ())


@frozen
class Anchor:
    """The position and orientation of the plan on the Earth.

    `latitude` and `longitude` are those of the plan's origin (0, 0), degrees, WGS84. `bearing` is the angle from true
    north clockwise to the plan's +y, rad; with 0, +x is east and +y is north."""

    latitude: float = field(metadata=limits(-MAX_LATITUDE, MAX_LATITUDE, "degrees"))
    longitude: float = field(metadata=limits(-180.0, 180.0, "degrees"))
    bearing: float = limited(0.0, -10.0, 10.0, "rad")


@frozen
class FloorPlan:
    """A building with levels and connectors.

    `levels` go from the lowest to the highest. `connectors` join them. `anchor` is None when the position on the Earth
    is unknown; nothing requires it. `heights_known` is False when the file has no elevations and the importer assumed
    the height between levels: then heights must not be corrected by elevations. `remarks` are lines about faults that
    the importer tolerated; comparisons of plans ignore them."""

    name: str
    levels: tuple[Level, ...]
    connectors: tuple[Connector, ...] = ()
    anchor: Anchor | None = None
    heights_known: bool = True
    remarks: tuple[str, ...] = field(default=(), eq=False)

    def __deepcopy__(self, memo: object) -> FloorPlan:
        """Return the plan itself: nothing in it can change, and it may have 100,000 walls."""
        return self

    @property
    def fingerprint(self) -> int:
        """Checksum of the plan: equal on every machine for equal plans, and by chance (1 in 2^32) for other plans.

        It is computed at each access, in a time that grows with the plan."""
        return checksum(save(evolve(self, remarks=())))

    def shapes(self) -> Iterator[tuple[str, str, tuple[Point, ...]]]:
        """Yield everything that is drawn: its kind, its name for messages, and its points."""
        for level in self.levels:
            walls = ((wall.start, wall.end) for wall in level.walls)
            doors = ((door.start, door.end) for door in level.doors)
            for kind, drawn in (("wall", walls), ("room", level.rooms), ("door", doors)):
                for i, points in enumerate(drawn):
                    yield kind, f"level {level.id!r}: {kind} {i}", points
        for connector in self.connectors:
            for stop in connector.stops:
                for kind, points in (("stop", (stop.place,)), ("outline", stop.outline)):
                    yield kind, f"{connector.label}: its {kind} at level {stop.level!r}", points

    @property
    def origin(self) -> Point:
        """A place near the plan in whole m, plan frame: values stored with few digits are stored relative to it."""
        x, y = next((points[0] for _, _, points in self.shapes()), (0.0, 0.0))
        return x // 1.0, y // 1.0

    def level(self, name: str) -> Level:
        """Return the level with this id; raise FloorPlanError when there is none."""
        for level in self.levels:
            if level.id == name:
                return level
        known = ", ".join(level.id for level in self.levels)
        raise FloorPlanError(f"the plan has no level {name!r}, only {known or 'none at all'}")

    def landmark(self, name: str, level: str) -> Point:
        """Return where a person steps on and off the stairs or lift of this name on a level, m.

        Raises FloorPlanError when there is no such level, or not exactly one stop of that name on it."""
        self.level(level)
        stops = [(one.name, stop.place) for one in self.connectors for stop in one.stops if stop.level == level]
        places = [place for named, place in stops if named == name]
        if len(places) == 1:
            return places[0]
        known = ", ".join([repr(named) for named, _ in stops if named])
        number = "no stairs or lift" if not places else f"{len(places)} stairs or lifts"
        raise FloorPlanError(f"level {level!r} has {number} of the name {name!r}; its names are {known or 'not known'}")


@frozen
class Start:
    """Initial place of a wearer, or only the first heading.

    `place` is in m, plan frame, None when unknown. `heading` is the wearer's first heading, rad, counter-clockwise from
    the plan's +x, None when unknown. `spread` is the uncertainty of `place`, m (rms). With a heading alone, as the
    compass of a phone may give it, fewer candidates are possible after the first stairs or lift."""

    level: str = ""
    place: Point | None = limited(None, -MAX_COORDINATE, MAX_COORDINATE, "m")
    heading: float | None = limited(None, -1000.0, 1000.0, "rad")
    spread: float = limited(0.5, 0.0, 5000.0, "m")

    def contradiction(self) -> str | None:
        """Return what is missing: a place, or the heading alone."""
        if self.place is not None or (self.heading is not None and self.level == ""):
            return None
        return " has no place: give level and place, or the heading alone"
