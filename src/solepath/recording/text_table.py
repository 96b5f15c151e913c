"""Reads a table of words and numbers that a person or a program wrote: participants of a study, or a truth.

Its first line has the names. It is in UTF-8 (with or without a mark) or as Windows or Excel write it, with commas,
semicolons or tabs between the cells, or a workbook or Parquet file. Columns of a table of samples are read by
samples/."""

from __future__ import annotations

import csv
from contextlib import suppress
from io import StringIO
from math import isfinite
from pathlib import Path

from attrs import frozen

from .errors import RecordingError, open_file, printable
from .samples.books import read_book
from .samples.sheet import BOOKS, encoding_of, is_blank

SEPARATORS = ",;\t"
MISSING = ("", "-", "n/a", "na", "nan", "none")
"""Words for a value that is not known, in lower case."""


@frozen
class TextTable:
    """A table of texts without blanks around them; a column without a name, such as an index, is left out."""

    path: Path
    columns: tuple[str, ...]
    rows: tuple[dict[str, str], ...]
    """Cells of each row by column; a row without any content is left out."""

    def number(self, row: dict[str, str], column: str) -> float | None:
        """Return the number in a cell, with a decimal point or comma; None for a value that is not known.

        RecordingError, naming the row, for a text that is no number."""
        text = row.get(column, "")
        if text.lower() in MISSING:
            return None
        with suppress(ValueError):
            if isfinite(value := float(text if "." in text else text.replace(",", "."))):
                return value
        what = f"{printable(column)} is no number: {printable(text, 40)}"
        raise RecordingError(self.path, what, f"row {self.rows.index(row) + 1} below the names")


def read_text_table(path: Path) -> TextTable:
    """Return the table in a file; raise RecordingError for a file that is empty, or names a column twice."""
    if path.suffix.lower() in BOOKS:
        cells = [["" if is_blank(cell) else str(cell) for cell in row] for _, row in read_book(path)]
    else:
        with open_file(path) as file:
            data = file.read()
        text = data.decode(encoding_of(data), errors="replace")
        first = text.lstrip().partition("\n")[0]
        cells = [*csv.reader(StringIO(text), delimiter=max(SEPARATORS, key=first.count))]
    names, *rows = [[cell.strip() for cell in row] for row in cells if any(map(str.strip, row))] or [[]]
    known = [name for name in names if name]
    if not known:
        raise RecordingError(path, "is empty; its first line has the names of the columns")
    if twice := [name for name in known if known.count(name) > 1]:
        raise RecordingError(path, f"has two columns with the name {printable(twice[0])}")
    if long := next((k for k, row in enumerate(rows, 1) if any(row[len(names) :])), None):
        what = "has more cells than there are names; a text with the separator in it needs quotes"
        raise RecordingError(path, what, f"row {long} below the names")
    by_name = [dict(zip(names, [*row, *[""] * len(names)], strict=False)) for row in rows]
    return TextTable(path, tuple(known), tuple([{name: row[name] for name in known} for row in by_name]))
