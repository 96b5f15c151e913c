"""Model of `TwoSecondWindows`: thresholds of the decision tree, and mixtures for windows of walking and of stairs.

`solepath-lab train footstep-activity` learns the model. `shipped` reads it from footstep_activity.json, which names its
training data. Numbers without a source were chosen by hand."""

from __future__ import annotations

import json
from functools import cache
from math import log
from pkgutil import get_data

from ....saving.codec import load
from ....types import Floats
from ....types.attrs import frozen
from .hmm import Matrix
from .windows import FootWindow

FEATURES = ("log variance", "skewness", "mean", "log across", "log turning")
"""Names of a window's features, in the order of `window_features`; the last feature needs a gyroscope."""
LEAST_VARIANCE = 1e-6
"""Variance added before a logarithm is taken, m^2/s^4 and rad^2/s^2; no sensor has less noise."""
LARGEST_SKEWNESS = 4.0
"""Limit of the absolute skewness, so that a single bump of the foot does not decide about a window."""


def window_features(window: FootWindow) -> Floats:
    """Return the window's features in the order of `FEATURES`; logarithms are of values in m^2/s^4 and rad^2/s^2."""
    features = (
        log(window.variance + LEAST_VARIANCE),
        max(-LARGEST_SKEWNESS, min(LARGEST_SKEWNESS, window.skewness)),
        window.mean,
        log(window.across + LEAST_VARIANCE),
    )
    return features if window.turning is None else (*features, log(window.turning + LEAST_VARIANCE))


@frozen
class Gaussian:
    """One component of a mixture of Gaussians."""

    weight: float
    mean: Floats
    factor: tuple[Floats, ...]
    """Lower Cholesky factor of the covariance, row by row."""

    def log_density(self, x: Floats) -> float:
        """Return the logarithm of weight times density at `x`, without a constant that all Gaussians have in common.

        If `x` lacks the last features, the result is the marginal density of the others, for which the first rows of
        the factor suffice."""
        log_sum = log(self.weight)
        coordinates: list[float] = []
        for value, mean, row in zip(x, self.mean, self.factor, strict=False):
            residual = value - mean
            for coordinate, entry in zip(coordinates, row, strict=False):
                residual -= coordinate * entry
            residual /= row[-1]
            coordinates.append(residual)
            log_sum -= 0.5 * residual * residual + log(row[-1])
        return log_sum


@frozen
class WindowModel:
    """The learnt thresholds, mixtures and transitions."""

    trained_on: str
    """Training data, in a sentence."""
    moving: float
    """Variance of a_z above which a window is walking or stairs, m^2/s^4 (fig. 6a)."""
    pulse: float
    """Least difference of a window's mean from that of standing while an elevator speeds up or brakes, m/s^2 (fig. 6b).
    """
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

        The likeliest component stands for the whole mixture, because the components hardly overlap."""
        x = window_features(window)
        up, down = (max([g.log_density(x) for g in mixture]) for mixture in (self.stairs_up, self.stairs_down))
        return max([g.log_density(x) for g in self.walking]), up, down


@cache
def shipped() -> WindowModel:
    """Return the model that comes with this release."""
    return load(WindowModel, json.loads(get_data(__package__, "footstep_activity.json") or b""))
