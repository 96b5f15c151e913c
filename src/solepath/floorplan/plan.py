"""A floor plan as plain records: levels with walls, doors and rooms, and the stairs and elevators that join them.

Plan frame: x and y in m, right handed, z up; a level's z is its `elevation`. Importers of three formats
(importers/reading.py) make these records; a program can make them too. Walls are solid: an importer cuts every door out
of them (doors.py). checks.py has the requirements on a plan."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from enum import Enum
from math import dist, fsum, hypot, sqrt

from ..saving.codec import checksum, save
from ..types.attrs import evolve, field, frozen, limited, limits
from .frame import MAX_COORDINATE as MAX_COORDINATE
from .frame import MAX_LATITUDE as MAX_LATITUDE
from .frame import Anchor as Anchor
from .frame import FloorPlanError as FloorPlanError
from .frame import Line as Line
from .frame import Point as Point
from .frame import naming as naming


@frozen
class Wall:
    """A straight solid wall without thickness."""

    start: Point
    end: Point

    @property
    def line(self) -> Line:
        """The wall from end to end."""
        return (*self.start, *self.end)

    @property
    def middle(self) -> Point:
        """The place in the middle of the wall, m."""
        return 0.5 * (self.start[0] + self.end[0]), 0.5 * (self.start[1] + self.end[1])


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
        return f"{self.kind.value} {self.name!r}" if self.name else f"{self.kind.value} without a name"


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
class PlanFinding:
    """One thing that is wrong with a floor plan.

    `text` is a sentence that names level, place and id. `act`: places will be wrong until somebody mends it. `level` is
    the id of a level and `place` is in m, plan frame, where there is such a place."""

    text: str
    act: bool = False
    level: str = ""
    place: Point | None = None


def on_level(level: str, what: str, place: Point | None = None, *, act: bool = True) -> PlanFinding:
    """Return what is wrong on a level; its sentence begins with the level."""
    return PlanFinding(f"level {level!r}: {what}", act, level, place)


def at(place: Point) -> str:
    """Return a place, m, for messages."""
    return f"({place[0]:.1f}, {place[1]:.1f})"


@frozen
class FloorPlan:
    """A building with levels and connectors.

    `levels` go from the lowest to the highest. `connectors` join them. `anchor` is None when the position on the Earth
    is unknown; nothing requires it. `heights_known` is False when the file has no elevations and the importer assumed
    the height between levels: then heights must not be corrected by elevations. `remarks` are faults that the
    importer tolerated; comparisons of plans ignore them."""

    name: str
    levels: tuple[Level, ...]
    connectors: tuple[Connector, ...] = ()
    anchor: Anchor | None = None
    heights_known: bool = True
    remarks: tuple[PlanFinding, ...] = field(default=(), eq=False)

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
                for i, points in enumerate(drawn, 1):
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

    def places(self, level: str) -> dict[str, dict[str, Point]]:
        """Return where the rooms, stairs and lifts, and doors of a level are, m, by kind and id.

        An id is a name that nothing else on its level has, else the name, or the kind, with a number; stairs and lifts
        have the same id on all levels. White space in an id is one space. The place of a room is inside it, that of
        stairs or a lift is where a person steps on and off, that of a door is its middle. Raises FloorPlanError when
        there is no such level."""
        from .geometry import find_inner_point

        drawn = self.level(level)
        connectors = self.connector_ids
        names = [(name, "room") for name in drawn.room_names or ("",) * len(drawn.rooms)]
        ids = make_ids([*names, *[(door.name, "door") for door in drawn.doors]], connectors)
        count = len(names)
        return {
            "connector": {name: stop.place for name, one in zip(connectors, self.connectors, strict=True)
                          for stop in one.stops if stop.level == level},
            "room": dict(zip(ids[:count], map(find_inner_point, drawn.rooms), strict=True)),
            "door": dict(zip(ids[count:], [door.middle for door in drawn.doors], strict=True)),
        }  # fmt: skip

    @property
    def connector_ids(self) -> list[str]:
        """Ids of the stairs and lifts (`places`)."""
        return make_ids([(one.name, one.kind.value) for one in self.connectors])

    def landmark(self, name: str, level: str) -> Point:
        """Return the place of the stairs or lift, the room or the door with this id on a level (`places`), m.

        Raises FloorPlanError when there is no such level, or nothing with this id on it."""
        places, name = self.places(level), one_space(name)
        for found in places.values():
            if name in found:
                return found[name]
        known = ", ".join([repr(named) for found in (places["connector"], places["room"]) for named in found])
        raise FloorPlanError(f"level {level!r} has no stairs, lift, room or door {name!r}; it has {known or 'none'}")

    def start(self, name: str, level: str | None = None, heading: float | None = None) -> Start:
        """Return the start of a wearer who sets out at a place with this id (`places`).

        `level` may be left out when only one level has such a place. `heading` is the wearer's first heading, rad,
        counter-clockwise from +x. In a room the place is uncertain by the size of the room. Raises FloorPlanError when
        there is no such place, or several."""
        levels, name = [one.id for one in self.levels] if level is None else [level], one_space(name)
        on = [one for one in levels if any([name in found for found in self.places(one).values()])]
        if len(on) > 1:
            raise FloorPlanError(f"{name!r} is on several levels: {', '.join(map(repr, on))}")
        if not on and level is None:
            raise FloorPlanError(f"no level of the plan has stairs, a lift, a room or a door {name!r}")
        at = (on or levels)[0]
        place = self.landmark(name, at)
        rooms, drawn = self.places(at)["room"], self.level(at)
        if name not in rooms:
            return Start(at, place, heading)
        ring = drawn.rooms[list(rooms).index(name)]
        # of a rectangle, the mean square distance from its middle is a third of that of its corners
        return Start(at, place, heading, sqrt(fsum([dist(place, corner) ** 2 for corner in ring]) / len(ring) / 3.0))

    @property
    def has_degrees(self) -> bool:
        """Whether all that is drawn has longitude and latitude: there is an anchor, and near enough.

        It is computed at each access, in a time that grows with the plan."""
        from .earth import MAX_ANCHOR_DISTANCE

        farthest = max([hypot(*point) for _, _, points in self.shapes() for point in points], default=0.0)
        return self.anchor is not None and farthest <= MAX_ANCHOR_DISTANCE

    def to_wgs84(self, point: Point) -> tuple[float, float]:
        """Return longitude and latitude, degrees, of a point of the plan, m; right to 0.1 mm within 20 km.

        Raises FloorPlanError when the plan has no anchor."""
        if self.anchor is None:
            raise FloorPlanError("the plan has no coordinates: give it an anchor")
        from .earth import Tangent

        return Tangent(self.anchor).degrees(point)


def one_space(name: str) -> str:
    """Return a name with one space in place of any white space within it."""
    return " ".join(name.split())


def make_ids(names: Sequence[tuple[str, str]], taken: Sequence[str] = ()) -> list[str]:
    """Return an id for each name and kind, all different and none of them taken.

    It is a name that is there once, else name or kind with a number. White space in it is one space."""
    named = [(one_space(name), kind) for name, kind in names]
    counts = Counter([*taken, *[name for name, _ in named]])
    numbers: Counter[str] = Counter()
    ids = []
    for name, kind in named:
        one, stem = name, name or kind
        while not one or counts[one] > (one == name):
            numbers[stem] += 1
            one = f"{stem} {numbers[stem]}"
        ids.append(one)
    return ids


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
