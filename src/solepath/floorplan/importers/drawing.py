"""Spaces that a building map draws, and their conversion to a plan with walls.

The outline of a closed space becomes walls. The outline of an open space becomes walls except along another open or
free space. Doors are cut out of the walls. Stairs and elevators are joined over the levels where they overlap. The
importers of IMDF and OpenStreetMap add to a Drawing; the plan does not depend on the order in which they add."""

from __future__ import annotations

from enum import Enum
from itertools import groupby
from math import atan2, hypot

from ...types.attrs import define, field
from ..checks import MAX_LEVELS, MAX_WALLS
from ..doors import MAX_DOOR_OFFSET, Line, Openings, cut_openings
from ..geometry import Ring, contains, distance, edges, find_inner_point, join_holes, normalize_ring
from ..plan import (
    Anchor,
    Connector,
    ConnectorKind,
    ConnectorStop,
    Door,
    FloorPlan,
    FloorPlanError,
    Level,
    Point,
    Wall,
    with_rooms,
)
from .earth import to_mm

_MERGE_DISTANCE = 2e-3
"""Largest distance between walls that count as lying on one line, and largest gap over which they are joined, m."""

SHARED_BORDER_DISTANCE = 0.05
"""Largest distance between borders of two spaces that count as one border, m."""


MAX_DOORS, MAX_PARTS = 100_000, 1000


class Border(Enum):
    """The kind of a space's outline."""

    WALL = "wall"  # a wall all round except at doors
    OPEN = "open"  # a wall, except along another open or free space
    FREE = "free"  # no wall
    SOLID = "solid"  # a wall, and nobody can be inside


@define
class Space:
    """A space on one level; `rings` are its outline, then its holes. `name` is "" when it has none."""

    level: str
    rings: tuple[Ring, ...]
    border: Border
    name: str = ""


@define
class ConnectorPart:
    """The part of stairs or an elevator on one level.

    Parts with the same `group` belong to the same connector; other parts do if they overlap on neighbouring levels.
    `place` is where a person steps on, m, plan frame; None stands for the middle. `rise` is the height of one tread of
    the stairs, m; None when unknown."""

    kind: ConnectorKind
    name: str
    level: str
    place: Point | None
    rings: tuple[Ring, ...]
    group: str
    rise: float | None = None

    @property
    def ring(self) -> Ring:
        """The outline and the holes as one ring."""
        return join_holes(self.rings)


@define
class Storey:
    """The name and order of a level."""

    name: str
    ordinal: int
    order: float
    """Height above level 0, storeys, which may be fractional; it sorts the levels and gives their elevations."""


