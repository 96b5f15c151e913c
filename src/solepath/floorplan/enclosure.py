"""What the walls of a level enclose, found by walking in from the outside with all doors shut."""

from __future__ import annotations

from math import ceil, hypot, sqrt

from .crossing import Walls
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


class Enclosure:
    """The places that one reaches from outside a level without going through a wall or a door. It costs about 2 us for
    each of them, 30 to 60 ms for a storey of 56 m by 63 m."""

    __slots__ = ("_bottom", "_columns", "_hull", "_left", "_outside", "_rows", "_solid", "_space", "open_end", "order")

    def __init__(self, level: Level) -> None:
        lines = [(wall.start, wall.end) for wall in level.walls]
        lines += [(door.start, door.end) for door in level.doors if door.start != door.end]
        lines += _posts(level)
        self._solid = Walls(lines)
        xs = [x for line in lines for x, _ in line] or [0.0]
        ys = [y for line in lines for _, y in line] or [0.0]
        width, depth = max(xs) - min(xs), max(ys) - min(ys)
        self._space = max(LATTICE, sqrt(width * depth / MOST_PLACES), width / MOST_PLACES, depth / MOST_PLACES)
        # an odd fraction, so that walls at round numbers do not lie on the lattice
        self._left, self._bottom = min(xs) - 1.37 * self._space, min(ys) - 1.37 * self._space
        self._columns, self._rows = ceil(width / self._space) + 3, ceil(depth / self._space) + 3
        self._outside = bytearray(self._columns * self._rows)
        self.order: list[Point] = []
        """The places outside, from the nearest to the farthest from the way in."""
        self._walk()
        self.open_end: Point | None = next((end for end in self._open_ends() if self._near_outside(end)), None)
        """An end of a wall, out of doors, at which no other wall goes on; None when there is none."""
        self._hull = _hull([point for line in lines for point in line]) if self.open_end is not None else []

    def _place(self, i: int, j: int) -> Point:
        return self._left + i * self._space, self._bottom + j * self._space

    def _walk(self) -> None:
        now = [(0, 0)]
        self._outside[0] = 1
        while now:
            later = []
            for i, j in now:
                x, y = self._place(i, j)
                self.order.append((x, y))
                for k, m in ((i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)):
                    if 0 <= k < self._columns and 0 <= m < self._rows and not self._outside[m * self._columns + k]:
                        there = self._place(k, m)
                        if not self._solid.crosses(x, y, *there):
                            self._outside[m * self._columns + k] = 1
                            later.append((k, m))
            now = later

    def _open_ends(self) -> list[Point]:
        return [
            (x, y)
            for ax, ay, bx, by in self._solid.ends
            for x, y in ((ax, ay), (bx, by))
            if not self._solid.joined(x, y, (ax, ay, bx, by), OPEN_END)
        ]

    def _near_outside(self, point: Point) -> bool:
        i, j = self._nearest(*point)
        return any(
            0 <= k < self._columns and 0 <= m < self._rows and self._outside[m * self._columns + k]
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
        if not (0.0 <= x - self._left <= self._columns * self._space
                and 0.0 <= y - self._bottom <= self._rows * self._space):  # fmt: skip
            return False
        i, j = self._nearest(x, y)
        for k, m in ((i, j), (i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)):
            if 0 <= k < self._columns and 0 <= m < self._rows and not self._solid.crosses(x, y, *self._place(k, m)):
                return not self._outside[m * self._columns + k]
        return True


def _posts(level: Level) -> list[tuple[Point, Point]]:
    """From the ends of each door to the ends of walls around them: a door may be drawn beside the gap that it is."""
    ends: dict[tuple[int, int], list[Point]] = {}
    for wall in level.walls:
        for x, y in (wall.start, wall.end):
            ends.setdefault((round(x / _POST), round(y / _POST)), []).append((x, y))
    found = set()
    for x, y in (end for door in level.doors for end in (door.start, door.end)):
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
