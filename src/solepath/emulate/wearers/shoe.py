"""The shoe as a rigid body with two rockers, and the mountings of sensors on it.

A rocker is a curved end of the sole over which the shoe rolls. Foot frame: x to the toe, y left, z up, origin on the
ground under the heel's rear end, on the midline. In side view the sole is flat between two circular arcs that are
tangent to it. The foot rolls over the heel arc from heel-strike to foot-flat, and over the forefoot arc from heel-off
to toe-off. When a circle rolls without slip over level ground by the pitch angle, its centre moves by radius times
angle, so the foot's position follows from its pitch alone. KUPT uses the velocity of that motion (Chen et al. 2019,
IEEE Internet of Things Journal, figs. 5 to 7). The rockers here are round; the paper has a pivot and fitted curves.
`Shoe.contact` has what a worn shoe does otherwise: it bends elsewhere under the weight, and it slides.
Numbers without a source were chosen by hand for a shoe of this size and not swept."""

from __future__ import annotations

from attrs import evolve, frozen

from ...types import Quat, Vec3
from ...types.vector import IDENTITY
from .contact import RIGID, GroundContact


@frozen
class Rocker:
    """A rocker of the sole: a circular arc with its centre at (x, 0, radius) in the foot frame, m."""

    x: float
    """Coordinate x of the centre in the foot frame, m."""
    radius: float
    """Radius of the arc, m."""


@frozen
class Shoe:
    """The geometry of a shoe; the default is about a size 43 (US 10), the size of the insole of Chen et al. 2019."""

    length: float = 0.285
    """Length of the sole, m."""
    width: float = 0.100
    """Width of the sole, m."""
    heel: Rocker = Rocker(x=0.025, radius=0.035)
    """Arc of the heel."""
    forefoot: Rocker = Rocker(x=0.195, radius=0.050)
    """Arc of the forefoot."""
    ankle: Vec3 = (0.085, 0.0, 0.080)
    """Ankle point in the foot frame, m; in swing this point follows the planned curve."""
    contact: GroundContact = RIGID
    """Contact with the ground while the wearer walks; `heel` and `forefoot` are the arcs in static postures."""

    def walking(self, pivot_shift: float) -> Shoe:
        """Return the shoe with the arcs of a stride whose forefoot arc is shifted forwards by `pivot_shift`, m."""
        heel, forefoot, contact = self.heel, self.forefoot, self.contact
        return evolve(
            self,
            heel=Rocker(heel.x + contact.heel_shift, heel.radius),
            forefoot=Rocker(forefoot.x + pivot_shift, forefoot.radius * contact.radius_ratio),
        )


@frozen
class Mounting:
    """Position and attitude of a sensor on the foot."""

    position: Vec3 = (0.125, 0.0, 0.029)
    """Position in the foot frame, m."""
    attitude: Quat = IDENTITY
    """Unit quaternion that turns a vector of the sensor frame into the foot frame."""


IN_SOLE = Mounting()
"""Mounting under the arch: 12.5 cm in front of the heel's end (L_r) and 2.9 cm high (H_imu), as in Chen et al. 2019."""

ON_INSTEP = Mounting(position=(0.170, 0.0, 0.085))
"""Mounting on the laces, with the axes of the foot frame."""

ON_HEEL = Mounting(position=(-0.010, 0.0, 0.050))
"""Mounting on the back of the heel, with the axes of the foot frame."""
