"""Drift of the heading of each foot, from a walk there and back along one straight line.

The wearer walks a corridor or the straight of a track to and fro, and turns at its ends now to the left and now to the
right. All legs have the same direction, or the opposite one. What the track of a foot has turned from one leg to the
next is therefore its drift: `drift` for each usual stride, and `turning` for each rad that it has turned. Both are
fitted to the directions of the legs by a Kalman filter, with three times their usual sizes as a prior. If all turns are
to one side, only their sum for a leg with its turn is known, and the standard deviations say so."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import atan2, fsum, hypot, pi, remainder, sqrt

from ..body.fuse.both_feet import BothFeet
from ..body.fuse.common_error import DRIFT, HEADING_NOISE, TURNING
from ..body.fuse.position import MeanOfFeet
from ..calibration import Calibration, CalibrationError, HeadingCalibration, usual_strides
from ..events import Event, StrideTaken
from ..foot.navigate.bias import BIAS_WANDER, Bias
from ..recipes import DEFAULT
from ..types import Foot, Packet, Sample
from ..types.attrs import evolve, frozen
from ..types.checking import find_fault
from .session import Session

MIN_LEG, MIN_LEGS = 6.0, 4
"""Shortest leg, m, and least number of legs of a foot from which its drift is learnt."""
MAX_LEG_TURN, MIN_LEG_STRIDE = 0.35, 0.5
"""Largest turn, rad, and least length, m, of a stride of a leg."""
MAX_LEG_ERROR = 0.35
"""Largest difference of the direction of a leg from that of the one before or its opposite, rad; above it the walk is
not there and back."""
LEG_BOW = 0.1
"""Standard deviation of the lateral distance between both ends of a leg and the line, m: feet land beside it."""
DAY_DRIFT = 1.5e-4
"""Standard deviation of the change of the drift from one day to another, rad a stride: a tenth of a usual drift,
because nobody walks alike every day (assumed). The error of the bias on the day of the walk is added."""
DAY_TURNING = 0.001
"""Standard deviation of the change of the relative error of turns from one day to another, no unit (assumed)."""
PRIOR_FACTOR = 3.0
"""Ratio of the prior standard deviations to those of the session's filter, so that the walk decides."""


@frozen
class HeadingFit:
    """The drift of one foot, and how well it explains the walk."""

    foot: Foot
    heading: HeadingCalibration
    """Drift of the foot."""
    legs: int
    """Number of legs."""
    duration: float
    """Time from the first leg to the last one, s."""
    before: float
    """Root mean square of the differences of the directions of the legs, rad."""
    after: float
    """The same without the drift, rad."""


@frozen
class _Leg:
    t: float
    direction: float
    length: float
    strides: float
    turn: float


def heading_walk(source: Iterable[Packet | Sample], calibration: Calibration | None = None) -> list[HeadingFit]:
    """Return the drift of each foot that walked; CalibrationError says why a foot does not show it, or none walked."""
    known = calibration or Calibration()
    # each foot by itself, without any earlier calibration of its heading
    session = Session(DEFAULT.replace_part(BothFeet, MeanOfFeet()), calibration=evolve(known, headings={}))
    taken: dict[Foot, list[StrideTaken]] = {foot: [] for foot in Foot}
    before: dict[Foot, Bias] = {}
    for one in source:
        _sort_strides(session.feed(one), taken)
        for foot, tracker in session.feet.items():
            if taken[foot] and foot not in before:
                before[foot] = tracker.rest.bias_filter.bias
    _sort_strides(session.finish(), taken)
    feet = session.feet
    fits: list[HeadingFit] = []
    reasons: list[str] = []
    for foot, strides in taken.items():
        after = feet[foot].rest.bias_filter.bias if foot in feet else Bias()
        found = fit_heading(foot, strides, before.get(foot, Bias()), after)
        if isinstance(found, HeadingFit):
            fits.append(found)
        elif strides:
            reasons.append(f"{foot.value} foot: {found}")
    if reasons and fits:
        reasons.append(f"the {fits[0].foot.value} foot alone shows its drift")
    if reasons or not fits:
        raise CalibrationError("; ".join(reasons) or "no strides")
    return fits


def _sort_strides(events: Iterable[Event], taken: dict[Foot, list[StrideTaken]]) -> None:
    for event in events:
        if isinstance(event, StrideTaken):
            taken[event.foot].append(event)


