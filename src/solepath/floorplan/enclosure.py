"""Area that the walls of a level enclose, found by a flood fill from the outside with all doors closed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from math import ceil, dist, sqrt

from .doors import MAX_DOOR_OFFSET
from .geometry import Ring, contains, distance, edges, side
from .plan import Level, Line, Point
from .walls import Walls

LATTICE_SPACING = 0.5
"""Distance between the points of the lattice, m; larger where there would be too many.

A gap in a wall along x or y is found if it is wider than the spacing, in a slanting wall if wider than 1.4 spacings."""

MAX_POINTS, MAX_POINTS_PER_PLAN = 30_000, 500_000
"""Largest number of points of the lattice of a level, and of all levels together."""

_CLOSING_DISTANCE = MAX_DOOR_OFFSET + 0.05
"""Largest distance of a wall's end from a door's end at which the two are joined by a closing line, m."""

Cell = tuple[int, int]
"""Column and row of a point of the lattice."""
OUTSIDE, ENCLOSED = 0, -1
"""Region of the points outside, and of those within that have no number yet."""

OPEN_END_DISTANCE = 0.05
"""Distance from all other walls and doors beyond which a wall's end counts as open, m."""


class Enclosure:
    """The area that the walls and closed doors of a level enclose, on a lattice of points.

    `walls` are those of the level, `count` is the number of levels of the plan."""

    __slots__ = ("_barriers", "_bottom", "_hull", "_left", "_regions", "_space", "open_ends", "outside")

    def __init__(self, level: Level, walls: Walls, count: int) -> None:
        doors = [door.line for door in level.doors if door.start != door.end]
        lines = [*[wall.line for wall in level.walls], *doors, *_find_closing_lines(level, walls)]
        self._barriers = Walls(lines, 2.0 * walls.scale)
        ends = [end for line in lines for end in (line[:2], line[2:])]
        xs, ys = [sorted(axis) for axis in zip(*(ends or [(0.0, 0.0)]), strict=True)]
        width, depth = xs[-1] - xs[0], ys[-1] - ys[0]
        self._space = max(LATTICE_SPACING, sqrt(width * depth / min(MAX_POINTS, MAX_POINTS_PER_PLAN / count)))
        # an odd fraction, so that walls at round numbers do not lie on the lattice
        self._left, self._bottom = xs[0] - 1.37 * self._space, ys[0] - 1.37 * self._space
        columns, rows = ceil(width / self._space) + 3, ceil(depth / self._space) + 3
        self._regions = {(i, j): ENCLOSED for i in range(columns) for j in range(rows)}
        self.outside = list(self._flood((0, 0), OUTSIDE))
        """The points outside, m, in the order in which the flood fill reaches them, each with that before it."""
        self.open_ends = list(self._find_open_ends(lines))
        """Ends of walls, doors and closing lines near the outside and near no other of these, m."""
        self._hull = _hull(ends) if self.open_ends else []

    def point(self, i: int, j: int) -> Point:
        """Return the place of a point of the lattice, m."""
        return self._left + i * self._space, self._bottom + j * self._space

    def _find_nearest(self, x: float, y: float) -> Cell:
        return round((x - self._left) / self._space), round((y - self._bottom) / self._space)

    def _flood(self, first: Cell, region: int) -> Iterator[tuple[Point, Point]]:
        """Mark the points that no wall or door separates from the first one as of this region.

        Yields each of them after the first one, with the point from which it is reached."""
        self._regions[first] = region
        found = [first]
        for i, j in found:  # the list grows in the loop
            place = self.point(i, j)
            for near in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
                if self._regions.get(near) == ENCLOSED:
                    beside = self.point(*near)
                    if not self._barriers.crosses(*place, *beside):
                        self._regions[near] = region
                        found.append(near)
                        yield beside, place

    def number_regions(self) -> int:
        """Give a number to each region within, in which no wall or door bars the way; return the number of all regions.

        The region outside counts, too."""
        count = OUTSIDE + 1
        for point in self._regions:
            if self._regions[point] == ENCLOSED:
                list(self._flood(point, count))
                count += 1
        return count

    def find_points(self, ring: Ring) -> list[Cell]:
        """Return the points of the lattice in the ring, each by its column and row."""
        lines, (xs, ys) = edges(ring), zip(*ring, strict=True)
        (left, bottom), (right, top) = self._find_nearest(min(xs), min(ys)), self._find_nearest(max(xs), max(ys))
        points = [(i, j) for i in range(left, right + 1) for j in range(bottom, top + 1)]
        return [one for one in points if one in self._regions and contains(lines, *self.point(*one))]

    def count_regions(self, ring: Ring) -> Counter[int]:
        """Return of how many points of the lattice in the ring each region is."""
        return Counter([self._regions[one] for one in self.find_points(ring)])

    def _find_open_ends(self, lines: list[Line]) -> Iterator[Point]:
        for line in lines:
            for end in (line[:2], line[2:]):
                i, j = self._find_nearest(*end)
                around = [self._regions[k, m] for k in (i - 1, i, i + 1) for m in (j - 1, j, j + 1)]
                if OUTSIDE in around and not any(
                    distance(*other, *end) <= OPEN_END_DISTANCE
                    for other in self._barriers.near(*end) if other not in (line, line[2:] + line[:2])
                ):  # fmt: skip
                    yield end

    def inside(self, x: float, y: float) -> bool:
        """Return whether (x, y), m, is enclosed or, if a wall has an open end, within the hull of all walls."""
        if self._hull:
            ends = zip(self._hull, self._hull[1:] + self._hull[:1], strict=True)
            return all(side(*a, *b, x, y) >= 0 for a, b in ends)
        i, j = self._find_nearest(x, y)
        return (i, j) in self._regions and self.region(x, y) != OUTSIDE

    def region(self, x: float, y: float) -> int | None:
        """Return the region of (x, y), m; None where walls and doors separate it from all points around it."""
        i, j = self._find_nearest(x, y)
        for near in ((i, j), (i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)):
            if near in self._regions and not self._barriers.crosses(x, y, *self.point(*near)):
                return self._regions[near]
        return None


def _find_closing_lines(level: Level, walls: Walls) -> list[Line]:
    """Return lines from the ends of doors to near ends of walls, as a map may draw a door on one face of its wall."""
    ends = [end for door in level.doors for end in (door.start, door.end)]
    lines = {(*end, *other) for end in ends for wall in walls.near(*end) for other in (wall[:2], wall[2:])}
    return sorted([line for line in lines if 0.0 < dist(line[:2], line[2:]) <= _CLOSING_DISTANCE])


def _hull(points: list[Point]) -> list[Point]:
    """Return the convex hull, counter-clockwise (Andrew 1979, Information Processing Letters 9)."""
    hull, ordered = list[Point](), sorted(set(points))
    for sequence in (ordered, ordered[::-1]):
        half: list[Point] = []
        for point in sequence:
            while len(half) >= 2 and side(*half[-2], *half[-1], *point) <= 0:
                half.pop()
            half.append(point)
        hull += half[:-1]
    return hull
