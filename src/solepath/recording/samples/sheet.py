"""Rows of cells of a text file, a workbook (Excel) or a Parquet file, with the layout that was found in its start.

A text file is read as a stream, so that it may come through a pipe. Workbooks and Parquet files need pandas or polars
(extra `tables`)."""

from __future__ import annotations

from codecs import getincrementaldecoder
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from io import TextIOWrapper
from itertools import chain, islice
from pathlib import Path
from typing import Any, TextIO

from attrs import frozen

from ...types.extras import install_hint
from ..bad_rows import LONGEST_LINE, MAX_SKIPPED, skip_line
from ..errors import RecordingError, describe_error, open_file
from ..mapping.mapping import TableMapping
from .layout import HEAD_LINES, Cells, SheetLayout, find_header, find_layout, splitter

MAX_LENGTH = 4_000_000_000
"""Largest number of characters of a file: 40 for each of MAX_VALUES. A device without end is read up to it."""
MAX_BOOK = 256_000_000
"""Largest size of a workbook or Parquet file, bytes; which is unpacked as a whole."""
BOOKS = (".xlsx", ".xlsm", ".xls", ".ods", ".parquet")
"""Suffixes of workbooks and Parquet files."""
UTF_16 = (b"\xff\xfe", b"\xfe\xff")
"""First bytes of a file in UTF-16, which Excel calls Unicode text."""


@frozen
class Row:
    """One row of a table; `cells` is None for a row that cannot be cut into cells, whose `fault` says why."""

    number: int
    """Number of the line, counted from 1."""
    cells: Cells | None
    fault: str = ""
    is_whole: bool = True
    """Flag: the line has an end; the last line of a file that was cut off has none."""


@contextmanager
def open_sheet(path: Path, mapping: TableMapping) -> Iterator[tuple[SheetLayout, Iterator[Row]]]:
    """Open a table; the value is its layout, and an iterator over its rows below the header that are not blank.

    RecordingError for a file that is empty, too large or no table."""
    if path.suffix.lower() in BOOKS:
        rows = list(_read_book(path))
        layout = _layout_of(path, find_header, rows[:HEAD_LINES], mapping)
        yield layout, (Row(number, cells) for number, cells in rows if number >= layout.first)
        return
    file = open_file(path)
    encoding = _encoding_of(file.peek(2))  # type: ignore[attr-defined]
    # bytes that are no text become part of a column's name or of a number, where they are reported
    with TextIOWrapper(file, encoding=encoding, errors="replace") as text:
        lines = _read_lines(path, text)
        head = list(islice(lines, HEAD_LINES))
        if not any(line.strip() for _, line in head):
            raise RecordingError(path, "is empty")
        if len(head[0][1]) > LONGEST_LINE:
            raise RecordingError(path, f"is longer than {LONGEST_LINE} characters", "line 1")
        layout = _layout_of(path, find_layout, head, mapping)
        yield layout, _cut_rows(chain(head, lines), layout)


def _encoding_of(start: bytes) -> str:
    """Return the encoding of a text file by its first bytes: those of UTF-16, else UTF-8, else that of Windows."""
    if start[:2] in UTF_16:
        return "utf-16"
    try:
        getincrementaldecoder("utf-8")().decode(start)  # a character may be cut off at the end
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig"


def _layout_of(path: Path, find: Any, rows: list[Any], mapping: TableMapping) -> SheetLayout:
    try:
        layout: SheetLayout = find(path, rows, mapping)
    except ValueError as error:
        repair = f"header = N, for the line with the names, in {mapping.origin or 'the mapping'}"
        raise RecordingError(path, str(error), repair=repair) from None
    if not layout.names:
        raise RecordingError(path, "is empty")
    return layout


def _cut_rows(lines: Iterable[tuple[int, str]], layout: SheetLayout) -> Iterator[Row]:
    split = splitter(layout.separator)
    for number, line in lines:
        if number >= layout.first and line.strip():
            is_whole = line.endswith("\n") or len(line) > LONGEST_LINE
            try:
                yield Row(number, split(line), is_whole=is_whole)
            except ValueError as error:
                yield Row(number, None, str(error), is_whole)


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


def _read_book(path: Path) -> Iterator[tuple[int, Cells]]:
    """Yield the rows of the first sheet of a workbook, or names and rows of a Parquet file, with their numbers."""
    with open_file(path) as file:
        if len(file.read(MAX_BOOK + 1)) > MAX_BOOK:
            raise RecordingError(path, f"is larger than {MAX_BOOK // 1_000_000} MB")
    library = next((name for name in ("pandas", "polars") if find_spec(name) is not None), None)
    if library is None:
        raise RecordingError(path, "needs pandas or polars", repair=install_hint("tables"))
    is_parquet = path.suffix.lower() == ".parquet"
    try:
        columns = _load_columns(path, library, is_parquet)
    except ImportError as error:
        what = f"cannot be read by {library}, which lacks {error.name or 'a library'}"
        raise RecordingError(path, what, repair=install_hint("tables")) from error
    except Exception as error:  # the libraries raise errors of many kinds for a damaged file
        kind = "Parquet file" if is_parquet else "workbook"
        raise RecordingError(path, f"is no whole {kind} ({describe_error(error)})") from error
    if is_parquet:
        yield 1, list(columns)
    for number, row in enumerate(zip(*columns.values(), strict=True), 2 if is_parquet else 1):
        yield number, list(row)


def _load_columns(path: Path, library: str, is_parquet: bool) -> dict[str, list[Any]]:
    if library == "polars":
        import polars

        frame = polars.read_parquet(path) if is_parquet else polars.read_excel(path, has_header=False)
        return {name: frame[name].to_list() for name in frame.columns}
    import pandas

    frame = pandas.read_parquet(path) if is_parquet else pandas.read_excel(path, header=None, dtype=object)
    return {str(name): frame[name].astype(object).tolist() for name in frame.columns}
