"""Samples in a .csv file: one row per instant; the first line names the columns.

    t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z,pressure_0,pressure_1
    t,acc_x_left,...,gyro_z_left,pressure_0_left,...,acc_x_right,...       (or t_left and t_right instead of t)

The foot may also stand before the component (acc_left_x), and 0, 1, 2 may replace x, y, z. Other columns are ignored.
In a file of both feet, a row in which all cells of one foot are blank holds no sample of that foot."""

from __future__ import annotations

import csv
import re
from pathlib import Path

import numpy as np
from attrs import define, field

from ...types import Foot
from ..errors import RecordingError, Report, open_file, printable
from .table import QUANTITIES, FootTable

_COLUMN = re.compile(r"(t|acc|gyro|pressure)(?:_(left|right))?(?:_([xyz]|[0-9]{1,4}))?(?:_(left|right))?")
_NUMBER = re.compile(r"[-+]?[0-9.]+(?:e[-+]?[0-9]+)?")
_AXES = {"x": 0, "y": 1, "z": 2}


@define
class _FootColumns:
    """The columns of one foot's values."""

    foot: Foot
    suffix: str
    time: int
    time_name: str
    places: dict[str, dict[int, int]] = field(factory=dict)
    """Column number by quantity and component."""

    def order(self) -> list[int]:
        """Return the column numbers of t and then of every quantity's components in order."""
        ordered = [self.places[q][c] for q in QUANTITIES if q in self.places for c in sorted(self.places[q])]
        return [self.time, *ordered]


def read_csv(path: Path, one_foot: Foot, report: Report) -> tuple[list[FootTable], RecordingError | None]:
    """Return the tables of the feet in the file up to the first bad row, and the reason why they end there, or None.

    A last line that was cut off goes to `report` and is left out. (A cut within the digits of the last column leaves a
    whole row, which cannot be detected.)"""
    with open_file(path) as file:
        data = file.read()
    if not data.strip():
        raise RecordingError(path, "is empty")
    # bytes that are not text appear in a column's name or as a bad number, and are reported there
    lines = data.decode("utf-8-sig", errors="replace").splitlines()
    cut_off = not data.endswith((b"\n", b"\r"))
    try:
        header = [name.strip().lower() for name in _cells(lines[0])]
        feet = _columns(header, one_foot)
    except ValueError as error:
        raise RecordingError(path, str(error), "line 1") from error
    orders = [foot.order() for foot in feet]
    values: list[list[list[float]]] = [[] for _ in feet]
    numbers: list[list[int]] = [[] for _ in feet]
    flaw: RecordingError | None = None
    for number, line in enumerate(lines[1:], start=2):
        if not line.strip():
            continue
        try:
            parsed = _parse(_cells(line), header, orders)
        except ValueError as error:
            if cut_off and number == len(lines):
                report(f"{printable(str(path))}: line {number}: cut off in the middle; everything before it is used")
            else:
                flaw = RecordingError(path, str(error), f"line {number}")
            break
        for foot_values, foot_numbers, numeric in zip(values, numbers, parsed, strict=True):
            if numeric is not None:
                foot_values.append(numeric)
                foot_numbers.append(number)
    tables = [_table(path, *parts) for parts in zip(feet, values, numbers, strict=True)]
    return [table for table in tables if len(table)], flaw


def _cells(line: str) -> list[str]:
    """Return the cells of one line. A quote that is never closed spoils this line only."""
    try:
        return next(csv.reader([line]))
    except csv.Error as error:
        raise ValueError(f"is not a row of a table ({error})") from error


