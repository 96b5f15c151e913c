"""Stance evidence of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.1.2:
the short-time energy of the acceleration's magnitude, and the magnitude by itself, its baseline.
"""

from __future__ import annotations

from collections import deque
from math import inf, sqrt

from attrs import define, field

from ..types import Phase, Quat, Vec3
from ..vector import GRAVITY, IDENTITY, TIE, ZERO
from .stance import Load, Stance

RATE = 100.0
"""Of the paper's samples, Hz."""
LOUDEST = 1e4
"""No sample counts for more than this, g^2: the running sum stays exact to far below the threshold."""


@define
class ShortTimeEnergy:
    """x = sqrt(accX^2 + accY^2 + accZ^2) - g; E_n = sum over m = n-N+1 .. n of [x(m) w(n-m)]^2; stationary where
    E < E_T = 0.05. The statistic is E. Latency: `window`.

    The paper gives neither a unit nor w and N. x is in g here: at rest the noise of the paper's MPU-6050 (0.4 mg per
    sqrt(Hz), 3 mg over 50 Hz) and an offset of one axis (50 to 80 mg in its data sheet) make an x of 0.03 to 0.8 m/s^2,
    so in (m/s^2)^2 ten resting samples would reach 0.01 to 6 and many a sensor could never stand; in g^2 they
    stay below 0.06, before the accelerometer's scale is learnt, and the figures of table 1 begin with a gravity of 1.
    w is a rectangle. N is a time, `window`, and each sample counts for as many of the paper's 100 Hz as it lasts: the
    energy of the same motion is the same at every rate.
    """

    threshold: float = 0.05
    """E_T, g^2, summed over samples at 100 Hz."""
    window: float = 0.1
    """N of the paper's samples, s."""
    sigma: float = 0.01
    # state
    entries: deque[tuple[float, float]] = field(factory=deque, init=False)
    """Time and x^2 of the samples in the window."""
    total: float = field(default=0.0, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        ax, ay, az = acc
        x = sqrt(ax * ax + ay * ay + az * az) / GRAVITY - 1.0
        square = x * x
        if square > LOUDEST:
            square = LOUDEST
        entries = self.entries
        entries.append((t, square))
        total = self.total + square
        oldest = t - self.window + TIE
        while entries[0][0] <= oldest and len(entries) > 1:
            total -= entries.popleft()[1]
        self.total = total
        energy = max(0.0, total) / len(entries) * self.window * RATE
        if energy < self.threshold:
            return Stance(ZERO, self.sigma, energy, Phase.STATIONARY)
        return Stance(ZERO, inf, energy, None)


@define
class AccelerationMagnitude:
    """The acceleration is as large as gravity, so the foot stands: what Li et al. compare with, in section 4.2.1, of
    which they give no threshold. Jimenez and others, "A comparison of pedestrian dead-reckoning algorithms using a
    low-cost MEMS IMU" (IEEE WISP 2009), condition C1: 9 m/s^2 < |a| < 11 m/s^2. The statistic is |a| - g, m/s^2. No
    latency."""

    lowest: float = 9.0
    """m/s^2."""
    highest: float = 11.0
    sigma: float = 0.01

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        ax, ay, az = acc
        magnitude = sqrt(ax * ax + ay * ay + az * az)
        if self.lowest < magnitude < self.highest:
            return Stance(ZERO, self.sigma, magnitude - GRAVITY, Phase.STATIONARY)
        return Stance(ZERO, inf, magnitude - GRAVITY, None)
