"""What the walls of a level enclose, found by walking in from the outside with all doors shut."""

from __future__ import annotations

from collections.abc import Iterator
from math import ceil, floor, hypot, sqrt

from .crossing import MOST_CELLS, Walls
from .doors import BESIDE
from .plan import Level, Point
from .segments import side

LATTICE = 0.5
"""m between the places that are tried: a gap in a wall along the axes that is wider than this is found, a slanting one
from 0.7 m on. More where there would be more than MOST_PLACES."""

MOST_PLACES = 30_000

_POST = BESIDE + 0.05
"""m; a wall's end this near to a door's is the door's post."""

OPEN_END = 0.05
"""m; a wall's end farther than this from all other walls and doors is an open end."""

_ON = 1e-9
"""Of the lattice's spacing: a wall that passes a place of the lattice by less goes through it."""


class Enclosure:
    """The places that one reaches from outside a level without going through a wall or a door. It costs about 1 us for
    each of them, 15 to 30 ms for a storey of 56 m by 63 m. `walls`: of the level. `most`: places that are tried."""

    __slots__ = ("_bottom", "_hull", "_left", "_outside", "_shut", "_space", "_walls", "columns", "open_end", "order",
                 "rows")  # fmt: skip

    def __init__(self, level: Level, walls: Walls, most: int = MOST_PLACES) -> None:
        self._walls = walls
        self._shut = Walls([(door.start, door.end) for door in level.doors if door.start != door.end] + _posts(level),
                           min(most, MOST_CELLS))  # fmt: skip
        lines = self._walls.ends + self._shut.ends
        xs = [x for ax, _, bx, _ in lines for x in (ax, bx)] or [0.0]
        ys = [y for _, ay, _, by in lines for y in (ay, by)] or [0.0]
        width, depth = max(xs) - min(xs), max(ys) - min(ys)
        self._space = max(LATTICE, sqrt(width * depth / most), width / most, depth / most)
        # an odd fraction, so that walls at round numbers do not lie on the lattice
        self._left, self._bottom = min(xs) - 1.37 * self._space, min(ys) - 1.37 * self._space
        self.columns, self.rows = ceil(width / self._space) + 3, ceil(depth / self._space) + 3
        self._outside = bytearray(self.columns * self.rows)
        self.order: list[int] = []
        """The places outside, from the nearest to the farthest from the way in, by number."""
        self._walk(*self._barred(lines))
        self.open_end: Point | None = next(self._open_ends(), None)
        """An end of a wall, out of doors, at which no other wall goes on; None when there is none."""
        points = [point for ax, ay, bx, by in lines for point in ((ax, ay), (bx, by))]
        self._hull = _hull(points) if self.open_end is not None else []

    @property
    def outside(self) -> Iterator[Point]:
        """The places outside, from the nearest to the farthest from the way in, m."""
        return (self.place(at % self.columns, at // self.columns) for at in self.order)

    def place(self, i: int, j: int) -> Point:
        """Of the lattice, m: number i of `columns` from the west, number j of `rows` from the south."""
        return self._left + i * self._space, self._bottom + j * self._space

    def _barred(self, lines: list[tuple[float, float, float, float]]) -> tuple[bytearray, bytearray]:
        """Whether there is a line between each place and the next one to the east, and to the north. Beyond the last
        one of a row or a column there always is."""
        columns, rows, per_m = self.columns, self.rows, 1.0 / self._space
        east, north = bytearray(columns * rows), bytearray(columns * rows)
        east[columns - 1 :: columns] = b"\1" * rows
        north[-columns:] = b"\1" * columns
        for ax, ay, bx, by in lines:
            a, b = ((ax - self._left) * per_m, (ay - self._bottom) * per_m), (
                (bx - self._left) * per_m, (by - self._bottom) * per_m)  # fmt: skip
            for j, first, last in _met(a, b):
                for i in range(first, last + 1):
                    east[j * columns + i] = 1
            for i, first, last in _met(a[::-1], b[::-1]):
                for j in range(first, last + 1):
                    north[j * columns + i] = 1
        return east, north

    def _walk(self, east: bytearray, north: bytearray) -> None:
        outside, columns = self._outside, self.columns
        order = self.order = [0]
        outside[0] = 1
        for at in order:  # which grows meanwhile
            # to the west of the first column lies the last one, which is barred; to the south of the first row likewise
            for barred, there in (
                (east[at], at + 1),
                (east[at - 1], at - 1),
                (north[at], at + columns),
                (north[at - columns], at - columns),
            ):
                if not barred and not outside[there]:
                    outside[there] = 1
                    order.append(there)

    def _open_ends(self) -> Iterator[Point]:
        for own in (*self._walls.ends, *self._shut.ends):
            for end in (own[:2], own[2:]):
                if self._near_outside(end) and not any(
                    [walls.joined(*end, own, OPEN_END) for walls in (self._walls, self._shut)]
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
        """Whether (x, y), m, is enclosed; where the walls have open ends, whether it is within the hull of them all."""
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
                and not any(walls.crosses(x, y, *self.place(k, m)) for walls in (self._walls, self._shut))
            ):
                return not self._outside[m * self.columns + k]
        return True


def _met(a: Point, b: Point) -> Iterator[tuple[int, int, int]]:
    """The whole numbers v that the line from a to b, (u, v), passes, each with the first and the last of the whole
    numbers u from which on to the next it passes there. Rather one too many than one too few."""
    low, high = ceil(min(a[1], b[1]) - _ON), floor(max(a[1], b[1]) + _ON)
    tall = b[1] - a[1]
    for v in range(low, high + 1):
        if abs(tall) <= 2.0 * _ON:
            yield v, floor(min(a[0], b[0]) - _ON), floor(max(a[0], b[0]) + _ON)
        else:
            u = a[0] + min(max((v - a[1]) / tall, 0.0), 1.0) * (b[0] - a[0])
            yield v, floor(u - _ON), floor(u + _ON)


def _posts(level: Level) -> list[tuple[Point, Point]]:
    """From the ends of each door to the ends of walls around them: a door may be drawn beside the gap that it is."""
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
    """The convex hull, counter-clockwise (Andrew 1979, Information Processing Letters 9)."""
    ordered = sorted(set(points))
    found: list[Point] = []
    for way in (ordered, ordered[::-1]):
        half: list[Point] = []
        for point in way:
            while len(half) >= 2 and side(*half[-2], *half[-1], *point) <= 0:
                half.pop()
            half.append(point)
        found += half[:-1]
    return found
