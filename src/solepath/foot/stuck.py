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
    """How long the newest value of a sensor has been the same."""

    since: float = 0.0
    """Time of the first sample with it, s, if others repeat it."""
    count: int = 0
    """Number of samples with it after that one."""
    motion: float = 0.0
    """What the other sensor has shown since then: the angle turned, rad, or the largest change of force, m/s^2."""

    def add(self, before: float, is_same: bool) -> None:
        """Add a value that is the same as that of the sample at `before`, s, or another."""
        if not is_same:
            self.count = 0
            return
        if not self.count:
            self.since, self.motion = before, 0.0
        self.count += 1


@define
class Stuck:
    """Watches the values of a foot's two sensors."""

    t: float = 0.0
    """Time of the newest sample, s."""
    acc: Vec3 | None = None
    """Specific force of the newest sample, m/s^2; None before any."""
    gyro: Vec3 | None = None
    """Angular rate of the newest sample, rad/s; None before any."""
    acc_repeats: Repeats = field(factory=Repeats)
    gyro_repeats: Repeats = field(factory=Repeats)
    first_acc: Vec3 = ZERO
    """Specific force at the first sample with the newest angular rate, m/s^2, if others repeat it."""
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
    at_ease: bool = False
    """Flag: both sensors have shown that they measure, and their newest values are new."""

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> str | None:
        """Add a sample; return a sentence on what is stuck, once."""
        before, last_acc, last_gyro = self.t, self.acc, self.gyro
        self.t, self.acc, self.gyro = t, acc, gyro
        if acc == last_acc or gyro == last_gyro or not self.at_ease:
            return self._watch(t, before, acc, gyro, last_acc, last_gyro)
        if self.still < MOST_STILL and hypot(*gyro) <= MOVING:
            self.still += 1
        return None

    def _watch(
        self, t: float, before: float, acc: Vec3, gyro: Vec3, last_acc: Vec3 | None, last_gyro: Vec3 | None
    ) -> str | None:
        """Add a sample that may be no measurement, after one at `before`, s, with other values or the same."""
        same_acc, same_gyro = acc == last_acc, gyro == last_gyro
        if same_gyro and last_acc is not None and not self.gyro_repeats.count:
            self.first_acc = last_acc
        self.acc_repeats.add(before, same_acc)
        self.gyro_repeats.add(before, same_gyro)
        if not self.awake:
            self.awake = acc != ZERO or gyro != ZERO
            self.held = not self.awake
            if self.held:
                return self._judge_zeros(t)
        rate = hypot(*gyro)
        if not (same_acc or same_gyro):
            self.held = False
            self.turned = self.turned or rate > MOVING
            if rate <= MOVING:
                self.still = min(self.still + 1, MOST_STILL)
            self.at_ease = self.turned
            return None
        self.at_ease = False
        if rate < MOVING and same_acc and same_gyro:
            self.still_repeats += 1
        self.acc_repeats.motion += rate * (t - before)
        self.gyro_repeats.motion = max(self.gyro_repeats.motion, dist(acc, self.first_acc))
        return self._judge(t, rate > MOVING)

    def _judge_zeros(self, t: float) -> str | None:
        if self.named or not self.acc_repeats.count or t - self.acc_repeats.since < OFF_TIME:
            return None
        self.named = True
        return f"every value has been 0 for {OFF_TIME:g} s: the sensor is off, or gravity was removed; restart it"

    def _judge(self, t: float, moves: bool) -> str | None:
        """Return a sentence on what is stuck, once; the newest angular rate is that of a foot that moves or not."""
        acc, gyro = self.acc_repeats, self.gyro_repeats
        repeats = min(acc.count, gyro.count)
        flickers = self.still >= LEAST_STILL and self.still_repeats - repeats < REPEATING * self.still
        impossible = repeats >= STUCK_SAMPLES and (moves or flickers)
        acc_time, gyro_time = [t - one.since if one.count >= STUCK_SAMPLES else 0.0 for one in (acc, gyro)]
        self.held |= impossible and min(acc_time, gyro_time) >= HELD_TIME
        acc_stuck = acc_time >= STUCK_TIME and (acc.motion > TURN or impossible)
        # a gyroscope that has always read nothing is off, or in another unit, which the checks of the body see
        shows = gyro.motion > FORCE_CHANGE or moves or impossible
        gyro_stuck = gyro_time >= STUCK_TIME and (self.turned or self.gyro != ZERO) and shows
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
