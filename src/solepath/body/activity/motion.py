"""From one foot's features to how likely each way of moving is: a small network, evaluated in plain Python.

One hidden layer of tanh, outputs that add up to 1 (softmax). It was trained by `solepath.train.activities`, which also
says what on; what it learnt is activities.json beside this file.

How like anything that it was trained on the features are is said by `strangeness`: each way of moving has a mean and a
deviation for every feature, and the strangeness is the mean square of deviations from the nearest.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from math import exp, log, tanh
from typing import Any

from attrs import frozen

from .features import COUNT, GYRO

MOTIONS = ("still", "walking", "running", "stairs_up", "stairs_down")
"""What a foot's own samples tell apart, in the order of the outputs. Still is standing, and riding in a lift too."""

Row = tuple[float, ...]


@frozen
class MotionModel:
    """All that was learnt. `hidden` and `output`: a row of weights for each unit, `COUNT` and `len(hidden)` long."""

    trained_on: str
    """In a sentence."""
    hidden: tuple[Row, ...]
    hidden_bias: Row
    output: tuple[Row, ...]
    """One for each of `MOTIONS`."""
    output_bias: Row
    usual: tuple[Row, ...]
    """Mean of the features that need an accelerometer only, for each of `MOTIONS`,"""
    spread: tuple[Row, ...]
    """and their deviation."""

    def log_probabilities(self, features: Sequence[float]) -> list[float]:
        """Of each of `MOTIONS`, natural logarithms; the exponentials add up to 1."""
        inner = [
            tanh(bias + sum([w * x for w, x in zip(row, features, strict=True)]))
            for row, bias in zip(self.hidden, self.hidden_bias, strict=True)
        ]
        outer = [
            bias + sum([w * x for w, x in zip(row, inner, strict=True)])
            for row, bias in zip(self.output, self.output_bias, strict=True)
        ]
        highest = max(outer)
        total = highest + log(sum([exp(value - highest) for value in outer]))
        return [value - total for value in outer]

    def strangeness(self, features: Sequence[float]) -> float:
        """1 for what is as usual, 4 for what is two deviations off in every feature of the accelerometer."""
        return min(
            [
                sum([((x - m) / s) ** 2 for x, m, s in zip(features, means, deviations, strict=False)])
                for means, deviations in zip(self.usual, self.spread, strict=True)
            ]
        ) / GYRO


@cache
def shipped() -> MotionModel:
    """The model that comes with this release."""
    return from_json(json.loads(files(__package__).joinpath("activities.json").read_text(encoding="utf-8")))


def from_json(told: dict[str, Any]) -> MotionModel:
    """The model of what activities.json holds. ValueError when it does not fit the features of this release."""
    model = MotionModel(
        trained_on=str(told["trained_on"]),
        hidden=_rows(told["hidden"]),
        hidden_bias=_row(told["hidden_bias"]),
        output=_rows(told["output"]),
        output_bias=_row(told["output_bias"]),
        usual=_rows(told["usual"]),
        spread=_rows(told["spread"]),
    )
    if len(model.output) != len(MOTIONS) or any([len(row) != COUNT for row in model.hidden]):
        raise ValueError(f"a model of {len(model.output)} motions and {len(model.hidden[0])} features does not fit")
    return model


def to_json(model: MotionModel) -> dict[str, Any]:
    """What `from_json` reads."""
    return {
        "trained_on": model.trained_on,
        "hidden": [list(row) for row in model.hidden],
        "hidden_bias": list(model.hidden_bias),
        "output": [list(row) for row in model.output],
        "output_bias": list(model.output_bias),
        "usual": [list(row) for row in model.usual],
        "spread": [list(row) for row in model.spread],
    }


def _row(told: Sequence[Any]) -> Row:
    return tuple([float(value) for value in told])


def _rows(told: Sequence[Sequence[Any]]) -> tuple[Row, ...]:
    return tuple([_row(row) for row in told])
