"""Formats numbers and tables as plain text."""

from __future__ import annotations

from collections.abc import Sequence


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table, the first column aligned left, the others right; an empty row is drawn as a line."""
    widths = [max(len(row[c]) for row in (header, *rows) if row) for c in range(len(header))]
    rule = "  ".join("-" * width for width in widths)
    lines = [_line(header, widths), rule, *(_line(row, widths) if row else rule for row in rows)]
    return "\n".join(lines)


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    first, *others = cells
    return "  ".join([first.ljust(widths[0]), *(c.rjust(w) for c, w in zip(others, widths[1:], strict=True))]).rstrip()


def number(value: float | None, digits: int = 2) -> str:
    """Return `value` with `digits` digits after the point; a dash for None."""
    return "-" if value is None else f"{value:.{digits}f}"


def percent(share: float | None, digits: int = 1) -> str:
    """Return a share, 0 to 1, in percent, without "%"; a dash for None."""
    return "-" if share is None else f"{100.0 * share:.{digits}f}"


def milliseconds(seconds: float | None) -> str:
    """Return a time in s as a whole number of ms; a dash for None."""
    return "-" if seconds is None else f"{1000.0 * seconds:.0f}"


def counted(count: int, noun: str) -> str:
    """Return a number with its noun, which has the plural -s: "1 gap", "2 gaps"."""
    return f"{count} {noun}{'s' * (count != 1)}"


def times(count: int) -> str:
    """Return how often something happened: "once", "twice", "3 times"."""
    return {1: "once", 2: "twice"}.get(count, f"{count} times")


def duration_text(seconds: float) -> str:
    """Return a duration as text in s, min or h."""
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    minutes, rest = divmod(whole, 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"
