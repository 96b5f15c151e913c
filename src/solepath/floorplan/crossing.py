"""Test whether a straight move of a candidate crosses a wall, over a uniform grid.

A cell of the grid lists the walls within MAX_SHORT_MOVE of it and its distance from the nearest wall. A move that is
shorter than this distance crosses nothing. Other moves up to MAX_SHORT_MOVE are tested against the walls of their first
cell, and longer moves against the walls of all cells along them. The signed distances of both ends from a wall's line
and of a wall's ends from the move's line decide for most walls; else the exact test (segments.py) does."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, hypot, isfinite, sqrt

from .grid import Grid
from .plan import Point
from .segments import distance, touch

MAX_SHORT_MOVE = 1.5
"""Longest move that is tested in one cell only, m: longer than a step, shorter than the width of a wide corridor."""

CELL_SIZE = 0.5
"""Side of a cell, m; larger where the plan would have more than MAX_CELLS."""

MAX_CELLS = 100_000

_MAX_SHORT_MOVE2 = MAX_SHORT_MOVE * MAX_SHORT_MOVE

_PIECE_SHARE = 0.999
"""Longest piece of a long move, as a share of MAX_SHORT_MOVE: rounding must not make a piece longer than that."""

_SIDE_MARGIN = 1e-6
"""Distance from a wall's line beyond which the side is certain, m: coordinates below 1e7 m are accurate to 1e-8 m."""

_UNDERFLOW = 1e-300
"""Bound above the loss by underflow of a product, m^2."""

_Wall = tuple[float, float, float, float, float, float, float]
"""(a, b, c) with a x + b y - c the signed distance from the wall's line, and the wall's ends ax, ay, bx, by."""


