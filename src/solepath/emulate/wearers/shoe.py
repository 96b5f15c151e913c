"""The shoe as a rigid body with two rockers, and the mountings of sensors on it.

Foot frame: x to the toe, y left, z up, origin on the ground under the heel's rear end, on the midline. In side view the
sole is flat between two circular arcs that are tangent to it: the foot rolls over the heel arc from heel-strike to
foot-flat, over the forefoot arc from heel-off to toe-off. When a circle rolls without slip over level ground by the
pitch angle, its centre moves by radius times angle, so the foot's position follows from its pitch alone. This is the
known velocity of KUPT (Chen et al. 2019, IEEE Internet of Things Journal, figs. 5 to 7), with round rockers where the
paper has a pivot and fitted curves."""

from __future__ import annotations

from attrs import frozen

from ...types import Quat, Vec3
from ...types.vector import IDENTITY


@frozen
class Rocker:
    """One arc of the sole: the centre of its circle is at (x, 0, radius) in the foot frame, m."""

    x: float
    """Coordinate x of the centre in the foot frame, m."""
    radius: float
    """Radius of the arc, m."""


@frozen
class Shoe:
    """The geometry of a shoe; the default is about a size 43 (US 10), as in the paper's insole."""

    length: float = 0.285
    """Length of the sole, m."""
    width: float = 0.100
    """Width of the sole, m."""
    heel: Rocker = Rocker(x=0.025, radius=0.035)
    """Arc of the heel."""
    forefoot: Rocker = Rocker(x=0.195, radius=0.050)
    """Arc of the forefoot."""
    ankle: Vec3 = (0.085, 0.0, 0.080)
    """Point in the foot frame that follows the planned curve in swing, m."""


@frozen
class Mounting:
    """Position and attitude of a sensor on the foot."""

    position: Vec3 = (0.125, 0.0, 0.029)
    """Position in the foot frame, m."""
    attitude: Quat = IDENTITY
    """Unit quaternion that turns a vector of the sensor frame into the foot frame."""


IN_SOLE = Mounting()
"""Mounting under the arch: L_r 12.5 cm in front of the heel's end, H_imu 2.9 cm above the ground (the paper's shoe)."""

ON_INSTEP = Mounting(position=(0.170, 0.0, 0.085))
"""Mounting on the laces, with the axes of the foot frame."""

ON_HEEL = Mounting(position=(-0.010, 0.0, 0.050))
"""Mounting on the back of the heel, with the axes of the foot frame."""
