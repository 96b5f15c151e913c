"""Jumps of many cells from one sample to the next, which no foot makes: steps of the supply, and bursts of one value.

A foot takes some hundredths of a second to load or unload its cells, and loads some more than others. It is a module
because it knows nothing of loads: only of what the cells have in common."""

from __future__ import annotations

from operator import sub

from ...types import Floats
from ...types.attrs import define

SHORT_INTERVAL = 0.025
"""Longest time between two samples in which a foot loads too little to be taken for a jump, s."""
LEAST_BURST = 0.3
"""Smallest change of the sum of the cells with which a burst begins, as a share of the range of the last 8 to 10 s."""
LONGEST_BURST = 0.5
"""Longest burst, s: cells that show one value for longer show it for good (cell_health.py).

If it is the value of all cells, and not that of a foot in the air, they show no load for as long as it lasts."""
LEAST_STEP, LEAST_STEP_OF_TWO = 0.04, 0.3
"""Smallest step of the sum of the cells, as a share of that range: a smaller one hides neither contact nor toe-off.

That of two cells is larger, because feet move two cells alike now and then, but not as far at once."""
STEP_TOLERANCE = 0.25
"""Largest deviation of the change of one cell from that of most in a step, as a share of the latter."""
STEP_CELLS = 0.67
"""Smallest share of the cells that deviate less: the others may be those under which the foot moves, or cut off."""
LONGEST_STEP = 2
"""Largest number of samples in a row that a step takes, or that a value is wrong which then returns."""
MANY_CELLS, SLOW_INTERVAL = 8, 0.045
"""Number of cells from which on no foot moves so many alike even within that time, s."""


@define
class Jumps:
    """Looks for steps and bursts. Latency: none."""

    t: float | None = None
    """Time of the last sample, s; None before any."""
    total: float = 0.0
    """Sum of the cells of the last sample that was in no burst."""
    cells: Floats = ()
    """Cells of the last sample."""
    before: Floats = ()
    """Cells of the sample before the jump that lasts; empty outside of one."""
    held: int = 0
    """Number of samples of that jump, which are not used."""
    burst: float | None = None
    """The value that the cells of the current burst have; None outside of a burst."""
    burst_t: float = 0.0
    """Start of the last burst, s."""
    bursts: int = 0
    """Number of bursts so far."""

    def is_burst(self, t: float, total: float, cells: Floats, load_range: float, lowest: float) -> bool:
        """Return whether the cells of a sample show a burst, so that this sample must not be used.

        `total` is their sum, `load_range` its range in the last 8 to 10 s, and `lowest` the lower end of it.
        Call this, `is_jump` and then `find_step` for a sample whose sum differs by LEAST_STEP or more from that of the
        sample before, and keep what the others show."""
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

    def is_jump(self, t: float, total: float, cells: Floats, least: float) -> bool:
        """Return whether the cells move alike to this sample, so that it must not be used: what follows decides.

        `least` is the smallest change of a cell that matters."""
        longest = SLOW_INTERVAL if len(cells) >= MANY_CELLS else SHORT_INTERVAL
        if self.t is None or not 2 <= len(cells) == len(self.cells) or t - self.t > longest:
            self.before = ()
        elif self.held < LONGEST_STEP and common_change(self.cells, cells, least):
            self.before, self.held = self.before or self.cells, self.held + 1
            self.t, self.total, self.cells = t, total, cells
            return True
        return False

    def find_step(self, cells: Floats, least: float) -> float:
        """Return by how much all cells have jumped and then stayed; 0 if they have not."""
        before, self.before, self.held = self.before, (), 0
        if not before:
            return 0.0
        step = common_change(before, self.cells, least)
        moved = sorted([abs(b - a) for a, b in zip(self.cells, cells, strict=True)])
        stays = moved[int(STEP_CELLS * (len(moved) - 1))] <= STEP_TOLERANCE * abs(step)
        return step if stays else 0.0


def common_change(before: Floats, cells: Floats, least: float) -> float:
    """Return by how much most cells have changed alike; 0 if they have not, or by `least` at most.

    It is the middle of the half of the changes that lie closest together: loaded cells change by more or less."""
    changes = sorted(map(sub, cells, before))
    # one of most cells has the median of all changes, and is within STEP_TOLERANCE of what they have in common
    if abs(changes[len(changes) // 2]) <= 0.5 * least:
        return 0.0
    low, high = min(zip(changes, changes[len(changes) // 2 :], strict=False), key=lambda ends: ends[1] - ends[0])
    middle = 0.5 * (low + high)
    alike = [change for change in changes if abs(change - middle) <= STEP_TOLERANCE * abs(middle)]
    return middle if abs(middle) > least and len(alike) >= STEP_CELLS * len(changes) else 0.0
