"""Assembly of CC2541 accelerometer, gyroscope and magnetometer values, which come separately, into Samples.

The sensors do not measure at the same moments. A Sample is made at each accelerometer time, with the gyroscope
interpolated between the measurements before and after that time. A Sample thus waits for the next gyroscope packet: its
latency is up to one period (100 ms with stock firmware, 50 ms at 20 Hz) plus the radio's delay. When a channel fails:

- After the loss of one gyroscope packet, interpolation spans two periods, and a Sample waits one period longer.
- After the loss of several, the nearest gyroscope measurement within 0.75 periods is used, else none.
- If the gyroscope is silent for 2.5 periods, or always, Samples have acc alone and do not wait.
- If an accelerometer packet is lost, there is no Sample at its time.
- If the accelerometer is silent for 2.5 periods, or always, Samples have gyro alone, at the gyroscope's times.

Magnetometer and air pressure are slower; each value is attached once, to the next Sample. The numbers are those of
protocol/clock.md, "Devices without counters"."""

from __future__ import annotations

from math import radians

from ...types import Sample, Site, Vec3
from ...types.attrs import define, field
from ..clock import MIN_INCREMENT

MAX_GAP_PERIODS = 2.5
"""Largest time that interpolation may span, and time after which a channel counts as silent, periods."""
MAX_NEAREST_PERIODS = 0.75
"""Largest distance of a gyroscope measurement that is used when interpolation is impossible, periods."""
GYRO_RANGE_END = 0.99 * radians(250.0)
"""Angular rate that counts as saturated, rad/s.

The gyroscope ends at 250 degrees/s, which a foot exceeds in every push-off."""


Timed = tuple[float, Vec3]
"""The time at which a measurement was taken, s, and the measurement."""


@define
class Assembler:
    """Pairs accelerometer and gyroscope measurements, of which at most four wait.

    Times `t` (s) increase from one call of `add_acc` to the next; those of `add_gyro` are made to. `period` is the time
    between two measurements of the added kind, s. `known_at` is the arrival of the packet, s."""

    site: Site
    waiting_acc: list[Timed] = field(factory=list)
    """Accelerometer measurements that wait for their gyroscope measurement."""
    gyro_before: Timed | None = None
    """Gyroscope measurement before the newest."""
    gyro_newest: Timed | None = None
    """Newest gyroscope measurement."""
    newest_acc_t: float | None = None
    """Time of the newest accelerometer measurement, s."""
    gyro_alone_since: float | None = None
    """Time of the first gyroscope measurement after the newest accelerometer measurement, s."""
    gyro_silent: bool = False
    """True if the gyroscope is silent, so that accelerometer measurements do not wait for it."""
    mag: Vec3 | None = None
    """Magnetometer value that waits for the next Sample, T."""
    air_pressure: float | None = None
    """Air pressure that waits for the next Sample, Pa."""
    last_t: float | None = None
    """Time of the newest Sample, s; sample times strictly increase."""

    def add_acc(self, t: float, value: Vec3, period: float, known_at: float) -> list[Sample]:
        """Add an accelerometer measurement, m/s^2, and return the Samples that are complete."""
        self.newest_acc_t, self.gyro_alone_since = t, None
        self.waiting_acc.append((t, value))
        return self._release_complete(period, known_at)

    def add_gyro(self, t: float, value: Vec3, period: float, known_at: float) -> list[Sample]:
        """Add a gyroscope measurement, rad/s, and return the Samples that are complete."""
        if self.gyro_newest is not None and t <= self.gyro_newest[0]:
            t = self.gyro_newest[0] + MIN_INCREMENT
        self.gyro_before, self.gyro_newest, self.gyro_silent = self.gyro_newest, (t, value), False
        out = self._release_complete(period, known_at)
        if self.gyro_alone_since is None:
            self.gyro_alone_since = t
        t_last = self.gyro_alone_since if self.newest_acc_t is None else self.newest_acc_t
        if t - t_last > MAX_GAP_PERIODS * period:
            out += self._make_sample(t, None, value, known_at)
        return out

    def add_pressure_alone(self, t: float, pascal: float) -> list[Sample]:
        """Return the Samples that still wait, and a Sample with air pressure (Pa) alone at its arrival `t`, s."""
        out = self.flush(t)
        self.air_pressure = pascal
        return out + self._make_sample(t, None, None, t)

    @property
    def newest_t(self) -> float | None:
        """Time of the newest measurement, of the accelerometer if it has sent any, s; None before any."""
        return self.newest_acc_t if self.newest_acc_t is not None or self.gyro_newest is None else self.gyro_newest[0]

    def after_absence(self) -> Assembler:
        """Return the assembler of what comes after an absence of both streams."""
        return Assembler(self.site, mag=self.mag, air_pressure=self.air_pressure, last_t=self.last_t)

    def flush(self, known_at: float) -> list[Sample]:
        """Return the Samples that still wait, without gyroscope."""
        out: list[Sample] = []
        for t, acc in self.waiting_acc:
            out += self._make_sample(t, acc, None, known_at)
        self.waiting_acc = []
        return out

    def _release_complete(self, period: float, known_at: float) -> list[Sample]:
        out: list[Sample] = []
        while self.waiting_acc:
            t, acc = self.waiting_acc[0]
            t_gyro = None if self.gyro_newest is None else self.gyro_newest[0]
            if (t_gyro is None or t_gyro < t) and not self.gyro_silent:
                if self.waiting_acc[-1][0] - (t if t_gyro is None else t_gyro) < MAX_GAP_PERIODS * period:
                    break
                self.gyro_silent = True
            out += self._make_sample(t, acc, self._interpolate_gyro(t, period), known_at)
            del self.waiting_acc[0]
        return out

    def _interpolate_gyro(self, t: float, period: float) -> Vec3 | None:
        if self.gyro_newest is None:
            return None
        t_b, b = self.gyro_newest
        t_a, a = self.gyro_before or self.gyro_newest
        if t_a <= t <= t_b and 0.0 < t_b - t_a <= MAX_GAP_PERIODS * period:
            k = (t - t_a) / (t_b - t_a)
            x, y, z = [p + k * (q - p) for p, q in zip(a, b, strict=True)]
            return (x, y, z)
        t_nearest, nearest = (t_a, a) if abs(t - t_a) < abs(t_b - t) else (t_b, b)
        return nearest if abs(t_nearest - t) <= MAX_NEAREST_PERIODS * period else None

    def _make_sample(self, t: float, acc: Vec3 | None, gyro: Vec3 | None, known_at: float) -> list[Sample]:
        if self.last_t is not None and t <= self.last_t:  # too late: the first value after a silence of its channel
            return []
        mag, self.mag = self.mag, None
        air_pressure, self.air_pressure = self.air_pressure, None
        self.last_t = t
        known_at = max(known_at, t)
        saturated = gyro is not None and max(map(abs, gyro)) >= GYRO_RANGE_END
        return [
            Sample(t, self.site, acc, gyro, mag=mag, air_pressure=air_pressure, known_at=known_at, saturated=saturated)
        ]
