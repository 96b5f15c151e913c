"""Motion model: from one foot's features to the probability of each motion, by two small networks in plain Python.

Each has one hidden layer of tanh and outputs that add up to 1 (softmax); a foot without a gyroscope has a network of
its own. `solepath.lab.train.activities` trains them and lists the training data; the result is activities.json beside
this file. It also holds the durations of activities and the shifts of labels, which chain.py uses.

`strangeness` is the distance of the features from the training data: each motion has a mean and a deviation for every
feature, and the strangeness is the mean square of deviations from the nearest.

math.dist is the one loop over floats that runs in C in every Python from 3.11 on, three times as fast as sum(map(mul,
...)) and exact to the last bit, so sums of products use it: w x = (w w + x x - |w - x|^2) / 2. That is off by 1e-12 at
the most, and its results are rounded to 1e-4 (hypotheses.py)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, cached_property
from math import dist, exp, hypot, log, tanh
from operator import truediv
from typing import Any

from ...types import Activity
from ...types.attrs import frozen
from .chain import Chain, Chances, Shifts, chain_of
from .features import COUNT, GYRO

MOTIONS = ("still", "walking", "running", "stairs_up", "stairs_down")
"""Motions that a foot's own samples distinguish, in the order of the outputs.

Still is standing, and also riding in a lift."""

Row = tuple[float, ...]


@frozen
class Network:
    """A network of one hidden layer; `hidden` and `output` have a row of weights for each unit."""

    hidden: tuple[Row, ...]
    hidden_bias: Row
    output: tuple[Row, ...]
    """One row of weights for each of `MOTIONS`."""
    output_bias: Row

    @cached_property
    def hidden_half(self) -> Row:
        """Bias of each hidden unit plus w w / 2 of its weights w."""
        return _with_half_squares(self.hidden, self.hidden_bias)

    @cached_property
    def output_half(self) -> Row:
        """Bias of each output unit plus w w / 2 of its weights w."""
        return _with_half_squares(self.output, self.output_bias)

    def log_probabilities(self, features: Sequence[float]) -> list[float]:
        """Return the natural logarithm of the probability of each of `MOTIONS`.

        Features without weights do not count."""
        given = tuple(features[: len(self.hidden[0])])
        inner = tuple([tanh(value) for value in _weighted_sums(self.hidden, self.hidden_half, given)])
        outer = _weighted_sums(self.output, self.output_half, inner)
        highest = max(outer)
        total = highest + log(sum([exp(value - highest) for value in outer]))
        return [value - total for value in outer]


@frozen
class MotionModel:
    """The parameters that were learnt."""

    trained_on: str
    """Description of the training data, one sentence."""
    whole: Network
    """Network for all `COUNT` features."""
    alone: Network
    """Network for the first `GYRO` features, of a foot without a gyroscope."""
    usual: tuple[Row, ...]
    """Mean of the features that need only an accelerometer, for each of `MOTIONS`."""
    spread: tuple[Row, ...]
    """Standard deviation of the same features, for each of `MOTIONS`."""
    chances: Chances
    shifts: Shifts

    @cached_property
    def middles(self) -> tuple[Row, ...]:
        """Means as multiples of the deviations."""
        return tuple([tuple(map(truediv, *rows)) for rows in zip(self.usual, self.spread, strict=True)])

    def log_probabilities(self, features: Sequence[float]) -> list[float]:
        """Return the natural logarithm of the probability of each of `MOTIONS`."""
        return (self.whole if features[GYRO] else self.alone).log_probabilities(features)

    def strangeness(self, features: Sequence[float]) -> float:
        """Return the strangeness of the features: 1 is usual, 4 is two deviations in every accelerometer feature."""
        given = features[:GYRO]
        away = [
            dist(tuple(map(truediv, given, spread)), middle)
            for spread, middle in zip(self.spread, self.middles, strict=True)
        ]
        nearest = min(away)
        return nearest * nearest / GYRO

    @property
    def chain(self) -> Chain:
        """Chain of activities with the learnt chances and shifts."""
        return chain_of(self.chances, self.shifts)


@cache
def shipped() -> MotionModel:
    """Return the model of this release; it is read once, when a part that needs it is first made ready."""
    import json
    from pkgutil import get_data

    return from_json(json.loads(get_data(__package__, "activities.json") or b""))


def from_json(data: dict[str, Any]) -> MotionModel:
    """Return the model in the content of activities.json.

    Raises ValueError when it does not fit the features of this release."""
    model = MotionModel(
        trained_on=str(data["trained_on"]),
        whole=_network(data["whole"], COUNT),
        alone=_network(data["alone"], GYRO),
        usual=_rows(data["usual"]),
        spread=_rows(data["spread"]),
        chances=_rows(data["chances"]),
        shifts=tuple([(Activity(a), Activity(b), float(shift)) for a, b, shift in data["shifts"]]),
    )
    if [len(row) for row in model.chances] != [len(MOTIONS)] * len(MOTIONS):
        raise ValueError("chances of other motions do not fit")
    return model


def to_json(model: MotionModel) -> dict[str, Any]:
    """Return the model in the form that `from_json` reads."""
    return {
        "trained_on": model.trained_on,
        "whole": _network_json(model.whole),
        "alone": _network_json(model.alone),
        "usual": [list(row) for row in model.usual],
        "spread": [list(row) for row in model.spread],
        "chances": [list(row) for row in model.chances],
        "shifts": [[a.value, b.value, shift] for a, b, shift in model.shifts],
    }


def _network(data: dict[str, Any], count: int) -> Network:
    network = Network(
        hidden=_rows(data["hidden"]),
        hidden_bias=_row(data["hidden_bias"]),
        output=_rows(data["output"]),
        output_bias=_row(data["output_bias"]),
    )
    if len(network.output) != len(MOTIONS) or any([len(row) != count for row in network.hidden]):
        raise ValueError(f"a network of {len(network.output)} motions and {len(network.hidden[0])} features")
    return network


def _network_json(network: Network) -> dict[str, Any]:
    return {
        "hidden": [list(row) for row in network.hidden],
        "hidden_bias": list(network.hidden_bias),
        "output": [list(row) for row in network.output],
        "output_bias": list(network.output_bias),
    }


def _row(data: Sequence[Any]) -> Row:
    return tuple([float(value) for value in data])


def _rows(data: Sequence[Sequence[Any]]) -> tuple[Row, ...]:
    return tuple([_row(row) for row in data])


def _with_half_squares(rows: Sequence[Row], bias: Row) -> Row:
    return tuple([b + 0.5 * sum([w * w for w in row]) for row, b in zip(rows, bias, strict=True)])


def _weighted_sums(rows: Sequence[Row], half: Row, given: Row) -> list[float]:
    """Return bias + w x of each row."""
    length = hypot(*given)
    square = 0.5 * length * length
    return [
        constant + square - 0.5 * (away := dist(row, given)) * away for row, constant in zip(rows, half, strict=True)
    ]
