"""Stance detectors with fixed thresholds on inertial signals.

Angular rate energy (ARE) and acceleration moving variance (MV) are from Skog, Handel, Nilsson, Rantakokko,
"Zero-velocity detection: an algorithm evaluation" (IEEE Trans. Biomed. Eng. 57, 2010). The memory-based graph-theoretic
detector (MBGTD) is the one that Wagstaff, Peretroukhin, Kelly, "Robust data-driven zero-velocity detection for
foot-mounted inertial navigation" (2019) compare with. All are causal and use a window that ends with the current
sample; it is the only latency. At low sampling rates the window has as many samples as the statistic needs. Sums are
updated, so the cost of a sample does not depend on the window, except in MBGTD, whose statistic needs every pair of
samples in the window.

The papers give thresholds for their own sensors. The thresholds here were chosen by hand on the recordings of
docs/accuracy.md and not swept."""

from __future__ import annotations

from collections import deque
from math import inf, sqrt

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import IDENTITY, ZERO
from ..settings import CountThreshold, WindowThreshold
from .shoe import SIGMA_ACC, SIGMA_GYRO
from .stance import Detector, Load, Stance, soften


@define
class AngularRate(Detector):
    """The ARE detector: angular rate energy, T = 1/W sum(|w|^2) / s_w^2, over W samples."""

    settings: WindowThreshold = WindowThreshold(window=0.025, rest_statistic=5e3, motion_statistic=1e5)
    entries: deque[tuple[float, float]] = field(factory=deque, init=False)
    """Time, s, and squared rate, (rad/s)^2, of each sample in the window."""
    total: float = field(default=0.0, init=False)
    """Sum of the squared rates in the window, (rad/s)^2."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        wx, wy, wz = gyro
        w2 = wx * wx + wy * wy + wz * wz
        self.entries.append((t, w2))
        self.total += w2
        oldest = t - self.settings.window + 1e-9
        while len(self.entries) > 1 and self.entries[0][0] < oldest:
            self.total -= self.entries.popleft()[1]
        statistic = max(0.0, self.total) / len(self.entries) / SIGMA_GYRO**2
        return soften(statistic, self.settings)


@define
class MovingVariance(Detector):
    """The MV detector: moving variance of the acceleration, T = 1/W sum(|a - a_mean|^2) / s_a^2, over W samples."""

    settings: WindowThreshold = WindowThreshold(window=0.05, rest_statistic=5e3, motion_statistic=5e4)
    entries: deque[tuple[float, float, float, float]] = field(factory=deque, init=False)
    """Time, s, and acc x, y, z, m/s^2, of each sample in the window."""
    sums: tuple[float, float, float, float] = field(default=(0.0, 0.0, 0.0, 0.0), init=False)
    """Sums over the window of acc x, y, z, m/s^2, and of the squared norm, (m/s^2)^2."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        ax, ay, az = acc
        sx, sy, sz, s2 = self.sums
        sx, sy, sz, s2 = sx + ax, sy + ay, sz + az, s2 + ax * ax + ay * ay + az * az
        entries = self.entries
        entries.append((t, ax, ay, az))
        oldest = t - self.settings.window + 1e-9
        while len(entries) > 2 and entries[0][0] < oldest:
            _, ax, ay, az = entries.popleft()
            sx, sy, sz, s2 = sx - ax, sy - ay, sz - az, s2 - ax * ax - ay * ay - az * az
        self.sums = (sx, sy, sz, s2)
        n = len(entries)
        variance = max(0.0, s2 / n - (sx * sx + sy * sy + sz * sz) / (n * n))
        return soften(variance / SIGMA_ACC**2, self.settings)


@define
class Graph(Detector):
    """The MBGTD detector: T is large if the window splits into an early and a late part that differ much.

    Indices a < b, counted from 0 as in published code, mark the end of the early part and the start of the late part.
    For every such pair the distances |a_i - a_j| between the samples of the two parts are summed and divided by
    (b - a) (W - b + 1). T is the largest of these values, m/s^2. The cost of a sample is O(W^2)."""

    settings: CountThreshold = CountThreshold(count=5, rest_statistic=2.0, motion_statistic=8.0)
    entries: deque[Vec3] = field(factory=deque, init=False)
    """Acc of each sample in the window, m/s^2."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        entries = self.entries
        entries.append(acc)
        while len(entries) > self.settings.count:
            entries.popleft()
        w = len(entries)
        if w < 3:
            return Stance(ZERO, inf, 0.0, None)
        # column[j] becomes, row by row, the sum over i <= a of |a_i - a_j|
        column = [0.0] * w
        largest = 0.0
        for a in range(w - 1):
            x, y, z = entries[a]
            for j in range(a + 1, w):
                u, v, q = entries[j]
                u, v, q = x - u, y - v, z - q
                column[j] += sqrt(u * u + v * v + q * q)
            tail = 0.0
            for b in range(w - 1, a, -1):
                tail += column[b]
                largest = max(largest, tail / ((b - a) * (w - b + 1)))
        return soften(largest, self.settings)
