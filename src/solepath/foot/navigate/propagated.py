"""Strapdown navigation with a covariance, which is propagated over any interval in one step.

Between two uses of the covariance only the noise is summed, so a sample costs no more than its integration
(covariance.py). Numbers without a source were chosen by hand and not swept."""

from __future__ import annotations

from math import sqrt

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, ZERO, normalise
from .corrector import LONGEST_BRIDGE
from .covariance import (
    HEIGHT,
    POSITION_X,
    POSITION_Y,
    TILT_X,
    TILT_Y,
    VELOCITY_X,
    VELOCITY_Y,
    VELOCITY_Z,
    YAW,
    Correction,
    Covariance,
    propagate,
)
from .strapdown import Strapdown

LARGEST_REST_TILT = 0.03
"""Standard deviation of the first tilt below which it was measured at rest, rad.

attitude.py gives 0.02 at rest, otherwise 0.06 or 0.2."""
SPEED_AT_REST = 0.01
"""Standard deviation of the initial speed of a foot at rest, m/s."""
SPEED_PER_TILT = 2.0
"""Standard deviation of the initial speed of a foot not at rest, for each rad of that of the tilt, m/s.

It is 0.12 m/s in mid-stance and 0.4 m/s at any other moment."""


BRIDGED_VELOCITY_GROWTH, BRIDGED_ANGLE_GROWTH = 4.0, 0.25
"""Growth of the variance in a bridged gap: velocity, (m/s)^2/s, and angle, rad^2/s.

A foot accelerates by some 10 m/s^2 and turns by some rad/s."""
GAP_SPEED, GAP_TILT = 1.0, 0.2
"""Standard deviation of velocity, m/s, and tilt, rad, after a gap that was not bridged."""
GAP_WALKING_SPEED, LONGEST_GAP_WALK = 1.5, 2.0
"""Speed at which a foot may have moved on in a gap that was not bridged, m/s, and longest time for which it did, s.

It may have stopped as well."""
GAP_RISE_RATIO = 0.04
"""Ratio of the variance of the height to that of the position after such a gap.

A foot moves a fifth as far up or down as along the ground."""
INFILL_POSITION_VARIANCE = 0.0025
"""Variance of each axis of the position after infill, m^2: that of 5 cm, because strides differ by some per cent."""
HEADING_DRIFT = 0.004
"""Growth of the heading error, rad/sqrt(s): half a degree in the first four seconds, two degrees in a minute.

The process noise of yaw is another number: it keeps the tilt correctable and cancels over a stride."""
INFILL_VELOCITY_SIGMA = 0.3
"""Standard deviation of the velocity after infill, m/s."""
INFILL_TILT_SIGMA = 0.1
"""Standard deviation of the tilt after infill, rad."""
INFILL_YAW_SIGMA = 0.06
"""Standard deviation of the heading after infill, rad."""
INTERVAL_RATIO = 1.3
"""Factor k of the interval between independent readings (IndependentInterval), below sqrt(2); no unit.

From 1.2 to 1.4 `ms_patient` has the same strides at 2, 3 and 4 times its rate. Up to 1.3 the ARMSE2d of `pyshoe_vicon`
is 0.0529 m as without this interval, at sqrt(2) it is 0.0539 m."""
LONGEST_INTERVAL = 0.05
"""Longest interval between independent readings, s: that of 20 Hz, the lowest rate for which the noise was chosen."""
MEMORY_TIME = 2.0
"""Time constant of the sums of an IndependentInterval, s: about two strides, so that each sum has some impacts."""


