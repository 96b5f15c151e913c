"""The newest blocks (half seconds) of one foot: sums over samples, and its newest strides."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, log, sqrt

from ...events import FootFlat, HeelStrike, StrideTaken
from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, add, cross, sub
from .flights import integrated_rise

# Features of one foot's blocks (half seconds of samples), from which activities are recognised.
#
# Features of samples use only the lengths of vectors, so they do not depend on the mounting of the sensor. They use
# shares of samples instead of numbers of samples, so they depend little on the sample rate.

BLOCK_DURATION = 0.5
"""Duration of a block, s."""
WINDOW_REACH = 2
"""Number of blocks before and after the judged one in its window: five blocks, 2.5 s."""
STEADY_FORCES, HARD_FORCE = (8.0, 12.0), 18.0
"""Specific forces between which a foot is hardly accelerated, and from which on it is hard, m/s^2.

Some accelerometers clip at 2 g, so what is above counts the same. Edges of the bins of an earlier model."""
FAST_RATE = 5.0
"""Angular rate from which on a foot turns fast, rad/s: in the swing of a walk, not in its stance."""
MOVING_VARIANCE = 1.0
"""Least variance of |acc| of a foot that moves, (m/s^2)^2."""
REST_BLOCKS = 10
"""Number of blocks over which the specific force of a foot at rest is averaged: 5 s, longer than a car brakes."""
MAX_LENGTH, MAX_RISE = 2.0, 0.6
"""Largest length of a stride and largest height change that features distinguish, m: two stairs at a time."""
MAX_SPEED = 3.0
"""Largest upward or downward velocity that features distinguish, m/s."""
LEAST_SLOPE_LENGTH = 0.2
"""Least length by which the rise of a stride is divided, m."""

FEATURES = (
    "steady", "hard", "turning", "turning_around", "fast", "climb", "sink", "climb_now", "sink_now", "stride",
    "stride_time", "stride_length", "slope", "strike_height",
)  # fmt: skip
"""Names of the features of a foot with a gyroscope.

- `steady`, `hard`: shares of the samples in the window with such a force
- `turning`, `turning_around`: a quarter of the logarithm of the mean square of the angular rate, in (rad/s)^2, in the
  judged half second and in the window
- `fast`: share of the samples in the window with such a rate
- `climb`, `sink`, and the same `now`: largest upward and downward velocity in the window, and in the judged half
  second, m/s; 0 without a track
- `stride`: 1 if a stride is known at the middle of the judged half second, else 0, and so are the others:
  `stride_time`, s, `stride_length`, m, `slope`, the rise over the length, and `strike_height`, that of the heel-strike
  above the foot-flat before it, m"""
FORCE_FEATURES = ("steady", "hard", "shaking", "shaking_around", "stillest")
"""Names of the features of a foot without a gyroscope.

