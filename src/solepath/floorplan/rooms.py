"""Test whether a place on a level with rooms is inside: in a room, a stairwell, an elevator cabin, or on a doorstep."""

from __future__ import annotations

from math import ceil, sqrt

from .grid import Grid
from .outlines import Edges, Ring, contains, edges
from .plan import Level
from .segments import distance

DOORSTEP_DISTANCE = 0.5
"""Distance from a door within which a place is inside, m.

Rooms are often drawn without the thickness of the wall between them."""

CELL_SIZE = 0.5
"""Side of a cell, m; larger where the level would have more than MAX_CELLS."""
MAX_CELLS = 30_000


class Rooms:
    """The rooms of a level in a grid.

    A cell that no outline crosses is inside or outside as a whole. Every other cell lists the edges of its row and the
    doors near it. A test takes 0.4 us in a cell of the first kind, and 0.15 us for each edge in the second."""

    __slots__ = ("_bottom", "_cells", "_columns", "_edge_cells", "_left", "_per_m", "_rows")

    def __init__(self, level: Level, outlines: tuple[Ring, ...], most: int = MAX_CELLS) -> None:
        """Index the level's rooms and `outlines` of stairwells and cabins in a grid of at most `most` cells."""
        rings = [edges(ring) for ring in dict.fromkeys((*level.rooms, *outlines)) if len(ring) >= 3]
        doors = [(*door.start, *door.end) for door in level.doors]
        grid = Grid([line for ring in rings for line in ring] + doors, DOORSTEP_DISTANCE, CELL_SIZE, most)
        self._left, self._bottom, self._per_m = grid.left, grid.bottom, grid.per_m
        self._columns, self._rows = grid.columns, grid.rows
        self._cells = bytearray(self._columns * self._rows)
        self._edge_cells: dict[int, tuple[list[Edges], list[tuple[float, float, float, float]]]] = {}
        self._index(grid, rings, doors)

    def _index(self, grid: Grid, rings: list[Edges], doors: list[tuple[float, float, float, float]]) -> None:
        half = grid.cell * sqrt(0.5) + 1e-6
        for ring in rings:
            crossed_by_row: dict[int, list[int]] = {}
            for cell in {cell for edge in ring for cell, _ in grid.find_near(*edge, half)}:
                crossed_by_row.setdefault(cell // self._columns, []).append(cell)
            for row, row_edges in self._group_by_row(ring).items():
                self._fill(grid, row, row_edges, crossed_by_row.get(row, []))
                for cell in crossed_by_row.get(row, ()):
                    self._edge_cells.setdefault(cell, ([], []))[0].append(row_edges)
        for door in doors:
            for cell, _ in grid.find_near(*door, half + DOORSTEP_DISTANCE):
                self._edge_cells.setdefault(cell, ([], []))[1].append(door)
        for cell in [cell for cell in self._edge_cells if self._cells[cell]]:
            del self._edge_cells[cell]  # another room contains the whole cell

    def _group_by_row(self, ring: Edges) -> dict[int, Edges]:
        """Return the edges of a ring by the grid rows that they cross: only these matter for a place in the row."""
        edges_by_row: dict[int, list[tuple[float, float, float, float]]] = {}
        for edge in ring:
            low, high = sorted([int((y - self._bottom) * self._per_m) for y in (edge[1], edge[3])])
            for row in range(low, high + 1):
                edges_by_row.setdefault(row, []).append(edge)
        return {row: tuple(row_edges) for row, row_edges in edges_by_row.items()}

    def _fill(self, grid: Grid, row_number: int, row_edges: Edges, crossed_cells: list[int]) -> None:
        """Mark the cells of a row within a ring, except those that the ring crosses."""
        y = self._bottom + (row_number + 0.5) * grid.cell
        crossings = sorted(
            [ax + (y - ay) * (bx - ax) / (by - ay) for ax, ay, bx, by in row_edges if (ay > y) != (by > y)]
        )
        if not crossings:
            return
        inside = bytearray(self._columns)
        for west, east in zip(crossings[::2], crossings[1::2], strict=False):
            first, last = [min(max(ceil((x - self._left) * self._per_m - 0.5), 0), self._columns) for x in (west, east)]
            inside[first:last] = b"\1" * (last - first)
        row = slice(row_number * self._columns, (row_number + 1) * self._columns)
        for cell in crossed_cells:
            inside[cell - row.start] = 0
        filled = int.from_bytes(self._cells[row], "little") | int.from_bytes(inside, "little")
        self._cells[row] = filled.to_bytes(self._columns, "little")

    def inside(self, x: float, y: float) -> bool:
        """Return whether (x, y), m, is inside; a place on an outline is in one of the rooms beside it or in none."""
        column, row = (x - self._left) * self._per_m, (y - self._bottom) * self._per_m
        if not (0.0 <= column < self._columns and 0.0 <= row < self._rows):
            return False
        cell = int(row) * self._columns + int(column)
        edge_cell = self._edge_cells.get(cell)
        if edge_cell is None:
            return bool(self._cells[cell])
        rings, doors = edge_cell
        return any(contains(ring, x, y) for ring in rings) or any(
            distance(*door, x, y) <= DOORSTEP_DISTANCE for door in doors
        )
