"""The table of a reproduction beside the paper's."""

from __future__ import annotations

from solepath.show.tables.table import number, table

from ..reproduce.tables import STATISTICS, FigureRow, Reproduction, Statistics, statistics


def comparison_with_paper(reproduction: Reproduction) -> str:
    """Return the table of our figures beside the paper's, with the claims and the notes on lines below it."""
    first, *others = STATISTICS
    header = [reproduction.unit, f"ours: {first}", *others, f"paper: {first}", *others]
    rows = [[row.name, *_cells(statistics(row.values), row), *_cells(row.paper, row)] for row in reproduction.rows]
    published, found = reproduction.published, reproduction.claims
    title = (
        f"{reproduction.name}: ours is emulated ({reproduction.emulation}), theirs was walked ({published['title']})."
    )
    claims = ["", "Claims:", *[str(one) for one in found]] if found else []
    notes = ["", *published["notes"]]
    return "\n".join([title, "", table(header, rows), *claims, *notes])


def _cells(shown: Statistics, row: FigureRow) -> list[str]:
    return [number(getattr(shown, key), row.digits) for key in STATISTICS]
