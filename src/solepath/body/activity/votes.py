"""What the feet say of half a second, each by itself, and what that comes to."""

from __future__ import annotations

from collections.abc import Sequence

from .block import ActivityBlock
from .motion import MOTIONS, MotionModel
from .ride import SWAY, Felt

SHARE = 0.6
"""Neighbouring windows are of the same samples, so each vote counts so much."""
LEAST = -12.0
"""No vote is less (natural logarithm)."""
STRANGE = 3.0
"""Something that nobody has learnt is as likely as this (minus natural logarithm) for a foot that moves as usual,"""
USUAL = 6.0
"""up to this strangeness (motion.py), and ever more likely above."""
MOVES = 1.0
"""Variance of |acc| of a foot that does not stand, (m/s^2)^2."""
MOST = 40.0
"""A mean force beyond is none of a standing foot, m/s^2."""


def motions(model: MotionModel, feet: Sequence[Sequence[float] | None]) -> tuple[float, ...]:
    """Logarithms of how likely each of `MOTIONS` is, and something else, given the features of each foot; None: it was
    not heard."""
    said = [0.0] * len(MOTIONS)
    unknown = 0.0
    heard = False
    for features in feet:
        if features is None:
            continue
        heard = True
        for i, likely in enumerate(model.log_probabilities(features)):
            said[i] += SHARE * max(likely, LEAST)
        unknown += SHARE * min(0.5 * (model.strangeness(features) - USUAL) - STRANGE, 0.0)
    return (*said, unknown) if heard else (*[-1.0] * len(MOTIONS), 0.0)


def felt(block: ActivityBlock | None, grain: float) -> Felt | None:
    """What a lift would be felt in; None of a foot that was not heard. `grain`: what a count of its accelerometer is
    worth, m/s^2."""
    if block is None or block.force >= MOST:
        return None
    variance = SWAY * SWAY + 0.05 * min(block.variance, 1e4) + grain * grain / 12.0
    return Felt(block.force, variance, block.variance > MOVES)
