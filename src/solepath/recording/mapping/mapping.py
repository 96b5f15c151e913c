"""The meaning of the columns of a table that somebody else wrote: names, units, feet, and how its text is written."""

from __future__ import annotations

import csv
import re
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from math import inf
from typing import Any

from attrs import evolve, field, frozen

from .units import UNITS, find_unit

QUANTITIES = ("t", "acc", "gyro", "pressure")
"""Quantities that columns may hold: time, specific force, angular rate, and the cells of an insole."""
MEASURED = QUANTITIES[1:]
"""Quantities that sensors measure."""
COMPONENTS = {"t": 1, "acc": 3, "gyro": 3}
"""Number of components of a quantity; an insole may have any number of cells."""
KEYS = tuple(quantity + suffix for suffix in ("", "_left", "_right") for quantity in QUANTITIES)
"""Keys of columns: a quantity, alone or with the foot whose it is."""
FORMATS = ("movella-dot", "mbientlab", "physilog", "moticon", "ngimu", "solepath")
"""Names of the known formats, which `solepath.recording.exports` defines."""
SEPARATORS = {",": ",", ";": ";", "\t": "\t", "|": "|", " ": " ", "tab": "\t"}
"""Texts that may be between the cells of a line; "tab" is another word for a tab."""


def _to_columns(given: Mapping[str, str | Iterable[str]]) -> dict[str, tuple[str, ...]]:
    return {key: (names,) if isinstance(names, str) else tuple(names) for key, names in given.items()}


@frozen
class TableMapping:
    """Meaning of the columns of a table of samples; what it leaves out is found in the table, or is SI units.

    Problems of its values are one ValueError, with a line for each."""

    columns: Mapping[str, tuple[str, ...]] = field(factory=dict, converter=_to_columns)
    """Names of the columns of each quantity: `t`, `acc`, `gyro`, `pressure`, alone or with `_left` or `_right`.

    A name may start with "-" for the opposite sign, contain "*" for any text, or be "#4" for the fourth column."""
    units: Mapping[str, str] = field(factory=dict)
    """Unit of each quantity, such as {"t": "ms", "acc": "g", "gyro": "deg/s"}."""
    rate: float | None = None
    """Number of samples a second, Hz, of a table without times; None for one with times."""
    wrap: float | None = None
    """Value at which a counter of time starts again from 0, s or the unit of the column; None if it never does."""
    separator: str | None = None
    """Character between the cells of a line; None: found in the file."""
    decimal: str | None = None
    """Decimal mark, "." or ","; None: found in the file."""
    header: int | None = None
    """Number of the line that has the names, counted from 1; 0 for a table without names; None: found in the file."""
    feet: Mapping[str, str] = field(factory=dict)
    """Pattern of the names of each foot's files, such as {"left": "*_li.csv", "right": "*_re.csv"}."""
    format: str = ""
    """Name of the known format that the file has; "": found in the file."""
    origin: str = field(default="", eq=False)
    """Name of the file that holds this mapping; "" for options of a command, and for a known format."""

    def __attrs_post_init__(self) -> None:
        if faults := [*self._name_faults(), *self._value_faults()]:
            raise ValueError("\n".join(faults))

    def _name_faults(self) -> Iterator[str]:
        """Yield what is wrong with columns and units."""
        for key, names in self.columns.items():
            if key not in KEYS:
                yield f"{key} is none of {', '.join(KEYS)}"
            elif not names or not all(isinstance(name, str) and name for name in names):
                yield f"{key} has no names of columns"
            elif key.startswith("t") and len(names) != 1:
                yield f"{key} is one column, not {len(names)}"
        for quantity, unit in self.units.items():
            known = find_unit(unit) if isinstance(unit, str) else None
            if quantity not in UNITS:
                yield f"{quantity} is none of {', '.join(UNITS)}"
            elif known is None or known[0] != quantity:
                yield f"{unit!r} is no unit of {quantity}: {', '.join(UNITS[quantity])}"

    def _value_faults(self) -> Iterator[str]:
        """Yield what is wrong with the other values."""
        for key in ("rate", "wrap"):
            value = getattr(self, key)
            if value is not None and (type(value) not in (int, float) or not 0.0 < value < inf):
                yield f"{key} is {value!r}, not a number above 0"
        if self.separator is not None and self.separator not in SEPARATORS:
            yield f"separator is {self.separator!r}, not one of comma, semicolon, tab, bar, blank"
        if self.decimal not in (None, ".", ","):
            yield f'decimal is {self.decimal!r}, not "." or ","'
        if self.header is not None and (type(self.header) is not int or self.header < 0):
            yield f"header is {self.header!r}, not the number of a line"
        if self.format and self.format not in FORMATS:
            yield f"{self.format} is none of the known formats {', '.join(FORMATS)}"
        for foot, pattern in self.feet.items():
            if foot not in ("left", "right") or not isinstance(pattern, str):
                yield f"{foot} is not left or right, with a pattern of names of files"

    @classmethod
    def parse(cls, columns: str = "", units: str = "", **more: Any) -> TableMapping:
        """Return the mapping of `t=Time,acc=AX,AY,AZ` and `g,deg/s,ms`, the texts of --columns and --units.

        A name that contains a comma is in double quotes. ValueError says what is wrong."""
        return cls(_parse_columns(columns), _parse_units(units), **more)

    def replaced(self, other: TableMapping, **more: Any) -> TableMapping:
        """Return this mapping with everything that another one states in place of its own; `more`: other fields."""
        merged = other.completed(self)
        return evolve(self, columns=merged.columns, units=merged.units, rate=merged.rate, **more)

    def completed(self, base: TableMapping) -> TableMapping:
        """Return this mapping with everything that it leaves out taken from another one."""
        own = {key.split("_")[0] for key in self.columns if "_" not in key}
        kept = {key: names for key, names in base.columns.items() if "_" not in key or key.split("_")[0] not in own}
        return evolve(
            self,
            columns={**kept, **self.columns},
            units={**base.units, **self.units},
            rate=base.rate if self.rate is None else self.rate,
            wrap=base.wrap if self.wrap is None else self.wrap,
        )

    @property
    def is_of_one_foot(self) -> bool:
        """True when a quantity that a sensor measures is named without a foot."""
        return any(quantity in self.columns for quantity in MEASURED)

    def write_columns(self, key: str, changes: Mapping[str, Iterable[str]]) -> str:
        """Return what makes these changes: the whole --columns, or the line of `key` in the file of this mapping."""
        if not self.origin:
            columns = {**self.columns, **changes}
            return f"--columns {shlex.quote(','.join(f'{k}={join_names(names)}' for k, names in columns.items()))}"
        names = list(changes[key])
        text = ", ".join(f'"{name}"' for name in names)
        return f"in {self.origin}: {key} = {text}" if len(names) == 1 else f"in {self.origin}: {key} = [{text}]"

    def write_units(self, quantity: str, changes: Mapping[str, str]) -> str:
        """Return what makes these changes: the whole --units, or the line of a quantity in the file of this mapping."""
        if not self.origin:
            return f"--units {','.join({**self.units, **changes}.values())}"
        return f'in {self.origin}: {quantity} = "{changes[quantity]}" below [units]'

    def write_setting(self, key: str, value: str) -> str:
        """Return what sets another value: an option of this name, or a line in the file of this mapping."""
        return f"in {self.origin}: {key} = {value}" if self.origin else f"--{key} {value}"


