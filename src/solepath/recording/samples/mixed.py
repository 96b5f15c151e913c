"""Rows of a table that are not one sensor's in order of time: several devices in one file, or times of packets.

What repairs it is offered after it was applied to the rows: those of one value of a column, or a rate in place of
times."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from itertools import combinations, pairwise
from math import fsum, isfinite

from attrs import evolve, frozen

from ...types.doubles import doubles
from ..bad_rows import BadRows
from ..errors import RecordingError, printable
from ..mapping.mapping import MEASURED, TableMapping
from ..mapping.units import UNITS
from .columns import TableColumns, find_columns
from .numbers import read_rows
from .plausible import USUAL_INTERVAL
from .sheet import Row, cut
from .table import FootTable, rows_in_order

MIXED_SHARE = 0.3
"""Share of rows that repeat a time, or are out of order, from which on a table is none of one sensor's samples: of two
devices, one of which has half of the other's rate, a third is."""
SAME_TIME = 0.1
"""Time between two samples that come together, in usual intervals."""
MAX_DEVICES = 4
"""Largest number of devices whose rows take turns that are found by their values."""
ROUGH = 0.6
"""Ratio of the change from a row to one of the next few, to that from row to row, below which rows of several devices
take turns. Feet of twelve data sets have 0.9 and more, their two feet in turns up to 0.45."""
LEAST_ROWS, LEAST_CHANGES = 10, 100
"""Least number of rows whose times are judged, and whose values are: a second of a walk."""
MAX_ROWS = 20_000
"""Number of rows whose values are compared."""
MOST_LABELS = 12
"""Largest number of values of a column that may name the devices; chosen by hand."""


@frozen
class Mixture:
    """What is wrong with the order of a table's rows."""

    what: str
    """Sentence on it."""
    rate: float = 0.0
    """Number of samples a second by the count of rows over time; 0 if that says nothing."""


def find_mixture(table: FootTable) -> Mixture | None:
    """Return what is wrong with the order of the rows of a table, none of which was removed; None for nothing."""
    order = rows_in_order(table.t, [row for row, t in enumerate(table.t) if isfinite(t)])
    if len(order) < LEAST_ROWS:
        return None
    t = [table.t[row] for row in order]
    usual = evolve(table, t=doubles(t), columns={}).pace
    starts = [row for row, (before, after) in enumerate(pairwise(t), 1) if after - before > SAME_TIME * usual]
    late, count = len(table) - len(order), len(table)
    if late > MIXED_SHARE * count or not starts:
        what = (
            f"{late + len(order) - 1 - len(starts)} of {count} rows have the time of another one, or are out of order"
        )
        return Mixture(f"{what}: these are rows of several devices, or not in order of time")
    if len(order) - 1 - len(starts) > MIXED_SHARE * count:
        size, interval = starts[-1] / len(starts), (t[starts[-1]] - t[0]) / starts[-1]
        raw, (low, high) = interval / table.factor("t"), USUAL_INTERVAL
        interval = next((raw * unit for unit in UNITS["t"].values() if low <= raw * unit <= high), interval)
        what = (
            f"samples come in bursts of about {size:.0f}, one burst each {size * interval:.3g} s, as with the time at "
            "which their packet came, or with rows of several devices; give each sample its own time, about "
            f"{interval:.3g} s after the one before"
        )
        return Mixture(what, 1.0 / interval)
    if len(order) >= LEAST_CHANGES and _take_turns(table):
        return Mixture("values jump from row to row: rows of several devices take turns")
    return None


def _take_turns(table: FootTable) -> bool:
    """Return whether values are nearer to those of some rows before than to those of the row before."""
    columns = next((table.columns[quantity] for quantity in MEASURED if quantity in table.columns), [])

    def change(lag: int) -> float:
        """Return how much values change in so many rows, on average."""
        pairs = [(a, b) for one in columns for a, b in zip(one[:MAX_ROWS], one[lag:MAX_ROWS], strict=False)]
        changes = [abs(b - a) for a, b in pairs if isfinite(b - a)]
        return fsum(changes) / max(len(changes), 1)

    near = change(1)
    return any(change(lag) < ROUGH * near for lag in range(2, MAX_DEVICES + 1))


def repair_mixture(found: TableColumns, rows: Sequence[Row], mixture: Mixture) -> str:
    """Return the options that choose the rows of one device, or give the rows times; "" if none makes them right.

    `rows` are those below the header."""
    given, labels = found.given, _labels(found, rows)
    first = [{name: values[0]} for name, values in labels.items()]
    for choice in [*first, *(one | other for one, other in combinations(first, 2))]:
        if _is_right(found, rows, evolve(given, rows={**given.rows, **choice})):
            others = [value for name in choice for value in labels[name][1:]]
            return f"{given.write_rows(choice)} (there are {printable(', '.join(others), 80)}, too)"
    rate = f"{mixture.rate:.4g}"
    is_right = mixture.rate and _is_right(found, rows, evolve(given.untimed, rate=float(rate)))
    return given.write_rate(rate) if is_right else ""


def _labels(found: TableColumns, rows: Sequence[Row]) -> dict[str, list[str]]:
    """Return the values of the columns that may name the devices: few, and other than those of the sensors."""
    used = {one.index for table in found.feet for its in table.sources.values() for one in its}
    names = found.header.names
    values: dict[int, dict[str, None]] = {k: {} for k, name in enumerate(names) if name and k not in used}
    for row in rows:
        with suppress(ValueError):
            cells = cut(row.content, found.header.separator)
            for index in list(values):
                values[index][str(cells[index]).strip() if index < len(cells) else ""] = None
                if len(values[index]) > MOST_LABELS:
                    del values[index]
    return {names[index]: [*its] for index, its in values.items() if len(its) > 1}


def _is_right(found: TableColumns, rows: Sequence[Row], given: TableMapping) -> bool:
    """Return whether the rows are in order with another mapping."""
    again = find_columns(found.header, given, found.feet[0].foot)
    try:
        tables = read_rows(iter(rows), again, BadRows(found.header.path, lambda _: None))
    except RecordingError:
        return False
    return bool(tables) and all(len(table) >= LEAST_ROWS and find_mixture(table) is None for table in tables)
