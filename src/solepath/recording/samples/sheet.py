"""Rows of cells of a text file, a workbook (Excel) or a Parquet file, with the layout that was found in its start.

A text file is read as a stream, so that it may come through a pipe. Parquet files need pyarrow or polars (extra
`tables`)."""

from __future__ import annotations

import csv
import re
from codecs import getincrementaldecoder
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from datetime import UTC, datetime, time
from io import TextIOWrapper
from itertools import chain, islice
from math import nan
from pathlib import Path
from typing import Any, TextIO

from attrs import frozen

from ..bad_rows import LONGEST_LINE, read_lines
from ..errors import UNREAD_SAMPLES, RecordingError, printable
from ..mapping.mapping import SEPARATORS, TableMapping
from ..mapping.units import find_unit
from ..unpacking import content_name, open_unpacked

MAX_LENGTH = 4_000_000_000
"""Largest number of characters of a file: 40 for each of MAX_VALUES. A device without end is read up to it."""
BOOKS = (".xlsx", ".xlsm", ".parquet")
"""Suffixes of workbooks and Parquet files."""
UTF_16 = (b"\xff\xfe", b"\xfe\xff")
"""First bytes of a file in UTF-16, which Excel calls Unicode text."""
HEAD_LINES = 200
"""Number of lines in which the start of a table is looked for; exports have some 10 lines before their header."""
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?(?:nan|inf)|n/a", re.IGNORECASE)
COMMA_NUMBER = re.compile(r"[-+]?(?:\d{1,3}(?:\.\d{3})+|\d*),\d+(?:[eE][-+]?\d+)?")
"""Patterns of a number, and of one with a decimal comma, with or without points between thousands."""

Cells = list[Any]
"""Cells of a row: texts of a text file, or values of a workbook."""


@frozen
class SheetLayout:
    """Start of a table; its rows of numbers start at line `first`."""

    path: Path
    names: tuple[str, ...]
    """Names of the columns, without blanks around them; 1, 2, 3 in a table without a header."""
    header: int = 0
    """Number of the line with the names; 0 for a table without a header."""
    first: int = 0
    """Number of the first line that may hold numbers."""
    separator: str = ","
    decimal: str = "."
    preamble: tuple[str, ...] = ()
    """Lines before the header."""
    units: tuple[str, ...] = ()
    """Cells of the line of units below the header; none without such a line."""
    example: tuple[str, ...] = ()
    """Cells of the first line that may hold numbers; none without such a line."""

    @property
    def where(self) -> str:
        """Text that says where the names are; "" for a table without them."""
        return f"line {self.header}" if self.header else ""

    @property
    def holds_numbers(self) -> bool:
        """True for names that are none."""
        return all(map(is_number, filter(None, self.names)))

    def list_names(self) -> str:
        """Return what there is instead of a column that is missing."""
        if self.holds_numbers:
            return "it holds numbers: is the line with the names missing?"
        return f"it names {printable(', '.join(filter(None, self.names)), 80)}"


@frozen
class Row:
    """One row of a table."""

    number: int
    """Number of the line, counted from 1."""
    content: str | Cells
    """Line of a text file, or cells of a workbook."""
    is_cut: bool = False
    """Flag: the last line of a file that was cut off, which has no end."""


def cut(content: str | Cells, separator: str) -> Cells:
    """Return the cells of a row. Each line is cut alone: an open quote affects no other line. ValueError for no row."""
    if not isinstance(content, str):
        return content
    if len(content) > LONGEST_LINE:
        raise ValueError(f"is longer than {LONGEST_LINE} characters")
    if separator == " ":
        return content.split()
    try:
        return next(csv.reader([content], delimiter=separator))
    except csv.Error as error:
        raise ValueError(f"is not a row of a table ({error})") from error


def is_number(text: str) -> bool:
    """Return whether the text of a cell is a number, with a decimal point or comma."""
    return bool(NUMBER.fullmatch(text.strip()) or COMMA_NUMBER.fullmatch(text.strip()))


def is_blank(cell: Any) -> bool:
    """Return whether a cell of a text file or a workbook has no content."""
    return not cell.strip() if isinstance(cell, str) else cell is None or cell != cell