def _columns(header: list[str], one_foot: Foot) -> list[_FootColumns]:
    """Return the columns of each foot; ValueError describes a fault of the names."""
    found: dict[tuple[str, str, int], int] = {}
    for number, name in enumerate(header):
        match = _COLUMN.fullmatch(name)
        if match is None or (match[2] and match[4]) or (match[1] == "t" and match[3]):
            continue
        component = _AXES[match[3]] if match[3] in _AXES else int(match[3] or 0)
        key = (match[1], match[2] or match[4] or "", component)
        if key in found:
            raise ValueError(f"names the column {name} twice")
        found[key] = number
    suffixes = sorted({suffix for quantity, suffix, _ in found if quantity != "t"})
    if "" in suffixes and len(suffixes) > 1:
        raise ValueError("has columns with and without a foot's name: is it of one foot or of two?")
    if not any(quantity in ("acc", "pressure") for quantity, _, _ in found):
        raise ValueError(f"names no column acc_x or pressure_0 ({_guess(header)})")
    feet = []
    for suffix in suffixes:
        own = ("t", suffix, 0) in found
        if not own and ("t", "", 0) not in found:
            raise ValueError("names no column t")
        foot = _FootColumns(
            foot=Foot(suffix) if suffix else one_foot,
            suffix=suffix and f"_{suffix}",
            time=found["t", suffix if own else "", 0],
            time_name=f"t_{suffix}" if own and suffix else "t",
        )
        for (quantity, of, component), number in found.items():
            if quantity != "t" and of == suffix:
                foot.places.setdefault(quantity, {})[component] = number
        _check_components(foot)
        feet.append(foot)
    return feet


def _guess(header: list[str]) -> str:
    """Return a guess at the content of the first line, where it names nothing that is needed."""
    if len(header) == 1 and re.search("[;\t]", header[0]):
        return "its columns are not separated by commas"
    if any(_NUMBER.fullmatch(name) for name in header):
        return "it holds numbers: is the line with the names missing?"
    return f"it names {printable(', '.join(header), 80)}"


def _check_components(foot: _FootColumns) -> None:
    if "gyro" in foot.places and "acc" not in foot.places:
        raise ValueError(f"names gyro{foot.suffix} but not acc{foot.suffix}")
    for quantity, components in foot.places.items():
        if quantity == "pressure":
            first = min(1, *components) if len(components) > 1 else 0
            expected = range(first, first + len(components))
            missing = [f"pressure_{c}{foot.suffix}" for c in expected if c not in components]
        else:
            missing = [f"{quantity}_{axis}{foot.suffix}" for axis, c in _AXES.items() if c not in components]
        if missing:
            raise ValueError(f"names no column {missing[0]}")
        if quantity != "pressure" and len(components) > 3:
            raise ValueError(f"names more than three columns of {quantity}{foot.suffix}")


def _parse(row: list[str], header: list[str], orders: list[list[int]]) -> list[list[float] | None]:
    """Return the numbers of each foot in this row, None where it has none; ValueError describes a fault of the row."""
    if len(row) != len(header):
        raise ValueError(f"has {len(row)} columns instead of {len(header)}")
    parsed: list[list[float] | None] = []
    for order in orders:
        if len(orders) > 1 and not any(row[c].strip() for c in order[1:]):
            parsed.append(None)
            continue
        numbers = []
        for column in order:
            try:
                numbers.append(float(row[column]))
            except ValueError:
                found = f'"{printable(row[column], 20)}"' if row[column].strip() else "blank"
                raise ValueError(f"{header[column]} is {found}, not a number") from None
        parsed.append(numbers)
    return parsed


def _table(path: Path, foot: _FootColumns, rows: list[list[float]], lines: list[int]) -> FootTable:
    array = np.array(rows, dtype=np.float64).reshape(len(rows), len(foot.order()))
    columns, start = {}, 1
    for quantity in QUANTITIES:
        width = len(foot.places.get(quantity, ()))
        if width:
            columns[quantity] = array[:, start : start + width]
            start += width
    names = {"t": foot.time_name, **{quantity: quantity + foot.suffix for quantity in columns}}
    return FootTable(path, foot.foot, names, array[:, 0], columns, lines)
