"""Stance evidence of Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.1.2.

`ShortTimeEnergy` uses the short-time energy of the magnitude of the specific force. The paper's baseline, the magnitude
itself, is in solepath_lab/reproduce/shoe/variants.py. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections import deque
from math import inf, sqrt

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Phase, Quat, Vec2, Vec3
from ...types.attrs import field, frozen, state, stateful
from ...types.vector import GRAVITY, IDENTITY, TIME_EPSILON, ZERO, dot

PAPER_RATE = 100.0
"""Sampling rate of the paper, Hz."""
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


@stateful
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

    settings: EnergySettings = field(default=EnergySettings())
    entries: deque[Vec2] = state(factory=deque)
    """Samples in the window, each with its duration, s, and energy, g^2."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        settings, entries = self.settings, self.entries
        x = sqrt(dot(acc, acc)) / GRAVITY - 1.0
        duration = min(dt, LONGEST_SAMPLE)
        entries.append((duration, x * x * duration * PAPER_RATE))
        time = energy = still_time = 0.0
        count = 0
        for one_duration, one_energy in reversed(entries):
            count += 1
            time += one_duration
            energy += one_energy
            if energy < settings.threshold:
                still_time = time
            if time >= settings.window - TIME_EPSILON:
                break
        while len(entries) > count:
            entries.popleft()
        if still_time >= settings.window - TIME_EPSILON:
            return Stance(ZERO, settings.sigma, energy, Phase.STATIONARY)
        if still_time >= settings.shortest_stance - TIME_EPSILON:
            return Stance(ZERO, settings.sigma * settings.window / still_time, energy, None)
        return Stance(ZERO, inf, energy, None)


def printed_energy(window: float = EnergySettings().window) -> ShortTimeEnergy:
    """Return the detector as printed, with a window of so many s: E < E_T is a stance, and everything else none."""
    return ShortTimeEnergy(EnergySettings(window=window, shortest_stance=window))
