"""Uncertainty of the path of one foot so far."""

from __future__ import annotations

from ..types import Vec3
from ..types.attrs import define


@define
class PathCovariance:
    """The covariance of position and heading at the end of a chain of stretches, by the rule of dead reckoning.

    Let a stretch have the displacement d (m) and the covariance C, and let its heading at the start have the standard
    deviation s (rad). Its end then has the error of C, and that of s times d turned by 90 degrees. Memory is O(1)
    however long the path is."""

    position: tuple[float, float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    """Covariance of the position: xx, xy, xz, yy, yz, zz, m^2."""
    yaw: float = 0.0
    """Variance of the heading, rad^2."""
    position_yaw: tuple[float, float] = (0.0, 0.0)
    """Covariance of position x and y with yaw, m rad."""

    def extend(self, displacement: Vec3, stretch: tuple[float, ...]) -> PathCovariance:
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
