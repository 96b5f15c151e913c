"""Tables with this project's own names of columns: the first line names them, in SI units.

    t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z,pressure_0,pressure_1
    t,acc_x_left,...,gyro_z_left,pressure_0_left,...,acc_x_right,...       (or t_left and t_right instead of t)

The foot may also be named before the component (acc_left_x), and 0, 1, 2 may replace x, y, z. Other columns are
ignored. In a file of both feet, a row in which all cells of one foot are blank has no sample of that foot."""

from __future__ import annotations

import re

from ..mapping.mapping import TableMapping
from .export import Export, TableHeader

_COLUMN = re.compile(
    r"(t|acc|gyro|pressure)(?:_(left|right))?(?:_([xyz]|[0-9]{1,4}))?(?:_(left|right))?", re.IGNORECASE
)
_AXES = {"x": 0, "y": 1, "z": 2}

QUANTITIES = frozenset(["acc", "gyro", "pressure"])
"""Quantities of which a table with these names has one or more."""

Key = tuple[str, str, int]
"""Quantity, foot ("" for none) and component of a column."""


def _find(header: TableHeader) -> dict[Key, str]:
    """Return the name of each column by its meaning; ValueError for a meaning that occurs twice."""
    found: dict[Key, str] = {}
    for name in header.names:
        match = _COLUMN.fullmatch(name)
        if match is None or (match[2] and match[4]) or (match[1].lower() == "t" and match[3]):
            continue
        quantity, foot, axis = (text and text.lower() for text in (match[1], match[2] or match[4] or "", match[3]))
        component = _AXES[axis] if axis in _AXES else int(axis or 0)
        if (quantity, foot, component) in found:
            raise ValueError(f"names the column {name} twice")
        found[quantity, foot, component] = name
    return found


def _is_own(header: TableHeader) -> bool:
    # other programs write Acc_X too, but not beside a column t
    names = [match[1] for match in map(_COLUMN.fullmatch, header.names) if match]
    has_time = "t" in map(str.lower, names)
    return any(name in QUANTITIES or (has_time and name.lower() in QUANTITIES) for name in names)


def _mapping(header: TableHeader) -> TableMapping:
    found = _find(header)
    feet = sorted({foot for quantity, foot, _ in found if quantity != "t"})
    if "" in feet and len(feet) > 1:
        raise ValueError("has columns with and without a foot's name: is it of one foot or of two?")
    columns: dict[str, tuple[str, ...]] = {}
    for quantity, foot in {(quantity, foot): None for quantity, foot, _ in found}:
        suffix = foot and f"_{foot}"
        numbers = sorted(number for q, f, number in found if (q, f) == (quantity, foot))
        if quantity != "t":
            _check_components(quantity, suffix, numbers)
        columns[quantity + suffix] = tuple(found[quantity, foot, number] for number in numbers)
    return TableMapping(columns)


def _check_components(quantity: str, suffix: str, numbers: list[int]) -> None:
    if quantity == "pressure":
        first = min(1, *numbers) if len(numbers) > 1 else 0
        missing = [f"pressure_{c}{suffix}" for c in range(first, first + len(numbers)) if c not in numbers]
    else:
        missing = [f"{quantity}_{axis}{suffix}" for axis, c in _AXES.items() if c not in numbers]
    if missing:
        raise ValueError(f"names no column {missing[0]}")
    if quantity != "pressure" and len(numbers) > 3:
        raise ValueError(f"names more than three columns of {quantity}{suffix}")


OWN = Export("solepath", "solepath", _mapping, _is_own)
"""The format with this project's own names."""
