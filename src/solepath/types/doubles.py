"""Rows of numbers of 8 bytes each: a list takes 32 for a number that nothing else holds."""

from __future__ import annotations

from array import array
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    Doubles = array[float]
else:
    Doubles = array  # before Python 3.12, an array cannot be subscripted at run time


def doubles(values: Iterable[float] = ()) -> Doubles:
    """Return the numbers as an array."""
    return array("d", values)
