"""The shoe as a rigid body with two rockers, and what sits where on it.

Foot frame: x to the toe, y left, z up, origin on the ground under the heel's rear end, on the midline. Seen from the
side the sole is flat between two circular arcs that are tangent to it: over the heel arc the foot rolls from
heel-strike to foot-flat, over the forefoot arc from heel-off to toe-off. A circle that rolls without slip over level
ground by the pitch angle carries its centre by radius times angle, so where the foot is follows from its pitch alone;
that is the known velocity of KUPT (Chen et al. 2019, IEEE Internet of Things Journal, figs. 5 to 7), with round
rockers where the paper has a pivot and fitted curves.
"""

from __future__ import annotations

from attrs import frozen

from ...types import Quat, Vec3
from ...types.vector import IDENTITY


@frozen
class Rocker:
    """One arc of the sole: the centre of its circle is at (x, 0, radius) in the foot frame, m."""

    x: float
    radius: float


@frozen
class Shoe:
    """A shoe, in m. The default is about a size 43 (US 10), as in the paper's insole.

    `ankle` is the point by which the leg carries and places the foot.
    """

    length: float = 0.285
    width: float = 0.100
    heel: Rocker = Rocker(x=0.025, radius=0.035)
    forefoot: Rocker = Rocker(x=0.195, radius=0.050)
    ankle: Vec3 = (0.085, 0.0, 0.080)


@frozen
class Mounting:
    """Where a sensor sits on the foot and how it is turned.

    `position`: in the foot frame, m. `attitude`: turns sensor coordinates into foot coordinates.
    """

    position: Vec3 = (0.125, 0.0, 0.029)
    attitude: Quat = IDENTITY


IN_SOLE = Mounting()
"""Under the arch: L_r 12.5 cm before the heel's end, H_imu 2.9 cm above the ground (the paper's shoe)."""

ON_INSTEP = Mounting(position=(0.170, 0.0, 0.085))
"""On the laces, axes along the foot's."""

ON_HEEL = Mounting(position=(-0.010, 0.0, 0.050))
"""On the back of the heel, axes along the foot's."""
