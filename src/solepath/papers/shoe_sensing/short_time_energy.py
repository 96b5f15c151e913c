"""Stance evidence of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.1.2:
the short-time energy of the acceleration's magnitude, and the magnitude by itself, its baseline.
"""

from __future__ import annotations

from collections import deque
from math import inf, sqrt

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import GRAVITY, IDENTITY, TIE, ZERO

RATE = 100.0
"""Of the paper's samples, Hz."""
LOUDEST = 1e4
"""No sample counts for more than this, g^2: the running sum stays exact to far below the threshold."""
LONGEST = 0.1
"""Nor for a longer time, s."""


@frozen
class EnergySettings:
    """What `ShortTimeEnergy` is set to."""

    threshold: float = 0.05
    """E_T, g^2, summed over samples at 100 Hz."""
    window: float = 0.15
    """N of the paper's samples, s."""
    shortest: float = 0.025
    """A shorter stance is none, s."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s."""


@define
class ShortTimeEnergy(Detector):
    """x = sqrt(accX^2 + accY^2 + accZ^2) - g; E_n = sum over m = n-N+1 .. n of [x(m) w(n-m)]^2; stationary where
    E < E_T = 0.05. The statistic is E. Latency: `window`.

    The paper gives neither a unit nor w and N. x is in g here: at rest the noise of the paper's MPU-6050 (0.4 mg per
    sqrt(Hz), 3 mg over 50 Hz) and an offset of one axis (50 to 80 mg in its data sheet) make an x of 0.03 to 0.8 m/s^2,
    so in (m/s^2)^2 fifteen resting samples would reach 0.01 to 10 and many a sensor could never stand; in g^2 they
    stay below 0.1, before the accelerometer's scale is learnt, and the paper's own gravity is [0, 0, 1]. w is a
    rectangle. N is a time, `window`, and each sample counts for as many of the paper's 100 Hz as it lasts: the energy
    of the same motion is the same at every rate.

    "N is critical": with 0.15 s a walker's stances are found and little else, but a jogger's foot is flat for 0.08 s.
    So the energy is summed backwards for as long as it stays below E_T. When that is all of `window`, E < E_T, sigma is
    `sigma` and the hint STATIONARY; when it is less, down to `shortest`, sigma is larger in proportion and there is no
    hint: it may be a jogger's stance, and a corrector that knows how fast the foot is can tell.
    """

    settings: EnergySettings = EnergySettings()
    entries: deque[tuple[float, float]] = field(factory=deque, init=False)
    """How long the samples in the window were, s, and what they add to the energy."""
    lasting: float = field(default=0.0, init=False)
    """Of all of them together, s."""
    total: float = field(default=0.0, init=False)
    quiet: int = field(default=0, init=False)
    """So many of the last ones stay below E_T together."""
    quiet_lasting: float = field(default=0.0, init=False)
    quiet_total: float = field(default=0.0, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        settings = self.settings
        ax, ay, az = acc
        x = sqrt(ax * ax + ay * ay + az * az) / GRAVITY - 1.0
        square = x * x
        if square > LOUDEST:
            square = LOUDEST
        if dt > LONGEST:
            dt = LONGEST
        energy = square * dt * RATE
        entries = self.entries
        entries.append((dt, energy))
        self.lasting += dt
        self.total += energy
        quiet = self.quiet + 1
        self.quiet_lasting += dt
        self.quiet_total += energy
        while quiet and self.quiet_total >= settings.threshold:
            dropped, less = entries[-quiet]
            quiet -= 1
            self.quiet_lasting -= dropped
            self.quiet_total -= less
        while self.lasting - entries[0][0] >= settings.window - TIE and len(entries) > 1:
            dropped, less = entries.popleft()
            self.lasting -= dropped
            self.total -= less
            if quiet > len(entries):
                quiet -= 1
                self.quiet_lasting -= dropped
                self.quiet_total -= less
        if not quiet:
            self.quiet_lasting = self.quiet_total = 0.0
        self.quiet = quiet
        if quiet == len(entries):
            self.total = self.quiet_total
            self.lasting = self.quiet_lasting
            if self.lasting >= settings.window - TIE:
                return Stance(ZERO, settings.sigma, self.total, Phase.STATIONARY)
        lasting = self.quiet_lasting
        if lasting >= settings.shortest - TIE:
            return Stance(ZERO, settings.sigma * settings.window / lasting, self.total, None)
        return Stance(ZERO, inf, self.total, None)


@frozen
class AccelerationMagnitude(Detector):
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