@frozen
class NamedColumn:
    """A column of a table, and the sign with which its numbers count."""

    index: int
    """Number of the column, counted from 0."""
    name: str
    sign: float = 1.0


def match_name(names: Sequence[str], given: str) -> list[NamedColumn]:
    """Return the columns that a name means: as it is or with a sign, as a number, a pattern, and in any case."""
    for name, sign in ((given, 1.0), (given[1:], -1.0))[: 1 + given.startswith("-")]:
        exact = [k for k, one in enumerate(names) if one == name]
        if not exact and name.startswith("#") and name[1:].isdecimal() and 0 < int(name[1:]) <= len(names):
            exact = [int(name[1:]) - 1]
        if not exact and "*" in name:
            pattern = name.lower().replace("[", "[[]")
            exact = [k for k, one in enumerate(names) if fnmatchcase(one.lower(), pattern)]
        if not exact:
            exact = [k for k, one in enumerate(names) if one.lower() == name.strip().lower()]
        if exact:
            return [NamedColumn(k, names[k], sign) for k in exact]
    return []


def join_names(names: Iterable[str]) -> str:
    """Return names with commas between them; one that contains a comma or a double quote is in double quotes."""
    return ",".join('"' + name.replace('"', '""') + '"' if re.search('[,"]', name) else name for name in names)


def _parse_columns(text: str) -> dict[str, tuple[str, ...]]:
    columns: dict[str, tuple[str, ...]] = {}
    key = ""
    for word in _split_names(text):
        name, equals, first = word.partition("=")
        if equals and name.strip() in KEYS:
            key = name.strip()
            if key in columns:
                raise ValueError(f"{key} is given twice")
            columns[key], word = (), first
        elif not key:
            known = ", ".join(QUANTITIES)
            raise ValueError(f"{word!r} names no quantity: write t=Time,acc=AX,AY,AZ,gyro=GX,GY,GZ with {known}")
        columns[key] = (*columns[key], *([word.strip()] if word.strip() else []))
    return columns


def _split_names(text: str) -> list[str]:
    if not text.strip():
        return []
    # a quoted name may follow the sign of equality, where csv does not expect it
    moved = re.sub(r'(^|,)\s*([a-z_]+)="', r'\1"\2=', text)
    try:
        return next(csv.reader([moved], skipinitialspace=True, strict=True))
    except csv.Error:
        raise ValueError(f"{text!r} has a double quote that does not end") from None


def _parse_units(text: str) -> dict[str, str]:
    units: dict[str, str] = {}
    for word in filter(None, map(str.strip, text.split(","))):
        found = find_unit(word)
        if found is None:
            known = "; ".join(", ".join(factors) for factors in UNITS.values())
            raise ValueError(f"{word!r} is no unit: {known}")
        if found[0] in units:
            raise ValueError(f"{units[found[0]]} and {found[1]} are units of the same quantity")
        units[found[0]] = found[1]
    return units
