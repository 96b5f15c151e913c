"""Text tables of scores: of each data set, and of the ablation.

They are at most WIDTH wide: columns that have no room go into a table below, with the first column again."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

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


WIDTH = 120
"""Largest length of a line that is printed."""


def narrow_tables(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table in parts of at most WIDTH, one below another, each with the first column."""
    parts: list[list[int]] = [[]]
    for column in range(1, len(header)):
        if parts[-1] and len(_part(header, rows, [*parts[-1], column]).partition("\n")[0]) > WIDTH:
            parts.append([])
        parts[-1].append(column)
    return "\n\n".join([_part(header, rows, part) for part in parts])


def _part(header: Sequence[str], rows: Sequence[Sequence[str]], columns: Sequence[int]) -> str:
    """Return the table of the first column and these."""
    chosen = [[row[column] for column in (0, *columns)] if row else [] for row in (header, *rows)]
    return table(chosen[0], chosen[1:])


def words_of(results: Sequence[Result]) -> str:
    """Return what each column of the tables of these results is, a line for each."""
    shown_keys = dict.fromkeys(key for result in results for key in _keys(result))
    lines = [f"{FIGURES[key].title} = {FIGURES[key].words}" for key in FIGURES if key in shown_keys]
    return "\n".join([line for one in lines for line in wrap(one, WIDTH, subsequent_indent="  ")])


def _keys(result: Result) -> list[str]:
    """Return the names of the figures of a data set that have a value."""
    known = [score.flat() for score in result.scores]
    known += [figures for one in result.summaries for figures in (one.mean, one.median, one.together)]
    return [key for key in FIGURES if any(one.get(key) is not None for one in known)]


def score_table(result: Result) -> str:
    """Return the title, table of figures with a value, confusion matrix and failures of a data set."""
    data_set = result.data_set
    keys = _keys(result)
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
    lines = [title, narrow_tables(header, rows)]
    lines += [_confusion(one.confusion) for one in result.summaries if one.group == "all" and one.confusion]
    return "\n".join([*lines, *(f"failed: {sentence}" for sentence in result.failures)])


def _confusion(counts: dict[str, dict[str, int]]) -> str:
    """Return the confusion matrix: of the samples of each true activity, the share of each reported one, %."""
    reported = [activity_words(Activity(answer)) for row in [*counts.values()][:1] for answer in row]
    rows = []
    for was, row in counts.items():
        total = sum(row.values())
        rows.append([activity_words(Activity(was)), *[percent(count / total) for count in row.values()], str(total)])
    return narrow_tables(["% of the true activity, reported as", *reported, "samples"], rows)


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
    return narrow_tables(header, rows)
