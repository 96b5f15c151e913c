"""Says the result of a walk test in sentences: the outcome first, its share of the reference, and its change.

What is not measured of a whole test is compared with nothing: no prediction, and no walk before or after."""

from __future__ import annotations

from .rows import OutcomeRow


def answer(row: OutcomeRow, before: OutcomeRow | None) -> list[str]:
    """Return the result of a walk test, and how it changed from that of the walk before, if there is one."""
    name = row.part.capitalize()
    if row.value is None:
        return [f"{name}: the {row.label} is not known."]
    sentences = [f"{name}: {row.measured}{_reference_clause(row)}."]
    if row.shortfalls:
        reasons = " and ".join(row.shortfalls)
        sentences.append(f"{reasons[0].upper()}{reasons[1:]}: it is compared with no prediction and no other walk.")
    if before is not None:
        sentences.append(_change(row, before))
    return sentences


def _reference_clause(row: OutcomeRow) -> str:
    if (one := row.reference) is None:
        return ""
    value = f"{row.shown(one.value)} {row.unit}"
    if one.lower_limit is None:
        return f", {row.share_of_reference} of {value}, the {one.words}"
    limit = f"lower limit of normal {row.shown(one.lower_limit)} {row.unit}"
    return f", {row.share_of_reference} of the predicted {value} ({limit})"


def _change(row: OutcomeRow, before: OutcomeRow) -> str:
    """Return a sentence on the change from the walk before, against the smallest change that matters."""
    if before.value is None:
        return "Before: not known."
    change = change_of(row, before)
    if change is None or row.value is None:
        why = f": {' and '.join(before.shortfalls)}, so that no change is given" if before.shortfalls else ""
        return f"Before: {before.measured}{why}."
    digits, one = row.digits(row.value), row.smallest_change
    words = f"Before: {before.value:.{digits}f} {row.unit}{before.extent}. The change, {change:+.{digits}f}"
    if one is None:
        return f"{words} {row.unit}, has no published limit."
    reached = "reaches" if one.reached_by(change) else "is less than"
    return f"{words} {row.unit}, {reached} the smallest that matters, {one.value:g} {row.unit}."


def change_of(row: OutcomeRow, before: OutcomeRow) -> float | None:
    """Return the change of a result from that of the walk before; None unless both are of whole tests."""
    if row.value is None or before.value is None or row.shortfalls or before.shortfalls:
        return None
    return row.value - before.value
