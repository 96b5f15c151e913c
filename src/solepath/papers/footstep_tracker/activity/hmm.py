"""Forward filter of a hidden Markov model with a few states, one observation at a time.

Rabiner 1989, "A tutorial on hidden Markov models": alpha of equations (19) and (20), scaled to sum 1 as in section V.A
there."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, fsum

from ....types import Floats

LEAST_LIKELIHOOD = 1e-12
"""Least likelihood of a state relative to the likeliest one. With a smaller one it could not become likely again."""

Matrix = tuple[Floats, ...]
"""Rows of a matrix."""


def scaled_likelihoods(log_likelihoods: Sequence[float]) -> Floats:
    """Return likelihoods relative to the largest, each in [LEAST_LIKELIHOOD, 1]; the logarithms are finite."""
    highest = max(log_likelihoods)
    return tuple([max(LEAST_LIKELIHOOD, exp(max(-700.0, value - highest))) for value in log_likelihoods])


def forward(belief: Sequence[float], transitions: Matrix, likelihoods: Sequence[float]) -> Floats:
    """Return the probabilities of the states after one more observation, from the old ones and the likelihoods.

    `likelihoods` are those of `scaled_likelihoods`. The result sums to 1."""
    prior = [0.0] * len(belief)
    for share, row in zip(belief, transitions, strict=True):
        for j, p in enumerate(row):
            prior[j] += share * p
    return bayes_update(prior, likelihoods)


def bayes_update(prior: Sequence[float], likelihoods: Sequence[float]) -> Floats:
    """Return the posterior by Bayes' rule; no state becomes impossible."""
    joint = [max(p * f, LEAST_LIKELIHOOD) for p, f in zip(prior, likelihoods, strict=True)]
    scale = 1.0 / fsum(joint)
    return tuple([p * scale for p in joint])
