"""The small networks of `Activities`: one hidden layer, fitted by stochastic gradient descent (Adam: Kingma, Ba 2015).

In every epoch the features of the track and of the strides are set to 0 in some blocks, so that the network works
without them. Noise as large as the errors of tracks with a clipping accelerometer is added to the features of strides.

Numbers without a source were chosen by hand; no sweep of them is recorded."""

from __future__ import annotations

import json
import re

import attrs
import numpy as np
from numpy.typing import NDArray

from solepath.body.activity.foot_blocks import FIRST_GYRO_FEATURE, FIRST_STRIDE_FEATURE, FIRST_TRACK_FEATURE
from solepath.body.activity.motion import MOTIONS, MotionModel, Network, Row
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
}
"""Number of the network's output for each activity. In an elevator a foot stands."""
HIDDEN_UNITS = 24
EPOCHS = 15
BATCH_SIZE = 512
LEARNING_RATE = 3e-3
WEIGHT_DECAY = 1e-3
TRACK_DROPOUT, STRIDE_DROPOUT = 0.1, 0.2
"""Shares of the blocks in an epoch without the features of the track, and without those of the stride."""
MIN_DEVIATION = 0.02
"""Smallest standard deviation of a feature that the model states, in the feature's unit."""


def weights(classes: Numbers, wearers: Numbers) -> Floats:
    """Return the weight of each block, which is proportional to 1 / sqrt(number of blocks of its class and wearer).

    So all blocks of one class and wearer together weigh sqrt(number): neither rare nor frequent classes dominate."""
    block_weights = np.ones(len(classes))
    for wearer in np.unique(wearers):
        for k in range(len(MOTIONS)):
            members = (wearers == wearer) & (classes == k)
            if members.any():
                block_weights[members] = 1.0 / np.sqrt(members.sum())
    return np.asarray(block_weights / block_weights.mean())


def fit_networks(features: Floats, classes: Numbers, wearers: Numbers) -> tuple[Network, Network]:
    """Return the network for feet with a gyroscope, and the network that needs only the accelerometer.

    `features` (n, FEATURE_COUNT), `classes` (n,) (numbers of CLASSES) and `wearers` (n,) have a row for each block."""
    has_gyro = features[:, FIRST_GYRO_FEATURE] > 0.0
    full_network = fit_network(features[has_gyro], classes[has_gyro], wearers[has_gyro])
    return full_network, fit_network(features[:, :FIRST_GYRO_FEATURE], classes, wearers)


def fit_network(features: Floats, classes: Numbers, wearers: Numbers, seed: int = 0) -> Network:
    """Return a network that is fitted to the blocks with these features, classes and wearers."""
    rng = np.random.default_rng(seed)
    weight = weights(classes, wearers)
    mean, deviation = features.mean(0), features.std(0) + 0.01
    inputs = features.shape[1]
    shapes = ((inputs, HIDDEN_UNITS), (HIDDEN_UNITS,), (HIDDEN_UNITS, len(MOTIONS)), (len(MOTIONS),))
    parameters = [rng.normal(0.0, shape[0] ** -0.5, shape) if len(shape) == 2 else np.zeros(shape) for shape in shapes]
    mean_slopes, mean_squares = [np.zeros(shape) for shape in shapes], [np.zeros(shape) for shape in shapes]
    count = 0
    for epoch in range(EPOCHS):
        rows = ((disturb(features, rng) if inputs > FIRST_GYRO_FEATURE else features) - mean) / deviation
        rate = LEARNING_RATE * 0.5 * (1.0 + np.cos(np.pi * epoch / EPOCHS))
        order = rng.permutation(len(rows))
        for start in range(0, len(order), BATCH_SIZE):
            batch = order[start : start + BATCH_SIZE]
            count += 1
            for k, slope in enumerate(_slopes(parameters, rows[batch], classes[batch], weight[batch])):
                mean_slopes[k] += 0.1 * (slope - mean_slopes[k])
                mean_squares[k] += 0.001 * (slope**2 - mean_squares[k])
                step = mean_slopes[k] / (1.0 - 0.9**count) / (np.sqrt(mean_squares[k] / (1.0 - 0.999**count)) + 1e-8)
                parameters[k] -= rate * step
    hidden = parameters[0] / deviation[:, None]
    return Network(
        hidden=tuple([rounded_row(row) for row in hidden.T]),
        hidden_bias=rounded_row(parameters[1] - mean @ hidden),
        output=tuple([rounded_row(row) for row in parameters[2].T]),
        output_bias=rounded_row(parameters[3]),
    )


def feature_statistics(features: Floats, classes: Numbers) -> tuple[tuple[Row, ...], tuple[Row, ...]]:
    """Return mean and standard deviation of each accelerometer feature, for each of MOTIONS."""
    accelerometer_rows = [features[classes == k][:, :FIRST_GYRO_FEATURE] for k in range(len(MOTIONS))]
    return (
        tuple([rounded_row(one.mean(0)) for one in accelerometer_rows]),
        tuple([rounded_row(np.maximum(one.std(0), MIN_DEVIATION)) for one in accelerometer_rows]),
    )


def _slopes(parameters: list[Floats], x: Floats, y: Numbers, weight: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the gradient of the weighted cross-entropy plus weight decay, for each of the four parameter arrays."""
    inner = np.tanh(x @ parameters[0] + parameters[1])
    outer = inner @ parameters[2] + parameters[3]
    probabilities = np.exp(outer - outer.max(1, keepdims=True))
    probabilities /= probabilities.sum(1, keepdims=True)
    probabilities[np.arange(len(y)), y] -= 1.0
    probabilities *= weight[:, None] / len(y)
    hidden_slopes = (probabilities @ parameters[2].T) * (1.0 - inner**2)
    return (
        np.asarray(x.T @ hidden_slopes + WEIGHT_DECAY * parameters[0]),
        np.asarray(hidden_slopes.sum(0)),
        np.asarray(inner.T @ probabilities + WEIGHT_DECAY * parameters[2]),
        np.asarray(probabilities.sum(0)),
    )


def disturb(features: Floats, rng: np.random.Generator) -> Floats:
    """Return the features with noise and gaps as other sensors might have them."""
    noisy = features.copy()
    n = len(noisy)
    has_stride = noisy[:, FIRST_STRIDE_FEATURE] > 0.0
    for feature, deviation in ((2, 0.12), (5, 0.06), (6, 0.05)):
        noisy[has_stride, FIRST_STRIDE_FEATURE + feature] *= np.exp(rng.normal(0.0, deviation, n))[has_stride]
    for feature, deviation in ((3, 0.08), (4, 0.05), (8, 0.05), (9, 0.05), (10, 0.05)):
        noisy[has_stride, FIRST_STRIDE_FEATURE + feature] += rng.normal(0.0, deviation, n)[has_stride]
    noisy[rng.random(n) < STRIDE_DROPOUT, FIRST_STRIDE_FEATURE:] = 0.0
    noisy[rng.random(n) < TRACK_DROPOUT, FIRST_TRACK_FEATURE:] = 0.0
    return noisy


def rounded_row(values: Floats) -> Row:
    """Return the values rounded as in the file of the model."""
    return tuple([float(f"{value:.5g}") for value in values.tolist()])


def to_json(model: MotionModel) -> str:
    """Return the model in the form that `load_released_model` reads, with a line for each row of numbers."""
    fields = attrs.asdict(model, value_serializer=lambda _, __, value: getattr(value, "value", value))
    return re.sub(r"\[[^][]*\]", lambda row: json.dumps(json.loads(row[0])), json.dumps(fields, indent=1)) + "\n"
