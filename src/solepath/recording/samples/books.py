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
"""Largest number of blank cells before others in the rows of a workbook, and how many more for each cell with content:
a row of one sensor among seven has six times as many."""
DATE_STYLES = {*range(14, 23), *range(45, 48)}
"""Numbers of the built-in formats of dates and times (ECMA-376 part 1, 18.8.30)."""
DAY_0 = (datetime(1899, 12, 30), datetime(1904, 1, 1))
"""Day 0 of a workbook, with which the days from March 1900 on are right, and of one whose days count from 1904."""
BATCH = 8192
"""Number of rows of a Parquet file that are unpacked at once."""
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
    for name, attributes, text in _elements(path, sheet, "c", "row"):
        if name == "row":
            number = int(attributes.get("r", number + 1))
            if cells:
                yield number, cells
            cells = []
            continue
        column = len(cells)
        if (letters := re.match("[A-Z]{1,3}", attributes.get("r", ""))) is not None:
            column = reduce(lambda index, letter: 26 * index + ord(letter) - ord("A") + 1, letters[0], 0) - 1
        blanks, count = blanks + max(column - len(cells), 0), count + 1
        if blanks > MAX_BLANKS + BLANKS_PER_CELL * count:
            raise RecordingError(
                path, f"has {blanks:,} blank cells before others, so it is no table", f"line {number + 1}"
            )
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

    def check(length: int) -> None:
        if length > LONGEST_LINE:
            raise RecordingError(path, f"holds a text of more than {LONGEST_LINE} characters", part)

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
            check(size)

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
            unfinished += len(data)
            parser.Parse(data)
            check(unfinished)  # the parser keeps a tag, with all its attributes, until its end
            yield from found
            found.clear()
        parser.Parse(b"", True)


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
        stream.seek(0)
        read = _with_pyarrow if find_spec("pyarrow") is not None else _with_polars
        count, names, batches = read(stream)
        if count * len(names) > MAX_VALUES:
            raise RecordingError(
                path, f"holds {count:,} rows of {len(names)} columns: more than {MAX_VALUES:,} numbers"
            )
        check_ratio(path, count * len(names) * FLOAT_SIZE, size)
        yield names
        for batch in batches:
            yield from map(list, batch)


def _with_pyarrow(stream: BinaryIO) -> tuple[int, list[str], Iterator[Iterable[Any]]]:
    """Return the number of rows that the footer of a Parquet file claims, the names of its columns, and its rows."""
    from pyarrow import parquet, types

    book = parquet.ParquetFile(stream)
    names = [field.name for field in book.schema_arrow if not types.is_nested(field.type)]
    batches = book.iter_batches(BATCH, columns=names)
    rows = (zip(*[column.to_pylist() for column in batch.columns], strict=True) for batch in batches)
    return book.metadata.num_rows, names, rows


def _with_polars(stream: BinaryIO) -> tuple[int, list[str], Iterator[Iterable[Any]]]:
    """Return the same with polars."""
    import polars

    lazy = polars.scan_parquet(stream)
    names = [name for name, kind in lazy.collect_schema().items() if not kind.is_nested()]
    count = lazy.select(polars.len()).collect().item()
    rows = (lazy.select(names).slice(start, BATCH).collect().rows() for start in range(0, count, BATCH))
    return count, names, rows
