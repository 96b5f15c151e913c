"""The meaning of the columns of a table that somebody else wrote: names, units, feet, and how its text is written."""

from __future__ import annotations

import csv
import json
import re
import shlex
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import inf
from typing import Any

from attrs import evolve, field, frozen

from .units import UNITS, find_unit, unit_of

QUANTITIES = ("t", "acc", "gyro", "pressure")
"""Quantities that columns may hold: time, specific force, angular rate, and the cells of an insole."""
MEASURED = QUANTITIES[1:]
"""Quantities that sensors measure."""
COMPONENTS = {"t": 1, "acc": 3, "gyro": 3}
"""Number of components of a quantity; an insole may have any number of cells."""
KEYS = tuple(quantity + suffix for suffix in ("", "_left", "_right") for quantity in QUANTITIES)
"""Keys of columns: a quantity, alone or with the foot whose it is."""
SCALED = {"t": "s", "acc": "g", "gyro": "deg/s", "pressure": "N"}
"""Unit of each quantity in which a scale counts: 2048 counts per g."""
FORMATS = ("movella-dot", "mbientlab", "physilog", "moticon", "ngimu", "solepath")
"""Names of the known formats, which `solepath.recording.exports` defines."""
SEPARATORS = (",", ";", "\t", "|", " ")
"""Texts that may be between the cells of a line."""


def _is_positive(value: Any) -> bool:
    return type(value) in (int, float) and 0.0 < value < inf


_RULES: dict[str, tuple[Callable[[Any], bool], str]] = {
    "rate": (_is_positive, "a number above 0"),
    "wrap": (_is_positive, "a number above 0"),
    "separator": (SEPARATORS.__contains__, "one of comma, semicolon, tab, bar, blank"),
    "decimal": ((".", ",").__contains__, '"." or ","'),
    "header": (lambda value: type(value) is int and value >= 0, "the number of a line"),
    "format": (FORMATS.__contains__, f"one of the known formats {', '.join(FORMATS)}"),
}
"""Whether a value of a mapping can be used, and what it should be."""


