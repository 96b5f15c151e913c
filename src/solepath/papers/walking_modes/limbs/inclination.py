"""The attitude of a sensor above the ankle that sends none itself: angular velocity, held upright by gravity.

A complementary filter: the attitude turns with the gyroscope, and leans towards where the accelerometer has up, slowly
enough for a walker's accelerations to cancel. Heading has nothing to hold it but the gyroscope, whose bias is learnt
while the wearer stands (foot/attitude.py). Its world begins with whatever heading the sensor has; that the wearer's
first heading lies at `heading` in it is seen from where the sensor itself goes when the wearer sets out.
"""

from __future__ import annotations

from math import atan2, hypot, sqrt

from ....foot.attitude import Levelling, Rest
from ....types import Quat, Vec3
from ....types.attrs import define, field
from ....types.vector import GRAVITY, ZERO, from_rotation_vector, multiply, normalise, rotate, sub

LONGEST = 0.25
"""A gap longer than this is not integrated over, s."""
SETTLING = 4.0
"""Time constant of the lean towards the measured up, s: several strides."""
WEARERS_WAY = 0.4
"""A sensor that has gone so far from where it stood has gone the way that the wearer goes, m."""


@define
class Inclination:
    """One sensor: acc and gyro in, attitude out."""

    attitude: Quat | None = field(default=None, init=False)
    """Sensor to its own world; None until it was levelled."""
    heading: float | None = field(default=None, init=False)
    """Of the wearer's first heading in that world, rad."""
    t: float | None = field(default=None, init=False)
    rate: Vec3 = field(default=ZERO, init=False)
    levelling: Levelling = field(factory=Levelling, init=False)
    rest: Rest = field(factory=Rest, init=False)
    velocity: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    place: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    offset: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Horizontal acceleration that the sensor shows at rest, m/s^2."""

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> Quat | None:
        """One sample, m/s^2 and rad/s in the sensor frame; the attitude after it."""
        dt = 0.0 if self.t is None else t - self.t
        self.t = t
        rested = self.rest.update(t, acc, gyro)
        rate = sub(gyro, self.rest.bias)
        before, self.rate = self.rate, rate
        attitude = self.attitude
        if attitude is None:
            first = self.levelling.update(t, acc, gyro)
            self.attitude = None if first is None else first[0]
            return self.attitude
        if not 0.0 < dt <= LONGEST:
            return attitude
        half = 0.5 * dt
        x, y, z = rate[0] + before[0], rate[1] + before[1], rate[2] + before[2]
        attitude = multiply(attitude, from_rotation_vector((x * half, y * half, z * half)))
        up_x, up_y, up_z = rotate(attitude, acc)
        self._go(dt, up_x, up_y, rested)
        length = sqrt(up_x * up_x + up_y * up_y + up_z * up_z)
        if length > 0.1 * GRAVITY:
            k = min(dt / SETTLING, 1.0) / length
            # the small turn that takes the measured up towards z: up x z
            attitude = multiply(from_rotation_vector((up_y * k, -up_x * k, 0.0)), attitude)
        self.attitude = attitude = normalise(attitude)
        return attitude

    def _go(self, dt: float, ax: float, ay: float, rested: bool) -> None:
        """Until the heading is known: where the sensor goes from where it last stood."""
        if self.heading is not None:
            return
        if rested:
            self.velocity = self.place = (0.0, 0.0)
            self.offset = (ax, ay)
            return
        vx = self.velocity[0] + (ax - self.offset[0]) * dt
        vy = self.velocity[1] + (ay - self.offset[1]) * dt
        self.velocity = (vx, vy)
        x, y = self.place[0] + vx * dt, self.place[1] + vy * dt
        self.place = (x, y)
        if self.rest.count and hypot(x, y) > WEARERS_WAY:
            self.heading = atan2(y, x)
