"""What one foot's samples look like, half a second at a time: what activities are told from.

Only lengths of vectors count, so nothing depends on how the sensor is mounted, and shares of samples rather than their
number, so little depends on the rate. Accelerometers clip at anything from 2 g: |acc| beyond that says the same.
"""

from __future__ import annotations

from math import log

from .block import ActivityBlock, BlockStride

BLOCK = 0.5
"""s."""
REACH = 2
"""Blocks before and after the one that is told; five of them are a window of 2.5 s."""
BINS = 10
"""Of |acc|, 2 m/s^2 each, and of |gyro|, 1 rad/s each; the last one is open."""
BEYOND, BEYOND_RATE = 2.0 * BINS, BINS * BINS
"""|acc| and the square of |gyro| of the last bins and more."""

THIRDS = 3
"""Parts of a window: the blocks before the one that is told, that one, and the blocks after it."""

GYRO = 4 + THIRDS * BINS
"""Index of the first feature that needs a gyroscope."""
TRACK = GYRO + 5 + THIRDS * BINS
"""Index of the first feature that needs a track."""
STEP = TRACK + 6
"""Index of the first feature of a step."""
COUNT = STEP + 11


def features_of(here: ActivityBlock, near: list[ActivityBlock], step: BlockStride | None) -> list[float]:
    """`COUNT` numbers of the order of 1 for the block `here`, with those `near` it, itself among them, and the stride
    under way in it; what is not known is 0."""
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
    values[0] = _logarithm(here.variance)
    values[1] = _logarithm(least)
    values[2] = _logarithm(most)
    mean = forces / whole
    values[3] = _logarithm(max(0.0, squares / whole - mean * mean))
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
        values[GYRO + 1] = _logarithm(here.rate if here.rates else turned[0].rate)
        values[GYRO + 2] = _logarithm(least)
        values[GYRO + 3] = _logarithm(most)
        values[GYRO + 4] = _logarithm(squares / rates)
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
    if step is not None:
        lasted = step.end - step.start
        values[STEP] = 1.0
        values[STEP + 1] = min(lasted, 2.0)
        values[STEP + 2] = min(step.length, 2.0)
        values[STEP + 3] = 2.0 * min(max(step.rise, -0.6), 0.6)
        values[STEP + 4] = 2.0 * min(max(step.clearance, 0.0), 0.5)
        values[STEP + 5] = 0.5 * min(step.speed, 6.0)
        values[STEP + 6] = min(step.pitch, 3.0)
        values[STEP + 7] = min(max(step.rise / max(step.length, 0.2), -1.0), 1.0)
        values[STEP + 8] = 2.0 * min(max(step.top, -0.6), 0.6)
        values[STEP + 9] = 2.0 * min(max(step.bottom, -0.6), 0.6)
        values[STEP + 10] = 2.0 * min(max(step.strike, -0.6), 0.6)
    return values


def _logarithm(variance: float) -> float:
    """Of a variance: about -1 at rest and 1 in a run."""
    return 0.25 * log(1e-4 if variance < 1e-4 else 1e4 if variance > 1e4 else variance)


def _shares(bins: list[tuple[int, ...]], counts: list[int]) -> list[float]:
    """Shares of each bin among the samples of the blocks of one third of a window."""
    whole = sum(counts)
    if len(bins) == 1:
        return [n / whole for n in bins[0]]
    return [a / whole + b / whole for a, b in zip(*bins, strict=True)]