@define
class IndependentInterval:
    """Learns the interval between independent readings, which is longer than dt for a sensor read beyond its bandwidth.

    The filter knows what lies between two samples only by their difference: the larger it is, the larger may be the
    error of a straight line between them. Readings that are interpolated, or faster than the bandwidth of the sensor,
    show small differences although they show no more of an impact than at a lower rate. The noise would vanish with the
    third power of dt, and a landing that was measured badly would look like a swing (`ms_patient` at 102 Hz,
    interpolated to 410 Hz: the standard deviation of the vertical velocity at a landing fell from 0.37 to 0.06 m/s, its
    error stayed 0.9 m/s, and the gate rejected every sixth stance).

    The spectrum shows the interval. Let j be the jerk, the difference of two readings of the specific force divided by
    dt, and s the difference of two values of j divided by dt. Over some strides the interval is

        T = k sqrt(sum |j|^2 dt / sum |s|^2 dt),  not less than dt.

    The root is dt / sqrt(2) for readings that change at random. It does not depend on dt where the band is narrow
    against the rate, because the sums are integrals there."""

    jerk_square: float = field(default=0.0, init=False)
    """Fading sum of |j|^2 dt, m^2/s^5."""
    snap_square: float = field(default=0.0, init=False)
    """Fading sum of |s|^2 dt, m^2/s^7."""

    def update(self, dt: float, acc: Vec3, dt_before: float, last: Vec3, earlier: Vec3) -> float:
        """Add a sample `dt` s after the last one, which came `dt_before` s after the earlier one; return T / dt.

        `acc`, `last` and `earlier` are the specific forces of the three samples, sensor frame, m/s^2."""
        if dt <= 0.0 or dt_before <= 0.0:
            return 1.0
        k, m = 1.0 / dt, 1.0 / dt_before
        ax, ay, az = acc
        x, y, z = last
        px, py, pz = earlier
        ax, ay, az, px, py, pz = k * (ax - x), k * (ay - y), k * (az - z), m * (x - px), m * (y - py), m * (z - pz)
        remaining = 1.0 - dt / MEMORY_TIME if dt < MEMORY_TIME else 0.0
        self.jerk_square = remaining * self.jerk_square + (ax * ax + ay * ay + az * az) * dt
        x, y, z = ax - px, ay - py, az - pz
        self.snap_square = remaining * self.snap_square + (x * x + y * y + z * z) * k
        ratio_square = INTERVAL_RATIO * INTERVAL_RATIO * k * k * self.jerk_square
        if ratio_square <= self.snap_square:
            return 1.0
        longest = max(LONGEST_INTERVAL * k, 1.0)
        return (
            longest if ratio_square >= longest * longest * self.snap_square else sqrt(ratio_square / self.snap_square)
        )


