"""Usual durations of one foot, which follow what was measured: interval between samples, stance, swing."""

from __future__ import annotations

from itertools import pairwise

from ..types.attrs import define

LEAST_RATIO, LARGEST_RATIO = 0.5, 2.0
"""Limits of the ratio of a duration to the usual one, with which it enters the average; chosen by hand."""


def follow(usual: float, newest: float, gain: float, largest: float = LARGEST_RATIO) -> float:
    """Return the running mean after the newest duration, limited to LEAST_RATIO to `largest` times the usual one."""
    counted, low, high = newest, LEAST_RATIO * usual, largest * usual
    if counted < low:
        counted = low
    elif counted > high:
        counted = high
    return usual + gain * (counted - usual)


USUAL_GAIN = 0.02
"""Weight of the newest interval in the usual one; chosen by hand."""
LEAST_GAP_RATIO, LEAST_GAP_DIFFERENCE = 1.75, 0.002
"""Ratio of an interval to the usual one, and difference between them in s, above which it is a gap.

The ratio was chosen by hand. Times in whole milliseconds make two intervals differ by up to 2 ms."""
GAPS_OF_NEW_RATE, LARGEST_GAP_DEVIATION = 10, 0.1
"""Number of equal gaps in a row that mean a new sampling rate, and largest relative difference between them."""
SHORTEST_ABSENCE, LONGEST_LOSS, ABSENT_INTERVALS = 1.0, 2.0, 20.0
"""Longest gap in which samples were lost: so many intervals, within the first two limits, s; in a longer one the sensor
was absent. `Profile.stale_after` of the built-in devices is the same at their rates."""
FIRST_INTERVALS = 10
"""Number of intervals after the start from which the usual interval is learnt at once."""


def longest_loss(interval: float) -> float:
    """Return the longest gap in which samples that come every `interval` s were lost, s; a longer one is an absence."""
    return min(LONGEST_LOSS, max(SHORTEST_ABSENCE, ABSENT_INTERVALS * interval))


@define
class Rhythm:
    """The usual interval between samples, learnt from them; a gap does not change it.

    Many gaps of equal length in a row mean a new sampling rate. Times do not show a loss that is always the same:
    samples of which every second one is lost are samples at half the rate."""

    first: tuple[float, ...] = ()
    """First intervals, s, in the order of their length."""
    usual_interval: float | None = None
    """Usual interval between samples, s; None before any."""
    gaps_in_a_row: int = 0
    """Number of equal gaps in a row."""
    first_gap: float = 0.0
    """Duration of the first gap of the current row, s."""

    def update(self, dt: float) -> bool:
        """Add one interval, s; return whether it was a gap."""
        usual_interval = self.usual_interval
        if usual_interval is None or len(self.first) < FIRST_INTERVALS:
            usual_interval = self._learn(dt)
        if dt <= LEAST_GAP_RATIO * usual_interval or dt - usual_interval <= LEAST_GAP_DIFFERENCE:
            self.usual_interval = follow(usual_interval, dt, USUAL_GAIN)
            self.gaps_in_a_row = 0
            return False
        if self.gaps_in_a_row == 0 or abs(dt - self.first_gap) > LARGEST_GAP_DEVIATION * self.first_gap:
            self.gaps_in_a_row, self.first_gap = 0, dt
        self.gaps_in_a_row += 1
        if self.gaps_in_a_row == GAPS_OF_NEW_RATE:
            self.usual_interval, self.gaps_in_a_row = dt, 0
        return True

    def _learn(self, dt: float) -> float:
        """Return the usual interval with one of the first: the shortest that another one is like, no odd one."""
        self.first = first = tuple(sorted((*self.first, dt)))
        alike = [one for one, longer in pairwise(first) if longer <= LEAST_GAP_RATIO * one]
        return alike[0] if alike else first[-1]

    @property
    def longest_loss(self) -> float:
        """Longest gap in which samples were lost, s."""
        return longest_loss(0.0 if self.usual_interval is None or len(self.first) < 2 else self.usual_interval)

    def count_missing(self, gap: float) -> int:
        """Return how many samples at the usual interval a gap of so many s has room for; 0 in an absence."""
        if self.usual_interval is None or gap > self.longest_loss:
            return 0
        return round(gap / self.usual_interval) - 1


FIRST_STANCE, FIRST_SWING = 0.7, 0.5
"""Durations of stance and swing that are assumed before any were measured, s: those of slow walking."""
SWING_SHARE = 0.5
"""Share of the usual swing that must have passed before evidence can be a stance; chosen by hand."""
SHORTEST_SWING = 0.15
"""Shortest time without accepted evidence that is a swing, s; shorter ones are breaks in a stance."""
SHORTEST_STANCE, LONGEST_STANCE = 0.05, 1.0
"""Limits of a stance in gait, s: a shorter one is chance, in a longer one the wearer stands."""
STANCE_GAIN = 0.2
"""Weight of the newest stance or swing in the usual one."""


@define
class StanceRhythm:
    """Learns how long stance and swing of one foot usually last, from the times of accepted evidence.

    A filter whose velocity drifted in a swing gates the stance that follows, although the foot stands. The duration of
    the evidence decides: a slow swing looks still for a fraction of a stance only. In `gumushane_gcp` gated evidence in
    mid-swing lasted 0.05 to 0.07 s, where stances lasted 0.4 s. So the foot stands if evidence starts late enough after
    the last stance and lasts for half of the wearer's usual stance, whatever the pace."""

    usual_stance: float = FIRST_STANCE
    """Usual time from the first to the last accepted evidence of a stance, s."""
    usual_swing: float = FIRST_SWING
    """Usual time without accepted evidence between two stances, s."""
    stance_start: float | None = None
    """Time of the first accepted evidence of the current stance, s; None before any."""

    def add(self, t: float, last: float) -> None:
        """Add evidence that is accepted at `t`, s, after the last one at `last`."""
        swing = t - last
        if self.stance_start is None:
            self.stance_start = t
        elif swing > SHORTEST_SWING:
            stance = last - self.stance_start
            if SHORTEST_STANCE < stance < LONGEST_STANCE:
                self.usual_stance = follow(self.usual_stance, stance, STANCE_GAIN)
                self.usual_swing = follow(self.usual_swing, swing, STANCE_GAIN)
            self.stance_start = t

    def time_until_stance(self, since_last: float, share: float, longest: float) -> float:
        """Return how long evidence must last until the foot stands for certain, s, at most `longest`.

        The evidence started `since_last` s after the last accepted one. `share` is that of the usual stance."""
        if since_last < SWING_SHARE * self.usual_swing:
            return longest
        return min(longest, share * self.usual_stance)

    def reset(self) -> None:
        """Discard the times of the current stance, because times restart."""
        self.stance_start = None
