"""Position and velocity of the sensor in a shoe that rolls over its heel or its forefoot.

Equations (4) to (7) of Chen et al., "Smart insole-based indoor localization system for Internet of Things applications"
(IEEE Internet of Things Journal 6, 2019), figs. 5, 6, 7. From the side, the pivot is the point of the shoe's bottom
that stays on the ground. L_r is the length from it along the bottom to the point below the sensor, and the sensor lies
H_imu above that point. With the pitch of the sole the sensor's position is

    P_h = L_r cos(pitch) - H_imu sin(pitch)         along the ground, from the pivot
    P_z = L_r sin(pitch) + H_imu cos(pitch)         above it

From heel-strike to foot-flat the pivot is the heel's end, behind the sensor. The pitch is toe-up, and the sensor lies
P_h ahead of the heel's end, which stands still (4). From heel-off to toe-off the pivot is where the forefoot leaves the
ground, ahead of the sensor. The pitch is heel-up, and the sensor lies P_h + L_p2t behind the toe, which stands still
(6). Hence the minus sign in (7). A velocity is the difference of the positions at two samples over the time between
them (5) (7): the mean velocity of that interval.

The pitch comes from the attitude, for any mounting of the sensor. `Sagittal` learns two directions in the sensor frame:
upwards while the foot stands flat, and towards the toes. When the heel lifts, the foot turns toe-down, and the upward
direction tilts in the foot towards the heel; this shows where the toes are. Pitch is relative to the foot that stood
flat. So neither the mounting nor a navigation frame whose vertical is a degree off changes it.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import asin, cos, hypot, sin, sqrt

from ...calibration import ShoeGeometry
from ...types import Quat, Vec3
from ...types.attrs import define, evolve, field
from ...types.vector import ZERO

DEFAULT_LENGTH = 0.285
"""Length of the shoe whose geometry is the default, m."""
SHORTEST_INSOLE, LONGEST_INSOLE = 0.15, 0.40
"""Lengths of the shortest and the longest insole, m."""
FLAT_TIME = 0.05
"""Time constant with which "up" on the flat foot follows the measured direction, s."""
LEAST_HEEL_RISE = 0.35
"""Least tilt of the foot in a push-off from which the direction of the toes is learnt, rad."""
SWING_BACK_SHARE = 0.8
"""Share of the largest squared sine of the tilt in a push-off below which the foot swings back and does not count."""
MOST_MISFITS, FOLLOW_SHARE, MISFIT_COSINE = 3, 0.2, 0.5
"""Number of consecutive misfits that replace the direction of the toes, weight of a push-off, and cosine of 60 degrees.

