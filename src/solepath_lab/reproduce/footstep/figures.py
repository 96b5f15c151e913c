"""Panels of fig. 13 (a) to (h) and of fig. 15 of Liu et al. 2015."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import degrees

import numpy as np

from solepath.types import Turn

from ..tables import Bars, Panel, PictureTrack, Plot, Values, mean, pooled
from .activities import CLASSES, row_of_variant
from .turning import TURN_ANGLES

TWO_AND_ONE = ("two feet", "one foot")
"""Variants of the panels (f) to (h)."""


def panels(
    corridors: Sequence[Values], activities: Sequence[Values], turns: Sequence[Values], places: Sequence[Values]
) -> tuple[Panel, ...]:
    """Return the panels (a) and (c) to (h); single curves are of the first wearer."""
    shares = {
        name: tuple([mean(pooled(activities, row_of_variant(one.value, name))) for one in CLASSES])
        for name in ("ours", "printed")
    }
    angles = [round(degrees(angle)) for angle in TURN_ANGLES]
    by_angle = {
        name: zip(angles, mean_series(turns, f"turn angle, {name} deg"), strict=True) for name in ("ours", "printed")
    }
    errors = {name: sorted(pooled(corridors, f"step, {name} m")) for name in ("one foot", "two feet")}
    distributions = {name: zip(of, np.arange(1.0, len(of) + 1.0) / len(of), strict=True) for name, of in errors.items()}
    by_stride = {name: enumerate(pooled(places[:1], f"(by stride) {name}"), 1) for name in TWO_AND_ONE}
    # from the second turn on as in the paper, for turns that all made
    by_turn = {name: list(enumerate(mean_series(places, f"(by turn) {name}"), 1))[1:] for name in TWO_AND_ONE}
    users = {
        name: tuple([mean(pooled([one], f"place, case study, {row} m")) for one in places])
        for name, row in zip(TWO_AND_ONE, ("ours", "one foot"), strict=True)
    }
    classes = tuple([mean(pooled(turns, f"turn {turn.value} %")) for turn in Turn])
    return (
        Bars("activities (a)", tuple([one.value for one in CLASSES]), tuple(shares.items()), "windows right, %"),
        Plot("error of a stride length (c)", _tracks(distributions), "error, m", "CDF", (0.0, 1.0)),
        Plot("turn angle (d)", _tracks(by_angle), "turn, degrees", "mean error, degrees"),
        Bars("turn classes (e)", tuple([turn.value for turn in Turn]), (("ours", classes),), "turns right, %"),
        Plot("place by steps (f)", _tracks(by_stride), "step", "error, m"),
        Plot("place by turns (g)", _tracks(by_turn), "turn", "mean error, m"),
        Bars(
            "place by user (h)", tuple([str(k + 1) for k in range(len(places))]), tuple(users.items()), "mean error, m"
        ),
    )


def mean_series(walks: Sequence[Values], name: str) -> list[float]:
    """Return the means over walks of their first, second and further values, as far as all walks have them."""
    return [mean(values) for values in zip(*[one[name] for one in walks], strict=False)]


def _tracks(points: Mapping[str, Iterable[tuple[float, float]]]) -> tuple[PictureTrack, ...]:
    return tuple([PictureTrack(name, [(float(x), float(y)) for x, y in of]) for name, of in points.items()])
