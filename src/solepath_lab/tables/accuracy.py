"""Short scores as the Markdown table that docs/accuracy.md quotes.

accuracy.csv has its rows: the group of figures and the figure without which the row is left out, what is measured, the
figures, and the figures of a single recording where they differ. In braces are figures of a summary, as columns.csv
says, or with another unit and number of digits after a colon."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from attrs import frozen

from ..descriptions import read_rows
from ..evaluate.report import Result
from ..measures.score import Figures, Summary
from .columns import FIGURES, shown
from .markdown import table

PATH_SHARES = ("end_relative", "radius_error")
"""Shares of the path, which need no length of the walk beside them, as errors in m do."""
ROWS = read_rows(__file__, "accuracy.csv")


@frozen
class _Cell:
    """A figure in a text with braces."""

    name: str
    value: float | None

    def __format__(self, form: str) -> str:
        return shown(self.value, form[:-1], int(form[-1])) if form else FIGURES[self.name].show(self.value)


def accuracy_table(results: Sequence[Result]) -> str:
    """Return the table with one line for each figure of each data set, and one column of results for each recipe."""
    recipes = list(dict.fromkeys(result.recipe for result in results))
    rows: dict[tuple[str, str], dict[str, str]] = {}
    for result in results:
        summaries = {summary.group: summary for summary in result.summaries}
        if (summary := summaries.get("all")) is not None:
            count = f"{summary.count} recording{'s' * (summary.count > 1)}"
            data = f"{result.data_set.title}: `{result.data_set.name}`, {count}"
            for measured, figures in _lines(summary):
                rows.setdefault((data, measured), {})[result.recipe] = figures
    headings = ["result"] if len(recipes) == 1 else [f"`{recipe}`" for recipe in recipes]
    cells, previous_data = [], ""
    for (data, measured), entries in rows.items():
        cells.append(["" if data == previous_data else data, measured, *(entries.get(name, "-") for name in recipes)])
        previous_data = data
    header = ["data", "measured", *headings]
    return "\n".join(table(header, cells, left=len(header)))


def _lines(summary: Summary) -> Iterator[tuple[str, str]]:
    """Yield what is measured, and the figures, of each row of a data set."""
    groups: dict[str, Figures] = {"mean": summary.mean, "median": summary.median, "together": summary.together}
    texts: dict[str, Any] = {
        group: {name: _Cell(name, value) for name, value in figures.items()} for group, figures in groups.items()
    }
    for row in ROWS:
        needs, value = row["needs"], groups[row["group"]].get(row["needs"])
        if value is None or needs == "rides_true" and not value:
            continue
        if needs == "path" and any(share in summary.mean for share in PATH_SHARES):
            continue
        figures = (summary.count == 1 and row["alone"]) or row["figures"]
        yield row["measured"].format(**texts), figures.format(**texts)
