"""Reading of samples from a .csv file, whose first line names the columns, and whose other lines have one time each.

    t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z,pressure_0,pressure_1
    t,acc_x_left,...,gyro_z_left,pressure_0_left,...,acc_x_right,...       (or t_left and t_right instead of t)

The foot may also be named before the component (acc_left_x), and 0, 1, 2 may replace x, y, z. Other columns are
ignored. In a file of both feet, a row in which all cells of one foot are blank has no sample of that foot."""

from __future__ import annotations

import csv
import re
from array import array
from collections.abc import Iterator
from io import TextIOWrapper
from pathlib import Path
from typing import TextIO

import numpy as np
from attrs import define, field

from ...types import Foot
from ..bad_rows import LONGEST_LINE, MAX_SKIPPED, BadRows, skip_line
from ..errors import RecordingError, open_file, printable
from .table import MAX_VALUES, QUANTITIES, FootTable

MAX_LENGTH = 4_000_000_000
"""Largest number of characters of a file: 40 for each of MAX_VALUES. A device without end is read up to it."""

_COLUMN = re.compile(r"(t|acc|gyro|pressure)(?:_(left|right))?(?:_([xyz]|[0-9]{1,4}))?(?:_(left|right))?")
_NUMBER = re.compile(r"[-+]?[0-9.]+(?:e[-+]?[0-9]+)?")
_AXES = {"x": 0, "y": 1, "z": 2}


@define
class _FootColumns:
    """The column numbers of one foot's values."""

    foot: Foot
    suffix: str
    time: int
    time_name: str
    column_numbers: dict[str, dict[int, int]] = field(factory=dict)
    """Column number by quantity and component."""

    def list_columns(self) -> list[int]:
        """Return the column number of t, then those of every quantity's components in order."""
        ordered = [
            self.column_numbers[q][c]
            for q in QUANTITIES
            if q in self.column_numbers
            for c in sorted(self.column_numbers[q])
        ]
        return [self.time, *ordered]


def read_csv(path: Path, one_foot: Foot, bad_rows: BadRows) -> list[FootTable]:
    """Return the tables of the feet, without the lines that are no row of numbers, which `bad_rows` gets.

    An incomplete last line is reported and left out. It is not detected if only digits of its last column are missing,
    because the row is then complete. RecordingError for a file that is no table, or that is too large."""
    # bytes that are no text become part of a column's name or of a number, where they are reported
    with TextIOWrapper(open_file(path), encoding="utf-8-sig", errors="replace") as file:
        lines = _read_lines(path, file)
        number, line = next(lines, (1, ""))
        if not line.strip():
            line = next((text for _, text in lines if text.strip()), "")
            raise RecordingError(path, "has an empty first line" if line else "is empty", "line 1" if line else "")
        try:
            header = [name.strip().lower() for name in _split_cells(line)]
            feet = _find_columns(header, one_foot)
        except ValueError as error:
            raise RecordingError(path, str(error), "line 1") from error
        orders = [foot.list_columns() for foot in feet]
        values, line_numbers = [array("d") for _ in feet], [array("q") for _ in feet]
        for number, line in lines:
            if not line.strip():
                continue
            try:
                parsed = _parse_row(_split_cells(line), header, orders)
            except ValueError as error:
                if line.endswith("\n") or len(line) > LONGEST_LINE:
                    bad_rows.add(f"line {number}", str(error))
                    continue
                text = f"line {number}: cut off in the middle; everything before it is used"
                bad_rows.report(f"{printable(str(path))}: {text}")
                break
            bad_rows.good += 1
            for foot_values, foot_numbers, numeric in zip(values, line_numbers, parsed, strict=True):
                if numeric is not None:
                    foot_values.extend(numeric)
                    foot_numbers.append(number)
            if sum(map(len, values)) > MAX_VALUES:
                raise RecordingError(path, f"holds more than {MAX_VALUES:,} numbers")
    tables = [_make_table(path, *parts) for parts in zip(feet, values, line_numbers, strict=True)]
    return [table for table in tables if len(table)]


def _read_lines(path: Path, file: TextIO) -> Iterator[tuple[int, str]]:
    """Yield each line with its number; RecordingError for a file that is too long for a table.

    Of a line that is too long only the start is yielded; after MAX_SKIPPED characters of it the file ends there."""
    number = size = 0
    while line := file.readline(LONGEST_LINE + 1):
        number, size, skipped = number + 1, size + len(line), 0
        if len(line) > LONGEST_LINE and not line.endswith("\n"):
            skipped, _ = skip_line(file, "\n")
        size += skipped
        if size > MAX_LENGTH:
            raise RecordingError(path, f"is longer than {MAX_LENGTH:,} characters")
        yield number, line
        if skipped >= MAX_SKIPPED:
            return


