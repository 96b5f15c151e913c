"""The shoe as rockers: where the sensor in it is, and how fast, while it rolls over its heel or its forefoot.

Equations (4) to (7) of Chen et al., "Smart insole-based indoor localization system for Internet of Things
applications" (IEEE Internet of Things Journal 6, 2019), figs. 5 to 7. Seen from the side the point below the sensor on
the shoe's bottom is L_r away from a pivot on the ground, the sensor H_imu above that point, and the sole is pitched:

    P_h = L_r cos(pitch) - H_imu sin(pitch)         along the ground, from the pivot
    P_z = L_r sin(pitch) + H_imu cos(pitch)         above it

From heel-strike to foot-flat the pivot is the heel's end, behind the sensor: pitch is toe-up, and the sensor lies P_h
ahead of a point that stands still (4). From heel-off to toe-off the pivot is where the forefoot leaves the ground, in
front of the sensor: pitch is heel-up, and the sensor lies P_h + L_p2t behind the toe, which stands still (6). Hence the
minus sign in (7). Velocities are differences between two samples over the true time between them (5) (7): the mean
velocity in between.

The pitch comes from the attitude however the sensor is mounted. `Sagittal` keeps, in the sensor frame, which way was up
while the foot stood flat and which way the toes point. The heel lifts by turning the foot toe-down, which tilts "up"
towards the heel: that is how the direction of the toes is learnt. Everything is relative to the foot when it stood, so
a sensor that lies askew, or a frame whose vertical is a degree off, gives the same pitch.
"""

from __future__ import annotations

from math import asin, cos, hypot, sin, sqrt

from ...calibration import ShoeGeometry
from ...types import Quat, Vec3
from ...types.attrs import define, evolve, field
from ...types.vector import ZERO

LENGTH = 0.285
"""Of the shoe whose geometry is the default, m."""
SHORTEST, LONGEST = 0.15, 0.40
"""No insole is shorter or longer, m."""
FLAT_TIME = 0.05
""""Up" on the flat foot follows what is measured within about this time, s."""
LEAST_LIFT = 0.35
"""A push-off lifts the heel by at least this before it tells the direction of the toes, rad."""
MISFITS, FOLLOW = 3, 0.2
"""Push-offs in a row in another direction, by more than 60 degrees, after which that one is believed; share by which
each push-off moves the direction."""


def shoe_for(length: float) -> ShoeGeometry:
    """The default shoe in the size of an insole of `length` m: all that lies along the sole grows with it, the height
    of the sensor does not. The default itself for a length that no insole has."""
    shoe = ShoeGeometry()
    if not SHORTEST <= length <= LONGEST:
        return shoe
    k = length / LENGTH
    return evolve(
        shoe,
        heel_radius=k * shoe.heel_radius,
        forefoot_radius=tuple([k * c for c in shoe.forefoot_radius]),
        pivot_to_toe=tuple([k * c for c in shoe.pivot_to_toe]),
    )


def heel_place(shoe: ShoeGeometry, toe_up: float) -> tuple[float, float]:
    """(4): (P_h ahead of the heel's end, P_z above the ground) of the sensor, m, at this toe-up pitch, rad."""
    s, c = sin(toe_up), cos(toe_up)
    return shoe.heel_radius * c - shoe.height * s, shoe.heel_radius * s + shoe.height * c


def forefoot_place(shoe: ShoeGeometry, heel_up: float) -> tuple[float, float]:
    """(6): (P_h + L_p2t behind the toe, P_z above the ground) of the sensor, m, at this heel-up pitch, rad. Between
    flat and `steepest` the fitted curves hold; beyond either they stay as they are there."""
    p = min(max(heel_up, 0.0), shoe.steepest)
    radius = to_toe = 0.0
    for k in reversed(shoe.forefoot_radius):
        radius = radius * p + k
    for k in reversed(shoe.pivot_to_toe):
        to_toe = to_toe * p + k
    s, c = sin(heel_up), cos(heel_up)
    return radius * c - shoe.height * s + to_toe, radius * s + shoe.height * c


