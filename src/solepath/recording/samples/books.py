"""Rows of workbooks (.xlsx) and Parquet files, one after the other, so that their size takes no memory.

A workbook is a .zip of XML (ECMA-376 part 1, 18). It is read as a stream with what Python brings: what it claims of its
dimensions is not used, blank cells cost nothing, and entities, which could grow without end, are rejected. Parquet
needs pyarrow or polars (extra `tables`)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence, Set
from contextlib import suppress
from datetime import datetime, timedelta
from functools import reduce
from importlib.util import find_spec
from io import SEEK_END, BytesIO
from pathlib import Path, PurePosixPath
from typing import Any, BinaryIO, NoReturn
from xml.parsers.expat import ParserCreate

from ...types.extras import install_hint
from ..bad_rows import LONGEST_LINE
from ..errors import RecordingError, describe_error
from ..unpacking import check_ratio, content_name, open_member, open_unpacked
from .table import FLOAT_SIZE, MAX_VALUES

MAX_BOOK = 256_000_000
"""Largest size of a Parquet file, and of a workbook that is compressed, bytes."""
CHUNK = 65_536
"""Number of bytes of XML that are parsed at once."""
MAX_TEXTS = 1_000_000
"""Largest number of texts that the cells of a workbook share: a table of samples has its names, and labels."""
MAX_BLANKS, BLANKS_PER_CELL = 100_000, 20
"""Largest number of blank rows, and cells before others, of a workbook, and how many more for each cell with content: a
row of one sensor among seven has six times as many."""
BLANK_ROW = re.compile(rb'<row r="\d+"[^<>]*(?:/>|></row>)')
"""XML of a blank row as Excel writes it for a format, up to its last row: the others have their numbers without it."""
DATE_STYLES = {*range(14, 23), *range(45, 48)}
"""Numbers of the built-in formats of dates and times (ECMA-376 part 1, 18.8.30)."""
DAY_0 = (datetime(1899, 12, 30), datetime(1904, 1, 1))
"""Day 0 of a workbook, with which the days from March 1900 on are right, and of one whose days count from 1904."""
BATCH, BATCH_CELLS = 8192, 500_000
"""Largest number of rows of a Parquet file that are unpacked at once, and of their cells."""
MAX_COLUMNS = 10_000
"""Largest number of columns of a Parquet file: 4,000 pressure cells of two feet take less."""
FOOTER_END, FOOTER_SIZE = 8, 4
"""Number of bytes before the end of a Parquet file at which the size of its footer is, and of bytes that it has."""
MAX_FOOTER = 5_000_000
"""Largest size of what a Parquet file says of its columns and groups of rows, bytes; in memory it is 16 times as large,
and 10,000 columns take 2 MB."""
VALUES = {"v", "t"}
"""Elements with the value of a cell, or the text that cells share."""


def read_book(path: Path) -> Iterator[tuple[int, list[Any]]]:
    """Yield number and cells of the rows of a workbook's first sheet; or names, and rows, of a Parquet file.

    RecordingError for a file that is no whole one, and for one that would take far more memory than it has bytes."""
    is_parquet = Path(content_name(path)).suffix.lower() == ".parquet"
    try:
        yield from enumerate(_read_parquet(path), 1) if is_parquet else _read_sheet(path)
    except (RecordingError, GeneratorExit):
        raise
    except ImportError as error:
        raise RecordingError(path, "needs pyarrow or polars", repair=install_hint("tables")) from error
    except Exception as error:  # expat and the libraries raise errors of many kinds for a damaged file
        kind = "Parquet file" if is_parquet else "workbook (.xlsx)"
        raise RecordingError(path, f"is no whole {kind} ({describe_error(error)})") from error


def _read_sheet(path: Path) -> Iterator[tuple[int, list[Any]]]:
    """Yield the rows of the first sheet of a workbook that have cells."""
    relations = [attributes for _, attributes, _ in _elements(path, "xl/_rels/workbook.xml.rels", "Relationship")]
    parts = {
        kind: {
            one["Id"]: str(PurePosixPath("/xl") / one["Target"])[1:] for one in relations if one["Type"].endswith(kind)
        }
        for kind in ("/worksheet", "/sharedStrings", "/styles")
    }
    settings, ids = dict[str, str](), list[str]()
    for name, attributes, _ in _elements(path, "xl/workbook.xml", "workbookPr", "sheet"):
        if name == "sheet":
            ids.append(attributes.get("id", ""))
        else:
            settings = attributes
    day_0 = DAY_0[settings.get("date1904", "0") in ("1", "true")]
    texts = list[str]()
    for part in parts["/sharedStrings"].values():
        for _, _, text in _elements(path, part, "si"):
            texts.append(text)
            if len(texts) > MAX_TEXTS:
                raise RecordingError(path, f"holds more than {MAX_TEXTS:,} texts")
    dates = {style for part in parts["/styles"].values() for style in _date_styles(path, part)}
    sheet = next(parts["/worksheet"][one] for one in ids if one in parts["/worksheet"])
    cells: list[Any] = []
    number = blanks = count = 0

    def check_blanks() -> None:
        if blanks > MAX_BLANKS + BLANKS_PER_CELL * count:
            what = f"has {blanks:,} blank rows, and cells before others, so it is no table"
            raise RecordingError(path, what, f"line {number + 1}")

    for name, attributes, text in _elements(path, sheet, "c", "row"):
        if name == "row":
            number = int(attributes.get("r", number + 1))
            if cells:
                yield number, cells
            blanks += not cells
            check_blanks()
            cells = []
            continue
        column = len(cells)
        if (letters := re.match("[A-Z]{1,3}", attributes.get("r", ""))) is not None:
            column = reduce(lambda index, letter: 26 * index + ord(letter) - ord("A") + 1, letters[0], 0) - 1
        blanks, count = blanks + max(column - len(cells), 0), count + 1
        check_blanks()
        cells += [None] * (column - len(cells))
        cells[column:] = [_value(attributes, text, texts, dates, day_0)]


def _value(attributes: dict[str, str], text: str, texts: Sequence[str], dates: Set[str], day_0: datetime) -> Any:
    """Return what a cell holds: a number, a text, None without content, or a date as text."""
    kind = attributes.get("t", "n")
    if kind == "s":
        return texts[int(text)]
    if kind not in ("n", "b") or not text:
        return text or None
    if attributes.get("s") in dates:
        days = float(text)
        moment = day_0 + timedelta(days=days)
        return (moment.time() if days < 1.0 else moment).isoformat()
    with suppress(ValueError):
        return int(text)
    return float(text)


def _date_styles(path: Path, part: str) -> set[str]:
    """Return the numbers of the styles that show a number as a date or a time."""
    formats = dict[str, str]()
    styles = list[str]()
    for name, attributes, _ in _elements(path, part, "numFmt", "xf", "cellStyleXfs"):
        if name == "numFmt":
            formats[attributes["numFmtId"]] = re.sub(r'"[^"]*"|\\.|\[[^\]]*\]', "", attributes.get("formatCode", ""))
        elif name == "xf":
            styles.append(attributes.get("numFmtId", "0"))
        else:
            styles.clear()  # those of named styles come first, and the numbers are of those of cells
    return {
        str(number)
        for number, style in enumerate(styles)
        if int(style) in DATE_STYLES or re.search("[ymdhs]", formats.get(style, ""), re.IGNORECASE)
    }


def _elements(path: Path, part: str, *names: str) -> Iterator[tuple[str, dict[str, str], str]]:
    """Yield name, attributes and text of the elements of these names in a part of a workbook, each at its end.

    The text is that of its value, without a formula and without how it is pronounced."""
    parser, found, attributes_of = ParserCreate(), list[tuple[str, dict[str, str], str]](), dict[str, dict[str, str]]()
    text, within, size, unfinished = list[str](), set[str](), 0, 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal size, unfinished
        unfinished = 0
        name = name.rpartition(":")[2]
        within.add(name)
        if name in names:
            attributes_of[name] = {key.rpartition(":")[2]: value for key, value in attributes.items()}
            text.clear()
            size = 0

    def add(data: str) -> None:
        nonlocal size, unfinished
        unfinished = 0
        if not within.isdisjoint(VALUES) and "rPh" not in within:
            text.append(data)
            size += len(data)
            _check_text(path, size, part)

    def end(name: str) -> None:
        name = name.rpartition(":")[2]
        within.discard(name)
        if name in names:
            found.append((name, attributes_of[name], "".join(text)))

    def reject(*_: Any) -> NoReturn:
        raise RecordingError(path, "has a DOCTYPE, which no workbook has", part)

    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = start, end, add
    parser.StartDoctypeDeclHandler, parser.buffer_text = reject, True
    with open_member(path, part, _open_book(path)) as file:
        while data := file.read(CHUNK):
            data = BLANK_ROW.sub(b"", data)
            unfinished += len(data)
            parser.Parse(data)
            _check_text(path, unfinished, part)  # the parser keeps a tag, with all its attributes, until its end
            yield from found
            found.clear()
        parser.Parse(b"", True)


def _check_text(path: Path, length: int, part: str = "") -> None:
    if length > LONGEST_LINE:
        raise RecordingError(path, f"holds a text of more than {LONGEST_LINE} characters", part)


def _open_book(path: Path) -> BinaryIO:
    """Return a book opened for reading at any place; one that is compressed is read into memory."""
    file = open_unpacked(path)
    if file.seekable():
        return file
    with file:
        return BytesIO(file.read(MAX_BOOK))


def _read_parquet(path: Path) -> Iterator[list[Any]]:
    """Yield the names of the columns of a Parquet file, then its rows; a nested column holds no samples."""
    with _open_book(path) as stream:
        size = stream.seek(0, SEEK_END)
        if size >= MAX_BOOK:
            raise RecordingError(path, f"is larger than {MAX_BOOK // 1_000_000} MB")
        stream.seek(max(size - FOOTER_END, 0))
        footer = int.from_bytes(stream.read(FOOTER_SIZE), "little")
        if MAX_FOOTER < footer < size:
            what = f"needs {footer:,} bytes to list its columns and groups of rows: more than {MAX_FOOTER:,}"
            raise RecordingError(path, what, repair="write it with fewer columns, or with larger groups of rows")
        stream.seek(0)
        read = _with_pyarrow if find_spec("pyarrow") is not None else _with_polars
        count, unpacked, names, batches = read(path, stream)
        if len(names) > MAX_COLUMNS:
            raise RecordingError(path, f"has {len(names):,} columns: more than {MAX_COLUMNS:,}")
        if count * len(names) > MAX_VALUES:
            raise RecordingError(
                path, f"holds {count:,} rows of {len(names)} columns: more than {MAX_VALUES:,} numbers"
            )
        check_ratio(path, max(count * len(names) * FLOAT_SIZE, unpacked), size)
        yield names
        for batch in batches:
            yield from map(list, batch)


def _batch_size(names: Sequence[str]) -> int:
    """Return the number of rows that are unpacked at once."""
    return max(min(BATCH, BATCH_CELLS // max(len(names), 1)), 1)


def _with_pyarrow(path: Path, stream: BinaryIO) -> tuple[int, int, list[str], Iterator[Iterable[Any]]]:
    """Return the numbers of rows and of unpacked bytes that a Parquet file claims, names of its columns, and its rows.

    A text that many rows share is there once, in the file as in memory."""
    from pyarrow import compute, parquet, types

    claimed = parquet.read_metadata(stream)
    paths = [claimed.schema.column(k).path for k in range(claimed.num_columns)]
    book = parquet.ParquetFile(stream, metadata=claimed, read_dictionary=paths)
    kinds = book.schema_arrow
    names = [one.name for one in kinds if not types.is_nested(one.type) and not types.is_fixed_size_binary(one.type)]
    unpacked = sum(claimed.row_group(k).total_byte_size for k in range(claimed.num_row_groups))

    def cells(column: Any) -> list[Any]:
        if not types.is_dictionary(column.type):
            return column.to_pylist()  # type: ignore[no-any-return]
        shared = column.indices.dictionary_encode()  # a column has texts of other batches, too
        texts = column.dictionary.take(shared.dictionary)
        _check_text(path, compute.max(compute.binary_length(texts)).as_py() or 0)
        known = [*texts.to_pylist(), None]
        return [known[index] for index in compute.fill_null(shared.indices, len(texts)).to_pylist()]

    batches = book.iter_batches(_batch_size(names), columns=names)
    rows = (zip(*map(cells, batch.columns), strict=True) for batch in batches)
    return claimed.num_rows, unpacked, names, rows


def _with_polars(path: Path, stream: BinaryIO) -> tuple[int, int, list[str], Iterator[Iterable[Any]]]:
    """Return the same with polars, which does not tell what a file unpacks to."""
    import polars

    lazy = polars.scan_parquet(stream)
    names = [name for name, kind in lazy.collect_schema().items() if not kind.is_nested()]
    count = lazy.select(polars.len()).collect().item()

    def unpack(start: int) -> Iterator[Any]:
        frame = lazy.select(names).slice(start, size).collect()
        for column in frame.select(polars.col(polars.String).str.len_bytes().max()):
            _check_text(path, column.item() or 0)
        return frame.iter_rows()

    size = _batch_size(names)
    return count, 0, names, map(unpack, range(0, count, size))
