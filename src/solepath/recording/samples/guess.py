"""Guess of the mapping of a table of no known format: it is offered as options to type, and never used silently."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path

from attrs import evolve

from ...types import Foot
from ..bad_rows import BadRows
from ..errors import RecordingError
from ..mapping.mapping import KEYS, TableMapping
from ..mapping.units import unit_of_name
from ..mapping.words import key_of_name
from .columns import TableColumns, find_columns, sensor_of_file
from .numbers import read_rows
from .plausible import find_wrong_units
from .sheet import Row, SheetLayout
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
            rate = "" if "t" in guess.columns else "--rate HZ"
            repair = " ".join(filter(None, ("this may fit:", guess.write_columns("", {}), units, rate, feet)))
        super().__init__(path, what, where, repair)
        self.found = found


def guess_mapping(layout: SheetLayout, rows: Iterator[Row], foot: Foot | None) -> UnknownTable:
    """Return the error for a table of no known format, with the options that may fit it."""
    where = layout.where or ("line 1" if layout.first else "")
    columns = {} if layout.holds_numbers else _guess_columns(layout)
    if not columns.keys() - {"t"}:
        what = f"names no column acc_x or pressure_0 ({layout.list_names()})"
        return UnknownTable(layout.path, what, where, None)
    found = find_columns(layout, TableMapping(columns), foot)
    units = _guess_units(islice(rows, MAX_ROWS), found)
    if units.get("t") == "":
        del columns["t"], units["t"]
    found.mapping = TableMapping(columns, units)
    return UnknownTable(layout.path, f"is of no known format ({layout.list_names()})", where, found)


def merge_guesses(problems: Sequence[RecordingError], feet: str = "") -> list[RecordingError]:
    """Return the problems; those of unknown tables offer the same options, unless those of two files contradict.

    `feet` is the option that names the feet, "" if it is not needed."""
    guesses = [one.found.mapping for one in problems if isinstance(one, UnknownTable) and one.found is not None]
    columns = {key: names for guess in guesses for key, names in guess.columns.items()}
    units = {quantity: unit for guess in guesses for quantity, unit in guess.units.items()}
    if any(guess.columns.items() - columns.items() or guess.units.items() - units.items() for guess in guesses):
        return list(problems)
    merged = TableMapping({key: columns[key] for key in KEYS if key in columns}, units)
    return [
        UnknownTable(one.path, one.what, one.where, evolve(one.found, mapping=merged), feet)
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


def _guess_units(rows: Iterator[Row], found: TableColumns) -> dict[str, str]:
    """Return the units that the numbers suggest where the names say none; that of sample numbers is ""."""
    units: dict[str, str] = {}
    with suppress(RecordingError):  # a table without good rows suggests nothing
        for table in read_rows(rows, found, BadRows(found.header.path, lambda _: None)):
            remove_bad_rows(table)
            wrong = {one.quantity: "" if one.is_count else one.unit or None for one in find_wrong_units(table)}
            for quantity, (first, *_) in table.sources.items():
                unit = wrong.get(quantity, table.units[quantity])
                if unit is not None and not unit_of_name(first.name, quantity):
                    units.setdefault(quantity, unit)
    return units
