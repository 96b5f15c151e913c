"""What a window of walking says of the pressure cells of an insole, and of the insole: nothing of earlier windows in it
but in how many of them each cell was lively.

- DEAD: it varies by less than 1 % of what the most lively cell does, though all around it cells load (that takes a
  layout), or it has loaded in every window before, or there are at most four cells, which are where the foot presses.
- STUCK: it shows one value, well above what the other cells show in the air.
- SATURATED: it is at the end of its range, or beyond, also while the foot is in the air (that takes a layout).

A cell at the rim of the sole or under a high arch may carry nothing for all its life. One that was dead from the
beginning looks the same there: it is not reported, and does no harm.
"""

from __future__ import annotations

from ...events import CellFault
from ...types import Layout
from ...types.attrs import frozen
from .cells import CellSpan, enclosed, spacing

LIVELY = 0.15
"""A cell that varies by more than this share of what the most lively one does loads and unloads."""
SILENT = 0.01
"""One that varies by less carries nothing."""
CONSTANT = 0.0025
"""One that varies by less shows one value, and perhaps a count beside it."""
RAISED = 0.1
"""This share of the most lively one's variation above the others in the air is not the air."""
LIVELY_WINDOWS = 3
"""A cell that was lively in so many windows in a row is expected to be,"""
LIVELY_WINDOWS_ALONE = 8
"""where nobody knows which cells are next to it."""
FEW = 4
FULL = 0.99
"""From this share of its range a cell is at the end of it."""
STAYS_LOADED = 0.3
"""An insole in newtons does not unload when it never shows less than this share of its highest load;"""
STAYS_LOADED_IN_COUNTS = 0.9
"""one whose zero is not known, this share."""
NO_VARIATION = 0.01
"""Of the highest value: if no cell varies by more, none shows anything."""


@frozen
class CellWindow:
    """What the cells showed in a window; of `working`, those that have not failed, the others are judged."""

    lows: list[float]
    """Of every cell, unit of the samples."""
    ranges: list[float]
    """By how much each varied."""
    working: list[int]
    liveliest: float
    """By how much the most lively of the working ones varied."""
    highest: float
    """What any of them showed."""

    @classmethod
    def from_span(cls, span: CellSpan, excluded: list[int]) -> CellWindow:
        """`excluded`: the cells that failed."""
        ranges = [high - low for low, high in zip(span.lows, span.highs, strict=True)]
        working = [i for i in range(len(ranges)) if i not in excluded]
        liveliest = max([ranges[i] for i in working], default=0.0)
        highest = max([span.highs[i] for i in working], default=0.0)
        return cls(span.lows, ranges, working, liveliest, highest)

    @property
    def moves(self) -> bool:
        """Some cell shows something."""
        return self.liveliest > NO_VARIATION * self.highest and self.liveliest > 0.0

    def lively(self) -> list[bool]:
        """Of every cell, whether it loads and unloads."""
        return [r > LIVELY * self.liveliest for r in self.ranges]

    def faults(self, layout: Layout | None, lively_windows: list[int]) -> dict[CellFault, list[int]]:
        """What the window says of the working cells. `lively_windows`: in how many windows in a row before it each cell was
        lively, [] before any."""
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
    """The insole bears much less at some time in the window than at others, or nothing at all."""
    in_newtons = layout is not None and layout.scale is not None
    share = STAYS_LOADED if in_newtons else STAYS_LOADED_IN_COUNTS
    return not (span.high > 0.0 and span.low > share * span.high)
