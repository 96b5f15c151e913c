"""Reads the tables that calibrations of several papers are computed from.

A table is a csv file with named columns; every mistake in it is reported with its line number."""

from __future__ import annotations

import csv
from collections.abc import Collection
from io import StringIO
from math import inf, isfinite, nan
from pathlib import Path

from ..calibration import CalibrationError
from ..calibration.file import bounded_text
from ..types.attrs import frozen


@frozen
class TableRow:
    """One line of a table, with its cells by column; `where` names file and line in messages."""

    where: str
    cells: dict[str, str]

    def has(self, column: str) -> bool:
        """Return whether the cell of this column is not empty."""
        return bool(self.cells.get(column, ""))

    def number(self, column: str, low: float = -inf, high: float = inf, unit: str = "") -> float:
        """Return the number of this column. Raise CalibrationError if it is not a number from `low` to `high`."""
        text = self.cells.get(column, "")
        try:
            value = float(text)
        except ValueError:
            value = nan
        if not isfinite(value):
            raise CalibrationError(f"{self.where}: {column} is {text!r}, not a number that is finite")
        if not low <= value <= high:
            between = f"between {low:g} and {high:g} {unit}"
            raise CalibrationError(f"{self.where}: {column} is {text}, which is not {between}")
        return value

    def one_of(self, column: str, allowed: Collection[str]) -> str:
        """Return the text of this column. Raise CalibrationError if it is not one of `allowed`."""
        text = self.cells.get(column, "")
        if text not in allowed:
            raise CalibrationError(f"{self.where}: {column} is {text!r}, not one of {', '.join(allowed)}")
        return text


def read_rows(path: Path | str, columns: Collection[str]) -> list[TableRow]:
    """Return the lines of a csv file below its header, without empty lines.

    CalibrationError is raised when the file cannot be read, does not have each of `columns` exactly once, or has a line
    whose length differs from the header's."""
    try:
        text = StringIO(bounded_text(Path(path), "utf-8-sig"), newline="")
        lines = [[cell.strip() for cell in line] for line in csv.reader(text)]
    except OSError as error:
        raise CalibrationError(f"{path}: {error.strerror}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise CalibrationError(f"{path}: is not a csv file ({error})") from None
    header = lines[0] if lines else []
    missing = [column for column in columns if header.count(column) != 1]
    if missing:
        raise CalibrationError(f"{path}, line 1: needs one column {' and one column '.join(missing)}")
    rows = []
    for number, line in enumerate(lines[1:], 2):
        if not any(line):
            continue
        if len(line) != len(header):
            raise CalibrationError(f"{path}, line {number}: {len(line)} values, and the header has {len(header)}")
        rows.append(TableRow(f"{path}, line {number}", dict(zip(header, line, strict=True))))
    return rows
