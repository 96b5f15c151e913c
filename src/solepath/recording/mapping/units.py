"""Units of times, specific force, angular rate and pressure in tables, streams and datasets, and their factors."""

from __future__ import annotations

import re
import tomllib
from pkgutil import get_data
from typing import Any

WORDS: dict[str, Any] = tomllib.loads((get_data(__package__, "words.toml") or b"").decode())
"""Units, and words in names."""
UNITS: dict[str, dict[str, float]] = WORDS["units"]
"""Factors to SI units of the units of each quantity."""
SI = {quantity: next(iter(factors)) for quantity, factors in UNITS.items()}
"""SI unit of each quantity."""
GRAVITY = UNITS["acc"]["g"]
"""Standard gravity, m/s^2: the value of 1 g."""
DATETIME = "datetime"
"""Unit of times that are text."""
SPELLINGS = {spelling: unit for unit, spellings in WORDS["spellings"].items() for spelling in spellings}
"""Unit of each other spelling, in lower case."""
IN_BRACKETS = re.compile(r"[\[(]([^\[\]()]*)[\])]\s*$")
"""Pattern of a unit in brackets at the end of a column's name, as in `Acc X (g)`."""


def find_unit(text: str) -> tuple[str, str] | None:
    """Return the quantity and the usual spelling of a unit; None for any other text."""
    spelling = re.sub(r"[\s\[\]()]", "", text)
    spelling = SPELLINGS.get(spelling.lower(), spelling)
    for quantity, factors in UNITS.items():
        for unit in factors:
            if spelling == unit or (spelling.lower() == unit and unit != "mg"):
                return quantity, unit
    return None


def unit_of(text: str, quantity: str) -> str | None:
    """Return the usual spelling of a unit of a quantity; None for any other text."""
    found = find_unit(text)
    return found[1] if found is not None and found[0] == quantity else None


def unit_of_name(name: str, quantity: str) -> str | None:
    """Return the unit of a quantity that the name of a column holds in brackets; None without one."""
    match = IN_BRACKETS.search(name)
    return None if match is None else unit_of(match[1], quantity)
