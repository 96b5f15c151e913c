"""Reading of the rows of a table as numbers: one table of samples for each foot, and the rows that cannot be used."""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import accumulate, pairwise
from math import isnan, nan

from attrs import evolve

from ...types.doubles import Doubles, doubles
from ..bad_rows import BadRows
from ..errors import RecordingError, printable
from ..exports import OWN
from ..mapping.units import DATETIME
from .columns import TableColumns
from .sheet import Row, cut, is_blank, read_datetime, read_number
from .table import MAX_VALUES, FootTable

MOST_VALUES = 10
"""Largest number of values of a column that an error names; chosen by hand."""
SECONDS_OF_DAY = 86400.0
"""Length of a day, s: times without a date start again from 0 after it."""


def read_rows(rows: Iterator[Row], found: TableColumns, bad_rows: BadRows) -> list[FootTable]:
    """Return the tables of the feet, without the rows that are none of numbers, which `bad_rows` gets.

    An incomplete last line is reported and left out. It is not detected if only digits of its last column are missing,
    because the row is then complete. A pressure cell that is blank or a word is NaN."""
    header = found.header
    columns = {one.index: one.name for table in found.feet for its in table.sources.values() for one in its}
    cells_of_insoles = {one.index for table in found.feet for one in table.sources.get("pressure", ())}
    datetimes = {table.sources["t"][0].index for table in found.feet if table.units.get("t") == DATETIME}
    values = {index: doubles() for index in columns}
    lines, counts = array("q"), doubles()
    width = max((k + 1 for k, name in enumerate(header.names) if name), default=0)
    for count, row in enumerate(_chosen(rows, found)):
        numbers = []
        try:
            cells = cut(row.content, header.separator)
            if len(cells) < width or not all(map(is_blank, cells[len(header.names) :])):
                raise ValueError(f"has {len(cells)} columns instead of {len(header.names)}")
            for index, name in columns.items():
                cell = cells[index] if index < len(cells) else None
                try:
                    if is_blank(cell) and len(found.feet) > 1:
                        numbers.append(nan)  # this row may be of the other foot
                    else:
                        numbers.append(read_datetime(cell) if index in datetimes else read_number(cell, header.decimal))
                except (ValueError, TypeError):
                    if index in cells_of_insoles and not row.is_cut:
                        numbers.append(nan)  # a cell that sends no number costs itself only
                        continue
                    text = "blank" if is_blank(cell) else f'"{printable(str(cell), 20)}"'
                    kind = "time" if index in datetimes else "number"
                    raise ValueError(f"{name} is {text}, not a {kind}") from None
        except ValueError as error:
            if row.is_cut:
                text = f"line {row.number}: cut off in the middle; everything before it is used"
                bad_rows.report(f"{printable(str(header.path))}: {text}")
                break
            bad_rows.add(f"line {row.number}", str(error))
            continue
        bad_rows.good += 1
        lines.append(row.number)
        counts.append(count)
        for column, number in zip(values.values(), numbers, strict=True):
            column.append(number)
        if len(lines) * len(values) > MAX_VALUES:
            raise RecordingError(header.path, f"holds more than {MAX_VALUES:,} numbers")
    return fill_tables(found, values, counts, lines) if lines else []


def choose_values(found: TableColumns, columns: Mapping[int, Sequence[float]]) -> dict[int, list[float]]:
    """Return the values of columns, of the same length, in the rows that the mapping chooses."""
    rows = (Row(row, list(cells)) for row, cells in enumerate(zip(*columns.values(), strict=False)))
    order = {index: k for k, index in enumerate(columns)}
    chosen = {order[index]: value for index, value in found.chosen.items()}
    kept = [row.content for row in _chosen(rows, evolve(found, chosen=chosen))]
    return {index: list(values) for index, values in zip(columns, zip(*kept, strict=True), strict=True)}


def _chosen(rows: Iterator[Row], found: TableColumns) -> Iterator[Row]:
    """Yield the rows that the mapping chooses; RecordingError when there is none, with the values that there are."""
    seen, count = dict[str, None](), 0
    for row in rows:
        if found.chosen:
            with suppress(ValueError):
                cells = cut(row.content, found.header.separator)
                values = [str(cells[index]).strip() if index < len(cells) else "" for index in found.chosen]
                if len(seen) < MOST_VALUES:
                    seen[", ".join(values)] = None
                if not all(map(is_same, values, found.chosen.values())):
                    continue
        count += 1
        yield row
    if found.chosen and not count:
        choice = ", ".join([f"{name} = {value}" for name, value in found.mapping.rows.items()])
        what = f"has no row with {printable(choice, 80)}; there are {printable('; '.join(seen), 120)}"
        raise RecordingError(found.header.path, what)


def is_same(text: str, value: str) -> bool:
    """Return whether two texts are the same, or the same number."""
    if text == value:
        return True
    try:
        return float(text) == float(value)
    except ValueError:
        return False


def fill_tables(
    found: TableColumns, values: Mapping[int, Sequence[float]], counts: Sequence[float], lines: Sequence[int] | None
) -> list[FootTable]:
    """Return the tables of the feet, with the values of columns by their index.

    `counts` numbers the rows, for a table with a rate; `lines` has the line of each. In a table of both feet, a row
    that is blank for one of them has no sample of it."""
    has_own_time = found.mapping.columns.get("t", ("t",))[0].lower() == "t"
    for table in found.feet:
        table.lines = lines
        table.columns = {
            quantity: [_scaled(values[one.index], one.sign * table.factor(quantity)) for one in columns]
            for quantity, columns in table.sources.items()
        }
        if "t" in table.sources:
            unit, t = table.units["t"], values[table.sources["t"][0].index]
            wrap = (
                SECONDS_OF_DAY if unit == DATETIME and max(t[:1], default=0.0) < SECONDS_OF_DAY else found.mapping.wrap
            )
            if wrap is not None:
                turns = accumulate([b - a < -0.5 * wrap for a, b in pairwise(t)], initial=0)
                t = [number + wrap * turn for number, turn in zip(t, turns, strict=False)]
            table.t = _scaled(t, table.factor("t"))
            table.is_own = found.export is OWN and has_own_time and unit == "s"
            del table.columns["t"]
        else:
            table.t = doubles([count / (found.mapping.rate or 1.0) for count in counts])
        if len(found.feet) > 1:
            measured = [column for columns in table.columns.values() for column in columns]
            table.select([not all(map(isnan, row)) for row in zip(*measured, strict=True)])
    return found.feet


def _scaled(values: Sequence[float], factor: float) -> Doubles:
    return doubles(values if factor == 1.0 else [value * factor for value in values])
