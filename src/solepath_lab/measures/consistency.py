"""Tests whether the errors of a position are as large as its covariance says.

The statistic is the normalised estimation error squared (NEES): d' P^-1 d for the horizontal error d with covariance P
(Bar-Shalom et al. 2001, section 5.4). NEES/2 is 1 on average for a covariance that is right, and 0.69 in the median. On
a recording the first heading is not known. The track is therefore turned so that its first metres fit, and P gets the
error of that turn besides: the covariance across the way at the end of these metres, and the error of the survey."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, sin

import numpy as np

from solepath.validate.alignment import Floats, distances

from .score import Figures

HELD = 5.991
"""Squared distance, in units of the covariance, within which the wearer is with 95 % probability (chi-square, 2)."""
START_DISTANCE = 10.0
"""Length of the first metres, which show the heading, m."""
SURVEY_ERROR = 0.01
"""Standard deviation of a surveyed footprint, m: the width of a mark (assumed)."""


def rotation(angle: float) -> Floats:
    """Return the matrix (2,2) of a rotation to the left by an angle, rad."""
    return np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])


def matrix(covariance: Sequence[float] | Floats) -> Floats:
    """Return the covariance (2,2), m^2, of its xx, xy and yy."""
    xx, xy, yy = covariance
    return np.array([[xx, xy], [xy, yy]])


def yaws(attitudes: Floats) -> Floats:
    """Return the angles of attitudes (n,4), or of one (4,), about the vertical, rad, from -pi to pi."""
    w, x, y, z = attitudes.T
    return np.asarray(np.arctan2(2.0 * (x * y + w * z), 1.0 - 2.0 * (y * y + z * z)))


def consistency(error: Floats, covariance: Floats) -> tuple[float, float]:
    """Return NEES/2 of a horizontal error (2,), m, with a covariance (2,2), m^2, and 1 if it is held, otherwise 0."""
    square = float(error @ np.linalg.solve(covariance, error))
    return 0.5 * square, float(square < HELD)


def consistency_at_end(places: Floats, covariances: Floats, surveyed: Floats) -> Figures:
    """Return `nees_end` and `held_end` of the last of some places of a track (n,2), m, with their survey (n,2), m.

    The covariances (n,3) are xx, xy, yy, m^2. There is none for a walk that is not longer than the first metres."""
    walked = distances(surveyed)
    k = int(np.searchsorted(walked, START_DISTANCE))
    if k >= len(walked) - 1:
        return {}
    (x, y), (u, v) = places[k] - places[0], surveyed[k] - surveyed[0]
    yaw, length = atan2(v, u) - atan2(y, x), float(np.hypot(x, y))
    across = np.array([-y, x]) / length
    turn = rotation(yaw)
    yaw_variance = (across @ matrix(covariances[k]) @ across + 2.0 * SURVEY_ERROR**2) / length**2
    end = turn @ (places[-1] - places[0])
    turned = np.array([-end[1], end[0]])
    covariance = turn @ matrix(covariances[-1]) @ turn.T + yaw_variance * np.outer(turned, turned)
    nees, held = consistency(end - (surveyed[-1] - surveyed[0]), covariance)
    return {"nees_end": nees, "held_end": held}
