"""Reading of the rows of a table as numbers: one table of samples for each foot, and the rows that cannot be used."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import accumulate, pairwise
from typing import Any

from attrs import define, field

from ..bad_rows import BadRows
from ..errors import RecordingError, printable
from ..exports import OWN
from ..mapping.mapping import MEASURED, QUANTITIES, NamedColumn
from ..mapping.units import DATETIME
from .columns import TableColumns
from .sheet import Cells, Row, cut, is_blank, read_datetime, read_number
from .table import MAX_VALUES, FootTable, floats

SECONDS_OF_DAY = 86400.0
"""Length of a day, s: times without a date start again from 0 after it."""


def read_rows(rows: Iterator[Row], found: TableColumns, bad_rows: BadRows) -> list[FootTable]:
    """Return the tables of the feet, without the rows that are none of numbers, which `bad_rows` gets.

    An incomplete last line is reported and left out. It is not detected if only digits of its last column are missing,
    because the row is then complete."""
    header = found.header
    feet = [_FootRows(table, header.decimal, len(found.feet) == 1) for table in found.feet]
    width = max((k + 1 for k, name in enumerate(header.names) if name), default=0)
    for count, row in enumerate(rows):
        try:
            cells = cut(row.content, header.separator)
            if len(cells) < width or not all(map(is_blank, cells[len(header.names) :])):
                raise ValueError(f"has {len(cells)} columns instead of {len(header.names)}")
            parsed = [foot.parse(cells, float(count)) for foot in feet]
        except ValueError as error:
            if row.is_cut:
                text = f"line {row.number}: cut off in the middle; everything before it is used"
                bad_rows.report(f"{printable(str(header.path))}: {text}")
                break
            bad_rows.add(f"line {row.number}", str(error))
            continue
        bad_rows.good += 1
        for foot, numbers in zip(feet, parsed, strict=True):
            if numbers:
                foot.values.extend(numbers)
                foot.lines.append(row.number)
        if sum([len(foot.values) for foot in feet]) > MAX_VALUES:
            raise RecordingError(header.path, f"holds more than {MAX_VALUES:,} numbers")
    for foot in feet:
        foot.table.lines = foot.lines
        fill_table(foot.table, found, [foot.values[k :: foot.width] for k in range(foot.width)])
    return [foot.table for foot in feet if foot.lines]


@define
class _FootRows:
    """The numbers of one foot, row by row."""

    table: FootTable
    decimal: str
    is_only: bool
    """Flag: the table has no other foot."""
    values: array[float] = field(factory=floats)
    lines: array[int] = field(factory=lambda: array("q"))
    cells: list[tuple[NamedColumn, Callable[[Any], float], str]] = field(init=False)
    """Each column in the order of the quantities, the function from its cells to numbers, and what these are."""

    @cells.default
    def _choose_readers(self) -> list[tuple[NamedColumn, Callable[[Any], float], str]]:
        number = partial(read_number, decimal=self.decimal)
        return [
            (column, read_datetime, "a time")
            if (quantity, self.table.units[quantity]) == ("t", DATETIME)
            else (column, number, "a number")
            for quantity in QUANTITIES
            for column in self.table.sources.get(quantity, ())
        ]

    @property
    def width(self) -> int:
        """Number of numbers in a row, the first of which is its time."""
        return len(self.cells) + ("t" not in self.table.sources)

    def parse(self, cells: Cells, count: float) -> list[float]:
        """Return the numbers of a row, or its number in place of a time; none if all cells of sensors are blank.

        ValueError for a row with another fault."""
        numbers = [count] if "t" not in self.table.sources else []
        sensors = self.cells[1 - len(numbers) :]
        if not self.is_only and all(is_blank(cells[column.index]) for column, _, _ in sensors):
            return []
        for column, read, what in self.cells:
            cell = cells[column.index] if column.index < len(cells) else None
            try:
                numbers.append(column.sign * read(cell))
            except (ValueError, TypeError):
                found = "blank" if is_blank(cell) else f'"{printable(str(cell), 20)}"'
                raise ValueError(f"{column.name} is {found}, not {what}") from None
        return numbers


def fill_table(table: FootTable, found: TableColumns, columns: Sequence[Iterable[float]]) -> None:
    """Set the values of a table from its times, or the numbers of its rows, and its columns in order of quantities."""
    t, *rest = columns
    unit, times, values = table.units.get("t"), list(t), iter(rest)
    for quantity in filter(table.sources.__contains__, MEASURED):
        table.set_quantity(quantity, [next(values) for _ in table.sources[quantity]])
    if unit is None:
        times = [number / (found.mapping.rate or 1.0) for number in times]
    elif times:
        wrap = SECONDS_OF_DAY if unit == DATETIME and times[0] < SECONDS_OF_DAY else found.mapping.wrap
        if wrap is not None:
            turns = accumulate([b - a < -0.5 * wrap for a, b in pairwise(times)], initial=0)
            times = [number + wrap * turn for number, turn in zip(times, turns, strict=True)]
    table.set_quantity("t", [times])
    has_own_time = found.mapping.columns.get("t", ("t",))[0].lower() == "t"
    table.is_own = found.export is OWN and has_own_time and unit == "s"
