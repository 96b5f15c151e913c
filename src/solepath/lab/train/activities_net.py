"""The small networks of `Activities`: one hidden layer, fitted by stochastic gradient descent (Adam: Kingma, Ba 2015).

The features of the track and of the steps are hidden from the network for some blocks in every pass, so that it works
without them. The features of the steps are also disturbed by as much as tracks of clipping accelerometers are wrong."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...body.activity.features import GYRO, STRIDE, TRACK
from ...body.activity.motion import MOTIONS, Network, Row
from ...types import Activity

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
"""Output of the network for each activity: a foot in a lift stands."""
HIDDEN = 24
EPOCHS = 15
BATCH = 512
RATE = 3e-3
DECAY = 1e-3
WITHOUT_TRACK, WITHOUT_STEP = 0.1, 0.2
"""Shares of blocks in a pass without the features of the track, and without those of the step."""
LEAST_SPREAD = 0.02


def weights(classes: Numbers, wearers: Numbers) -> Floats:
    """Return the weight of each block: 1 over the root of the number of blocks of its class and wearer.

    So a class of a wearer counts by that root, and neither the rare nor the frequent classes alone decide."""
    found = np.ones(len(classes))
    for wearer in np.unique(wearers):
        for k in range(len(MOTIONS)):
            those = (wearers == wearer) & (classes == k)
            if those.any():
                found[those] = 1.0 / np.sqrt(those.sum())
    return np.asarray(found / found.mean())


def networks(features: Floats, classes: Numbers, wearers: Numbers) -> tuple[Network, Network]:
    """Return the network of feet with a gyroscope, and that of the accelerometer alone.

    `features` are (n, COUNT), `classes` (n) as in CLASSES, `wearers` (n)."""
    turned = features[:, GYRO] > 0.0
    whole = learn(features[turned], classes[turned], wearers[turned])
    return whole, learn(features[:, :GYRO], classes, wearers)


def learn(features: Floats, classes: Numbers, wearers: Numbers, seed: int = 0) -> Network:
    """Return the network that is fitted to these blocks."""
    rng = np.random.default_rng(seed)
    weight = weights(classes, wearers)
    mean, spread = features.mean(0), features.std(0) + 0.01
    inputs = features.shape[1]
    shapes = ((inputs, HIDDEN), (HIDDEN,), (HIDDEN, len(MOTIONS)), (len(MOTIONS),))
    held = [rng.normal(0.0, shape[0] ** -0.5, shape) if len(shape) == 2 else np.zeros(shape) for shape in shapes]
    first, second = [np.zeros(shape) for shape in shapes], [np.zeros(shape) for shape in shapes]
    count = 0
    for epoch in range(EPOCHS):
        seen = ((disturbed(features, rng) if inputs > GYRO else features) - mean) / spread
        rate = RATE * 0.5 * (1.0 + np.cos(np.pi * epoch / EPOCHS))
        order = rng.permutation(len(seen))
        for start in range(0, len(order), BATCH):
            batch = order[start : start + BATCH]
            count += 1
            for k, slope in enumerate(_slopes(held, seen[batch], classes[batch], weight[batch])):
                first[k] += 0.1 * (slope - first[k])
                second[k] += 0.001 * (slope**2 - second[k])
                step = first[k] / (1.0 - 0.9**count) / (np.sqrt(second[k] / (1.0 - 0.999**count)) + 1e-8)
                held[k] -= rate * step
    hidden = held[0] / spread[:, None]
    return Network(
        hidden=tuple([row_of(row) for row in hidden.T]),
        hidden_bias=row_of(held[1] - mean @ hidden),
        output=tuple([row_of(row) for row in held[2].T]),
        output_bias=row_of(held[3]),
    )


def usual(features: Floats, classes: Numbers) -> tuple[tuple[Row, ...], tuple[Row, ...]]:
    """Return mean and deviation of the features of the accelerometer, for each of MOTIONS."""
    alone = [features[classes == k][:, :GYRO] for k in range(len(MOTIONS))]
    return (
        tuple([row_of(one.mean(0)) for one in alone]),
        tuple([row_of(np.maximum(one.std(0), LEAST_SPREAD)) for one in alone]),
    )


def _slopes(held: list[Floats], x: Floats, y: Numbers, weight: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the gradient of the weighted cross-entropy and of the decay of the weights."""
    inner = np.tanh(x @ held[0] + held[1])
    outer = inner @ held[2] + held[3]
    likely = np.exp(outer - outer.max(1, keepdims=True))
    likely /= likely.sum(1, keepdims=True)
    likely[np.arange(len(y)), y] -= 1.0
    likely *= weight[:, None] / len(y)
    back = (likely @ held[2].T) * (1.0 - inner**2)
    return (
        np.asarray(x.T @ back + DECAY * held[0]),
        np.asarray(back.sum(0)),
        np.asarray(inner.T @ likely + DECAY * held[2]),
        np.asarray(likely.sum(0)),
    )


def disturbed(features: Floats, rng: np.random.Generator) -> Floats:
    """Return the features with errors as other sensors might have them."""
    found = features.copy()
    n = len(found)
    stepped = found[:, STRIDE] > 0.0
    for column, size in ((2, 0.12), (5, 0.06), (6, 0.05)):
        found[stepped, STRIDE + column] *= np.exp(rng.normal(0.0, size, n))[stepped]
    for column, size in ((3, 0.08), (4, 0.05), (8, 0.05), (9, 0.05), (10, 0.05)):
        found[stepped, STRIDE + column] += rng.normal(0.0, size, n)[stepped]
    found[rng.random(n) < WITHOUT_STEP, STRIDE:] = 0.0
    found[rng.random(n) < WITHOUT_TRACK, TRACK:] = 0.0
    return found


def row_of(values: Floats) -> Row:
    """Return the values rounded as in the file of the model."""
    return tuple([float(f"{value:.5g}") for value in values.tolist()])
