"""Test of the calibration of the heading by the straight ways of a walk.

Two hypotheses predict how the straight ways of this walk bend: the feet drift as `solepath calibrate walk` found, up to
its standard deviation, or the calibration is of other shoes or sensors, and they drift as uncalibrated feet do. Each
is a filter of one state, the drift that remains after the calibration is removed (Bar-Shalom et al. 2001, section 1.4).
A way may bend by itself under both. The calibration is dropped when the second hypothesis explains the walk better by
far, and makes most of its ways straight: those of a wearer who weaves bend alike to the left and to the right."""

from __future__ import annotations

from math import exp, log, sqrt

from ...types.attrs import define
from .straightness import StretchDrift

DROP_RATIO = 1000.0
"""Ratio of the likelihoods above which the calibration is dropped, no unit: 1 in 100 is of other shoes, and 10 to 1 is
certain enough."""
STRAIGHT_SHARE = 0.7
"""Share of the stretches that are straight, the others bend by themselves (assumed)."""
LEAST_SHARE, LEAST_COUNT = 0.75, 4.0
"""Least share of the stretches that are straight without the calibration, and least number of stretches, before it is
dropped. On a way that bends to the left and to the right in turn the share is a half."""
BEND_SIGMA = 0.04
"""Standard deviation of the bend of a way that is not straight, rad a stride: 1/30 m."""


@define
class DriftHypothesis:
    """The drift that remains after the calibration, under one hypothesis."""

    drift: float
    """Estimated drift, rad a stride."""
    variance: float
    """Variance of `drift`, rad^2."""
    straight: float = 0.0
    """Number of stretches that are straight with this drift: the sum of their probabilities."""

    def add(self, found: StretchDrift, seen: float) -> float:
        """Take in the drift `seen` on a stretch, rad a stride; return the logarithm of its likelihood."""
        z, s = seen - self.drift, self.variance + found.variance
        bent = found.variance + BEND_SIGMA * BEND_SIGMA
        straight = STRAIGHT_SHARE * exp(-0.5 * z * z / s) / sqrt(s)
        total = straight + (1.0 - STRAIGHT_SHARE) * exp(-0.5 * seen * seen / bent) / sqrt(bent) + 1e-300
        weight, gain = straight / total, self.variance / s
        self.straight += weight
        self.drift += weight * gain * z
        self.variance *= max(0.0, 1.0 - weight * gain)
        self.variance += weight * (1.0 - weight) * gain * gain * z * z
        return log(total)


@define
class CalibrationFit:
    """Evidence on whether the calibration of the heading fits a walk."""

    fits: DriftHypothesis
    """The feet drift as calibrated."""
    other: DriftHypothesis
    """The feet drift as if they had not been calibrated."""
    evidence: float = 0.0
    """Logarithm of the ratio of the likelihoods of `other` and `fits`, at least 0."""
    count: float = 0.0
    """Number of stretches since `evidence` was last 0."""

    def add(self, found: StretchDrift, seen: float) -> bool:
        """Take in the drift `seen` on a stretch, rad a stride; return whether the calibration does not fit."""
        if not self.evidence:
            self.count = self.other.straight = 0.0
        self.count += 1.0
        self.evidence = max(0.0, self.evidence + self.other.add(found, seen) - self.fits.add(found, seen))
        is_straight = self.count >= LEAST_COUNT and self.other.straight >= LEAST_SHARE * self.count
        return is_straight and self.evidence > log(DROP_RATIO)
