"""Windows of two seconds of one foot's vertical specific force, and their features.

Liu et al. 2015, "Track Your Foot Step", section IV.A: "We use a slide window with size 40, which equals to 2 seconds in
time, to ensure that the window contains an entire step period during walking or a process of hypergravity and
weightlessness." Here a window is a time, not a number of samples, so the sample rate does not matter. The paper does
not give the shift from one window to the next. Here it is a quarter of a window (`HOP`). So a window is made of four
blocks, of which only sums are kept.

a_z is the component along the paper's vertical axis, of a sensor that lies flat in the sole. For any other mounting the
axis is the mean direction of specific force over the previous window: a foot has the same velocity at both ends of a
whole stride, so that mean is gravity. This needs no gyroscope.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections import deque
from math import fsum, radians, sqrt

from ....types import Floats, Vec3
from ....types.attrs import define, field, frozen
from ....types.vector import GRAVITY, TIME_EPSILON, dot

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

The range of the paper's SensorTag ends there, and a sensor with a larger range must give the same result for the same
gait."""
LEAST_FORCE = 1.0
"""Length of a window's mean specific force below which it does not show the direction of gravity, m/s^2."""
QUICK_SHARE, SLOW_SHARE = 0.5, 0.05
"""Least weight of a window in the mean of standing: directly after a movement, and at other times."""


@frozen
class FootWindow:
    """The features of one window of one foot."""

    index: int
    """Number of the window's last half-second, counted from the first sample."""
    mean: float
    """Length of the mean specific force, m/s^2; the mean of a_z if the foot stays level."""
    variance: float
    """Variance of a_z, m^2/s^4."""
    skewness: float
    """Skewness of a_z, without unit: positive when upward peaks are higher than downward ones."""
    across: float
    """Mean square of the specific force at right angles to a_z, m^2/s^4."""
    turning: float | None
    """Mean square of the angular rate, rad^2/s^2; None without a gyroscope."""


@define
class WindowBlock:
    """The sums over the samples of half a second."""

    index: int
    """Number of the half-second, counted from the first sample."""
    levelled: bool
    """Flag: the axis of a_z was known."""
    count: int = 0
    """Number of samples."""
    turns: int = 0
    """Number of samples with an angular rate."""
    sums: Floats = (0.0,) * 8
    """Sums of the specific force along the sensor's x, y and z, m/s^2; of a_z minus standard gravity, without which
    powers would lose digits, m/s^2, of its square and of its cube; of the squared specific force, all axes, m^2/s^4;
    and of the squared angular rate, rad^2/s^2."""


@define
class FootWindows:
    """Computes the windows of one foot from its samples, in order of time, at constant cost for each sample."""

    axis: Vec3 = (0.0, 0.0, 1.0)
    """Unit vector upwards in the sensor frame."""
    levelled: bool = False
    """Flag: `axis` is known."""
    newest: int | None = None
    """Number of the present half-second; None before any sample."""
    blocks: deque[WindowBlock] = field(factory=deque)
    """Blocks of the window; the last one is being filled."""
    ready: deque[FootWindow] = field(factory=deque)
    """Finished windows that have not been taken yet."""

    def update(self, since: float, acc: Vec3, gyro: Vec3 | None = None) -> bool:
        """Add one sample, and return whether it starts another half-second, so that `ready` may have another window.

        `acc` is the specific force in m/s^2 and `gyro` the angular rate in rad/s, sensor frame. `since` is the time
        since the first sample, s."""
        index = int((since + TIME_EPSILON) // HOP)
        is_next_block = index != self.newest
        if is_next_block:
            self._start_block(index)
        block = self.blocks[-1]
        along = dot(self.axis, acc) - GRAVITY
        square, turning = along * along, 0.0
        if gyro is not None:
            turning = min(dot(gyro, gyro), HIGHEST_RATE_SQUARE)
            block.turns += 1
        block.count += 1
        values = (*acc, along, square, square * along, dot(acc, acc), turning)
        block.sums = tuple([total + value for total, value in zip(block.sums, values, strict=True)])
        return is_next_block

    def _start_block(self, index: int) -> None:
        blocks = self.blocks
        if blocks:
            self._level()
        if len(blocks) == BLOCKS and blocks[0].levelled:
            window = measure_window(blocks)
            if window is not None:
                self.ready.append(window)
        if self.newest is not None and index != self.newest + 1:
            blocks.clear()  # no window contains a gap
        elif len(blocks) == BLOCKS:
            blocks.popleft()
        blocks.append(WindowBlock(index, self.levelled))
        self.newest = index

    def _level(self) -> None:
        count = sum([block.count for block in self.blocks])  # whole numbers
        x, y, z = (fsum([block.sums[axis] for block in self.blocks]) for axis in range(3))
        length = sqrt(x * x + y * y + z * z)
        if length > LEAST_FORCE * count:
            self.axis = (x / length, y / length, z / length)
            self.levelled = True


def measure_window(blocks: deque[WindowBlock]) -> FootWindow | None:
    """Return the window of these blocks; None when it has too few samples."""
    count, turns = [sum([block.count for block in blocks]), sum([block.turns for block in blocks])]  # whole numbers
    if count < FEWEST_SAMPLES:
        return None
    sums = [fsum(column) for column in zip(*[block.sums for block in blocks], strict=True)]
    x, y, z, m1, m2, m3, energy, _ = (total / count for total in sums)
    variance = max(0.0, m2 - m1 * m1)
    third = m3 - 3.0 * m1 * m2 + 2.0 * m1 * m1 * m1
    return FootWindow(
        index=blocks[-1].index,
        mean=sqrt(x * x + y * y + z * z),
        variance=variance,
        skewness=third / (variance * sqrt(variance)) if variance > 1e-9 else 0.0,
        turning=sums[-1] / turns if turns >= FEWEST_SAMPLES else None,
        across=max(0.0, energy - (m2 + 2.0 * GRAVITY * m1 + GRAVITY * GRAVITY)),
    )


@define
class StandingForce:
    """The length of a standing foot's specific force, averaged over windows, m/s^2."""

    mean: float | None = None
    share: float = 1.0
    """Weight that the next window of standing will have in the mean."""

    def add_window(self, mean: float) -> None:
        """Add the mean specific force of another window of standing, m/s^2."""
        self.mean = mean if self.mean is None else self.mean + self.share * (mean - self.mean)
        self.share = max(SLOW_SHARE, self.share / (1.0 + self.share))

    def add_movement(self) -> None:
        """Give the next window more weight, because after a movement the foot may stand in another posture."""
        self.share = max(self.share, QUICK_SHARE)
