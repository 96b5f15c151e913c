"""Variability and asymmetry of steady strides with 95 % confidence intervals, and the strides that they need.

The intervals are analytic: no random number is drawn. They allow for strides that resemble the one before, by the
autocorrelation at lag 1 of each foot's strides (of a process of order 1). Slower changes, such as getting tired over
minutes, they do not cover, nor errors of the sensors: where their scales differ by 1 %, so do lengths.
tests/outcomes/test_spread.py shows how often the intervals hold the true value."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import ceil, fsum, sqrt
from statistics import fmean

from attrs import frozen

from ...events import Event, GaitCycleMeasured
from ...types import Foot
from .quantiles import Z, chi_squared_quantile, student_quantile

VARIABLE = (
    "stride_time", "stance_time", "swing_time", "step_time", "stride_length", "speed",
)  # fmt: skip
"""Fields of GaitCycleMeasured whose variability and asymmetry the command line and the report show."""
MIN_FOOT_STRIDES = 4
"""Least number of strides of a foot for an interval; chosen by hand: an autocorrelation of fewer means nothing."""
VARIABILITY_PRECISION = 0.2
"""Half width of the interval, as a share of the coefficient of variation, for which `needed` is given.

With independent strides it takes 50, which is also from where on variability was as reliable as it gets (Koenig et al.
2014, Gait & Posture 39)."""
ASYMMETRY_PRECISION = 0.02
"""Half width of the interval of an asymmetry for which `needed` is given, as a share; chosen by hand."""
MOST_NEEDED = 25
"""Number of times as many strides as there are that an outcome may need; then its interval is five times as wide as it
should be, it says nothing, and the outcome is left out (chosen by hand)."""
VAGUE_ASYMMETRY = ASYMMETRY_PRECISION * sqrt(MOST_NEEDED)
"""Half width above which the interval of an asymmetry says nothing by the same rule, as a share: it falls with the root
of the number of strides."""
LEFT_OUT = "Left out, because the interval says nothing: {}."
"""Sentence on what is left out for it."""
MAX_CORRELATION = 0.95
"""Largest autocorrelation that is used; chosen by hand: nearer to 1 the number of independent strides is below 3 %."""

LEAST_SQUARE = 1e-9
"""Least value whose root is taken in the interval of a variability; only coefficients for which it does not hold, far
above 1/3, give less, and their upper end is then as good as unlimited."""


@frozen(kw_only=True)
class IntervalEstimate:
    """An estimate over steady strides with its 95 % confidence interval; all three are shares (0.02 is 2 %)."""

    value: float
    low: float
    """Lower end of the interval."""
    high: float
    """Upper end of the interval."""
    strides: int
    """Number of strides, of both feet where both count."""
    needed: int
    """Number of strides, of both feet where both count, from which the interval is as narrow as it should be: 20 % of a
    coefficient of variation, or 2 percentage points of an asymmetry, to each side. By the formula of the interval, with
    the variances and autocorrelations of these strides."""

    @property
    def enough(self) -> bool:
        """True if there are as many strides as needed."""
        return self.strides >= self.needed

    @property
    def is_vague(self) -> bool:
        """True if the interval is so wide that it says nothing."""
        return self.needed > MOST_NEEDED * self.strides


@frozen
class FootSample:
    """The values of one parameter in the steady strides of one foot, as moments."""

    count: int
    mean: float
    variance: float
    """Unbiased variance of the values."""
    correlation: float
    """Autocorrelation at lag 1, of strides that follow each other, corrected for its bias and not below 0."""

    @property
    def mean_count(self) -> float:
        """Number of independent strides whose mean would vary as much: n (1 - r) / (1 + r).

        Bayley and Hammersley 1946, J. R. Stat. Soc. Suppl. 8."""
        return self.count * (1.0 - self.correlation) / (1.0 + self.correlation)

    @property
    def variance_count(self) -> float:
        """Number of independent strides whose variance would vary as much: n (1 - r^2) / (1 + r^2) (same source)."""
        square = self.correlation * self.correlation
        return self.count * (1.0 - square) / (1.0 + square)


def variability(
    events: Iterable[Event], name: str, foot: Foot | None = None, *, running: bool = False
) -> IntervalEstimate | None:
    """Return the coefficient of variation of a field of GaitCycleMeasured over steady strides of walking or `running`.

    Without `foot` it is that of both feet, as in the gait table: the root of the mean of the feet's variances over the
    mean of their means (Galna et al. 2013, Gait & Posture 37); of a wearer of one sensor that foot's. The interval is
    the modified one of McKay (Vangel 1996, Am. Stat. 50, equation 16), for which the values are normally distributed
    and the coefficient is below 1/3. The number of strides needed is 1 + z^2 / (2 h^2) independent ones of each foot
    together, with half width h (Greenwood and Sandomire 1950, J. Am. Stat. Assoc. 45). None if a foot has fewer than
    four strides or the mean is not above zero."""
    samples = [sample for one, sample in _samples(events, name, running).items() if foot in (None, one)]
    variances = [sample.variance for sample in samples]
    total, counts = fsum(variances), [sample.count for sample in samples]
    if min(counts, default=0) < MIN_FOOT_STRIDES or total <= 0.0:
        return None
    mean = fmean([sample.mean for sample in samples])
    if mean <= 0.0:
        return None
    cv = sqrt(fmean(variances)) / mean
    # degrees of freedom of a mean of variances (Satterthwaite 1946, Biometrics Bull. 2)
    freedom = _freedom(variances, [sample.variance_count for sample in samples])

    def end(share: float) -> float:
        u = chi_squared_quantile(share, freedom)
        return cv / sqrt(max(((u + 2.0) / (freedom + 1.0) - 1.0) * cv * cv + u / freedom, LEAST_SQUARE))

    feet, count = len(samples), sum(counts)
    needed = ceil(feet + (Z / VARIABILITY_PRECISION) ** 2 / 2.0 * count / (freedom + feet))
    return IntervalEstimate(value=cv, low=end(0.975), high=end(0.025), strides=count, needed=needed)


def _freedom(parts: Sequence[float], counts: Sequence[float]) -> float:
    """Return the degrees of freedom of a sum of variances, each from a number of independent values."""
    terms = [part * part / max(count - 1.0, 1.0) for part, count in zip(parts, counts, strict=True)]
    return fsum(parts) ** 2 / fsum(terms)


def asymmetry(events: Iterable[Event], name: str, *, running: bool = False) -> IntervalEstimate | None:
    """Return the symmetry index of a field of GaitCycleMeasured, 2 (right - left) / (right + left).

    `left` and `right` are the feet's means over steady strides of walking or `running` (Robinson et al. 1987, J. Manip.
    Physiol. Ther. 10). The variance of the index is that of first order (delta method) of these means, which are taken
    as independent: what both feet have in common makes the true interval narrower. Its quantile is Student's t, with
    degrees of freedom by Welch (1947, Biometrika 34). None without four strides of each foot, or if a mean is not above
    zero."""
    samples = list(_samples(events, name, running).values())
    if len(samples) < len(Foot) or min([sample.count for sample in samples]) < MIN_FOOT_STRIDES:
        return None
    left, right = samples
    if min(left.mean, right.mean) <= 0.0:
        return None
    index = 2.0 * (right.mean - left.mean) / (right.mean + left.mean)
    slope = 4.0 / (right.mean + left.mean) ** 2
    parts = [(slope * other.mean) ** 2 * one.variance / one.mean_count for one, other in ((left, right), (right, left))]
    half = 0.0
    if any(parts):
        half = student_quantile(_freedom(parts, [left.mean_count, right.mean_count])) * sqrt(fsum(parts))
    count = left.count + right.count
    needed = max(2 * MIN_FOOT_STRIDES, ceil(count * (half / ASYMMETRY_PRECISION) ** 2))
    return IntervalEstimate(value=index, low=index - half, high=index + half, strides=count, needed=needed)


def steady_strides(events: Iterable[Event], *, running: bool = False) -> list[GaitCycleMeasured]:
    """Return the strides that count: steady ones of walking or `running` that the next one of the foot follows.

    They are those of the means in `Session.gait`."""
    latest: dict[Foot, GaitCycleMeasured] = {}
    strides = []
    for event in events:
        if isinstance(event, GaitCycleMeasured):
            last, latest[event.foot] = latest.get(event.foot), event
            if last is not None and last.steady and last.running is running and last.t == event.t_start:
                strides.append(last)
    return strides


def _samples(events: Iterable[Event], name: str, running: bool) -> dict[Foot, FootSample]:
    """Return the moments of a parameter over the steady strides of each foot that has any."""
    strides = [
        (one, value) for one in steady_strides(events, running=running) if (value := getattr(one, name)) is not None
    ]
    found = {foot: [pair for pair in strides if pair[0].foot is foot] for foot in Foot}
    return {foot: moments(pairs) for foot, pairs in found.items() if pairs}


def moments(pairs: Sequence[tuple[GaitCycleMeasured, float]]) -> FootSample:
    """Return the moments of values in the strides of a foot, some of which follow each other."""
    count, mean = len(pairs), fmean([value for _, value in pairs])
    squares = fsum([(value - mean) ** 2 for _, value in pairs])
    following = [(a - mean) * (b - mean) for (one, a), (after, b) in pairwise(pairs) if one.t == after.t_start]
    correlation = 0.0
    if following and squares > 0.0:
        found = fmean(following) / (squares / count)
        # the bias of the estimate (Marriott and Pope 1954, Biometrika 41)
        correlation = min(max(found + (1.0 + 4.0 * found) / count, 0.0), MAX_CORRELATION)
    return FootSample(count, mean, squares / max(count - 1, 1), correlation)