`shaking`, `shaking_around` and `stillest` are a quarter of the logarithm of the variance of |acc|, in (m/s^2)^2, in the
judged half second, in the window, and in the stillest half second of the window."""

Row = tuple[float, ...]


@define
class ActivityBlock:
    """Statistics of the samples of one foot in one block."""

    index: int
    """Number of the block."""
    count: int
    """Number of samples."""
    force: float
    """Mean |acc|, the length of the specific force, m/s^2."""
    variance: float
    """Variance of |acc|, (m/s^2)^2."""
    lean: float
    """Part of the mean specific force across its mean direction since the foot came to rest, m/s^2; 0 if it moves."""
    steady: int
    """Number of samples between `STEADY_FORCES`."""
    hard: int
    """Number of samples from `HARD_FORCE` on."""
    gyro_count: int
    """Number of samples with a gyroscope."""
    gyro_mean_square: float
    """Mean square of |gyro|, (rad/s)^2."""
    fast: int
    """Number of samples from `FAST_RATE` on."""
    climb: float
    """Largest upward velocity, m/s; 0 when it is not known."""
    sink: float
    """Largest downward velocity, m/s, negative; 0 when it is not known."""


@define
class BlockStride:
    """A stride of one foot, as the activity features need it: times in s, lengths in m."""

    start: float
    end: float
    length: float
    """Length, at most `MAX_LENGTH`."""
    rise: float
    """Height change, at most `MAX_RISE` up or down."""
    strike_height: float
    """Height at heel-strike above the start of the stride."""


@define
class BlockFeatures:
    """What a foot shows in a block."""

    gyroscope: bool
    """Flag: the values are those of `FEATURES`, else of `FORCE_FEATURES`."""
    values: Row
    stride: BlockStride | None
    """Stride at the middle of the block; None when none is known."""


def features_of(judged: ActivityBlock, window: Sequence[ActivityBlock], stride: BlockStride | None) -> Row:
    """Return `FEATURES` of the block `judged`; `stride` is that in its middle.

    `window` has the blocks of the window, including `judged`; one of them has a gyroscope."""
    samples = steady = hard = gyro_samples = fast = 0
    squares = climb = sink = 0.0
    turning = judged
    for block in window:
        samples += block.count
        steady += block.steady
        hard += block.hard
        gyro_samples += block.gyro_count
        fast += block.fast
        squares += block.gyro_mean_square * block.gyro_count
        climb = max(climb, block.climb)
        sink = min(sink, block.sink)
        if not turning.gyro_count:
            turning = block
    known = (0.0,) * 5
    if stride is not None:
        slope = max(-1.0, min(1.0, stride.rise / max(stride.length, LEAST_SLOPE_LENGTH)))
        known = (1.0, min(stride.end - stride.start, MAX_STRIDE_TIME), stride.length, slope, stride.strike_height)
    return (
        steady / samples,
        hard / samples,
        _logarithm(turning.gyro_mean_square),
        _logarithm(squares / gyro_samples),
        fast / gyro_samples,
        min(climb, MAX_SPEED),
        max(sink, -MAX_SPEED),
        min(judged.climb, MAX_SPEED),
        max(judged.sink, -MAX_SPEED),
        *known,
    )


def force_features_of(judged: ActivityBlock, window: Sequence[ActivityBlock]) -> Row:
    """Return `FORCE_FEATURES` of the block `judged`; `window` has the blocks of the window, including `judged`."""
    samples = steady = hard = 0
    forces = squares = 0.0
    stillest = judged.variance
    for block in window:
        n, force = block.count, block.force
        samples += n
        steady += block.steady
        hard += block.hard
        forces += force * n
        squares += (block.variance + force * force) * n
        stillest = min(stillest, block.variance)
    mean = forces / samples
    return (
        steady / samples,
        hard / samples,
        _logarithm(judged.variance),
        _logarithm(squares / samples - mean * mean),
        _logarithm(stillest),
    )


def _logarithm(square: float) -> float:
    """Return a scaled logarithm of a mean square: about -1 at rest and 1 when running."""
    return 0.25 * log(max(1e-4, min(1e4, square)))


_HARD, _FAST = HARD_FORCE * HARD_FORCE, FAST_RATE * FAST_RATE
_STEADY_FROM, _STEADY_TO = [force * force for force in STEADY_FORCES]
"""Squares of the limits that samples are compared with."""
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
    total: Vec3 = ZERO
    """Sum of the specific forces of the block under way, m/s^2."""
    rested: int = 0
    """Number of blocks in `rest_force`, at most `REST_BLOCKS`."""
    rest_force: Vec3 = ZERO
    """Mean specific force since the foot came to rest, sensor frame, m/s^2."""
    force: float = 0.0
    """Sum of |acc| over the block under way, m/s^2."""
    squares: float = 0.0
    """Sum of |acc|^2 over the block under way, (m/s^2)^2."""
    count: int = 0
    """Number of samples of the block under way."""
    steady: int = 0
    """Number of them between `STEADY_FORCES`."""
    hard: int = 0
    """Number of them from `HARD_FORCE` on."""
    gyro_count: int = 0
    """Number of them with a gyroscope."""
    fast: int = 0
    """Number of them from `FAST_RATE` on."""
    rate_squares: float = 0.0
    """Sum of |gyro|^2 over the block under way, (rad/s)^2."""
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
    flat_height: float = 0.0
    """Height at the last foot-flat, navigation frame, m."""
    strike_height: float | None = None
    """Height at the last heel-strike, navigation frame, m; None when there was none since foot-flat."""
    blocks: list[ActivityBlock] = field(factory=list)
    """The newest blocks, at most `MAX_BLOCKS`, oldest first."""
    strides: list[BlockStride] = field(factory=list)
    """The newest strides, at most `MAX_STRIDES`, oldest first."""

    def start_block(self, index: int, bias: Vec3, resolution: float) -> None:
        """Start a block with the gyroscope bias, rad/s, and the accelerometer's resolution, m/s^2 per count.

        A resolution of 0 means that it is not known."""
        self.index = index
        self.force = self.squares = self.rate_squares = 0.0
        self.total = ZERO
        self.count = self.steady = self.hard = self.gyro_count = self.fast = 0
        self.bias = bias
        self.resolution = resolution
        self.tracked = False
        self.climb = self.sink = 0.0

    def add(self, acc: Vec3, gyro: Vec3 | None, velocity: Vec3 | None) -> None:
        """Add a sample to the block under way.

        `velocity`, m/s, z up, is that of the foot after it; None when it is not known."""
        x, y, z = acc
        u, v, w = self.total
        square = x * x + y * y + z * z
        self.total = (u + x, v + y, w + z)
        self.count += 1
        self.force += sqrt(square)
        self.squares += square
        if square >= _HARD:
            self.hard += 1
        elif _STEADY_FROM <= square < _STEADY_TO:
            self.steady += 1
        if gyro is None:
            return
        x, y, z = gyro
        u, v, w = self.bias
        square = (x - u) * (x - u) + (y - v) * (y - v) + (z - w) * (z - w)
        self.gyro_count += 1
        self.rate_squares += square
        if square >= _FAST:
            self.fast += 1
        if velocity is None:
            return
        self.tracked = True
        z = velocity[2]
        if z > self.climb:
            self.climb = z
        elif z < self.sink:
            self.sink = z

    def add_events(self, events: Sequence[object], height: float) -> None:
        """Add the events of a sample; `height` is the foot's, navigation frame, m."""
        for event in events:
            if isinstance(event, StrideTaken):
                self._add_stride(event)
            elif isinstance(event, HeelStrike):
                self.strike_height = height
        for event in events:
            if isinstance(event, FootFlat):
                self.flat_height = height
                self.strike_height = None

    def close(self) -> None:
        """Close the block under way and keep it."""
        n, rates = self.count, self.gyro_count
        if self.index is None or not n:
            return
        mean = self.force / n
        variance = round(max(0.0, self.squares / n - mean * mean), 6)
        self.blocks.append(
            ActivityBlock(
                self.index,
                n,
                round(mean, 6),
                variance,
                self._lean(n, variance),
                self.steady,
                self.hard,
                rates,
                round(self.rate_squares / rates, 6) if rates else 0.0,
                self.fast,
                round(self.climb, 4),
                round(self.sink, 4),
            )
        )
        del self.blocks[:-MAX_BLOCKS]

    def _lean(self, n: int, variance: float) -> float:
        """Return how far the mean force of the block under way leans, m/s^2, and add it to that of the foot at rest."""
        if variance > MOVING_VARIANCE:
            self.rested, self.rest_force = 0, ZERO
            return 0.0
        x, y, z = self.total
        force = (x / n, y / n, z / n)
        lean = 0.0
        if self.rested:
            lean = round(hypot(*cross(force, self.rest_force)) / (hypot(*self.rest_force) or 1.0), 6)
        self.rested = min(self.rested + 1, REST_BLOCKS)
        self.rest_force = add(self.rest_force, sub(force, self.rest_force), 1.0 / self.rested)
        return lean

    def _add_stride(self, stride: StrideTaken) -> None:
        rise = integrated_rise(stride)  # the weights were learnt with heights as integrated
        strike_height = 0.0 if self.strike_height is None else self.strike_height - self.flat_height
        self.strides.append(
            BlockStride(
                stride.t_start,
                stride.t_end,
                round(min(stride.length, MAX_LENGTH), 4),
                round(max(-MAX_RISE, min(MAX_RISE, rise)), 4),
                round(max(-MAX_RISE, min(MAX_RISE, strike_height)), 4),
            )
        )
        del self.strides[:-MAX_STRIDES]

    def restart(self) -> None:
        """Discard all blocks and strides, because the clock restarts or another device is worn."""
        self.index = None
        self.rested, self.rest_force = 0, ZERO
        self.count = 0
        self.blocks.clear()
        self.strides.clear()

    def block(self, index: int) -> ActivityBlock | None:
        """Return the block number `index`; None when it has no samples."""
        for block in self.blocks:
            if block.index == index:
                return block
        return None

    def window(self, index: int) -> list[ActivityBlock]:
        """Return the blocks in the window around the block number `index`."""
        return [block for block in self.blocks if -WINDOW_REACH <= block.index - index <= WINDOW_REACH]

    def features(self, index: int, t: float) -> BlockFeatures | None:
        """Return the features of the block number `index`, whose middle is at `t`, s; None when it has no samples."""
        here = self.block(index)
        if here is None:
            return None
        window, stride = self.window(index), self._stride_at(t)
        if any([block.gyro_count for block in window]):
            return BlockFeatures(True, features_of(here, window, stride), stride)
        return BlockFeatures(False, force_features_of(here, window), stride)

    def _stride_at(self, t: float) -> BlockStride | None:
        """Return the stride nearest to `t`, s; None when none is within a quarter of a second."""
        best, nearest = None, 0.5 * BLOCK_DURATION
        for stride in self.strides:
            start = max(stride.start, stride.end - MAX_STRIDE_TIME)
            distance = max(start - t, t - stride.end, 0.0)
            if distance <= nearest:
                best, nearest = stride, distance
        return best
