"""The heading by straight ways: its drift, and whether its calibration fits.

Borenstein and Ojeda, "Heuristic drift elimination for personnel tracking systems", Journal of Navigation 63, 2010,
assume that a nearly straight path is straight: people walk straight on for long stretches, in any direction, and a
gyroscope that drifts bends these stretches by nearly the same angle in every stride. No sensor measures that a stretch
is straight, so it is tested.

A stretch consists of strides in nearly one direction. At its end a parabola is fitted to it. People wander about a
straight line by some centimetres, which leaves its curvature uncertain: by 1.3 1/km after 20 m of straight way, by 0.1
1/km after 60 m. The curvature that remains is that of the drift, of a gentle bend, or of a bend. The probability of
each follows from the curvature (all three are normal distributions) and from how often each was met before on this
walk, so that the drift is learnt in corridors, and not in a ring, on a track or on a plaza. A stretch that leaves its
parabola by more than people wander is not straight.

Two hypotheses predict how the straight ways of this walk bend: the feet drift as `solepath calibrate walk` found, up to
its standard deviation, or the calibration is of other shoes or sensors, and they drift as uncalibrated feet do. Each
is a filter of one state, the drift that remains after the calibration is removed (Bar-Shalom et al. 2001, section 1.4).
A way may bend by itself under both. The calibration is dropped when the second hypothesis explains the walk better by
far, and makes most of its ways straight: those of a wearer who weaves bend alike to the left and to the right."""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Mapping
from math import atan2, degrees, exp, fsum, hypot, log, sqrt

from ...calibration import HeadingCalibration
from ...events import StrideTaken
from ...types import Floats, Foot, Vec2
from ...types.attrs import define, evolve, field, frozen
from ...types.vector import add, wrap_angle
from .common_error import BIAS, DRIFT, FEET, MAX_TURN_BACK, NO_MOVE, TURN, TURNING, CommonError, Move

MAX_FOOT_TURN = 0.2
"""Largest turn of a foot in a stride of a stretch, rad; feet turn by some degrees from stride to stride anyway."""
MIN_ADVANCE = 0.4
"""Shortest stride of a stretch, m."""
MAX_DEVIATION, DEVIATION_STRIDES = 0.17, 4
"""Largest angle between the way of the last strides and the stretch so far, rad, and number of these strides."""
MAX_PAUSE = 3.0
"""Longest time between the ends of two strides of a stretch, s."""
MIN_LENGTH, MAX_LENGTH = 7.0, 80.0
"""Shortest stretch that is used, and length at which a longer one is divided, m."""
MIN_STRIDES = 8
"""Least number of strides of a stretch that is used."""
FOOTFALL = 0.015
"""Standard deviation of the middle of both feet from the smooth way of the body, m; feet land 2 to 3 cm to a side."""
USUAL_WANDER, WANDER_WEIGHT, MAX_WANDER_WEIGHT = 0.05, 4.0, 30.0
"""Usual standard deviation of the wandering about a straight line, m, the number of stretches as which it counts in the
mean over the stretches of a wearer, and the largest such number. (Legs of 9 m in `ipol_10m_uturn` bow by 5 to 7 cm.)"""
WANDER_LENGTH, MIN_INDEPENDENT = 4.5, 7.0
"""Length after which the wandering is another one, m, and least number of such lengths that a curvature counts.

Both describe the curvature of parabolas that are fitted to a spline with random knots every 5 m. Emulated wearers
wander by the same spline (solepath_lab/emulated/unsteady.py), so they do not prove these numbers."""
MAX_WANDER_SHARE, HALF_SHARE_LENGTH = 0.75, 16.0
"""Share of the wandering that a parabola through a long stretch leaves, and length at which it leaves half of that, m;
of the same spline."""
FITTED_PLACES = 6.0
"""Number of places that is added to that of a stretch, because the factor below holds for many only."""
CURVATURE_FACTOR = sqrt(720.0)
"""Standard deviation of the curvature of a parabola through n points of standard deviation s on a length L: this number
times s / (L^2 sqrt(n)), for large n."""
MAX_RESIDUAL = 5.0
"""Largest ratio of the mean square of the distances from the parabola to the expected one."""
DRIFT_SCATTER = 2.5e-4
"""Standard deviation of the drift of one stretch from the mean drift, rad a stride, because the bias wanders."""
GATE = 9.0
"""Largest squared drift, divided by its variance, that is attributed to the gyroscope."""
GENTLE_BEND, BEND = 0.006, 0.03
"""Standard deviations of the curvature of ways that bend gently, and of bends, 1/m."""
FIRST_COUNTS = (1.0, 1.0, 1.0)
"""Number of stretches as which it counts before any walk that stretches are straight, bend gently, and bend."""
FORGETTING = 0.97
"""Factor of all counts at each stretch: about the last thirty count."""
LONGEST_STRIDE_TIME = 2.0
"""Longest duration of a stride that walks, s; in a longer one the wearer stood first."""
DROP_RATIO = 1000.0
"""Ratio of the likelihoods above which the calibration is dropped, no unit: 1 in 100 is of other shoes, and 10 to 1 is
certain enough."""
STRAIGHT_SHARE = 0.7
"""Share of the stretches that are straight, the others bend by themselves (assumed)."""
LEAST_SHARE, LEAST_COUNT = 0.75, 4.0
"""Least share of the stretches that are straight without the calibration, and least number of stretches, before it is
dropped. On a way that bends to the left and to the right in turn the share is a half."""
BEND_SIGMA = 0.04
"""Standard deviation of the bend of a way that is not straight, rad a stride: 1/30 m."""
CALIBRATED = tuple([row + one for row in FEET.values() for one in (0, TURN)])
"""Rows of the common errors that a calibration knows: drift and turning of the left foot, then of the right one."""


