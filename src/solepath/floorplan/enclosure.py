"""Area that the walls of a level enclose, found by a flood fill from the outside with all doors closed."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, floor, hypot, sqrt

from .crossing import MOST_CELLS, Walls
from .doors import BESIDE
from .plan import Level, Point
from .segments import side

LATTICE = 0.5
"""Distance between the tested places, m; larger where there would be more than MOST_PLACES.

A gap in a wall along the axes that is wider than this is found, a slanting one from 0.7 m on."""

MOST_PLACES = 30_000

_POST = BESIDE + 0.05
"""Distance from a door's end within which a wall's end is the door's post, m."""

OPEN_END = 0.05
"""Distance from all other walls and doors beyond which a wall's end is open, m."""

_ON = 1e-9
"""Distance from a place of the lattice, in units of its spacing, below which a wall goes through it."""


class Enclosure:
    """The places that can be reached from outside a level without going through a wall or a door.

    Takes about 1 us for each place, 15 to 30 ms for a storey of 56 m by 63 m. `walls` are those of the level, `most` is
    the largest number of places."""

    __slots__ = ("_bottom", "_hull", "_left", "_outside", "_closed_doors", "_space", "_walls", "columns", "open_end",
                 "order", "rows")  # fmt: skip

    def __init__(self, level: Level, walls: Walls, most: int = MOST_PLACES) -> None:
        self._walls = walls
        doors = [(door.start, door.end) for door in level.doors if door.start != door.end]
        self._closed_doors = Walls(doors + _find_posts(level), min(most, MOST_CELLS))
        lines = self._walls.ends + self._closed_doors.ends
        xs = [x for ax, _, bx, _ in lines for x in (ax, bx)] or [0.0]
        ys = [y for _, ay, _, by in lines for y in (ay, by)] or [0.0]
        width, depth = max(xs) - min(xs), max(ys) - min(ys)
        self._space = max(LATTICE, sqrt(width * depth / most), width / most, depth / most)
        # an odd fraction, so that walls at round numbers do not lie on the lattice
        self._left, self._bottom = min(xs) - 1.37 * self._space, min(ys) - 1.37 * self._space
        self.columns, self.rows = ceil(width / self._space) + 3, ceil(depth / self._space) + 3
        self._outside = bytearray(self.columns * self.rows)
        self.order: list[int] = []
        """Numbers of the places outside, in the order of their distance from the start of the flood fill."""
        self._flood(*self._find_barriers(lines))
        self.open_end: Point | None = next(self._open_ends(), None)
        """End of a wall, outside, at which no other wall goes on; None when there is none."""
        points = [point for ax, ay, bx, by in lines for point in ((ax, ay), (bx, by))]
        self._hull = _hull(points) if self.open_end is not None else []

    @property
    def outside(self) -> Iterator[Point]:
        """The places outside, in the order of their distance from the start of the flood fill, m."""
        return (self.place(at % self.columns, at // self.columns) for at in self.order)

    def place(self, i: int, j: int) -> Point:
        """Return a place of the lattice, m: number i of `columns` from the west, number j of `rows` from the south."""
        return self._left + i * self._space, self._bottom + j * self._space

    def _find_barriers(self, lines: list[tuple[float, float, float, float]]) -> tuple[bytearray, bytearray]:
        """Return flags of a line between each place and the next one to the east, and to the north.

        After the last place of a row or a column there always is a barrier."""
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
        order = self.order = [0]
        outside[0] = 1
        for at in order:  # it grows in the loop
            # west of the first column lies the last one, which has a barrier; south of the first row likewise
            for blocked, neighbour in (
                (east[at], at + 1),
                (east[at - 1], at - 1),
                (north[at], at + columns),
                (north[at - columns], at - columns),
            ):
                if not blocked and not outside[neighbour]:
                    outside[neighbour] = 1
                    order.append(neighbour)

    def _open_ends(self) -> Iterator[Point]:
        for own in (*self._walls.ends, *self._closed_doors.ends):
            for end in (own[:2], own[2:]):
                if self._near_outside(end) and not any(
                    [walls.is_continued(*end, own, OPEN_END) for walls in (self._walls, self._closed_doors)]
                ):
                    yield end

    def _near_outside(self, point: Point) -> bool:
        i, j = self._nearest(*point)
        return any(
            0 <= k < self.columns and 0 <= m < self.rows and self._outside[m * self.columns + k]
            for k in (i - 1, i, i + 1)
            for m in (j - 1, j, j + 1)
        )

    def _nearest(self, x: float, y: float) -> tuple[int, int]:
        return round((x - self._left) / self._space), round((y - self._bottom) / self._space)

    def inside(self, x: float, y: float) -> bool:
        """Return whether (x, y), m, is enclosed or, where the walls have open ends, within the hull of them all."""
        if self._hull:
            return all(
                side(*a, *b, x, y) >= 0 for a, b in zip(self._hull, (*self._hull[1:], self._hull[0]), strict=True)
            )
        if not (0.0 <= x - self._left <= self.columns * self._space
                and 0.0 <= y - self._bottom <= self.rows * self._space):  # fmt: skip
            return False
        i, j = self._nearest(x, y)
        for k, m in ((i, j), (i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)):
            if (
                0 <= k < self.columns
                and 0 <= m < self.rows
                and not any(walls.crosses(x, y, *self.place(k, m)) for walls in (self._walls, self._closed_doors))
            ):
                return not self._outside[m * self.columns + k]
        return True


def _lattice_crossings(a: Point, b: Point) -> Iterator[tuple[int, int, int]]:
    """Yield where the line from a to b, in coordinates (u, v), passes the lattice rows.

    For each whole number v it gives the first and the last whole number u after which the line passes on that row.
    Rather one too many than one too few."""
    low, high = ceil(min(a[1], b[1]) - _ON), floor(max(a[1], b[1]) + _ON)
    tall = b[1] - a[1]
    for v in range(low, high + 1):
        if abs(tall) <= 2.0 * _ON:
            yield v, floor(min(a[0], b[0]) - _ON), floor(max(a[0], b[0]) + _ON)
        else:
            u = a[0] + min(max((v - a[1]) / tall, 0.0), 1.0) * (b[0] - a[0])
            yield v, floor(u - _ON), floor(u + _ON)


def _find_posts(level: Level) -> list[tuple[Point, Point]]:
    """Return lines from the ends of doors to near ends of walls: a door may be drawn beside its gap."""
    ends: dict[tuple[int, int], list[Point]] = {}
    for x, y in dict.fromkeys(end for wall in level.walls for end in (wall.start, wall.end)):
        ends.setdefault((round(x / _POST), round(y / _POST)), []).append((x, y))
    found = set()
    for x, y in dict.fromkeys(end for door in level.doors for end in (door.start, door.end)):
        i, j = round(x / _POST), round(y / _POST)
        around = [end for k in (i - 1, i, i + 1) for m in (j - 1, j, j + 1) for end in ends.get((k, m), ())]
        found |= {((x, y), end) for end in around if 0.0 < hypot(end[0] - x, end[1] - y) <= _POST}
    return sorted(found)


def _hull(points: list[Point]) -> list[Point]:
    """Return the convex hull, counter-clockwise (Andrew 1979, Information Processing Letters 9)."""
    ordered = sorted(set(points))
    found: list[Point] = []
    for sequence in (ordered, ordered[::-1]):
        half: list[Point] = []
        for point in sequence:
            while len(half) >= 2 and side(*half[-2], *half[-1], *point) <= 0:
                half.pop()
            half.append(point)
        found += half[:-1]
    return found
