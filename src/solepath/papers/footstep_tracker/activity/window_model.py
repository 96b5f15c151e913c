"""Model of `TwoSecondWindows`: thresholds of its tree, and mixtures for windows of walking and of stairs.

`solepath.lab.train.footstep_activity` learns it, and `shipped` reads the result from footstep_activity.json, which
names its training data."""

from __future__ import annotations

import json
from functools import cache
from math import log
from pkgutil import get_data

from ....saving.codec import load
from ....types.attrs import frozen
from .hmm import Matrix
from .windows import FootWindow

FEATURES = ("log variance", "skewness", "mean", "log across", "log turning")
"""Features of a window for the hidden Markov model, in the order of `window_features`; the last needs a gyroscope."""
LEAST_VARIANCE = 1e-6
"""Least variance, m^2/s^4 and rad^2/s^2; no sensor has less noise."""
LARGEST_SKEWNESS = 4.0
"""Limit of the skewness: one bump of the foot must not decide about a window."""


def window_features(window: FootWindow) -> tuple[float, ...]:
    """Return the window's features, as `FEATURES` names them; logarithms of m^2/s^4 and rad^2/s^2."""
    known = (
        log(window.variance + LEAST_VARIANCE),
        max(-LARGEST_SKEWNESS, min(LARGEST_SKEWNESS, window.skewness)),
        window.mean,
        log(window.across + LEAST_VARIANCE),
    )
    return known if window.turning is None else (*known, log(window.turning + LEAST_VARIANCE))


@frozen
class Gaussian:
    """One component of a mixture.

    `factor`: the lower triangle, row by row, whose product with its own transpose is the covariance."""

    weight: float
    mean: tuple[float, ...]
    factor: tuple[tuple[float, ...], ...]

    def log_density(self, x: tuple[float, ...]) -> float:
        """Return the log density of the features `x`, times the weight, but for a constant of all Gaussians.

        Where `x` lacks the last features it is that of the others: the triangle's first rows are theirs."""
        log_sum = log(self.weight)
        solved: list[float] = []
        for value, mean, row in zip(x, self.mean, self.factor, strict=False):
            left = value - mean
            for known, entry in zip(solved, row, strict=False):
                left -= known * entry
            left /= row[-1]
            solved.append(left)
            log_sum -= 0.5 * left * left + log(row[-1])
        return log_sum


@frozen
class WindowModel:
    """The learnt thresholds, mixtures and transitions."""

    trained_on: str
    """Training data, in a sentence."""
    moving: float
    """Variance of a_z above which a window is walking or stairs, m^2/s^4 (fig. 6a)."""
    pulse: float
    """Difference of a window's mean from that of standing in hypergravity or weightlessness, m/s^2 (fig. 6b)."""
    walking: tuple[Gaussian, ...]
    """Mixture of Gaussians over `FEATURES` for walking."""
    stairs_up: tuple[Gaussian, ...]
    """Mixture of Gaussians over `FEATURES` for stairs up."""
    stairs_down: tuple[Gaussian, ...]
    """Mixture of Gaussians over `FEATURES` for stairs down."""
    transitions: Matrix
    """Transition matrix from one window to the next, half a second later: walking, stairs up, stairs down."""

    def log_likelihoods(self, window: FootWindow) -> tuple[float, float, float]:
        """Return the log likelihoods of walking, stairs up and stairs down.

        A mixture counts as its likeliest component: they lie apart."""
        x = window_features(window)
        up, down = (max([one.log_density(x) for one in part]) for part in (self.stairs_up, self.stairs_down))
        return max([one.log_density(x) for one in self.walking]), up, down


@cache
def shipped() -> WindowModel:
    """Return the model that comes with this release."""
    return load(WindowModel, json.loads(get_data(__package__, "footstep_activity.json") or b""))
