"""Stance evidence of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.1.2.

`ShortTimeEnergy` uses the short-time energy of the magnitude of the specific force. `AccelerationMagnitude`, the
paper's baseline, uses the magnitude itself. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections import deque
from math import inf, sqrt

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import GRAVITY, IDENTITY, TIME_EPSILON, ZERO

PAPER_RATE = 100.0
"""Sampling rate of the paper, Hz."""
LARGEST_SQUARE = 1e4
"""Limit of one sample's squared x, g^2, so that rounding errors of the running sum stay far below the threshold."""
LONGEST_SAMPLE = 0.1
"""Limit of the time that one sample counts for, s."""


@frozen
class EnergySettings:
    """Settings of `ShortTimeEnergy`."""

    threshold: float = 0.05
    """Threshold E_T of the energy, g^2, summed over samples at 100 Hz."""
    window: float = 0.15
    """Duration of the paper's N samples, s."""
    shortest_stance: float = 0.025
    """Duration of the shortest stance, s; from `window` on there is no uncertain stance, as in the paper."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s."""


@define
class ShortTimeEnergy(Detector):
    """Detector by short-time energy E_n = sum over m = n-N+1 .. n of [x(m) w(n-m)]^2; stationary where E < E_T = 0.05.

    x = sqrt(accX^2 + accY^2 + accZ^2) - g. The statistic is E, g^2. Latency: `window`.

    The paper gives neither a unit nor w and N. Here x is in g, because the paper's gravity is [0, 0, 1] and because of
    sensor errors at rest: The noise of the paper's MPU-6050 (0.4 mg per sqrt(Hz), 3 mg over 50 Hz) and the offset of
    one axis (50 to 80 mg in its data sheet) make an x of 0.03 to 0.8 m/s^2. Fifteen samples at rest would then have an
    energy of 0.01 to 10 (m/s^2)^2, and many sensors would never be stationary. In g^2 the energy is below 0.1, even
    before the accelerometer's scale is learnt. w is a rectangle. N is a time, `window`. A sample is weighted by its
    duration times the paper's 100 Hz, so the energy of a motion does not depend on the sample rate.

    n is "the position of the center" of the window in the text, and the newest sample of it in the equation. Here it is
    the newest, as live tracking needs; with the centre all flags would come half a window later.

    "N is critical": A window of 0.15 s finds the stances of walkers and little else, but a jogger's foot is flat for
    0.08 s. So energy is summed backwards in time while it is below E_T. If the sum covers the whole `window`, E < E_T,
    the evidence has `sigma` and the hint STATIONARY. If it covers less, but at least `shortest_stance`, sigma is
    inversely proportional to that time and there is no hint. This may be a jogger's stance; a corrector, which knows
    the speed of the foot, can decide."""

    settings: EnergySettings = EnergySettings()
    entries: deque[tuple[float, float]] = field(factory=deque, init=False)
    """Samples in the window, each with its duration, s, and energy, g^2."""
    total_time: float = field(default=0.0, init=False)
    """Duration of all samples in the window, s."""
    total_energy: float = field(default=0.0, init=False)
    """Energy of all samples in the window, g^2."""
    still_count: int = field(default=0, init=False)
    """Number of latest samples whose total energy is below E_T."""
    still_time: float = field(default=0.0, init=False)
    """Duration of the last `still_count` samples, s."""
    still_energy: float = field(default=0.0, init=False)
    """Energy of the last `still_count` samples, g^2."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        settings = self.settings
        ax, ay, az = acc
        x = sqrt(ax * ax + ay * ay + az * az) / GRAVITY - 1.0
        square = x * x
        if square > LARGEST_SQUARE:
            square = LARGEST_SQUARE
        if dt > LONGEST_SAMPLE:
            dt = LONGEST_SAMPLE
        energy = square * dt * PAPER_RATE
        entries = self.entries
        entries.append((dt, energy))
        self.total_time += dt
        self.total_energy += energy
        still_count = self.still_count + 1
        self.still_time += dt
        self.still_energy += energy
        while still_count and self.still_energy >= settings.threshold:
            old_dt, old_energy = entries[-still_count]
            still_count -= 1
            self.still_time -= old_dt
            self.still_energy -= old_energy
        while self.total_time - entries[0][0] >= settings.window - TIME_EPSILON and len(entries) > 1:
            old_dt, old_energy = entries.popleft()
            self.total_time -= old_dt
            self.total_energy -= old_energy
            if still_count > len(entries):
                still_count -= 1
                self.still_time -= old_dt
                self.still_energy -= old_energy
        if not still_count:
            self.still_time = self.still_energy = 0.0
        self.still_count = still_count
        if still_count == len(entries):
            self.total_energy = self.still_energy
            self.total_time = self.still_time
            if self.total_time >= settings.window - TIME_EPSILON:
                return Stance(ZERO, settings.sigma, self.total_energy, Phase.STATIONARY)
        time = self.still_time
        if time >= settings.shortest_stance - TIME_EPSILON:
            return Stance(ZERO, settings.sigma * settings.window / time, self.total_energy, None)
        return Stance(ZERO, inf, self.total_energy, None)


def printed_energy(window: float = EnergySettings().window) -> ShortTimeEnergy:
    """Return the detector as printed, with a window of so many s: E < E_T is a stance, and everything else none."""
    return ShortTimeEnergy(EnergySettings(window=window, shortest_stance=window))


@frozen
class AccelerationMagnitude(Detector):
    """Detector: the foot stands while the magnitude of the specific force, |a|, is about 1 g.

    Li et al. compare with it in section 4.2.1, but give no threshold. Here it is condition C1 of Jimenez and others, "A
    comparison of pedestrian dead-reckoning algorithms using a low-cost MEMS IMU" (IEEE WISP 2009): 9 m/s^2 < |a| < 11
    m/s^2. The statistic is |a| - g, m/s^2. It has no latency."""

    lowest: float = 9.0
    """Lower limit of |a| of a standing foot, m/s^2."""
    highest: float = 11.0
    """Upper limit of |a| of a standing foot, m/s^2."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        ax, ay, az = acc
        magnitude = sqrt(ax * ax + ay * ay + az * az)
        if self.lowest < magnitude < self.highest:
            return Stance(ZERO, self.sigma, magnitude - GRAVITY, Phase.STATIONARY)
        return Stance(ZERO, inf, magnitude - GRAVITY, None)
