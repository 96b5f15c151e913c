"""The newest blocks (half seconds) of one foot: sums over samples, and its newest strides."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import sqrt

from ....events import FootFlat, HeelStrike, StrideTaken
from ....types import Vec3
from ....types.attrs import define, field
from ....types.vector import ZERO
from .features import (
    ACC_LIMIT,
    BIN_COUNT,
    BLOCK_DURATION,
    RATE_LIMIT,
    WINDOW_REACH,
    ActivityBlock,
    BlockStride,
    features_of,
)

MAX_BLOCKS = 2 * WINDOW_REACH + 1
"""Number of blocks that are kept: one window."""
MAX_STRIDES = 3
"""Number of strides that are kept: a window of a runner holds as many."""
MAX_STRIDE_TIME = 1.6
"""Longest time of a stride, s; a longer one started with standing, which is cut off."""


@define
class FootBlocks:
    """The newest blocks of one foot: `add` takes each sample, `close` ends a block, `features` returns its features."""

    index: int | None = None
    """Number of the block under way."""
    force: float = 0.0
    """Sum of |acc| over the block under way, m/s^2."""
    squares: float = 0.0
    """Sum of |acc|^2 over the block under way, (m/s^2)^2."""
    acc_bins: list[int] = field(factory=lambda: [0] * BIN_COUNT)
    """Number of samples of the block under way in each bin of |acc|; every sample is in a bin."""
    rate_squares: float = 0.0
    """Sum of |gyro|^2 over the block under way, (rad/s)^2."""
    gyro_bins: list[int] = field(factory=lambda: [0] * BIN_COUNT)
    """Number of samples of the block under way in each bin of |gyro|."""
    bias: Vec3 = ZERO
    """Gyroscope bias at the start of the block, rad/s."""
    resolution: float = 0.0
    """Resolution of the accelerometer, m/s^2 per count; 0 when it is not known."""
    tracked: bool = False
    """Flag: velocity and position were known in the block under way."""
    climb: float = 0.0
    """Largest upward velocity in the block under way, m/s."""
    sink: float = 0.0
    """Largest downward velocity in the block under way, m/s, negative."""
    speed: float = 0.0
    """Largest square of the horizontal speed in the block under way, (m/s)^2."""
    flat_height: float = 0.0
    """Height at the last foot-flat, navigation frame, m."""
    top: float = 0.0
    """Greatest height since the last foot-flat, navigation frame, m."""
    bottom: float = 0.0
    """Lowest height since the last foot-flat, navigation frame, m."""
    strike_height: float | None = None
    """Height at the last heel-strike, navigation frame, m; None when there was none since foot-flat."""
    blocks: deque[ActivityBlock] = field(factory=deque)
    """The newest blocks, at most `MAX_BLOCKS`, oldest first."""
    strides: deque[BlockStride] = field(factory=deque)
    """The newest strides, at most `MAX_STRIDES`, oldest first."""

    def start_block(self, index: int, bias: Vec3, resolution: float) -> None:
        """Start a block with the gyroscope bias, rad/s, and the accelerometer's resolution, m/s^2 per count.

        A resolution of 0 means that it is not known."""
        self.index = index
        self.force = self.squares = self.rate_squares = 0.0
        self.acc_bins = [0] * BIN_COUNT
        self.gyro_bins = [0] * BIN_COUNT
        self.bias = bias
        self.resolution = resolution
        self.tracked = False
        self.climb = self.sink = self.speed = 0.0

    def add(self, acc: Vec3, gyro: Vec3 | None, velocity: Vec3 | None, height: float) -> None:
        """Add a sample to the block under way.

        `velocity`, m/s, and `height`, m, are those of the foot after it, z up; no velocity: the motion is not known."""
        x, y, z = acc
        length = sqrt(x * x + y * y + z * z)
        self.force += length
        self.squares += length * length
        self.acc_bins[int(length * 0.5) if length < ACC_LIMIT else BIN_COUNT - 1] += 1
        if gyro is None:
            return
        (x, y, z), (u, v, w) = gyro, self.bias
        square = (x - u) * (x - u) + (y - v) * (y - v) + (z - w) * (z - w)
        rate = sqrt(square)
        self.rate_squares += square
        self.gyro_bins[int(rate) if rate < RATE_LIMIT else BIN_COUNT - 1] += 1
        if velocity is None:
            return
        self.tracked = True
        x, y, z = velocity
        if z > self.climb:
            self.climb = z
        elif z < self.sink:
            self.sink = z
        square = x * x + y * y
        if square > self.speed:
            self.speed = square
        if height > self.top:
            self.top = height
        elif height < self.bottom:
            self.bottom = height

    def add_events(self, events: Sequence[object], height: float) -> None:
        """Add the events of a sample; `height` is the foot's, navigation frame, m."""
        for event in events:
            if isinstance(event, StrideTaken):
                self._add_stride(event)
            elif isinstance(event, HeelStrike):
                self.strike_height = height
        for event in events:
            if isinstance(event, FootFlat):
                self.flat_height = self.top = self.bottom = height
                self.strike_height = None

    def close(self) -> None:
        """Close the block under way and keep it."""
        n, rates = sum(self.acc_bins), sum(self.gyro_bins)  # whole numbers
        if self.index is None or not n:
            return
        mean = self.force / n
        self.blocks.append(
            ActivityBlock(
                self.index,
                n,
                round(mean, 6),
                round(max(0.0, self.squares / n - mean * mean), 6),
                _limited(self.acc_bins),
                rates,
                round(self.rate_squares / rates, 6) if rates else 0.0,
                _limited(self.gyro_bins),
                self.tracked,
                round(self.climb, 4),
                round(self.sink, 4),
                round(sqrt(self.speed), 4),
            )
        )
        if len(self.blocks) > MAX_BLOCKS:
            self.blocks.popleft()

    def _add_stride(self, stride: StrideTaken) -> None:
        features = stride.features
        # use heights as integrated: the network was trained with them; clearance is above the higher end of the stride
        rise = stride.height_change if features.rise is None else features.rise
        clearance = features.clearance + max(stride.height_change, 0.0) - max(rise, 0.0)
        self.strides.append(
            BlockStride(
                stride.t_start,
                stride.t_end,
                round(stride.length, 4),
                round(rise, 4),
                round(clearance, 4),
                round(features.peak_speed, 4),
                round(features.swing_pitch, 4),
                round(self.top - self.flat_height, 4),
                round(self.bottom - self.flat_height, 4),
                round(
                    (self.strike_height if self.strike_height is not None else self.flat_height) - self.flat_height, 4
                ),
            )
        )
        if len(self.strides) > MAX_STRIDES:
            self.strides.popleft()

    def restart(self) -> None:
        """Discard all blocks and strides, because the clock restarts."""
        self.index = None
        self.acc_bins = [0] * BIN_COUNT
        self.blocks.clear()
        self.strides.clear()

    def block(self, index: int) -> ActivityBlock | None:
        """Return the block number `index`; None when it has no samples."""
        for block in self.blocks:
            if block.index == index:
                return block
        return None

    def features(self, index: int, t: float) -> list[float] | None:
        """Return the features of the block number `index`, whose middle is at `t`, s; None when it has no samples."""
        here = self.block(index)
        if here is None:
            return None
        near = [block for block in self.blocks if -WINDOW_REACH <= block.index - index <= WINDOW_REACH]
        return features_of(here, near, self._stride_at(t))

    def _stride_at(self, t: float) -> BlockStride | None:
        """Return the stride nearest to `t`, s; None when none is within a quarter of a second."""
        best, nearest = None, 0.5 * BLOCK_DURATION
        for stride in self.strides:
            start = max(stride.start, stride.end - MAX_STRIDE_TIME)
            distance = max(start - t, t - stride.end, 0.0)
            if distance <= nearest:
                best, nearest = stride, distance
        return best


def _limited(bins: list[int]) -> tuple[int, ...]:
    return tuple([min(n, 255) for n in bins])