A misfit is a push-off whose direction differs by more than that angle from the learnt one. Any other push-off moves the
learnt direction towards its own by the weight."""


def shoe_for(length: float) -> ShoeGeometry:
    """Return the default shoe scaled to an insole of `length` m, or unscaled if no insole has that length.

    Lengths along the sole are scaled, the height of the sensor is not."""
    shoe = ShoeGeometry()
    if not SHORTEST_INSOLE <= length <= LONGEST_INSOLE:
        return shoe
    k = length / DEFAULT_LENGTH
    return evolve(
        shoe,
        heel_radius=k * shoe.heel_radius,
        forefoot_radius=tuple([k * c for c in shoe.forefoot_radius]),
        pivot_to_toe=tuple([k * c for c in shoe.pivot_to_toe]),
    )


def heel_position(shoe: ShoeGeometry, toe_up: float) -> tuple[float, float]:
    """Return the sensor's position (P_h ahead of the heel's end, P_z above ground), m, at a toe-up pitch, rad (4)."""
    s, c = sin(toe_up), cos(toe_up)
    return shoe.heel_radius * c - shoe.height * s, shoe.heel_radius * s + shoe.height * c


def forefoot_position(shoe: ShoeGeometry, heel_up: float) -> tuple[float, float]:
    """Return the sensor's position (P_h + L_p2t behind the toe, P_z above ground), m, at a heel-up pitch, rad (6).

    L_r and L_p2t are fitted curves from flat to the steepest measured posture; outside they are constant."""
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
    """Measures the foot's pitch and direction from the attitude of a sensor in any mounting.

    Angles in rad. The direction of the toes is known after the first push-off; `toe` is None until then."""

    up: Vec3 | None = field(default=None, init=False)
    """Unit vector upwards in the sensor frame while the foot stood flat; None before the first flat sample."""
    toe: Vec3 | None = field(default=None, init=False)
    """Unit vector towards the toes in the sensor frame; None before the first push-off."""
    tilt_sum: Vec3 = field(default=ZERO, init=False)
    """Sum over this push-off of the horizontal parts of the upward direction, sensor frame, without unit."""
    largest_tilt: float = field(default=0.0, init=False)
    """Square of the sine of the largest tilt in this push-off."""
    misfits: int = field(default=0, init=False)
    """Number of consecutive misfits (`MOST_MISFITS`)."""
    pitch: float = field(default=0.0, init=False)
    """Pitch of the last sample, positive toe-up, rad."""
    forward: tuple[float, float] = field(default=(1.0, 0.0), init=False)
    """Direction of the foot, horizontal unit vector in the navigation frame."""

    def add_flat_sample(self, dt: float, attitude: Quat) -> None:
        """Add a sample of `dt` s in which the foot is flat."""
        x, y, z = up_direction(attitude)
        if self.up is None:
            self.up = (x, y, z)
            return
        u, v, w = self.up
        k = dt / (dt + FLAT_TIME)
        u, v, w = u + k * (x - u), v + k * (y - v), w + k * (z - w)
        k = 1.0 / sqrt(u * u + v * v + w * w)
        self.up = (u * k, v * k, w * k)

    def update(self, attitude: Quat) -> None:
        """Compute `pitch` and `forward` for this attitude; they stay unchanged as long as `toe` is unknown."""
        if self.toe is None or self.up is None:
            return
        # `up` may have changed since `toe` was learnt: take the part of `toe` at right angles to it
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
            self.forward = (nx / level, ny / level)

    def add_lift_sample(self, attitude: Quat) -> None:
        """Add one sample of a push-off, in which the heel lifts; see `SWING_BACK_SHARE`."""
        if self.up is None:
            return
        x, y, z = up_direction(attitude)
        u, v, w = self.up
        along = x * u + y * v + z * w
        x, y, z = x - along * u, y - along * v, z - along * w
        size = x * x + y * y + z * z
        if along < 0.0:  # the tilt exceeds 90 degrees
            size = 1.0
        if size < SWING_BACK_SHARE * self.largest_tilt:
            return
        self.largest_tilt = max(self.largest_tilt, size)
        a, b, c = self.tilt_sum
        self.tilt_sum = (a + x, b + y, c + z)

    def end_lift(self) -> None:
        """End the push-off, and learn the direction of the toes from it if it was large enough."""
        x, y, z = self.tilt_sum
        largest_tilt = self.largest_tilt
        self.tilt_sum = ZERO
        self.largest_tilt = 0.0
        size = sqrt(x * x + y * y + z * z)
        if largest_tilt < sin(LEAST_HEEL_RISE) ** 2 or size < 1e-9:
            return
        x, y, z = -x / size, -y / size, -z / size  # "up" tilts to the heel
        if self.toe is None:
            self.toe = (x, y, z)
            return
        u, v, w = self.toe
        share = FOLLOW_SHARE
        if u * x + v * y + w * z < MISFIT_COSINE:
            self.misfits += 1
            if self.misfits < MOST_MISFITS:
                return
            share = 1.0
        self.misfits = 0
        u, v, w = u + share * (x - u), v + share * (y - v), w + share * (z - w)
        size = 1.0 / sqrt(u * u + v * v + w * w)
        self.toe = (u * size, v * size, w * size)

    def heel_position(self, shoe: ShoeGeometry) -> Vec3:
        """Return the sensor's position relative to the heel's end, navigation frame, m (4)."""
        ahead, above = heel_position(shoe, self.pitch)
        x, y = self.forward
        return (ahead * x, ahead * y, above)

    def forefoot_position(self, shoe: ShoeGeometry) -> Vec3:
        """Return the sensor's position relative to the toe, navigation frame, m: (6) with the sign of (7)."""
        behind, above = forefoot_position(shoe, -self.pitch)
        x, y = self.forward
        return (-behind * x, -behind * y, above)


def mean_velocity(last_position: Vec3, position: Vec3, dt: float) -> Vec3:
    """Return the mean velocity, m/s, between two positions, m, that are `dt` s apart: (5) and (7)."""
    return (
        (position[0] - last_position[0]) / dt,
        (position[1] - last_position[1]) / dt,
        (position[2] - last_position[2]) / dt,
    )


def up_direction(attitude: Quat) -> Vec3:
    """Return the direction up in the sensor frame: the last row of the rotation from sensor to navigation frame."""
    w, x, y, z = attitude
    return (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))
