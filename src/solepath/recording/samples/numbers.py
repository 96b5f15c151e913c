"""Reading of the rows of a table as numbers: one table of samples for each foot, and the rows that cannot be used."""

from __future__ import annotations

import re
from array import array
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, time
from pathlib import Path
from typing import Any

import numpy as np
from attrs import define, field

from ...types import Foot
from ..bad_rows import BadRows
from ..errors import RecordingError, printable
from ..exports import OWN
from ..mapping.mapping import MEASURED
from ..mapping.units import DATETIME, UNITS
from .columns import FootColumns, TableColumns
from .layout import COMMA_NUMBER, Cells, SheetLayout
from .sheet import Row
from .table import MAX_VALUES, FootTable

SECONDS_OF_DAY = 86400.0
"""Length of a day, s: times without a date start again from 0 after it."""


def read_rows(
    path: Path, layout: SheetLayout, rows: Iterator[Row], found: TableColumns, bad_rows: BadRows
) -> list[FootTable]:
    """Return the tables of the feet, without the rows that are none of numbers, which `bad_rows` gets.

    An incomplete last line is reported and left out. It is not detected if only digits of its last column are missing,
    because the row is then complete."""
    number_of = number_reader(layout.decimal)
    feet = [_FootRows(columns, number_of) for columns in found.feet]
    width = max((k + 1 for k, name in enumerate(layout.names) if name), default=0)
    for count, row in enumerate(rows):
        try:
            if row.cells is None:
                raise ValueError(row.fault)
            cells = _fit(row.cells, len(layout.names), width)
            parsed = [foot.parse(cells, count, is_only=len(feet) == 1) for foot in feet]
        except ValueError as error:
            if row.is_whole:
                bad_rows.add(f"line {row.number}", str(error))
                continue
            text = f"line {row.number}: cut off in the middle; everything before it is used"
            bad_rows.report(f"{printable(str(path))}: {text}")
            break
        bad_rows.good += 1
        for foot, numbers in zip(feet, parsed, strict=True):
            if numbers is not None:
                foot.values.extend(numbers)
                foot.lines.append(row.number)
        if sum(len(foot.values) for foot in feet) > MAX_VALUES:  # whole numbers
            raise RecordingError(path, f"holds more than {MAX_VALUES:,} numbers")
    is_own = found.export is OWN and found.time_is_own
    return [foot.to_table(path, found, is_own=is_own) for foot in feet if len(foot.lines)]


def _fit(cells: Cells, count: int, width: int) -> Cells:
    """Return the cells of a row with those that are blank and beyond the names left out."""
    if len(cells) == count:
        return cells
    filled = max((k + 1 for k, cell in enumerate(cells) if not _is_blank(cell)), default=0)
    if filled > count or len(cells) < width:
        raise ValueError(f"has {len(cells)} columns instead of {count}")
    return cells


@define
class _FootRows:
    """The numbers of one foot, row by row."""

    columns: FootColumns
    number_of: Callable[[Any], float]
    values: array[float] = field(factory=lambda: array("d"))
    lines: array[int] = field(factory=lambda: array("q"))
    order: list[tuple[int, str, float]] = field(init=False)
    """Number, name and sign of each column of numbers, in the order of the quantities."""
    time_of: Callable[[Any], float] | None = None
    """Function from a cell to its time, in the unit of the column; None before the first row."""

    @order.default
    def _find_order(self) -> list[tuple[int, str, float]]:
        its = self.columns.columns
        return [(c.index, c.name, -1.0 if c.is_reversed else 1.0) for q in MEASURED for c in its.get(q, ())]

    def parse(self, cells: Cells, count: int, *, is_only: bool) -> list[float] | None:
        """Return the numbers of a row, its time first; None for a foot all of whose cells are blank.

        ValueError for a row with another fault."""
        if not is_only and all(_is_blank(cells[index]) for index, _, _ in self.order):
            return None
        numbers = [self._time(cells) if "t" in self.columns.columns else float(count)]
        for index, name, sign in self.order:
            try:
                numbers.append(sign * self.number_of(cells[index]))
            except (ValueError, TypeError, IndexError):
                raise ValueError(f"{name} is {_describe(cells, index)}, not a number") from None
        return numbers

    def _time(self, cells: Cells) -> float:
        (column,) = self.columns.columns["t"]
        cell = cells[column.index] if column.index < len(cells) else None
        if self.time_of is None:
            is_text = self.columns.units["t"] == DATETIME or is_datetime(cell, self.number_of)
            self.time_of = read_datetime if is_text else self.number_of
            if is_text:
                self.columns.units["t"] = DATETIME
        try:
            return self.time_of(cell)
        except (ValueError, TypeError):
            kind = "a time" if self.time_of is read_datetime else "a number"
            raise ValueError(f"{column.name} is {_describe(cells, column.index)}, not {kind}") from None

    def to_table(self, path: Path, found: TableColumns, *, is_own: bool) -> FootTable:
        """Return the rows as a table, in SI units; `is_own`: the column of times has this project's name."""
        columns, units = self.columns.columns, self.columns.units
        rows = np.frombuffer(self.values, dtype=np.float64).reshape(len(self.lines), 1 + len(self.order))
        t = rows[:, 0]
        if "t" not in columns:
            t = t / (found.mapping.rate or 1.0)
        else:
            wrap = SECONDS_OF_DAY if units["t"] == DATETIME and t[0] < SECONDS_OF_DAY else found.mapping.wrap
            if wrap is not None:
                with np.errstate(invalid="ignore"):
                    t = t + wrap * np.cumsum(np.concatenate([[0.0], np.diff(t) < -0.5 * wrap]))
            t = t * UNITS["t"][units["t"]]
        quantities, start = {}, 1
        for quantity in MEASURED:
            width = len(columns.get(quantity, ()))
            if width:
                factor = UNITS[quantity][units[quantity]]
                part = rows[:, start : start + width]
                with np.errstate(over="ignore"):  # a value that is infinite then is reported with its line
                    quantities[quantity] = part if factor == 1.0 else part * factor
                start += width
        names = {"t": self.columns.names["t"], **{quantity: self.columns.names[quantity] for quantity in quantities}}
        signed = {q: tuple(("-" if c.is_reversed else "") + c.name for c in columns[q]) for q in quantities}
        return FootTable(
            path,
            self.columns.foot or Foot.RIGHT,
            names,
            t,
            quantities,
            np.frombuffer(self.lines, dtype=np.int64),
            is_assumed=self.columns.foot is None,
            is_named=self.columns.is_named,
            units=dict(units),
            signed=signed,
            mapping=found.given,
            is_own=is_own and units["t"] == "s",
        )


def number_reader(decimal: str) -> Callable[[Any], float]:
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


def _is_blank(cell: Any) -> bool:
    return not cell.strip() if isinstance(cell, str) else cell is None or cell != cell


def _describe(cells: Cells, index: int) -> str:
    cell = cells[index] if index < len(cells) else None
    return "blank" if _is_blank(cell) else f'"{printable(str(cell), 20)}"'


def is_datetime(cell: Any, number_of: Callable[[Any], float]) -> bool:
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