def read_number(cell: Any, decimal: str) -> float:
    """Return the number in a cell with this decimal mark, NaN for one that is not available.

    ValueError or TypeError for a cell that has none."""
    if cell == "n/a":
        return nan
    if decimal == "." or not isinstance(cell, str):
        return float(cell)
    text = cell.strip()
    if COMMA_NUMBER.fullmatch(text):
        return float(text.replace(".", "").replace(",", "."))
    if "." in text:
        raise ValueError(text)  # 1.234 may be a thousand or one
    return float(text)


def read_datetime(cell: Any) -> float:
    """Return the time of a cell in s: since 1970, or since midnight without a date; without a zone it is in UTC."""
    text = re.sub(r"(\d)[.,](\d{1,6})\d*", lambda m: f"{m[1]}.{m[2]:0<6}", str(cell).strip())
    if re.match(r"\d{1,2}:", text):
        day = time.fromisoformat(text if text[1] != ":" else f"0{text}")
        return 3600.0 * day.hour + 60.0 * day.minute + day.second + 1e-6 * day.microsecond
    moment = datetime.fromisoformat(text)
    return (moment if moment.tzinfo is not None else moment.replace(tzinfo=UTC)).timestamp()


def is_datetime(text: str, decimal: str) -> bool:
    """Return whether the text of a cell is no number but a time of day, with or without a date."""
    try:
        read_number(text, decimal)
    except ValueError:
        with suppress(ValueError):
            read_datetime(text)
            return True
    return False


@contextmanager
def open_sheet(path: Path, mapping: TableMapping) -> Iterator[tuple[SheetLayout, Iterator[Row]]]:
    """Open a table; the value is its layout, and an iterator over its rows below the header that are not blank.

    RecordingError for a file that is empty, too large or no table."""
    suffix = Path(content_name(path)).suffix.lower()
    if suffix in UNREAD_SAMPLES:
        raise RecordingError(path, f"is of a kind that is not read ({suffix})", repair=UNREAD_SAMPLES[suffix])
    if suffix in BOOKS:
        from .books import read_book

        rows = (Row(number, cells) for number, cells in read_book(path) if not all(map(is_blank, cells)))
        yield _find_start(path, rows, mapping)
        return
    file = open_unpacked(path)
    encoding = encoding_of(file.peek(2))  # type: ignore[attr-defined]
    # bytes that are no text become part of a column's name or of a number, where they are reported
    with TextIOWrapper(file, encoding=encoding, errors="replace") as text:
        yield _find_start(path, _read_text(path, text), mapping)


def encoding_of(start: bytes) -> str:
    """Return the encoding of a text file by its first bytes: those of UTF-16, else UTF-8, else that of Windows."""
    if start[:2] in UTF_16:
        return "utf-16"
    if start[:2].count(0) == 1:  # UTF-16 without its mark
        return "utf-16-le" if start[0] else "utf-16-be"
    try:
        getincrementaldecoder("utf-8")().decode(start)  # a character may be cut off at the end
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig"


def _read_text(path: Path, text: TextIO) -> Iterator[Row]:
    for line in read_lines(text, "\n"):
        if line.end > MAX_LENGTH:
            raise RecordingError(path, f"is longer than {MAX_LENGTH:,} characters")
        yield Row(line.number, line.data, line.is_cut)


def _find_start(path: Path, rows: Iterator[Row], mapping: TableMapping) -> tuple[SheetLayout, Iterator[Row]]:
    head = list(islice(rows, HEAD_LINES))
    if not head:
        raise RecordingError(path, "is empty")
    if len(head[0].content) > LONGEST_LINE:
        raise RecordingError(path, f"is longer than {LONGEST_LINE} characters", f"line {head[0].number}")
    layout = _find_layout(path, head, mapping)
    return layout, (row for row in chain(head, rows) if row.number >= layout.first)


def _texts(content: str | Cells, separator: str) -> list[str]:
    """Return the texts of the cells of a row, without blanks around them."""
    try:
        return ["" if is_blank(cell) else str(cell).strip() for cell in cut(content, separator)]
    except ValueError:
        return [str(content).strip()]


