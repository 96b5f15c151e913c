"""Runs of a recipe over the samples of a boot: its strides, and the samples in which it took the heel to be at rest."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import erfc, sqrt

import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from solepath.calibration import Calibration
from solepath.emulate.wearers.truth import Truth
from solepath.events import StrideTaken
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.recipes import Recipe
from solepath.session import Session
from solepath.types import Foot, Sample
from solepath.validate.alignment import Floats

from ..walks import final_strides


@frozen(eq=False)
class ContourRun:
    """The results of one recipe on the samples of one foot."""

    strides: tuple[StrideTaken, ...]
    """Final strides of the foot."""
    t: Floats
    """Times of the samples, s, (N)."""
    at_rest: NDArray[np.bool_]
    """True for the samples at which the velocity was set to zero, (N)."""
    bias: Floats
    """Bias that the recipe's filter has estimated after each sample, sensor frame, m/s^2, (N, 3)."""


def run_foot(recipe: Recipe, foot: Foot, samples: Sequence[Sample], calibration: Calibration) -> ContourRun:
    """Feed the samples of one foot to a session of the recipe, one at a time."""
    session = Session(recipe, calibration=calibration)
    events, at_rest, biases = [], [], []
    for sample in samples:
        events += session.feed(sample)
        corrector = session.feet[foot].corrector
        assert isinstance(corrector, LinearDedrift)
        at_rest.append(corrector.swing == 0.0)
        bias = getattr(corrector, "bias", None)
        biases.append((0.0, 0.0, 0.0) if bias is None else bias.bias)
    events += session.finish()
    strides = tuple(final_strides(events))
    t = np.array([sample.t for sample in samples])
    return ContourRun(strides, t, np.array(at_rest), np.array(biases))


def stance_velocities(run: ContourRun, truth: Truth, foot: Foot, after: float = 0.0) -> Floats:
    """Return the true velocities of the heel while a recipe took it to be at rest, in stances from `after`, s, on, m/s.

    A velocity is the length of the mean horizontal one over the samples of a stance that were taken for rest: an update
    with zero velocity makes an error of this size. It is nan for a stance without such a sample.

    A stance here lasts from the middle of one swing to the middle of the next: what is taken for rest in a swing counts
    to the nearer stance."""
    velocity = truth.pose(foot, run.t).velocity[:, :2]
    strides = truth.strides(foot)
    middles = np.array([0.5 * (one.t_toe_off + one.t_heel_strike) for one in strides])
    middles = middles[middles >= max(after, float(run.t[0]))]
    biases = []
    for start, end in pairwise(middles):
        rows = slice(*np.searchsorted(run.t, (start, end)).tolist())
        rest = run.at_rest[rows]
        biases.append(float(np.linalg.norm(velocity[rows][rest].mean(axis=0))) if rest.any() else float("nan"))
    return np.array(biases)


def found_share(velocities: Floats) -> float:
    """Return the share of stances that have a sample taken for rest."""
    return float(np.mean(~np.isnan(velocities))) if len(velocities) else 0.0


@frozen
class PairedTest:
    """A sign test of pairs: how often the first of two values is smaller, and how probable that is by chance."""

    smaller: int
    """Number of pairs in which the first value is smaller."""
    pairs: int
    """Number of pairs with different values."""

    @property
    def probability(self) -> float:
        """Probability, two-sided, that so many or more pairs go one way if both ways are as likely.

        It is that of the normal distribution with a continuity correction."""
        if not self.pairs:
            return 1.0
        deviation = abs(self.smaller - 0.5 * self.pairs) - 0.5
        return min(1.0, erfc(max(0.0, deviation) / sqrt(0.5 * self.pairs)))


def sign_test(first: Floats, second: Floats) -> PairedTest:
    """Compare pairs of values; pairs with a nan are left out."""
    both = ~(np.isnan(first) | np.isnan(second)) & (first != second)
    return PairedTest(int(np.sum(first[both] < second[both])), int(np.sum(both)))
