"""Measurements of the sensors of a SensorTag on the shoe over a whole walk, in SI units, before quantisation."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from attrs import frozen

from ...types import Foot
from ..wearers.curves import Array, Rng
from ..wearers.motion import Kinematics
from ..wearers.shoe import Mounting
from ..wearers.walker import Walker
from .device import FIELD, DeviceClock, Notification, in_sensor_frame, sampling_instants
from .parts import BarometerPart, Imu, Triad
from .sensors import Instants, measure, read_barometer, to_counts

HANDLING = 2e-3
"""Time from a measurement until the radio has it, s."""
SLOW = 1.0
"""Period of the barometer and of the CC2541's magnetometer after the usual setup, s."""
MAG_DELAY = 0.3
"""Delay of the magnetometer's first sample after the tag's first sample, s."""
BAROMETER_DELAY = 0.5
"""Delay of the barometer's first sample after the tag's first sample, s."""

Counts = tuple[int, int, int]


@frozen(eq=False)
class Series:
    """The values of one sensor over a walk; value k is measured at true time `first` + k `step`, s.

    Values can have any number, also below 0 and after the end of the walk: the wearer then stands as at the start or
    the end."""

    first: float
    """True time of value 0, s."""
    step: float
    """True time between values, s."""
    values: Array
    """Measured values in SI units, (N, axes)."""

    def taken(self, number: int) -> float:
        """Return the true time of a value, s."""
        return self.first + self.step * number

    def value(self, number: int) -> Array:
        """Return a value, (1, axes)."""
        row = min(max(number, 0), len(self.values) - 1)
        return self.values[row : row + 1]

    def notified(self, channel: str, payloads: Iterable[bytes]) -> list[Notification]:
        """Return the notifications of the encoded values, at the times at which the radio has them."""
        return [Notification(self.taken(k) + HANDLING, channel, data) for k, data in enumerate(payloads)]


def counts(measured: Array, part: Triad, count: float, axes: Sequence[bool] = (True, True, True)) -> list[Counts]:
    """Return the counts of a triad for measured values (N, 3); axes that are off read 0."""
    x, y, z = (to_counts(measured, part, count).counts * axes).T.tolist()
    return list(zip(x, y, z, strict=True))


@frozen(eq=False)
class TagMotion:
    """The motion of a tag at the sampling instants of a sensor."""

    when: Instants
    """Sampling instants of the sensor."""
    step: float
    """True time between samples, s."""
    motion: Kinematics
    """Motion of the tag at the fine instants."""

    def acc(self, part: Imu, rng: Rng) -> Series:
        """Return what the accelerometer measures, m/s^2."""
        return self._series(measure(self.motion.force, self.when, part.acc, rng))

    def gyro(self, part: Imu, rng: Rng) -> Series:
        """Return what the gyroscope measures, rad/s."""
        return self._series(measure(self.motion.rate, self.when, part.gyro, rng, self.motion.force))

    def mag(self, part: Triad, rng: Rng) -> Series:
        """Return what the magnetometer measures, T."""
        return self._series(measure(in_sensor_frame(self.motion.attitude, FIELD), self.when, part, rng))

    def _series(self, values: Array) -> Series:
        return Series(float(self.when.taken[0]), self.step, values)


@frozen(eq=False)
class WornTag:
    """A tag on a foot."""

    walker: Walker
    """Walker that wears the tag."""
    foot: Foot
    """Foot that wears the tag."""
    mounting: Mounting
    """Position and attitude on the foot."""
    clock: DeviceClock
    """Clock of the tag."""

    def moving(self, period: float, delay: float = 0.0) -> TagMotion:
        """Return the motion for a sensor that measures every `period` s, from `delay` s after the first sample on."""
        when = sampling_instants(self.walker, self.clock, period, self.clock.first + delay)
        motion = self.walker.kinematics(self.foot, when.fine, self.mounting)
        return TagMotion(when, self.clock.interval(period), motion)

    def air(self, period: float, part: BarometerPart, rng: Rng) -> Series:
        """Return what the barometer measures every `period` s, Pa, (N, 1)."""
        t = sampling_instants(self.walker, self.clock, period, self.clock.first + BAROMETER_DELAY).taken
        height = self.walker.kinematics(self.foot, t, self.mounting).position[:, 2]
        return Series(float(t[0]), self.clock.interval(period), read_barometer(height, t, part, rng)[:, None])