def fit_heading(foot: Foot, strides: Sequence[StrideTaken], before: Bias, after: Bias) -> HeadingFit | str:
    """Return the drift of a foot from its strides, or the reason why they do not show it.

    `before` and `after` are the gyroscope biases that the rests before and after the walk have shown. The error of the
    bias is part of the drift on this day, and another one on any other day, so it is taken off."""
    legs = _find_legs(strides)
    if len(legs) < MIN_LEGS:
        return f"{len(legs)} straight legs of {MIN_LEG:g} m and more, of which {MIN_LEGS} are needed"
    directions = [legs[0].direction]
    for leg in legs[1:]:
        step = remainder(leg.direction - directions[-1], pi)
        if abs(step) > MAX_LEG_ERROR:
            return "its legs do not lead there and back along one line"
        directions.append(directions[-1] + step)
    drift, turning, drift_variance, turning_variance = _filter(legs, directions)
    first, last = legs[0], legs[-1]
    stride_time = (last.t - first.t) / (last.strides - first.strides)
    turned, bias_sigma = _bias_error(before, after, last.t - first.t)
    left = [
        direction + drift * (leg.strides - first.strides) + turning * (leg.turn - first.turn)
        for leg, direction in zip(legs, directions, strict=True)
    ]
    heading = HeadingCalibration(
        drift=drift - turned * stride_time,
        turning=turning,
        drift_sigma=hypot(sqrt(drift_variance), DAY_DRIFT, bias_sigma * stride_time),
        turning_sigma=hypot(sqrt(turning_variance), DAY_TURNING),
    )
    fault = find_fault(heading, HeadingCalibration)
    if fault is not None:
        return str(fault)
    if heading.drift_sigma >= DRIFT:
        return "the walk is too short, or turns to one side only: it shows less than is known of any foot"
    return HeadingFit(foot, heading, len(legs), last.t - first.t, _spread(directions), _spread(left))


def _bias_error(before: Bias, after: Bias, duration: float) -> tuple[float, float]:
    """Return the mean rate by which the bias turned the heading in a walk of this duration, s, and its sigma, rad/s.

    With a rest after the walk, the bias of the walk was on average that between both rests."""
    wander = BIAS_WANDER * sqrt(duration / 3.0)
    known = sqrt(before.variances[0])
    if after.spans == before.spans:
        return 0.0, hypot(known, wander)
    return -0.5 * (after.change - before.change), hypot(0.5 * known, 0.5 * sqrt(after.variances[0]), 0.5 * wander)


def _spread(directions: Sequence[float]) -> float:
    """Return the root mean square of the differences of directions from their mean, rad."""
    mean = fsum(directions) / len(directions)
    return sqrt(fsum((one - mean) ** 2 for one in directions) / len(directions))


def _filter(legs: Sequence[_Leg], directions: Sequence[float]) -> tuple[float, float, float, float]:
    """Return drift and turning and their variances from the directions of legs, rad, by a Kalman filter.

    Its states are the direction of the line on the track h, drift r and turning k. Between two legs, with n usual
    strides and a turn of theta, h' = h - n r - theta k, and h walks at random; the direction of a leg measures h."""
    h, r, k = directions[0], 0.0, 0.0
    hh = 2.0 * (LEG_BOW / legs[0].length) ** 2
    hr = hk = rk = 0.0
    rr, kk = (PRIOR_FACTOR * DRIFT) ** 2, (PRIOR_FACTOR * TURNING) ** 2
    for (before, leg), direction in zip(pairwise(legs), directions[1:], strict=True):
        n, turn = leg.strides - before.strides, leg.turn - before.turn
        h -= n * r + turn * k
        ar, ak = n * rr + turn * rk, n * rk + turn * kk
        hh += n * ar + turn * ak - 2.0 * (n * hr + turn * hk) + HEADING_NOISE * HEADING_NOISE * (leg.t - before.t)
        hr, hk = hr - ar, hk - ak
        s = hh + 2.0 * (LEG_BOW / leg.length) ** 2
        innovation, a, b, c = direction - h, hh / s, hr / s, hk / s
        h, r, k = h + a * innovation, r + b * innovation, k + c * innovation
        rr, rk, kk = rr - b * hr, rk - b * hk, kk - c * hk
        hh, hr, hk = (1.0 - a) * hh, (1.0 - a) * hr, (1.0 - a) * hk
    return r, k, rr, kk


def heading_calibration(fits: Iterable[HeadingFit]) -> Calibration:
    """Return the calibration that a session takes."""
    return Calibration(headings={fit.foot: fit.heading for fit in fits})


def _find_legs(strides: Sequence[StrideTaken]) -> list[_Leg]:
    """Return the runs of strides without a turn, with what the foot had walked and turned at the middle of each."""
    legs: list[_Leg] = []
    run: list[StrideTaken] = []
    counts: list[tuple[float, float]] = []
    count = turn = 0.0

    def close() -> None:
        x, y = (fsum(stride.displacement[axis] for stride in run) for axis in range(2))
        if hypot(x, y) >= MIN_LEG:
            done, turned = (fsum(one[k] for one in counts) / len(counts) for k in range(2))
            middle = 0.5 * (run[0].t_start + run[-1].t_end)
            legs.append(_Leg(middle, atan2(y, x), hypot(x, y), done, turned))
        run.clear()
        counts.clear()

    for stride in strides:
        usual = usual_strides(stride.length)
        if abs(stride.heading_change) > MAX_LEG_TURN or stride.length < MIN_LEG_STRIDE:
            close()
        else:
            run.append(stride)
            counts.append((count + 0.5 * usual, turn + 0.5 * stride.heading_change))
        count, turn = count + usual, turn + stride.heading_change
    close()
    return legs
