"""Strapdown navigation with covariance, which is propagated over any interval at once.

Between two uses of the covariance only the noise is summed up, so a sample costs no more than its integration
(covariance.py)."""

from __future__ import annotations

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, ZERO, normalise
from .corrector import LONGEST_BRIDGE
from .covariance import (
    HEIGHT,
    PLACE_X,
    PLACE_Y,
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

SEEN_AT_REST = 0.03
"""Tilt below which the first attitude was measured at rest, rad; attitude.py gives 0.02 then, else 0.06 or 0.2."""
SPEED_AT_REST = 0.01
"""Standard deviation of the initial speed of a foot at rest, m/s; chosen by hand."""
SPEED_PER_TILT = 2.0
"""Standard deviation of the initial speed of any other foot for each rad of the tilt's, m/s; chosen by hand.

It is 0.12 m/s in mid-stance, 0.4 m/s at any moment."""


BRIDGED_ACC, BRIDGED_GYRO = 4.0, 0.25
"""Growth of the variance in a bridged gap: velocity, (m/s)^2/s, and angle, rad^2/s.

A foot accelerates by some 10 m/s^2 and turns by some rad/s. These and all following constants were chosen by hand."""
GAP_SPEED, GAP_TILT = 1.0, 0.2
"""Standard deviation of velocity, m/s, and tilt, rad, after a gap that was not bridged."""
GAP_PACE, GAP_LONGEST = 1.5, 2.0
"""Speed at which a foot may have moved on in such a gap, m/s, and longest duration of this, s.

It may have stopped as well."""
GAP_RISE = 0.04
"""Ratio of the variance of the height to that of the position: a fifth as far up or down as along the ground."""
INFILL_PLACE = 0.0025
"""Variance of a position after infill, m^2 an axis: 5 cm, because two strides differ by some per cent."""
HEADING_DRIFT = 0.004
"""Growth of the heading error, rad/sqrt(s): half a degree in the first four seconds, two in a minute.

It is not the process noise of yaw, which keeps the tilt correctable and cancels over a stride."""
INFILL_VELOCITY = 0.3
"""Standard deviation of the velocity after infill, m/s."""
INFILL_TILT = 0.1
"""Standard deviation of the tilt after infill, rad."""
INFILL_YAW = 0.06
"""Standard deviation of the heading after infill, rad."""


@define
class PropagatedCovariance(Strapdown):
    """The state, its covariance `since` s ago, and the velocity and position at that time."""

    uncertainty: Covariance = field(default=(0.0,) * 45, init=False)
    """Covariance at the last propagation."""
    since: float = field(default=0.0, init=False)
    """Time since the covariance was last propagated, s."""
    start_velocity: Vec3 = field(default=ZERO, init=False)
    """Velocity at the last propagation, navigation frame, m/s."""
    start_position: Vec3 = field(default=ZERO, init=False)
    """Position at the last propagation, navigation frame, m."""
    acc_variance: float = field(default=0.0, init=False)
    """Variance of a velocity that noise has added since then, (m/s)^2."""
    gyro_variance: float = field(default=0.0, init=False)
    """Variance of an angle that noise has added since then, rad^2."""
    stretch: float = field(default=0.0, init=False)
    """Time since the last anchor, s."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.attitude = attitude
        self.velocity = self.position = self.start_velocity = self.start_position = ZERO
        self.force = self.rate = None
        covariance = [0.0] * 45
        # a foot that was not at rest may move
        speed = SPEED_AT_REST if tilt_sigma < SEEN_AT_REST else SPEED_PER_TILT * tilt_sigma
        covariance[VELOCITY_X] = covariance[VELOCITY_Y] = covariance[VELOCITY_Z] = speed * speed
        covariance[TILT_X] = covariance[TILT_Y] = tilt_sigma * tilt_sigma
        self.uncertainty = tuple(covariance)
        self.since = self.stretch = self.acc_variance = self.gyro_variance = 0.0

    def bridge(self, dt: float) -> float:
        if dt <= LONGEST_BRIDGE:
            self.acc_variance += BRIDGED_ACC * dt
            self.gyro_variance += BRIDGED_GYRO * dt
            return dt
        self._propagate()
        self.velocity = self.start_velocity = ZERO
        self.force = self.rate = None
        self._inflate(velocity=GAP_SPEED, tilt=GAP_TILT)
        far = GAP_PACE * min(dt, GAP_LONGEST)
        covariance = list(self.uncertainty)
        covariance[PLACE_X] += far * far
        covariance[PLACE_Y] += far * far
        covariance[HEIGHT] += GAP_RISE * far * far
        self.uncertainty = tuple(covariance)
        return 0.0

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self._propagate()
        self.stretch += dt
        self.attitude, self.velocity, self.position = attitude, velocity, position
        self.force = self.rate = None
        self._mark_start()
        self._inflate(velocity=INFILL_VELOCITY, tilt=INFILL_TILT)
        covariance = list(self.uncertainty)
        for i in (PLACE_X, PLACE_Y, HEIGHT):
            covariance[i] += INFILL_PLACE
        covariance[YAW] += INFILL_YAW * INFILL_YAW
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
        self.stretch = 0.0
        covariance = list(self.uncertainty)
        # position and yaw are exact by definition after an anchor, so their covariance is 0: pp, pv, pt and all of yaw
        for i in (*range(24), 32, 35, 38, 41, 43, 44):
            covariance[i] = 0.0
        self.uncertainty = tuple(covariance)
        return stretch

    def covariance(self) -> tuple[float, ...]:
        covariance = self._propagated() if self.since > 0.0 else self.uncertainty
        return (*covariance[:6], HEADING_DRIFT * HEADING_DRIFT * self.stretch)

    def _propagated(self) -> Covariance:
        """Return the current covariance."""
        t = self.since
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
        if self.since > 0.0:
            self.uncertainty = self._propagated()
            self._mark_start()

    def _mark_start(self) -> None:
        self.since = self.acc_variance = self.gyro_variance = 0.0
        self.start_velocity = self.velocity
        self.start_position = self.position

    def _inflate(self, velocity: float, tilt: float) -> None:
        """Add these standard deviations, m/s and rad, to the covariance."""
        covariance = list(self.uncertainty)
        for i in (VELOCITY_X, VELOCITY_Y, VELOCITY_Z):
            covariance[i] += velocity * velocity
        for i in (TILT_X, TILT_Y):
            covariance[i] += tilt * tilt
        self.uncertainty = tuple(covariance)

    def _inject(self, error: Correction, tilt_x: float, tilt_y: float) -> None:
        """Correct the state by `error`, and turn it by two more tilt angles, rad."""
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
