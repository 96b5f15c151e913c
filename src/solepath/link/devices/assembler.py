"""Assembly of CC2541 accelerometer, gyroscope and magnetometer values, which come separately, into Samples.

Each sensor has its own phase. A Sample is taken at each accelerometer time, with the gyroscope interpolated to it
between the measurements before and after. So a Sample waits for the next gyroscope packet: latency up to one period
(100 ms stock, 50 ms at 20 Hz) plus the radio's. When a channel fails:

- One gyroscope packet lost: interpolated over the gap (PacketsLost was reported); the wait is one period longer.
- More lost: the nearest measurement within 0.75 periods, else no gyroscope in that Sample.
- Gyroscope silent for 2.5 periods or never seen: Samples with acc alone, then without waiting.
- An accelerometer packet lost: no Sample there; the next has its own time.
- Accelerometer silent for 2.5 periods or never seen: Samples with gyro alone, at the gyroscope's times.

Magnetometer and air pressure are slower; each value is attached once, to the next Sample."""

from __future__ import annotations

from math import radians

from ...types import Sample, Site, Vec3
from ...types.attrs import define, field

MAX_BRACKET = 2.5
"""Periods that interpolation may span, and after which a channel counts as silent."""
NEAREST = 0.75
"""Periods within which one measurement may stand in for a time without measurements on both sides."""
RATE_END = 0.99 * radians(250.0)
"""Angular rate that counts as saturated, rad/s.

The gyroscope ends at 250 degrees/s, which a foot exceeds in every push-off."""


@define
class TimedMeasurement:
    """A measurement and the time at which it was taken, s."""

    t: float
    value: Vec3


@define
class Assembler:
    """Pairs accelerometer and gyroscope measurements; at most four wait.

    The times given to `add_acc` and to `add_gyro` each increase."""

    site: Site
    waiting: list[TimedMeasurement] = field(factory=list)
    """Accelerometer measurements that wait for their gyroscope measurement."""
    gyro_before: TimedMeasurement | None = None
    """Gyroscope measurement before the newest."""
    gyro_newest: TimedMeasurement | None = None
    """Newest gyroscope measurement."""
    acc_t: float | None = None
    """Time of the newest accelerometer measurement, s."""
    gyro_since: float | None = None
    """Time of the first gyroscope measurement since the newest accelerometer measurement, s."""
    gyro_silent: bool = False
    """True if the gyroscope is silent, so that acc does not wait for it."""
    mag: Vec3 | None = None
    """Magnetometer value that waits for the next Sample, T."""
    air_pressure: float | None = None
    """Air pressure that waits for the next Sample, Pa."""
    last_t: float | None = None
    """Time of the newest Sample, s; sample times strictly increase."""

    def add_acc(self, t: float, value: Vec3, period: float, known_at: float) -> list[Sample]:
        """Add an accelerometer measurement, m/s^2, and return the Samples that are complete."""
        self.acc_t, self.gyro_since = t, None
        self.waiting.append(TimedMeasurement(t, value))
        return self._release(period, known_at)

    def add_gyro(self, t: float, value: Vec3, period: float, known_at: float) -> list[Sample]:
        """Add a gyroscope measurement, rad/s, and return the Samples that are complete."""
        self.gyro_before, self.gyro_newest, self.gyro_silent = self.gyro_newest, TimedMeasurement(t, value), False
        out = self._release(period, known_at)
        if self.gyro_since is None:
            self.gyro_since = t
        t_last = self.gyro_since if self.acc_t is None else self.acc_t
        if t - t_last > MAX_BRACKET * period:
            out += self._sample(t, None, value, known_at)
        return out

    def add_pressure_alone(self, t: float, pascal: float) -> list[Sample]:
        """Return a Sample of air pressure alone at its arrival `t`, s, while nothing else comes."""
        out = self.flush(t)
        self.air_pressure = pascal
        return out + self._sample(t, None, None, t)

    def flush(self, known_at: float) -> list[Sample]:
        """Return the Samples that still wait, with the gyroscope as far as it is known."""
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
        if self.last_t is not None and t <= self.last_t:  # the first after its channel was silent came too late
            return []
        mag, self.mag = self.mag, None
        air_pressure, self.air_pressure = self.air_pressure, None
        self.last_t = t
        known_at = max(known_at, t)
        saturated = gyro is not None and max(map(abs, gyro)) >= RATE_END
        return [
            Sample(t, self.site, acc, gyro, mag=mag, air_pressure=air_pressure, known_at=known_at, saturated=saturated)
        ]
