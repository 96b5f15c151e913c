"""The table of a reproduction beside the paper's."""

from __future__ import annotations

from solepath.show.tables.table import number, table

from ..reproduce.tables import STATISTICS, FigureRow, Reproduction, Statistics, statistics


def comparison_with_paper(reproduction: Reproduction) -> str:
    """Return the table of our figures beside the paper's, with the claims and the notes on lines below it."""
    first, *others = STATISTICS
    header = [reproduction.unit, f"ours: {first}", *others, f"paper: {first}", *others]
    rows = [[row.name, *_cells(statistics(row.values), row), *_cells(row.paper, row)] for row in reproduction.rows]
    title = (
        f"{reproduction.name}: ours is emulated ({reproduction.emulation}), "
        f"theirs was walked ({reproduction.paper_title})."
    )
    claims = [] if not reproduction.claims else ["", "Claims:", *[str(one) for one in reproduction.claims]]
    notes = [] if not reproduction.notes else ["", *reproduction.notes]
    return "\n".join([title, "", table(header, rows), *claims, *notes])


def _cells(shown: Statistics, row: FigureRow) -> list[str]:
    return [number(getattr(shown, key), row.digits) for key in STATISTICS]
