"""Is a place inside? Where a level has rooms: in one of them, in a stairwell or a cabin, or on a doorstep."""

from __future__ import annotations

from math import ceil, sqrt

from .grid import Grid
from .outlines import Edges, Ring, edges, holds
from .plan import Level
from .segments import distance

DOORSTEP = 0.5
"""m; a place this near to a door is inside: rooms are often drawn without the thickness of the wall between them."""

CELL = 0.5
MOST_CELLS = 30_000


class Rooms:
    """The rooms of a level in a grid. A cell that no outline passes is inside or outside as a whole; the others know
    the edges that may decide. A test costs 0.4 us in the former, and 0.15 us for each edge in the latter."""

    __slots__ = ("_bottom", "_cells", "_columns", "_edged", "_left", "_per_m", "_rows")

    def __init__(self, level: Level, outlines: tuple[Ring, ...], most: int = MOST_CELLS) -> None:
        """`outlines`: of stairwells and cabins on this level, beside its rooms. `most`: cells of the grid."""
        rings = [edges(ring) for ring in dict.fromkeys((*level.rooms, *outlines)) if len(ring) >= 3]
        doors = [(*door.start, *door.end) for door in level.doors]
        grid = Grid([line for ring in rings for line in ring] + doors, DOORSTEP, CELL, most)
        self._left, self._bottom, self._per_m = grid.left, grid.bottom, grid.per_m
        self._columns, self._rows = grid.columns, grid.rows
        self._cells = bytearray(self._columns * self._rows)
        self._edged: dict[int, tuple[list[Edges], list[tuple[float, float, float, float]]]] = {}
        self._sow(grid, rings, doors)

    def _sow(self, grid: Grid, rings: list[Edges], doors: list[tuple[float, float, float, float]]) -> None:
        half = grid.cell * sqrt(0.5) + 1e-6
        for ring in rings:
            passed: dict[int, list[int]] = {}
            for at in {at for edge in ring for at, _ in grid.near(*edge, half)}:
                passed.setdefault(at // self._columns, []).append(at)
            for j, beside in self._by_row(ring).items():
                self._fill(grid, j, beside, passed.get(j, []))
                for at in passed.get(j, ()):
                    self._edged.setdefault(at, ([], []))[0].append(beside)
        for door in doors:
            for at, _ in grid.near(*door, half + DOORSTEP):
                self._edged.setdefault(at, ([], []))[1].append(door)
        for at in [at for at in self._edged if self._cells[at]]:
            del self._edged[at]  # another room holds all of the cell

    def _by_row(self, ring: Edges) -> dict[int, Edges]:
        """The edges of a ring by the rows of the grid that they pass: others do not count for a place in the row."""
        found: dict[int, list[tuple[float, float, float, float]]] = {}
        for edge in ring:
            low, high = sorted([int((y - self._bottom) * self._per_m) for y in (edge[1], edge[3])])
            for j in range(low, high + 1):
                found.setdefault(j, []).append(edge)
        return {j: tuple(some) for j, some in found.items()}

    def _fill(self, grid: Grid, j: int, beside: Edges, passed: list[int]) -> None:
        """The cells of a row within a ring, but for those that it passes."""
        y = self._bottom + (j + 0.5) * grid.cell
        met = sorted([ax + (y - ay) * (bx - ax) / (by - ay) for ax, ay, bx, by in beside if (ay > y) != (by > y)])
        if not met:
            return
        row = bytearray(self._columns)
        for west, east in zip(met[::2], met[1::2], strict=False):
            first, last = [min(max(ceil((x - self._left) * self._per_m - 0.5), 0), self._columns) for x in (west, east)]
            row[first:last] = b"\1" * (last - first)
        begin = j * self._columns
        for at in passed:
            row[at - begin] = 0
        both = int.from_bytes(self._cells[begin : begin + self._columns], "little") | int.from_bytes(row, "little")
        self._cells[begin : begin + self._columns] = both.to_bytes(self._columns, "little")

    def inside(self, x: float, y: float) -> bool:
        """Whether (x, y), m, is in a room. On an outline it is in one of the rooms beside it or in none."""
        across, up = (x - self._left) * self._per_m, (y - self._bottom) * self._per_m
        if not (0.0 <= across < self._columns and 0.0 <= up < self._rows):
            return False
        at = int(up) * self._columns + int(across)
        edged = self._edged.get(at)
        if edged is None:
            return bool(self._cells[at])
        rings, doors = edged
        return any(holds(ring, x, y) for ring in rings) or any(distance(*door, x, y) <= DOORSTEP for door in doors)