@frozen
class StretchDrift:
    """The drift that a straight stretch shows."""

    drift: float
    """Turn of the heading in a usual stride that makes the stretch straight, rad, positive to the left."""
    variance: float
    """Variance of `drift`, rad^2."""
    weight: float
    """Probability that the stretch is straight, from 0 to 1."""
    stride_time: float
    """Mean duration of a usual stride of the stretch, s."""


@frozen
class Places:
    """The places of a stretch, strides in nearly one direction, as the sums from which a parabola is found."""

    t_start: float
    """End of the first stride, s."""
    t: float
    """Time of the newest place, s."""
    x: float
    """Newest place along the first direction of the stretch, from its start, m."""
    y: float
    """Newest place to the left of that direction, m."""
    strides: float = 0.0
    """Number of usual strides in which the heading of the mean of both feet has drifted since the start."""
    count: int = 0
    sums: Floats = (0.0,) * 8
    """Sums of x, x^2, x^3, x^4, y, x y, x^2 y and y^2."""

    def add(self, t: float, x: float, y: float, strides: float) -> Places:
        """Return the places with one more at `t`, s, after `strides` more usual strides."""
        square = x * x
        more = (x, square, square * x, square * square, y, x * y, square * y, y * y)
        sums = tuple(map(float.__add__, self.sums, more))
        return Places(self.t_start, t, x, y, self.strides + strides, self.count + 1, sums)

    def parabola(self) -> Vec2 | None:
        """Return the curvature, 1/m, of the parabola of least squares and the mean square distance from it, m^2."""
        n, (s1, s2, s3, s4, t0, t1, t2, square) = float(self.count), self.sums
        # normal equations of y = a + b x + c x^2, solved by Cramer's rule
        m0, m1, m2, m3 = s2 * s4 - s3 * s3, s1 * s4 - s2 * s3, s1 * s3 - s2 * s2, n * s3 - s1 * s2
        determinant = n * m0 - s1 * m1 + s2 * m2
        if determinant <= 0.0:
            return None
        a = (t0 * m0 - t1 * m1 + t2 * m2) / determinant
        b = (-t0 * m1 + t1 * (n * s4 - s2 * s2) - t2 * m3) / determinant
        c = (t0 * m2 - t1 * m3 + t2 * (n * s2 - s1 * s1)) / determinant
        return 2.0 * c, max(0.0, square - a * t0 - b * t1 - c * t2) / n


