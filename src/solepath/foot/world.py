"""The world frame of one foot: z up, x along the first heading, y left, origin where the sensor was first seen.

Navigation begins before anybody knows where the wearer will go, in a frame with an arbitrary heading. The first
heading is that of the first step; from when the foot has moved a little until that step is over it is the direction in
which the foot has come so far. What was reported before lies within `FIRST_HEADING_DISTANCE` of the origin and was not final.
"""

from __future__ import annotations

from math import atan2, cos, hypot, sin

from ..types import Quat, Vec3
from ..types.attrs import define, field
from ..types.vector import from_yaw, multiply

FIRST_HEADING_DISTANCE = 0.15
"""The foot tells a heading when it is this far from where it first stood, m."""

Covariance3 = tuple[float, float, float, float, float, float]
"""xx, xy, xz, yy, yz, zz."""


@define
class World:
    """The turn from the navigation frame to the world frame."""

    north: tuple[float, float] | None = field(default=None, init=False)
    """cos and sin of the turn; None until the first heading is known."""

    def find_heading(self, position: Vec3, least: float = FIRST_HEADING_DISTANCE) -> bool:
        """Take the direction of `position` (navigation frame, m) as the first heading if it is far enough."""
        x, y, _ = position
        if hypot(x, y) < max(least, 1e-6):
            return False
        heading = atan2(y, x)
        self.north = (cos(heading), -sin(heading))
        return True

    def settle(self) -> None:
        """Keep the navigation frame's own heading if no other was found."""
        if self.north is None:
            self.north = (1.0, 0.0)

    def vector(self, v: Vec3) -> Vec3:
        """A vector of the navigation frame, in the world frame."""
        if self.north is None:
            return v
        c, s = self.north
        x, y, z = v
        return (c * x - s * y, s * x + c * y, z)

    def attitude(self, q: Quat) -> Quat:
        """Sensor to navigation frame, as sensor to world."""
        if self.north is None:
            return q
        return multiply(from_yaw(atan2(self.north[1], self.north[0])), q)

    def covariance(self, covariance: tuple[float, ...]) -> Covariance3:
        """Of a vector of the navigation frame, as of one of the world frame."""
        xx, xy, xz, yy, yz, zz = covariance
        if self.north is None:
            return (xx, xy, xz, yy, yz, zz)
        c, s = self.north
        return (
            c * c * xx - 2.0 * c * s * xy + s * s * yy,
            c * s * (xx - yy) + (c * c - s * s) * xy,
            c * xz - s * yz,
            s * s * xx + 2.0 * c * s * xy + c * c * yy,
            s * xz + c * yz,
            zz,
        )
