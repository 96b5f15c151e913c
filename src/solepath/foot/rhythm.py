"""How often samples come, and so which wait for one is a gap."""

from __future__ import annotations

from ..types.attrs import define, field

USUAL_GAIN = 0.02
"""Share of the newest wait in the usual one; chosen by hand."""
MOST_RATIO = 2.0
"""A wait counts as no more than so many times the usual one, and as no less than that part of it."""
GAP_SHARE, LEAST_GAP = 1.75, 0.004
"""A wait is a gap when it is so many times the usual one and so much longer, s."""
GAPS_OF_NEW_RATE, SAME_SHARE = 10, 0.1
"""So many gaps in a row, as long as the first within this share of it, make a new rate."""
FIRST_INTERVALS = 10
"""So many waits in which a shorter one shows that the first were none to go by."""


@define
class Rhythm:
    """The usual time between samples, learnt from them. Many waits in a row that are gaps and alike are no gaps but
    another rate."""

    seen: int = field(default=0, init=False)
    usual: float | None = field(default=None, init=False)
    """s."""
    gaps_in_a_row: int = field(default=0, init=False)
    first_gap: float = field(default=0.0, init=False)
    """The first of the gaps in a row, s."""

    def update(self, dt: float) -> bool:
        """One wait, s; True when it was a gap."""
        usual = self.usual
        if usual is None or self.seen <= FIRST_INTERVALS:
            self.seen += 1
            if usual is None or (self.seen <= FIRST_INTERVALS and dt * GAP_SHARE < usual):
                self.usual = dt
                return False
        # the usual wait follows slowly and mistrusts the unusual
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
