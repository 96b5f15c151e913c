"""Features of one foot's blocks (half seconds of samples), from which activities are recognised.

Sample features use only the lengths of vectors, so they do not depend on the mounting of the sensor. They use shares of
samples instead of numbers of samples, so they depend little on the sample rate. Some accelerometers clip at 2 g, so all
|acc| above that share one bin."""

from __future__ import annotations

from collections.abc import Sequence
from math import log

from ....types.attrs import define

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
    acc_bins: tuple[int, ...]
    """Number of samples in each bin of |acc|, at most 255 each (features.py has the bins)."""
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
    values = [0.0] * FEATURE_COUNT
    earlier = [block for block in window if block.index < judged.index]
    later = [block for block in window if block.index > judged.index]
    with_gyro = [block for block in window if block.gyro_count]
    tracked = [block for block in window if block.tracked]
    samples, forces, squares = 0, 0.0, 0.0
    least = most = judged.variance
    for block in window:
        n, force, variance = block.count, block.force, block.variance
        samples += n
        forces += force * n
        squares += (variance + force * force) * n
        if variance < least:
            least = variance
        elif variance > most:
            most = variance
    values[0] = _log_variance(judged.variance)
    values[1] = _log_variance(least)
    values[2] = _log_variance(most)
    mean = forces / samples
    values[3] = _log_variance(max(0.0, squares / samples - mean * mean))
    window_parts = (earlier, [judged], later)
    start = 4
    for blocks in window_parts:
        if blocks:
            values[start : start + BIN_COUNT] = _shares([b.acc_bins for b in blocks], [b.count for b in blocks])
        start += BIN_COUNT
    if with_gyro:
        gyro_count, squares = 0, 0.0
        least = most = with_gyro[0].gyro_mean_square
        for block in with_gyro:
            n, gyro_mean_square = block.gyro_count, block.gyro_mean_square
            gyro_count += n
            squares += gyro_mean_square * n
            if gyro_mean_square < least:
                least = gyro_mean_square
            elif gyro_mean_square > most:
                most = gyro_mean_square
        values[FIRST_GYRO_FEATURE] = 1.0
        values[FIRST_GYRO_FEATURE + 1] = _log_variance(
            judged.gyro_mean_square if judged.gyro_count else with_gyro[0].gyro_mean_square
        )
        values[FIRST_GYRO_FEATURE + 2] = _log_variance(least)
        values[FIRST_GYRO_FEATURE + 3] = _log_variance(most)
        values[FIRST_GYRO_FEATURE + 4] = _log_variance(squares / gyro_count)
        start = FIRST_GYRO_FEATURE + 5
        for blocks in window_parts:
            if len(with_gyro) < len(window):
                blocks = [block for block in blocks if block.gyro_count]
            if blocks:
                values[start : start + BIN_COUNT] = _shares(
                    [b.gyro_bins for b in blocks], [b.gyro_count for b in blocks]
                )
            start += BIN_COUNT
    if tracked:
        values[FIRST_TRACK_FEATURE] = 1.0
        values[FIRST_TRACK_FEATURE + 1] = min(max([block.climb for block in tracked]), 3.0)
        values[FIRST_TRACK_FEATURE + 2] = max(min([block.sink for block in tracked]), -3.0)
        values[FIRST_TRACK_FEATURE + 3] = 0.5 * min(max([block.speed for block in tracked]), 6.0)
        values[FIRST_TRACK_FEATURE + 4] = min(judged.climb, 3.0)
        values[FIRST_TRACK_FEATURE + 5] = max(judged.sink, -3.0)
    if stride is not None:
        duration = stride.end - stride.start
        values[FIRST_STRIDE_FEATURE] = 1.0
        values[FIRST_STRIDE_FEATURE + 1] = min(duration, 2.0)
        values[FIRST_STRIDE_FEATURE + 2] = min(stride.length, MAX_LENGTH)
        values[FIRST_STRIDE_FEATURE + 3] = 2.0 * min(max(stride.rise, -MAX_RISE), MAX_RISE)
        values[FIRST_STRIDE_FEATURE + 4] = 2.0 * min(max(stride.clearance, 0.0), 0.5)
        values[FIRST_STRIDE_FEATURE + 5] = 0.5 * min(stride.speed, 6.0)
        values[FIRST_STRIDE_FEATURE + 6] = min(stride.pitch, 3.0)
        values[FIRST_STRIDE_FEATURE + 7] = min(max(stride.rise / max(stride.length, 0.2), -1.0), 1.0)
        values[FIRST_STRIDE_FEATURE + 8] = 2.0 * min(max(stride.top, -0.6), 0.6)
        values[FIRST_STRIDE_FEATURE + 9] = 2.0 * min(max(stride.bottom, -0.6), 0.6)
        values[FIRST_STRIDE_FEATURE + 10] = 2.0 * min(max(stride.strike_height, -0.6), 0.6)
    return values


def stride_of(features: Sequence[float]) -> tuple[float, float, float] | None:
    """Return the duration, up to 2 s, the length, up to 2 m, and the rise of the stride in a block, m.

    Returns None without a stride."""
    if not features[FIRST_STRIDE_FEATURE]:
        return None
    duration, length, doubled_rise = features[FIRST_STRIDE_FEATURE + 1 : FIRST_STRIDE_FEATURE + 4]
    return duration, length, 0.5 * doubled_rise


def _log_variance(variance: float) -> float:
    """Return the scaled logarithm of a variance: about -1 at rest and 1 when running."""
    return 0.25 * log(1e-4 if variance < 1e-4 else 1e4 if variance > 1e4 else variance)


def _shares(bins: list[tuple[int, ...]], counts: list[int]) -> list[float]:
    """Return the share of each bin among the samples of one part of a window, of one or two blocks."""
    samples = sum(counts)  # whole numbers
    if len(bins) == 1:
        return [n / samples for n in bins[0]]
    return [a / samples + b / samples for a, b in zip(*bins, strict=True)]
