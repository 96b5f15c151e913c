"""Drift of the heading of a foot, from surveyed strides, from a loop that is closed, and on a treadmill.

A drift is that of the track against the truth, rad/s, positive to the left."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from solepath.validate.alignment import Floats

from .score import Figures

MIN_STRIDE = 0.5
"""Shortest stride whose direction is compared with the truth, m."""
MIN_TIME = 50.0
"""Shortest walk whose drift is averaged with that of others, s: in a shorter one, the direction of a stride decides."""


def drift_figures(drift: float | None, t: Floats) -> Figures:
    """Return the size of a drift of a foot, rad/s, and the same for each of its strides, which end at `t` (n,), s."""
    if drift is None:
        return {"drift": None, "drift_stride": None}
    return {"drift": abs(drift), "drift_stride": abs(drift) * float(t[-1] - t[0]) / (len(t) - 1)}


def drift_of_strides(t: Floats, places: Floats, truth: NDArray[Any]) -> float | None:
    """Return the drift of `places` (n,2), m, at the ends of strides `t` (n,), s, against `truth` (n,2), m.

    The errors of the directions of strides are fitted by a straight line in time, weighted by the strides' length. None
    for a walk of less than MIN_TIME."""
    if t[-1] - t[0] < MIN_TIME:
        return None
    ours, theirs = (
        np.diff(np.asarray(one, np.float64)[:, :2], axis=0) @ np.array([1.0, 1.0j]) for one in (places, truth)
    )
    long_enough = np.abs(theirs) > MIN_STRIDE
    errors = np.unwrap(np.angle(ours[long_enough] / theirs[long_enough]))
    middle = 0.5 * (t[1:] + t[:-1])[long_enough]
    return float(np.polyfit(middle, errors, 1, w=np.abs(theirs[long_enough]))[0])


def drift_that_opens(t: Floats, places: Floats) -> float:
    """Return the drift that best explains why a closed walk through `places` (n,2), m, at `t` (n,), s, does not close.

    A heading that has drifted by w dt at a place p moves the end by w dt c (end - p), with a rotation c by +90 degrees.
    The integral a of that, and the distance e from start to end, give w = e a / a^2 by least squares."""
    end = places[-1, :2]
    arms = end - places[:, :2]
    integral = np.sum(0.5 * (arms[1:] + arms[:-1]) * np.diff(t)[:, None], axis=0)
    turned = np.array([-integral[1], integral[0]])
    return float((end - places[0, :2]) @ turned / (turned @ turned))