def width_of(texts: Sequence[str]) -> int:
    """Return the number of cells up to the last one with content."""
    return max((k + 1 for k, text in enumerate(texts) if text), default=0)


def _count_numbers(texts: Sequence[str]) -> int:
    """Return the number of numbers in a row that consists of them, for half of its cells or more; otherwise 0."""
    count = sum(map(is_number, texts))  # whole numbers
    return count if count >= 2 and 2 * count >= len(list(filter(None, texts))) else 0


def _find_separator(head: Sequence[Row]) -> str:
    """Return the character between the cells with which there are most rows of numbers, and most numbers in a row."""

    def rank(separator: str) -> tuple[int, int, int]:
        counts = [count for row in head if (count := _count_numbers(_texts(row.content, separator)))]
        # texts within cells have blanks, too
        found = 0 if separator == " " else max(row.content.count(separator) for row in head)
        return len(counts), max(counts, default=0), found

    return max(SEPARATORS, key=rank)


def _find_layout(path: Path, head: Sequence[Row], mapping: TableMapping) -> SheetLayout:
    """Return the layout of a table from its first rows; `mapping` may state parts of it."""
    separator = mapping.separator or _find_separator(head)
    filled = [(row.number, texts) for row in head if any(texts := _texts(row.content, separator))]
    start = next((k for k, (_, texts) in enumerate(filled) if _count_numbers(texts)), None)
    named = 0 if start is None else _find_names(filled, start)
    if mapping.header is not None:
        named = next((k for k, (number, _) in enumerate(filled) if number == mapping.header), None)
        if named is None and mapping.header:
            repair = f"header = N, for the line with the names, in {mapping.origin or 'the mapping'}"
            raise RecordingError(path, f"has no names in line {mapping.header}", repair=repair)
    below = (start or 0) if named is None else named + 1
    header, units = 0, []
    if named is None:
        names = [str(k + 1) for k in range(max(len(texts) for _, texts in filled[below:]))]
    else:
        header, (first, *rest) = filled[named]
        names = [first.lstrip("# "), *rest]  # a header may be a comment
    if below < len(filled) and _is_line_of_units(filled[below][1]):
        units, below = filled[below][1], below + 1
    texts = [text for _, texts in filled[below:] for text in texts]
    has_commas = separator != "," and any(map(COMMA_NUMBER.fullmatch, texts))
    return SheetLayout(
        path,
        tuple(names),
        header,
        filled[below][0] if below < len(filled) else filled[-1][0] + 1,
        separator,
        mapping.decimal or ("," if has_commas else "."),
        tuple(separator.join(texts) for _, texts in filled[:named]),
        tuple(units),
        tuple(filled[below][1] if below < len(filled) else ()),
    )


def _find_names(filled: Sequence[tuple[int, list[str]]], start: int) -> int | None:
    """Return the index of the row with the names above the first row of numbers; None if there is none as wide.

    Rows of a sensor that did not measure yet may be between them."""
    above = start - 1
    while above > 0 and (
        _is_line_of_units(filled[above][1])
        or (
            _is_damaged(filled[above][1])
            and max(width_of(texts) for _, texts in filled[:above]) >= width_of(filled[start][1]) - 1
        )
    ):
        above -= 1
    width = width_of(filled[above][1]) if above >= 0 else 0
    # rows of an export may lack their last cells, or have a cell more than there are names
    if width < 2 or _is_damaged(filled[above][1]):
        return None
    return above if width >= width_of(filled[start][1]) - 1 or above == 0 else None


def _is_damaged(cells: Sequence[str]) -> bool:
    """Return whether a row is one of values that were not measured: it starts with a number, or says one word only."""
    return is_number(cells[0]) or is_datetime(cells[0], ".") or len({*filter(None, cells)}) == 1


def _is_line_of_units(cells: Sequence[str]) -> bool:
    """Return whether a row names units: all in brackets, or two or more known ones and nothing else."""
    texts = list(filter(None, cells))
    known = [find_unit(text) is not None or re.fullmatch(r"[\[(].*[\])]|-", text) is not None for text in texts]
    return len(texts) > 1 and all(known) and not any(map(is_number, texts))
