"""Sums up a walk for the head of its report: how far and how long by activity, measures, differences between the feet.

Limits below which a difference is not named have their sources beside them."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from math import fsum, sqrt
from statistics import fmean
from typing import TYPE_CHECKING

from attrs import frozen

from ...body.gait.means import Figure, GaitParameters
from ...events import GaitCycleMeasured
from ...types import Activity, Foot

if TYPE_CHECKING:
    from ..outcomes.absences import Absences

LENGTH_ERROR = 0.02
"""Difference of stride lengths that two good sensors may show, as a share: each has a scale within 1 % by the data
sheet of the LSM6DSOX, a common part (emulate/sensors/parts.py)."""
EVENT_ERROR = 0.010
"""Scatter of a foot's heel-strikes within a recording, s: larger than that of toe-offs, on the recorded walks of
`tripod_treadmill` (docs/accuracy.md, by foot). On recorded walks whose swings are labelled, every difference that is
named beyond it is of the labelled foot (docs/clinic.md). Two settled clocks differ by 5 ms at most (docs/events.md), by
twice as much an asymmetry of step times errs."""

HALF_STRIDE = 0.5
"""Time from the middle of a stride to its end, s, about."""
MIN_PAIRS = 4
"""Least number of strides of the right foot between two of the left one; chosen by hand, as in show/outcomes."""

STRIDE_LENGTH, SWING_TIME, STEP_TIME = "stride_length", "swing_time", "step_time"
Span = tuple[float, float]
"""Start and end of a time, s."""


@frozen
class FootDifference:
    """A difference between the feet in steady strides of walking: (right - left) / mean of both, as a share."""

    value: float
    """Asymmetry of the gait table, of the feet's means."""
    paired: float
    """Mean difference of strides that follow each other (paired_difference)."""
    half_width: float
    """Half the width of the 95 % interval of `paired`, as a share."""
    error: float
    """Difference that the measurement may show where there is none, as a share."""
    is_vague: bool = False
    """True if its interval says nothing (outcomes/spread.py)."""

    @property
    def is_certain(self) -> bool:
        """True if the whole interval is beyond the error of the measurement, around either estimate."""
        least = min(abs(self.value), abs(self.paired)) if self.value * self.paired > 0.0 else 0.0
        return not self.is_vague and least - self.half_width > self.error


def foot_differences(
    strides: Sequence[GaitCycleMeasured], parameters: GaitParameters | None
) -> dict[str, FootDifference]:
    """Return the differences of stride length, swing time and step time that are known, by their names.

    `strides` are gait cycles in order of time. A difference that `parameters` lack, as step times on separate clocks
    are, is left out, and so are those of runs."""
    from ..outcomes.spread import VAGUE_ASYMMETRY, asymmetry

    known: dict[str, FootDifference] = {}
    if parameters is None:
        return known
    for name in (STRIDE_LENGTH, SWING_TIME, STEP_TIME):
        figure: Figure | None = getattr(parameters.both, name)
        value, paired, index = parameters.asymmetry(name), paired_difference(strides, name), asymmetry(strides, name)
        if figure is not None and value is not None and paired is not None and figure.mean > 0.0:
            error = LENGTH_ERROR if name == STRIDE_LENGTH else EVENT_ERROR / figure.mean
            is_vague = index is None or index.is_vague or paired[1] > VAGUE_ASYMMETRY
            known[name] = FootDifference(value, *paired, error, is_vague)
    return known


def paired_difference(strides: Sequence[GaitCycleMeasured], name: str) -> tuple[float, float] | None:
    """Return the mean of (right - left) / mean of both, and half the width of its 95 % interval, as shares.

    Each steady stride of the right foot is compared with the mean of the left ones before and after it, so that what
    both feet have in common, such as a change of speed, does not count. The interval is Student's t, with fewer strides
    for differences that resemble the one before (show/outcomes/spread.py). None with fewer than MIN_PAIRS."""
    from ..outcomes.quantiles import student_quantile
    from ..outcomes.spread import moments, steady_strides

    known = [stride for stride in steady_strides(strides) if getattr(stride, name) is not None]
    known.sort(key=lambda stride: stride.t_start)
    pairs = []
    for before, stride, after in zip(known, known[1:], known[2:], strict=False):
        left, right = 0.5 * (getattr(before, name) + getattr(after, name)), getattr(stride, name)
        is_between = before.foot is Foot.LEFT and stride.foot is Foot.RIGHT and before.t == after.t_start
        if is_between and left + right > 0.0:
            pairs.append((stride, 2.0 * (right - left) / (right + left)))
    if len(pairs) < MIN_PAIRS:
        return None
    sample = moments(pairs)
    independent = max(sample.mean_count, 2.0)
    return sample.mean, student_quantile(independent - 1.0) * sqrt(sample.variance / independent)


def gait_spans(
    spans: Sequence[tuple[float, float, Activity]], strides: Sequence[GaitCycleMeasured]
) -> dict[bool, list[Span]]:
    """Return the spans of time in which the wearer walked (False) and ran (True).

    Whether it was a run is known best from the strides: a runner's foot is on the ground for less than half of the gait
    cycle. In spans of walking and running the majority of the strides counts, and without strides the activity. Without
    activities, as with some recipes, it is from the first to the last gait cycle of the kind."""
    found: dict[bool, list[Span]] = {False: [], True: []}
    if all([activity is Activity.UNKNOWN for _, _, activity in spans]):
        for kind in found:
            times = [t for stride in strides if stride.running is kind for t in (stride.t_start, stride.t)]
            found[kind] = [(min(times), max(times))] if times else []
    for start, end, activity in spans:
        if activity in (Activity.WALKING, Activity.RUNNING):
            runs = [stride.running for stride in strides if start <= stride.t < end]
            found[2 * runs.count(True) > len(runs) if runs else activity is Activity.RUNNING].append((start, end))
    return found


def distance_in(
    spans: Sequence[Span], distances: Mapping[Foot, Sequence[tuple[float, float]]], absences: Absences
) -> float | None:
    """Return how far the wearer went in some spans of time, m: the mean of the feet measured; None without any.

    `distances` has pairs of the end of a stride, s, and the distance that the foot has gone until then, m. A stride
    counts where its middle is, because activities change in the middle of the first and the last one."""

    def until(pairs: Sequence[tuple[float, float]], t: float) -> float:
        k = bisect_right(pairs, t + HALF_STRIDE, key=lambda pair: pair[0])
        return pairs[k - 1][1] if k else 0.0

    known = {foot: pairs for foot, pairs in distances.items() if pairs}
    parts = [part for start, end in spans for part in absences.parts(start, end)]
    feet = [([known[foot] for foot in known if foot not in absent], a, b) for a, b, absent in parts]
    means = [fmean([until(pairs, b) - until(pairs, a) for pairs in there]) for there, a, b in feet if there]
    return fsum(means) if known else None
