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
from ...types import Floats, Quat, Vec2, Vec3
from ...types.attrs import evolve, stateful
from ...types.vector import ZERO, across, add, dot, rotate, sub

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


def shoe_for(insole_length: float) -> ShoeGeometry:
    """Return the default shoe scaled to an insole of `insole_length` m, or unscaled if no insole has that length.

    Lengths along the sole are scaled, the height of the sensor is not."""
    shoe = ShoeGeometry()
    if not SHORTEST_INSOLE <= insole_length <= LONGEST_INSOLE:
        return shoe
    k = insole_length / DEFAULT_LENGTH
    radius, to_toe = (tuple([k * c for c in curve]) for curve in (shoe.forefoot_radius, shoe.pivot_to_toe))
    return evolve(shoe, heel_radius=k * shoe.heel_radius, forefoot_radius=radius, pivot_to_toe=to_toe)


def heel_position(shoe: ShoeGeometry, toe_up: float) -> Vec2:
    """Return the sensor's position (P_h ahead of the heel's end, P_z above ground), m, at a toe-up pitch, rad (4)."""
    s, c = sin(toe_up), cos(toe_up)
    return shoe.heel_radius * c - shoe.height * s, shoe.heel_radius * s + shoe.height * c


def _curve(coefficients: Floats, pitch: float) -> float:
    value = 0.0
    for k in reversed(coefficients):
        value = value * pitch + k
    return value


def forefoot_position(shoe: ShoeGeometry, heel_up: float) -> Vec2:
    """Return the sensor's position (P_h + L_p2t behind the toe, P_z above ground), m, at a heel-up pitch, rad (6).

    L_r and L_p2t are fitted curves from flat to the steepest measured posture; outside they are constant."""
    p = min(max(heel_up, 0.0), shoe.steepest)
    radius, to_toe = _curve(shoe.forefoot_radius, p), _curve(shoe.pivot_to_toe, p)
    s, c = sin(heel_up), cos(heel_up)
    return radius * c - shoe.height * s + to_toe, radius * s + shoe.height * c


@stateful
class Sagittal:
    """Measures the foot's pitch and direction from the attitude of a sensor in any mounting.

    Angles in rad. The direction of the toes is known after the first push-off; `toe` is None until then."""

    up: Vec3 | None = None
    """Unit vector upwards in the sensor frame while the foot stood flat; None before the first flat sample."""
    toe: Vec3 | None = None
    """Unit vector towards the toes in the sensor frame; None before the first push-off."""
    tilt_sum: Vec3 = ZERO
    """Sum over this push-off of the horizontal parts of the upward direction, sensor frame, without unit."""
    largest_tilt: float = 0.0
    """Square of the sine of the largest tilt in this push-off."""
    misfits: int = 0
    """Number of consecutive misfits (`MOST_MISFITS`)."""
    pitch: float = 0.0
    """Pitch of the last sample, positive toe-up, rad."""
    forward: Vec2 = (1.0, 0.0)
    """Direction of the foot, horizontal unit vector in the navigation frame."""

    def add_flat_sample(self, dt: float, attitude: Quat) -> None:
        """Add a sample of `dt` s in which the foot is flat."""
        up = up_direction(attitude)
        self.up = up if self.up is None else of_length_1(add(self.up, sub(up, self.up), dt / (dt + FLAT_TIME)))

    def update(self, attitude: Quat) -> None:
        """Compute `pitch` and `forward` for this attitude; they stay unchanged as long as `toe` is unknown."""
        if self.toe is None or self.up is None:
            return
        # `up` may have changed since `toe` was learnt: take the part of `toe` at right angles to it
        x, y, z = rotate(attitude, of_length_1(across(self.toe, self.up)))
        self.pitch = asin(min(max(z, -1.0), 1.0))
        level = hypot(x, y)
        if level > 1e-6:
            self.forward = (x / level, y / level)

    def add_lift_sample(self, attitude: Quat) -> None:
        """Add one sample of a push-off, in which the heel lifts; see `SWING_BACK_SHARE`."""
        if self.up is None:
            return
        up = up_direction(attitude)
        tilted = across(up, self.up)
        size = dot(tilted, tilted) if dot(up, self.up) >= 0.0 else 1.0  # the tilt exceeds 90 degrees
        if size >= SWING_BACK_SHARE * self.largest_tilt:
            self.largest_tilt = max(self.largest_tilt, size)
            self.tilt_sum = add(self.tilt_sum, tilted)

    def end_lift(self) -> None:
        """End the push-off, and learn the direction of the toes from it if it was large enough."""
        tilted, largest_tilt = self.tilt_sum, self.largest_tilt
        self.tilt_sum, self.largest_tilt = ZERO, 0.0
        if largest_tilt < sin(LEAST_HEEL_RISE) ** 2 or length(tilted) < 1e-9:
            return
        toe = of_length_1(sub(ZERO, tilted))  # "up" tilts to the heel
        if self.toe is None:
            self.toe = toe
            return
        fits = dot(self.toe, toe) >= MISFIT_COSINE
        self.misfits = 0 if fits else self.misfits + 1
        if fits or self.misfits >= MOST_MISFITS:
            self.misfits = 0
            self.toe = of_length_1(add(self.toe, sub(toe, self.toe), FOLLOW_SHARE if fits else 1.0))

    def heel_position(self, shoe: ShoeGeometry) -> Vec3:
        """Return the sensor's position relative to the heel's end, navigation frame, m (4)."""
        return self._along(*heel_position(shoe, self.pitch))

    def forefoot_position(self, shoe: ShoeGeometry) -> Vec3:
        """Return the sensor's position relative to the toe, navigation frame, m: (6) with the sign of (7)."""
        behind, above = forefoot_position(shoe, -self.pitch)
        return self._along(-behind, above)

    def _along(self, ahead: float, above: float) -> Vec3:
        x, y = self.forward
        return (ahead * x, ahead * y, above)


def mean_velocity(last_position: Vec3, position: Vec3, dt: float) -> Vec3:
    """Return the mean velocity, m/s, between two positions, m, that are `dt` s apart: (5) and (7)."""
    x, y, z = sub(position, last_position)
    return (x / dt, y / dt, z / dt)


def up_direction(attitude: Quat) -> Vec3:
    """Return the direction up in the sensor frame: the last row of the rotation from sensor to navigation frame."""
    w, x, y, z = attitude
    return (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y))


def length(v: Vec3) -> float:
    """Return the length of a vector."""
    return sqrt(dot(v, v))


def of_length_1(v: Vec3) -> Vec3:
    """Return the unit vector in the direction of `v`, which is not zero."""
    return add(ZERO, v, 1.0 / length(v))
