"""Compares the figures of an evaluation with those in the JSON file of an earlier one.

The better direction depends on the figure. Errors, spreads and numbers of invented events should be small. Biases
should be near zero. F1 and shares found should be large. Numbers of true events, path lengths and other people's
results have no better direction. Two figures that agree in DIGITS significant digits are the same."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from enum import Enum
from math import isfinite
from pathlib import Path
from typing import Any

from attrs import frozen

from solepath.recording import RecordingError
from solepath.saving.files import FileTooLarge, read_bounded

from ..measures.confusion import CHECKS, CLASSES

DIGITS = 3
"""Number of significant digits to which figures are compared."""


class Better(Enum):
    """Direction in which a figure is better."""

    LESS = "less"
    NEARER_ZERO = "nearer to zero"
    MORE = "more"


_LESS = (
    "armse_2d", "rms_2d", "rms_3d", "rms_z", "relative", "position_mean", "position_end", "position_max",
    "end_error", "end_error_2d", "end_height", "end_relative", "largest_relative", "height_end", "height_max",
    "strides_invented", "stride_error", "stride_error_median", "stride_error_track", "heel_strike_mad",
    "heel_strike_scatter", "heel_strike_off", "toe_off_mad", "toe_off_scatter", "toe_off_off", "stride_time_error",
    "stride_time_error_median", "leg_error", "leg_error_median", "body_leg_error", "body_leg_error_median",
    "leg_spread", "uturn_angle", "uturn_invented", "rides_invented", "level_called", "heading_end", "radius_error",
    "drift", "drift_left", "drift_right", "drift_stride", "end_without", "end_return", "way_places",
)  # fmt: skip
_NEARER_ZERO = ("heel_strike_bias", "toe_off_bias", "stride_time_bias", "leg_bias", "body_leg_bias")
_MORE = (
    "strides_found", "heel_strike_f1", "toe_off_f1", "authors_beaten", "uturn_found", "accuracy", *CHECKS,
    "rides_found",
    "stairs_called", "stairs_direction",
    "rejected_first", "rejected_later", "used", *(f"f1_{activity.value.lower()}" for activity in CLASSES),
)  # fmt: skip
BETTER: dict[str, Better] = {
    **dict.fromkeys(_LESS, Better.LESS),
    **dict.fromkeys(_NEARER_ZERO, Better.NEARER_ZERO),
    **dict.fromkeys(_MORE, Better.MORE),
}
"""Better direction by the figure's name in JSON. Figures that are not listed have no better direction."""


class Verdict(Enum):
    """Result of comparing a figure with its earlier value."""

    BETTER = "better"
    WORSE = "worse"
    SAME = "the same"
    CHANGED = "changed"
    """The figure changed and has no better direction, or only one of the two evaluations has it."""


def verdict(figure: str, earlier: float | None, present: float | None) -> Verdict:
    """Return the verdict on one figure; None stands for a figure that could not be measured."""
    if earlier is None or present is None:
        return Verdict.SAME if earlier is present else Verdict.CHANGED
    direction = BETTER.get(figure)
    if direction is Better.NEARER_ZERO:
        earlier, present = abs(earlier), abs(present)
    if f"{earlier:.{DIGITS}g}" == f"{present:.{DIGITS}g}":
        return Verdict.SAME
    if direction is None:
        return Verdict.CHANGED
    return Verdict.BETTER if (present > earlier) is (direction is Better.MORE) else Verdict.WORSE


@frozen
class Change:
    """The earlier and present value of one figure."""

    row: str
    """Name of a recording, or a key of SUMMARY_ROWS with the name of a group."""
    figure: str
    """Name of the figure in JSON."""
    earlier: float | None
    present: float | None

    @property
    def verdict(self) -> Verdict:
        """Verdict on the present value."""
        return verdict(self.figure, self.earlier, self.present)


@frozen
class Changes:
    """The changes of the figures of one recipe on one data set."""

    recipe: str
    data_set: str
    changes: tuple[Change, ...]
    removed: tuple[str, ...]
    """Recordings that were scored earlier and are not scored now."""
    new: tuple[str, ...]
    """Recordings that are scored now and were not scored earlier."""


Scores = dict[str, dict[str, Any]]
"""Scores of an evaluation in the form that report.as_json returns."""
MAX_FILE_SIZE = 64_000_000
"""Largest size of a file of scores, bytes: some ten times that of all recipes on all data sets."""
SUMMARY_ROWS = {"mean": "mean", "median": "median", "pooled": "together"}
"""Key in JSON of each row of a group's summary."""


def read_scores(path: Path) -> Scores:
    """Return the scores in the JSON file of an earlier evaluation. Raise RecordingError when it holds none."""
    try:
        document = json.loads(read_bounded(path, MAX_FILE_SIZE))
    except OSError as error:
        raise RecordingError(path, error.strerror or "cannot be read") from None
    except FileTooLarge as error:
        raise RecordingError(path, f"{error}, too large for scores") from None
    except (ValueError, RecursionError):
        raise RecordingError(path, "is not JSON") from None
    try:
        for data_sets in document.values():
            for part in data_sets.values():
                for _, figures in _rows(part):
                    if not all(value is None or isfinite(value) for value in figures.values()):
                        raise TypeError
    except (AttributeError, KeyError, OverflowError, TypeError):
        raise RecordingError(path, "does not hold the scores of an evaluation") from None
    scores: Scores = document
    return scores


def _rows(part: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, float | None]]]:
    """Yield name and figures of each row of one data set: first the groups, then the recordings."""
    for group, summary in part["summary"].items():
        of = "" if group == "all" else f" {group}"
        for row, key in SUMMARY_ROWS.items():
            yield f"{row}{of}", summary[key]
    yield from part["recordings"].items()


def compare_scores(earlier: Scores, present: Scores) -> list[Changes]:
    """Return the changes of each data set of each recipe that is in both evaluations, in the order of `present`."""
    found: list[Changes] = []
    for recipe, data_sets in present.items():
        for name, part in data_sets.items():
            before = earlier.get(recipe, {}).get(name)
            if before is None:
                continue
            old = dict(_rows(before))
            changes = [
                Change(row, figure, old[row].get(figure), figures.get(figure))
                for row, figures in _rows(part)
                if row in old
                for figure in dict.fromkeys([*figures, *old[row]])
            ]
            then, today = before["recordings"], part["recordings"]
            removed, new = (tuple(x for x in a if x not in b) for a, b in ((then, today), (today, then)))
            found.append(Changes(recipe, name, tuple(changes), removed, new))
    return found


def names_missing(scores: Scores, other: Scores) -> list[str]:
    """Return the recipes and data sets of `scores` that `other` lacks, as `recipe` or `recipe: data set`."""
    found: list[str] = []
    for recipe, data_sets in scores.items():
        if recipe not in other:
            found.append(recipe)
        else:
            found += [f"{recipe}: {name}" for name in data_sets if name not in other[recipe]]
    return found
