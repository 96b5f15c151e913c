"""Spaces that a building map draws, and their conversion to a plan with walls.

The outline of a closed space becomes walls. The outline of an open space becomes walls except along another open or
free space. Doors are cut out of the walls. Stairs and elevators are joined over the levels where they overlap. The
importers of IMDF and OpenStreetMap add to a Drawing; the plan does not depend on the order in which they add."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from itertools import chain
from math import atan2

from ...types.attrs import define, field
from ..checks import MAX_LEVELS, MAX_WALLS
from ..doors import MAX_DOOR_OFFSET, Openings, cut_openings
from ..earth import to_mm
from ..geometry import Ring, contains, direction, distance, edges, find_inner_point, join_holes, normalize_ring
from ..plan import (
    Anchor,
    Connector,
    ConnectorKind,
    ConnectorStop,
    Door,
    FloorPlan,
    FloorPlanError,
    Level,
    Line,
    PlanFinding,
    Point,
    Wall,
    with_rooms,
)

_MERGE_DISTANCE = 2e-3
"""Largest distance between walls that count as lying on one line, and largest gap over which they are joined, m."""

SHARED_BORDER_DISTANCE = 0.05
"""Largest distance between borders of two spaces that count as one border, m."""


MIN_PLACE_DISTANCE = 0.3
"""Least distance from the outline at which a person stands in stairs or a cabin, m: half of a person's width."""

MAX_PARTS = 1000
"""Largest number of parts of stairs and elevators: each is compared with all others."""


class Border(Enum):
    """The kind of a space's outline."""

    WALL = "wall"  # a wall all round except at doors
    OPEN = "open"  # a wall, except along another open or free space
    FREE = "free"  # no wall
    SOLID = "solid"  # a wall, and nobody can be inside


@define
class Space:
    """A space on one level; `rings` are its outline, then its holes. `name` is "" when it has none."""

    rings: tuple[Ring, ...]
    border: Border
    name: str = ""


@define
class ConnectorPart:
    """The part of stairs or an elevator on one level.

    Parts with the same `group` belong to the same connector; other parts do if they overlap on neighbouring levels.
    `place` is where a person steps on, m, plan frame; None stands for the middle, and so does a place that is not well
    within the outline, as many a map has its label there. `rise` is the height of one tread of the stairs, m; None when
    unknown."""

    kind: ConnectorKind
    name: str
    level: str
    place: Point | None
    rings: tuple[Ring, ...]
    group: str
    rise: float | None = None
    outline: Ring = field(init=False, default=())
    """The outline and the holes as one ring, empty when unknown."""
    middle: Point = field(init=False)
    """A place within the outline, m."""

    def __attrs_post_init__(self) -> None:
        self.middle = self.place or (0.0, 0.0)
        if self.rings:
            self.outline = normalize_ring(join_holes(self.rings))
            self.middle = find_inner_point(self.outline)
            if self.place is not None and not self._holds(self.place):
                self.place = None

    def _holds(self, place: Point) -> bool:
        """Return whether a person can stand at a place within the outline."""
        margin = min([distance(*edge, *place) for edge in edges(self.outline)])
        return self.contains(place) and margin >= MIN_PLACE_DISTANCE

    def contains(self, place: Point) -> bool:
        """Return whether the outline contains a place, m."""
        return contains(edges(self.outline), *place)


@define
class Storey:
    """A level: its name and order, and what is drawn on it. `lines` are walls besides outlines."""

    name: str
    ordinal: int
    order: float
    """Height above level 0, storeys, which may be fractional; it sorts the levels and gives their elevations."""
    spaces: list[Space] = field(factory=list)
    lines: list[Line] = field(factory=list)
    doors: list[Door] = field(factory=list)


