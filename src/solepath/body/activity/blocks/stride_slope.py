"""Evidence of the slope of a stride for stairs: its rise over its length, with the errors that both have.

The rise of a stride on the level is 0, on stairs that of two treads, or of four if the wearer takes two at a time, and
each is measured with an error that grows with the length. The logarithm of the likelihood ratio of stairs to level is
evidence that anyone can check, beside that of a network which may never have seen how this wearer climbs. A ramp of one
in twelve is level by it. A track without heights has strides without rise, which are level."""

from __future__ import annotations

from functools import lru_cache
from math import exp, log

from ....types.attrs import frozen
from .features import MAX_RISE

TREADS_RISE, TREADS_DEVIATION = 0.34, 0.06
"""Rise of a stride over two treads and its standard deviation, m: risers of 0.14 to 0.20 m (Approved Document K of the
Building Regulations 2010 allows 0.15 to 0.22 m)."""
DOUBLE_RISE, DOUBLE_DEVIATION, DOUBLE_SHARE = 0.58, 0.1, 0.2
"""The same two treads at a time, with the largest rise that is distinguished, and the share of such strides.

All three are assumed."""
RISE_ERROR, RISE_ERROR_SHARE = 0.05, 0.08
"""Standard deviation of a measured rise, m, and its growth with the length, no unit.

Level strides of an accelerometer that clips at 2 g (hugadb) rise by 0.10 m over 0.9 m. Chosen of three pairs there, all
wearers in view (0.04 and 0.06 have 1.3 points less, 0.06 and 0.1 as many), and on emulated walks backwards."""
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
    level = _density(rise, error)
    up, down = [log(_stairs(sign * rise, error) + 1e-9) - log(level + 1e-9) for sign in (1.0, -1.0)]
    return SlopeEvidence(BLOCK_SHARE * _limited(up), BLOCK_SHARE * _limited(down))


def _stairs(rise: float, error: float) -> float:
    single = _density(rise - TREADS_RISE, (TREADS_DEVIATION**2 + error**2) ** 0.5)
    double = _density(min(rise, MAX_RISE) - DOUBLE_RISE, (DOUBLE_DEVIATION**2 + error**2) ** 0.5)
    return (1.0 - DOUBLE_SHARE) * single + DOUBLE_SHARE * double


def _density(residual: float, deviation: float) -> float:
    """Return the density of a normal distribution, times the root of 2 pi, 1/m."""
    return exp(-0.5 * (residual / deviation) ** 2) / deviation


def _limited(value: float) -> float:
    return max(-MOST_EVIDENCE, min(MOST_EVIDENCE, value))
