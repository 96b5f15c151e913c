"""Test whether a straight move of a candidate crosses a wall, over square cells.

A cell lists the walls within MAX_SHORT_MOVE of it, the nearest first, and its distance from that. A move shorter than
this distance crosses nothing. Other moves up to MAX_SHORT_MOVE are tested against the walls of their first cell: the
signed distances of both ends from a wall's line and of a wall's ends from the move's line decide for most of them, else
the exact test (geometry.py). Longer moves, which are rare, have this test with the walls of all cells along them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from math import dist, isfinite, sqrt

from .geometry import UNDERFLOW, direction, distance, touch
from .plan import Line

CELL_SIZE = 1.0
"""Side of a cell, m, in a plan of the usual size."""

MAX_SHORT_MOVE = 1.5
"""Longest move that is tested in one cell only, m: longer than a step, shorter than the width of a wide corridor."""

_MAX_SHORT_MOVE2 = MAX_SHORT_MOVE * MAX_SHORT_MOVE

_SIDE_MARGIN = 1e-6
"""Distance from a wall's line beyond which the side is certain, m: coordinates below 1e7 m are accurate to 1e-8 m."""

CELLS_PER_COLUMN = 65536.0
"""Factor of the column in the number of a cell: column times this plus row.

Column and row of a place are its x and y, divided by the side of a cell and rounded down. Far away, two cells may have
the same number: then a place is tested for nothing."""

_Wall = tuple[float, float, float, float, float, float, float]
"""(a, b, c) with a x + b y - c the signed distance from the wall's line, and the wall's ends ax, ay, bx, by."""


def find_range(a: float, b: float, size: float, reach: float = 0.0) -> range:
    """Return the columns or rows from a to b, m, and within `reach` m of these; `size` is the side of a cell, m."""
    return range(int((min(a, b) - reach) // size), int((max(a, b) + reach) // size) + 1)


def find_cells(line: Line, within: float, size: float) -> Iterator[tuple[float, float]]:
    """Yield the numbers of the cells with a place within `within` m of the line, and their least distances, m.

    The time grows with the length of the line, not with the area of its bounding box."""
    ax, ay, bx, by = line
    half = size * sqrt(0.5) + _SIDE_MARGIN  # from the centre of a cell to its corner
    reach = within + half
    for row in find_range(ay, by, size, reach):
        y = (row + 0.5) * size
        # the part of the line that is within reach of the row
        low, high = [min(max((y + up - ay) / (by - ay), 0.0), 1.0) if ay != by else up > 0.0 for up in (-reach, reach)]
        for column in find_range(ax + low * (bx - ax), ax + high * (bx - ax), size, reach):
            far = distance(*line, (column + 0.5) * size, y)
            if far <= reach:
                yield column * CELLS_PER_COLUMN + row, max(far - half, 0.0)


class Walls:
    """Straight walls in cells; none of them is a single point, and equal ones count once.

    `scale` is the side of a cell in units of CELL_SIZE."""

    __slots__ = ("_cells", "_size", "_walls", "scale")

    def __init__(self, walls: Iterable[Line], scale: float = 1.0) -> None:
        self.scale, self._size = scale, scale * CELL_SIZE
        self._walls = [_make_wall(*wall) for wall in dict.fromkeys(walls)]
        near: dict[float, list[tuple[float, _Wall]]] = {}
        for wall in self._walls:
            for cell, far in find_cells(wall[3:], MAX_SHORT_MOVE, self._size):
                near.setdefault(cell, []).append((far, wall))
        self._cells = {
            cell: (min(found)[0] ** 2, tuple([wall for _, wall in sorted(found)])) for cell, found in near.items()
        }

    def crosses(self, x0: float, y0: float, x1: float, y1: float) -> bool:
        """Return whether the straight move from (x0, y0) to (x1, y1), m, touches a wall; ends count.

        Exact for all finite floats. True for a move with an end that is NaN or infinite: no such move is possible."""
        dx, dy = x1 - x0, y1 - y0
        length2 = dx * dx + dy * dy
        if not length2 <= _MAX_SHORT_MOVE2:  # also if it is NaN
            return self._crosses_far((x0, y0, x1, y1))
        size = self._size
        cell = self._cells.get(x0 // size * CELLS_PER_COLUMN + y0 // size)
        if cell is None or length2 < cell[0]:
            return False
        margin = _SIDE_MARGIN * (abs(dx) + abs(dy)) + UNDERFLOW
        certain = margin + _SIDE_MARGIN * _SIDE_MARGIN  # distances differ by the move's length: then both are certain
        for a, b, c, ax, ay, bx, by in cell[1]:
            sides = (a * x0 + b * y0 - c) * (a * x1 + b * y1 - c)
            if sides > certain:
                continue
            if sides < -certain:  # the move crosses the wall's line: does it pass between its ends?
                left = dx * (ay - y0) - dy * (ax - x0)
                right = dx * (by - y0) - dy * (bx - x0)
                if left > margin < right or left < -margin > right:
                    continue
                if left > margin > -margin > right or left < -margin < margin < right:
                    return True
            if touch(ax, ay, bx, by, x0, y0, x1, y1):
                return True
        return False

    def _crosses_far(self, move: Line) -> bool:
        if not all(map(isfinite, move)):
            return True
        near: Iterable[_Wall] = self._walls
        if dist(move[:2], move[2:]) < self._size * len(self._walls):
            near = chain(*[self._list(cell) for cell, _ in find_cells(move, 0.0, self._size)])
        return any(touch(*wall[3:], *move) for wall in near)

    def _list(self, cell: float) -> tuple[_Wall, ...]:
        return self._cells.get(cell, (0.0, ()))[1]

    def near(self, x: float, y: float) -> list[Line]:
        """Return the walls within MAX_SHORT_MOVE of (x, y), m, and some more."""
        return [wall[3:] for wall in self._list(x // self._size * CELLS_PER_COLUMN + y // self._size)]

    def find_densest(self) -> tuple[int, float, float]:
        """Return the largest number of walls that one cell lists, and the middle of that cell, m."""
        count, cell = max([(len(found), cell) for cell, (_, found) in self._cells.items()], default=(0, 0.0))
        column = round(cell / CELLS_PER_COLUMN)
        return count, (column + 0.5) * self._size, (cell - column * CELLS_PER_COLUMN + 0.5) * self._size


def _make_wall(ax: float, ay: float, bx: float, by: float) -> _Wall:
    _, ux, uy = direction((ax, ay), (bx, by))
    return -uy, ux, ux * ay - uy * ax, ax, ay, bx, by
