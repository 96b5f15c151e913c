"""Measurements of the sensors of a SensorTag on the shoe over a whole walk, in SI units, before quantisation."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from attrs import frozen

from ...types import Foot
from ..wearers.curves import Array, Rng
from ..wearers.motion import Kinematics
from ..wearers.shoe import Mounting
from ..wearers.walker import Walker
from .device import DeviceClock, Notification, make_sampling, measure_field
from .magnetic_field import MagneticField
from .parts import BarometerErrors, Imu, TriadErrors
from .sensors import Sampling, measure, read_barometer, to_counts

HANDLING_TIME = 2e-3
"""Time from a measurement until the radio has its value, s (assumed)."""
PERIOD_UNIT = 0.01
"""Unit of a SensorTag's period characteristics, s."""
SLOW_PERIOD = 1.0
"""Period of the barometer and of the CC2541's magnetometer after the usual setup, s."""
MAG_DELAY = 0.3
"""Time from the tag's first sample to the first one of the CC2541's magnetometer, s (assumed)."""
BAROMETER_DELAY = 0.5
"""Time from the tag's first sample to the first one of the barometer, s (assumed)."""

Counts = tuple[int, int, int]


@frozen(eq=False)
class Series:
    """The values of one sensor over a walk; value k is measured at true time `first` + k `step`, s.

    Numbers below 0 and after the end of the walk are valid: the wearer then stands as at the start or the end."""

    first: float
    """True time of value 0, s."""
    step: float
    """True time between values, s."""
    values: Array
    """Measured values in SI units, (N, axes)."""

    def sample_time(self, number: int) -> float:
        """Return the true time of the value of this number, s."""
        return self.first + self.step * number

    def value(self, number: int) -> Array:
        """Return the value of this number, (1, axes)."""
        row = min(max(number, 0), len(self.values) - 1)
        return self.values[row : row + 1]

    def notified(self, channel: str, payloads: Iterable[bytes]) -> list[Notification]:
        """Return the notifications of the encoded values, at the times at which the radio has them."""
        return [Notification(self.sample_time(k) + HANDLING_TIME, channel, data) for k, data in enumerate(payloads)]


def counts(measured: Array, chip: TriadErrors, count: float, axes: Sequence[bool] = (True, True, True)) -> list[Counts]:
    """Return the counts of a three-axis sensor for measured values (N, 3); axes that are off read 0."""
    x, y, z = (to_counts(measured, chip, count).counts * axes).T.tolist()
    return list(zip(x, y, z, strict=True))


@frozen(eq=False)
class TagMotion:
    """The motion of a tag at the sampling instants of a sensor."""

    sampling: Sampling
    """Sampling instants of the sensor."""
    step: float
    """True time between samples, s."""
    kinematics: Kinematics
    """Motion of the tag at the fine instants."""
    field: MagneticField
    """Magnetic field in the building."""

    def acc(self, chip: Imu, rng: Rng) -> Series:
        """Return the series of the accelerometer, m/s^2."""
        return self._series(measure(self.kinematics.force, self.sampling, chip.acc, rng))

    def gyro(self, chip: Imu, rng: Rng) -> Series:
        """Return the series of the gyroscope, rad/s."""
        return self._series(measure(self.kinematics.rate, self.sampling, chip.gyro, rng, self.kinematics.force))

    def mag(self, chip: TriadErrors, rng: Rng) -> Series:
        """Return the series of the magnetometer, T."""
        return self._series(measure_field(self.kinematics, self.field, self.sampling, chip, rng))

    def _series(self, values: Array) -> Series:
        return Series(float(self.sampling.times[0]), self.step, values)


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

    def motion(self, period: float, delay: float = 0.0) -> TagMotion:
        """Return the motion for a sensor with samples `period` s apart, the first `delay` s after the tag's first."""
        sampling = make_sampling(self.walker, self.clock, period, self.clock.first + delay)
        kinematics = self.walker.kinematics(self.foot, sampling.fine_times, self.mounting)
        return TagMotion(sampling, self.clock.interval(period), kinematics, self.walker.field)

    def barometer(self, period: float, chip: BarometerErrors, rng: Rng) -> Series:
        """Return the series of a barometer that measures every `period` s, Pa."""
        t = make_sampling(self.walker, self.clock, period, self.clock.first + BAROMETER_DELAY).times
        height = self.walker.kinematics(self.foot, t, self.mounting).position[:, 2]
        return Series(
            float(t[0]), self.clock.interval(period), read_barometer(height, t, chip, rng, self.walker.air)[:, None]
        )
