"""Pressure cells over a stretch of time, and which lie around one."""

from __future__ import annotations

from functools import lru_cache
from math import atan2, hypot, pi

from ...types import Layout
from ...types.attrs import define, field

NEIGHBOUR_DISTANCE = 1.7
"""Neighbours are within this many times the usual distance between cells."""
WIDEST_OPENING = 2.6
"""A cell with a wider gap between its neighbours lies at their rim, rad."""


@define
class CellSpan:
    """The lowest and highest value of each cell, and of their sum, over a stretch of time."""

    lows: list[float] = field(factory=list)
    highs: list[float] = field(factory=list)
    low: float = 0.0
    high: float = 0.0

    def add(self, cells: tuple[float, ...], excluded: list[int]) -> None:
        """One sample more; `excluded` are not part of the sum."""
        total = sum(cells) - sum([cells[i] for i in excluded])
        if not self.lows:
            self.lows, self.highs = list(cells), list(cells)
            self.low = self.high = total
            return
        # half the time of map(min, ...), which calls a function for every cell
        self.lows = [low if low < value else value for low, value in zip(self.lows, cells, strict=True)]
        self.highs = [high if high > value else value for high, value in zip(self.highs, cells, strict=True)]
        self.low, self.high = min(self.low, total), max(self.high, total)


@lru_cache(maxsize=8)
def spacing(layout: Layout) -> float:
    """The usual distance from one cell to the next, m; 0 with fewer than two."""
    places = [(cell.x, cell.y) for cell in layout.cells]
    nearest = sorted(
        [min([hypot(x - u, y - v) for j, (u, v) in enumerate(places) if j != i]) for i, (x, y) in enumerate(places)]
        if len(places) > 1
        else [0.0]
    )
    return nearest[len(nearest) // 2]


def enclosed(layout: Layout, between: float, i: int, loading: list[bool]) -> tuple[bool, bool]:
    """Of the cells around cell `i`: whether those that load lie on all its sides, and whether two of them do at all."""
    here = layout.cells[i]
    angles, others = [], 0
    for j, cell in enumerate(layout.cells):
        dx, dy = cell.x - here.x, cell.y - here.y
        if j == i or hypot(dx, dy) > NEIGHBOUR_DISTANCE * between:
            continue
        if loading[j]:
            angles.append(atan2(dy, dx))
        else:
            others += 1
    if len(angles) < 2:
        return False, False
    if len(angles) < 4 or others > 1:
        return False, True
    angles.sort()
    gaps = [b - a for a, b in zip(angles, angles[1:], strict=False)]
    widest = max([*gaps, angles[0] + 2.0 * pi - angles[-1]])
    return widest < WIDEST_OPENING, True


def centre(layout: Layout) -> float | None:
    """x of the centre of the foot, half-way between the first and the last cell, foot frame, m; None without cells.

    "Smart insole-based indoor localization system for Internet of Things applications", IEEE Internet of Things Journal
    6, 2019: of cells from 34 to 166 mm the centre is at 100 mm, and there the centre of pressure is taken to be while
    the foot is in the air."""
    xs = [cell.x for cell in layout.cells]
    return 0.5 * (min(xs) + max(xs)) if xs else None
