"""The lateral wandering of a wearer about the path: nobody walks a line exactly.

Tracks of straight legs of 9 m in recordings (`ipol_10m_uturn`, `felius_2min_walk`) bow to a side by 5 to 7 cm; feet
land 2 to 3 cm beside such a bow."""

from __future__ import annotations

from math import atan

import numpy as np
from attrs import evolve, frozen

from ..wearers.curves import Array, Rng
from .path import Pose

KNOT_DISTANCE = 5.0
"""Distance along the path between two knots of the wandering, m (assumed: half of a leg that bows once)."""


@frozen(eq=False)
class Wander:
    """Lateral displacement from a path as a cubic Hermite spline; it is 0 at the start and at the end of the path."""

    knots: Array
    """Displacement to the left at the knots, m."""
    distance: float
    """Distance between two knots along the path, m."""

    @classmethod
    def drawn(cls, length: float, sigma: float, rng: Rng) -> Wander:
        """Return a random wandering with a standard deviation of `sigma` m for a path of `length` m."""
        count = max(1, round(length / KNOT_DISTANCE))
        knots = sigma * rng.standard_normal(count + 1)
        knots[0] = knots[-1] = 0.0
        return cls(knots, length / count)

    def at(self, s: float) -> tuple[float, float]:
        """Return the displacement to the left, m, and its slope, m per m, `s` m along the path."""
        last = len(self.knots) - 2
        k = min(max(int(s / self.distance), 0), last)
        u = min(max(s / self.distance - k, 0.0), 1.0)
        p0, p1 = float(self.knots[k]), float(self.knots[k + 1])
        m0 = 0.5 * (p1 - float(self.knots[k - 1])) if k > 0 else 0.0
        m1 = 0.5 * (float(self.knots[k + 2]) - p0) if k < last else 0.0
        # p = p0 + m0 u + (3 (p1 - p0) - 2 m0 - m1) u^2 + (2 (p0 - p1) + m0 + m1) u^3
        a, b = 3.0 * (p1 - p0) - 2.0 * m0 - m1, 2.0 * (p0 - p1) + m0 + m1
        return p0 + u * (m0 + u * (a + u * b)), (m0 + u * (2.0 * a + 3.0 * u * b)) / self.distance

    def move(self, pose: Pose, s: float) -> Pose:
        """Return `pose`, which is `s` m along the path, displaced and turned by the wandering."""
        aside, slope = self.at(s)
        moved = evolve(pose, heading=pose.heading + 0.5 * np.pi).ahead(aside, 0.0)
        return evolve(moved, heading=pose.heading + atan(slope), grade=pose.grade)
