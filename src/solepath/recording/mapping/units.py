"""Units of times, specific force, angular rate and pressure in tables, streams and datasets, and their factors."""

from __future__ import annotations

import re
from math import pi

GRAVITY = 9.80665
"""Standard gravity, m/s^2: the value of 1 g (ISO 80000-3)."""
DATETIME = "datetime"
"""Unit of times that are text, such as 2026-03-01T09:30:00.125; a time without a zone is in UTC."""

UNITS = {
    "t": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, DATETIME: 1.0},
    "acc": {"m/s^2": 1.0, "g": GRAVITY, "mg": 1e-3 * GRAVITY},
    "gyro": {"rad/s": 1.0, "deg/s": pi / 180.0, "mdeg/s": 1e-3 * pi / 180.0},
    "pressure": {"N": 1.0, "N/cm^2": 1.0},
}
"""Factors to s, m/s^2 and rad/s of the units of each quantity; the cells of an insole are taken as they are."""

ALIASES = {
    "sec": "s", "second": "s", "seconds": "s", "msec": "ms", "milliseconds": "ms", "\u00b5s": "us", "\u03bcs": "us",
    "usec": "us", "microseconds": "us", "nanoseconds": "ns", "iso": DATETIME,
    "m/s2": "m/s^2", "m/s\u00b2": "m/s^2", "ms-2": "m/s^2", "m/s/s": "m/s^2", "meters/second^2": "m/s^2",
    "milli-g": "mg", "rad/sec": "rad/s", "radians/second": "rad/s",
    "rads/s": "rad/s", "dps": "deg/s", "\u00b0/s": "deg/s", "degree/s": "deg/s", "degrees/s": "deg/s",
    "deg/sec": "deg/s", "degrees/second": "deg/s", "mdps": "mdeg/s",
    "n": "N", "n/cm2": "N/cm^2", "n/cm\u00b2": "N/cm^2",
}  # fmt: skip
"""Other spellings of these units, in lower case."""

IN_BRACKETS = re.compile(r"[\[(]([^\[\]()]*)[\])]\s*$")
"""Pattern of a unit in brackets at the end of a column's name, as in `Acc X (g)`."""


def find_unit(text: str) -> tuple[str, str] | None:
    """Return the quantity and the usual spelling of a unit; None for any other text."""
    spelling = re.sub(r"[\s\[\]()]", "", text)
    spelling = ALIASES.get(spelling.lower(), spelling)
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
