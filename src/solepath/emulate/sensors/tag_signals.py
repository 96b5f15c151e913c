"""What the sensors of a tag on the shoe measure over a whole walk, in SI units, before it makes counts of it."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from ...types import Foot
from ..wearers.curves import Array
from ..wearers.motion import Kinematics
from ..wearers.shoe import Mounting
from ..wearers.walker import Walker
from .device import FIELD, DeviceClock, samplings, seen_from
from .parts import BarometerPart, Imu, Triad
from .sensors import Instants, counted, measure, read_barometer

HANDLING = 2e-3
"""s from a measurement until the radio has it."""
SLOW = 1.0
"""s between readings of the barometer, and of the CC2541's magnetometer, after the usual setup."""
LATE_MAG = 0.3
LATE_AIR = 0.5
"""s after the first sample of the others."""


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

    def count(self, number: int, part: Triad, count: float) -> tuple[int, int, int]:
        """One value as a triad counts it."""
        x, y, z = counted(self.value(number), part, count).counts[0].tolist()
        return (x, y, z)

    def counts(self, part: Triad, count: float) -> list[tuple[int, int, int]]:
        """All values as a triad counts them."""
        return [(x, y, z) for x, y, z in counted(self.values, part, count).counts.tolist()]


@frozen(eq=False)
class WornTag:
    """A tag on a foot: `clock` is its own."""

    walker: Walker
    foot: Foot
    mounting: Mounting
    clock: DeviceClock

    def when(self, period: float, late: float = 0.0) -> Instants:
        """The instants of a sensor that measures every `period` s, `late` s after the first sample."""
        return samplings(self.walker, self.clock, period, self.clock.first + late)

    def motion(self, when: Instants) -> Kinematics:
        return self.walker.kinematics(self.foot, when.fine, self.mounting)

    def acc(self, motion: Kinematics, when: Instants, part: Imu, rng: np.random.Generator) -> Array:
        """m/s^2."""
        return measure(motion.force, when, part.acc, rng)

    def gyro(self, motion: Kinematics, when: Instants, part: Imu, rng: np.random.Generator) -> Array:
        """rad/s."""
        return measure(motion.rate, when, part.gyro, rng, force=motion.force)

    def mag(self, motion: Kinematics, when: Instants, part: Triad, rng: np.random.Generator) -> Array:
        """T."""
        return measure(seen_from(motion.attitude, FIELD), when, part, rng)

    def air(self, period: float, part: BarometerPart, rng: np.random.Generator) -> Series:
        """Pa, (N, 1)."""
        when = self.when(period, LATE_AIR)
        height = self.walker.kinematics(self.foot, when.taken, self.mounting).position[:, 2]
        return self.series(when, period, read_barometer(height, when.taken, part, rng)[:, None])

    def series(self, when: Instants, period: float, values: Array) -> Series:
        """What was measured every `period` s at these instants."""
        return Series(float(when.taken[0]), self.clock.interval(period), values)
