"""Stance evidence relative to each gait cycle; the default detector.

No single threshold suits a stroll and a run: from stance to swing, the SHOE statistic goes from 10^3 to 10^7 in a
stroll, and from 10^5 to 10^8 in a run. So stillness is judged relative to the wearer's own last gait cycle. The
threshold lies between the lowest and the highest statistic of the last 1.2 to 1.6 s, at a fixed position in logarithms.

The noise of the evidence follows from the motion: a foot that turns at w rad/s about a point of the sole at distance
r m moves the sensor at r w. The known part of this velocity follows from the height of the sensor above the sole
(sensor_height.py); it is the reference velocity. The unknown part is noise. The noise has a second term that grows with
w^2, so that the many samples of early and late stance do not outweigh those of mid-stance.

The settings (settings.py) were chosen by hand on the recordings of docs/accuracy.md. A table in that document
gives the accuracy without whole terms: one threshold for all, evidence of one noise, zero velocity for a foot
that rolls, no extra noise for a foot that brakes."""

from __future__ import annotations

from math import exp, inf, log, sqrt
from typing import Final

from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, IDENTITY, TIE, ZERO
from ..settings import CycleSettings
from .sensor_height import SensorHeight
from .shoe import SIGMA_ACC, SIGMA_GYRO, ShoeDetector
from .stance import Detector, Load, Stance

ACC_SQUARE = SIGMA_ACC**2
GYRO_SQUARE = SIGMA_GYRO**2
TWO_G = 2.0 * GRAVITY
SHOE_WINDOW = 0.025
"""Duration of the window of the SHOE statistic, s."""

# Local names, because one look-up in the enum costs as much as five multiplications.
SWING: Final = Phase.SWING
STATIONARY: Final = Phase.STATIONARY

make_stance = tuple.__new__
"""Constructor of a Stance from its five fields, which takes half the time of the class's own."""

NO_STATISTIC = 1e12
"""Upper bound of any statistic, which stands for the lowest one before any sample."""


@define
class Cycle(Detector):
    """Compares the SHOE statistic with a threshold from the last gait cycle; the noise follows from the motion.

    Latency: 25 ms. The statistic has no unit: SHOE divides each mean square by that of the sensor's noise (shoe.py).
    Time is divided into spans of equal duration. The extremes are those of the last three spans and the current one."""

    settings: CycleSettings = CycleSettings()
    sensor_height: SensorHeight = field(factory=SensorHeight, init=False)
    shoe: ShoeDetector = field(factory=ShoeDetector, init=False)
    span_end: float | None = field(default=None, init=False)
    """End of the current span, s; None before any."""
    lows: tuple[float, float, float] = field(default=(NO_STATISTIC, NO_STATISTIC, NO_STATISTIC), init=False)
    """Lowest statistic of each of the last three spans."""
    highs: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), init=False)
    """Highest statistic of each of the last three spans."""
    lowest: float = field(default=NO_STATISTIC, init=False)
    """Lowest statistic of the current span."""
    highest: float = field(default=0.0, init=False)
    """Highest statistic of the current span."""
    past_low: float = field(default=NO_STATISTIC, init=False)
    """Lowest statistic of the last three spans together."""
    past_high: float = field(default=0.0, init=False)
    """Highest statistic of the last three spans together."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        # the sums of ShoeDetector.parts: a call would cost 4 % of this (tests/foot/test_alike.py checks both are equal)
        ax, ay, az = acc
        wx, wy, wz = gyro
        a2, w2 = ax * ax + ay * ay + az * az, wx * wx + wy * wy + wz * wz
        shoe = self.shoe
        entries = shoe.entries
        sx, sy, sz, s2, sw = shoe.sums
        sx += ax
        sy += ay
        sz += az
        s2 += a2
        sw += w2
        entries.append((t, ax, ay, az, a2, w2))
        oldest = t - SHOE_WINDOW + 1e-9
        while entries[0][0] < oldest and len(entries) > 1:
            _, ax, ay, az, a2, w2 = entries.pop(0)
            sx -= ax
            sy -= ay
            sz -= az
            s2 -= a2
            sw -= w2
        shoe.sums = (sx, sy, sz, s2, sw)
        n = len(entries)
        force = s2 - TWO_G * sqrt(sx * sx + sy * sy + sz * sz) + n * GRAVITY * GRAVITY
        force, rate = (force / n if force > 0.0 else 0.0), (sw / n if sw > 0.0 else 0.0)
        statistic = force / ACC_SQUARE + rate / GYRO_SQUARE
        # lowest and highest statistic of the current span
        if self.span_end is None or t >= self.span_end - TIE:
            self._start_span(t, statistic)
        elif statistic < self.lowest:
            self.lowest = statistic
        elif statistic > self.highest:
            self.highest = statistic
        if load is not None and load.airborne:
            self.sensor_height.end_stance()
            return make_stance(Stance, (ZERO, inf, statistic, SWING, None))
        settings = self.settings
        if statistic < settings.least_threshold:
            hint = STATIONARY if statistic < settings.standing_statistic else None
        elif statistic > settings.largest_threshold or statistic > self._threshold():
            if self.sensor_height.sums[0]:
                self.sensor_height.end_stance()
            return make_stance(Stance, (ZERO, inf, statistic, None, None))
        else:
            hint = None
        variance = (
            settings.sigma * settings.sigma
            + (
                settings.noise_per_rate * settings.noise_per_rate
                + settings.noise_per_rate_square * settings.noise_per_rate_square * rate
            )
            * rate
            + (
                settings.noise_per_acceleration * settings.noise_per_acceleration
                + settings.noise_per_acceleration_square * settings.noise_per_acceleration_square * force
            )
            * force
        )
        if not settings.rolls:
            return make_stance(Stance, (ZERO, sqrt(variance), statistic, hint, None))
        vx, vy = self.sensor_height.roll(dt, acc, gyro, attitude)
        return make_stance(Stance, ((vx, vy, 0.0), sqrt(variance), statistic, hint, None))

    def _threshold(self) -> float:
        lowest, highest, least_statistic = self.lowest, self.highest, self.settings.least_statistic
        if self.past_low < lowest:
            lowest = self.past_low
        if lowest < least_statistic:
            lowest = least_statistic
        if self.past_high > highest:
            highest = self.past_high
        if highest < least_statistic:
            highest = least_statistic
        threshold_position = self.settings.threshold_position
        return exp((1.0 - threshold_position) * log(lowest) + threshold_position * log(highest))

    def _start_span(self, t: float, statistic: float) -> None:
        """Start the next span at `t`, s, with its first statistic."""
        if self.span_end is not None:
            self.lows = (self.lows[1], self.lows[2], self.lowest)
            self.highs = (self.highs[1], self.highs[2], self.highest)
            self.past_low = min(self.lows)
            self.past_high = max(self.highs)
        self.span_end = t + self.settings.span_duration
        self.lowest = self.highest = statistic
