"""The newest blocks (half seconds) of one foot: sums over samples, and its newest strides."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import hypot, log, sqrt

from ...events import FootFlat, HeelStrike, StrideTaken
from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, add, cross, sub
from .flights import integrated_rise

# Features of one foot's blocks (half seconds of samples), from which activities are recognised.
#
# Sample features use only the lengths of vectors, so they do not depend on the mounting of the sensor. They use shares
# of samples instead of numbers of samples, so they depend little on the sample rate. Some accelerometers clip at 2 g,
# so all |acc| above that share one bin.

BLOCK_DURATION = 0.5
"""Duration of a block, s."""
WINDOW_REACH = 2
"""Number of blocks before and after the judged one in its window: five blocks, 2.5 s."""
BIN_COUNT = 10
"""Number of bins of |acc|, 2 m/s^2 wide, and of |gyro|, 1 rad/s wide; the last bin has no upper limit."""
ACC_LIMIT, RATE_LIMIT = 2.0 * BIN_COUNT, 1.0 * BIN_COUNT
"""Lower limits of the last bins: |acc|, m/s^2, and |gyro|, rad/s."""
WINDOW_PARTS = 3
"""Number of parts of a window: the blocks before the judged one, the judged one, and the blocks after it."""
FIRST_GYRO_FEATURE = 4 + WINDOW_PARTS * BIN_COUNT
"""Index of the first feature that needs a gyroscope."""
FIRST_TRACK_FEATURE = FIRST_GYRO_FEATURE + 5 + WINDOW_PARTS * BIN_COUNT
"""Index of the first feature that needs a track."""
FIRST_STRIDE_FEATURE = FIRST_TRACK_FEATURE + 6
"""Index of the first feature of a stride."""
FEATURE_COUNT = FIRST_STRIDE_FEATURE + 11
"""Number of features."""
MOVING_VARIANCE = 1.0
"""Least variance of |acc| of a foot that moves, (m/s^2)^2."""
REST_BLOCKS = 10
"""Number of blocks over which the specific force of a foot at rest is averaged: 5 s, longer than a car brakes."""
MAX_LENGTH, MAX_RISE = 2.0, 0.6
"""Largest length of a stride and largest height change that features distinguish, m: two stairs at a time."""


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
    acc_bins: tuple[int, ...]
    """Number of samples in each bin of |acc|, at most 255 each."""
    gyro_count: int
    """Number of samples with a gyroscope."""
    gyro_mean_square: float
    """Mean square of |gyro|, (rad/s)^2."""
    gyro_bins: tuple[int, ...]
    """Number of samples in each bin of |gyro|, at most 255 each."""
    tracked: bool
    """Flag: velocity and position of the foot are known."""
    climb: float
    """Largest upward velocity, m/s."""
    sink: float
    """Largest downward velocity, m/s, negative."""
    speed: float
    """Largest horizontal speed, m/s."""


@define
class BlockStride:
    """A stride of one foot, as the activity features need it: times in s, lengths in m."""

    start: float
    end: float
    length: float
    rise: float
    """Height change, m."""
    clearance: float
    speed: float
    """Peak speed, m/s."""
    pitch: float
    """Pitch of the swing, rad."""
    top: float
    """Greatest height in the stride above its start, m."""
    bottom: float
    """Lowest height in the stride above its start, m; 0 or negative."""
    strike_height: float
    """Height at heel-strike above the start of the stride, m."""


def features_of(judged: ActivityBlock, window: list[ActivityBlock], stride: BlockStride | None) -> list[float]:
    """Return `FEATURE_COUNT` features, scaled to the order of 1, of the block `judged`; unknown features are 0.

    `window` has the blocks of the window, including `judged`; `stride` is the stride in the middle of `judged`."""
    parts = [
        [block for block in window if block.index < judged.index],
        [judged],
        [block for block in window if block.index > judged.index],
    ]
    samples, forces, squares = 0, 0.0, 0.0
    for block in window:
        n, force = block.count, block.force
        samples += n
        forces += force * n
        squares += (block.variance + force * force) * n
    mean, variances = forces / samples, [block.variance for block in window]
    values = _log_variances(judged.variance, variances, max(0.0, squares / samples - mean * mean))
    for blocks in parts:
        values += _shares([(block.acc_bins, block.count) for block in blocks])
    with_gyro = [block for block in window if block.gyro_count]
    if with_gyro:
        gyro_count, squares = 0, 0.0
        for block in with_gyro:
            gyro_count += block.gyro_count
            squares += block.gyro_mean_square * block.gyro_count
        nearest = judged if judged.gyro_count else with_gyro[0]
        mean_squares = [block.gyro_mean_square for block in with_gyro]
        values += [1.0, *_log_variances(nearest.gyro_mean_square, mean_squares, squares / gyro_count)]
        for blocks in parts:
            values += _shares([(block.gyro_bins, block.gyro_count) for block in blocks if block.gyro_count])
    else:
        values += [0.0] * (FIRST_TRACK_FEATURE - FIRST_GYRO_FEATURE)
    tracked = [block for block in window if block.tracked]
    if tracked:
        values += [
            1.0,
            min(max([block.climb for block in tracked]), 3.0),
            max(min([block.sink for block in tracked]), -3.0),
            0.5 * min(max([block.speed for block in tracked]), 6.0),
            min(judged.climb, 3.0),
            max(judged.sink, -3.0),
        ]
    else:
        values += [0.0] * (FIRST_STRIDE_FEATURE - FIRST_TRACK_FEATURE)
    if stride is None:
        return values + [0.0] * (FEATURE_COUNT - FIRST_STRIDE_FEATURE)
    return [
        *values,
        1.0,
        min(stride.end - stride.start, 2.0),
        min(stride.length, MAX_LENGTH),
        2.0 * min(max(stride.rise, -MAX_RISE), MAX_RISE),
        2.0 * min(max(stride.clearance, 0.0), 0.5),
        0.5 * min(stride.speed, 6.0),
        min(stride.pitch, 3.0),
        min(max(stride.rise / max(stride.length, 0.2), -1.0), 1.0),
        *[2.0 * min(max(height, -0.6), 0.6) for height in (stride.top, stride.bottom, stride.strike_height)],
    ]


def stride_of(features: Sequence[float]) -> tuple[float, float, float] | None:
    """Return the duration, up to 2 s, the length, up to 2 m, and the rise of the stride in a block, m.

    Returns None without a stride."""
    if not features[FIRST_STRIDE_FEATURE]:
        return None
    duration, length, doubled_rise = features[FIRST_STRIDE_FEATURE + 1 : FIRST_STRIDE_FEATURE + 4]
    return duration, length, 0.5 * doubled_rise


def _log_variances(judged: float, window: list[float], whole: float) -> list[float]:
    """Return the scaled logarithms of variances: about -1 at rest and 1 when running.

    They are of the judged block, the least and the largest in its window, and of the whole window."""
    return [0.25 * log(max(1e-4, min(1e4, value))) for value in (judged, min(window), max(window), whole)]


def _shares(blocks: list[tuple[tuple[int, ...], int]]) -> list[float]:
    """Return the share of each bin among the samples of up to two blocks, each with its bins and number of samples."""
    shares, samples = [0.0] * BIN_COUNT, sum([count for _, count in blocks])  # whole numbers
    for bins, _ in blocks:
        shares = [share + n / samples for share, n in zip(shares, bins, strict=True)]
    return shares


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
        self.total = ZERO
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
        a, b, c = self.total
        self.total = (a + x, b + y, c + z)
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
        variance = round(max(0.0, self.squares / n - mean * mean), 6)
        self.blocks.append(
            ActivityBlock(
                self.index,
                n,
                round(mean, 6),
                variance,
                self._lean(n, variance),
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
        features = stride.features
        # use heights as integrated: the network was trained with them; clearance is above the higher end of the stride
        rise = integrated_rise(stride)
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
                0.0 if self.strike_height is None else round(self.strike_height - self.flat_height, 4),
            )
        )
        if len(self.strides) > MAX_STRIDES:
            self.strides.popleft()

    def restart(self) -> None:
        """Discard all blocks and strides, because the clock restarts or another device is worn."""
        self.index = None
        self.rested, self.rest_force = 0, ZERO
        self.acc_bins = [0] * BIN_COUNT
        self.blocks.clear()
        self.strides.clear()

    def block(self, index: int) -> ActivityBlock | None:
        """Return the block number `index`; None when it has no samples."""
        return next((block for block in self.blocks if block.index == index), None)

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
