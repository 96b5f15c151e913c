"""Detection of a sensor that is filtered so much that it does not follow the impacts and the swing of a foot."""

from __future__ import annotations

from math import pi, sqrt

from ...events import Defect
from ...types.attrs import define, field
from .axes import LONGEST_STRIDE, SHORTEST_STRIDE
from .finding import Finding
from .stances import FORCE, TICK, TURN, ClosedStride

LEAST_ACC, LEAST_GYRO = 2.6, 1.8
"""Usual frequency of the changes of specific force and of angular rate over a stride below which they are filtered, Hz.

Of 375 recordings of a foot, the smallest are 3.4 and 1.9. Averaged over 0.2 s, of which a tracker loses stances, 95 in
100 are below 2.3 and 2.0."""
STRIDES = 6
"""Number of strides whose median is judged."""


@define
class BandwidthCheck:
    """Looks at how fast the specific force and the angular rate change over a stride."""

    acc: list[float] = field(factory=list)
    """Frequency of the changes of the specific force in each stride, Hz."""
    gyro: list[float] = field(factory=list)
    """Frequency of the changes of the angular rate in each stride, Hz."""

    def add(self, stride: ClosedStride) -> Finding | None:
        """Add a stride; return which sensor is filtered, once there are enough strides; they are judged once."""
        if len(self.acc) >= STRIDES or not SHORTEST_STRIDE < stride.duration < LONGEST_STRIDE:
            return None
        rates, forces = [], []
        for duration, tx, ty, tz, ax, ay, az in stride.intervals:
            k = TURN / (TICK * duration)
            rates.append((k * tx, k * ty, k * tz))
            forces.append((FORCE * ax, FORCE * ay, FORCE * az))
        interval = stride.duration / len(rates)
        self.acc.append(_frequency(forces, interval))
        self.gyro.append(_frequency(rates, interval))
        if len(self.acc) < STRIDES:
            return None
        acc_is_filtered = sorted(self.acc)[STRIDES // 2] < LEAST_ACC
        gyro_is_filtered = sorted(self.gyro)[STRIDES // 2] < LEAST_GYRO
        if not (acc_is_filtered or gyro_is_filtered):
            return None
        name = "the accelerometer is" if acc_is_filtered else "the gyroscope is"
        text = (
            f"{'both sensors are' if acc_is_filtered and gyro_is_filtered else name} filtered or averaged so much that"
        )
        return Finding(Defect.BANDWIDTH, f"{text} a step is smoothed away: choose a bandwidth of 20 Hz or more")


def _frequency(values: list[tuple[float, float, float]], interval: float) -> float:
    """Return the root mean square frequency of a signal with values each `interval`, s, in Hz.

    A signal of frequency f changes by 2 pi f of its own size in a second."""
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
    return sqrt(change / power) / (2.0 * pi * interval) if power > 0.0 else 0.0