@define
class Straightness:
    """Collects the strides of a stretch, and keeps what was learnt from earlier stretches."""

    direction: float = 0.0
    """Direction of the first stride of the stretch, rad, world frame."""
    t: float | None = None
    """End of the newest stride, s; None before any stretch."""
    recent: list[Places] = field(factory=list)
    """The places after each of the last strides, the newest last; empty without a stretch."""
    left_out: int = 0
    """Number of strides that are left out before the next stretch starts, because the wearer still turns."""
    counts: Floats = FIRST_COUNTS
    """Number of stretches that were straight, that bent gently and that bent, each fading by `FORGETTING`."""
    wander: Vec2 = (USUAL_WANDER * USUAL_WANDER, WANDER_WEIGHT)
    """Variance of the wandering, m^2, and the number of stretches as which it counts."""

    def add_stride(self, t: float, displacement: complex, share: float, strides: float, turn: float) -> Places | None:
        """Add a stride that ended at `t`, s; return the stretch that it has ended, if that is long enough.

        `displacement` is in m, world frame, `turn` that of the foot, rad. The mean of both feet moves and drifts by
        `share` of the stride, which counts as `strides` usual ones."""
        paused = self.t is not None and abs(t - self.t) > MAX_PAUSE  # the feet's clocks may be apart
        self.t = t
        if paused or abs(turn) > MAX_FOOT_TURN or hypot(displacement.real, displacement.imag) < MIN_ADVANCE:
            found = self._end(self.recent[-1]) if self.recent else None
            self.recent, self.left_out = [], 0
            return found
        if self.left_out:
            self.left_out -= 1
            return None
        if not self.recent:
            self._start(phase(displacement))
        newest, earlier = self.recent[-1], self.recent[0]
        moved = displacement * rect(1.0, -self.direction)
        x, y = newest.x + share * moved.real, newest.y + share * moved.imag
        if len(self.recent) > DEVIATION_STRIDES:
            deviation = atan2(y - earlier.y, x - earlier.x) - atan2(y, x)
            if abs(wrap_angle(deviation)) > MAX_DEVIATION:  # the wearer has turned off, perhaps some strides ago
                found = self._end(earlier)
                self.recent, self.left_out = [], DEVIATION_STRIDES // 2
                return found
        self.recent = [*self.recent[-DEVIATION_STRIDES:], newest.add(t, x, y, share * strides)]
        if x <= MAX_LENGTH:
            return None
        found = self._end(self.recent[-1])
        self._start(self.direction)
        return found

    def reset(self) -> None:
        """Discard the stretch, because the clock restarts or another device is worn."""
        self.direction, self.recent, self.left_out, self.t = 0.0, [], 0, None

    def drift_of(self, places: Places, drift_sigma: float) -> StretchDrift | None:
        """Return the drift that a stretch shows, and learn from it how this wearer walks; None without a parabola.

        `drift_sigma` is the standard deviation of the estimated drift, rad a stride, which is already removed from the
        strides."""
        length, fit = places.x, places.parabola()
        if fit is None:
            return None
        (curvature, mean_square), (variance, weight), footfall = fit, self.wander, FOOTFALL * FOOTFALL
        independent = max(MIN_INDEPENDENT, length / WANDER_LENGTH)
        error = (CURVATURE_FACTOR / (length * length)) ** 2 * (
            variance / independent + footfall / (places.count + FITTED_PLACES)
        )
        per_stride = length / places.strides  # rad a stride for a curvature in 1/m
        z, noise = -curvature * per_stride, error * per_stride * per_stride + DRIFT_SCATTER * DRIFT_SCATTER
        s = drift_sigma * drift_sigma + noise
        share = MAX_WANDER_SHARE * length * length / (length * length + HALF_SHARE_LENGTH * HALF_SHARE_LENGTH)
        expected = share * share * variance + footfall
        variances = (s, s + (GENTLE_BEND * per_stride) ** 2, s + (BEND * per_stride) ** 2)
        likely = [count * exp(-0.5 * z * z / v) / sqrt(v) for count, v in zip(self.counts, variances, strict=True)]
        if z * z > GATE * s or mean_square > MAX_RESIDUAL * expected:
            likely[0] = 0.0
        total = fsum(likely)
        shares = [one / total for one in likely] if total > 0.0 else [0.0, 0.0, 1.0]
        self.counts = tuple([FORGETTING * old + new for old, new in zip(self.counts, shares, strict=True)])
        if shares[0] > 0.5 and length > 2.0 * MIN_LENGTH:
            seen = max(0.0, mean_square - footfall) / (share * share)
            self.wander = (variance + (seen - variance) / (weight + 1.0), min(weight + 1.0, MAX_WANDER_WEIGHT))
        return StretchDrift(z, noise, shares[0], max(0.0, (places.t - places.t_start) / places.strides))

    def _end(self, places: Places) -> Places | None:
        is_long = places.count >= MIN_STRIDES and places.x >= MIN_LENGTH and places.strides > 0.0
        return places if is_long else None

    def _start(self, direction: float) -> None:
        self.direction, t = direction, self.t or 0.0
        self.recent = [Places(t, t, 0.0, 0.0).add(t, 0.0, 0.0, 0.0)]


