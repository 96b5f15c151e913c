"""Text tables of scores: of each data set, and of the ablation."""

from __future__ import annotations

from collections.abc import Sequence

from solepath.show.tables.table import percent, table
from solepath.show.tables.words import activity_words
from solepath.types import Activity

from ..evaluate.ablation import COLUMNS
from ..evaluate.report import Result
from ..measures.score import Figures
from . import markdown
from .columns import FIGURES, shown

DIGITS = {"%": 2, "ms": 0}
"""Digits of the main figures in these units; the others have three."""


def score_table(result: Result) -> str:
    """Return the title, table of figures with a value, confusion matrix and failures of a data set."""
    data_set = result.data_set
    known = [score.flat() for score in result.scores]
    known += [figures for one in result.summaries for figures in (one.mean, one.median, one.together)]
    keys = [key for key in FIGURES if any(one.get(key) is not None for one in known)]
    header = ["recording", *(FIGURES[key].title for key in keys)]
    rows: list[Sequence[str]] = []
    if data_set.lists_recordings:
        rows += [_row(score.recording, score.flat(), keys) for score in result.scores]
        rows.append([])
    for summary in result.summaries:
        name = "" if summary.group == "all" else f" {summary.group}"
        if summary.mean:
            rows.append(_row(f"mean of {summary.count}{name}", summary.mean | summary.together, keys))
            rows.append(_row("median", summary.median, keys))
        else:
            rows.append(_row(f"pooled {summary.count}{name}", summary.together, keys))
    title = f"{data_set.name}: {data_set.title} ({result.recipe})"
    lines = [title, table(header, rows)]
    lines += [_confusion(one.confusion) for one in result.summaries if one.group == "all" and one.confusion]
    return "\n".join([*lines, *(f"failed: {sentence}" for sentence in result.failures)])


def _confusion(counts: dict[str, dict[str, int]]) -> str:
    """Return the confusion matrix: of the samples of each true activity, the share of each reported one, %."""
    reported = [activity_words(Activity(answer)) for row in [*counts.values()][:1] for answer in row]
    rows = []
    for was, row in counts.items():
        total = sum(row.values())
        rows.append([activity_words(Activity(was)), *[percent(count / total) for count in row.values()], str(total)])
    return table(["% of the true activity, reported as", *reported, "samples"], rows)


def _row(name: str, figures: Figures, keys: Sequence[str]) -> list[str]:
    return [name, *(FIGURES[key].show(figures.get(key)) for key in keys)]


def ablation_table(results: Sequence[Result], as_markdown: bool = False) -> str:
    """Return a table with a line for each recipe and a column for each main figure that was scored."""
    scored = {result.data_set.name for result in results}
    columns = [column for column in COLUMNS if column.data_set in scored]
    header = ["", *(f"{column.title} {column.unit}".strip() for column in columns)]
    rows = []
    for recipe in dict.fromkeys(result.recipe for result in results):
        figures = [(column.unit, column.find_figure(results, recipe)) for column in columns]
        rows.append([recipe, *(shown(value, unit, DIGITS.get(unit, 3)) for unit, value in figures)])
    if as_markdown:
        return "\n".join(map(markdown.row, [header, ["---", *["---:"] * len(columns)], *rows]))
    return table(header, rows)