def _split_cells(line: str) -> list[str]:
    """Return the cells of one line; each line is parsed alone, so that an open quote affects no other line."""
    if len(line) > LONGEST_LINE:
        raise ValueError(f"is longer than {LONGEST_LINE} characters")
    try:
        return next(csv.reader([line]))
    except csv.Error as error:
        raise ValueError(f"is not a row of a table ({error})") from error


def _find_columns(header: list[str], one_foot: Foot) -> list[_FootColumns]:
    """Return the columns of each foot; a fault of the names raises ValueError."""
    columns: dict[tuple[str, str, int], int] = {}
    for number, name in enumerate(header):
        match = _COLUMN.fullmatch(name)
        if match is None or (match[2] and match[4]) or (match[1] == "t" and match[3]):
            continue
        component = _AXES[match[3]] if match[3] in _AXES else int(match[3] or 0)
        key = (match[1], match[2] or match[4] or "", component)
        if key in columns:
            raise ValueError(f"names the column {name} twice")
        columns[key] = number
    suffixes = sorted({suffix for quantity, suffix, _ in columns if quantity != "t"})
    if "" in suffixes and len(suffixes) > 1:
        raise ValueError("has columns with and without a foot's name: is it of one foot or of two?")
    if not any(quantity in ("acc", "pressure") for quantity, _, _ in columns):
        raise ValueError(f"names no column acc_x or pressure_0 ({_guess_content(header)})")
    feet = []
    for suffix in suffixes:
        has_own_time = ("t", suffix, 0) in columns
        if not has_own_time and ("t", "", 0) not in columns:
            raise ValueError("names no column t")
        foot = _FootColumns(
            foot=Foot(suffix) if suffix else one_foot,
            suffix=suffix and f"_{suffix}",
            time=columns["t", suffix if has_own_time else "", 0],
            time_name=f"t_{suffix}" if has_own_time and suffix else "t",
        )
        for (quantity, foot_name, component), number in columns.items():
            if quantity != "t" and foot_name == suffix:
                foot.column_numbers.setdefault(quantity, {})[component] = number
        _check_components(foot)
        feet.append(foot)
    return feet


def _guess_content(header: list[str]) -> str:
    """Return a guess at the content of a first line that names none of the required columns."""
    if len(header) == 1 and re.search("[;\t]", header[0]):
        return "its columns are not separated by commas"
    if any(_NUMBER.fullmatch(name) for name in header):
        return "it holds numbers: is the line with the names missing?"
    return f"it names {printable(', '.join(header), 80)}"


def _check_components(foot: _FootColumns) -> None:
    if "gyro" in foot.column_numbers and "acc" not in foot.column_numbers:
        raise ValueError(f"names gyro{foot.suffix} but not acc{foot.suffix}")
    for quantity, components in foot.column_numbers.items():
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


def _parse_row(row: list[str], header: list[str], orders: list[list[int]]) -> list[list[float] | None]:
    """Return the numbers of each foot in this row, None for a blank foot; a fault of the row raises ValueError."""
    if len(row) != len(header):
        raise ValueError(f"has {len(row)} columns instead of {len(header)}")
    parsed: list[list[float] | None] = []
    for column_order in orders:
        if len(orders) > 1 and not any(row[c].strip() for c in column_order[1:]):
            parsed.append(None)
            continue
        row_values = []
        for column in column_order:
            try:
                row_values.append(float(row[column]))
            except ValueError:
                cell_text = f'"{printable(row[column], 20)}"' if row[column].strip() else "blank"
                raise ValueError(f"{header[column]} is {cell_text}, not a number") from None
        parsed.append(row_values)
    return parsed


def _make_table(path: Path, foot: _FootColumns, values: array[float], lines: array[int]) -> FootTable:
    rows = np.frombuffer(values, dtype=np.float64).reshape(len(lines), len(foot.list_columns()))
    columns, start = {}, 1
    for quantity in QUANTITIES:
        width = len(foot.column_numbers.get(quantity, ()))
        if width:
            columns[quantity] = rows[:, start : start + width]
            start += width
    names = {"t": foot.time_name, **{quantity: quantity + foot.suffix for quantity in columns}}
    return FootTable(path, foot.foot, names, rows[:, 0], columns, np.frombuffer(lines, dtype=np.int64))
