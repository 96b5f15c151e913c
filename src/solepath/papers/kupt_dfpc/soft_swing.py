"""Corrector of ours in place of (8): each known velocity weighs what its own error allows.

(8) of Chen et al. 2019 (IEEE Internet of Things Journal 6, section III.C.3) takes the velocities of the rolling shoe
for exact and the drift in swing for linear; fig. 14 shows that it is not. Here the error of the raw velocity at motion
end is a sum of three independent parts: what arises until toe-off, in swing, and after heel-strike. Their variances are
those of the motion between samples (`MotionMoment.drift`). The velocity errors at toe-off (7), at heel-strike (5) and
at motion end (zero velocity) are measurements of the first part, of the first two, and of all three. The displacement
is corrected by each part times the time since it arose.

With exact rolling velocities and half of the swing as the time of its drift, this is (8). With rolling velocities that
nobody can trust only the zero velocity at the end is left, as in ZUPT: KUPT falls back by degrees."""

from __future__ import annotations

from math import fsum, hypot
from typing import ClassVar

from ...types import Vec3
from ...types.attrs import evolve, state, stateful
from ...types.vector import GRAVITY, add, dot, sub
from .kinematics import up_direction
from .swing_drift import MotionMoment, SwingDedrift

Parts = tuple[float, float, float]
"""One number for each part: what arises until toe-off, in swing, and after heel-strike."""

ZERO_VELOCITY_NOISE = 1e-4
"""Variance of the zero velocity of a standing foot, m^2/s^2: that of `KnownVelocitySettings.sigma`."""
ROLLING_NOISE = 0.15**2
"""Variance of the velocity of a rolling shoe, m^2/s^2: a pivot 2 cm off at 5 rad/s, and a slide of 0.1 m/s (assumed).

That is a third of the speed of a sensor at toe-off. Learning pivot and slide from the strides gained nothing."""
LEAST_VARIANCE = 1e-8
"""Least variance of a part of the velocity error, m^2/s^2."""
DRIFT_RATIO = 0.01
"""Variance of the velocity error for each unit of `MotionMoment.drift`: a tenth of each difference between samples."""
BIAS_SHARE = 0.8
"""Share of the difference from 1 g at rest that is taken for an upward bias of the accelerometer.

The remainder is an error of its scale. Typical zero-g offsets in data sheets (LSM6DSOX, MPU-9250, MPU-6050) are twice
as large as 1 g times the tolerance of the scale; so four fifths of the variance of that difference are offset."""
TIME_SPREAD, TIME_MISMATCH = 0.3, 0.2
"""Standard deviation of the mean time of the drift before the first stride, and of its difference between the vertical
and the horizontal axes, as shares of the swing.

The first is that of an even distribution over the swing. The second was chosen by hand; emulated walks of 20 m at 30 Hz
differ by 0.01 m from 0.1 to 0.3."""
RISE_SPREAD, RISE_NOISE = 0.04, 0.01
"""Standard deviation of the mean rise of level strides by the raw velocity, and of one stride about it, m.

A bias of 0.1 m/s^2 raises a stride of 0.9 s by 0.04 m. The floor is level within a centimetre."""
TIME_WEIGHT = TIME_SPREAD**2 / (TIME_SPREAD**2 + TIME_MISMATCH**2)
"""Share of a deviation of the vertical time of the drift from one half that the horizontal time has on average."""
STEPPED_RISE = 0.1
"""Difference of a stride's rise from the expected one above which it went up or down a step, m."""


