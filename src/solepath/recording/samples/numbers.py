"""Reading of the rows of a table as numbers: one table of samples for each foot, and the rows that cannot be used."""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, time
from itertools import accumulate, pairwise
from typing import Any

from attrs import define, field

from ..bad_rows import BadRows
from ..errors import RecordingError, printable
from ..exports import OWN
from ..mapping.mapping import MEASURED, NamedColumn
from ..mapping.units import DATETIME
from .columns import TableColumns
from .layout import COMMA_NUMBER, Cells, is_blank
from .sheet import Row
from .table import MAX_VALUES, FootTable, floats

SECONDS_OF_DAY = 86400.0
"""Length of a day, s: times without a date start again from 0 after it."""
Parse = Callable[[Any], float]
"""A function from a cell to its number; ValueError or TypeError for a cell that is none."""


def read_rows(rows: Iterator[Row], found: TableColumns, bad_rows: BadRows) -> list[FootTable]:
    """Return the tables of the feet, without the rows that are none of numbers, which `bad_rows` gets.

    An incomplete last line is reported and left out. It is not detected if only digits of its last column are missing,
    because the row is then complete."""
    header = found.header
    feet = [_FootRows(table, number_reader(header.decimal), len(found.feet) == 1) for table in found.feet]
    width = max((k + 1 for k, name in enumerate(header.names) if name), default=0)
    for count, row in enumerate(rows):
        try:
            if row.cells is None:
                raise ValueError(row.fault)
            cells = _fit(row.cells, len(header.names), width)
            parsed = [foot.parse(cells, float(count)) for foot in feet]
        except ValueError as error:
            if row.is_whole:
                bad_rows.add(f"line {row.number}", str(error))
                continue
            text = f"line {row.number}: cut off in the middle; everything before it is used"
            bad_rows.report(f"{printable(str(header.path))}: {text}")
            break
        bad_rows.good += 1
        for foot, numbers in zip(feet, parsed, strict=True):
            if numbers is not None:
                foot.values.extend(numbers)
                foot.lines.append(row.number)
        if sum([len(foot.values) for foot in feet]) > MAX_VALUES:
            raise RecordingError(header.path, f"holds more than {MAX_VALUES:,} numbers")
    return [foot.fill(found) for foot in feet if foot.lines]


def _fit(cells: Cells, count: int, width: int) -> Cells:
    """Return the cells of a row with those that are blank and beyond the names left out."""
    if len(cells) != count:
        filled = max((k + 1 for k, cell in enumerate(cells) if not is_blank(cell)), default=0)
        if filled > count or len(cells) < width:
            raise ValueError(f"has {len(cells)} columns instead of {count}")
    return cells


@define
class _FootRows:
    """The numbers of one foot, row by row."""

    table: FootTable
    parse_number: Parse
    is_only: bool
    """Flag: the table has no other foot."""
    values: array[float] = field(factory=floats)
    lines: array[int] = field(factory=lambda: array("q"))
    sources: list[NamedColumn] = field(init=False)
    """Columns of sensors, in the order of their quantities."""
    parse_time: Parse | None = None
    """Function from a cell to its time, in the unit of the column; None before the first row."""

    @sources.default
    def _list_sources(self) -> list[NamedColumn]:
        return [column for quantity in MEASURED for column in self.table.sources.get(quantity, ())]

    def parse(self, cells: Cells, count: float) -> list[float] | None:
        """Return the numbers of a row, its time first; None for a foot all of whose cells are blank.

        ValueError for a row with another fault."""
        if not self.is_only and all(is_blank(cells[column.index]) for column in self.sources):
            return None
        numbers = [self._time(cells) if "t" in self.table.sources else count]
        for column in self.sources:
            try:
                numbers.append(column.sign * self.parse_number(cells[column.index]))
            except (ValueError, TypeError, IndexError):
                raise ValueError(f"{column.name} is {_describe(cells, column.index)}, not a number") from None
        return numbers

    def _time(self, cells: Cells) -> float:
        (column,), units = self.table.sources["t"], self.table.units
        cell = cells[column.index] if column.index < len(cells) else None
        if self.parse_time is None:
            is_text = units["t"] == DATETIME or is_datetime(cell, self.parse_number)
            units["t"], self.parse_time = (DATETIME, read_datetime) if is_text else (units["t"], self.parse_number)
        try:
            return self.parse_time(cell)
        except (ValueError, TypeError):
            kind = "a time" if self.parse_time is read_datetime else "a number"
            raise ValueError(f"{column.name} is {_describe(cells, column.index)}, not {kind}") from None

    def fill(self, found: TableColumns) -> FootTable:
        """Return the table with the rows, in SI units."""
        table, unit, width = self.table, self.table.units.get("t"), 1 + len(self.sources)
        table.lines, t = self.lines, self.values[::width]
        columns = (self.values[k::width] for k in range(1, width))
        for quantity in filter(table.sources.__contains__, MEASURED):
            its_columns = [next(columns) for _ in table.sources[quantity]]
            table.set_quantity(quantity, its_columns, table.units[quantity])
        if unit is None:
            t = floats([number / (found.mapping.rate or 1.0) for number in t])
        else:
            wrap = SECONDS_OF_DAY if unit == DATETIME and t[0] < SECONDS_OF_DAY else found.mapping.wrap
            if wrap is not None:
                turns = accumulate([b - a < -0.5 * wrap for a, b in pairwise(t)], initial=0)
                t = floats([number + wrap * turn for number, turn in zip(t, turns, strict=True)])
        table.set_quantity("t", [t], unit or "s")
        has_own_time = found.mapping.columns.get("t", ("t",))[0].lower() == "t"
        table.is_own = found.export is OWN and has_own_time and unit == "s"
        return table


def number_reader(decimal: str) -> Parse:
    """Return the function from a cell to its number, with this decimal mark."""
    if decimal == ".":
        return float

    def read(cell: Any) -> float:
        if not isinstance(cell, str):
            return float(cell)
        text = cell.strip()
        if COMMA_NUMBER.fullmatch(text):
            return float(text.replace(".", "").replace(",", "."))
        if "." in text:
            raise ValueError(text)  # 1.234 may be a thousand or one
        return float(text)

    return read


def _describe(cells: Cells, index: int) -> str:
    cell = cells[index] if index < len(cells) else None
    return "blank" if is_blank(cell) else f'"{printable(str(cell), 20)}"'


def is_datetime(cell: Any, number_of: Parse) -> bool:
    """Return whether a cell is no number but a time of day, with or without a date."""
    if not isinstance(cell, str):
        return isinstance(cell, datetime)
    try:
        number_of(cell)
    except ValueError:
        try:
            read_datetime(cell)
        except ValueError:
            return False
        return True
    return False


def read_datetime(cell: Any) -> float:
    """Return the time of a cell in s: since 1970, or since midnight without a date; without a zone it is in UTC."""
    if isinstance(cell, datetime):
        moment = cell
    else:
        text = re.sub(r"(\d)[.,](\d{1,6})\d*", lambda m: f"{m[1]}.{m[2]:0<6}", str(cell).strip())
        if re.match(r"\d{1,2}:", text):
            day = time.fromisoformat(text if text[1] != ":" else f"0{text}")
            return 3600.0 * day.hour + 60.0 * day.minute + day.second + 1e-6 * day.microsecond
        moment = datetime.fromisoformat(text)
    return (moment if moment.tzinfo is not None else moment.replace(tzinfo=UTC)).timestamp()
