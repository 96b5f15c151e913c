"""Jumps of many cells from one sample to the next, which no foot makes: steps of the supply, and bursts of one value.

A foot takes some hundredths of a second to load or unload its cells, and loads some more than others. It is a module
because it knows nothing of loads: only of what the cells have in common."""

from __future__ import annotations

from ...types import Floats
from ...types.attrs import define

SHORT_INTERVAL = 0.025
"""Longest time between two samples in which a foot loads too little to be taken for a jump, s."""
LEAST_BURST = 0.3
"""Smallest change of the sum of the cells with which a burst begins, as a share of the range of the last 8 to 10 s."""
LONGEST_BURST = 0.5
"""Longest burst, s: cells that show one value for longer show it for good (cell_health.py).

If it is the value of all cells, and not that of a foot in the air, they show no load for as long as it lasts."""
LEAST_STEP = 0.04
"""Smallest step of the sum of the cells, as a share of that range: a smaller one hides neither contact nor toe-off."""
STEP_TOLERANCE = 0.25
"""Largest deviation of the change of one cell from that of all cells in a step, as a share of the latter."""
LEAST_STEP_CELLS = 3
"""Smallest number of cells that show a step: two cells rise alike now and then in a step of the wearer, too."""


@define
class Jumps:
    """Looks for steps and bursts. Latency: none."""

    t: float | None = None
    """Time of the last sample, s; None before any."""
    total: float = 0.0
    """Sum of the cells of the last sample that was in no burst."""
    cells: Floats = ()
    """Its cells, if they are few enough to be compared one by one; otherwise empty."""
    burst: float | None = None
    """The value that the cells of the current burst have; None outside of a burst."""
    burst_t: float = 0.0
    """Start of the last burst, s."""
    bursts: int = 0
    """Number of bursts so far."""

    def is_burst(self, t: float, total: float, cells: Floats, load_range: float, lowest: float) -> bool:
        """Return whether the cells of a sample show a burst, so that this sample must not be used.

        `total` is their sum, `load_range` its range in the last 8 to 10 s, and `lowest` the lower end of it.
        Call this and then `find_step` for a sample whose sum differs by LEAST_STEP or more from that of the sample
        before, and keep what the others show."""
        count, burst = len(cells), self.burst
        if burst is not None:
            same = cells.count(burst)
            is_short = 0.0 <= t - self.burst_t < LONGEST_BURST
            unlike_swing = abs(total - lowest) > LEAST_STEP * load_range
            if (is_short and 2 * same >= count) or (same == count and unlike_swing):
                self.t = t
                return True
            self.burst = None
            return False
        change = total - self.total
        if self.t is None or count < 2 or abs(change) <= LEAST_BURST * load_range:
            return False
        is_quick = t - self.t <= SHORT_INTERVAL
        value = max(cells) if change > 0.0 else min(cells)
        same = cells.count(value)
        if (same == count and (is_quick or count > 2 and change > 0.0)) or (
            is_quick and change > 0.0 and 2 * same >= count > 2
        ):
            self.burst, self.burst_t, self.t, self.bursts = value, t, t, self.bursts + 1
            return True
        return False

    def find_step(self, t: float, total: float, cells: Floats) -> float:
        """Return by how much all cells have jumped at once; 0 if they have not."""
        before, count = self.cells, len(cells)
        if self.t is None or t - self.t > SHORT_INTERVAL or not LEAST_STEP_CELLS <= count == len(before):
            return 0.0
        change = total - self.total
        step = change / count
        tolerance = STEP_TOLERANCE * abs(step)
        for value, value_before in zip(cells, before, strict=True):
            if abs(value - value_before - step) > tolerance:
                return 0.0
        return step
