"""Attitude of a sensor above the ankle that sends no attitude: a complementary filter of gyroscope and accelerometer.

The attitude turns with the gyroscope, and is tilted towards the accelerometer's upward direction, so slowly that the
accelerations of walking average out. The heading follows from the gyroscope alone, whose bias is learnt while the
wearer stands (foot/attitude.py). The sensor's world starts with an arbitrary heading. The wearer's first heading in it
is the direction in which the sensor moves when the wearer starts to walk. Numbers without a source were chosen by hand.
"""

from __future__ import annotations

from math import atan2, hypot, sqrt

from ....foot.attitude import Levelling, Rest
from ....types import Quat, Vec3
from ....types.attrs import define, field
from ....types.vector import GRAVITY, ZERO, from_rotation_vector, multiply, normalise, rotate, sub

LONGEST_GAP = 0.25
"""Longest gap that is bridged by integration, s."""
LEVELLING_TIME = 4.0
"""Time constant of the tilt towards the measured upward direction, s: several strides."""
LEAST_DISTANCE = 0.4
"""Distance of a sensor from its place while the wearer stood, m, from which on it shows the direction of walking."""


@define
class Inclination:
    """Estimates the attitude of one sensor from specific force and angular rate."""

    attitude: Quat | None = field(default=None, init=False)
    """Attitude, sensor frame to the sensor's own world; None until it is levelled."""
    heading: float | None = field(default=None, init=False)
    """Wearer's first heading in the sensor's own world, rad; None while unknown."""
    t: float | None = field(default=None, init=False)
    """Time of the last sample, s."""
    rate: Vec3 = field(default=ZERO, init=False)
    """Angular rate of the last sample without bias, sensor frame, rad/s."""
    levelling: Levelling = field(factory=Levelling, init=False)
    rest: Rest = field(factory=Rest, init=False)
    velocity: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Horizontal velocity since the wearer stood, sensor's own world, m/s."""
    position: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Horizontal displacement since the wearer stood, sensor's own world, m."""
    offset: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Horizontal specific force measured at rest, sensor's own world, m/s^2: an error."""

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> Quat | None:
        """Add one sample, m/s^2 and rad/s, sensor frame, and return the attitude; None until it is levelled."""
        dt = 0.0 if self.t is None else t - self.t
        self.t = t
        is_at_rest = self.rest.update(t, acc, gyro)
        rate = sub(gyro, self.rest.bias)
        old_rate, self.rate = self.rate, rate
        attitude = self.attitude
        if attitude is None:
            levelled_attitude = self.levelling.update(t, acc, gyro)
            self.attitude = None if levelled_attitude is None else levelled_attitude[0]
            return self.attitude
        if not 0.0 < dt <= LONGEST_GAP:
            return attitude
        half = 0.5 * dt
        x, y, z = rate[0] + old_rate[0], rate[1] + old_rate[1], rate[2] + old_rate[2]
        attitude = multiply(attitude, from_rotation_vector((x * half, y * half, z * half)))
        up_x, up_y, up_z = rotate(attitude, acc)
        self._track_direction(dt, up_x, up_y, is_at_rest)
        length = sqrt(up_x * up_x + up_y * up_y + up_z * up_z)
        if length > 0.1 * GRAVITY:
            k = min(dt / LEVELLING_TIME, 1.0) / length
            # a small rotation of the measured upward direction towards z, about up x z
            attitude = multiply(from_rotation_vector((up_y * k, -up_x * k, 0.0)), attitude)
        self.attitude = attitude = normalise(attitude)
        return attitude

    def _track_direction(self, dt: float, ax: float, ay: float, rested: bool) -> None:
        """Integrate the sensor's displacement since the wearer stood, until the heading is known."""
        if self.heading is not None:
            return
        if rested:
            self.velocity = self.position = (0.0, 0.0)
            self.offset = (ax, ay)
            return
        vx = self.velocity[0] + (ax - self.offset[0]) * dt
        vy = self.velocity[1] + (ay - self.offset[1]) * dt
        self.velocity = (vx, vy)
        x, y = self.position[0] + vx * dt, self.position[1] + vy * dt
        self.position = (x, y)
        if self.rest.count and hypot(x, y) > LEAST_DISTANCE:
            self.heading = atan2(y, x)
