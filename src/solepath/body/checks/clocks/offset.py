"""The offset between the clocks of the feet, from comparisons of the stances of each foot with the other's swings.

clocks.py has what is compared and why."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, fsum, pi, sin, sqrt

from ....types.attrs import frozen

MIN_COMPARISONS = 16
"""Least number of comparisons for an offset, about 9 s of walking.

With 12 to 20 no recording of feet on one clock is reported, with 10 one of 119 is, for a few uneven steps."""
GAIT_SIGMA = 0.010
"""Standard deviation of the distance of the middles, s: 6 ms in even walkers, and an allowance for others."""
EVEN_SWINGS = 0.040
"""Largest difference of the mean swing times of the feet of an even walker, s; 95 % of 111 walks have less."""
UNEVEN_SHARE = 0.25
"""Standard deviation of the distance of the middles of an uneven walker, as a share of the swing times' difference
above `EVEN_SWINGS`; chosen by hand: the double supports differ by half as much as the swings."""
SIGNIFICANT = 3.0
"""Number of standard deviations from which an offset is reported."""
CHANGED = 0.5
"""Relative change of a reported offset that is reported again."""
MAX_SCATTER = 0.08
"""Largest standard deviation of the single distances, as a share of the cycle; walks have 0.01, and 0.03 on stairs."""
AMBIGUOUS_PHASE = 0.25
"""Phase from which the right foot may also be late instead of early, or early instead of late, by the rest of the
cycle."""
SCALE_OF_MAD = 1.4826
"""Standard deviation of a normal distribution relative to its median absolute deviation."""
EFFICIENCY_OF_MEDIAN = 1.2533
"""Standard deviation of the median relative to that of the mean of normal values: sqrt(pi / 2)."""


@frozen
class Comparison:
    """A stance of one foot compared with the swing of the other foot that is nearest in time."""

    phase: float
    """Lateness of the right foot relative to the left one, as a share of the cycle, from -0.5 to 0.5."""
    cycle: float
    """Mean cycle time of both feet, s."""
    uneven: float
    """Swing time of the right foot minus that of the left one, s."""


@frozen
class Offset:
    """An estimate of the offset between the clocks."""

    value: float
    """Time to add to the times of the right foot, s; it may be wrong by whole cycles."""
    sigma: float
    """Standard deviation of `value`, s."""
    cycle: float
    """Time of a cycle, s."""

    @property
    def is_significant(self) -> bool:
        """True if feet on one clock do not show such an offset."""
        return abs(self.value) > SIGNIFICANT * self.sigma

    @property
    def sentences(self) -> str:
        """Sentences for the person who records, on the right foot."""
        late, size = "late" if self.value < 0.0 else "early", 1000.0 * abs(self.value)
        cycle = 1000.0 * self.cycle
        return (
            f"its times are about {size:.0f} ms {late}, give or take whole cycles of {cycle:.0f} ms; step time and "
            "double support are left out. Use one clock: an offset wrong by a cycle gives numbers that look right"
        )

    def differs_from(self, other: float) -> bool:
        """Return whether another offset, s, differs from this one by more than `CHANGED`, but for whole cycles."""
        difference = self.value - other
        difference -= self.cycle * round(difference / self.cycle)
        return abs(difference) > max(SIGNIFICANT * self.sigma, CHANGED * abs(other))


def find_offset(comparisons: Sequence[Comparison]) -> Offset | None:
    """Return the offset of the right foot's times that these comparisons show, or None."""
    if len(comparisons) < MIN_COMPARISONS:
        return None
    angles = [2.0 * pi * one.phase for one in comparisons]
    turn = atan2(fsum([sin(angle) for angle in angles]), fsum([cos(angle) for angle in angles])) / (2.0 * pi)
    cycle = _median([one.cycle for one in comparisons])
    phases = [one.phase - round(one.phase - turn) for one in comparisons]
    delay, scatter = _spread([phase * one.cycle for phase, one in zip(phases, comparisons, strict=True)])
    if abs(turn) > AMBIGUOUS_PHASE:
        # a wearer who changes the pace shows the whole cycles: the offset is constant in s and not in phase
        whole = 1.0 if turn < 0.0 else -1.0
        other = _spread([(phase + whole) * one.cycle for phase, one in zip(phases, comparisons, strict=True)])
        if other[1] < scatter:
            delay, scatter = other
    if scatter > MAX_SCATTER * cycle:
        return None
    uneven = UNEVEN_SHARE * max(0.0, abs(_median([one.uneven for one in comparisons])) - EVEN_SWINGS)
    error = EFFICIENCY_OF_MEDIAN * scatter / sqrt(len(comparisons))
    return Offset(-delay, sqrt(GAIT_SIGMA * GAIT_SIGMA + uneven * uneven + error * error), cycle)


def _spread(delays: list[float]) -> tuple[float, float]:
    """Return median and robust standard deviation of the delays."""
    median = _median(delays)
    return median, SCALE_OF_MAD * _median([abs(one - median) for one in delays])


def _median(values: list[float]) -> float:
    """Return the median of at least one value."""
    ordered, half = sorted(values), len(values) // 2
    return ordered[half] if len(values) % 2 else 0.5 * (ordered[half - 1] + ordered[half])
