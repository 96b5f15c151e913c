"""Windows of two seconds of one foot's vertical acceleration, and the features of each.

Liu et al. 2015, "Track Your Foot Step", section IV.A: "We use a slide window with size 40, which equals to 2 seconds in
time, to ensure that the window contains an entire step period during walking or a process of hypergravity and
weightlessness." Time counts here, not samples, so any rate will do. The paper does not give the shift of the window:
here it is a quarter of the window (`HOP`), so a window is four blocks, of which only sums are kept.

a_z is the paper's vertical axis of a sensor lying flat in the sole. A sensor may have any mounting, so the axis is the
direction of gravity in the sensor over the window before: over whole strides a foot starts and ends with the same
velocity, and the mean specific force is gravity. It needs no gyroscope."""

from __future__ import annotations

from collections import deque
from math import radians, sqrt

from ....types import Vec3
from ....types.attrs import define, field, frozen
from ....types.vector import GRAVITY, TIE

HOP = 0.5
"""Time from the start of a window to that of the next, s."""
BLOCKS = 4
"""Number of blocks in a window."""
WINDOW = BLOCKS * HOP
"""Duration of a window, s."""
FEWEST_SAMPLES = 8
"""Least number of samples in a window; at 10 Hz it has twenty."""
HIGHEST_RATE_SQUARE = radians(250.0) ** 2
"""Limit of the squared angular rate, rad^2/s^2.

The paper's SensorTag measures no more, and other sensors must give the same result for the same gait."""
LEAST_FORCE = 1.0
"""Mean specific force of a window below which gravity has no direction, m/s^2."""


@frozen
class FootWindow:
    """The features of one window of one foot."""

    index: int
    """Number of its last half-second, from the start of all windows."""
    mean: float
    """Length of the mean specific force, m/s^2: for a foot that stays level, the mean of a_z."""
    variance: float
    """Variance of a_z, m^2/s^4."""
    skewness: float
    """Skewness of a_z: above 0 when its peaks are higher than its troughs are deep."""
    across: float
    """Mean square of the specific force across a_z, m^2/s^4."""
    turning: float | None
    """Mean square of the angular rate, rad^2/s^2; None without a gyroscope."""


@define
class WindowBlock:
    """Sums over half a second.

    a_z counts less standard gravity, or its square would drown the rest."""

    index: int
    levelled: bool
    """Flag: the axis of a_z was known."""
    count: int = 0
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    along: float = 0.0
    square: float = 0.0
    cube: float = 0.0
    energy: float = 0.0
    """Sum of the squared specific force, all axes, m^2/s^4."""
    turning: float = 0.0
    turns: int = 0
    """Number of angular rates among the samples."""


@define
class FootWindows:
    """Computes the windows of one foot from its samples in the order of their time; O(1) a sample."""

    axis: Vec3 = (0.0, 0.0, 1.0)
    """Direction of gravity in the sensor, a unit vector."""
    levelled: bool = False
    newest: int | None = None
    """Number of the present half-second; None before any sample."""
    blocks: deque[WindowBlock] = field(factory=deque)
    """Blocks of the window, the one being filled last."""
    ready: deque[FootWindow] = field(factory=deque)
    """Finished windows that have not been taken yet."""

    def update(self, since: float, acc: Vec3, gyro: Vec3 | None = None) -> bool:
        """Add one sample, and return whether it starts another half-second, so `ready` may have another window.

        Specific force in m/s^2 and angular rate in rad/s, sensor frame, `since` s after the start of all windows."""
        index = int((since + TIE) // HOP)
        fresh = index != self.newest
        if fresh:
            self._start_block(index)
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
            block.turning += square if square < HIGHEST_RATE_SQUARE else HIGHEST_RATE_SQUARE
            block.turns += 1
        return fresh

    def _start_block(self, index: int) -> None:
        """Start another half-second: finish the window that is full, and level the axis."""
        blocks = self.blocks
        if blocks:
            self._level()
        if len(blocks) == BLOCKS and blocks[0].levelled:
            window = measure_window(blocks)
            if window is not None:
                self.ready.append(window)
        if self.newest is not None and index != self.newest + 1:
            blocks.clear()  # a gap: no window goes over it
        elif len(blocks) == BLOCKS:
            blocks.popleft()
        blocks.append(WindowBlock(index, self.levelled))
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
        if length > LEAST_FORCE * count:
            self.axis = (x / length, y / length, z / length)
            self.levelled = True


def measure_window(blocks: deque[WindowBlock]) -> FootWindow | None:
    """Return the window of these blocks; None when it has too few samples."""
    count = sum([block.count for block in blocks])
    if count < FEWEST_SAMPLES:
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
        turning=sum([block.turning for block in blocks]) / turns if turns >= FEWEST_SAMPLES else None,
        across=max(0.0, energy - (m2 + 2.0 * GRAVITY * m1 + GRAVITY * GRAVITY)),
    )