@define
class DriftHypothesis:
    """The drift that remains after the calibration, under one hypothesis."""

    drift: float
    """Estimated drift, rad a stride."""
    variance: float
    """Variance of `drift`, rad^2."""
    straight: float = 0.0
    """Number of stretches that are straight with this drift: the sum of their probabilities."""

    def add(self, found: StretchDrift, seen: float) -> float:
        """Take in the drift `seen` on a stretch, rad a stride; return the logarithm of its likelihood."""
        z, s = seen - self.drift, self.variance + found.variance
        bent = found.variance + BEND_SIGMA * BEND_SIGMA
        straight = STRAIGHT_SHARE * exp(-0.5 * z * z / s) / sqrt(s)
        total = straight + (1.0 - STRAIGHT_SHARE) * exp(-0.5 * seen * seen / bent) / sqrt(bent) + 1e-300
        weight, gain = straight / total, self.variance / s
        self.straight += weight
        self.drift += weight * gain * z
        self.variance *= max(0.0, 1.0 - weight * gain)
        self.variance += weight * (1.0 - weight) * gain * gain * z * z
        return log(total)


@define
class CalibrationFit:
    """Evidence on whether the calibration of the heading fits a walk."""

    fits: DriftHypothesis
    """The feet drift as calibrated."""
    other: DriftHypothesis
    """The feet drift as if they had not been calibrated."""
    evidence: float = 0.0
    """Logarithm of the ratio of the likelihoods of `other` and `fits`, at least 0."""
    count: float = 0.0
    """Number of stretches since `evidence` was last 0."""

    def add(self, found: StretchDrift, seen: float) -> bool:
        """Take in the drift `seen` on a stretch, rad a stride; return whether the calibration does not fit."""
        if not self.evidence:
            self.count = self.other.straight = 0.0
        self.count += 1.0
        self.evidence = max(0.0, self.evidence + self.other.add(found, seen) - self.fits.add(found, seen))
        is_straight = self.count >= LEAST_COUNT and self.other.straight >= LEAST_SHARE * self.count
        return is_straight and self.evidence > log(DROP_RATIO)


