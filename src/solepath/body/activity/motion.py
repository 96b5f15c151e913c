"""From one foot's features to how likely each way of moving is: two small networks, evaluated in plain Python.

One hidden layer of tanh, outputs that add up to 1 (softmax); a foot without a gyroscope has a network of its own. They
were trained by `solepath.lab.train.activities`, which also says what on; what it learnt is activities.json beside this
file. How long things last and when labels change belong to it as well: chain.py says what for.

How like anything that it was trained on the features are is said by `strangeness`: each way of moving has a mean and a
deviation for every feature, and the strangeness is the mean square of deviations from the nearest.

math.dist is the one loop over floats that runs in C in every Python from 3.11 on, three times as fast as
sum(map(mul, ...)) and exact to the last bit, so sums of products are taken from it: w x = (w w + x x - |w - x|^2) / 2.
That is off by 1e-12 at the most, and what is made of it is rounded to 1e-4 (hypotheses.py).
"""

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
"""What a foot's own samples tell apart, in the order of the outputs. Still is standing, and riding in a lift too."""

Row = tuple[float, ...]


@frozen
class Network:
    """`hidden` and `output`: a row of weights for each unit."""

    hidden: tuple[Row, ...]
    hidden_bias: Row
    output: tuple[Row, ...]
    """One for each of `MOTIONS`."""
    output_bias: Row

    @cached_property
    def hidden_half(self) -> Row:
        """The bias of each unit with w w / 2 of its weights w."""
        return _with_half_squares(self.hidden, self.hidden_bias)

    @cached_property
    def output_half(self) -> Row:
        """The same of the outputs."""
        return _with_half_squares(self.output, self.output_bias)

    def log_probabilities(self, features: Sequence[float]) -> list[float]:
        """Of each of `MOTIONS`, natural logarithms; the exponentials add up to 1. What the network has no weights for
        does not count."""
        given = tuple(features[: len(self.hidden[0])])
        inner = tuple([tanh(value) for value in _weighed(self.hidden, self.hidden_half, given)])
        outer = _weighed(self.output, self.output_half, inner)
        highest = max(outer)
        total = highest + log(sum([exp(value - highest) for value in outer]))
        return [value - total for value in outer]


@frozen
class MotionModel:
    """All that was learnt."""

    trained_on: str
    """In a sentence."""
    whole: Network
    """Of all `COUNT` features."""
    alone: Network
    """Of the first `GYRO`, for a foot without a gyroscope."""
    usual: tuple[Row, ...]
    """Mean of the features that need an accelerometer only, for each of `MOTIONS`,"""
    spread: tuple[Row, ...]
    """and their deviation."""
    chances: Chances
    shifts: Shifts

    @cached_property
    def middles(self) -> tuple[Row, ...]:
        """The means as multiples of the deviations."""
        return tuple([tuple(map(truediv, *rows)) for rows in zip(self.usual, self.spread, strict=True)])

    def log_probabilities(self, features: Sequence[float]) -> list[float]:
        """Of each of `MOTIONS`, as `Network` says."""
        return (self.whole if features[GYRO] else self.alone).log_probabilities(features)

    def strangeness(self, features: Sequence[float]) -> float:
        """1 for what is as usual, 4 for what is two deviations off in every feature of the accelerometer."""
        given = features[:GYRO]
        away = [
            dist(tuple(map(truediv, given, spread)), middle)
            for spread, middle in zip(self.spread, self.middles, strict=True)
        ]
        nearest = min(away)
        return nearest * nearest / GYRO

    @property
    def chain(self) -> Chain:
        """How what is done goes on."""
        return chain_of(self.chances, self.shifts)


@cache
def shipped() -> MotionModel:
    """The model that comes with this release; read once, when a part that needs it is first made ready."""
    import json
    from pkgutil import get_data

    return from_json(json.loads(get_data(__package__, "activities.json") or b""))


def from_json(told: dict[str, Any]) -> MotionModel:
    """The model of what activities.json holds. ValueError when it does not fit the features of this release."""
    model = MotionModel(
        trained_on=str(told["trained_on"]),
        whole=_network(told["whole"], COUNT),
        alone=_network(told["alone"], GYRO),
        usual=_rows(told["usual"]),
        spread=_rows(told["spread"]),
        chances=_rows(told["chances"]),
        shifts=tuple([(Activity(a), Activity(b), float(shift)) for a, b, shift in told["shifts"]]),
    )
    if [len(row) for row in model.chances] != [len(MOTIONS)] * len(MOTIONS):
        raise ValueError("chances of other motions do not fit")
    return model


def to_json(model: MotionModel) -> dict[str, Any]:
    """What `from_json` reads."""
    return {
        "trained_on": model.trained_on,
        "whole": _told(model.whole),
        "alone": _told(model.alone),
        "usual": [list(row) for row in model.usual],
        "spread": [list(row) for row in model.spread],
        "chances": [list(row) for row in model.chances],
        "shifts": [[a.value, b.value, shift] for a, b, shift in model.shifts],
    }


def _network(told: dict[str, Any], count: int) -> Network:
    network = Network(
        hidden=_rows(told["hidden"]),
        hidden_bias=_row(told["hidden_bias"]),
        output=_rows(told["output"]),
        output_bias=_row(told["output_bias"]),
    )
    if len(network.output) != len(MOTIONS) or any([len(row) != count for row in network.hidden]):
        raise ValueError(f"a network of {len(network.output)} motions and {len(network.hidden[0])} features")
    return network


def _told(network: Network) -> dict[str, Any]:
    return {
        "hidden": [list(row) for row in network.hidden],
        "hidden_bias": list(network.hidden_bias),
        "output": [list(row) for row in network.output],
        "output_bias": list(network.output_bias),
    }


def _row(told: Sequence[Any]) -> Row:
    return tuple([float(value) for value in told])


def _rows(told: Sequence[Sequence[Any]]) -> tuple[Row, ...]:
    return tuple([_row(row) for row in told])


def _with_half_squares(rows: Sequence[Row], bias: Row) -> Row:
    return tuple([b + 0.5 * sum([w * w for w in row]) for row, b in zip(rows, bias, strict=True)])


def _weighed(rows: Sequence[Row], half: Row, given: Row) -> list[float]:
    """bias + w x of each row."""
    length = hypot(*given)
    square = 0.5 * length * length
    return [
        constant + square - 0.5 * (away := dist(row, given)) * away for row, constant in zip(rows, half, strict=True)
    ]
