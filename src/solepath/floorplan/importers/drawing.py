"""Spaces, as building maps draw them, and their conversion to a plan with walls.

Walls are the outlines of closed spaces, and those of open spaces except towards another open or free one, each
without its doors. Stairs and lifts are joined over the levels where they overlap. The readers of IMDF and
OpenStreetMap add to a Drawing; the plan does not depend on their order."""

from __future__ import annotations

from enum import Enum
from itertools import groupby
from math import atan2, hypot

from ...types.attrs import define, field
from ..checks import MOST_LEVELS, MOST_WALLS
from ..doors import BESIDE, Line, Openings, cut
from ..outlines import Ring, edges, holds, middle, tidy, with_holes
from ..plan import Anchor, Connector, ConnectorKind, ConnectorStop, Door, FloorPlan, FloorPlanError, Level, Point, Wall
from ..segments import distance
from .earth import to_mm

_TOGETHER = 2e-3
"""Largest distance between walls on one line, and largest gap that joins them, m."""

SHARED = 0.05
"""Largest distance between borders of two spaces that count as one border, m."""


class Border(Enum):
    """The kind of a space's outline."""

    WALL = "wall"  # a wall all round, but for its doors
    OPEN = "open"  # a wall, but not towards another open or free space
    FREE = "free"  # no wall
    SOLID = "solid"  # a wall, and nobody can be inside


@define
class Space:
    """A space on one level; `rings` are its outline, then its holes."""

    level: str
    rings: tuple[Ring, ...]
    border: Border


@define
class ConnectorPart:
    """The part of stairs or a lift on one level.

    Parts of one `group` are always the same stairs or lift; others are if they overlap on neighbouring levels. `place`
    is where a person steps on; None stands for the middle."""

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
        return with_holes(self.rings)


@define
class Storey:
    """The name and order of a level."""

    name: str
    ordinal: int
    order: float
    """Position in storeys above level 0, which may be fractional; it sorts the levels and gives their heights."""


@define
class Drawing:
    """Everything that was drawn."""

    name: str = ""
    storeys: dict[str, Storey] = field(factory=dict)
    spaces: list[Space] = field(factory=list)
    lines: list[tuple[str, Point, Point]] = field(factory=list)
    doors: list[tuple[str, Point, Point, str]] = field(factory=list)
    parts: list[ConnectorPart] = field(factory=list)
    remarks: list[str] = field(factory=list)

    def plan(self, anchor: Anchor, storey: float) -> FloorPlan:
        """Return the plan; `storey` is the height from one level to the next, m: these formats have no elevations.

        Raises FloorPlanError when there is more than a building has."""
        if len(self.storeys) > MOST_LEVELS:
            raise FloorPlanError(f"has more than {MOST_LEVELS} levels")
        rings = [ring for space in self.spaces for ring in space.rings] + [r for part in self.parts for r in part.rings]
        drawn = sum(map(len, rings)) + len(self.lines)
        if drawn > MOST_WALLS:
            raise FloorPlanError(f"has more than {MOST_WALLS} walls")
        if len(self.doors) > MOST_WALLS or len(self.parts) > MOST_LEVELS:
            raise FloorPlanError(f"has more than {MOST_WALLS} doors or {MOST_LEVELS} stairs and lifts")
        ids = sorted(self.storeys, key=lambda level: (self.storeys[level].order, level))
        levels = [
            Level(level, self.storeys[level].name, self.storeys[level].ordinal, self.storeys[level].order * storey,
                  self._walls(level), self._doors(level), self._rooms(level))
            for level in ids
        ]  # fmt: skip
        connectors = tuple(_join_parts(self.parts, {level: i for i, level in enumerate(ids)}, self.storeys))
        return FloorPlan(self.name, tuple(levels), connectors, anchor, heights_known=False, remarks=tuple(self.remarks))

    def _doors(self, level: str) -> tuple[Door, ...]:
        found = {Door(min(a, b), max(a, b), name) for at, a, b, name in self.doors if at == level}
        return tuple(sorted(found, key=lambda door: (door.start, door.end, door.name)))

    def _rooms(self, level: str) -> tuple[Ring, ...]:
        here = [one for one in self.spaces if one.level == level and one.border is not Border.SOLID]
        return tuple(sorted([tidy(with_holes(one.rings)) for one in here]))

    def _walls(self, level: str) -> tuple[Wall, ...]:
        doors: list[Line] = [(start, end) for at, start, end, _ in self.doors if at == level]
        here = [(one.rings, one.border) for one in self.spaces if one.level == level]
        here += [(one.rings, _border_of(one, doors)) for one in self.parts if one.level == level and one.rings]
        walls = {_wall(start, end) for at, start, end in self.lines if at == level and start != end}
        for rings, border in here:
            if border in (Border.WALL, Border.SOLID):
                walls.update(_lines(rings))
        loose = [(_lines(rings), border) for rings, border in here if border in (Border.OPEN, Border.FREE)]
        owned = [(wall.start, wall.end, i) for i, (lines, _) in enumerate(loose) for wall in sorted(lines, key=_ends)]
        borders = Openings([(start, end) for start, end, _ in owned], [owner for _, _, owner in owned])
        for i, (lines, border) in enumerate(loose):
            if border is Border.OPEN:
                walls.update(cut(sorted(lines, key=_ends), borders, SHARED, excluded=i))
        kept = cut(merged(walls), Openings(doors), BESIDE)
        return tuple(sorted({_wall(wall.start, wall.end) for wall in kept}, key=_ends))


