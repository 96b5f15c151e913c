"""The curves of `Activities`: a multinomial logistic regression on the shares of points, fitted by Newton's method.

A value between two points of a curve has a share of either, and none of the others. In a share of the blocks the
features of the track and of the strides are set to 0 first, so that the curves serve blocks without them. Numbers
without a source were chosen by hand; no sweep of them is recorded."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from solepath.body.activity.foot_blocks import FEATURES, FORCE_FEATURES, Row
from solepath.body.activity.motion import MOTIONS, Curve, Curves, MotionModel
from solepath.types import Activity

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

CLASSES: dict[Activity, int] = {
    Activity.STANDING: 0,
    Activity.ELEVATOR_UP: 0,
    Activity.ELEVATOR_DOWN: 0,
    Activity.WALKING: 1,
    Activity.RUNNING: 2,
    Activity.STAIRS_UP: 3,
    Activity.STAIRS_DOWN: 4,
    Activity.UNKNOWN: 5,
}
"""Number of the motion for each activity. In an elevator a foot stands."""
STRIDE_FEATURES = ("stride", "stride_time", "stride_length", "slope", "strike_height")
TRACK_FEATURES = ("climb", "sink", "climb_now", "sink_now", *STRIDE_FEATURES)
"""Features that need strides, and those that need a track."""
STRIDE_DROPOUT, TRACK_DROPOUT = 0.2, 0.1
"""Shares of the blocks that are learnt without the features of strides, and without those of the track."""
POINTS = (0.02, 0.25, 0.5, 0.75, 0.98)
"""Shares of the values of a feature that are below each point of its curve.

Three points have 0.3 percentage points fewer right half seconds in the folds of hugadb, seven have 0.04 more."""
ITERATIONS = 10
"""Steps of Newton's method; the last ones change nothing."""
RIDGE = 1e-4
"""Weight of half the sum of the squares of all points, against the mean loss of a block; a tenth changes nothing."""


def block_weights(classes: Numbers, wearers: Numbers) -> Floats:
    """Return the weight of each block, which is proportional to 1 / sqrt(number of blocks of its class and wearer).

    So no wearer with many blocks dominates. All blocks of a class together weigh the same, so that a probability is
    proportional to the likelihood that the chain of activities needs (Bourlard, Morgan, "Connectionist Speech
    Recognition", 1994). The sum is 1."""
    _, index, counts = np.unique(np.column_stack([classes, wearers]), axis=0, return_inverse=True, return_counts=True)
    weights = 1.0 / np.sqrt(counts[index.ravel()])
    totals = np.bincount(classes, weights)
    return np.asarray(weights / totals[classes] / (totals > 0.0).sum())


def fit(names: Sequence[str], rows: Floats, classes: Numbers, wearers: Numbers) -> Curves:
    """Return the curves that are fitted to blocks with these features, classes and wearers.

    `rows` (n, features), `classes` (n,) (numbers of CLASSES) and `wearers` (n,) have a row for each block."""
    rng = np.random.default_rng(0)
    weight, truth = block_weights(classes, wearers), np.eye(len(MOTIONS))[classes]
    points = {name: _points(name, rows[:, k], weight) for k, name in enumerate(names)}
    rows = rows.copy()
    for dropped, share in ((STRIDE_FEATURES, STRIDE_DROPOUT), (TRACK_FEATURES, TRACK_DROPOUT)):
        chosen = rng.random(len(rows)) < share
        for k, name in enumerate(names):
            if name in dropped:
                rows[chosen, k] = 0.0
    x = np.concatenate([_shares(rows[:, k], points[name]) for k, name in enumerate(names)], axis=1)
    found = np.zeros((len(MOTIONS), x.shape[1]))
    loss = _loss(x, truth, weight, found)
    for _ in range(ITERATIONS):
        step = _newton_step(x, truth, weight, found)
        while (shorter := _loss(x, truth, weight, found - step)) > loss and np.abs(step).max() > 1e-6:
            step = 0.5 * step
        found, loss = found - step, shorter
    odds = iter(found.T)
    return {
        name: Curve(rounded_row(values), tuple([rounded_row(next(odds)) for _ in values]))
        for name, values in points.items()
    }


def _points(name: str, values: Floats, weight: Floats) -> Floats:
    """Return the values of a feature at the points of its curve; of a feature of strides where a stride is known."""
    known = values != 0.0 if name in STRIDE_FEATURES and name != "stride" else np.full(len(values), True)
    order = np.argsort(values[known])
    below = np.cumsum(weight[known][order])
    return np.unique(rounded_row(values[known][order][np.searchsorted(below, np.array(POINTS) * below[-1])]))


def _shares(values: Floats, points: Floats) -> Floats:
    """Return the share of each point in each value, (n, points)."""
    return np.column_stack([np.interp(values, points, one) for one in np.eye(len(points))])


def _probabilities(x: Floats, found: Floats) -> Floats:
    sums = x @ found.T
    odds = np.exp(sums - sums.max(1, keepdims=True))
    return np.asarray(odds / odds.sum(1, keepdims=True))


def _loss(x: Floats, truth: Floats, weight: Floats, found: Floats) -> float:
    """Return the weighted cross-entropy plus the penalty of large values."""
    likely = (_probabilities(x, found) * truth).sum(1)
    return float(-weight @ np.log(likely + 1e-300) + 0.5 * RIDGE * (found * found).sum())


def _newton_step(x: Floats, truth: Floats, weight: Floats, found: Floats) -> Floats:
    """Return the gradient divided by the second derivatives, in the shape of `found`."""
    chances = _probabilities(x, found)
    n, m = found.shape
    slope = ((chances - truth) * weight[:, None]).T @ x + RIDGE * found
    curvature = RIDGE * np.eye(n * m)
    for a in range(n):
        for b in range(a + 1):
            share = weight * chances[:, a] * (float(a == b) - chances[:, b])
            part = (x * share[:, None]).T @ x
            curvature[a * m : (a + 1) * m, b * m : (b + 1) * m] += part
            if a != b:
                curvature[b * m : (b + 1) * m, a * m : (a + 1) * m] += part
    return np.asarray(np.linalg.solve(curvature, slope.ravel()).reshape(n, m))


def fit_both(features: Floats, forces: Floats, classes: Numbers, wearers: Numbers) -> tuple[Curves, Curves]:
    """Return the curves of FEATURES, learnt from the blocks that have them, and those of FORCE_FEATURES."""
    known = ~np.isnan(features[:, 0])
    with_gyroscope = fit(FEATURES, features[known], classes[known], wearers[known])
    return with_gyroscope, fit(FORCE_FEATURES, forces, classes, wearers)


def rounded_row(values: Floats) -> Row:
    """Return the values rounded as in the file of the model."""
    return tuple([float(f"{value:.3g}") for value in values.tolist()])


def to_json(model: MotionModel) -> str:
    """Return the model in the form that `load_released_model` reads, with a line for each row of numbers."""
    fields = attrs.asdict(model, value_serializer=lambda _, __, value: getattr(value, "value", value))
    return re.sub(r"\[[^][]*\]", lambda row: json.dumps(json.loads(row[0])), json.dumps(fields, indent=1)) + "\n"
