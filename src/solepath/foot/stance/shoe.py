"""Stance evidence by the SHOE statistic with fixed thresholds; `Cycle` uses the same statistic (cycle.py)."""

from __future__ import annotations

from math import inf, sqrt

from ...types import Quat, Vec3
from ...types.attrs import field, state, stateful
from ...types.vector import GRAVITY, IDENTITY, ZERO
from ..phase import STATIONARY
from ..settings import ShoeSettings
from .stance import Detector, Load, Stance

ACC_SQUARE = 0.01**2
"""Variance of the accelerometer noise, which scales the statistic, (m/s^2)^2 (as Skog et al.)."""
GYRO_SQUARE = (0.1 * 3.141592653589793 / 180.0) ** 2
"""Variance of the gyroscope noise, which scales the statistic, (rad/s)^2: that of 0.1 degrees/s (as Skog et al.)."""


@stateful
class ShoeDetector(Detector):
    """The SHOE detector: stance hypothesis optimal estimation, with fixed thresholds.

    Source: Skog, Handel, Nilsson, Rantakokko, "Zero-velocity detection: an algorithm evaluation" (IEEE Trans. Biomed.
    Eng. 57, 2010). The thresholds were chosen by hand on the recordings of docs/accuracy.md and not swept. The detector
    is causal and uses a window that ends with the current sample; it is the only latency.

    T = 1/W sum(|a - g a_mean/|a_mean||^2/s_a^2 + |w|^2/s_w^2), over the W samples of the window. The sigma of the zero
    velocity grows with sqrt(T) above the statistic of a foot at rest."""

    settings: ShoeSettings = field(default=ShoeSettings())
    entries: list[tuple[float, float, float, float, float, float]] = state(factory=list)
    """Time (s), acc x, y, z (m/s^2), and squared norms of acc and gyro (rad/s) of each sample in the window."""
    sums: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    """Sums over the window of acc x, y, z and of the squared norms of acc and gyro."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        acc_square, gyro_square = self.mean_squares(t, acc, gyro)
        statistic = acc_square / ACC_SQUARE + gyro_square / GYRO_SQUARE
        settings = self.settings
        if statistic >= settings.motion_statistic:
            return Stance(ZERO, inf, statistic, None)
        hint = STATIONARY if statistic < settings.rest_statistic else None
        sigma = settings.sigma * sqrt(max(1.0, statistic / settings.rest_statistic))
        return Stance(ZERO, sigma, statistic, hint)

    def mean_squares(self, t: float, acc: Vec3, gyro: Vec3) -> tuple[float, float]:
        """Add one sample; return the two mean squares of the window that make the statistic.

        The first is that of the specific force minus gravity, (m/s^2)^2, the second that of the rate, (rad/s)^2."""
        ax, ay, az = acc
        wx, wy, wz = gyro
        a2 = ax * ax + ay * ay + az * az
        w2 = wx * wx + wy * wy + wz * wz
        sx, sy, sz, s2, sw = self.sums
        sx += ax
        sy += ay
        sz += az
        s2 += a2
        sw += w2
        entries = self.entries
        entries.append((t, ax, ay, az, a2, w2))
        oldest = t - self.settings.window + 1e-9
        while entries[0][0] < oldest and len(entries) > 1:
            _, ax, ay, az, a2, w2 = entries.pop(0)
            sx -= ax
            sy -= ay
            sz -= az
            s2 -= a2
            sw -= w2
        self.sums = (sx, sy, sz, s2, sw)
        n = len(entries)
        # sum |a - g u|^2 with u the direction of the mean: sum a^2 - 2 g |sum a| + n g^2
        acc_residual = s2 - 2.0 * GRAVITY * sqrt(sx * sx + sy * sy + sz * sz) + n * GRAVITY * GRAVITY
        return (acc_residual / n if acc_residual > 0.0 else 0.0), (sw / n if sw > 0.0 else 0.0)
