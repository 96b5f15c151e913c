"""Reads tables with named columns that people write: of a study, of a truth, of what a calibration is computed from.

Commas, semicolons or tabs part the cells, which may be texts; UTF-8, UTF-16 and what Windows writes are known, as are
workbooks and Parquet files. Every mistake is reported with its line number. Tables of samples are read by samples/."""

from __future__ import annotations

import csv
from collections.abc import Collection
from io import StringIO
from math import inf, isfinite, nan
from pathlib import Path

from ..calibration import CalibrationError
from ..saving.files import FileTooLarge, read_bounded
from ..types.attrs import frozen
from .samples.books import read_book
from .samples.sheet import BOOKS, encoding_of, is_blank

MAX_SIZE = 256_000_000
"""Largest size of a table, bytes, as of a Parquet file of samples."""
SEPARATORS = ",;\t"
NOT_KNOWN = ("", "-", "n/a", "na", "nan", "none")
"""Words for a value that is not known, in lower case."""


class TableError(CalibrationError):
    """Error for a table that cannot be used, of a calibration or of anything else."""


@frozen
class TableRow:
    """One line of a table, with its cells by column; `where` names file and line in messages."""

    where: str
    cells: dict[str, str]

    def has(self, column: str) -> bool:
        """Return whether the cell of this column has a value."""
        return self.cells.get(column, "").lower() not in NOT_KNOWN

    def number(self, column: str, low: float = -inf, high: float = inf, unit: str = "") -> float:
        """Return the number of this column. Raise TableError if it is not a number from `low` to `high`."""
        text = self.cells.get(column, "")
        try:
            value = float(text if "." in text else text.replace(",", "."))
        except ValueError:
            value = nan
        if not isfinite(value):
            raise TableError(f"{self.where}: {column} is {text!r}, not a number that is finite")
        if not low <= value <= high:
            between = f"between {low:g} and {high:g} {unit}"
            raise TableError(f"{self.where}: {column} is {text}, which is not {between}")
        return value

    def one_of(self, column: str, allowed: Collection[str]) -> str:
        """Return the text of this column. Raise TableError if it is not one of `allowed`."""
        text = self.cells.get(column, "")
        if text not in allowed:
            raise TableError(f"{self.where}: {column} is {text!r}, not one of {', '.join(allowed)}")
        return text


def read_rows(path: Path | str, columns: Collection[str]) -> list[TableRow]:
    """Return the lines of a table below its header, without empty lines; a column without a name is left out.

    TableError is raised when the file cannot be read, does not have each of `columns`, has a column twice, or has a
    line whose length differs from the header's."""
    path = Path(path)
    try:
        if path.suffix.lower() in BOOKS:
            lines = [["" if is_blank(cell) else str(cell) for cell in line] for _, line in read_book(path)]
        else:
            data = read_bounded(path, MAX_SIZE)
            text = data.decode(encoding_of(data))
            separator = max(SEPARATORS, key=text.partition("\n")[0].count)
            lines = [
                [cell.strip() for cell in line] for line in csv.reader(StringIO(text, newline=""), delimiter=separator)
            ]
    except OSError as error:
        raise TableError(f"{path}: {error.strerror}") from error
    except (UnicodeDecodeError, csv.Error, FileTooLarge) as error:
        raise TableError(f"{path}: is no table of text ({error})") from None
    header = lines[0] if lines else []
    wrong = [name for name in dict.fromkeys([*columns, *filter(None, header)]) if header.count(name) != 1]
    if wrong or not header:
        raise TableError(f"{path}, line 1: needs one column {' and one column '.join(wrong) or 'at least'}")
    rows = []
    for number, line in enumerate(lines[1:], 2):
        if not any(line):
            continue
        if len(line) != len(header):
            raise TableError(f"{path}, line {number}: {len(line)} values, and the header has {len(header)}")
        named = {name: cell for name, cell in zip(header, line, strict=True) if name}
        rows.append(TableRow(f"{path}, line {number}", named))
    return rows
