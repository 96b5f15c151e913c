"""Runs of rows that stay near their mean: the static zones of Liu et al. 2015 (IEEE MASS, IV.B, figure 7)."""

from __future__ import annotations

from ...types import Vec3
from ...types.attrs import define
from ...types.vector import GRAVITY, ZERO

GRAVITY_TOLERANCE = 2.0
"""Largest difference of a zone's mean from 1 g, m/s^2: cheap chips err, and an elevator may start."""
MOST_AVERAGED = 64
"""Number of rows of a run from which on its mean is a moving one, in which each row has weight 1/64."""


@define
class StaticRun:
    """Consecutive rows, each of which is near the mean of the earlier ones."""

    since: float | None = None
    """Start of the run, s."""
    count: int = 0
    """Number of rows, at most `MOST_AVERAGED`."""
    mean: Vec3 = ZERO
    """Mean specific force of the run, m/s^2."""

    def add(self, t: float, acc: Vec3, within: float) -> None:
        """Add one row with specific force `acc`; it starts another run unless all axes are near the mean, m/s^2."""
        ax, ay, az = acc
        x, y, z = self.mean
        if self.since is not None and abs(ax - x) <= within and abs(ay - y) <= within and abs(az - z) <= within:
            self.count = min(self.count + 1, MOST_AVERAGED)
            k = 1.0 / self.count
            self.mean = (x + k * (ax - x), y + k * (ay - y), z + k * (az - z))
        else:
            self.since, self.count, self.mean = t, 1, acc

    def duration(self, t: float) -> float:
        """Return the duration of the run up to `t`, s; 0 with less than three rows or a mean far from 1 g."""
        if self.since is None or self.count < 3:
            return 0.0
        x, y, z = self.mean
        return t - self.since if abs((x * x + y * y + z * z) ** 0.5 - GRAVITY) < GRAVITY_TOLERANCE else 0.0