class DriftParts:
    """The parts of the horizontal velocity error of one motion, independent and isotropic at first.

    Both axes have the same covariance, because they are measured together and with the same noise. A foot needs this
    only while a motion ends, so it is in no snapshot."""

    __slots__ = ("covariance", "parts")

    def __init__(self, variances: Parts) -> None:
        first, swing, last = variances
        self.parts = [0j, 0j, 0j]
        self.covariance = [[first, 0.0, 0.0], [0.0, swing, 0.0], [0.0, 0.0, last]]

    def measure(self, count: int, error: Vec3, noise: float) -> None:
        """Use a measured sum of the first `count` parts, m/s along x and y, with this variance, m^2/s^2."""
        with_sum = [fsum(row[:count]) for row in self.covariance]
        variance, rest = noise + fsum(with_sum[:count]), complex(error[0], error[1])
        for part in self.parts[:count]:
            rest -= part
        for k, row in enumerate(self.covariance):
            gain = with_sum[k] / variance
            self.parts[k] += gain * rest
            self.covariance[k] = [value - gain * other for value, other in zip(row, with_sum, strict=True)]

    def displacement(self, ages: Parts) -> complex:
        """Return the error of the displacement x + iy, m; `ages` are the times since the parts arose, s."""
        moved = 0j
        for age, part in zip(ages, self.parts, strict=True):
            moved += age * part
        return moved


@stateful
class DriftTime:
    """Mean time at which the velocity drifts in swing, as a share of the swing from toe-off to heel-strike.

    Of a stride of level walking the rise is known: it is zero. The rise by the raw velocity is the vertical velocity
    error at the end, times the time since it arose. So the rises of strides show the time of the vertical drift,
    `vertical`. The horizontal velocity need not drift at the same time, so its share is in between that and one half,
    which is the linear drift of (8). The rise that all strides have in common comes from a bias. It is learnt beside
    the time and tells nothing of it."""

    vertical: float = 0.5
    """Share for the vertical velocity."""
    rise: float = 0.0
    """Rise that all strides have in common, m."""
    vertical_variance: float = TIME_SPREAD**2 + TIME_MISMATCH**2
    """Variance of `vertical`."""
    covariance: float = 0.0
    """Covariance of `vertical` and `rise`, m."""
    rise_variance: float = RISE_SPREAD * RISE_SPREAD
    """Variance of `rise`, m^2."""

    @property
    def share(self) -> float:
        """Share for the horizontal velocity."""
        return 0.5 + TIME_WEIGHT * (self.vertical - 0.5)

    def add(self, rise: float, slope: float) -> None:
        """Add a stride with this rise, m, if all of the drift came at toe-off; `slope` is its change per share, m."""
        error = rise - self.rise - slope * self.vertical
        if abs(error) > STEPPED_RISE:
            return
        cross = self.covariance + slope * self.vertical_variance
        whole = self.rise_variance + slope * self.covariance
        variance = whole + slope * cross + RISE_NOISE * RISE_NOISE
        self.vertical = min(max(self.vertical + cross / variance * error, 0.0), 1.0)
        self.rise += whole / variance * error
        self.vertical_variance -= cross * cross / variance
        self.covariance -= cross * whole / variance
        self.rise_variance -= whole * whole / variance


