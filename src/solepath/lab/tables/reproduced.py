"""An experiment beside the paper's, as text."""

from __future__ import annotations

from ...show.tables.table import number, table
from ..reproduce.tables import STATISTICS, FigureRow, Reproduction, Statistics, statistics


def reproduced(done: Reproduction) -> str:
    """The table of ours with the paper's beside it, and what else is to be said, a sentence a line."""
    first, *others = STATISTICS
    header = [done.unit, f"ours: {first}", *others, f"paper: {first}", *others]
    rows = [[row.name, *_cells(statistics(row.values), row), *_cells(row.paper, row)] for row in done.rows]
    title = f"{done.name}: ours is emulated ({done.walked}), theirs was walked ({done.paper_title})."
    return "\n".join([title, "", table(header, rows), *([""] if done.notes else []), *done.notes])


def _cells(of: Statistics, row: FigureRow) -> list[str]:
    return [number(getattr(of, key), row.digits) for key in STATISTICS]
