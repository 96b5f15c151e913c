"""Area that the walls of a level enclose, found by a flood fill from the outside with all doors closed."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, floor, hypot, sqrt

from .crossing import MAX_CELLS, Walls
from .doors import MAX_DOOR_OFFSET
from .plan import Level, Point
from .segments import side

LATTICE_SPACING = 0.5
"""Distance between the points of the lattice, m; larger where there would be more than MAX_LATTICE_POINTS.

A gap in a wall along x or y is found if it is wider than the spacing, in a slanting wall if wider than 1.4 spacings."""
MAX_LATTICE_POINTS = 30_000
_CLOSING_DISTANCE = MAX_DOOR_OFFSET + 0.05
"""Largest distance of a wall's end from a door's end at which the two are joined by a closing line, m."""
OPEN_END_DISTANCE = 0.05
"""Distance from all other walls and doors beyond which a wall's end counts as open, m."""
_LATTICE_MARGIN = 1e-9
"""Distance from a point of the lattice, in units of the spacing, below which a wall counts as going through it."""


class Enclosure:
    """The area that the walls and closed doors of a level enclose, on a lattice of points.

    Construction takes 1 to 2 us for each point, 15 to 30 ms for a storey of 56 m by 63 m. `walls` are those of the
    level, `most` is the largest number of points."""

    __slots__ = ("_bottom", "_hull", "_left", "_outside", "_closed_doors", "_space", "_walls", "columns", "open_end",
                 "outside_numbers", "rows")  # fmt: skip

    def __init__(self, level: Level, walls: Walls, most: int = MAX_LATTICE_POINTS) -> None:
        self._walls = walls
        doors = [(door.start, door.end) for door in level.doors if door.start != door.end]
        self._closed_doors = Walls(doors + _find_closing_lines(level), min(most, MAX_CELLS))
        lines = self._walls.ends + self._closed_doors.ends
        xs = [x for ax, _, bx, _ in lines for x in (ax, bx)] or [0.0]
        ys = [y for _, ay, _, by in lines for y in (ay, by)] or [0.0]
        width, depth = max(xs) - min(xs), max(ys) - min(ys)
        self._space = max(LATTICE_SPACING, sqrt(width * depth / most), width / most, depth / most)
        # an odd fraction, so that walls at round numbers do not lie on the lattice
        self._left, self._bottom = min(xs) - 1.37 * self._space, min(ys) - 1.37 * self._space
        self.columns, self.rows = ceil(width / self._space) + 3, ceil(depth / self._space) + 3
        self._outside = bytearray(self.columns * self.rows)
        self.outside_numbers: list[int] = []
        """Numbers (row times `columns` plus column) of the points outside, in the order of the flood fill."""
        self._flood(*self._find_barriers(lines))
        self.open_end: Point | None = next(self._find_open_ends(), None)
        """End of a wall, door or closing line near the outside and near no other of these, m; None without one."""
        points = [point for ax, ay, bx, by in lines for point in ((ax, ay), (bx, by))]
        self._hull = _hull(points) if self.open_end is not None else []

    @property
    def outside(self) -> Iterator[Point]:
        """The points outside, m, in the order in which the flood fill reaches them."""
        return (self.point(at % self.columns, at // self.columns) for at in self.outside_numbers)

    def point(self, i: int, j: int) -> Point:
        """Return a point of the lattice, m: column i counts along x, row j along y."""
        return self._left + i * self._space, self._bottom + j * self._space

    def _find_barriers(self, lines: list[tuple[float, float, float, float]]) -> tuple[bytearray, bytearray]:
        """Return for each point whether a wall separates it from its neighbour in +x ("east"), and in +y ("north").

        There is always a barrier after the last point of a row or a column."""
        columns, rows, per_m = self.columns, self.rows, 1.0 / self._space
        east, north = bytearray(columns * rows), bytearray(columns * rows)
        east[columns - 1 :: columns] = b"\1" * rows
        north[-columns:] = b"\1" * columns
        for ax, ay, bx, by in lines:
            a, b = ((ax - self._left) * per_m, (ay - self._bottom) * per_m), (
                (bx - self._left) * per_m, (by - self._bottom) * per_m)  # fmt: skip
            for j, first, last in _lattice_crossings(a, b):
                for i in range(first, last + 1):
                    east[j * columns + i] = 1
            for i, first, last in _lattice_crossings(a[::-1], b[::-1]):
                for j in range(first, last + 1):
                    north[j * columns + i] = 1
        return east, north

    def _flood(self, east: bytearray, north: bytearray) -> None:
        outside, columns = self._outside, self.columns
        outside_numbers = self.outside_numbers = [0]
        outside[0] = 1
        for number in outside_numbers:  # the list grows in the loop
            # before the first column or row, the index wraps to the end of a row or column, which has a barrier
            for blocked, neighbour in (
                (east[number], number + 1),
                (east[number - 1], number - 1),
                (north[number], number + columns),
                (north[number - columns], number - columns),
            ):
                if not blocked and not outside[neighbour]:
                    outside[neighbour] = 1
                    outside_numbers.append(neighbour)

    def _find_open_ends(self) -> Iterator[Point]:
        for wall in (*self._walls.ends, *self._closed_doors.ends):
            for end in (wall[:2], wall[2:]):
                if self._is_near_outside(end) and not any(
                    [walls.has_wall_near(*end, wall, OPEN_END_DISTANCE) for walls in (self._walls, self._closed_doors)]
                ):
                    yield end

    def _is_near_outside(self, point: Point) -> bool:
        i, j = self._find_nearest(*point)
        return any(
            0 <= k < self.columns and 0 <= m < self.rows and self._outside[m * self.columns + k]
            for k in (i - 1, i, i + 1)
            for m in (j - 1, j, j + 1)
        )

    def _find_nearest(self, x: float, y: float) -> tuple[int, int]:
        return round((x - self._left) / self._space), round((y - self._bottom) / self._space)

    def inside(self, x: float, y: float) -> bool:
        """Return whether (x, y), m, is enclosed or, if a wall has an open end, within the hull of all walls."""
        if self._hull:
            return all(
                side(*a, *b, x, y) >= 0 for a, b in zip(self._hull, (*self._hull[1:], self._hull[0]), strict=True)
            )
        if not (0.0 <= x - self._left <= self.columns * self._space
                and 0.0 <= y - self._bottom <= self.rows * self._space):  # fmt: skip
            return False
        i, j = self._find_nearest(x, y)
        for k, m in ((i, j), (i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)):
            if (
                0 <= k < self.columns
                and 0 <= m < self.rows
                and not any(walls.crosses(x, y, *self.point(k, m)) for walls in (self._walls, self._closed_doors))
            ):
                return not self._outside[m * self.columns + k]
        return True  # walls separate the point from all lattice points around it


def _lattice_crossings(a: Point, b: Point) -> Iterator[tuple[int, int, int]]:
    """Yield (row, first, last) for each lattice row that the line crosses from a to b: (column, row), in spacings.

    It crosses the row between columns i and i + 1, for a whole number i from `first` to `last`. Where rounding leaves
    this open, the range includes one number too many. With exchanged coordinates, rows and columns are exchanged."""
    low, high = ceil(min(a[1], b[1]) - _LATTICE_MARGIN), floor(max(a[1], b[1]) + _LATTICE_MARGIN)
    height = b[1] - a[1]
    for row in range(low, high + 1):
        if abs(height) <= 2.0 * _LATTICE_MARGIN:
            yield row, floor(min(a[0], b[0]) - _LATTICE_MARGIN), floor(max(a[0], b[0]) + _LATTICE_MARGIN)
        else:
            column = a[0] + min(max((row - a[1]) / height, 0.0), 1.0) * (b[0] - a[0])
            yield row, floor(column - _LATTICE_MARGIN), floor(column + _LATTICE_MARGIN)


def _find_closing_lines(level: Level) -> list[tuple[Point, Point]]:
    """Return lines from the ends of doors to near ends of walls, as a map may draw a door on one face of its wall."""
    ends: dict[tuple[int, int], list[Point]] = {}
    for x, y in dict.fromkeys(end for wall in level.walls for end in (wall.start, wall.end)):
        ends.setdefault((round(x / _CLOSING_DISTANCE), round(y / _CLOSING_DISTANCE)), []).append((x, y))
    lines = set()
    for x, y in dict.fromkeys(end for door in level.doors for end in (door.start, door.end)):
        i, j = round(x / _CLOSING_DISTANCE), round(y / _CLOSING_DISTANCE)
        near_ends = [end for k in (i - 1, i, i + 1) for m in (j - 1, j, j + 1) for end in ends.get((k, m), ())]
        lines |= {((x, y), end) for end in near_ends if 0.0 < hypot(end[0] - x, end[1] - y) <= _CLOSING_DISTANCE}
    return sorted(lines)


def _hull(points: list[Point]) -> list[Point]:
    """Return the convex hull, counter-clockwise (Andrew 1979, Information Processing Letters 9)."""
    ordered = sorted(set(points))
    hull: list[Point] = []
    for sequence in (ordered, ordered[::-1]):
        half: list[Point] = []
        for point in sequence:
            while len(half) >= 2 and side(*half[-2], *half[-1], *point) <= 0:
                half.pop()
            half.append(point)
        hull += half[:-1]
    return hull
