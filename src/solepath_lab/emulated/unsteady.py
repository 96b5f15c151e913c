"""How wearers are unsteady: they wander about their path, and their feet sway while they stand.

Nobody walks a line exactly. Tracks of straight legs of 9 m in recordings (`ipol_10m_uturn`, `felius_2min_walk`) bow to
a side by 5 to 7 cm; feet land 2 to 3 cm beside such a bow.

The sway of a foot that stands is small slow turns, which a gyroscope cannot tell from its bias. On recordings of
standing wearers the angular rate of a foot, averaged over half a second, differs from its mean by 6 to 10 degrees a
minute about the vertical, and by 12 to 17 about the other axes (`pyshoe_vicon`, `openshoe_loops`, `gumushane_gcp`,
`felius_2min_walk`, `hugadb`, `ipol_10m_uturn`). Angles with a standard deviation of 0.14 degrees that are reached about
once a second give such rates, with half of it for yaw."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import atan

import numpy as np
from attrs import evolve, frozen

from solepath.emulate.routes.path import Pose
from solepath.emulate.wearers.curves import Array, Rng, constant, join

KNOT_DISTANCE = 5.0
"""Distance along the path between two knots of the wandering, m (assumed: half of a leg that bows once)."""
SHORTEST_TURN, LONGEST_TURN = 0.3, 1.5
"""Shortest and longest time from one angle to the next, s."""
YAW_SHARE = 0.5
"""Ratio of the sway about the vertical to that about the other axes, no unit."""


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


@frozen
class Wandering:
    """Wandering about each path with a standard deviation of `sigma` m."""

    sigma: float

    def __call__(self, length: float, rng: Rng) -> Callable[[Pose, float], Pose]:
        """Return a function that moves a pose on a path of this length, m, which is so many m along it."""
        return Wander.drawn(length, self.sigma, rng).move


@frozen
class Swaying:
    """Sway with a standard deviation of `sigma` rad of pitch and roll."""

    sigma: float

    def __call__(
        self, t_start: float, end: float, first: float, last: float, rng: Rng
    ) -> Iterator[tuple[float, float, list[Array]]]:
        """Yield the pieces of a foot that stands from `t_start` to `end`, s, and sways from `first` to `last`, s.

        A piece has its start and end, s, and the curves of pitch, yaw and roll, rad. Pitch and roll have a standard
        deviation of `sigma`; all are 0 at `first` and `last`, and yaw is relative to the foot's own."""
        still = [constant(0.0)] * 3
        if t_start < first:
            yield t_start, first, still
        t, angles = first, np.zeros(3)
        while t < last:
            stop = t + float(rng.uniform(SHORTEST_TURN, LONGEST_TURN))
            targets = self.sigma * np.array((1.0, YAW_SHARE, 1.0)) * rng.standard_normal(3)
            if stop > last - SHORTEST_TURN:
                stop, targets = last, np.zeros(3)
            ends = zip(angles.tolist(), targets.tolist(), strict=True)
            yield t, stop, [join((a, 0.0, 0.0), (b, 0.0, 0.0), stop - t) for a, b in ends]
            t, angles = stop, targets
        if last < end:
            yield last, end, still
