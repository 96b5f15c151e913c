"""What `TwoSecondWindows` knows: thresholds of its tree, and what windows of walking and of stairs look like.

`solepath.lab.train.footstep_activity` learns it, and `shipped` reads what it learnt: footstep_activity.json, which
says of what it was learnt.
"""

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
"""What the hidden Markov model sees of a window, in this order (`seen`); the last one only where there is a
gyroscope."""
LEAST_VARIANCE = 1e-6
"""m^2/s^4, and rad^2/s^2; no sensor is more quiet."""
STEEPEST = 4.0
"""Magnitude of the skewness that counts at the most: one bump of the foot must not speak for a window."""


def seen(window: FootWindow) -> tuple[float, ...]:
    """The window's features, as `FEATURES` names them; logarithms of m^2/s^4 and rad^2/s^2."""
    known = (
        log(window.variance + LEAST_VARIANCE),
        max(-STEEPEST, min(STEEPEST, window.skewness)),
        window.mean,
        log(window.across + LEAST_VARIANCE),
    )
    return known if window.turning is None else (*known, log(window.turning + LEAST_VARIANCE))


@frozen
class Gaussian:
    """One component of a mixture. `factor`: the lower triangle, row by row, whose product with its own transpose is the
    covariance."""

    weight: float
    mean: tuple[float, ...]
    factor: tuple[tuple[float, ...], ...]

    def log_density(self, x: tuple[float, ...]) -> float:
        """Of the features `x`, times the weight, but for a constant of all Gaussians. Where `x` lacks the last ones it
        is that of the others: the triangle's first rows are theirs."""
        told = log(self.weight)
        solved: list[float] = []
        for value, mean, row in zip(x, self.mean, self.factor, strict=False):
            left = value - mean
            for known, entry in zip(solved, row, strict=False):
                left -= known * entry
            left /= row[-1]
            solved.append(left)
            told -= 0.5 * left * left + log(row[-1])
        return told


@frozen
class WindowModel:
    """All that was learnt."""

    trained_on: str
    """In a sentence."""
    moving: float
    """Variance of a_z above which a window is walking or stairs, m^2/s^4 (fig. 6a)."""
    pulse: float
    """By how much the mean of a window is above (hypergravity) or below (weightlessness) that of standing, m/s^2
    (fig. 6b)."""
    walking: tuple[Gaussian, ...]
    """Mixtures of Gaussians over `FEATURES`."""
    stairs_up: tuple[Gaussian, ...]
    stairs_down: tuple[Gaussian, ...]
    transitions: Matrix
    """From one window to the next that slides half a second on: walking, stairs up, stairs down."""

    def log_likelihoods(self, window: FootWindow) -> tuple[float, float, float]:
        """Of walking, stairs up and stairs down. A mixture counts as its likeliest component: they lie apart."""
        x = seen(window)
        up, down = (max([one.log_density(x) for one in part]) for part in (self.stairs_up, self.stairs_down))
        return max([one.log_density(x) for one in self.walking]), up, down


@cache
def shipped() -> WindowModel:
    """The model that comes with this release."""
    return load(WindowModel, json.loads(get_data(__package__, "footstep_activity.json") or b""))
