"""What a saved state may be: limits, which bound memory and time of reading whatever somebody put in its place.

A state of a session has some 5,000 values, with a floor plan some 20,000; the limits leave room for parts of an app. A
state that exceeds them is not saved either, so that every saved state can be read."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Json = None | bool | int | float | str | list["Json"] | dict[str, "Json"]
Classes = Callable[[str], type | None]
"""Function, such as a dict's `get`, that returns the class of an open record by its name, or None."""

MAX_VALUES = 1 << 20
"""Largest number of values (numbers, flags, texts, lists and objects) of a saved state."""
MAX_SIZE = 1 << 24
"""Largest number of characters of all texts of a snapshot, and of bytes that a packed state has beside its numbers."""
MAX_DEPTH = 64
"""Largest number of lists and objects of a snapshot that are within each other; a session has about 15."""
MAX_DIGITS = 309
"""Largest number of digits of an int: one with more is beyond the largest float, 1.8e308."""
_INT_LIMIT = 10**MAX_DIGITS


class SnapshotError(ValueError):
    """Error for a value that is no snapshot, has another version, or does not fit this release's records."""


def check_size(value: Any) -> None:
    """Raise ValueError for a JSON value that exceeds a limit; the work is in proportion to the limits at most."""
    count = characters = 0
    level = [value]
    for _ in range(MAX_DEPTH + 1):
        below: list[Any] = []
        for item in level:
            kind = type(item)
            if kind is list or kind is dict:
                count += len(item)
                if count > MAX_VALUES:
                    raise ValueError(f"no snapshot has more than {MAX_VALUES} values")
                if kind is dict:
                    below += item
                    item = item.values()
                below += item
            elif kind is str:
                characters += len(item)
            elif kind is int and not -_INT_LIMIT < item < _INT_LIMIT:
                raise ValueError(f"no snapshot has an int of more than {MAX_DIGITS} digits")
        if characters > MAX_SIZE:
            raise ValueError(f"no snapshot has more than {MAX_SIZE} characters")
        if not below:
            return
        level = below
    raise ValueError(f"no snapshot has more than {MAX_DEPTH} lists and objects within each other")
