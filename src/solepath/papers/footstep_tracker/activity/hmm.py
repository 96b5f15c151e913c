"""A hidden Markov model followed online by its forward filter; plain floats, a few states.

Rabiner 1989, "A tutorial on hidden Markov models": alpha of equations (19) and (20), scaled to sum 1 as in its section
V.A.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, isfinite

LEAST = 1e-12
"""No state is ever less likely than this beside the likeliest: it could not come back."""

Matrix = tuple[tuple[float, ...], ...]


def spread(log_likelihoods: Sequence[float]) -> tuple[float, ...]:
    """Likelihoods beside the largest, each in [LEAST, 1]; what is no number says nothing."""
    sound = [value if isfinite(value) else None for value in log_likelihoods]
    highest = max([value for value in sound if value is not None], default=0.0)
    return tuple([1.0 if value is None else max(LEAST, exp(max(-700.0, value - highest))) for value in sound])


def forward(belief: Sequence[float], transitions: Matrix, likelihoods: Sequence[float]) -> tuple[float, ...]:
    """The belief one step later, with the likelihoods of what was seen then (`spread`); it sums to 1."""
    prior = [0.0] * len(belief)
    for held, row in zip(belief, transitions, strict=True):
        for j, p in enumerate(row):
            prior[j] += held * p
    return weighed(prior, likelihoods)


def weighed(prior: Sequence[float], likelihoods: Sequence[float]) -> tuple[float, ...]:
    """Bayes' rule; no state becomes impossible."""
    joint = [max(p * f, LEAST) for p, f in zip(prior, likelihoods, strict=True)]
    scale = 1.0 / sum(joint)
    return tuple([p * scale for p in joint])
