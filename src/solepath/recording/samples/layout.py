"""Finding of the layout of a table: separator, decimal mark, the line with the names, and where the numbers start."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from attrs import frozen

from ..bad_rows import LONGEST_LINE
from ..errors import printable
from ..mapping.mapping import SEPARATORS, TableMapping
from ..mapping.units import find_unit

HEAD_LINES = 200
"""Number of lines in which the start of a table is looked for; exports have some 10 lines before their header."""
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?(?:nan|inf)", re.IGNORECASE)
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
    header: int
    """Number of the line with the names; 0 for a table without a header."""
    first: int
    """Number of the first line that may hold numbers."""
    separator: str = ","
    decimal: str = "."
    preamble: tuple[str, ...] = ()
    """Lines before the header."""
    units: tuple[str, ...] = ()
    """Cells of the line of units below the header; none without such a line."""

    def locate(self) -> str:
        """Return the text that says where the names are; "" for a table without them."""
        return f"line {self.header}" if self.header else ""

    def list_names(self) -> str:
        """Return what there is instead of a column that is missing."""
        names = [name for name in self.names if name]
        if all(name.replace(".", "").replace("-", "").isdecimal() for name in names):
            return "it holds numbers: is the line with the names missing?"
        return f"it names {printable(', '.join(names), 80)}"


def splitter(separator: str) -> Callable[[str], Cells]:
    """Return the function that cuts a line into cells. Each line is cut alone: an open quote affects no other line."""

    def split(line: str) -> Cells:
        if len(line) > LONGEST_LINE:
            raise ValueError(f"is longer than {LONGEST_LINE} characters")
        if separator == " ":
            return line.split()
        if '"' not in line:
            return line.rstrip("\r\n").split(separator)
        try:
            return next(csv.reader([line], delimiter=separator))
        except csv.Error as error:
            raise ValueError(f"is not a row of a table ({error})") from error

    return split


def is_number(text: str) -> bool:
    """Return whether the text of a cell is a number, with a decimal point or comma."""
    return bool(NUMBER.fullmatch(text.strip()) or COMMA_NUMBER.fullmatch(text.strip()))


def count_numbers(texts: Sequence[str]) -> int:
    """Return the number of numbers in a row that consists of them, for half of its cells or more; otherwise 0."""
    filled = [text for text in texts if text.strip()]
    count = sum(map(is_number, filled))  # whole numbers
    return count if count >= 2 and 2 * count >= len(filled) else 0


def find_layout(path: Path, lines: Sequence[tuple[int, str]], mapping: TableMapping) -> SheetLayout:
    """Return the layout of a text file from its first lines, with their numbers; `mapping` may state parts of it.

    ValueError when a line that is stated is not there."""
    if mapping.separator is not None:
        separator = SEPARATORS[mapping.separator]
    else:
        # blanks are the last resort: texts within cells have blanks, too
        counts = {one: _count_rows(lines, one) for one in ",;\t| "}
        separator = max(",;\t|", key=counts.__getitem__)
        if not counts[separator][0]:
            most_common = max(",;\t", key=lambda one: max((text.count(one) for _, text in lines), default=0))
            separator = " " if counts[" "][0] else most_common
    split = splitter(separator)
    return find_header(path, [(number, _cut(split, text)) for number, text in lines], mapping, separator)


def _cut(split: Callable[[str], Cells], text: str) -> Cells:
    try:
        return split(text)
    except ValueError:
        return [text]


def _count_rows(lines: Sequence[tuple[int, str]], separator: str) -> tuple[int, int]:
    """Return how much of a table there is with this separator: the number of rows of numbers, and of cells in them."""
    split = splitter(separator)
    counts = [count for _, text in lines if (count := count_numbers(_cut(split, text)))]
    return len(counts), max(counts, default=0)


def find_header(
    path: Path, rows: Sequence[tuple[int, Cells]], mapping: TableMapping, separator: str = ","
) -> SheetLayout:
    """Return the layout of a table from its first rows, with their numbers."""
    filled = [(number, texts) for number, cells in rows if any(texts := list(map(_text, cells)))]
    start = next((k for k, (_, texts) in enumerate(filled) if count_numbers(texts)), None)
    named = 0 if start is None else _find_names(filled, start)
    if mapping.header is not None:
        named = next((k for k, (number, _) in enumerate(filled) if number == mapping.header), None)
        if named is None and mapping.header:
            raise ValueError(f"has no names in line {mapping.header}")
    below = start or 0 if named is None else named + 1
    if named is None:
        header, width = 0, max((len(texts) for _, texts in filled[below:]), default=0)
        names = tuple(str(k + 1) for k in range(width))
    else:
        header, (first, *rest) = filled[named]
        names = (first.lstrip("# "), *rest)  # a header may be a comment
    units: tuple[str, ...] = ()
    if below < len(filled) and _is_line_of_units(filled[below][1]):
        units, below = tuple(filled[below][1]), below + 1
    end = filled[-1][0] + 1 if filled else 1
    has_commas = separator != "," and any(COMMA_NUMBER.fullmatch(text) for _, texts in filled[below:] for text in texts)
    return SheetLayout(
        path,
        names,
        header,
        filled[below][0] if below < len(filled) else end,
        separator,
        mapping.decimal or ("," if has_commas else "."),
        tuple(separator.join(texts) for _, texts in filled[:named]),
        units,
    )


def _find_names(filled: Sequence[tuple[int, list[str]]], start: int) -> int | None:
    """Return the index of the row with the names above the first row of numbers; None if there is none as wide."""
    above = start - 1
    if above > 0 and _is_line_of_units(filled[above][1]):
        above -= 1
    width = _width(filled[above][1]) if above >= 0 else 0
    # rows of an export may lack their last cells, or have a cell more than there are names
    return above if width > 1 and (width >= _width(filled[start][1]) - 1 or above == 0) else None


def _width(texts: Sequence[str]) -> int:
    return max(k + 1 for k, text in enumerate(texts) if text)


def _is_line_of_units(cells: Sequence[str]) -> bool:
    """Return whether a row names units: all in brackets, or two or more known ones and nothing else."""
    texts = list(filter(None, cells))
    known = [find_unit(text) is not None or re.fullmatch(r"[\[(].*[\])]|-", text) is not None for text in texts]
    return len(texts) > 1 and all(known) and not any(map(is_number, texts))


def _text(cell: Any) -> str:
    return "" if is_blank(cell) else str(cell).strip()


def is_blank(cell: Any) -> bool:
    """Return whether a cell of a text file or a workbook has no content."""
    return not cell.strip() if isinstance(cell, str) else cell is None or cell != cell
