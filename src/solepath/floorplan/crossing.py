"""Test whether a straight move crosses a wall, over a uniform grid, for candidates and particles.

A cell of the grid knows the walls within REACH of it and its distance from the nearest wall. A move that is shorter
than this distance is free at once; other moves up to REACH are tested against the walls of their first cell; longer
ones against the walls of the cells on their way. The signed distances of both ends from a wall's line exclude most
walls; only where these are uncertain or the move goes through the line, the exact test (segments.py) decides.

Time for a step's move among 500 walls in rooms of 15 m^2, the mean over moves in all directions from anywhere: 2 us;
0.5 us in the open, 3 to 5 us where it does cross a wall; half as much again among 10,000 walls. A move of 4 m: 8 us.
Indexing takes about 0.05 ms and 1.2 kB for each wall, for long walls in proportion to their length.
tests/bench/floorplan.py measures it."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, hypot, isfinite, sqrt

from .grid import Grid
from .plan import Point
from .segments import distance, touch

REACH = 1.5
"""Longest move that needs one cell only, m: more than a step, less than a wide corridor."""

CELL = 0.5
"""Side of a cell, m; larger where the plan would have more than MOST_CELLS."""

MOST_CELLS = 100_000

_REACH2 = REACH * REACH

_CERTAIN = 1e-6
"""Distance from a wall's line beyond which the side is certain, m: below 1e7 m, coordinates are good to 1e-8."""

_Wall = tuple[float, float, float, float, float, float, float]
"""(a, b, c) with a x + b y - c the signed distance from the wall's line, and the wall's ends ax, ay, bx, by."""


class Walls:
    """Straight walls in a grid; `walls` are (start, end) in m, and none of them is a single point."""

    __slots__ = ("_all", "_bottom", "_clear", "_columns", "_left", "_near", "_per_m", "_rows")

    def __init__(self, walls: Sequence[tuple[Point, Point]], most: int = MOST_CELLS) -> None:
        """Index the walls in a grid of at most `most` cells."""
        self._all = [_make_wall(start, end) for start, end in dict.fromkeys(walls)]
        grid = Grid(self.ends, REACH + CELL, CELL, most)
        self._left, self._bottom, self._per_m = grid.left, grid.bottom, grid.per_m
        self._columns, self._rows = grid.columns, grid.rows
        self._near: list[tuple[_Wall, ...]] = [()] * (self._columns * self._rows)
        self._clear = [_REACH2] * (self._columns * self._rows)
        self._index(grid)

    def _index(self, grid: Grid) -> None:
        """Add every wall to the cells from which it can be reached."""
        half = grid.cell * sqrt(0.5) + 1e-6  # from the centre to a corner, and the rounding of the assignment to cells
        near: dict[int, list[_Wall]] = {}
        clear: dict[int, float] = {}
        for wall in self._all:
            for at, away in grid.near(*wall[3:], REACH + half):
                known = near.get(at)
                if known is None:
                    near[at], clear[at] = [wall], away
                else:
                    known.append(wall)
                    if away < clear[at]:
                        clear[at] = away
        for at, walls in near.items():
            self._near[at] = tuple(walls)
            self._clear[at] = max(sqrt(clear[at]) - half, 0.0) ** 2

    def crosses(self, x0: float, y0: float, x1: float, y1: float) -> bool:
        """Return whether the straight move from (x0, y0) to (x1, y1), m, touches a wall; ends count.

        Exact for all finite floats. True for a move with an end that is NaN or infinite: no such move is possible."""
        dx, dy = x1 - x0, y1 - y0
        long = dx * dx + dy * dy
        across, up = (x0 - self._left) * self._per_m, (y0 - self._bottom) * self._per_m
        if not long <= _REACH2:  # also if it is NaN
            return self._crosses_far(x0, y0, x1, y1)
        if not (0.0 <= across < self._columns and 0.0 <= up < self._rows):
            return False  # outside the grid no wall is within REACH
        at = int(up) * self._columns + int(across)
        if long < self._clear[at]:
            return False
        return _touches_any(self._near[at], x0, y0, x1, y1)

    @property
    def densest(self) -> tuple[int, Point]:
        """The largest number of walls that a move is tested against, and about where that is, m."""
        counts = [len(walls) for walls in self._near]
        at = max(range(len(counts)), key=counts.__getitem__)
        i, j = at % self._columns, at // self._columns
        return counts[at], (self._left + (i + 0.5) / self._per_m, self._bottom + (j + 0.5) / self._per_m)

    @property
    def ends(self) -> list[tuple[float, float, float, float]]:
        """(ax, ay, bx, by) of every wall, in the order given; equal walls appear once."""
        return [wall[3:] for wall in self._all]

    def is_continued(self, x: float, y: float, own: tuple[float, float, float, float], within: float) -> bool:
        """Return whether another wall than `own`, or a repetition of it, comes within `within` <= REACH, m."""
        same = (own, (own[2], own[3], own[0], own[1]))
        return any(wall[3:] not in same and distance(*wall[3:], x, y) <= within for wall in self._at(x, y))

    def _crosses_far(self, x0: float, y0: float, x1: float, y1: float) -> bool:
        if not (isfinite(x0) and isfinite(y0) and isfinite(x1) and isfinite(y1)):
            return True
        pieces = hypot(x1 - x0, y1 - y0) / (0.999 * REACH)
        if pieces > len(self._all) or max(abs(x0), abs(y0), abs(x1), abs(y1)) > 1e7:
            return any(touch(*wall[3:], x0, y0, x1, y1) for wall in self._all)
        count = ceil(pieces)
        dx, dy = (x1 - x0) / count, (y1 - y0) / count
        tried = None
        for k in range(count):
            near = self._at(x0 + k * dx, y0 + k * dy)
            if near is not tried and _touches_any(near, x0, y0, x1, y1):
                return True
            tried = near
        return False

    def _at(self, x: float, y: float) -> tuple[_Wall, ...]:
        """Return the walls that the cell of a place knows."""
        across, up = (x - self._left) * self._per_m, (y - self._bottom) * self._per_m
        inside = 0.0 <= across < self._columns and 0.0 <= up < self._rows
        return self._near[int(up) * self._columns + int(across)] if inside else ()


def _touches_any(walls: tuple[_Wall, ...], x0: float, y0: float, x1: float, y1: float) -> bool:
    for a, b, c, ax, ay, bx, by in walls:
        before = a * x0 + b * y0 - c
        after = a * x1 + b * y1 - c
        if before > _CERTAIN:
            if after > _CERTAIN:
                continue
        elif before < -_CERTAIN and after < -_CERTAIN:
            continue
        if touch(ax, ay, bx, by, x0, y0, x1, y1):
            return True
    return False


def _make_wall(start: Point, end: Point) -> _Wall:
    (ax, ay), (bx, by) = start, end
    long = hypot(bx - ax, by - ay)
    a, b = (ay - by) / long, (bx - ax) / long
    return a, b, a * ax + b * ay, ax, ay, bx, by
