"""Is a place inside? Where a level has rooms: in one of them, in a stairwell or a cabin, or on a doorstep."""

from __future__ import annotations

from math import ceil, sqrt

from .outlines import Edges, Ring, edges, holds
from .plan import Level, Point
from .segments import distance

DOORSTEP = 0.5
"""m; a place this near to a door is inside: rooms are often drawn without the thickness of the wall between them."""

CELL = 0.5
MOST_CELLS = 30_000


class Rooms:
    """The rooms of a level in a grid. A cell that no outline passes is inside or outside as a whole; the others know
    the outlines that may decide. A test costs 0.4 us in the former, and 0.15 us for each edge in the latter."""

    __slots__ = ("_bottom", "_cells", "_columns", "_doors", "_edged", "_left", "_per_m", "_rings", "_rows")

    def __init__(self, level: Level, outlines: tuple[Ring, ...]) -> None:
        """`outlines`: of stairwells and cabins on this level, beside its rooms."""
        self._rings = [edges(ring) for ring in (*level.rooms, *outlines) if len(ring) >= 3]
        self._doors = [(*door.start, *door.end) for door in level.doors]
        lines = [line for ring in self._rings for line in ring] + self._doors
        xs = [x for ax, _, bx, _ in lines for x in (ax, bx)] or [0.0]
        ys = [y for _, ay, _, by in lines for y in (ay, by)] or [0.0]
        width, depth = max(xs) - min(xs) + 2.0 * DOORSTEP, max(ys) - min(ys) + 2.0 * DOORSTEP
        cell = max(CELL, sqrt(width * depth / MOST_CELLS), width / MOST_CELLS, depth / MOST_CELLS)
        self._left, self._bottom, self._per_m = min(xs) - DOORSTEP, min(ys) - DOORSTEP, 1.0 / cell
        self._columns, self._rows = ceil(width / cell), ceil(depth / cell)
        self._cells = bytearray(self._columns * self._rows)
        self._edged: dict[int, tuple[list[Edges], list[tuple[float, float, float, float]]]] = {}
        self._sow(cell)

    def _sow(self, cell: float) -> None:
        half = cell * sqrt(0.5) + 1e-6
        for ring in self._rings:
            boxed = self._boxed(ring)
            passed = set().union(*(self._passed(edge, half, cell) for edge in ring))
            for at in boxed:
                if at in passed:
                    self._edged.setdefault(at, ([], []))[0].append(ring)
                elif holds(ring, *self._centre(at, cell)):
                    self._cells[at] = 1
        for door in self._doors:
            for at in self._passed(door, half + DOORSTEP, cell):
                self._edged.setdefault(at, ([], []))[1].append(door)
        for at in [at for at in self._edged if self._cells[at]]:
            del self._edged[at]  # another room holds all of the cell

    def _centre(self, at: int, cell: float) -> Point:
        return self._left + (at % self._columns + 0.5) * cell, self._bottom + (at // self._columns + 0.5) * cell

    def _boxed(self, lines: Edges, more: float = 0.0) -> list[int]:
        xs = [x for ax, _, bx, _ in lines for x in (ax, bx)]
        ys = [y for _, ay, _, by in lines for y in (ay, by)]
        across = self._span(min(xs) - more - self._left, max(xs) + more - self._left, self._columns)
        up = self._span(min(ys) - more - self._bottom, max(ys) + more - self._bottom, self._rows)
        return [j * self._columns + i for j in up for i in across]

    def _span(self, low: float, high: float, count: int) -> range:
        return range(max(int(low * self._per_m), 0), min(int(high * self._per_m) + 1, count))

    def _passed(self, edge: tuple[float, float, float, float], near: float, cell: float) -> list[int]:
        return [at for at in self._boxed((edge,), near) if distance(*edge, *self._centre(at, cell)) <= near]

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
