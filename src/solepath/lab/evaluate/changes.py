"""What became of every figure since an earlier evaluation: its JSON beside today's.

Which way a figure is better is a property of the figure: errors, spreads and inventions the smaller, biases the nearer
to zero, F1 and shares found the larger. Counts of what is true, lengths of ways and others' figures are neither. Two
figures that agree in DIGITS significant digits are the same.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from enum import Enum
from math import isfinite
from pathlib import Path
from typing import Any

from attrs import frozen

from ...recording import RecordingError
from ..measures.confusion import CLASSES

DIGITS = 3


class Better(Enum):
    """Which way a figure is better."""

    LESS = "less"
    NEARER_ZERO = "nearer to zero"
    MORE = "more"


_LESS = (
    "armse_2d", "rms_2d", "rms_3d", "rms_z", "relative", "position_mean", "position_end", "position_max",
    "end_error", "end_error_2d", "end_height", "end_relative", "largest_relative", "height_end", "height_max",
    "strides_invented", "stride_error", "stride_error_median", "stride_error_track", "heel_strike_mad",
    "heel_strike_off", "toe_off_mad", "toe_off_off", "stride_time_error", "stride_time_error_median", "leg_error",
    "leg_error_median", "body_leg_error", "body_leg_error_median", "leg_spread", "uturn_angle", "uturn_invented",
    "rides_invented", "level_called",
)  # fmt: skip
_NEARER_ZERO = ("heel_strike_bias", "toe_off_bias", "stride_time_bias", "leg_bias", "body_leg_bias")
_MORE = (
    "strides_found", "heel_strike_f1", "toe_off_f1", "authors_beaten", "uturn_found", "accuracy", "rides_found",
    "stairs_called", "stairs_direction", *(f"f1_{activity.value.lower()}" for activity in CLASSES),
)  # fmt: skip
BETTER: dict[str, Better] = {
    **dict.fromkeys(_LESS, Better.LESS),
    **dict.fromkeys(_NEARER_ZERO, Better.NEARER_ZERO),
    **dict.fromkeys(_MORE, Better.MORE),
}
"""By a figure's name in JSON; one that is not here is better neither way."""


class Verdict(Enum):
    BETTER = "better"
    WORSE = "worse"
    SAME = "the same"
    CHANGED = "changed"
    """Better neither way, or known on one side only."""


def verdict(figure: str, was: float | None, now: float | None) -> Verdict:
    """On one figure; None is one that could not be measured."""
    if was is None or now is None:
        return Verdict.SAME if was is now else Verdict.CHANGED
    way = BETTER.get(figure)
    if way is Better.NEARER_ZERO:
        was, now = abs(was), abs(now)
    if f"{was:.{DIGITS}g}" == f"{now:.{DIGITS}g}":
        return Verdict.SAME
    if way is None:
        return Verdict.CHANGED
    return Verdict.BETTER if (now > was) is (way is Better.MORE) else Verdict.WORSE


@frozen
class Change:
    """One figure of `what` (a recording, or the mean, median or pooled figure of a group), then and now."""

    what: str
    figure: str
    was: float | None
    now: float | None

    @property
    def verdict(self) -> Verdict:
        return verdict(self.figure, self.was, self.now)


@frozen
class Changes:
    """Of one recipe on one data set."""

    recipe: str
    data_set: str
    changes: tuple[Change, ...]
    removed: tuple[str, ...]
    """Recordings of then that were not scored now."""
    new: tuple[str, ...]
    """Recordings that were not scored then."""


Scores = dict[str, dict[str, Any]]
"""Of an evaluation, as report.as_json makes it."""


def read_scores(path: Path) -> Scores:
    """The JSON of an earlier evaluation. RecordingError when it is none."""
    try:
        told = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RecordingError(path, error.strerror or "cannot be read") from None
    except (ValueError, RecursionError):
        raise RecordingError(path, "is not JSON") from None
    try:
        for data_sets in told.values():
            for part in data_sets.values():
                for _, figures in _rows(part):
                    if not all(value is None or isfinite(value) for value in figures.values()):
                        raise TypeError
    except (AttributeError, KeyError, OverflowError, TypeError):
        raise RecordingError(path, "does not hold the scores of an evaluation") from None
    scores: Scores = told
    return scores


def _rows(part: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, float | None]]]:
    """Every row of figures of one data set, by what it is of: of the groups first."""
    for group, summary in part["summary"].items():
        of = "" if group == "all" else f" {group}"
        for kind in ("mean", "median", "together"):
            yield f"{kind}{of}", summary[kind]
    yield from part["recordings"].items()


def compared(was: Scores, now: Scores) -> list[Changes]:
    """Each data set of each recipe that is in both, in the order of `now`."""
    found: list[Changes] = []
    for recipe, data_sets in now.items():
        for name, part in data_sets.items():
            before = was.get(recipe, {}).get(name)
            if before is None:
                continue
            old = dict(_rows(before))
            changes = [
                Change(what, figure, old[what].get(figure), figures.get(figure))
                for what, figures in _rows(part)
                if what in old
                for figure in dict.fromkeys([*figures, *old[what]])
            ]
            then, today = before["recordings"], part["recordings"]
            removed, new = (tuple(x for x in a if x not in b) for a, b in ((then, today), (today, then)))
            found.append(Changes(recipe, name, tuple(changes), removed, new))
    return found


def missing(of: Scores, other: Scores) -> list[str]:
    """What of the recipes and data sets of the one is not in the other: `recipe` or `recipe: data set`."""
    found: list[str] = []
    for recipe, data_sets in of.items():
        if recipe not in other:
            found.append(recipe)
        else:
            found += [f"{recipe}: {name}" for name in data_sets if name not in other[recipe]]
    return found
