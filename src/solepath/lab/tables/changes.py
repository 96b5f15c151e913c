"""Scores beside those of an earlier evaluation, as text."""

from __future__ import annotations

from collections.abc import Sequence

from ...show.tables.table import table
from ..evaluate.changes import DIGITS, Change, Changes, Scores, Verdict, compared, missing

HEADER = ("figure", "was", "is", "")
GROUPS = ("mean", "median", "together")


def changes_table(changes: Changes) -> str:
    """Every figure of the groups, and of the recordings those that changed; then what is on one side only."""
    rows: list[Sequence[str]] = []
    for change in changes.changes:
        if change.what.split()[0] in GROUPS or change.verdict is not Verdict.SAME:
            rows.append((f"{change.figure} ({change.what})", _figure(change.was), _figure(change.now), _word(change)))
    counts = [f"{_count(changes, which)} {which.value}" for which in (Verdict.BETTER, Verdict.WORSE, Verdict.SAME)]
    lines = [f"{changes.data_set}, {changes.recipe}, compared: {', '.join(counts)} (SI units)"]
    if rows:
        lines.append(table(HEADER, rows))
    if changes.gone:
        lines.append(f"scored then and not now: {', '.join(changes.gone)}")
    if changes.new:
        lines.append(f"not scored then: {', '.join(changes.new)}")
    return "\n".join(lines)


def comparison_tables(was: Scores, now: Scores) -> str:
    """A table for each data set that is in both, and what is in one only."""
    parts = [changes_table(changes) for changes in compared(was, now)]
    gone, new = missing(was, now), missing(now, was)
    if gone:
        parts.append(f"evaluated then and not now: {', '.join(gone)}")
    if new:
        parts.append(f"not evaluated then: {', '.join(new)}")
    return "\n\n".join(parts)


def _count(changes: Changes, which: Verdict) -> int:
    return sum(change.verdict is which for change in changes.changes)


def _figure(value: float | None) -> str:
    return "-" if value is None else f"{value:.{DIGITS}g}"


def _word(change: Change) -> str:
    return change.verdict.value
