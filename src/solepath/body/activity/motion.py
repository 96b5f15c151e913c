"""The motion in half a second: an additive model of features that can be named, and slopes of strides.

`motion_votes` turns the features of both feet (foot_blocks.py) into the likelihood of each motion. Each feature has a
curve for each motion: how much every value of the feature speaks for it. The sum of the curves is the logarithm of the
motion's odds (a generalized additive model: Hastie, Tibshirani 1986, Statistical Science 1). Other curves serve feet
without a gyroscope. `solepath-lab train activities` learns the curves and lists the training data. The result is
activities.json in this directory, a few points for each feature. The file also has the transition chances and label
delays that chain.py uses."""

from __future__ import annotations

from bisect import bisect
from collections.abc import Sequence
from functools import cache, cached_property, lru_cache
from math import exp, fsum, log
from typing import Any

from ...foot.bearing import RISE_ERROR, RISE_ERROR_SHARE, TREADS_RISE
from ...types import Activity, Floats
from ...types.attrs import frozen
from .chain import Chain, Chances, Shifts, chain_of
from .elevator_evidence import SWAY_DEVIATION, BlockForce
from .foot_blocks import MAX_RISE, MAX_STRIDE_TIME, MOVING_VARIANCE, ActivityBlock, BlockFeatures, Row

# Evidence of the slope of a stride for stairs: its rise over its length, with the errors that both have.
#
# The rise of a stride on the level is 0, on stairs that of two treads, or of four if the wearer takes two at a time,
# and each is measured with an error that grows with the length. The logarithm of the likelihood ratio of stairs to
# level is evidence that anyone can check, beside that of weights which may never have seen how this wearer climbs. A
# ramp of one in twelve is level by it. A track without heights has strides without rise, which are level.

TREADS_DEVIATION = 0.06
"""Standard deviation of `TREADS_RISE`, m."""
DOUBLE_RISE, DOUBLE_DEVIATION, DOUBLE_SHARE = 0.58, 0.1, 0.2
"""The same two treads at a time, with the largest rise that is distinguished, and the share of such strides.

All three are assumed."""
MOST_EVIDENCE = 6.0
"""Largest logarithm of the likelihood ratio of one stride: 400 to 1, because a step over something is no stairs."""
BLOCK_SHARE = 0.5
"""Share of a stride's evidence that one block has: a stride of 1 s is in two or three blocks."""


@frozen
class SlopeEvidence:
    """Logarithms of the likelihood ratios of stairs to level ground."""

    up: float
    down: float


@lru_cache(maxsize=16)  # the evidence of a stride is used for several blocks, with more and more blocks after them
def slope_evidence(length: float, rise: float) -> SlopeEvidence:
    """Return the evidence of a stride, or a step to the side, with this length and rise, m, for one block."""
    error = RISE_ERROR + RISE_ERROR_SHARE * length
    # densities of normal distributions, times the root of 2 pi, 1/m
    level = exp(-0.5 * (rise / error) ** 2) / error
    one, two = (TREADS_DEVIATION**2 + error**2) ** 0.5, (DOUBLE_DEVIATION**2 + error**2) ** 0.5
    found: list[float] = []
    for climb in (rise, -rise):
        single = exp(-0.5 * ((climb - TREADS_RISE) / one) ** 2) / one
        double = exp(-0.5 * ((min(climb, MAX_RISE) - DOUBLE_RISE) / two) ** 2) / two
        ratio = log((1.0 - DOUBLE_SHARE) * single + DOUBLE_SHARE * double + 1e-9) - log(level + 1e-9)
        found.append(BLOCK_SHARE * max(-MOST_EVIDENCE, min(MOST_EVIDENCE, ratio)))
    return SlopeEvidence(*found)


MOTIONS = ("still", "walking", "running", "stairs_up", "stairs_down", "other")
"""Motions that one foot's samples can distinguish, in the order of the first states of chain.py.

"still" is standing and riding in an elevator, "other" is a bicycle, jumps, and whatever is none of the activities."""


@frozen
class Curve:
    """What the values of a feature say about each of `MOTIONS`.

    The curve is straight between its points and level beyond them, so that values that nobody has learnt say no more
    than the last ones that somebody has."""

    values: Row
    """Values of the feature at the points, in ascending order."""
    odds: tuple[Row, ...]
    """Parts of the logarithms of the odds of `MOTIONS` at each point."""

    def between(self, value: float) -> tuple[Row, Row, float]:
        """Return the odds at the points before and after this value of the feature, and the share of the latter."""
        values, odds = self.values, self.odds
        after = bisect(values, value)
        if 0 < after < len(values):
            low = values[after - 1]
            return odds[after - 1], odds[after], (value - low) / (values[after] - low)
        end = odds[-1 if after else 0]
        return end, end, 0.0


Curves = dict[str, Curve]
"""Curves by the name of the feature."""


