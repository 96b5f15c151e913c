"""A sensor that is stuck: its values stay exactly the same, although time goes on.

A sensor that measures has noise, so that three values of a vector hardly ever come again. Of 620 recordings of a foot,
the longest repeats are 7 samples and 0.12 s of both sensors, and 0.05 s of one. But a coarse or quiet sensor repeats
itself at rest, however long. So values that repeat show a stuck sensor only if a foot at rest cannot have them, if the
other sensor shows motion, or if this sensor flickered at rest before."""

from __future__ import annotations

from math import dist, hypot

from ..types import Vec3
from ..types.attrs import define, field
from ..types.vector import ZERO

STUCK_TIME, STUCK_SAMPLES = 0.5, 5
"""Time, s, and number of repeats after which a sensor is stuck."""
HELD_TIME = 0.15
"""Time, s, after which repeated values of both sensors are no measurement, although they may come to life again."""
OFF_TIME = 5.0
"""Time, s, of zeros from the start on after which the sensor is off; many send some until their first measurement."""
MOVING = 0.5
"""Angular rate of a foot that does not rest, rad/s; in steps of 0.1 rad/s, those of 8 bits, it hardly repeats."""
TURN, FORCE_CHANGE = 1.5, 3.0
"""Angle turned, rad, that changes the specific force, and change of it, m/s^2, that takes a turn of the foot."""
LEAST_STILL, MOST_STILL, REPEATING = 50, 500, 0.1
"""Least and largest number of samples at rest that show whether a sensor flickers, and ratio of repeats to them up to
which it does."""


@define
class Repeats:
    """The newest value of a sensor, and since when it has been the same."""

    value: Vec3 | None = None
    """Value of the newest sample, m/s^2 or rad/s."""
    since: float = 0.0
    """Time of the first sample with it, s."""
    count: int = 0
    """Number of samples with it after that one."""
    motion: float = 0.0
    """What the other sensor has shown since then: the angle turned, rad, or the largest change of force, m/s^2."""

    def add(self, t: float, value: Vec3) -> bool:
        """Add a value at `t`, s; return whether it is that of the sample before."""
        if value == self.value:
            self.count += 1
            return True
        self.value, self.since, self.count, self.motion = value, t, 0, 0.0
        return False


@define
class Stuck:
    """Watches the values of a foot's two sensors."""

    acc: Repeats = field(factory=Repeats)
    gyro: Repeats = field(factory=Repeats)
    t: float = 0.0
    """Time of the newest sample, s."""
    first_acc: Vec3 = ZERO
    """Specific force at the first sample with the newest angular rate, m/s^2."""
    still: int = 0
    """Number of samples at rest with another value than the one before; `MOST_STILL` at most."""
    still_repeats: int = 0
    """Number of samples at rest with both values of the sample before."""
    turned: bool = False
    """Flag: the gyroscope has shown a foot that moves, so that it was neither off nor in another unit."""
    awake: bool = False
    """Flag: a value was other than 0."""
    held: bool = False
    """Flag: the values are no measurement."""
    named: bool = False
    """Flag: it was reported that a sensor is stuck."""

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> str | None:
        """Add a sample; return a sentence on what is stuck, once."""
        dt, self.t = t - self.t, t
        same_acc, same_gyro = self.acc.add(t, acc), self.gyro.add(t, gyro)
        if not self.awake:
            self.awake = acc != ZERO or gyro != ZERO
            self.held = not self.awake
            if self.held:
                return self._judge_zeros(t)
        if not same_gyro:
            self.first_acc = acc
            if not same_acc:  # nearly always
                self.held = False
                if self.still < MOST_STILL or not self.turned:
                    if hypot(*gyro) > MOVING:
                        self.turned = True
                    else:
                        self.still = min(self.still + 1, MOST_STILL)
                return None
        rate = hypot(*gyro)
        if rate < MOVING and same_acc and same_gyro:
            self.still_repeats += 1
        self.acc.motion += rate * dt
        self.gyro.motion = max(self.gyro.motion, dist(acc, self.first_acc))
        return self._judge(t, rate > MOVING)

    def _judge_zeros(self, t: float) -> str | None:
        if self.named or t - self.acc.since < OFF_TIME:
            return None
        self.named = True
        return f"every value has been 0 for {OFF_TIME:g} s: the sensor is off, or gravity was removed; restart it"

    def _judge(self, t: float, moves: bool) -> str | None:
        """Return a sentence on what is stuck, once; the newest angular rate is that of a foot that moves or not."""
        repeats = min(self.acc.count, self.gyro.count)
        flickers = self.still >= LEAST_STILL and self.still_repeats - repeats < REPEATING * self.still
        impossible = repeats >= STUCK_SAMPLES and (moves or flickers)
        acc_time, gyro_time = [t - one.since if one.count >= STUCK_SAMPLES else 0.0 for one in (self.acc, self.gyro)]
        self.held |= impossible and min(acc_time, gyro_time) >= HELD_TIME
        acc_stuck = acc_time >= STUCK_TIME and (self.acc.motion > TURN or impossible)
        # a gyroscope that has always read nothing is off, or in another unit, which the checks of the body see
        shows = self.gyro.motion > FORCE_CHANGE or moves or impossible
        gyro_stuck = gyro_time >= STUCK_TIME and (self.turned or self.gyro.value != ZERO) and shows
        if not (acc_stuck or gyro_stuck):
            return None
        self.held = True
        if self.named:
            return None
        self.named = True
        if acc_stuck and gyro_stuck:
            return f"every value has been the same for {STUCK_TIME:g} s: the sensor is stuck; restart it"
        name = "the accelerometer" if acc_stuck else "the gyroscope"
        return f"{name} repeats the same values while the foot moves: it is stuck; restart the sensor"