@define
class StraightWays:
    """Learns the drift of the heading from straight ways, and drops a calibration that they contradict."""

    straightness: Straightness = field(factory=Straightness)
    calibrated: Floats | None = None
    """Drift, rad a stride, and turning, no unit, of each foot that a calibration says and the feet remove, as in
    `CALIBRATED`; None without one, and once it was dropped."""
    fit: CalibrationFit | None = None
    """Test of the calibration; None before the first stretch."""
    moved: list[list[float]] = field(factory=list)
    """Derivatives of x and y, m, and of the heading, rad, over the whole walk by each of these errors; empty without a
    calibration."""
    devices: tuple[int, ...] = (0, 0)
    """Number of times that another device may have been connected to the left and to the right foot."""

    def use_calibration(self, headings: Mapping[Foot, HeadingCalibration]) -> None:
        """Test this calibration from the first stretch on."""
        known = [(0.0, 0.0) if one is None else (one.drift, one.turning) for one in map(headings.get, Foot)]
        self.calibrated, self.moved = (*known[0], *known[1]), [[0.0, 0.0, 0.0] for _ in CALIBRATED]

    def reset(self) -> None:
        """Discard the stretch that has begun."""
        self.straightness.reset()

    def add_stride(
        self, event: StrideTaken, strides: float, displacement: complex, common: CommonError, spoiled: bool = False
    ) -> tuple[Move, str | None]:
        """Add a stride of a foot; correct the `common` errors by what a straight stretch shows.

        It counts as `strides` usual ones, and its `displacement` is in m. Returns the correction of the tracks, and a
        sentence if the calibration was dropped. A stride of a foot that a defect has `spoiled` ends the stretch, and
        nothing is learnt from it."""
        share, turn = common.shares[event.foot], event.heading_change
        devices = tuple([0 if one is None else one.device for one in common.foot_biases.values()])
        if devices != self.devices:  # a calibration of the old one neither fits nor misfits any longer
            self._forget_calibration()
            self.devices = devices
        if self.moved:
            self._move({FEET[event.foot]: share * strides, FEET[event.foot] + TURN: share * turn}, share * displacement)
        if spoiled:
            self.straightness.reset()
            return NO_MOVE, None
        stretch = self.straightness.add_stride(event.t_end, displacement, share, strides, turn)
        if stretch is None:
            return NO_MOVE, None
        sigma = sqrt(common.drift_variance(min(event.t_end - event.t_start, LONGEST_STRIDE_TIME)))
        found = self.straightness.drift_of(stretch, sigma)
        if found is None:
            return NO_MOVE, None
        t = found.stride_time
        if self.calibrated is not None:
            fit = self.fit
            if fit is None:
                known, usual = common.drift_variance(0.0), _square_share(common) * DRIFT * DRIFT
                other = DriftHypothesis(-_mean_drift(self.calibrated, common), usual + known)
                fit = self.fit = CalibrationFit(DriftHypothesis(0.0, known), other)
            # of the rate at which the biases of the feet turn the heading
            rate_variance = common.variance_of([(row + BIAS, common.shares[foot]) for foot, row in FEET.items()])
            bias_known = evolve(found, variance=found.variance + t * t * rate_variance)
            if fit.add(bias_known, found.drift + common.drift_with_bias(t)):
                rate = fit.other.drift / t if t > 0.0 else 0.0  # feet whose clocks are apart may show no time
                return self._drop(self.calibrated, fit.other, common), MISFIT.format(abs(degrees(60.0 * rate)))
        return common.correct_drift(found.drift, found.variance, found.weight, t), None

    def _move(self, turns: Mapping[int, float], moved: complex) -> None:
        """Add a stride to the derivatives: its own turn by the errors of some rows, and its move, m."""
        for row, one in zip(CALIBRATED, self.moved, strict=False):
            more = turns.get(row, 0.0)
            middle = one[2] + 0.5 * more
            one[0] -= moved.imag * middle
            one[1] += moved.real * middle
            one[2] += more

    def _forget_calibration(self) -> None:
        self.calibrated, self.fit, self.moved = None, None, []

    def _drop(self, calibrated: Floats, other: DriftHypothesis, common: CommonError) -> Move:
        """Take the calibration back from the whole track; both feet drift as the `other` hypothesis says."""
        total, mean = NO_MOVE, _mean_drift(calibrated, common)
        variance = other.variance / _square_share(common)
        for row, value, moved in zip(CALIBRATED, calibrated, self.moved, strict=True):
            new = (other.drift + mean - value, variance) if row in FEET.values() else (-value, TURNING * TURNING)
            total = add(total, common.replace(row, *new, moved))
        self._forget_calibration()
        x, y, heading = total
        if abs(heading) > MAX_TURN_BACK:  # the derivatives do not hold so far: say only how wrong the track may be
            common.inflate(x * x + y * y, heading)
            return NO_MOVE
        return total


MISFIT = (
    "the calibration of the heading does not fit this walk: with it, straight ways bend by {:.0f} degrees a minute. It "
    "is not used any longer. Walk there and back again with these shoes and sensors (solepath calibrate walk)"
)
"""Sentence on a calibration that is dropped."""


def _mean_drift(calibrated: Floats, common: CommonError) -> float:
    return fsum([share * drift for share, drift in zip(common.shares.values(), calibrated[::2], strict=True)])


def _square_share(common: CommonError) -> float:
    return fsum([share * share for share in common.shares.values()])
