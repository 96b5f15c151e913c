"""Finding of the layout of a table: separator, decimal mark, the line with the names, and where the numbers start."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Sequence
from typing import Any

from attrs import field, frozen

from ..bad_rows import LONGEST_LINE
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
    """SheetLayout of a table; its rows of numbers start at line `first`."""

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
    split: Callable[[str], Cells] = field(default=str.split, eq=False)


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


def is_number(cell: Any) -> bool:
    """Return whether a cell holds a number, with a decimal point or comma."""
    if not isinstance(cell, str):
        return isinstance(cell, int | float) and not isinstance(cell, bool)
    text = cell.strip()
    return bool(NUMBER.fullmatch(text) or COMMA_NUMBER.fullmatch(text))


def count_numbers(cells: Sequence[Any]) -> int:
    """Return the number of numbers in a row that consists of them, for half of its cells or more; otherwise 0."""
    filled = [cell for cell in cells if _text(cell)]
    count = sum(map(is_number, filled))  # whole numbers
    return count if count >= 2 and 2 * count >= len(filled) else 0


def find_layout(lines: Sequence[tuple[int, str]], mapping: TableMapping) -> SheetLayout:
    """Return the layout of a text file from its first lines, with their numbers; `mapping` may state parts of it.

    ValueError when a line that is stated is not there."""
    if mapping.separator is not None:
        separator = SEPARATORS[mapping.separator]
    else:
        separator = max(",;\t|", key=lambda sep: _count_rows(lines, sep))
        if not _count_rows(lines, separator)[0] and _count_rows(lines, " ")[0]:
            separator = " "  # the last resort: texts within cells have blanks, too
        elif not _count_rows(lines, separator)[0]:
            separator = max(",;\t", key=lambda sep: max((text.count(sep) for _, text in lines), default=0))
    split = splitter(separator)
    rows = [(number, _cut(split, text)) for number, text in lines]
    return find_header(rows, mapping, separator, split)


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
    rows: Sequence[tuple[int, Cells]],
    mapping: TableMapping,
    separator: str = ",",
    split: Callable[[str], Cells] = str.split,
) -> SheetLayout:
    """Return the layout of a table from its first rows, with their numbers."""
    filled = [(number, cells) for number, cells in rows if any(_text(cell) for cell in cells)]
    start = next((k for k, (_, cells) in enumerate(filled) if count_numbers(cells)), None)
    if mapping.header:
        named = next((k for k, (number, _) in enumerate(filled) if number == mapping.header), None)
        if named is None:
            raise ValueError(f"has no names in line {mapping.header}")
    elif mapping.header == 0:
        named = None
    elif start is None:
        named = 0
    else:
        named = _find_names(filled, start)
    if named is None:
        width = max((len(cells) for _, cells in filled[start or 0 :]), default=0)
        names = tuple(str(k + 1) for k in range(width))
        header, below = 0, start or 0
    else:
        header, names = filled[named][0], tuple(_text(cell) for cell in filled[named][1])
        names = (names[0].lstrip("# "), *names[1:])  # a header may be a comment
        below = named + 1
    units: tuple[str, ...] = ()
    if below < len(filled) and _is_line_of_units(filled[below][1]):
        units, below = tuple(_text(cell) for cell in filled[below][1]), below + 1
    numbers = filled[below:] if below < len(filled) else []
    first = numbers[0][0] if numbers else (filled[-1][0] + 1 if filled else 1)
    has_commas = separator != "," and any(
        isinstance(cell, str) and COMMA_NUMBER.fullmatch(cell.strip()) for _, cells in numbers for cell in cells
    )
    return SheetLayout(
        names,
        header,
        first,
        separator,
        mapping.decimal or ("," if has_commas else "."),
        tuple(separator.join(map(_text, cells)) for _, cells in filled[:named]),
        units,
        split,
    )


def _find_names(filled: Sequence[tuple[int, Cells]], start: int) -> int | None:
    """Return the index of the row with the names above the first row of numbers; None if there is none as wide."""
    width = _width(filled[start][1])
    above = start - 1
    if above > 0 and _is_line_of_units(filled[above][1]):
        above -= 1
    if above < 0:
        return None
    names = _width(filled[above][1])
    # rows of an export may lack their last cells, or have a cell more than there are names
    return above if names > 1 and (names >= width - 1 or above == 0) else None


def _width(cells: Cells) -> int:
    return max((k + 1 for k, cell in enumerate(cells) if _text(cell)), default=0)


def _is_line_of_units(cells: Cells) -> bool:
    """Return whether a row names units: all in brackets, or two or more known ones and nothing else."""
    texts = [text for cell in cells if (text := _text(cell))]
    known = [find_unit(text) is not None or re.fullmatch(r"[\[(].*[\])]|-", text) is not None for text in texts]
    return len(texts) > 1 and all(known) and not any(is_number(text) for text in texts)


def _text(cell: Any) -> str:
    return cell.strip() if isinstance(cell, str) else "" if cell is None or cell != cell else str(cell)