@define
class Drawing:
    """Everything that a file draws; points are in m, plan frame.

    `lines` are walls (level, start, end) besides outlines. `doors` are (level, start, end, name)."""

    name: str = ""
    storeys: dict[str, Storey] = field(factory=dict)
    spaces: list[Space] = field(factory=list)
    lines: list[tuple[str, Point, Point]] = field(factory=list)
    doors: list[tuple[str, Point, Point, str]] = field(factory=list)
    parts: list[ConnectorPart] = field(factory=list)
    remarks: list[str] = field(factory=list)

    def plan(self, anchor: Anchor, storey: float) -> FloorPlan:
        """Return the plan; `storey` is the assumed height from one level to the next, m.

        Raises FloorPlanError when there are more levels, walls, doors or connectors than a plan may have."""
        if len(self.storeys) > MAX_LEVELS:
            raise FloorPlanError(f"has more than {MAX_LEVELS} levels")
        rings = [ring for space in self.spaces for ring in space.rings] + [r for part in self.parts for r in part.rings]
        drawn = sum(map(len, rings)) + len(self.lines)
        if drawn > MAX_WALLS:
            raise FloorPlanError(f"has more than {MAX_WALLS} walls")
        if len(self.doors) > MAX_DOORS or len(self.parts) > MAX_PARTS:
            raise FloorPlanError(f"has more than {MAX_DOORS} doors or {MAX_PARTS} stairs and lifts")
        ids = sorted(self.storeys, key=lambda level: (self.storeys[level].order, level))
        levels = [
            with_rooms(
                Level(level, self.storeys[level].name, self.storeys[level].ordinal, self.storeys[level].order * storey,
                      self._walls(level), self._doors(level)), self._rooms(level))
            for level in ids
        ]  # fmt: skip
        connectors = tuple(_join_parts(self.parts, {level: i for i, level in enumerate(ids)}, self.storeys))
        return FloorPlan(self.name, tuple(levels), connectors, anchor, heights_known=False, remarks=tuple(self.remarks))

    def _doors(self, level: str) -> tuple[Door, ...]:
        doors = {Door(min(a, b), max(a, b), name) for door_level, a, b, name in self.doors if door_level == level}
        return tuple(sorted(doors, key=lambda door: (door.start, door.end, door.name)))

    def _rooms(self, level: str) -> list[tuple[Ring, str]]:
        spaces = [space for space in self.spaces if space.level == level and space.border is not Border.SOLID]
        return sorted([(normalize_ring(join_holes(space.rings)), space.name) for space in spaces])

    def _walls(self, level: str) -> tuple[Wall, ...]:
        doors: list[Line] = [(start, end) for line_level, start, end, _ in self.doors if line_level == level]
        outlines = [(space.rings, space.border) for space in self.spaces if space.level == level]
        outlines += [(part.rings, _border_of(part, doors)) for part in self.parts if part.level == level and part.rings]
        walls = {
            _make_wall(start, end) for line_level, start, end in self.lines if line_level == level and start != end
        }
        for rings, border in outlines:
            if border in (Border.WALL, Border.SOLID):
                walls.update(_lines_of(rings))
        unwalled = [(_lines_of(rings), border) for rings, border in outlines if border in (Border.OPEN, Border.FREE)]
        owned_lines = [
            (wall.start, wall.end, i) for i, (lines, _) in enumerate(unwalled) for wall in sorted(lines, key=_ends_of)
        ]
        borders = Openings([(start, end) for start, end, _ in owned_lines], [owner for _, _, owner in owned_lines])
        for i, (lines, border) in enumerate(unwalled):
            if border is Border.OPEN:
                walls.update(cut_openings(sorted(lines, key=_ends_of), borders, SHARED_BORDER_DISTANCE, excluded=i))
        pieces = cut_openings(merge_walls(walls), Openings(doors), MAX_DOOR_OFFSET)
        return tuple(sorted({_make_wall(wall.start, wall.end) for wall in pieces}, key=_ends_of))


def _make_wall(start: Point, end: Point) -> Wall:
    return Wall(min(start, end), max(start, end))


def _ends_of(wall: Wall) -> tuple[Point, Point]:
    return wall.start, wall.end


def merge_walls(walls: set[Wall]) -> list[Wall]:
    """Return the walls after joining those that lie on one line and touch: most walls are drawn once for each room."""
    joined_walls: list[Wall] = []
    for wall in sorted(walls, key=_line_sort_key):
        if joined_walls:
            (ax, ay), (bx, by) = last_ends = joined_walls[-1].start, joined_walls[-1].end
            far_end = max(wall.end, last_ends[1])
            if (distance(ax, ay, bx, by, *wall.start) <= _MERGE_DISTANCE
                    and distance(*last_ends[0], *far_end, *wall.end) <= _MERGE_DISTANCE
                    and distance(*last_ends[0], *far_end, *last_ends[1]) <= _MERGE_DISTANCE):  # fmt: skip
                joined_walls[-1] = Wall(last_ends[0], far_end)
                continue
        joined_walls.append(wall)
    return joined_walls


