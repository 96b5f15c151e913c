"""Search for the name of the room at a place."""

from __future__ import annotations

from .grid import Grid
from .outlines import Edges, area, contains, edges
from .plan import Level

CELL_SIZE = 2.0
"""Side of a cell, m, about half of a small room's width; larger where the level would have more than MAX_CELLS."""
MAX_CELLS = 5000
"""Largest number of cells of a level: where every room covers all cells, the lists take 50 MB."""


class RoomNames:
    """The named rooms of a level in a grid.

    A cell lists the rooms that may be in it, the smallest first, each with its edges in the cell's row. A search takes
    1 us in a building of 100 rooms beside each other."""

    __slots__ = ("_bottom", "_cells", "_columns", "_left", "_per_m", "_rows")

    def __init__(self, level: Level, most: int = MAX_CELLS) -> None:
        """Index the level's rooms that have a name in a grid of at most `most` cells."""
        named = [(ring, name) for ring, name in zip(level.rooms, level.room_names, strict=True) if name]
        rooms = [(edges(ring), name) for ring, name in sorted(named, key=lambda room: abs(area(room[0])))]
        grid = Grid([edge for room_edges, _ in rooms for edge in room_edges], 0.0, CELL_SIZE, most)
        self._left, self._bottom, self._per_m = grid.left, grid.bottom, grid.per_m
        self._columns, self._rows = grid.columns, grid.rows
        self._cells: dict[int, list[tuple[Edges, str]]] = {}
        for room_edges, name in rooms:
            self._add(room_edges, name)

    def _add(self, room_edges: Edges, name: str) -> None:
        edges_by_row: dict[int, list[tuple[float, float, float, float]]] = {}
        for edge in room_edges:
            low, high = sorted([int((y - self._bottom) * self._per_m) for y in (edge[1], edge[3])])
            for row in range(low, high + 1):
                edges_by_row.setdefault(row, []).append(edge)
        for row, row_edges in edges_by_row.items():
            entry = (tuple(row_edges), name)
            ends = [x for ax, _, bx, _ in row_edges for x in (ax, bx)]
            first, last = [int((x - self._left) * self._per_m) for x in (min(ends), max(ends))]
            for cell in range(row * self._columns + first, row * self._columns + min(last + 1, self._columns)):
                self._cells.setdefault(cell, []).append(entry)

    def find(self, x: float, y: float) -> str | None:
        """Return the name of the smallest named room that contains (x, y), m; None when none does.

        A place on an outline is in one of the rooms beside it or in none."""
        column, row = (x - self._left) * self._per_m, (y - self._bottom) * self._per_m
        if 0.0 <= column < self._columns and 0.0 <= row < self._rows:  # False for NaN
            for row_edges, name in self._cells.get(int(row) * self._columns + int(column), ()):
                if contains(row_edges, x, y):
                    return name
        return None
