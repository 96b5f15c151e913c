"""Numbers as a screen shows them: few digits, and none where there is no number."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite


def shown(value: float | None, digits: int = 3) -> float | None:
    """`value` with so many digits after the point; None of what is no number: JSON has none for it."""
    return None if value is None or not isfinite(value) else round(value, digits)


def placed(values: Iterable[float], digits: int = 3) -> list[float | None]:
    """The same of a place, m: to the millimetre."""
    return [shown(value, digits) for value in values]
