"""Rows of numbers of 8 bytes each: a list takes 32 for a number that nothing else holds."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator
from typing import NewType

Doubles = NewType("Doubles", "array[float]")
"""An array with the typecode `d`, as `doubles` makes it. It may hold rows of several numbers one after the other."""


def doubles(values: Iterable[float] = ()) -> Doubles:
    """Return the numbers as an array."""
    return Doubles(array("d", values))


def pairs(values: Doubles) -> Iterator[tuple[float, float]]:
    """Return the numbers as rows of two; their count is even."""
    one_by_one = iter(values)
    return zip(one_by_one, one_by_one, strict=True)