def _wall(start: Point, end: Point) -> Wall:
    return Wall(min(start, end), max(start, end))


def _ends(wall: Wall) -> tuple[Point, Point]:
    return wall.start, wall.end


def merged(walls: set[Wall]) -> list[Wall]:
    """Return the walls with those joined that lie on one line and touch: most are drawn twice, from either room."""
    found: list[Wall] = []
    for wall in sorted(walls, key=_on_line):
        if found:
            (ax, ay), (bx, by) = last = found[-1].start, found[-1].end
            far = max(wall.end, last[1])
            if (distance(ax, ay, bx, by, *wall.start) <= _TOGETHER
                    and distance(*last[0], *far, *wall.end) <= _TOGETHER
                    and distance(*last[0], *far, *last[1]) <= _TOGETHER):  # fmt: skip
                found[-1] = Wall(last[0], far)
                continue
        found.append(wall)
    return found


def _on_line(wall: Wall) -> tuple[float, float, Point, Point]:
    """Return a sort key that groups walls on one line: direction, distance of the line from the origin, start."""
    (ax, ay), (bx, by) = wall.start, wall.end
    long = hypot(bx - ax, by - ay)
    ux, uy = (bx - ax) / long, (by - ay) / long
    return round(atan2(uy, ux), 4), round(ux * ay - uy * ax, 3), wall.start, wall.end


def _lines(rings: tuple[Ring, ...]) -> set[Wall]:
    return {_wall((ax, ay), (bx, by)) for ring in rings for ax, ay, bx, by in edges(ring) if (ax, ay) != (bx, by)}


def _border_of(part: ConnectorPart, doors: list[Line]) -> Border:
    """Return WALL for stairs and cabins with a door, else OPEN: closed walls would make them unreachable."""
    lines = [line for ring in part.rings for line in edges(ring)]
    for start, end in doors:
        x, y = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
        if any(distance(*line, x, y) <= BESIDE for line in lines):
            return Border.WALL
    return Border.OPEN


def _join_parts(parts: list[ConnectorPart], numbers: dict[str, int], storeys: dict[str, Storey]) -> list[Connector]:
    """Join parts into connectors.

    Joined are those of one group, and those that overlap on levels whose order is one apart or less, or that are
    adjacent in the list of levels."""
    ordered = sorted(
        parts,
        key=lambda part: (
            part.kind.value,
            numbers[part.level],
            min(part.ring, default=part.place or (0.0, 0.0)),
            part.name,
        ),
    )
    middles = [middle(part.ring) if len(part.ring) >= 3 else part.place or (0.0, 0.0) for part in ordered]
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
                _neighbours(lower.level, upper.level, numbers, storeys)
                and (_within(middles[i], upper) or _within(middles[j], lower))
            ):
                leader[max(find_leader(i), find_leader(j))] = min(find_leader(i), find_leader(j))
    together = sorted(range(len(ordered)), key=lambda i: (find_leader(i), i))
    found = [_connector([ordered[i] for i in some], numbers) for _, some in groupby(together, key=find_leader)]
    return sorted(found, key=lambda one: (one.kind.value, one.name, one.stops[0].place))


def _within(place: Point, part: ConnectorPart) -> bool:
    return len(part.ring) >= 3 and holds(edges(part.ring), *place)


def _neighbours(low: str, high: str, numbers: dict[str, int], storeys: dict[str, Storey]) -> bool:
    rise = storeys[high].order - storeys[low].order
    return rise > 0.0 and (rise <= 1.0 or numbers[high] - numbers[low] == 1)


def _connector(parts: list[ConnectorPart], numbers: dict[str, int]) -> Connector:
    stops: dict[str, ConnectorStop] = {}
    for part in parts:
        outline = tidy(part.ring) if len(part.ring) >= 3 else ()
        at = part.place if part.place is not None else middle(outline)
        stop = ConnectorStop(part.level, to_mm(at), outline)
        if part.level not in stops or not stops[part.level].outline:
            stops[part.level] = stop
    name = next((part.name for part in parts if part.name), "")
    rise = next((part.rise for part in parts if part.rise is not None), None)
    return Connector(parts[0].kind, name, tuple(stops[level] for level in sorted(stops, key=numbers.__getitem__)),
                     None, rise)  # fmt: skip