def _to_separator(given: str | None) -> str | None:
    return "\t" if given == "tab" else given


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
    scale: Mapping[str, float] = field(factory=dict)
    """Number of counts per unit (SCALED) of each quantity, such as {"acc": 2048, "gyro": 16.4}; none for a unit."""
    rows: Mapping[str, str] = field(factory=dict)
    """Value that each of these columns has in the rows that count, such as {"device": "3"}; none for all rows."""
    wrap: float | None = None
    """Value at which a counter of time starts again from 0, s or the unit of the column; None if it never does."""
    separator: str | None = field(default=None, converter=_to_separator)
    """Character between the cells of a line, or "tab"; None: found in the file."""
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
        if faults := list(self._list_faults()):
            raise ValueError("\n".join(faults))

    def _list_faults(self) -> Iterator[str]:
        """Yield what is wrong with the values."""
        for key, names in self.columns.items():
            if key not in KEYS:
                yield f"{key} is none of {', '.join(KEYS)}"
            elif not names or not all(isinstance(name, str) and name for name in names):
                yield f"{key} has no names of columns"
            elif key.startswith("t") and len(names) != 1:
                yield f"{key} is one column, not {len(names)}"
        for quantity, unit in self.units.items():
            if quantity not in UNITS:
                yield f"{quantity} is none of {', '.join(UNITS)}"
            elif not isinstance(unit, str) or unit_of(unit, quantity) is None:
                yield f"{unit!r} is no unit of {quantity}: {', '.join(UNITS[quantity])}"
        for quantity, scale in self.scale.items():
            if quantity not in SCALED or not _is_positive(scale):
                yield f"{quantity}={scale} is no scale: counts per {', '.join(SCALED.values())} of {', '.join(SCALED)}"
            elif quantity in self.units:
                yield f"{quantity} has a unit and a scale: give one of them"
        for key, (fits, what) in _RULES.items():
            value = getattr(self, key)
            if value not in (None, "") and not fits(value):
                yield f"{key} is {value!r}, not {what}"
        for foot, pattern in self.feet.items():
            if foot not in ("left", "right") or not isinstance(pattern, str):
                yield f"{foot} is not left or right, with a pattern of names of files"

    @classmethod
    def parse(
        cls, columns: str = "", units: str = "", scale: str = "", rows: Iterable[str] = (), **more: Any
    ) -> TableMapping:
        """Return the mapping of `t=Time,acc=AX,AY,AZ`, `g,deg/s,ms`, `acc=2048,gyro=16.4` and `device=3`.

        These are the texts of --columns, --units, --scale and --rows. A name that contains a comma is in double quotes.
        ValueError says what is wrong."""
        chosen = dict(_parse_rows(rows))
        return cls(_parse_columns(columns), _parse_units(units), scale=_parse_scale(scale), rows=chosen, **more)

    def replaced(self, other: TableMapping, **more: Any) -> TableMapping:
        """Return this mapping with everything that another one states in place of its own; `more`: other fields."""
        merged = other.completed(self)
        changes = {key: getattr(merged, key) for key in ("columns", "units", "scale", "rows", "rate")}
        return evolve(self, **changes, **more)

    def completed(self, base: TableMapping) -> TableMapping:
        """Return this mapping with everything that it leaves out taken from another one."""
        own = {key.split("_")[0] for key in self.columns if "_" not in key}
        kept = {key: names for key, names in base.columns.items() if "_" not in key or key.split("_")[0] not in own}
        if self.rate is not None:  # given in place of times
            kept = {key: names for key, names in kept.items() if not key.startswith("t")}
        return evolve(
            self,
            columns={**kept, **self.columns},
            units={**{q: unit for q, unit in base.units.items() if q not in self.scale}, **self.units},
            scale={**{q: scale for q, scale in base.scale.items() if q not in self.units}, **self.scale},
            rows={**base.rows, **self.rows},
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
        return self.write_setting(key, json.dumps(names if len(names) > 1 else names[0], ensure_ascii=False))

    def write_units(self, quantity: str, changes: Mapping[str, str]) -> str:
        """Return what makes these changes: the whole --units, or the line of a quantity in the file of this mapping."""
        if not self.origin:
            return f"--units {','.join({**self.units, **changes}.values())}"
        return self.write_setting(quantity, f'"{changes[quantity]}" below [units]')

    @property
    def untimed(self) -> TableMapping:
        """This mapping without columns of times."""
        return evolve(self, columns={key: names for key, names in self.columns.items() if not key.startswith("t")})

    def write_rate(self, rate: str) -> str:
        """Return what gives the rows a rate in place of times."""
        if self.origin:
            return f"{self.write_setting('rate', rate)}, and no t below [columns]"
        return f"{self.untimed.write_columns('', {}) + ' ' if self.columns else ''}{self.write_setting('rate', rate)}"

    def write_scale(self, changes: Mapping[str, str]) -> str:
        """Return what gives these scales: the whole --scale, or lines in the file of this mapping."""
        scales = {**{quantity: f"{scale:.6g}" for quantity, scale in self.scale.items()}, **changes}
        return self._write_lines("scale", changes) if self.origin else f"--scale {_join(scales)}" if scales else ""

    def write_rows(self, changes: Mapping[str, str]) -> str:
        """Return what chooses these rows: all of --rows, or lines in the file of this mapping."""
        chosen = [f"--rows {shlex.quote(_join({name: value}))}" for name, value in {**self.rows, **changes}.items()]
        lines = {json.dumps(name): json.dumps(value) for name, value in changes.items()}
        return self._write_lines("rows", lines) if self.origin else " ".join(chosen)

    def _write_lines(self, table: str, changes: Mapping[str, str]) -> str:
        return (
            f"in {self.origin}: {', '.join([f'{name} = {value}' for name, value in changes.items()])} below [{table}]"
        )

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
    numbers = {f"#{k}": [k - 1] for k in range(1, len(names) + 1)}
    for name, sign in ((given, 1.0), (given[1:], -1.0))[: 1 + given.startswith("-")]:
        pattern = re.compile(re.escape(name.strip()).replace(r"\*", ".*"), re.IGNORECASE)
        found = [k for k, one in enumerate(names) if one == name] or numbers.get(name)
        found = found or [k for k, one in enumerate(names) if pattern.fullmatch(one)]
        if found:
            return [NamedColumn(k, names[k], sign) for k in found]
    return []


def _join(values: Mapping[str, str]) -> str:
    return ",".join([f"{name}={value}" for name, value in values.items()])


def join_names(names: Iterable[str]) -> str:
    """Return names with commas between them; one that contains a comma or a double quote is in double quotes."""
    return ",".join('"' + name.replace('"', '""') + '"' if re.search('[,"]', name) else name for name in names)


def _parse_columns(text: str) -> dict[str, tuple[str, ...]]:
    # a quoted name may follow the sign of equality, where csv does not expect it
    moved = re.sub(r'(^|,)\s*([a-z_]+)="', r'\1"\2=', text)
    try:
        words = next(csv.reader([moved], skipinitialspace=True, strict=True), [])
    except csv.Error:
        raise ValueError(f"{text!r} has a double quote that does not end") from None
    columns: dict[str, tuple[str, ...]] = {}
    key = ""
    for word in filter(str.strip, words):
        name, equals, first = word.partition("=")
        if equals and name.strip() in KEYS:
            key, word = name.strip(), first
            if key in columns:
                raise ValueError(f"{key} is given twice")
        elif not key:
            known = ", ".join(QUANTITIES)
            raise ValueError(f"{word!r} names no quantity: write t=Time,acc=AX,AY,AZ,gyro=GX,GY,GZ with {known}")
        columns[key] = (*columns.get(key, ()), *filter(None, [word.strip()]))
    return columns


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


def _parse_scale(text: str) -> dict[str, float]:
    scales: dict[str, float] = {}
    for word in filter(str.strip, text.split(",")):
        quantity, _, number = map(str.strip, word.partition("="))
        try:
            if quantity not in SCALED or quantity in scales:
                raise ValueError
            scales[quantity] = float(number)
        except ValueError:
            raise ValueError(f"{word!r} is no scale: write acc=2048,gyro=16.4, counts per g and per deg/s") from None
    return scales


def _parse_rows(texts: Iterable[str]) -> Iterator[tuple[str, str]]:
    for text in texts:
        name, equals, value = map(str.strip, text.rpartition("="))
        if not equals or not name:
            raise ValueError(f"{text!r} chooses no rows: write COLUMN=VALUE, as in device=3")
        yield name, value
