"""Search for the named door at which a place is."""

from __future__ import annotations

from .grid import Grid
from .plan import Door, Level
from .segments import distance

REACH = 1.5
"""Largest distance of a place from a door at which it is at the door, m: two steps.

A wearer who walks through a door at 1.6 m/s takes two strides or more within it."""
EDGE_SHARE = 0.1
"""Share of a door's length at each end that a line to the door does not use, so that it does not touch the wall."""
CELL_SIZE = 2.0
"""Side of a cell, m; larger where the level would have more than MAX_CELLS."""
MAX_CELLS = 5000
"""Largest number of cells of a level."""


class DoorNames:
    """The named doors of a level in a grid; a cell lists those that may be within `REACH` of a place in it."""

    __slots__ = ("_bottom", "_cells", "_columns", "_left", "_per_m", "_rows")

    def __init__(self, level: Level, most: int = MAX_CELLS) -> None:
        """Index the level's doors that have a name in a grid of at most `most` cells."""
        named = [door for door in level.doors if door.name]
        grid = Grid([(*door.start, *door.end) for door in named], REACH, CELL_SIZE, most)
        self._left, self._bottom, self._per_m = grid.left, grid.bottom, grid.per_m
        self._columns, self._rows = grid.columns, grid.rows
        self._cells: dict[int, list[Door]] = {}
        for door in named:
            for cell, _ in grid.find_near(*door.start, *door.end, REACH + grid.cell):
                self._cells.setdefault(cell, []).append(door)

    def near(self, x: float, y: float) -> list[tuple[Door, float, float]]:
        """Return the doors within `REACH` of (x, y), m, the nearest first, each with its place nearest to (x, y)."""
        column, row = (x - self._left) * self._per_m, (y - self._bottom) * self._per_m
        if not (0.0 <= column < self._columns and 0.0 <= row < self._rows):  # also for NaN
            return []
        found = []
        for door in self._cells.get(int(row) * self._columns + int(column), ()):
            far = distance(*door.start, *door.end, x, y)
            if far <= REACH:
                found.append((far, door.name, door))
        return [(door, *_place_in(door, x, y)) for _, _, door in sorted(found, key=lambda one: one[:2])]


def _place_in(door: Door, x: float, y: float) -> tuple[float, float]:
    """Return the place between the posts of a door that is nearest to (x, y), m."""
    (ax, ay), (bx, by) = door.start, door.end
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    k = ((x - ax) * dx + (y - ay) * dy) / square if square > 0.0 else 0.5
    k = min(max(k, EDGE_SHARE), 1.0 - EDGE_SHARE)
    return (ax + k * dx, ay + k * dy)
