"""Usual interval between samples, and detection of gaps."""

from __future__ import annotations

from ..types.attrs import define, field

USUAL_GAIN = 0.02
"""Weight of the newest interval in the usual one; chosen by hand."""
MOST_RATIO = 2.0
"""Largest ratio of a counted interval to the usual one; its inverse is the smallest ratio."""
GAP_SHARE, LEAST_GAP = 1.75, 0.004
"""Smallest ratio of a gap to the usual interval, and smallest difference between them, s."""
GAPS_OF_NEW_RATE, SAME_SHARE = 10, 0.1
"""Number of equal gaps in a row that make a new rate, and largest relative difference between them."""
FIRST_INTERVALS = 10
"""Number of first intervals within which a much shorter one replaces the usual interval."""


@define
class Rhythm:
    """The usual interval between samples, learnt from them.

    Many gaps in a row of equal length are no gaps but a new rate."""

    seen: int = field(default=0, init=False)
    """Number of intervals so far, up to FIRST_INTERVALS + 1."""
    usual: float | None = field(default=None, init=False)
    """Usual interval between samples, s; None before any."""
    gaps_in_a_row: int = field(default=0, init=False)
    """Number of equal gaps in a row."""
    first_gap: float = field(default=0.0, init=False)
    """Duration of the first of these gaps, s."""

    def update(self, dt: float) -> bool:
        """Add one interval, s; return whether it was a gap."""
        usual = self.usual
        if usual is None or self.seen <= FIRST_INTERVALS:
            self.seen += 1
            if usual is None or (self.seen <= FIRST_INTERVALS and dt * GAP_SHARE < usual):
                self.usual = dt
                return False
        # the usual interval follows slowly, and an unusual one is limited first
        limited = dt
        if limited < usual / MOST_RATIO:
            limited = usual / MOST_RATIO
        elif limited > MOST_RATIO * usual:
            limited = MOST_RATIO * usual
        self.usual = usual + USUAL_GAIN * (limited - usual)
        if dt <= GAP_SHARE * usual or dt - usual <= LEAST_GAP:
            self.gaps_in_a_row = 0
            return False
        if self.gaps_in_a_row == 0 or abs(dt - self.first_gap) > SAME_SHARE * self.first_gap:
            self.gaps_in_a_row, self.first_gap = 0, dt
        self.gaps_in_a_row += 1
        if self.gaps_in_a_row == GAPS_OF_NEW_RATE:
            self.usual, self.gaps_in_a_row = dt, 0
        return True
