"""Tables as Markdown, for the pages that quote them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def row(cells: Iterable[object]) -> str:
    """Return a row of a table."""
    return f"| {' | '.join(map(str, cells))} |"


def table(header: Sequence[str], rows: Iterable[Iterable[object]], left: int = 1) -> list[str]:
    """Return the lines of a table, whose first `left` columns are aligned left, the others right."""
    rule = "".join(["---|" if k < left else "---:|" for k in range(len(header))])
    return [row(header), f"|{rule}", *map(row, rows)]