def _line_sort_key(wall: Wall) -> tuple[float, float, Point, Point]:
    """Return a sort key that groups walls on one line: direction, rad, distance from the origin, m, and the ends."""
    (ax, ay), (bx, by) = wall.start, wall.end
    length = hypot(bx - ax, by - ay)
    ux, uy = (bx - ax) / length, (by - ay) / length
    return round(atan2(uy, ux), 4), round(ux * ay - uy * ax, 3), wall.start, wall.end


def _lines_of(rings: tuple[Ring, ...]) -> set[Wall]:
    return {_make_wall((ax, ay), (bx, by)) for ring in rings for ax, ay, bx, by in edges(ring) if (ax, ay) != (bx, by)}


def _border_of(part: ConnectorPart, doors: list[Line]) -> Border:
    """Return WALL for stairs and cabins with a door, else OPEN, since walls without a door make them unreachable."""
    lines = [line for ring in part.rings for line in edges(ring)]
    for start, end in doors:
        x, y = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
        if any(distance(*line, x, y) <= MAX_DOOR_OFFSET for line in lines):
            return Border.WALL
    return Border.OPEN


def _join_parts(parts: list[ConnectorPart], numbers: dict[str, int], storeys: dict[str, Storey]) -> list[Connector]:
    """Return the connectors made of these parts.

    Parts of one group are joined. Parts that overlap are joined if their levels are at most one storey apart or
    adjacent in the list of levels."""

    def sort_key(part: ConnectorPart) -> tuple[str, int, Point, str]:
        corner = min(part.ring, default=part.place or (0.0, 0.0))
        return part.kind.value, numbers[part.level], corner, part.name

    ordered = sorted(parts, key=sort_key)
    middles = [find_inner_point(part.ring) if len(part.ring) >= 3 else part.place or (0.0, 0.0) for part in ordered]
    leader = list(range(len(ordered)))

    def find_leader(i: int) -> int:
        while leader[i] != i:
            leader[i] = leader[leader[i]]
            i = leader[i]
        return i

    for j, upper in enumerate(ordered):
        for i, lower in enumerate(ordered[:j]):
            if lower.kind is not upper.kind or find_leader(i) == find_leader(j):
                continue
            if lower.group == upper.group or (
                _are_neighbours(lower.level, upper.level, numbers, storeys)
                and (_is_within(middles[i], upper) or _is_within(middles[j], lower))
            ):
                leader[max(find_leader(i), find_leader(j))] = min(find_leader(i), find_leader(j))
    grouped = sorted(range(len(ordered)), key=lambda i: (find_leader(i), i))
    connectors = [
        _make_connector([ordered[i] for i in indices], numbers) for _, indices in groupby(grouped, key=find_leader)
    ]
    return sorted(connectors, key=lambda connector: (connector.kind.value, connector.name, connector.stops[0].place))


def _is_within(place: Point, part: ConnectorPart) -> bool:
    return len(part.ring) >= 3 and contains(edges(part.ring), *place)


def _are_neighbours(low: str, high: str, numbers: dict[str, int], storeys: dict[str, Storey]) -> bool:
    rise = storeys[high].order - storeys[low].order
    return rise > 0.0 and (rise <= 1.0 or numbers[high] - numbers[low] == 1)


def _make_connector(parts: list[ConnectorPart], numbers: dict[str, int]) -> Connector:
    stops: dict[str, ConnectorStop] = {}
    for part in parts:
        outline = normalize_ring(part.ring) if len(part.ring) >= 3 else ()
        place = part.place if part.place is not None else find_inner_point(outline)
        stop = ConnectorStop(part.level, to_mm(place), outline)
        if part.level not in stops or not stops[part.level].outline:
            stops[part.level] = stop
    name = next((part.name for part in parts if part.name), "")
    rise = next((part.rise for part in parts if part.rise is not None), None)
    return Connector(parts[0].kind, name, tuple(stops[level] for level in sorted(stops, key=numbers.__getitem__)),
                     None, rise)  # fmt: skip
