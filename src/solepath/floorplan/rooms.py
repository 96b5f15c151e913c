"""Test whether a place is inside, on a level with rooms: in a room, a stairwell, a cabin, or on a doorstep."""

from __future__ import annotations

from math import ceil, sqrt

from .grid import Grid
from .outlines import Edges, Ring, edges, holds
from .plan import Level
from .segments import distance

DOORSTEP = 0.5
"""Distance from a door within which a place is inside, m.

Rooms are often drawn without the thickness of the wall between them."""

CELL = 0.5
MOST_CELLS = 30_000


class Rooms:
    """The rooms of a level in a grid.

    A cell that no outline crosses is inside or outside as a whole; the others know the edges that may decide. A test
    takes 0.4 us in the former, and 0.15 us for each edge in the latter."""

    __slots__ = ("_bottom", "_cells", "_columns", "_edge_cells", "_left", "_per_m", "_rows")

    def __init__(self, level: Level, outlines: tuple[Ring, ...], most: int = MOST_CELLS) -> None:
        """Index the level's rooms and `outlines` of stairwells and cabins in a grid of at most `most` cells."""
        rings = [edges(ring) for ring in dict.fromkeys((*level.rooms, *outlines)) if len(ring) >= 3]
        doors = [(*door.start, *door.end) for door in level.doors]
        grid = Grid([line for ring in rings for line in ring] + doors, DOORSTEP, CELL, most)
        self._left, self._bottom, self._per_m = grid.left, grid.bottom, grid.per_m
        self._columns, self._rows = grid.columns, grid.rows
        self._cells = bytearray(self._columns * self._rows)
        self._edge_cells: dict[int, tuple[list[Edges], list[tuple[float, float, float, float]]]] = {}
        self._index(grid, rings, doors)

    def _index(self, grid: Grid, rings: list[Edges], doors: list[tuple[float, float, float, float]]) -> None:
        half = grid.cell * sqrt(0.5) + 1e-6
        for ring in rings:
            crossed: dict[int, list[int]] = {}
            for at in {at for edge in ring for at, _ in grid.near(*edge, half)}:
                crossed.setdefault(at // self._columns, []).append(at)
            for j, beside in self._by_row(ring).items():
                self._fill(grid, j, beside, crossed.get(j, []))
                for at in crossed.get(j, ()):
                    self._edge_cells.setdefault(at, ([], []))[0].append(beside)
        for door in doors:
            for at, _ in grid.near(*door, half + DOORSTEP):
                self._edge_cells.setdefault(at, ([], []))[1].append(door)
        for at in [at for at in self._edge_cells if self._cells[at]]:
            del self._edge_cells[at]  # another room contains the whole cell

    def _by_row(self, ring: Edges) -> dict[int, Edges]:
        """Return the edges of a ring by the grid rows that they cross: only these matter for a place in the row."""
        found: dict[int, list[tuple[float, float, float, float]]] = {}
        for edge in ring:
            low, high = sorted([int((y - self._bottom) * self._per_m) for y in (edge[1], edge[3])])
            for j in range(low, high + 1):
                found.setdefault(j, []).append(edge)
        return {j: tuple(some) for j, some in found.items()}

    def _fill(self, grid: Grid, j: int, beside: Edges, crossed: list[int]) -> None:
        """Mark the cells of a row within a ring, except those that the ring crosses."""
        y = self._bottom + (j + 0.5) * grid.cell
        met = sorted([ax + (y - ay) * (bx - ax) / (by - ay) for ax, ay, bx, by in beside if (ay > y) != (by > y)])
        if not met:
            return
        row = bytearray(self._columns)
        for west, east in zip(met[::2], met[1::2], strict=False):
            first, last = [min(max(ceil((x - self._left) * self._per_m - 0.5), 0), self._columns) for x in (west, east)]
            row[first:last] = b"\1" * (last - first)
        row_start = j * self._columns
        for at in crossed:
            row[at - row_start] = 0
        both = int.from_bytes(self._cells[row_start : row_start + self._columns], "little") | int.from_bytes(
            row, "little"
        )
        self._cells[row_start : row_start + self._columns] = both.to_bytes(self._columns, "little")

    def inside(self, x: float, y: float) -> bool:
        """Return whether (x, y), m, is in a room; a place on an outline is in one of the rooms beside it or in none."""
        across, up = (x - self._left) * self._per_m, (y - self._bottom) * self._per_m
        if not (0.0 <= across < self._columns and 0.0 <= up < self._rows):
            return False
        at = int(up) * self._columns + int(across)
        edge_cell = self._edge_cells.get(at)
        if edge_cell is None:
            return bool(self._cells[at])
        rings, doors = edge_cell
        return any(holds(ring, x, y) for ring in rings) or any(distance(*door, x, y) <= DOORSTEP for door in doors)
