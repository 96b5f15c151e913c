"""Compares the figures of an evaluation with those in the JSON file of an earlier one.

tables/columns.csv has the better direction of each figure. Two figures that agree in DIGITS significant digits are
the same."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Container, Iterable, Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from solepath.recording import RecordingError
from solepath.saving.files import FileTooLarge, read_bounded
from solepath.show.tables.table import table

from ..tables.columns import FIGURES

DIGITS = 3
"""Number of significant digits to which figures are compared."""
BETTER, WORSE, SAME, CHANGED = "better", "worse", "the same", "changed"
"""Verdicts on a figure; one that only changed has no better direction, or only one of the two evaluations has it."""
Scores = dict[str, dict[str, Any]]
"""Scores of an evaluation in the form that report.as_json returns."""
MAX_FILE_SIZE = 64_000_000
"""Largest size of a file of scores, bytes: some ten times that of all recipes on all data sets."""
SUMMARY_ROWS = {"mean": "mean", "median": "median", "pooled": "together"}
"""Key in JSON of each row of a group's summary."""


def verdict(figure: str, earlier: float | None, present: float | None) -> str:
    """Return the verdict on one figure; None stands for a figure that could not be measured."""
    if earlier is None or present is None:
        return SAME if earlier is present else CHANGED
    better = FIGURES[figure].better if figure in FIGURES else ""
    if better == "nearer to zero":
        earlier, present = abs(earlier), abs(present)
    if _format(earlier) == _format(present):
        return SAME
    if not better:
        return CHANGED
    return BETTER if (present > earlier) is (better == "more") else WORSE


def _format(value: float | None) -> str:
    return "-" if value is None else f"{value:.{DIGITS}g}"


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
                for figures in _rows(part).values():
                    if not all(value is None or isfinite(value) for value in figures.values()):
                        raise TypeError
    except (AttributeError, KeyError, OverflowError, TypeError):
        raise RecordingError(path, "does not hold the scores of an evaluation") from None
    scores: Scores = document
    return scores


def _rows(part: Mapping[str, Any]) -> dict[str, Mapping[str, float | None]]:
    """Return the figures of one data set by the name of their row: first the groups, then the recordings."""
    summaries = {
        row if group == "all" else f"{row} {group}": summary[key]
        for group, summary in part["summary"].items()
        for row, key in SUMMARY_ROWS.items()
    }
    return {**summaries, **part["recordings"]}


def comparison_tables(earlier: Scores, present: Scores) -> str:
    """Return a table for each data set of both evaluations, and the names of data sets that only one of them has."""
    parts = [
        _changes_table(f"{name}, {recipe}", earlier[recipe][name], part)
        for recipe, data_sets in present.items()
        for name, part in data_sets.items()
        if name in earlier.get(recipe, {})
    ]
    parts += _lacking("evaluated then and not now", _names(earlier, present), _names(present, earlier))
    parts += _lacking("not evaluated then", _names(present, earlier), _names(earlier, present))
    return "\n\n".join(parts)


def _changes_table(title: str, before: Mapping[str, Any], now: Mapping[str, Any]) -> str:
    """Return the table of summaries and of changed figures of recordings; removed and new recordings are below it."""
    rows, counts, old_rows = [], Counter[str](), _rows(before)
    for row, figures in _rows(now).items():
        old = old_rows.get(row, {})
        for figure in dict.fromkeys([*figures, *old]) if row in old_rows else ():
            values = old.get(figure), figures.get(figure)
            found = verdict(figure, *values)
            counts[found] += 1
            if found != SAME or row.split()[0] in SUMMARY_ROWS:
                rows.append((f"{figure} ({row})", *map(_format, values), found))
    numbers = ", ".join(f"{counts[one]} {one}" for one in (BETTER, WORSE, SAME))
    lines = [f"{title}, compared: {numbers} (SI units)"]
    lines += [table(("figure", "was", "is", ""), rows)] if rows else []
    lines += _lacking("scored then and not now", before["recordings"], now["recordings"])
    return "\n".join(lines + _lacking("not scored then", now["recordings"], before["recordings"]))


def _names(scores: Scores, other: Scores) -> list[str]:
    """Return the recipes of `scores`, and `recipe: data set` for those that `other` has too."""
    return [
        name
        for recipe, data_sets in scores.items()
        for name in ([f"{recipe}: {data_set}" for data_set in data_sets] if recipe in other else [recipe])
    ]


def _lacking(words: str, names: Iterable[str], others: Container[str]) -> list[str]:
    """Return a line about the names that are none of the others, if there are any."""
    lacking = [name for name in names if name not in others]
    return [f"{words}: {', '.join(lacking)}"] if lacking else []
