"""A uniform grid over straight lines, with a search for the cells near a line."""

from __future__ import annotations

from collections.abc import Iterable
from math import ceil, hypot, sqrt

_ROUNDING = 1e-6
"""Margin, m, above the rounding error of the ends of a row's range."""

CELLS = 2_000_000
"""Largest number of cells of the grids of all levels of a plan together."""
PLACES = 500_000
"""Largest number of places of the lattices (enclosure.py) of all levels of a plan together."""


def share(most: int, in_all: int, count: int) -> int:
    """Return the largest number of cells of one of `count` grids: `most`, less where all would exceed `in_all`.

    With fewer cells, the cells are larger: the answers stay the same and take longer."""
    return max(min(most, in_all // max(count, 1)), 64)


class Grid:
    """Square cells over all lines (ax, ay, bx, by), m, with a `margin` around them.

    A cell's number counts along x, then along y. `cell` is its side, m; it is larger where there would be more than
    `most` cells."""

    __slots__ = ("bottom", "cell", "columns", "left", "per_m", "rows")

    def __init__(
        self, lines: Iterable[tuple[float, float, float, float]], margin: float, cell: float, most: int
    ) -> None:
        known = list(lines) or [(0.0, 0.0, 0.0, 0.0)]
        self.left = min([min(ax, bx) for ax, _, bx, _ in known]) - margin
        self.bottom = min([min(ay, by) for _, ay, _, by in known]) - margin
        width = max([max(ax, bx) for ax, _, bx, _ in known]) + margin - self.left
        depth = max([max(ay, by) for _, ay, _, by in known]) + margin - self.bottom
        self.cell = max(cell, sqrt(width * depth / most), width / most, depth / most)
        self.per_m = 1.0 / self.cell
        self.columns, self.rows = max(ceil(width / self.cell), 1), max(ceil(depth / self.cell), 1)

    def near(self, ax: float, ay: float, bx: float, by: float, within: float) -> list[tuple[int, float]]:
        """Return the cells whose centres are within `within` m of the line, with their squared distances, m^2.

        The time grows with the length of the line, not with its bounding box."""
        dx, dy = bx - ax, by - ay
        long2, most = dx * dx + dy * dy, within * within
        shrunk = 1.0 / long2 if long2 > 0.0 else 0.0
        west, east = min(ax, bx) - within - _ROUNDING, max(ax, bx) + within + _ROUNDING
        flat = abs(dy) <= 1e-4 * abs(dx) or dy == 0.0  # a nearly horizontal line is in a few rows
        slope, half = (0.0, 0.0) if flat else (dx / dy, within * hypot(dx, dy) / abs(dy) + _ROUNDING)
        found = []
        for j in self._span(min(ay, by) - within - self.bottom, max(ay, by) + within - self.bottom, self.rows):
            y = self.bottom + (j + 0.5) * self.cell - ay
            first, last = west, east
            if not flat:
                middle = ax + y * slope
                first, last = max(first, middle - half), min(last, middle + half)
            for i in self._span(first - self.left, last - self.left, self.columns):
                x = self.left + (i + 0.5) * self.cell - ax
                along = (x * dx + y * dy) * shrunk
                if along < 0.0:
                    along = 0.0
                elif along > 1.0:
                    along = 1.0
                ex, ey = x - along * dx, y - along * dy
                away = ex * ex + ey * ey
                if away <= most:
                    found.append((j * self.columns + i, away))
        return found

    def _span(self, low: float, high: float, count: int) -> range:
        return range(max(int(low * self.per_m), 0), min(int(high * self.per_m) + 1, count))
