"""Parameters of the motion model: two small neural networks, and the statistics of their training data.

`motion_votes` turns the features of both feet into the likelihood of each motion with them.

Each network has one hidden layer of tanh units and softmax outputs. One network uses all features; the other one serves
feet without a gyroscope. `solepath-lab train activities` trains them and lists the training data. The result is
activities.json in this directory. The file also has the transition chances and label delays that chain.py uses.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, cached_property, lru_cache
from itertools import repeat
from math import dist, exp, fsum, hypot, inf, log, tanh
from operator import truediv
from typing import Any

from ...foot.bearing import RISE_ERROR, RISE_ERROR_SHARE, TREADS_RISE
from ...types import Activity, Floats
from ...types.attrs import frozen
from .chain import Chain, Chances, Shifts, chain_of
from .elevator_evidence import SWAY_DEVIATION, BlockForce
from .foot_blocks import FIRST_GYRO_FEATURE, MAX_RISE, MOVING_VARIANCE, ActivityBlock, stride_of

# Evidence of the slope of a stride for stairs: its rise over its length, with the errors that both have.
#
# The rise of a stride on the level is 0, on stairs that of two treads, or of four if the wearer takes two at a time,
# and each is measured with an error that grows with the length. The logarithm of the likelihood ratio of stairs to
# level is evidence that anyone can check, beside that of a network which may never have seen how this wearer climbs. A
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


MOTIONS = ("still", "walking", "running", "stairs_up", "stairs_down")
"""Motions that one foot's samples can distinguish, in the order of the network outputs.

"still" is standing and riding in an elevator."""

Row = tuple[float, ...]


@frozen
class Network:
    """A neural network with one hidden layer."""

    hidden: tuple[Row, ...]
    """Weights of the hidden layer, one row for each unit."""
    hidden_bias: Row
    output: tuple[Row, ...]
    """Weights of the output layer, one row for each of `MOTIONS`."""
    output_bias: Row

    @cached_property
    def hidden_half(self) -> Row:
        """Bias of each hidden unit plus half the squared length of its weights (`_weighted_sums`)."""
        return _with_half_squares(self.hidden, self.hidden_bias)

    @cached_property
    def output_half(self) -> Row:
        """Bias of each output unit plus half the squared length of its weights."""
        return _with_half_squares(self.output, self.output_bias)


@frozen
class MotionModel:
    """The learnt parameters: two networks, statistics of the features, chances and delays of the chain."""

    trained_on: str
    """Description of the training data, one sentence."""
    whole: Network
    """Network for all `FEATURE_COUNT` features, used with a gyroscope."""
    alone: Network
    """Network for the first `FIRST_GYRO_FEATURE` features, used without a gyroscope."""
    usual: tuple[Row, ...]
    """Means of the first `FIRST_GYRO_FEATURE` features, one row for each of `MOTIONS`."""
    spread: tuple[Row, ...]
    """Standard deviations of the first `FIRST_GYRO_FEATURE` features, one row for each of `MOTIONS`."""
    chances: Chances
    shifts: Shifts

    @cached_property
    def middles(self) -> tuple[Row, ...]:
        """Rows of `usual` divided by the rows of `spread`."""
        return tuple([tuple(map(truediv, *rows)) for rows in zip(self.usual, self.spread, strict=True)])

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
    return MotionModel(
        trained_on=data["trained_on"],
        whole=_network(data["whole"]),
        alone=_network(data["alone"]),
        usual=_rows(data["usual"]),
        spread=_rows(data["spread"]),
        chances=_rows(data["chances"]),
        shifts=tuple([(Activity(a), Activity(b), shift) for a, b, shift in data["shifts"]]),
    )


def _network(data: dict[str, Any]) -> Network:
    return Network(
        hidden=_rows(data["hidden"]),
        hidden_bias=_row(data["hidden_bias"]),
        output=_rows(data["output"]),
        output_bias=_row(data["output_bias"]),
    )


def _row(data: Sequence[Any]) -> Row:
    return tuple([float(value) for value in data])


def _rows(data: Sequence[Sequence[Any]]) -> tuple[Row, ...]:
    return tuple([_row(row) for row in data])


def _with_half_squares(rows: Sequence[Row], bias: Row) -> Row:
    return tuple([b + 0.5 * fsum([w * w for w in row]) for row, b in zip(rows, bias, strict=True)])


# Votes (log-likelihoods) of both feet on the motion in a block of half a second, and their sum.
#
# Sums of products use math.dist: w x = (w w + x x - |w - x|^2) / 2. It is the only loop over floats that runs in C in
# every Python from 3.11 on, three times as fast as sum(map(mul, ...)), and gives the same bits everywhere. The result
# is off by 1e-12 at most, and hypotheses.py rounds the scores to 1e-4.

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
"""Largest `strangeness` of usual motion; above it, an unknown activity becomes likelier."""
VARIANCE_SHARE = 0.05
"""Share of the variance of |acc| in a block that counts as variance of its mean."""
MAX_STANDING_FORCE = 40.0
"""Largest mean force of a standing foot, m/s^2."""


def motion_votes(model: MotionModel, feet: Sequence[Sequence[float] | None]) -> Floats:
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
    return BlockForce(block.force, variance, block.variance > MOVING_VARIANCE, resolution, block.lean)
