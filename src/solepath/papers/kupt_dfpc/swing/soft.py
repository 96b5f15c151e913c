"""Corrector of KUPT with soft evidence: each velocity of a rolling shoe weighs what its own error allows.

It replaces (8) of Chen et al. 2019 (IEEE Internet of Things Journal 6, section III.C.3), whose known velocities are
exact and whose drift is linear. Here the error of the raw velocity at motion end is a sum of three independent parts:
what arises until toe-off, in swing, and after heel-strike. Their variances are those of the motion between samples
(`MotionMoment.drift`). The velocity errors at toe-off (7), at heel-strike (5) and at motion end (zero velocity) are
measurements of the first part, of the first two, and of all three, with the noise that this foot has learnt
(rolling_errors.py). The displacement is corrected by each part times the time since it arose.

With exact rolling velocities and half of the swing as the time of its drift, this is (8). With rolling velocities that
nobody can trust only the zero velocity at the end is left, as in ZUPT: KUPT falls back by degrees."""

from __future__ import annotations

from math import hypot, sqrt

from ....types import Quat, Vec3
from ....types.attrs import define, field
from ....types.vector import GRAVITY
from ..kinematics import up_direction
from .dedrift import SwingDedrift
from .drift_parts import DriftParts, Parts
from .motion_moment import MotionMoment
from .rolling_errors import DriftScale, DriftTime, PivotShift, RollingError
from .settings import SoftSwingSettings

ZERO_VELOCITY_NOISE = 1e-4
"""Variance of the zero velocity of a standing foot, m^2/s^2: that of `KnownVelocitySettings.sigma`."""
LEAST_VARIANCE = 1e-8
"""Least variance of a part of the velocity error, m^2/s^2."""
LEAST_ROLL = 0.01
"""Shortest horizontal displacement by rolling that gives the direction of the foot, m."""
LEAST_SIN_PITCH = 0.3
"""Sine of the least pitch at toe-off from which the pivot is learnt."""
BRIDGE = 1.0 / 12.0
"""Variance of the mean of a Brownian bridge over the variance that the motion gains in the same time.

It is what a drift does between two instants at which it is known."""


