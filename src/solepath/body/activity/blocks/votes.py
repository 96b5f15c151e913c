"""Votes (log-likelihoods) of both feet on the motion in a block of half a second, and their sum.

Sums of products use math.dist: w x = (w w + x x - |w - x|^2) / 2. It is the only loop over floats that runs in C in
every Python from 3.11 on, three times as fast as sum(map(mul, ...)), and gives the same bits everywhere. The result
is off by 1e-12 at most, and hypotheses.py rounds the scores to 1e-4."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import repeat
from math import dist, exp, fsum, hypot, inf, log, tanh

from ..elevator_evidence import SWAY_DEVIATION, BlockForce
from .features import FIRST_GYRO_FEATURE, ActivityBlock, stride_of
from .motion import MOTIONS, MotionModel, Network, Row
from .stride_slope import slope_evidence

STILL, STAIRS_UP, STAIRS_DOWN = [MOTIONS.index(motion) for motion in ("still", "stairs_up", "stairs_down")]
LEAST_LENGTH, LONGEST_STRIDE, STRIDE_EVIDENCE = 0.2, 1.6, 4.0
"""Least length, m, and longest duration, s, of a stride that speaks against a foot that stands, and by how much.

Feet that step sideways or backwards turn little, which a network takes for standing; but nobody stands and strides. The
first stride after standing lasts longer. Chosen on emulated walks sideways; on hugadb it costs 0.1 points."""
VOTE_WEIGHT = 0.6
"""Weight of one vote; it is below 1 because neighbouring windows share samples."""
LESSER_WEIGHT = 0.3
"""Weight of the vote of a foot without a gyroscope beside one that has one: it takes stairs for level ways. A half; a
quarter is the same to 0.1 points (hugadb)."""
MIN_VOTE = -12.0
"""Lowest vote (natural logarithm)."""
UNKNOWN_COST = 3.0
"""Penalty (minus log-likelihood) of an unknown activity for a foot of usual motion."""
USUAL_STRANGENESS = 6.0
"""Largest strangeness (motion.py) of usual motion; above it, an unknown activity becomes likelier."""
MOVING_VARIANCE = 1.0
"""Least variance of |acc| of a foot that moves, (m/s^2)^2."""
VARIANCE_SHARE = 0.05
"""Share of the variance of |acc| in a block that counts as variance of its mean."""
MAX_STANDING_FORCE = 40.0
"""Largest mean force of a standing foot, m/s^2."""


def motion_votes(model: MotionModel, feet: Sequence[Sequence[float] | None]) -> tuple[float, ...]:
    """Return the log-likelihoods of `MOTIONS` and of an unknown activity, from the features of each foot or None."""
    votes = [0.0] * len(MOTIONS)
    unknown = 0.0
    known = False
    with_gyro = any([features is not None and features[FIRST_GYRO_FEATURE] for features in feet])
    for features in feet:
        if features is None:
            continue
        known = True
        weight = VOTE_WEIGHT if features[FIRST_GYRO_FEATURE] or not with_gyro else LESSER_WEIGHT
        network = model.whole if features[FIRST_GYRO_FEATURE] else model.alone
        for i, likely in enumerate(log_probabilities(network, features)):
            votes[i] += weight * max(likely, MIN_VOTE)
        stride = stride_of(features)
        if stride is not None:
            duration, length, rise = stride
            slope = slope_evidence(length, rise)
            if length > LEAST_LENGTH and duration < LONGEST_STRIDE:
                votes[STILL] -= STRIDE_EVIDENCE
            votes[STAIRS_UP] += slope.up
            votes[STAIRS_DOWN] += slope.down
        unknown += weight * min(0.5 * (strangeness(model, features) - USUAL_STRANGENESS) - UNKNOWN_COST, 0.0)
    return (*votes, unknown) if known else (*[-1.0] * len(MOTIONS), 0.0)


def log_probabilities(network: Network, features: Sequence[float]) -> list[float]:
    """Return the natural logarithm of the probability of each of `MOTIONS` by a network.

    Features beyond the network's inputs are ignored."""
    inputs = tuple(features[: len(network.hidden[0])])
    hidden_values = tuple(map(tanh, _weighted_sums(network.hidden, network.hidden_half, inputs)))
    output_values = _weighted_sums(network.output, network.output_half, hidden_values)
    highest = max(output_values)
    total = highest + log(fsum([exp(value - highest) for value in output_values]))
    return [value - total for value in output_values]


def strangeness(model: MotionModel, features: Sequence[float]) -> float:
    """Return the distance of features from the training data: 1 is usual, 4 is two standard deviations everywhere.

    It is the mean squared deviation from the nearest motion, over all accelerometer features, in standard
    deviations."""
    inputs, nearest = features[:FIRST_GYRO_FEATURE], inf
    for spread, middle in zip(model.spread, model.middles, strict=True):
        distance = dist([value / deviation for value, deviation in zip(inputs, spread, strict=True)], middle)
        if distance < nearest:
            nearest = distance
    return nearest * nearest / FIRST_GYRO_FEATURE


def _weighted_sums(rows: Sequence[Row], half: Row, inputs: Row) -> list[float]:
    """Return bias + w x for each row w; `half` has the bias plus w w / 2."""
    length = hypot(*inputs)
    square = 0.5 * length * length
    distances = map(dist, rows, repeat(inputs))
    return [constant + square - 0.5 * distance * distance for constant, distance in zip(half, distances, strict=True)]


def block_force(block: ActivityBlock | None, resolution: float) -> BlockForce | None:
    """Return the force on a foot in a block, for elevator detection; None without a block or above the limit.

    `resolution` is the accelerometer's, m/s^2 per count."""
    if block is None or block.force >= MAX_STANDING_FORCE:
        return None
    variance = (
        SWAY_DEVIATION * SWAY_DEVIATION + VARIANCE_SHARE * min(block.variance, 1e4) + resolution * resolution / 12.0
    )
    return BlockForce(block.force, variance, block.variance > MOVING_VARIANCE, resolution)