@define
class Sagittal:
    """How the foot is pitched and where it points, from the attitude of a sensor mounted anyhow.

    Angles in rad. The direction of the toes is known after the first push-off; `toe` is None until then.
    """

    up: Vec3 | None = field(default=None, init=False)
    """Up in the sensor frame while the foot stood flat, unit length."""
    toe: Vec3 | None = field(default=None, init=False)
    """The direction of the toes in the sensor frame, unit length."""
    lift: Vec3 = field(default=ZERO, init=False)
    """Sum of the tilts of "up" in this push-off, sensor frame."""
    highest: float = field(default=0.0, init=False)
    """Square of the sine of the largest of them."""
    strange: int = field(default=0, init=False)
    """Push-offs in a row that went another way."""
    pitch: float = field(default=0.0, init=False)
    """Toe-up, rad, of the last sample."""
    ahead: tuple[float, float] = field(default=(1.0, 0.0), init=False)
    """Where the foot points, horizontal unit vector in the navigation frame."""

    def stands(self, dt: float, attitude: Quat) -> None:
        """The foot stands flat."""
        x, y, z = _up(attitude)
        if self.up is None:
            self.up = (x, y, z)
            return
        u, v, w = self.up
        k = dt / (dt + FLAT_TIME)
        u, v, w = u + k * (x - u), v + k * (y - v), w + k * (z - w)
        k = 1.0 / sqrt(u * u + v * v + w * w)
        self.up = (u * k, v * k, w * k)

    def see(self, attitude: Quat) -> None:
        """Works out `pitch` and `ahead` for this attitude; nothing as long as `toe` is unknown."""
        if self.toe is None or self.up is None:
            return
        # the toes' direction at right angles to what is now "up on the flat foot"
        (fx, fy, fz), (ux, uy, uz) = self.toe, self.up
        along = fx * ux + fy * uy + fz * uz
        fx, fy, fz = fx - along * ux, fy - along * uy, fz - along * uz
        k = 1.0 / sqrt(fx * fx + fy * fy + fz * fz)
        w, x, y, z = attitude
        tx = 2.0 * k * (y * fz - z * fy)
        ty = 2.0 * k * (z * fx - x * fz)
        tz = 2.0 * k * (x * fy - y * fx)
        nx, ny = fx * k + w * tx + y * tz - z * ty, fy * k + w * ty + z * tx - x * tz
        nz = fz * k + w * tz + x * ty - y * tx
        self.pitch = asin(min(max(nz, -1.0), 1.0))
        level = hypot(nx, ny)
        if level > 1e-6:
            self.ahead = (nx / level, ny / level)

    def lifts(self, attitude: Quat) -> None:
        """The heel comes up: one more tilt of this push-off. Tilts after the largest, on the way back, do not count."""
        if self.up is None:
            return
        x, y, z = _up(attitude)
        u, v, w = self.up
        along = x * u + y * v + z * w
        x, y, z = x - along * u, y - along * v, z - along * w
        size = x * x + y * y + z * z
        if along < 0.0:
            size = 1.0
        if size < 0.8 * self.highest:
            return
        self.highest = max(self.highest, size)
        a, b, c = self.lift
        self.lift = (a + x, b + y, c + z)

    def lifted(self) -> None:
        """The push-off is over: learn the direction of the toes from it, if it went far enough."""
        x, y, z = self.lift
        highest = self.highest
        self.lift = ZERO
        self.highest = 0.0
        size = sqrt(x * x + y * y + z * z)
        if highest < sin(LEAST_LIFT) ** 2 or size < 1e-9:
            return
        x, y, z = -x / size, -y / size, -z / size  # "up" tilts to the heel
        if self.toe is None:
            self.toe = (x, y, z)
            return
        u, v, w = self.toe
        share = FOLLOW
        if u * x + v * y + w * z < 0.5:
            self.strange += 1
            if self.strange < MISFITS:
                return
            share = 1.0
        self.strange = 0
        u, v, w = u + share * (x - u), v + share * (y - v), w + share * (z - w)
        size = 1.0 / sqrt(u * u + v * v + w * w)
        self.toe = (u * size, v * size, w * size)

    def heel_place(self, shoe: ShoeGeometry) -> Vec3:
        """(4): the sensor from the heel's end, navigation frame, m."""
        ahead, above = heel_place(shoe, self.pitch)
        x, y = self.ahead
        return (ahead * x, ahead * y, above)

    def forefoot_place(self, shoe: ShoeGeometry) -> Vec3:
        """(6), turned round so that (7) is a plain difference: the sensor from the toe, navigation frame, m."""
        behind, above = forefoot_place(shoe, -self.pitch)
        x, y = self.ahead
        return (-behind * x, -behind * y, above)


def velocity(before: Vec3, now: Vec3, dt: float) -> Vec3:
    """(5) and (7): the mean velocity between two places, m/s, `dt` s apart."""
    return ((now[0] - before[0]) / dt, (now[1] - before[1]) / dt, (now[2] - before[2]) / dt)


def _up(attitude: Quat) -> Vec3:
    """Up in the sensor frame: the last row of the rotation sensor to navigation frame."""
    w, x, y, z = attitude
    return (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))
