"""Features of one foot's samples, half a second at a time, from which activities are recognised.

Only lengths of vectors count, so nothing depends on the mounting of the sensor, and shares of samples count instead of
their number, so little depends on the rate. Accelerometers clip at anything from 2 g: |acc| beyond that has one bin."""

from __future__ import annotations

from math import log

from .block import ActivityBlock, BlockStride

BLOCK = 0.5
"""Duration of a block, s."""
REACH = 2
"""Number of blocks before and after the judged one; five of them are a window of 2.5 s."""
BINS = 10
"""Number of bins of |acc|, 2 m/s^2 each, and of |gyro|, 1 rad/s each; the last one is open."""
BEYOND, BEYOND_RATE = 2.0 * BINS, BINS * BINS
"""Lower limits of the open bins: |acc|, m/s^2, and the square of |gyro|, (rad/s)^2."""

THIRDS = 3
"""Number of parts of a window: the blocks before the judged one, that one, and the blocks after it."""

GYRO = 4 + THIRDS * BINS
"""Index of the first feature that needs a gyroscope."""
TRACK = GYRO + 5 + THIRDS * BINS
"""Index of the first feature that needs a track."""
STRIDE = TRACK + 6
"""Index of the first feature of a stride."""
COUNT = STRIDE + 11
"""Number of features."""


def features_of(here: ActivityBlock, near: list[ActivityBlock], stride: BlockStride | None) -> list[float]:
    """Return `COUNT` features of the order of 1 for the block `here`; those not known are 0.

    `near` are the blocks of the window, `here` among them, and `stride` is the stride under way."""
    values = [0.0] * COUNT
    earlier = [block for block in near if block.index < here.index]
    later = [block for block in near if block.index > here.index]
    turned = [block for block in near if block.rates]
    tracked = [block for block in near if block.tracked]
    whole, forces, squares = 0, 0.0, 0.0
    least = most = here.variance
    for block in near:
        n, force, variance = block.count, block.force, block.variance
        whole += n
        forces += force * n
        squares += (variance + force * force) * n
        if variance < least:
            least = variance
        elif variance > most:
            most = variance
    values[0] = _log_variance(here.variance)
    values[1] = _log_variance(least)
    values[2] = _log_variance(most)
    mean = forces / whole
    values[3] = _log_variance(max(0.0, squares / whole - mean * mean))
    thirds = (earlier, [here], later)
    at = 4
    for third in thirds:
        if third:
            values[at : at + BINS] = _shares([b.acc_bins for b in third], [b.count for b in third])
        at += BINS
    if turned:
        rates, squares = 0, 0.0
        least = most = turned[0].rate
        for block in turned:
            n, rate = block.rates, block.rate
            rates += n
            squares += rate * n
            if rate < least:
                least = rate
            elif rate > most:
                most = rate
        values[GYRO] = 1.0
        values[GYRO + 1] = _log_variance(here.rate if here.rates else turned[0].rate)
        values[GYRO + 2] = _log_variance(least)
        values[GYRO + 3] = _log_variance(most)
        values[GYRO + 4] = _log_variance(squares / rates)
        at = GYRO + 5
        for third in thirds:
            if len(turned) < len(near):
                third = [block for block in third if block.rates]
            if third:
                values[at : at + BINS] = _shares([b.gyro_bins for b in third], [b.rates for b in third])
            at += BINS
    if tracked:
        values[TRACK] = 1.0
        values[TRACK + 1] = min(max([block.climb for block in tracked]), 3.0)
        values[TRACK + 2] = max(min([block.sink for block in tracked]), -3.0)
        values[TRACK + 3] = 0.5 * min(max([block.speed for block in tracked]), 6.0)
        values[TRACK + 4] = min(here.climb, 3.0)
        values[TRACK + 5] = max(here.sink, -3.0)
    if stride is not None:
        lasted = stride.end - stride.start
        values[STRIDE] = 1.0
        values[STRIDE + 1] = min(lasted, 2.0)
        values[STRIDE + 2] = min(stride.length, 2.0)
        values[STRIDE + 3] = 2.0 * min(max(stride.rise, -0.6), 0.6)
        values[STRIDE + 4] = 2.0 * min(max(stride.clearance, 0.0), 0.5)
        values[STRIDE + 5] = 0.5 * min(stride.speed, 6.0)
        values[STRIDE + 6] = min(stride.pitch, 3.0)
        values[STRIDE + 7] = min(max(stride.rise / max(stride.length, 0.2), -1.0), 1.0)
        values[STRIDE + 8] = 2.0 * min(max(stride.top, -0.6), 0.6)
        values[STRIDE + 9] = 2.0 * min(max(stride.bottom, -0.6), 0.6)
        values[STRIDE + 10] = 2.0 * min(max(stride.strike, -0.6), 0.6)
    return values


def _log_variance(variance: float) -> float:
    """Return the scaled logarithm of a variance: about -1 at rest and 1 in a run."""
    return 0.25 * log(1e-4 if variance < 1e-4 else 1e4 if variance > 1e4 else variance)


def _shares(bins: list[tuple[int, ...]], counts: list[int]) -> list[float]:
    """Return the share of each bin among the samples of the blocks of one third of a window."""
    whole = sum(counts)
    if len(bins) == 1:
        return [n / whole for n in bins[0]]
    return [a / whole + b / whole for a, b in zip(*bins, strict=True)]
