"""What the sensors of a tag on the shoe measure over a whole walk, in SI units, before it makes counts of it."""

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
"""s from a measurement until the radio has it."""
SLOW = 1.0
"""s between readings of the barometer, and of the CC2541's magnetometer, after the usual setup."""
MAG_DELAY = 0.3
BAROMETER_DELAY = 0.5
"""s after the first sample of the others."""

Counts = tuple[int, int, int]


@frozen(eq=False)
class Series:
    """`values` (N, axes), value k measured at `first` + k `step`, s in true time.

    There are values of any number, also below 0 and beyond the walk's end: the wearer then stands as at its beginning
    or end.
    """

    first: float
    step: float
    values: Array

    def taken(self, number: int) -> float:
        return self.first + self.step * number

    def value(self, number: int) -> Array:
        """(1, axes)."""
        row = min(max(number, 0), len(self.values) - 1)
        return self.values[row : row + 1]

    def notified(self, channel: str, payloads: Iterable[bytes]) -> list[Notification]:
        """What is said of each value, as it is sent."""
        return [Notification(self.taken(k) + HANDLING, channel, data) for k, data in enumerate(payloads)]


def counts(measured: Array, part: Triad, count: float, axes: Sequence[bool] = (True, True, True)) -> list[Counts]:
    """The rows of what a triad measured, (N, 3), as it counts them; axes that are off read 0."""
    x, y, z = (to_counts(measured, part, count).counts * axes).T.tolist()
    return list(zip(x, y, z, strict=True))


@frozen(eq=False)
class TagMotion:
    """How a tag moves at the instants of a sensor, and what sensors measure of it; every `step` s of true time."""

    when: Instants
    step: float
    motion: Kinematics

    def acc(self, part: Imu, rng: Rng) -> Series:
        """m/s^2."""
        return self._series(measure(self.motion.force, self.when, part.acc, rng))

    def gyro(self, part: Imu, rng: Rng) -> Series:
        """rad/s."""
        return self._series(measure(self.motion.rate, self.when, part.gyro, rng, self.motion.force))

    def mag(self, part: Triad, rng: Rng) -> Series:
        """T."""
        return self._series(measure(in_sensor_frame(self.motion.attitude, FIELD), self.when, part, rng))

    def _series(self, values: Array) -> Series:
        return Series(float(self.when.taken[0]), self.step, values)


@frozen(eq=False)
class WornTag:
    """A tag on a foot: `clock` is its own."""

    walker: Walker
    foot: Foot
    mounting: Mounting
    clock: DeviceClock

    def moving(self, period: float, delay: float = 0.0) -> TagMotion:
        """For a sensor that measures every `period` s, `late` s after the first sample."""
        when = sampling_instants(self.walker, self.clock, period, self.clock.first + delay)
        motion = self.walker.kinematics(self.foot, when.fine, self.mounting)
        return TagMotion(when, self.clock.interval(period), motion)

    def air(self, period: float, part: BarometerPart, rng: Rng) -> Series:
        """Pa, (N, 1), measured every `period` s."""
        t = sampling_instants(self.walker, self.clock, period, self.clock.first + BAROMETER_DELAY).taken
        height = self.walker.kinematics(self.foot, t, self.mounting).position[:, 2]
        return Series(float(t[0]), self.clock.interval(period), read_barometer(height, t, part, rng)[:, None])
