"""Votes (log-likelihoods) of both feet on the motion in a block of half a second, and their sum."""

from __future__ import annotations

from collections.abc import Sequence

from ..elevator_evidence import SWAY_DEVIATION, BlockForce
from .features import FIRST_GYRO_FEATURE, ActivityBlock, stride_of
from .motion import MOTIONS, MotionModel
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
        for i, likely in enumerate(model.log_probabilities(features)):
            votes[i] += weight * max(likely, MIN_VOTE)
        stride = stride_of(features)
        if stride is not None:
            duration, length, rise = stride
            slope = slope_evidence(length, rise)
            if length > LEAST_LENGTH and duration < LONGEST_STRIDE:
                votes[STILL] -= STRIDE_EVIDENCE
            votes[STAIRS_UP] += slope.up
            votes[STAIRS_DOWN] += slope.down
        unknown += weight * min(0.5 * (model.strangeness(features) - USUAL_STRANGENESS) - UNKNOWN_COST, 0.0)
    return (*votes, unknown) if known else (*[-1.0] * len(MOTIONS), 0.0)


def block_force(block: ActivityBlock | None, resolution: float) -> BlockForce | None:
    """Return the force on a foot in a block, for elevator detection; None without a block or above the limit.

    `resolution` is the accelerometer's, m/s^2 per count."""
    if block is None or block.force >= MAX_STANDING_FORCE:
        return None
    variance = (
        SWAY_DEVIATION * SWAY_DEVIATION + VARIANCE_SHARE * min(block.variance, 1e4) + resolution * resolution / 12.0
    )
    return BlockForce(block.force, variance, block.variance > MOVING_VARIANCE, resolution)
