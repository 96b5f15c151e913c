"""A uniform grid over straight lines, with a search for the cells near a line."""

from __future__ import annotations

from collections.abc import Iterable
from math import ceil, hypot, sqrt

_ROUNDING = 1e-6
"""Margin for the rounding error of the ends of a row's range, m."""

MAX_CELLS_PER_PLAN = 2_000_000
"""Largest number of cells of the grids of all levels of a plan together."""
MAX_LATTICE_POINTS_PER_PLAN = 500_000
"""Largest number of points of the lattices (enclosure.py) of all levels of a plan together."""
_MIN_CELLS = 64


def share_limit(limit: int, total_limit: int, count: int) -> int:
    """Return the largest number of cells or points for each of `count` grids: `limit`, or its share of `total_limit`.

    A grid of fewer, larger cells gives the same answers and takes longer; a coarser lattice misses narrower gaps."""
    return max(min(limit, total_limit // max(count, 1)), _MIN_CELLS)


class Grid:
    """A grid of square cells over all lines (ax, ay, bx, by), m, with a `margin` around them.

    A cell's number counts along x, then along y. `cell` is the side of a cell, m; the grid uses a larger side where
    there would be more than `max_cells` cells."""

    __slots__ = ("bottom", "cell", "columns", "left", "per_m", "rows")

    def __init__(
        self, lines: Iterable[tuple[float, float, float, float]], margin: float, cell: float, max_cells: int
    ) -> None:
        all_lines = list(lines) or [(0.0, 0.0, 0.0, 0.0)]
        self.left = min([min(ax, bx) for ax, _, bx, _ in all_lines]) - margin
        self.bottom = min([min(ay, by) for _, ay, _, by in all_lines]) - margin
        width = max([max(ax, bx) for ax, _, bx, _ in all_lines]) + margin - self.left
        depth = max([max(ay, by) for _, ay, _, by in all_lines]) + margin - self.bottom
        self.cell = max(cell, sqrt(width * depth / max_cells), width / max_cells, depth / max_cells)
        self.per_m = 1.0 / self.cell
        self.columns, self.rows = max(ceil(width / self.cell), 1), max(ceil(depth / self.cell), 1)

    def find_near(self, ax: float, ay: float, bx: float, by: float, within: float) -> list[tuple[int, float]]:
        """Return the cells whose centres are within `within` m of the line, with their squared distances, m^2.

        The time grows with the length of the line, not with the area of its bounding box."""
        dx, dy = bx - ax, by - ay
        length2, within2 = dx * dx + dy * dy, within * within
        per_length2 = 1.0 / length2 if length2 > 0.0 else 0.0
        west, east = min(ax, bx) - within - _ROUNDING, max(ax, bx) + within + _ROUNDING
        is_flat = abs(dy) <= 1e-4 * abs(dx) or dy == 0.0  # a nearly horizontal line is in a few rows
        slope, half = (0.0, 0.0) if is_flat else (dx / dy, within * hypot(dx, dy) / abs(dy) + _ROUNDING)
        cells = []
        for j in self._span(min(ay, by) - within - self.bottom, max(ay, by) + within - self.bottom, self.rows):
            y = self.bottom + (j + 0.5) * self.cell - ay
            first, last = west, east
            if not is_flat:
                middle = ax + y * slope
                first, last = max(first, middle - half), min(last, middle + half)
            for i in self._span(first - self.left, last - self.left, self.columns):
                x = self.left + (i + 0.5) * self.cell - ax
                along = (x * dx + y * dy) * per_length2
                if along < 0.0:
                    along = 0.0
                elif along > 1.0:
                    along = 1.0
                ex, ey = x - along * dx, y - along * dy
                distance2 = ex * ex + ey * ey
                if distance2 <= within2:
                    cells.append((j * self.columns + i, distance2))
        return cells

    def _span(self, low: float, high: float, count: int) -> range:
        return range(max(int(low * self.per_m), 0), min(int(high * self.per_m) + 1, count))
