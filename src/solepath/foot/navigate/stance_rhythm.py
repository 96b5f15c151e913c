"""Usual durations of the wearer's stance and swing, which tell when gated evidence is a stance after all.

A filter whose velocity drifted in a swing gates the stance that follows, although the foot stands. The duration of the
evidence decides: a slow swing looks still for a fraction of a stance only. In `gumushane_gcp` gated evidence in
mid-swing lasted 0.05 to 0.07 s, where stances lasted 0.4 s. So the foot stands if evidence starts late enough after the
last stance and lasts for half of the wearer's usual stance, whatever the pace."""

from __future__ import annotations

from ...types.attrs import define, field

FIRST_STANCE, FIRST_SWING = 0.7, 0.5
"""Durations of stance and swing that are assumed before any were measured, s: those of slow walking."""
SWING_SHARE = 0.5
"""Share of the usual swing that must have passed before evidence can be a stance; chosen by hand."""
SHORTEST_SWING = 0.15
"""Shortest time without accepted evidence that is a swing, s; shorter ones are breaks in a stance."""
SHORTEST_STANCE, LONGEST_STANCE = 0.05, 1.0
"""Limits of a stance in gait, s: a shorter one is chance, in a longer one the wearer stands."""
GAIN = 0.2
"""Weight of the newest duration in the usual one."""
LARGEST_RATIO = 2.0
"""Limit of the ratio of a duration to the usual one, and of its inverse, in the average."""


@define
class StanceRhythm:
    """Learns how long stance and swing of one foot usually last, from the times of accepted evidence."""

    usual_stance: float = field(default=FIRST_STANCE, init=False)
    """Usual time from the first to the last accepted evidence of a stance, s."""
    usual_swing: float = field(default=FIRST_SWING, init=False)
    """Usual time without accepted evidence between two stances, s."""
    stance_start: float | None = field(default=None, init=False)
    """Time of the first accepted evidence of the current stance, s; None before any."""

    def add(self, t: float, last: float) -> None:
        """Add evidence that is accepted at `t`, s, after the last one at `last`."""
        swing = t - last
        if self.stance_start is None:
            self.stance_start = t
        elif swing > SHORTEST_SWING:
            stance = last - self.stance_start
            if SHORTEST_STANCE < stance < LONGEST_STANCE:
                self.usual_stance = _average(self.usual_stance, stance)
                self.usual_swing = _average(self.usual_swing, swing)
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


def _average(usual: float, newest: float) -> float:
    return usual + GAIN * (min(max(newest, usual / LARGEST_RATIO), LARGEST_RATIO * usual) - usual)