@define
class SoftSwing(SwingDedrift):
    """Corrector that weighs the velocities of the rolling shoe, and learns pivot, slide and time of the drift.

    Latency as in `SwingDedrift`: the position is corrected in one jump at motion end. In a motion without toe-off,
    without heel-strike or with a gap one linear drift is removed. The covariance of a stretch is that of its motions,
    and `path_error` of the path for scale errors, which no stance shows. While the foot moves, the live position
    follows the velocity of the rolling shoe horizontally, and the raw velocity vertically: a pivot that is 1 cm off
    errs by 8 cm/s there."""

    settings: SoftSwingSettings = SoftSwingSettings()
    pivot: PivotShift = field(factory=PivotShift, init=False)
    """Error of L_r in (6)."""
    toe_slide: RollingError = field(factory=RollingError, init=False)
    """Error of (7) in the last interval before toe-off, without that of the pivot."""
    heel_slide: RollingError = field(factory=RollingError, init=False)
    """Error of (5) in the first interval after `slide_time`."""
    drift_time: DriftTime = field(factory=DriftTime, init=False)
    """Time of the drift in swing."""
    drift_scale: DriftScale = field(factory=DriftScale, init=False)
    """Scale of the drift."""
    drift: float = field(default=0.0, init=False)
    """Drift of this motion so far (`MotionMoment.drift`)."""
    drift_moment: float = field(default=0.0, init=False)
    """Moment of the drift of this motion so far (`MotionMoment.drift_moment`)."""
    rise_error: float = field(default=0.0, init=False)
    """Error of the rise in this push-off so far (`MotionMoment.rise_error`)."""
    upright: Vec3 = field(default=(0.0, 0.0, 1.0), init=False)
    """Upward direction in the sensor frame at motion start."""
    scale_excess: float = field(default=0.0, init=False)
    """Difference from 1 g at rest that is taken for a bias, as a share of 1 g."""
    motion_variance: float = field(default=0.0, init=False)
    """Variance of the displacement of the motions since the last anchor, along each horizontal axis, m^2."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        SwingDedrift.start(self, attitude, tilt_sigma)
        self.motion_variance = 0.0
        self.upright = up_direction(attitude)

    def scaled(self, scale: float) -> None:
        self.scale_excess = self.settings.bias_share * (1.0 / scale - 1.0)

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        last, excess = self.force, self.scale_excess
        if excess != 0.0:
            # undo the scale, and subtract a bias along the direction that is upwards in a standing foot
            (x, y, z), (u, v, w), k, bias = acc, self.upright, 1.0 + excess, excess * GRAVITY
            acc = (k * x - bias * u, k * y - bias * v, k * z - bias * w)
        SwingDedrift.predict(self, dt, acc, gyro, saturated)
        force = self.force
        if last is not None and force is not None:
            x, y, z = force[0] - last[0], force[1] - last[1], force[2] - last[2]
            drift = (x * x + y * y + z * z) * dt * dt
            self.drift += drift
            self.drift_moment += drift * (self.swing - 0.5 * dt)

    def _start_motion(self) -> None:
        SwingDedrift._start_motion(self)
        self.drift = self.drift_moment = self.rise_error = 0.0
        self.upright = up_direction(self.attitude)

    def _use_velocity(self, v_ref: Vec3, push_off: bool) -> Vec3 | None:
        height, climb = self.position[2], self.velocity[2]
        error = SwingDedrift._use_velocity(self, v_ref, push_off)
        (x, y, _), (vx, vy, _) = self.position, self.velocity
        self.position, self.velocity = (x, y, height), (vx, vy, climb)
        if push_off and error is not None:
            self.rise_error += error[2] * self.interval
        return error

    def _moment(self, error: Vec3 | None) -> MotionMoment:
        (x, y, z), (u, v, w), previous, dt = up_direction(self.attitude), self.upright, self.previous, self.interval
        cos_pitch = x * u + y * v + z * w
        return MotionMoment(
            self.swing, self.raw_displacement, self.known_displacement, error,
            drift=self.drift, drift_moment=self.drift_moment, cos_pitch=cos_pitch,
            lift_rate=0.0 if previous is None or dt <= 0.0 else (previous.cos_pitch - cos_pitch) / dt,
            rise_error=self.rise_error,
        )  # fmt: skip

    def _calibrated_displacement(self, duration: float) -> Vec3 | None:
        toe_off, heel_strike = self.toe_off, self.heel_strike
        vx, vy, vz = self.raw_velocity
        if self.has_gap or toe_off is None or heel_strike is None or heel_strike.elapsed <= toe_off.elapsed:
            self.motion_variance += 0.5 * (vx * vx + vy * vy) * duration * duration * BRIDGE
            return None
        t, h, ratio, time = toe_off.elapsed, heel_strike.elapsed, self.drift_scale.ratio, self.drift_time
        variances = (
            ratio * toe_off.drift + LEAST_VARIANCE,
            ratio * (heel_strike.drift - toe_off.drift) + LEAST_VARIANCE,
            ratio * (self.drift - heel_strike.drift) + LEAST_VARIANCE,
        )
        late, late_moment = self.drift - heel_strike.drift, self.drift_moment - heel_strike.drift_moment
        ages = (
            duration - _mean_time(toe_off.drift, toe_off.drift_moment, 0.0, t),
            duration - t - time.share * (h - t),
            duration - _mean_time(late, late_moment, h, duration),
        )
        parts = DriftParts(variances)
        self._use_rolling(parts, variances, toe_off)
        parts.measure(3, (vx, vy), ZERO_VELOCITY_NOISE)
        (dx, dy), variance = parts.displacement(ages)
        swing_drift = 0.5 * (parts.x[1] * parts.x[1] + parts.y[1] * parts.y[1])
        variance += swing_drift * (h - t) * (h - t) * time.share_variance
        first, swing, last = variances
        variance += BRIDGE * (first * t * t + swing * (h - t) ** 2 + last * (duration - h) ** 2)
        self.motion_variance += variance
        rise = self.raw_displacement[2]
        weight = vz / (first + swing + last)
        early_rise = weight * (first * ages[0] + swing * (duration - t) + last * ages[2])
        if self.settings.learns_time:
            time.add(rise - early_rise, -weight * swing * (h - t))
        self.drift_scale.add(0.5 * (vx * vx + vy * vy), self.drift)
        x, y, _ = self.raw_displacement
        return (x - dx, y - dy, rise - 0.5 * vz * duration)

    def _use_rolling(self, parts: DriftParts, variances: Parts, toe_off: MotionMoment) -> None:
        """Use the velocities of the rolling shoe, set the error index (10), and learn from both."""
        error, heel_error = toe_off.error, self.heel_strike_error
        x, y, _ = toe_off.known_displacement
        rolled = hypot(x, y)
        if error is None or rolled < LEAST_ROLL:
            return
        x, y = x / rolled, y / rolled
        last_error = self.raw_velocity if heel_error is None else heel_error
        self.last_error_index = hypot(error[0] + last_error[0], error[1] + last_error[1])
        if not self.settings.uses_rolling:
            return
        first, _, last = variances
        pivot, slide, lift_rate = self.pivot, self.toe_slide, toe_off.lift_rate
        expected = slide.mean + pivot.shift * lift_rate
        noise = slide.noise + pivot.variance * lift_rate * lift_rate
        parts.measure(1, (error[0] - expected * x, error[1] - expected * y), noise)
        heel = self.heel_slide
        if heel_error is not None:
            parts.measure(2, (heel_error[0] - heel.mean * x, heel_error[1] - heel.mean * y), heel.noise)
        if not self.settings.learns_rolling:
            return
        slide.add(error[0] * x + error[1] * y - pivot.shift * lift_rate, first + pivot.variance * lift_rate * lift_rate)
        sin_pitch = sqrt(max(0.0, 1.0 - toe_off.cos_pitch * toe_off.cos_pitch))
        if sin_pitch > LEAST_SIN_PITCH:
            pivot.add(toe_off.rise_error, sin_pitch)
        if heel_error is not None:
            vx, vy, _ = self.raw_velocity
            heel.add((heel_error[0] - vx) * x + (heel_error[1] - vy) * y, last)

    def anchor(self) -> tuple[float, ...]:
        stretch = SwingDedrift.anchor(self)
        self.motion_variance = 0.0
        return stretch

    def covariance(self) -> tuple[float, ...]:
        xx, xy, xz, yy, yz, zz, yaw = SwingDedrift.covariance(self)
        return (xx + self.motion_variance, xy, xz, yy + self.motion_variance, yz, zz, yaw)


def _mean_time(drift: float, moment: float, start: float, end: float) -> float:
    """Return the mean time of a drift with this moment between `start` and `end`, s; its middle without a drift."""
    return 0.5 * (start + end) if drift <= 0.0 else min(max(moment / drift, start), end)