@frozen
class MotionModel:
    """The learnt parameters: curves of the features, chances and delays of the chain."""

    trained_on: str
    """Description of the training data, one sentence."""
    gyroscope: Curves
    """Curves of `FEATURES`."""
    alone: Curves
    """Curves of `FORCE_FEATURES`, for feet without a gyroscope."""
    chances: Chances
    shifts: Shifts

    @cached_property
    def chain(self) -> Chain:
        """Chain of activities with the learnt chances and delays."""
        return chain_of(self.chances, self.shifts)


@cache
def load_released_model() -> MotionModel:
    """Return the model of this release, which is read from activities.json once."""
    import json
    from pkgutil import get_data

    data: dict[str, Any] = json.loads(get_data(__package__, "activities.json") or b"")
    gyroscope, alone = [
        {name: Curve(_row(curve["values"]), tuple(map(_row, curve["odds"]))) for name, curve in data[table].items()}
        for table in ("gyroscope", "alone")
    ]
    return MotionModel(
        trained_on=data["trained_on"],
        gyroscope=gyroscope,
        alone=alone,
        chances=tuple([_row(row) for row in data["chances"]]),
        shifts=tuple([(Activity(a), Activity(b), shift) for a, b, shift in data["shifts"]]),
    )


def _row(data: Sequence[Any]) -> Row:
    return tuple([float(value) for value in data])


# Votes (log-likelihoods) of both feet on the motion in a block of half a second, and their sum.

STILL, STAIRS_UP, STAIRS_DOWN = [MOTIONS.index(motion) for motion in ("still", "stairs_up", "stairs_down")]
LEAST_LENGTH, STRIDE_EVIDENCE = 0.2, 4.0
"""Least length, m, of a stride that speaks against a foot that stands, and by how much.

Feet that step sideways or backwards turn little, which is usual for standing; but nobody stands and strides. The first
stride after standing lasts longer than `MAX_STRIDE_TIME`. Chosen on emulated walks sideways."""
LESSER_WEIGHT = 0.5
"""Weight of the vote of a foot without a gyroscope beside one that has one: it takes stairs for level ways. A half; a
quarter is the same to 0.1 points (hugadb)."""
MIN_VOTE = -12.0
"""Lowest vote (natural logarithm)."""
NO_SAMPLES = (*[-1.0] * (len(MOTIONS) - 1), 0.0)
"""Votes without samples: nobody knows what is done."""
VARIANCE_SHARE = 0.05
"""Share of the variance of |acc| in a block that counts as variance of its mean."""
MAX_STANDING_FORCE = 40.0
"""Largest mean force of a standing foot, m/s^2."""


def motion_votes(model: MotionModel, feet: Sequence[BlockFeatures | None]) -> Floats:
    """Return the log-likelihoods of `MOTIONS`, from the features of each foot or None."""
    votes = [0.0] * len(MOTIONS)
    shown = [one for one in feet if one is not None]
    if not shown:
        return NO_SAMPLES
    with_gyro = any([one.gyroscope for one in shown])
    for one in shown:
        weight = 1.0 if one.gyroscope or not with_gyro else LESSER_WEIGHT
        curves = model.gyroscope if one.gyroscope else model.alone
        for i, likely in enumerate(log_probabilities(curves, one.values)):
            votes[i] += weight * max(likely, MIN_VOTE)
        stride = one.stride
        if stride is not None:
            slope = slope_evidence(stride.length, stride.rise)
            if stride.length > LEAST_LENGTH and stride.end - stride.start < MAX_STRIDE_TIME:
                votes[STILL] -= STRIDE_EVIDENCE
            votes[STAIRS_UP] += slope.up
            votes[STAIRS_DOWN] += slope.down
    return tuple(votes)


def log_probabilities(curves: Curves, values: Row) -> list[float]:
    """Return the natural logarithm of the probability of each of `MOTIONS`; `values` are those of the curves."""
    still = walking = running = up = down = other = 0.0
    for curve, value in zip(curves.values(), values, strict=True):
        (a, b, c, d, e, f), (p, q, r, s, t, u), share = curve.between(value)
        rest = 1.0 - share
        still += rest * a + share * p
        walking += rest * b + share * q
        running += rest * c + share * r
        up += rest * d + share * s
        down += rest * e + share * t
        other += rest * f + share * u
    sums = (still, walking, running, up, down, other)
    highest = max(sums)
    total = highest + log(fsum([exp(value - highest) for value in sums]))
    return [value - total for value in sums]


def block_force(block: ActivityBlock | None, resolution: float) -> BlockForce | None:
    """Return the force on a foot in a block, for elevator detection; None without a block or above the limit.

    `resolution` is the accelerometer's, m/s^2 per count."""
    if block is None or block.force >= MAX_STANDING_FORCE:
        return None
    variance = (
        SWAY_DEVIATION * SWAY_DEVIATION + VARIANCE_SHARE * min(block.variance, 1e4) + resolution * resolution / 12.0
    )
    return BlockForce(block.force, variance, block.variance > MOVING_VARIANCE, resolution, block.lean)