@define
class PropagatedCovariance(Strapdown):
    """The state of a foot, and its covariance, velocity and position at the last propagation, `elapsed` s ago."""

    uncertainty: Covariance = field(default=(0.0,) * 45, init=False)
    """Covariance at the last propagation."""
    elapsed: float = field(default=0.0, init=False)
    """Time since the covariance was last propagated, s."""
    start_velocity: Vec3 = field(default=ZERO, init=False)
    """Velocity at the last propagation, navigation frame, m/s."""
    start_position: Vec3 = field(default=ZERO, init=False)
    """Position at the last propagation, navigation frame, m."""
    acc_variance: float = field(default=0.0, init=False)
    """Variance that noise has added to each axis of the velocity since the last propagation, (m/s)^2."""
    gyro_variance: float = field(default=0.0, init=False)
    """Variance that noise has added to each angle since the last propagation, rad^2."""
    time_since_anchor: float = field(default=0.0, init=False)
    """Time since the last anchor, s."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.attitude = attitude
        self.velocity = self.position = self.start_velocity = self.start_position = ZERO
        self.force = self.rate = None
        covariance = [0.0] * 45
        # a foot whose tilt was not measured at rest may move
        speed = SPEED_AT_REST if tilt_sigma < LARGEST_REST_TILT else SPEED_PER_TILT * tilt_sigma
        covariance[VELOCITY_X] = covariance[VELOCITY_Y] = covariance[VELOCITY_Z] = speed * speed
        covariance[TILT_X] = covariance[TILT_Y] = tilt_sigma * tilt_sigma
        self.uncertainty = tuple(covariance)
        self.elapsed = self.time_since_anchor = self.acc_variance = self.gyro_variance = 0.0

    def bridge(self, dt: float) -> float:
        if dt <= LONGEST_BRIDGE:
            self.acc_variance += BRIDGED_VELOCITY_GROWTH * dt
            self.gyro_variance += BRIDGED_ANGLE_GROWTH * dt
            return dt
        self._propagate()
        self.velocity = self.start_velocity = ZERO
        self.force = self.rate = None
        self._inflate(velocity=GAP_SPEED, tilt=GAP_TILT)
        distance = GAP_WALKING_SPEED * min(dt, LONGEST_GAP_WALK)
        covariance = list(self.uncertainty)
        covariance[POSITION_X] += distance * distance
        covariance[POSITION_Y] += distance * distance
        covariance[HEIGHT] += GAP_RISE_RATIO * distance * distance
        self.uncertainty = tuple(covariance)
        return 0.0

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self._propagate()
        self.time_since_anchor += dt
        self.attitude, self.velocity, self.position = attitude, velocity, position
        self.force = self.rate = None
        self._mark_start()
        self._inflate(velocity=INFILL_VELOCITY_SIGMA, tilt=INFILL_TILT_SIGMA)
        covariance = list(self.uncertainty)
        for i in (POSITION_X, POSITION_Y, HEIGHT):
            covariance[i] += INFILL_POSITION_VARIANCE
        covariance[YAW] += INFILL_YAW_SIGMA * INFILL_YAW_SIGMA
        self.uncertainty = tuple(covariance)

    def repair(self, yaw: float, position: Vec3) -> None:
        self._propagate()
        Strapdown.repair(self, yaw, position)
        self._mark_start()

    def shift(self, yaw: float, by: Vec3) -> None:
        """Turn the state by `yaw` rad about the foot and move it by `by` m, navigation frame.

        The covariance does not change, because this is no motion."""
        self._propagate()
        self.turn_about(yaw, by)
        self._mark_start()

    def anchor(self) -> tuple[float, ...]:
        self._propagate()
        stretch = self.covariance()
        self.time_since_anchor = 0.0
        covariance = list(self.uncertainty)
        # a stretch starts at a known position and yaw, so their covariance is 0: pp, pv, pt and all of yaw
        for i in (*range(24), 32, 35, 38, 41, 43, 44):
            covariance[i] = 0.0
        self.uncertainty = tuple(covariance)
        return stretch

    def covariance(self) -> tuple[float, ...]:
        covariance = self._propagated() if self.elapsed > 0.0 else self.uncertainty
        return (*covariance[:6], HEADING_DRIFT * HEADING_DRIFT * self.time_since_anchor)

    def _propagated(self) -> Covariance:
        """Return the current covariance."""
        t = self.elapsed
        vx, vy, vz = self.velocity
        ux, uy, uz = self.start_velocity
        x, y, z = self.position
        ox, oy, oz = self.start_position
        # S = dv + g T, D = dp - v0 T + g T^2 / 2: integrals of the specific force, from its effect on the state
        s = (vx - ux, vy - uy, vz - uz + GRAVITY * t)
        d = (x - ox - ux * t, y - oy - uy * t, z - oz - uz * t + 0.5 * GRAVITY * t * t)
        q = self.acc_variance
        return propagate(self.uncertainty, t, s, d, q * t * t / 3.0, q * t / 2.0, q, self.gyro_variance)

    def _propagate(self) -> None:
        if self.elapsed > 0.0:
            self.uncertainty = self._propagated()
            self._mark_start()

    def _mark_start(self) -> None:
        self.elapsed = self.acc_variance = self.gyro_variance = 0.0
        self.start_velocity = self.velocity
        self.start_position = self.position

    def _inflate(self, velocity: float, tilt: float) -> None:
        """Add the squares of these standard deviations, m/s and rad, to the variances of velocity and tilt."""
        covariance = list(self.uncertainty)
        for i in (VELOCITY_X, VELOCITY_Y, VELOCITY_Z):
            covariance[i] += velocity * velocity
        for i in (TILT_X, TILT_Y):
            covariance[i] += tilt * tilt
        self.uncertainty = tuple(covariance)

    def _inject(self, error: Correction, tilt_x: float, tilt_y: float) -> None:
        """Correct the state by `error`, and turn it by `tilt_x` and `tilt_y` rad more."""
        px, py, pz, vx, vy, vz, tx, ty, tz = error
        tx += tilt_x
        ty += tilt_y
        x, y, z = self.position
        self.position = self.start_position = (x + px, y + py, z + pz)
        x, y, z = self.velocity
        self.velocity = self.start_velocity = (x + vx, y + vy, z + vz)
        # q <- dq(theta) * q with a global attitude error (Sola 2017, section 7)
        w, x, y, z = self.attitude
        tx, ty, tz = 0.5 * tx, 0.5 * ty, 0.5 * tz
        self.attitude = normalise(
            (w - tx * x - ty * y - tz * z, x + tx * w + ty * z - tz * y,
             y + ty * w + tz * x - tx * z, z + tz * w + tx * y - ty * x)
        )  # fmt: skip
