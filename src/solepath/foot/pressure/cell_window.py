"""Faults of pressure cells, and of the insole, that one window of walking shows.

The range of a cell is its highest minus its lowest value in the window. A cell is "lively" if it both loads and unloads
in the window. Of earlier windows only the number of windows in a row in which each cell was lively is used.

- DEAD: the range of the cell is below 1 % of the largest range, although the cell should load. It should load if cells
  on all its sides load (this needs a layout), if it was lively in several windows in a row, or if the insole has at
  most four cells, because these are put where the foot presses.
- STUCK: the cell shows one value, well above that of the other cells in the air.
- SATURATED: the cell is at the end of its measuring range, even while the foot is in the air (this needs a layout).

A cell at the rim of the sole or under a high arch may never bear load. A cell there that was dead from the start looks
the same: it is not reported, and does no harm. The numbers were chosen by hand and not swept."""

from __future__ import annotations

from ...events import CellFault
from ...types import Layout
from ...types.attrs import frozen
from .cells import CellSpan, enclosed

LIVELY_RANGE = 0.15
"""Range above which a cell is lively, as a share of the largest range."""
SILENT_RANGE = 0.01
"""Largest range of a cell that bears no load, as a share of the largest range."""
CONSTANT_RANGE = 0.0025
"""Largest range of a cell that shows one value or two neighbouring counts, as a share of the largest range."""
RAISED_VALUE = 0.1
"""Excess over the median cell in the air above which a value is not that of an unloaded cell.

It is a share of the largest range."""
LIVELY_WINDOWS = 3
"""Number of lively windows in a row after which a cell should load."""
LIVELY_WINDOWS_ALONE = 8
"""Number of lively windows in a row after which a cell should load if its neighbours are unknown."""
MOST_PRESSED_CELLS = 4
"""Largest number of cells of an insole that has all its cells where the foot presses."""
FULL_SCALE_SHARE = 0.99
"""Share of the full scale from which on a cell is saturated."""
LOADED_SHARE = 0.3
"""Lowest load in N above which an insole does not unload, as a share of its highest load."""
LOADED_SHARE_IN_COUNTS = 0.9
"""Value of LOADED_SHARE for loads in counts, whose zero is unknown."""
LEAST_VARIATION = 0.01
"""Largest range of cells that show no load at all, as a share of the highest value."""


@frozen
class CellWindow:
    """The extremes of the cells in one window, of which those that have not failed are judged."""

    lows: list[float]
    """Lowest value of each cell, unit of the samples."""
    ranges: list[float]
    """Range of each cell: highest minus lowest value, unit of the samples."""
    working: list[int]
    """Indices of the cells that have not failed."""
    largest_range: float
    """Largest range of any working cell, unit of the samples."""
    highest: float
    """Highest value of any working cell, unit of the samples."""

    @classmethod
    def from_span(cls, span: CellSpan, excluded: list[int]) -> CellWindow:
        """Return the window of a span; `excluded` holds the indices of the failed cells."""
        ranges = [high - low for low, high in zip(span.lows, span.highs, strict=True)]
        working = [i for i in range(len(ranges)) if i not in excluded]
        largest_range = max([ranges[i] for i in working], default=0.0)
        highest = max([span.highs[i] for i in working], default=0.0)
        return cls(span.lows, ranges, working, largest_range, highest)

    @property
    def varies(self) -> bool:
        """Flag: at least one cell varies enough to show a load."""
        return self.largest_range > LEAST_VARIATION * self.highest and self.largest_range > 0.0

    def find_lively(self) -> list[bool]:
        """Return for each cell whether it is lively."""
        return [r > LIVELY_RANGE * self.largest_range for r in self.ranges]

    def find_faults(self, layout: Layout | None, lively_windows: list[int]) -> dict[CellFault, list[int]]:
        """Return the faults of the working cells, each with the indices of its cells.

        `lively_windows` is, for each cell, the number of earlier windows in a row in which it was lively; [] if there
        are none."""
        lows, ranges, largest_range = self.lows, self.ranges, self.largest_range
        air_value = sorted([lows[i] for i in self.working])[len(self.working) // 2]
        full_scale_value = None if layout is None else layout.full_scale
        faults: dict[CellFault, list[int]] = {}
        for i in self.working:
            if full_scale_value is not None and 0.0 < FULL_SCALE_SHARE * full_scale_value <= lows[i]:
                fault = CellFault.SATURATED
            elif ranges[i] > SILENT_RANGE * largest_range:
                continue
            elif lows[i] - air_value > RAISED_VALUE * largest_range:
                if ranges[i] > CONSTANT_RANGE * largest_range:
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
            return len(self.ranges) <= MOST_PRESSED_CELLS or lively_windows >= LIVELY_WINDOWS_ALONE
        is_enclosed, any_neighbours = enclosed(layout, i, self.find_lively())
        return is_enclosed or (lively_windows >= LIVELY_WINDOWS and any_neighbours)


def unloads(span: CellSpan, layout: Layout | None) -> bool:
    """Return whether the load of the insole falls to a small share of its highest value, or is always zero."""
    in_newtons = layout is not None and layout.scale is not None
    share = LOADED_SHARE if in_newtons else LOADED_SHARE_IN_COUNTS
    return not (span.high > 0.0 and span.low > share * span.high)
