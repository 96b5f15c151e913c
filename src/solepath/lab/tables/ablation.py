"""What each part of the default recipe is worth, as a text table or as the Markdown table of docs/accuracy.md."""

from __future__ import annotations

from collections.abc import Sequence

from ...show.tables.table import milliseconds, number, percent, table
from ..evaluate.ablation import COLUMNS, Column
from ..evaluate.report import Result


def ablation_table(results: Sequence[Result], markdown: bool = False) -> str:
    """A line for each recipe, a column for each main figure that was scored."""
    recipes = list(dict.fromkeys(result.recipe for result in results))
    scored = {result.data_set.name for result in results}
    columns = [column for column in COLUMNS if column.data_set in scored]
    header = ["", *(f"{column.title} {column.unit}".strip() for column in columns)]
    rows = [[recipe, *(_figure(column, column.of(results, recipe)) for column in columns)] for recipe in recipes]
    if not markdown:
        return table(header, rows)
    lines = [header, ["---", *("---:" for _ in columns)], *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def _figure(column: Column, value: float | None) -> str:
    match column.unit:
        case "%":
            return percent(value, 2)
        case "ms":
            return milliseconds(value)
        case _:
            return number(value, 3)
