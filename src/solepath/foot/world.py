"""Turn from the navigation frame of one foot to the world frame, and the uncertainty of its path there.

The world frame is z up, x along the first heading, y left, with its origin at the first position of the sensor.
Navigation starts before the first heading is known, in a frame with an arbitrary heading. The first heading is that of
the first stride that goes on, less what the foot has turned before on the spot. Once the foot has moved by
`FIRST_HEADING_DISTANCE` and until that stride ends, the heading is that of a stride that would end now. Earlier
reported positions lie near the origin and were not final."""

from __future__ import annotations

from math import atan2, cos, hypot, sin

from ..types import Floats, Quat, Vec2, Vec3
from ..types.attrs import define
from ..types.vector import from_yaw, multiply

FIRST_HEADING_DISTANCE = 0.15
"""Distance of a foot from its first position from which on its direction gives a heading, m; chosen by hand."""

Covariance2 = tuple[float, float, float]
"""Covariance of a 2D vector: xx, xy, yy."""
Covariance3 = tuple[float, float, float, float, float, float]
"""Covariance of a 3D vector: xx, xy, xz, yy, yz, zz."""


def turned_covariance(xx: float, xy: float, yy: float, c: float, s: float) -> Covariance2:
    """Return the covariance of a 2D vector after a turn by an angle with this cosine and sine."""
    return (
        c * c * xx - 2.0 * c * s * xy + s * s * yy,
        c * s * (xx - yy) + (c * c - s * s) * xy,
        s * s * xx + 2.0 * c * s * xy + c * c * yy,
    )


@define
class World:
    """The rotation about z from the navigation frame to the world frame."""

    north: Vec2 | None = None
    """Cosine and sine of the angle from navigation to world frame; None until the first heading is known."""

    def find_heading(self, position: Vec3, least: float = FIRST_HEADING_DISTANCE) -> bool:
        """Set the heading to the direction of `position`; return False if that is too close to the origin.

        `position` is in the navigation frame, m; `least` is the smallest horizontal distance, m."""
        x, y, _ = position
        if hypot(x, y) < max(least, 1e-6):
            return False
        heading = atan2(y, x)
        self.north = (cos(heading), -sin(heading))
        return True

    def settle(self) -> None:
        """Use the heading of the navigation frame if no other heading is set."""
        if self.north is None:
            self.north = (1.0, 0.0)

    def rotate_vector(self, v: Vec3) -> Vec3:
        """Return a vector of the navigation frame in the world frame."""
        if self.north is None:
            return v
        c, s = self.north
        x, y, z = v
        return (c * x - s * y, s * x + c * y, z)

    def rotate_attitude(self, q: Quat) -> Quat:
        """Return the attitude from sensor to world frame for `q`, sensor to navigation frame."""
        if self.north is None:
            return q
        return multiply(from_yaw(atan2(self.north[1], self.north[0])), q)

    def rotate_covariance(self, covariance: Floats) -> Covariance3:
        """Return the covariance of a vector in the world frame for `covariance`, that in the navigation frame."""
        xx, xy, xz, yy, yz, zz = covariance
        if self.north is None:
            return (xx, xy, xz, yy, yz, zz)
        c, s = self.north
        xx, xy, yy = turned_covariance(xx, xy, yy, c, s)
        return (xx, xy, c * xz - s * yz, yy, s * xz + c * yz, zz)


@define
class PathCovariance:
    """The covariance of position and heading at the end of a chain of stretches, by the rule of dead reckoning.

    Let a stretch have the displacement d (m) and the covariance C, and let its heading at the start have the standard
    deviation s (rad). Its end then has the error of C, and that of s times d turned by 90 degrees. Memory is O(1)
    however long the path is."""

    position: Covariance3 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    """Covariance of the position: xx, xy, xz, yy, yz, zz, m^2."""
    yaw: float = 0.0
    """Variance of the heading, rad^2."""
    position_yaw: Vec2 = (0.0, 0.0)
    """Covariance of position x and y with yaw, m rad."""

    def extend(self, displacement: Vec3, stretch: Floats) -> PathCovariance:
        """Return the path with one more stretch, given by displacement (m) and covariance (`Corrector.anchor`)."""
        dx, dy, _ = displacement
        px, py = -dy, dx
        sxx, sxy, sxz, syy, syz, szz, yaw = stretch
        xx, xy, xz, y2, yz, zz = self.position
        mx, my = self.position_yaw
        v = self.yaw
        return PathCovariance(
            (
                xx + sxx + 2.0 * mx * px + v * px * px,
                xy + sxy + mx * py + my * px + v * px * py,
                xz + sxz,
                y2 + syy + 2.0 * my * py + v * py * py,
                yz + syz,
                zz + szz,
            ),
            v + yaw,
            (mx + v * px, my + v * py),
        )
