"""Faults of pressure cells, and of the insole, that one window of walking shows.

Earlier windows count only by the number of windows in which each cell was lively.

- DEAD: the cell varies by less than 1 % of the most lively cell, although it should load: cells on all its sides load
  (this needs a layout), or it loaded in every window before, or there are at most four cells, which are where the foot
  presses.
- STUCK: the cell shows one value, well above the other cells in the air.
- SATURATED: the cell is at or beyond the end of its range, even while the foot is in the air (this needs a layout).

A cell at the rim of the sole or under a high arch may never bear load. A cell there that was dead from the start looks
the same: it is not reported, and does no harm."""

from __future__ import annotations

from ...events import CellFault
from ...types import Layout
from ...types.attrs import frozen
from .cells import CellSpan, enclosed, spacing

LIVELY = 0.15
"""Smallest variation of a cell that loads and unloads, as a share of the most lively one's."""
SILENT = 0.01
"""Largest variation of a cell that bears no load, as a share of the most lively one's."""
CONSTANT = 0.0025
"""Largest variation of a cell that shows one value, or two neighbouring counts, as a share of the most lively one's."""
RAISED = 0.1
"""Smallest excess of a cell over the others in the air that is no unloaded value.

The unit is the variation of the most lively cell."""
LIVELY_WINDOWS = 3
"""Number of lively windows in a row after which a cell should load."""
LIVELY_WINDOWS_ALONE = 8
"""Number of lively windows in a row after which a cell should load if its neighbours are unknown."""
FEW = 4
"""Largest number of cells that all are where the foot presses."""
FULL = 0.99
"""Share of its range from which on a cell is at the end of it."""
STAYS_LOADED = 0.3
"""Smallest load of an insole in N that does not unload, as a share of its highest load."""
STAYS_LOADED_IN_COUNTS = 0.9
"""Smallest load of an insole with unknown zero that does not unload, as a share of its highest load."""
NO_VARIATION = 0.01
"""Largest variation of cells that show no load at all, as a share of the highest value."""


@frozen
class CellWindow:
    """The extremes of the cells in one window; only the `working` cells, which have not failed, are judged."""

    lows: list[float]
    """Lowest value of each cell, unit of the samples."""
    ranges: list[float]
    """Variation of each cell: highest minus lowest value, unit of the samples."""
    working: list[int]
    """Indices of the cells that have not failed."""
    liveliest: float
    """Variation of the most lively working cell, unit of the samples."""
    highest: float
    """Highest value of any working cell, unit of the samples."""

    @classmethod
    def from_span(cls, span: CellSpan, excluded: list[int]) -> CellWindow:
        """Return the window of a span; `excluded` are the cells that failed."""
        ranges = [high - low for low, high in zip(span.lows, span.highs, strict=True)]
        working = [i for i in range(len(ranges)) if i not in excluded]
        liveliest = max([ranges[i] for i in working], default=0.0)
        highest = max([span.highs[i] for i in working], default=0.0)
        return cls(span.lows, ranges, working, liveliest, highest)

    @property
    def moves(self) -> bool:
        """Some cell varies enough to show a load."""
        return self.liveliest > NO_VARIATION * self.highest and self.liveliest > 0.0

    def lively(self) -> list[bool]:
        """Return for each cell whether it loads and unloads."""
        return [r > LIVELY * self.liveliest for r in self.ranges]

    def faults(self, layout: Layout | None, lively_windows: list[int]) -> dict[CellFault, list[int]]:
        """Return the faults of the working cells.

        `lively_windows` is the number of windows in a row before this one in which each cell was lively; [] before
        any."""
        lows, ranges, liveliest = self.lows, self.ranges, self.liveliest
        air = sorted([lows[i] for i in self.working])[len(self.working) // 2]
        full = None if layout is None else layout.full_scale
        faults: dict[CellFault, list[int]] = {}
        for i in self.working:
            if full is not None and 0.0 < FULL * full <= lows[i]:
                fault = CellFault.SATURATED
            elif ranges[i] > SILENT * liveliest:
                continue
            elif lows[i] - air > RAISED * liveliest:
                if ranges[i] > CONSTANT * liveliest:
                    continue
                fault = CellFault.STUCK
            elif self._should_load(i, layout, lively_windows[i] if lively_windows else 0):
                fault = CellFault.DEAD
            else:
                continue
            faults.setdefault(fault, []).append(i)
        return faults

    def _should_load(self, i: int, layout: Layout | None, lively_windows: int) -> bool:
        if layout is None:
            return len(self.ranges) <= FEW or lively_windows >= LIVELY_WINDOWS_ALONE
        all_around, some = enclosed(layout, spacing(layout), i, self.lively())
        return all_around or (lively_windows >= LIVELY_WINDOWS and some)


def unloads(span: CellSpan, layout: Layout | None) -> bool:
    """Return whether the load of the insole is much lower at some time in the window, or always zero."""
    in_newtons = layout is not None and layout.scale is not None
    share = STAYS_LOADED if in_newtons else STAYS_LOADED_IN_COUNTS
    return not (span.high > 0.0 and span.low > share * span.high)