@define
class Drawing:
    """Everything that a file draws; points are in m, plan frame."""

    name: str = ""
    storeys: dict[str, Storey] = field(factory=dict)
    parts: list[ConnectorPart] = field(factory=list)
    remarks: list[PlanFinding] = field(factory=list)

    def plan(self, anchor: Anchor, height: float) -> FloorPlan:
        """Return the plan; `height` is that assumed from one level to the next, m.

        Raises FloorPlanError when there are more levels, walls, doors or connectors than a plan may have."""
        storeys = self.storeys.values()
        rings = [space.rings for storey in storeys for space in storey.spaces] + [part.rings for part in self.parts]
        lines = [line for one in storeys for line in one.lines]
        for what, most, count in (
            ("levels", MAX_LEVELS, len(storeys)),
            ("walls", MAX_WALLS, sum(map(len, chain(*rings))) + len(lines)),
            ("stairs and lifts", MAX_PARTS, len(self.parts)),
        ):
            if count > most:
                raise FloorPlanError(f"has more than {most} {what}")
        ids = sorted(self.storeys, key=lambda level: (self.storeys[level].order, level))
        levels = tuple([self._level(level, self.storeys[level], height) for level in ids])
        connectors = tuple(self._join_parts({level: i for i, level in enumerate(ids)}))
        return FloorPlan(self.name, levels, connectors, anchor, heights_known=False, remarks=tuple(self.remarks))

    def _level(self, level: str, storey: Storey, height: float) -> Level:
        doors = {(min(one.start, one.end), max(one.start, one.end), one.name) for one in storey.doors}
        rooms = [(normalize_ring(join_holes(space.rings)), space.name)
                 for space in storey.spaces if space.border is not Border.SOLID]  # fmt: skip
        drawn = Level(level, storey.name, storey.ordinal, storey.order * height, self._walls(level, storey),
                      tuple([Door(*door) for door in sorted(doors)]))  # fmt: skip
        return with_rooms(drawn, sorted(rooms))

    def _walls(self, level: str, storey: Storey) -> tuple[Wall, ...]:
        outlines = [(_make_walls(chain(*map(edges, space.rings))), space.border) for space in storey.spaces]
        for part in self.parts:
            if part.level == level and part.rings:
                walls = _make_walls(chain(*map(edges, part.rings)))
                outlines.append((walls, _border_of(walls, storey.doors)))
        solid = {*_make_walls(storey.lines)}
        for walls, border in outlines:
            if border in (Border.WALL, Border.SOLID):
                solid.update(walls)
        unwalled = [(walls, border) for walls, border in outlines if border in (Border.OPEN, Border.FREE)]
        borders = Openings([(wall.start, wall.end, i) for i, (walls, _) in enumerate(unwalled) for wall in walls])
        for i, (walls, border) in enumerate(unwalled):
            if border is Border.OPEN:
                solid.update(cut_openings(walls, borders, SHARED_BORDER_DISTANCE, excluded=i))
        openings = Openings([(door.start, door.end, -1) for door in storey.doors])
        pieces = cut_openings(merge_walls(solid), openings, MAX_DOOR_OFFSET)
        return tuple(_make_walls([piece.line for piece in pieces]))

    def _join_parts(self, numbers: dict[str, int]) -> list[Connector]:
        """Return the connectors: parts of one group, and parts that overlap on neighbouring levels.

        Neighbours are levels that are at most one storey apart or adjacent in the list of levels."""

        def key(part: ConnectorPart) -> tuple[str, int, Point, str]:
            corner = min(chain(*part.rings), default=part.middle)
            return part.kind.value, numbers[part.level], corner, part.name

        def belong(low: ConnectorPart, high: ConnectorPart) -> bool:
            if low.kind is not high.kind or low.group == high.group:
                return low.kind is high.kind
            rise = self.storeys[high.level].order - self.storeys[low.level].order
            are_neighbours = rise > 0.0 and (rise <= 1.0 or numbers[high.level] - numbers[low.level] == 1)
            return are_neighbours and (high.contains(low.middle) or low.contains(high.middle))

        ordered = sorted(self.parts, key=key)
        groups = list(range(len(ordered)))
        for j, high in enumerate(ordered):
            for i, low in enumerate(ordered[:j]):
                if groups[i] != groups[j] and belong(low, high):
                    groups = [groups[i] if one == groups[j] else one for one in groups]
        connectors = [
            _make_connector([part for part, one in zip(ordered, groups, strict=True) if one == group], numbers)
            for group in dict.fromkeys(groups)
        ]
        return sorted(connectors, key=lambda one: (one.kind.value, one.name, one.stops[0].place))


def _make_walls(lines: Iterable[Line]) -> list[Wall]:
    """Return the walls along these lines, each once, in the order of their ends."""
    ends = {(min(line[:2], line[2:]), max(line[:2], line[2:])) for line in lines}
    return [Wall(start, end) for start, end in sorted(ends) if start != end]


def merge_walls(walls: set[Wall]) -> list[Wall]:
    """Return the walls after joining those that lie on one line and touch: most walls are drawn once for each room."""
    joined_walls: list[Wall] = []
    for wall in sorted(walls, key=_line_sort_key):
        if joined_walls:
            start, end = joined_walls[-1].start, joined_walls[-1].end
            far_end = max(wall.end, end)
            if max(distance(*start, *end, *wall.start), distance(*start, *far_end, *wall.end),
                   distance(*start, *far_end, *end)) <= _MERGE_DISTANCE:  # fmt: skip
                joined_walls[-1] = Wall(start, far_end)
                continue
        joined_walls.append(wall)
    return joined_walls


def _line_sort_key(wall: Wall) -> tuple[float, float, Point, Point]:
    """Return a sort key that groups walls on one line: direction, rad, distance from the origin, m, and the ends."""
    (ax, ay), (_, ux, uy) = wall.start, direction(wall.start, wall.end)
    return round(atan2(uy, ux), 4), round(ux * ay - uy * ax, 3), wall.start, wall.end


def _border_of(walls: list[Wall], doors: list[Door]) -> Border:
    """Return WALL for stairs and cabins with a door, else OPEN, since walls without a door make them unreachable."""
    has_door = any(distance(*wall.line, *door.middle) <= MAX_DOOR_OFFSET for door in doors for wall in walls)
    return Border.WALL if has_door else Border.OPEN


def _make_connector(parts: list[ConnectorPart], numbers: dict[str, int]) -> Connector:
    stops: dict[str, ConnectorStop] = {}
    for part in parts:
        if part.level not in stops or not stops[part.level].outline:
            stops[part.level] = ConnectorStop(part.level, to_mm(part.place or part.middle), part.outline)
    name = next((part.name for part in parts if part.name), "")
    rise = next((part.rise for part in parts if part.rise is not None), None)
    return Connector(parts[0].kind, name, tuple([stops[level] for level in sorted(stops, key=numbers.__getitem__)]),
                     None, rise)  # fmt: skip
