"""Estimate of a velocity error that arises in three parts, from measurements of their sums."""

from __future__ import annotations

Parts = tuple[float, float, float]
"""One number for each part: what arises until toe-off, in swing, and after heel-strike."""


class DriftParts:
    """The parts of the horizontal velocity error of one motion, independent and isotropic at first.

    Both axes have the same covariance, because they are measured together and with the same noise. A foot needs this
    only while a motion ends, so it is in no snapshot."""

    __slots__ = ("covariance", "x", "y")

    def __init__(self, variances: Parts) -> None:
        first, swing, last = variances
        self.x, self.y = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        self.covariance = [[first, 0.0, 0.0], [0.0, swing, 0.0], [0.0, 0.0, last]]

    def measure(self, count: int, error: tuple[float, float], noise: float) -> None:
        """Use a measured sum of the first `count` parts, m/s along x and y, with this variance, m^2/s^2."""
        rows, first = self.covariance, range(count)
        with_sum = [0.0, 0.0, 0.0]
        for k, row in enumerate(rows):
            for j in first:
                with_sum[k] += row[j]
        variance, dx, dy = noise, error[0], error[1]
        for k in first:
            variance += with_sum[k]
            dx -= self.x[k]
            dy -= self.y[k]
        for k in range(3):
            gain = with_sum[k] / variance
            self.x[k] += gain * dx
            self.y[k] += gain * dy
            for j in range(3):
                rows[k][j] -= gain * with_sum[j]

    def displacement(self, ages: Parts) -> tuple[tuple[float, float], float]:
        """Return the error of the displacement (x, y), m, and its variance along either axis, m^2.

        `ages` are the times since the parts arose, s."""
        dx = dy = variance = 0.0
        for k in range(3):
            dx += ages[k] * self.x[k]
            dy += ages[k] * self.y[k]
            for j in range(3):
                variance += ages[k] * ages[j] * self.covariance[k][j]
        return (dx, dy), variance
