"""Windows of two seconds of one foot's vertical acceleration, and what a classifier asks of each.

Liu et al. 2015, "Track Your Foot Step", section IV.A: "We use a slide window with size 40, which equals to 2 seconds in
time, to ensure that the window contains an entire step period during walking or a process of hypergravity and
weightlessness." Time counts here, not samples, so any rate will do. By how much a window slides on is not said: here by
a quarter of itself (`HOP`), so a window is four blocks, of which only sums are kept.

a_z is the paper's vertical axis of a sensor lying flat in the sole. A sensor may be mounted anyhow, so the axis is
where gravity was in the sensor over the window before: over whole strides a foot begins and ends with the same
velocity, and what remains of the specific force is gravity. It needs no gyroscope.
"""

from __future__ import annotations

from collections import deque
from math import radians, sqrt

from ....types import Vec3
from ....types.attrs import define, field, frozen
from ....types.vector import GRAVITY, TIE

HOP = 0.5
"""A window begins this much later than the one before, s."""
BLOCKS = 4
WINDOW = BLOCKS * HOP
"""s."""
FEWEST = 8
"""Samples that a window has at the least; at 10 Hz it has twenty."""
FASTEST = radians(250.0) ** 2
"""What turns faster counts as this, rad^2/s^2: the paper's SensorTag measures no more, and other sensors must tell the
same of the same gait."""
WEIGHTLESS = 1.0
"""Gravity has no direction in a window whose mean specific force is less, m/s^2."""


@frozen
class FootWindow:
    """What a window holds, of one foot."""

    index: int
    """Its last half-second is number `index` from the beginning of all windows."""
    mean: float
    """Length of the mean specific force, m/s^2: of a foot that stays level, the mean of a_z."""
    variance: float
    """Of a_z, m^2/s^4."""
    skewness: float
    """Of a_z: above 0 when its peaks are higher than its troughs are deep."""
    across: float
    """Mean square of the specific force across a_z, m^2/s^4."""
    turning: float | None
    """Mean square of the angular rate, rad^2/s^2; None without a gyroscope."""


@define
class HalfSecond:
    """Sums over half a second. a_z counts as what it is above standard gravity, or its square would drown the rest."""

    index: int
    levelled: bool
    """There was an axis to measure a_z along."""
    count: int = 0
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    along: float = 0.0
    square: float = 0.0
    cube: float = 0.0
    energy: float = 0.0
    """Of the whole vector."""
    turning: float = 0.0
    turns: int = 0
    """Angular rates among the samples."""


@define
class FootWindows:
    """Feed it the accelerations of one foot in the order of their time. O(1) a sample."""

    axis: Vec3 = (0.0, 0.0, 1.0)
    """Where gravity is in the sensor, a unit vector."""
    levelled: bool = False
    newest: int | None = None
    """The half-second that it is in; None before any sample."""
    blocks: deque[HalfSecond] = field(factory=deque)
    """Those of the window, the one being filled last."""
    ready: deque[FootWindow] = field(factory=deque)
    """Windows that nobody has taken yet."""

    def update(self, since: float, acc: Vec3, gyro: Vec3 | None = None) -> bool:
        """Specific force in m/s^2 and angular rate in rad/s, sensor frame, `since` s after the beginning of all
        windows. True when the sample is the first of another half-second, so `ready` may have another window."""
        index = int((since + TIE) // HOP)
        fresh = index != self.newest
        if fresh:
            self._turn(index)
        block = self.blocks[-1]
        x, y, z = acc
        ux, uy, uz = self.axis
        along = ux * x + uy * y + uz * z - GRAVITY
        square = along * along
        block.count += 1
        block.x += x
        block.y += y
        block.z += z
        block.along += along
        block.square += square
        block.cube += square * along
        block.energy += x * x + y * y + z * z
        if gyro is not None:
            x, y, z = gyro
            square = x * x + y * y + z * z
            block.turning += square if square < FASTEST else FASTEST
            block.turns += 1
        return fresh

    def _turn(self, index: int) -> None:
        """Another half-second begins: tell the window that is full, and level the axis."""
        blocks = self.blocks
        if blocks:
            self._level()
        if len(blocks) == BLOCKS and blocks[0].levelled:
            window = measured(blocks)
            if window is not None:
                self.ready.append(window)
        if self.newest is not None and index != self.newest + 1:
            blocks.clear()  # a gap: no window goes over it
        elif len(blocks) == BLOCKS:
            blocks.popleft()
        blocks.append(HalfSecond(index, self.levelled))
        self.newest = index

    def _level(self) -> None:
        x = y = z = 0.0
        count = 0
        for block in self.blocks:
            x += block.x
            y += block.y
            z += block.z
            count += block.count
        length = sqrt(x * x + y * y + z * z)
        if length > WEIGHTLESS * count:
            self.axis = (x / length, y / length, z / length)
            self.levelled = True


def measured(blocks: deque[HalfSecond]) -> FootWindow | None:
    """The window of these blocks; None when it has too few samples."""
    count = sum([block.count for block in blocks])
    if count < FEWEST:
        return None
    share = 1.0 / count
    x, y, z = (share * sum([getattr(block, axis) for block in blocks]) for axis in "xyz")
    m1, m2, m3, energy = (
        share * sum([getattr(block, what) for block in blocks]) for what in ("along", "square", "cube", "energy")
    )
    turns = sum([block.turns for block in blocks])
    variance = max(0.0, m2 - m1 * m1)
    third = m3 - 3.0 * m1 * m2 + 2.0 * m1 * m1 * m1
    return FootWindow(
        index=blocks[-1].index,
        mean=sqrt(x * x + y * y + z * z),
        variance=variance,
        skewness=third / (variance * sqrt(variance)) if variance > 1e-9 else 0.0,
        turning=sum([block.turning for block in blocks]) / turns if turns >= FEWEST else None,
        across=max(0.0, energy - (m2 + 2.0 * GRAVITY * m1 + GRAVITY * GRAVITY)),
    )