class Walls:
    """Straight walls in a grid; `walls` are (start, end) in m, and none of them is a single point."""

    __slots__ = ("_wall_lines", "_bottom", "_free_distances2", "_columns", "_left", "_walls_near", "_per_m", "_rows")

    def __init__(self, walls: Sequence[tuple[Point, Point]], most: int = MAX_CELLS) -> None:
        """Index the walls in a grid of at most `most` cells."""
        self._wall_lines = [_make_wall(start, end) for start, end in dict.fromkeys(walls)]
        grid = Grid(self.ends, MAX_SHORT_MOVE + CELL_SIZE, CELL_SIZE, most)
        self._left, self._bottom, self._per_m = grid.left, grid.bottom, grid.per_m
        self._columns, self._rows = grid.columns, grid.rows
        self._walls_near: list[tuple[_Wall, ...]] = [()] * (self._columns * self._rows)
        self._free_distances2 = [_MAX_SHORT_MOVE2] * (self._columns * self._rows)
        self._index(grid)

    def _index(self, grid: Grid) -> None:
        """Add every wall to the cells from which it can be reached."""
        # from a cell's centre to its corner, m, with a margin for the rounding of the assignment to cells
        half_diagonal = grid.cell * sqrt(0.5) + 1e-6
        walls_by_cell: dict[int, list[_Wall]] = {}
        distances2: dict[int, float] = {}
        for wall in self._wall_lines:
            for cell, distance2 in grid.find_near(*wall[3:], MAX_SHORT_MOVE + half_diagonal):
                cell_walls = walls_by_cell.get(cell)
                if cell_walls is None:
                    walls_by_cell[cell], distances2[cell] = [wall], distance2
                else:
                    cell_walls.append(wall)
                    if distance2 < distances2[cell]:
                        distances2[cell] = distance2
        for cell, walls in walls_by_cell.items():
            self._walls_near[cell] = tuple(walls)
            self._free_distances2[cell] = max(sqrt(distances2[cell]) - half_diagonal, 0.0) ** 2

    def crosses(self, x0: float, y0: float, x1: float, y1: float) -> bool:
        """Return whether the straight move from (x0, y0) to (x1, y1), m, touches a wall; ends count.

        Exact for all finite floats. True for a move with an end that is NaN or infinite: no such move is possible."""
        dx, dy = x1 - x0, y1 - y0
        length2 = dx * dx + dy * dy
        column, row = (x0 - self._left) * self._per_m, (y0 - self._bottom) * self._per_m
        if not length2 <= _MAX_SHORT_MOVE2:  # also if it is NaN
            return self._crosses_far(x0, y0, x1, y1)
        if not (0.0 <= column < self._columns and 0.0 <= row < self._rows):
            return False  # outside the grid no wall is within MAX_SHORT_MOVE
        cell = int(row) * self._columns + int(column)
        if length2 < self._free_distances2[cell]:
            return False
        return _touches_any(self._walls_near[cell], x0, y0, x1, y1)

    @property
    def densest_cell(self) -> tuple[int, Point]:
        """The largest number of walls listed by one cell, and the centre of that cell, m."""
        counts = [len(walls) for walls in self._walls_near]
        cell = max(range(len(counts)), key=counts.__getitem__)
        i, j = cell % self._columns, cell // self._columns
        return counts[cell], (self._left + (i + 0.5) / self._per_m, self._bottom + (j + 0.5) / self._per_m)

    @property
    def ends(self) -> list[tuple[float, float, float, float]]:
        """The ends (ax, ay, bx, by) of every wall, m, in the given order; equal walls appear once."""
        return [wall[3:] for wall in self._wall_lines]

    def has_wall_near(self, x: float, y: float, excluded: tuple[float, float, float, float], within: float) -> bool:
        """Return whether a wall other than `excluded` is within `within` m, at most MAX_SHORT_MOVE, of (x, y)."""
        both_ways = (excluded, (excluded[2], excluded[3], excluded[0], excluded[1]))
        return any(wall[3:] not in both_ways and distance(*wall[3:], x, y) <= within for wall in self._walls_at(x, y))

    def _crosses_far(self, x0: float, y0: float, x1: float, y1: float) -> bool:
        if not (isfinite(x0) and isfinite(y0) and isfinite(x1) and isfinite(y1)):
            return True
        pieces = hypot(x1 - x0, y1 - y0) / (_PIECE_SHARE * MAX_SHORT_MOVE)
        if pieces > len(self._wall_lines) or max(abs(x0), abs(y0), abs(x1), abs(y1)) > 1e7:
            return any(touch(*wall[3:], x0, y0, x1, y1) for wall in self._wall_lines)
        count = ceil(pieces)
        dx, dy = (x1 - x0) / count, (y1 - y0) / count
        tested = None
        for k in range(count):
            cell_walls = self._walls_at(x0 + k * dx, y0 + k * dy)
            if cell_walls is not tested and _touches_any(cell_walls, x0, y0, x1, y1):
                return True
            tested = cell_walls
        return False

    def _walls_at(self, x: float, y: float) -> tuple[_Wall, ...]:
        """Return the walls that the cell of (x, y) lists."""
        column, row = (x - self._left) * self._per_m, (y - self._bottom) * self._per_m
        inside = 0.0 <= column < self._columns and 0.0 <= row < self._rows
        return self._walls_near[int(row) * self._columns + int(column)] if inside else ()


def _touches_any(walls: tuple[_Wall, ...], x0: float, y0: float, x1: float, y1: float) -> bool:
    dx, dy = x1 - x0, y1 - y0
    margin = _SIDE_MARGIN * (abs(dx) + abs(dy)) + _UNDERFLOW
    for a, b, c, ax, ay, bx, by in walls:
        before = a * x0 + b * y0 - c
        after = a * x1 + b * y1 - c
        if before > _SIDE_MARGIN:
            if after > _SIDE_MARGIN:
                continue
            is_across = after < -_SIDE_MARGIN
        elif before < -_SIDE_MARGIN:
            if after < -_SIDE_MARGIN:
                continue
            is_across = after > _SIDE_MARGIN
        else:
            is_across = False
        if is_across:  # the move crosses the wall's line: does it pass between its ends?
            left = dx * (ay - y0) - dy * (ax - x0)
            right = dx * (by - y0) - dy * (bx - x0)
            if left > margin:
                if right > margin:
                    continue
                if right < -margin:
                    return True
            elif left < -margin:
                if right < -margin:
                    continue
                if right > margin:
                    return True
        if touch(ax, ay, bx, by, x0, y0, x1, y1):
            return True
    return False


def _make_wall(start: Point, end: Point) -> _Wall:
    (ax, ay), (bx, by) = start, end
    length = hypot(bx - ax, by - ay)
    a, b = (ay - by) / length, (bx - ax) / length
    return a, b, a * ax + b * ay, ax, ay, bx, by
