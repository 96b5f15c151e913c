"""Usual interval between samples, and detection of gaps."""

from __future__ import annotations

from ..types.attrs import define, field

USUAL_GAIN = 0.02
"""Weight of the newest interval in the usual one; chosen by hand."""
LARGEST_COUNTED_RATIO = 2.0
"""Limit of the ratio of an interval to the usual one, and of its inverse, in the average; chosen by hand."""
LEAST_GAP_RATIO, LEAST_GAP_DIFFERENCE = 1.75, 0.004
"""Ratio of an interval to the usual one, and difference between them in s, above which it is a gap; chosen by hand."""
GAPS_OF_NEW_RATE, LARGEST_GAP_DEVIATION = 10, 0.1
"""Number of equal gaps in a row that mean a new sampling rate, and largest relative difference between them."""
FIRST_INTERVALS = 10
"""Number of intervals after the start among which a much shorter one replaces the usual interval."""


@define
class Rhythm:
    """The usual interval between samples, learnt from them.

    Many gaps of equal length in a row mean a new sampling rate."""

    intervals: int = field(default=0, init=False)
    """Number of intervals so far, up to FIRST_INTERVALS + 1."""
    usual_interval: float | None = field(default=None, init=False)
    """Usual interval between samples, s; None before any."""
    gaps_in_a_row: int = field(default=0, init=False)
    """Number of equal gaps in a row."""
    first_gap: float = field(default=0.0, init=False)
    """Duration of the first gap of the current row, s."""

    def update(self, dt: float) -> bool:
        """Add one interval, s; return whether it was a gap."""
        usual_interval = self.usual_interval
        if usual_interval is None or self.intervals <= FIRST_INTERVALS:
            self.intervals += 1
            if usual_interval is None or (self.intervals <= FIRST_INTERVALS and dt * LEAST_GAP_RATIO < usual_interval):
                self.usual_interval = dt
                return False
        # an unusual interval is limited before it enters the slow average
        counted = dt
        if counted < usual_interval / LARGEST_COUNTED_RATIO:
            counted = usual_interval / LARGEST_COUNTED_RATIO
        elif counted > LARGEST_COUNTED_RATIO * usual_interval:
            counted = LARGEST_COUNTED_RATIO * usual_interval
        self.usual_interval = usual_interval + USUAL_GAIN * (counted - usual_interval)
        if dt <= LEAST_GAP_RATIO * usual_interval or dt - usual_interval <= LEAST_GAP_DIFFERENCE:
            self.gaps_in_a_row = 0
            return False
        if self.gaps_in_a_row == 0 or abs(dt - self.first_gap) > LARGEST_GAP_DEVIATION * self.first_gap:
            self.gaps_in_a_row, self.first_gap = 0, dt
        self.gaps_in_a_row += 1
        if self.gaps_in_a_row == GAPS_OF_NEW_RATE:
            self.usual_interval, self.gaps_in_a_row = dt, 0
        return True
