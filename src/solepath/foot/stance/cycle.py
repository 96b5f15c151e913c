"""Stance evidence judged within each gait cycle, the default.

No single threshold serves a stroll and a run: between a stroll's stance and its swing the SHOE statistic goes from 10^3
to 10^7, in a run from 10^5 to 10^8. So what is still is judged against the wearer's own last cycle: in logarithms, the
threshold lies a fixed share of the way from the quietest to the loudest moment of the last 1.2 to 1.6 s. The noise of
the evidence comes from the motion itself: a foot that turns at w about a point of the sole r away moves the sensor at
r w. What of that is known, the height of the sensor above the sole (sensor_height.py), is the velocity that it ought to
have; what is not is noise, and the steeper second term keeps early and late stance from outvoting mid-stance.

The settings were chosen by hand on the recordings of docs/accuracy.md and not swept. What the whole of a term is worth
stands there in the table of the default without one of its parts: one threshold for all, evidence of one noise, zero
velocity of a foot that does not roll, no extra noise of a foot that is braked.
"""

from __future__ import annotations

from math import exp, inf, log, sqrt
from typing import Final

from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, IDENTITY, TIE, ZERO
from .sensor_height import EMPTY, Lever
from .shoe import SIGMA_ACC, SIGMA_GYRO, ShoeDetector
from .stance import Detector, Load, Stance

ACC_SQUARE = SIGMA_ACC**2
GYRO_SQUARE = SIGMA_GYRO**2
TWO_G = 2.0 * GRAVITY

SWING: Final = Phase.SWING
STATIONARY: Final = Phase.STATIONARY
"""Looked up once: a word of an enum costs as much as five multiplications."""

told = tuple.__new__
"""A Stance of its five fields, in half the time that its own constructor takes."""

NO_LOW = 1e12
"""Above any statistic."""


@define
class Cycle(Detector):
    """SHOE's statistic against a threshold learnt from the last cycle, with noise from the motion. Latency: 25 ms.

    Statistics have no unit: SHOE divides each mean square by that of the sensor's noise (shoe.py).
    """

    share: float = 0.45
    """Where the threshold lies between the log of the lowest and of the highest statistic, 0 to 1."""
    floor: float = 2e4
    """The threshold is never below this statistic, which a standing foot shows."""
    quietest: float = 3e3
    """A lower statistic counts as this one: after standing, the next stance is not as still as standing was."""
    ceiling: float = 6e6
    """The threshold is never above this statistic, which a runner's stance comes to."""
    certain: float = 2e3
    """Below this statistic the foot is still whatever the corrector believes."""
    sigma: float = 0.01
    """Noise of a foot that does not move at all, m/s."""
    arm: float = 0.05
    """Velocity noise for each rad/s, m: how well the height of the sensor is known at first."""
    arm2: float = 0.5
    """Velocity noise for each (rad/s)^2, m s: the rolling foot."""
    off_gravity: float = 0.05
    """Velocity noise for each m/s^2 off gravity, s."""
    off_gravity2: float = 0.02
    """Velocity noise for each (m/s^2)^2 off gravity, s^3/m: a foot that is braked before it lands may turn no more."""
    bucket: float = 0.4
    """Length of one of the four spans over which the extremes are kept, s; together they are a stride of any walker but
    a slow one."""
    rolls: bool = True
    """The velocity that the sensor ought to have is that of a foot that rolls (`lever`); otherwise zero."""
    # state
    lever: Lever = field(factory=Lever, init=False)
    shoe: ShoeDetector = field(factory=ShoeDetector, init=False)
    bucket_end: float | None = field(default=None, init=False)
    lows: tuple[float, float, float] = field(default=(NO_LOW, NO_LOW, NO_LOW), init=False)
    highs: tuple[float, float, float] = field(default=(0.0, 0.0, 0.0), init=False)
    low: float = field(default=NO_LOW, init=False)
    high: float = field(default=0.0, init=False)
    past_low: float = field(default=NO_LOW, init=False)
    past_high: float = field(default=0.0, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        # SHOE's sums, as ShoeDetector.parts: a call would be 4 % of this (tests/foot/test_alike.py holds both equal)
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
        oldest = t - shoe.window + 1e-9
        while entries[0][0] < oldest and len(entries) > 1:
            _, ax, ay, az, a2, w2 = entries.popleft()
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
        # the extremes of the last cycle
        if self.bucket_end is None or t >= self.bucket_end - TIE:
            self._next(t, statistic)
        elif statistic < self.low:
            self.low = statistic
        elif statistic > self.high:
            self.high = statistic
        if load is not None and load.airborne:
            self.lever.lift()
            return told(Stance, (ZERO, inf, statistic, SWING, None))
        if statistic < self.floor:
            hint = STATIONARY if statistic < self.certain else None
        elif statistic > self.ceiling or statistic > self._threshold():
            if self.lever.sums is not EMPTY:
                self.lever.lift()
            return told(Stance, (ZERO, inf, statistic, None, None))
        else:
            hint = None
        variance = (
            self.sigma * self.sigma
            + (self.arm * self.arm + self.arm2 * self.arm2 * rate) * rate
            + (self.off_gravity * self.off_gravity + self.off_gravity2 * self.off_gravity2 * force) * force
        )
        if not self.rolls:
            return told(Stance, (ZERO, sqrt(variance), statistic, hint, None))
        vx, vy = self.lever.roll(dt, acc, gyro, attitude)
        return told(Stance, ((vx, vy, 0.0), sqrt(variance), statistic, hint, None))

    def _threshold(self) -> float:
        low, high, quietest = self.low, self.high, self.quietest
        if self.past_low < low:
            low = self.past_low
        if low < quietest:
            low = quietest
        if self.past_high > high:
            high = self.past_high
        if high < quietest:
            high = quietest
        return exp((1.0 - self.share) * log(low) + self.share * log(high))

    def _next(self, t: float, statistic: float) -> None:
        """A span begins."""
        if self.bucket_end is not None:
            self.lows = (self.lows[1], self.lows[2], self.low)
            self.highs = (self.highs[1], self.highs[2], self.high)
            self.past_low = min(self.lows)
            self.past_high = max(self.highs)
        self.bucket_end = t + self.bucket
        self.low = self.high = statistic
