"""Guess of the mapping of a table of no known format: it is offered as options to type, and never used silently."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path

from ..bad_rows import BadRows
from ..errors import RecordingError
from ..mapping.mapping import KEYS, TableMapping
from ..mapping.units import unit_of_name
from ..mapping.words import key_of_name
from .columns import find_columns, sensor_of_file
from .numbers import read_rows
from .plausible import find_wrong_units
from .sheet import Row, SheetLayout
from .table import remove_bad_rows

MAX_ROWS = 20_000
"""Number of rows from which units are guessed: more than a minute at 256 Hz."""


class UnknownTable(RecordingError):
    """Error for a table of no known format, with the mapping that may fit it, and the option of its `feet`."""

    def __init__(self, path: Path, what: str, where: str, guess: TableMapping | None, feet: str = "") -> None:
        if guess is None:
            example = "t=1,acc=2,3,4,gyro=5,6,7" if "it holds numbers" in what else "t=NAME,acc=X,Y,Z,gyro=X,Y,Z"
            repair = f"say which columns hold what, as in --columns {example} --units g,deg/s,ms"
        else:
            units = guess.write_units("", {}) if guess.units else ""
            rate = "" if "t" in guess.columns else "--rate HZ"
            repair = " ".join(filter(None, ("this may fit:", guess.write_columns("", {}), units, rate, feet)))
        super().__init__(path, what, where, repair)
        self.guess = guess

    @property
    def quantities(self) -> set[str]:
        """Quantities that the columns may hold; none if the names of columns say of which foot they are."""
        keys = set() if self.guess is None else {*self.guess.columns}
        return set() if any("_" in key for key in keys) else keys


def guess_mapping(layout: SheetLayout, rows: Iterator[Row]) -> UnknownTable:
    """Return the error for a table of no known format, with the options that may fit it."""
    where = layout.where or ("line 1" if layout.first else "")
    columns = {} if layout.holds_numbers else _guess_columns(layout)
    if not columns.keys() - {"t"}:
        return UnknownTable(
            layout.path, f"names no column acc_x or pressure_0 ({layout.list_names()})", layout.where, None
        )
    units = _guess_units(layout, islice(rows, MAX_ROWS), TableMapping(columns))
    if units.get("t") == "":
        del columns["t"], units["t"]
    what = f"is of no known format ({layout.list_names()})"
    return UnknownTable(layout.path, what, where, TableMapping(columns, units))


def merge_guesses(problems: Sequence[RecordingError], feet: str = "") -> list[RecordingError]:
    """Return the problems; those of unknown tables offer the same options, unless those of two files contradict.

    `feet` is the option that names the feet, "" if it is not needed."""
    guesses = [one.guess for one in problems if isinstance(one, UnknownTable) and one.guess is not None]
    columns = {key: names for guess in guesses for key, names in guess.columns.items()}
    units = {quantity: unit for guess in guesses for quantity, unit in guess.units.items()}
    if any({**columns, **guess.columns} != columns or {**units, **guess.units} != units for guess in guesses):
        return list(problems)
    merged = TableMapping({key: columns[key] for key in KEYS if key in columns}, units)
    return [
        UnknownTable(one.path, one.what, one.where, merged, feet)
        if isinstance(one, UnknownTable) and one.guess is not None
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


def _guess_units(layout: SheetLayout, rows: Iterator[Row], guess: TableMapping) -> dict[str, str]:
    """Return the units that the numbers suggest where the names say none; that of sample numbers is ""."""
    units: dict[str, str] = {}
    with suppress(RecordingError):  # a table without good rows suggests nothing
        for table in read_rows(rows, find_columns(layout, guess, None), BadRows(layout.path, lambda _: None)):
            remove_bad_rows(table)
            wrong = {one.quantity: "" if one.is_count else one.unit or None for one in find_wrong_units(table)}
            for quantity, (first, *_) in table.sources.items():
                unit = wrong.get(quantity, table.units[quantity])
                if unit is not None and not unit_of_name(first.name, quantity):
                    units.setdefault(quantity, unit)
    return units
