"""CC2541: accelerometer, gyroscope and magnetometer come separately, each at its own phase; here they become Samples.

A Sample is taken at each accelerometer time, with the gyroscope interpolated to it between the measurements before and
after. So a Sample waits for the next gyroscope packet: latency up to one period (100 ms stock, 50 ms at 20 Hz) and the
radio's. When a channel fails:

- one gyroscope packet lost: interpolated over the hole (PacketsLost has been said); the wait is one period longer;
- more lost: the nearest measurement within 0.75 periods, else no gyroscope in that Sample;
- gyroscope silent for 2.5 periods or never seen: Samples with acc alone, then at once;
- an accelerometer packet lost: no Sample there; the next has its own time;
- accelerometer silent for 2.5 periods or never seen: Samples with gyro alone, at the gyroscope's times.

Magnetometer and air pressure are slower; each value rides on the next Sample once.
"""

from __future__ import annotations

from math import radians

from ...types import Sample, Site, Vec3
from ...types.attrs import define, field

MAX_BRACKET = 2.5
"""Periods that interpolation may span, and after which a channel counts as silent."""
NEAREST = 0.75
"""Periods within which one measurement may stand in for a time without a bracket."""
RATE_END = 0.99 * radians(250.0)
"""rad/s; the gyroscope ends at 250 degrees/s, which a foot exceeds in every push-off."""


@define
class TimedMeasurement:
    """A measurement and when it was taken, s."""

    t: float
    value: Vec3


@define
class Assembler:
    """Pairs measurements; the times given to `acc` and to `gyro` each increase. At most four wait."""

    site: Site
    waiting: list[TimedMeasurement] = field(factory=list)
    """Accelerometer measurements without their gyroscope."""
    gyro_before: TimedMeasurement | None = None
    """The gyroscope measurement before the newest."""
    gyro_newest: TimedMeasurement | None = None
    acc_t: float | None = None
    """When acc was last measured."""
    gyro_since: float | None = None
    """The gyroscope's first time since acc was last heard."""
    gyro_silent: bool = False
    """The gyroscope fell silent: acc does not wait for it."""
    mag: Vec3 | None = None
    air_pressure: float | None = None
    last_t: float | None = None
    """Of the newest Sample; they strictly increase."""

    def add_acc(self, t: float, value: Vec3, period: float, known_at: float) -> list[Sample]:
        """An accelerometer measurement, m/s^2."""
        self.acc_t, self.gyro_since = t, None
        self.waiting.append(TimedMeasurement(t, value))
        return self._release(period, known_at)

    def add_gyro(self, t: float, value: Vec3, period: float, known_at: float) -> list[Sample]:
        """A gyroscope measurement, rad/s."""
        self.gyro_before, self.gyro_newest, self.gyro_silent = self.gyro_newest, TimedMeasurement(t, value), False
        out = self._release(period, known_at)
        if self.gyro_since is None:
            self.gyro_since = t
        t_last = self.gyro_since if self.acc_t is None else self.acc_t
        if t - t_last > MAX_BRACKET * period:
            out += self._sample(t, None, value, known_at)
        return out

    def add_pressure_alone(self, t: float, pascal: float) -> list[Sample]:
        """Air pressure while nothing else comes: a Sample of its own at its arrival `t`, s."""
        out = self.flush(t)
        self.air_pressure = pascal
        return out + self._sample(t, None, None, t)

    def flush(self, known_at: float) -> list[Sample]:
        """What still waits, with the gyroscope as far as it is known."""
        out: list[Sample] = []
        for acc in self.waiting:
            out += self._sample(acc.t, acc.value, None, known_at)
        self.waiting = []
        return out

    def _release(self, period: float, known_at: float) -> list[Sample]:
        out: list[Sample] = []
        while self.waiting:
            acc = self.waiting[0]
            settled = self.gyro_newest is not None and self.gyro_newest.t >= acc.t
            if not settled and not self.gyro_silent:
                t_last = self.gyro_newest.t if self.gyro_newest is not None else acc.t
                if self.waiting[-1].t - t_last < MAX_BRACKET * period:
                    break
                self.gyro_silent = True
            out += self._sample(acc.t, acc.value, self._gyro_at(acc.t, period), known_at)
            del self.waiting[0]
        return out

    def _gyro_at(self, t: float, period: float) -> Vec3 | None:
        a, b = self.gyro_before, self.gyro_newest
        if b is None:
            return None
        if a is not None and a.t <= t <= b.t and b.t - a.t <= MAX_BRACKET * period:
            k = (t - a.t) / (b.t - a.t)
            (ax, ay, az), (bx, by, bz) = a.value, b.value
            return (ax + k * (bx - ax), ay + k * (by - ay), az + k * (bz - az))
        nearest = a if a is not None and abs(t - a.t) < abs(b.t - t) else b
        return nearest.value if abs(nearest.t - t) <= NEAREST * period else None

    def _sample(self, t: float, acc: Vec3 | None, gyro: Vec3 | None, known_at: float) -> list[Sample]:
        if self.last_t is not None and t <= self.last_t:  # the first after its channel was silent: overtaken
            return []
        mag, self.mag = self.mag, None
        air_pressure, self.air_pressure = self.air_pressure, None
        self.last_t = t
        known_at = max(known_at, t)
        saturated = gyro is not None and max(map(abs, gyro)) >= RATE_END
        return [
            Sample(t, self.site, acc, gyro, mag=mag, air_pressure=air_pressure, known_at=known_at, saturated=saturated)
        ]
