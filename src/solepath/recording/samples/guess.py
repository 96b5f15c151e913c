"""Guess of the mapping of a table of no known format: it is offered as options to type, and never used silently."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice, pairwise
from pathlib import Path

from attrs import evolve

from ...types import Foot
from ...types.doubles import doubles
from ..bad_rows import BadRows
from ..errors import RecordingError
from ..mapping.mapping import KEYS, TableMapping
from ..mapping.units import unit_of_name
from ..mapping.words import key_of_name
from .columns import TableColumns, find_columns, sensor_of_file
from .numbers import read_rows
from .plausible import find_wrong_units
from .sheet import Row, SheetLayout, cut, read_number
from .table import remove_bad_rows

MAX_ROWS = 20_000
"""Number of rows from which units are guessed: more than a minute at 256 Hz."""


class UnknownTable(RecordingError):
    """Error for a table of no known format, with the columns that may fit it, and the option of its `feet`."""

    def __init__(self, path: Path, what: str, where: str, found: TableColumns | None, feet: str = "") -> None:
        if found is None:
            example = "t=1,acc=2,3,4,gyro=5,6,7" if "it holds numbers" in what else "t=NAME,acc=X,Y,Z,gyro=X,Y,Z"
            repair = f"say which columns hold what, as in --columns {example} --units g,deg/s,ms"
        else:
            guess = found.mapping
            units = guess.write_units("", {}) if guess.units else ""
            rate = "" if "t" in guess.columns else f"--rate {f'{guess.rate:g}' if guess.rate else 'HZ'}"
            more = guess.write_scale(found.scales), guess.write_rows({}), rate, feet
            repair = " ".join(filter(None, ("this may fit:", guess.write_columns("", {}), units, *more)))
        super().__init__(path, what, where, repair)
        self.found = found


def guess_mapping(layout: SheetLayout, rows: Iterator[Row], given: TableMapping, foot: Foot | None) -> UnknownTable:
    """Return the error for a table of no known format, with the options that may fit it, beside those `given`."""
    where = layout.where or ("line 1" if layout.first else "")
    first = list(islice(rows, MAX_ROWS))
    columns = _guess_numbered(layout, first) if layout.holds_numbers else _guess_columns(layout)
    if given.rate is not None:
        columns.pop("t", None)
    if not columns.keys() - {"t"}:
        what = f"names no column acc_x or pressure_0 ({layout.list_names()})"
        return UnknownTable(layout.path, what, where, None)
    known = TableMapping(columns, scale=given.scale, rows=given.rows, rate=given.rate)
    found = find_columns(layout, known, foot)
    units = _guess_units(iter(first), found)
    if units.get("t") == "":
        del columns["t"], units["t"]
    found.mapping = evolve(known, columns=columns, units=units)
    return UnknownTable(layout.path, f"is of no known format ({layout.list_names()})", where, found)


def merge_guesses(problems: Sequence[RecordingError], feet: str = "") -> list[RecordingError]:
    """Return the problems; those of unknown tables offer the same options, unless those of two files contradict.

    `feet` is the option that names the feet, "" if it is not needed."""
    guesses = [one.found.mapping for one in problems if isinstance(one, UnknownTable) and one.found is not None]
    columns = {key: names for guess in guesses for key, names in guess.columns.items()}
    units = {quantity: unit for guess in guesses for quantity, unit in guess.units.items()}
    if any(guess.columns.items() - columns.items() or guess.units.items() - units.items() for guess in guesses):
        return list(problems)
    columns = {key: columns[key] for key in KEYS if key in columns}
    return [
        UnknownTable(
            one.path,
            one.what,
            one.where,
            evolve(one.found, mapping=evolve(one.found.mapping, columns=columns, units=units)),
            feet,
        )
        if isinstance(one, UnknownTable) and one.found is not None
        else one
        for one in problems
    ]


def _guess_columns(layout: SheetLayout) -> dict[str, tuple[str, ...]]:
    """Return the columns that the names suggest, by key of a mapping."""
    axes: dict[str, dict[str, str]] = {}
    for name in layout.names:
        key, axis = key_of_name(name, sensor_of_file(layout.path) or "")
        axes.setdefault(key, {}).setdefault(axis, name)
    orders = {key: ("",) if key == "t" else ("x", "y", "z") for key in KEYS if key in axes}
    return {key: tuple([axes[key][one] for one in order]) for key, order in orders.items() if {*order} == {*axes[key]}}


def _guess_numbered(layout: SheetLayout, rows: Sequence[Row]) -> dict[str, tuple[str, ...]]:
    """Return the columns of a table without names, if they are those of one foot: a time or none, three, and three.

    A time comes first and never decreases; then comes the accelerometer, as in the files of most programs."""
    first = doubles()
    for row in rows:
        with suppress(ValueError, TypeError, IndexError):
            first.append(read_number(cut(row.content, layout.separator)[0], layout.decimal))
    is_time = all(a <= b for a, b in pairwise(first)) and first[:1] < first[-1:]
    names = [f"#{k + 1}" if layout.header else str(k + 1) for k in range(len(layout.names))]
    times, sensors = names[:is_time], names[is_time:]
    if len(sensors) not in (3, 6):
        return {}
    keys = {"t": times, "acc": sensors[:3], "gyro": sensors[3:]}
    return {key: tuple(its) for key, its in keys.items() if its}


def _guess_units(rows: Iterator[Row], found: TableColumns) -> dict[str, str]:
    """Return the units that the numbers suggest where the names say none; that of sample numbers is ""."""
    units: dict[str, str] = {}
    with suppress(RecordingError):  # a table without good rows suggests nothing
        for table in read_rows(rows, found, BadRows(found.header.path, lambda _: None)):
            remove_bad_rows(table)
            problems = list(find_wrong_units(table))
            found.scales.update({one.quantity: one.scale for one in problems if one.scale})
            wrong = {one.quantity: "" if one.is_count else one.unit or None for one in problems}
            for quantity, (first, *_) in table.sources.items():
                unit = wrong.get(quantity, table.units[quantity])
                has_unit = unit_of_name(first.name, quantity) or quantity in table.mapping.scale
                if unit is not None and not has_unit:
                    units.setdefault(quantity, unit)
    return units
