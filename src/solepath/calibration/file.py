"""Reads and writes the calibration file, and reads the tables that calibrations are computed from.

The calibration file is JSON (protocol/calibration.md), as `solepath calibrate` writes it. A table is a csv file with
named columns; every mistake in it is reported with its line number."""

from __future__ import annotations

import csv
import json
from collections.abc import Collection
from io import StringIO
from math import inf, isfinite, nan
from pathlib import Path

from ..saving.codec import SnapshotError, load, save
from ..saving.files import BeforeMove, FileTooLarge, accept_any, read_bounded, write_whole
from ..types.attrs import frozen
from ..types.checking import find_fault
from .records import Calibration, CalibrationError

FORMAT = "solepath-calibration"
VERSION = 1
MAX_FILE_SIZE = 8_000_000
"""Largest accepted size of a file, bytes: a hundred times that of two insoles of a thousand cells."""


def write_calibration(path: Path | str, calibration: Calibration, before_move: BeforeMove = accept_any) -> None:
    """Write the calibration to a file. Raise OSError when that fails; the file then has its earlier content.

    `before_move` is called before the new file replaces the earlier one, which then stays if it raises an error."""
    document = {"format": FORMAT, "version": VERSION, "calibration": save(calibration)}
    write_whole(path, json.dumps(document, indent=1, allow_nan=False) + "\n", before_move)


def read_calibration(path: Path | str) -> Calibration:
    """Return the calibration in a file.

    CalibrationError is raised when the file cannot be read, is not a calibration, or holds a value outside its limits.
    """
    try:
        document = json.loads(bounded_text(Path(path)))
    except CalibrationError:
        raise
    except OSError as error:
        raise CalibrationError(f"{path}: {error.strerror}") from None
    except ValueError as error:
        raise CalibrationError(f"{path}: is not JSON ({error})") from None
    except RecursionError:
        raise CalibrationError(f"{path}: is not a calibration: it is nested too deeply") from None
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise CalibrationError(f"{path}: is not a calibration")
    if document.get("version") != VERSION:
        raise CalibrationError(f"{path}: is of version {document.get('version')!r}; this release reads {VERSION}")
    try:
        calibration = load(Calibration, document.get("calibration"))
    except SnapshotError as error:
        content = str(error).removeprefix("not a snapshot of Calibration: ")
        raise CalibrationError(f"{path}: is not a calibration ({content})") from None
    fault = find_fault(calibration, Calibration)
    if fault is not None:
        raise CalibrationError(f"{path}: {fault}")
    return calibration


def bounded_text(path: Path, encoding: str = "utf-8") -> str:
    """Return the text of a file of at most MAX_FILE_SIZE bytes.

    CalibrationError is raised when the file is larger or has no end, OSError when it cannot be read, ValueError when it
    is not text."""
    try:
        return read_bounded(path, MAX_FILE_SIZE).decode(encoding)
    except FileTooLarge as error:
        raise CalibrationError(f"{path}: {error}, too large for what it should be") from None


@frozen
class TableRow:
    """One line of a table, with its cells by column; `where` names file and line in messages."""

    where: str
    cells: dict[str, str]

    def has(self, column: str) -> bool:
        """Return whether the cell of this column is not empty."""
        return bool(self.cells.get(column, ""))

    def word(self, column: str) -> str:
        """Return the text of this column. Raise CalibrationError when it is empty."""
        if not self.has(column):
            raise CalibrationError(f"{self.where}: nothing in column {column}")
        return self.cells[column]

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