@stateful
class SoftSwing(SwingDedrift):
    """Corrector that weighs the velocities of the rolling shoe, and learns the time of the drift.

    Latency as in `SwingDedrift`: the position is corrected in one jump at motion end. In a motion without toe-off,
    without heel-strike or with a gap one linear drift is removed. While the foot moves, the live position follows the
    velocity of the rolling shoe horizontally, and the raw velocity vertically: the vertical rolling velocity is about
    L_r times the pitch rate, so a pivot that is 1 cm off at toe-off errs by 8 cm/s there."""

    slide_time: ClassVar[float] = 0.02
    """Time after heel-strike in which the heel slides and the sole gives way, which (4) does not model, s."""
    largest_rolling_error: ClassVar[float] = 0.6
    """Horizontal difference of rolling and raw velocity in push-off above which the rolling velocity is not used, m/s.

    The raw velocity is zero at motion start. Some tenths of a second later, when the foot leaves the ground, a tilt
    error of 2 degrees and an accelerometer error of 20 mg cause an error of 0.16 m/s, and a rolling velocity has one of
    0.1 m/s. Three times their combination is 0.57. The difference is up to 0.05 for emulated feet, up to 0.5 for
    recorded feet that roll, and 0.7 to 1.3 for recorded insoles whose cells release the load late: the foot then moves
    already and does not roll."""

    drift_time: DriftTime = state(factory=DriftTime)
    """Time of the drift in swing."""
    drift: float = 0.0
    """Drift of this motion so far (`MotionMoment.drift`)."""
    upright: Vec3 = (0.0, 0.0, 1.0)
    """Upward direction in the sensor frame at motion start."""
    scale_excess: float = 0.0
    """Difference from 1 g at rest that is taken for a bias, as a share of 1 g."""

    def scaled(self, scale: float) -> None:
        self.scale_excess = BIAS_SHARE * (1.0 / scale - 1.0)

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        last, excess = self.force, self.scale_excess
        # undo the scale, and subtract a bias along the direction that is upwards in a standing foot
        unscaled = add(add(acc, acc, excess), self.upright, -excess * GRAVITY)
        SwingDedrift.predict(self, dt, unscaled, gyro, saturated)
        if last is not None and self.force is not None:
            change = sub(self.force, last)
            self.drift += dot(change, change) * dt * dt

    def _start_motion(self) -> None:
        SwingDedrift._start_motion(self)
        self.drift = 0.0
        self.upright = up_direction(self.attitude)

    def _use_velocity(self, v_ref: Vec3, push_off: bool) -> Vec3 | None:
        height, climb = self.position[2], self.velocity[2]
        error = SwingDedrift._use_velocity(self, v_ref, push_off)
        self.position, self.velocity = (*self.position[:2], height), (*self.velocity[:2], climb)
        return error

    def _moment(self, error: Vec3 | None) -> MotionMoment:
        return evolve(SwingDedrift._moment(self, error), drift=self.drift)

    def _calibrated_displacement(self, duration: float) -> Vec3 | None:
        toe_off, landed = self.toe_off, self.heel_strike
        if self.has_gap or toe_off is None or landed is None or landed.elapsed <= toe_off.elapsed:
            return None
        before, flight, after = toe_off.elapsed, landed.elapsed - toe_off.elapsed, duration - landed.elapsed
        first, swing, last = variances = (
            DRIFT_RATIO * toe_off.drift + LEAST_VARIANCE,
            DRIFT_RATIO * (landed.drift - toe_off.drift) + LEAST_VARIANCE,
            DRIFT_RATIO * (self.drift - landed.drift) + LEAST_VARIANCE,
        )
        time = self.drift_time
        ages = (duration - 0.5 * before, after + (1.0 - time.share) * flight, 0.5 * after)
        parts = DriftParts(variances)
        self._use_rolling(parts, toe_off)
        parts.measure(3, self.raw_velocity, ZERO_VELOCITY_NOISE)
        off = parts.displacement(ages)
        (x, y, rise), climb = self.raw_displacement, self.raw_velocity[2]
        weight = climb / (first + swing + last)
        early_rise = weight * (first * ages[0] + swing * (after + flight) + last * ages[2])
        time.add(rise - early_rise, -weight * swing * flight)
        return (x - off.real, y - off.imag, rise - 0.5 * climb * duration)

    def _use_rolling(self, parts: DriftParts, toe_off: MotionMoment) -> None:
        """Use the velocities of the rolling shoe, and set the error index (10)."""
        roll = self.heel_roll
        if toe_off.error is None:
            return
        last_error = self.raw_velocity
        parts.measure(1, toe_off.error, ROLLING_NOISE)
        if roll is not None and roll.error is not None:
            last_error = roll.error
            parts.measure(2, last_error, ROLLING_NOISE)
        self.last_error_index = hypot(toe_off.error[0] + last_error[0], toe_off.error[1] + last_error[1])
