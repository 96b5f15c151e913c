"""Parameters of the motion model: two small neural networks, and the statistics of their training data.

votes.py turns one foot's features into the probability of each motion with them.

Each network has one hidden layer of tanh units and softmax outputs. One network uses all features; the other one serves
feet without a gyroscope. `solepath.lab.train.activities` trains them and lists the training data. The result is
activities.json in this directory. The file also has the transition chances and label delays that chain.py uses.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, cached_property
from math import fsum
from operator import truediv
from typing import Any

from ....types import Activity
from ....types.attrs import frozen
from ..chain import Chain, Chances, Shifts, chain_of
from .features import FEATURE_COUNT, FIRST_GYRO_FEATURE

MOTIONS = ("still", "walking", "running", "stairs_up", "stairs_down")
"""Motions that one foot's samples can distinguish, in the order of the network outputs.

"still" is standing and riding in an elevator."""

Row = tuple[float, ...]


@frozen
class Network:
    """A neural network with one hidden layer."""

    hidden: tuple[Row, ...]
    """Weights of the hidden layer, one row for each unit."""
    hidden_bias: Row
    output: tuple[Row, ...]
    """Weights of the output layer, one row for each of `MOTIONS`."""
    output_bias: Row

    @cached_property
    def hidden_half(self) -> Row:
        """Bias of each hidden unit plus half the squared length of its weights (votes.py)."""
        return _with_half_squares(self.hidden, self.hidden_bias)

    @cached_property
    def output_half(self) -> Row:
        """Bias of each output unit plus half the squared length of its weights."""
        return _with_half_squares(self.output, self.output_bias)


@frozen
class MotionModel:
    """The learnt parameters: two networks, statistics of the features, chances and delays of the chain."""

    trained_on: str
    """Description of the training data, one sentence."""
    whole: Network
    """Network for all `FEATURE_COUNT` features, used with a gyroscope."""
    alone: Network
    """Network for the first `FIRST_GYRO_FEATURE` features, used without a gyroscope."""
    usual: tuple[Row, ...]
    """Means of the first `FIRST_GYRO_FEATURE` features, one row for each of `MOTIONS`."""
    spread: tuple[Row, ...]
    """Standard deviations of the first `FIRST_GYRO_FEATURE` features, one row for each of `MOTIONS`."""
    chances: Chances
    shifts: Shifts

    @cached_property
    def middles(self) -> tuple[Row, ...]:
        """Rows of `usual` divided by the rows of `spread`."""
        return tuple([tuple(map(truediv, *rows)) for rows in zip(self.usual, self.spread, strict=True)])

    @cached_property
    def chain(self) -> Chain:
        """Chain of activities with the learnt chances and delays."""
        return chain_of(self.chances, self.shifts)


@cache
def load_released_model() -> MotionModel:
    """Return the model of this release, which is read from activities.json once."""
    import json
    from pkgutil import get_data

    return from_json(json.loads(get_data(__package__, "activities.json") or b""))


def from_json(data: dict[str, Any]) -> MotionModel:
    """Return the model from the content of activities.json.

    Raises ValueError when the model does not fit the features of this release."""
    model = MotionModel(
        trained_on=str(data["trained_on"]),
        whole=_network(data["whole"], FEATURE_COUNT),
        alone=_network(data["alone"], FIRST_GYRO_FEATURE),
        usual=_rows(data["usual"]),
        spread=_rows(data["spread"]),
        chances=_rows(data["chances"]),
        shifts=tuple([(Activity(a), Activity(b), float(shift)) for a, b, shift in data["shifts"]]),
    )
    if [len(row) for row in model.chances] != [len(MOTIONS)] * len(MOTIONS):
        raise ValueError("chances of other motions do not fit")
    return model


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


def _row(data: Sequence[Any]) -> Row:
    return tuple([float(value) for value in data])


def _rows(data: Sequence[Sequence[Any]]) -> tuple[Row, ...]:
    return tuple([_row(row) for row in data])


def _with_half_squares(rows: Sequence[Row], bias: Row) -> Row:
    return tuple([b + 0.5 * fsum([w * w for w in row]) for row, b in zip(rows, bias, strict=True)])
