"""Detection of a sensor that is filtered so much that it does not follow the impacts and the swing of a foot."""

from __future__ import annotations

from math import pi, sqrt

from ...events import Defect
from ...types import Vec3
from ...types.attrs import define, field
from .axes import LONGEST_STRIDE, SHORTEST_STRIDE
from .finding import Finding
from .stances import FORCE, TICK, TURN, ClosedStride

LEAST_ACC, LEAST_GYRO = 2.6, 2.0
"""Usual number of cycles a stride of specific force and of angular rate below which they are filtered.

It is a number for each stride, because all that a slow walker does is slow. Of 375 recordings of a foot, the smallest
are 3.2 and 2.5, of emulated walks at 0.3 m/s 3.7 and 2.1. Averaged over 0.33 s, with which a tracker loses stances, 95
in 100 are below 2.2 and 1.9."""
STRIDES = 6
"""Number of strides whose median is judged."""


@define
class BandwidthCheck:
    """Looks at how fast the specific force and the angular rate change over a stride."""

    acc: list[float] = field(factory=list)
    """Number of cycles of the specific force in each stride."""
    gyro: list[float] = field(factory=list)
    """Number of cycles of the angular rate in each stride."""

    def add(self, stride: ClosedStride) -> Finding | None:
        """Add a stride; return which sensor is filtered, once there are enough strides; they are judged once."""
        if self.judged or not SHORTEST_STRIDE < stride.duration < LONGEST_STRIDE:
            return None
        rates, forces = [], []
        for duration, tx, ty, tz, ax, ay, az in stride.intervals:
            k = TURN / (TICK * duration)
            rates.append((k * tx, k * ty, k * tz))
            forces.append((FORCE * ax, FORCE * ay, FORCE * az))
        self.acc.append(_cycles(forces))
        self.gyro.append(_cycles(rates))
        if not self.judged:
            return None
        acc_is_filtered = sorted(self.acc)[STRIDES // 2] < LEAST_ACC
        gyro_is_filtered = sorted(self.gyro)[STRIDES // 2] < LEAST_GYRO
        if not (acc_is_filtered or gyro_is_filtered):
            return None
        name = "the accelerometer is" if acc_is_filtered else "the gyroscope is"
        name = "both sensors are" if acc_is_filtered and gyro_is_filtered else name
        text = f"{name} filtered or averaged so much that a step is smoothed away: choose a bandwidth of 20 Hz or more"
        return Finding(Defect.BANDWIDTH, text)

    @property
    def judged(self) -> bool:
        """Return whether there were enough strides."""
        return len(self.acc) >= STRIDES


def _cycles(values: list[Vec3]) -> float:
    """Return the number of cycles of a signal in the duration of its values, by its root mean square frequency.

    A signal of n cycles changes by 2 pi n of its own size in that duration."""
    n = len(values)
    x = y = z = 0.0
    for a, b, c in values:
        x, y, z = x + a, y + b, z + c
    x, y, z = x / n, y / n, z / n
    power = change = 0.0
    last_a, last_b, last_c = values[0]
    for a, b, c in values:
        power += (a - x) ** 2 + (b - y) ** 2 + (c - z) ** 2
        change += (a - last_a) ** 2 + (b - last_b) ** 2 + (c - last_c) ** 2
        last_a, last_b, last_c = a, b, c
    return n * sqrt(change / power) / (2.0 * pi) if power > 0.0 else 0.0
