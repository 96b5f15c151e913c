"""Search for the rooms and the doors at a place, over square cells."""

from __future__ import annotations

from collections.abc import Iterable

from .geometry import Ring, area, contains, distance, edges, share_along
from .plan import Door, Level, Line, Point
from .walls import CELLS_PER_COLUMN, find_cells, find_range

CELL_SIZE = 2.0
"""Side of a cell, m, in a plan of the usual size: about half of a small room's width."""

DOORSTEP_DISTANCE = 0.5
"""Distance from a door within which a place is inside, m.

Rooms are often drawn without the thickness of the wall between them."""

DOOR_DISTANCE = 1.5
"""Largest distance of a place from a door at which it is at the door, m: two steps.

A wearer who walks through a door at 1.6 m/s takes two strides or more within it."""

EDGE_SHARE = 0.1
"""Share of a door's length at each end that a line to the door does not use, so that it does not touch the wall."""


class Rooms:
    """The rooms and doors of a level, and `outlines` of its stairwells and cabins, which are rooms without a name.

    A cell lists the rooms that may be in it, the smallest first, each with its edges in the cell's row, and the doors
    that may be within DOOR_DISTANCE. `scale` is the side of a cell in units of CELL_SIZE."""

    __slots__ = ("_cells", "_size")

    def __init__(self, level: Level, outlines: Iterable[Ring], scale: float = 1.0) -> None:
        self._size = scale * CELL_SIZE
        self._cells: dict[float, tuple[list[tuple[list[Line], str]], list[Door]]] = {}
        names = level.room_names or [""] * len(level.rooms)
        rings = [*zip(level.rooms, names, strict=True), *[(outline, "") for outline in outlines if outline]]
        for ring, name in sorted(rings, key=lambda room: abs(area(room[0]))):
            self._add(ring, name)
        for door in level.doors:
            for cell, _ in find_cells(door.line, DOOR_DISTANCE, self._size):
                self._cells.setdefault(cell, ([], []))[1].append(door)

    def _add(self, ring: Ring, name: str) -> None:
        rows: dict[int, list[Line]] = {}
        for edge in edges(ring):
            for row in find_range(edge[1], edge[3], self._size):
                rows.setdefault(row, []).append(edge)
        for row, lines in rows.items():
            xs = [x for ax, _, bx, _ in lines for x in (ax, bx)]
            for column in find_range(min(xs), max(xs), self._size):
                self._cells.setdefault(column * CELLS_PER_COLUMN + row, ([], []))[0].append((lines, name))

    def _list(self, x: float, y: float) -> tuple[list[tuple[list[Line], str]], list[Door]]:
        return self._cells.get(x // self._size * CELLS_PER_COLUMN + y // self._size, ([], []))

    def find(self, x: float, y: float) -> list[str]:
        """Return the names of the rooms that contain (x, y), m, the smallest first, "" for one without a name.

        A place on an outline is in one of the rooms beside it or in none."""
        return [name for lines, name in self._list(x, y)[0] if contains(lines, x, y)]

    def inside(self, x: float, y: float) -> bool:
        """Return whether (x, y), m, is in a room, a stairwell or an elevator cabin, or on a doorstep."""
        doors = self._list(x, y)[1]
        return bool(self.find(x, y)) or any([distance(*door.line, x, y) <= DOORSTEP_DISTANCE for door in doors])

    def find_doors(self, x: float, y: float) -> list[tuple[float, str, Point]]:
        """Return the doors within DOOR_DISTANCE of (x, y), m, the nearest first.

        Each has its distance, m, its name, and its place between the posts that is nearest to (x, y)."""
        doors = [(distance(*door.line, x, y), door) for door in self._list(x, y)[1]]
        return sorted([(far, door.name, _find_place(door.line, x, y)) for far, door in doors if far <= DOOR_DISTANCE])


def _find_place(door: Line, x: float, y: float) -> Point:
    ax, ay, bx, by = door
    k = min(max(share_along(*door, x, y), EDGE_SHARE), 1.0 - EDGE_SHARE)
    return ax + k * (bx - ax), ay + k * (by - ay)
