"""Guess of the mapping of a table of no known format: it is offered as options to type, and never used silently."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, pairwise
from math import isfinite, log, nan
from pathlib import Path

from ..errors import RecordingError, printable
from ..mapping.mapping import KEYS, TableMapping
from ..mapping.units import GRAVITY, UNITS, unit_of_name
from ..mapping.words import key_of_name
from .columns import sensor_of_file
from .layout import SheetLayout, is_number
from .numbers import is_datetime, number_reader
from .plausible import MAX_GYRO, NEAR, TOP, percentile, usual_unit
from .sheet import Row
from .table import lengths, median

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
    names = [name for name in layout.names if name]
    holds_numbers = not layout.header or all(map(is_number, names))
    what = "it holds numbers: is the line with the names missing?" if holds_numbers else ""
    what = what or f"it names {printable(', '.join(names), 80)}"
    where = f"line {layout.header or 1}"
    columns = {} if holds_numbers else _guess_columns(layout, sensor_of_file(layout.path) or "")
    if not columns.keys() - {"t"}:
        return UnknownTable(layout.path, f"names no column acc_x or pressure_0 ({what})", where, None)
    units = _guess_units(layout, rows, columns)
    if units.get("t") == "":
        del columns["t"]
    named = {key: tuple(layout.names[k] for k in numbers) for key, numbers in columns.items()}
    guess = TableMapping(named, {quantity: unit for quantity, unit in units.items() if unit})
    return UnknownTable(layout.path, f"is of no known format ({what})", where, guess)


def merge_guesses(problems: Sequence[RecordingError], feet: str = "") -> list[RecordingError]:
    """Return the problems; those of unknown tables offer the same options, unless those of two files contradict.

    `feet` is the option that names the feet, "" if it is not needed."""
    unknown = [one for one in problems if isinstance(one, UnknownTable) and one.guess is not None]
    guesses = [one.guess for one in unknown if one.guess is not None]
    columns = {key: names for guess in guesses for key, names in guess.columns.items()}
    units = {quantity: unit for guess in guesses for quantity, unit in guess.units.items()}
    if any({**columns, **guess.columns} != columns or {**units, **guess.units} != units for guess in guesses):
        return list(problems)
    merged = TableMapping({key: columns[key] for key in KEYS if key in columns}, units)
    return [UnknownTable(one.path, one.what, one.where, merged, feet) if one in unknown else one for one in problems]


def _guess_columns(layout: SheetLayout, sensor: str) -> dict[str, list[int]]:
    """Return the columns that the names suggest, by key of a mapping; `sensor`: quantity of axes without a name."""
    axes: dict[str, dict[str, int]] = {}
    for number, name in enumerate(layout.names):
        key, axis = key_of_name(name, sensor)
        axes.setdefault(key, {}).setdefault(axis, number)
    whole = {"t": [""]}
    return {
        key: [axes[key][axis] for axis in whole.get(key, "xyz")]
        for key in KEYS
        if set(axes.get(key, ())) == set(whole.get(key, "xyz"))
    }


def _guess_units(layout: SheetLayout, rows: Iterator[Row], columns: dict[str, list[int]]) -> dict[str, str]:
    """Return the units that the numbers suggest where the names say none; that of sample numbers is ""."""
    parse = number_reader(layout.decimal)
    read = [row.cells or [] for row in islice(rows, MAX_ROWS)]

    def number_of(cells: Sequence[object], k: int) -> float:
        try:
            return parse(cells[k])
        except (ValueError, TypeError, IndexError):
            return nan

    units: dict[str, str] = {}
    for key, numbers in columns.items():
        quantity = key.split("_")[0]
        if units.get(quantity) or unit_of_name(layout.names[numbers[0]], quantity):
            continue
        values = [[number_of(cells, k) for k in numbers] for cells in read]
        whole = [row for row in values if all(map(isfinite, row))]
        if quantity == "t":
            k = numbers[0]
            is_text = any(k < len(cells) and is_datetime(cells[k], parse) for cells in read)
            unit = "datetime" if is_text else _time_unit([row[0] for row in whole])
        else:
            sizes = lengths(list(zip(*whole, strict=True)) or [(), (), ()])
            unit = _acc_unit(sizes) if quantity == "acc" else _gyro_unit(sizes)
        if unit is not None:
            units[quantity] = unit
    return units


def _time_unit(times: Sequence[float]) -> str | None:
    """Return the unit of times, "" for sample numbers, and None if none fits."""
    intervals = [b - a for a, b in pairwise(times)]
    if len(intervals) < 2:
        return None
    return "" if set(intervals) == {1.0} else usual_unit(median(intervals)) or None


def _acc_unit(sizes: Sequence[float]) -> str | None:
    middle = median(sizes) if sizes else 0.0
    near = {unit: abs(log(max(middle, 1e-9) * factor / GRAVITY)) for unit, factor in UNITS["acc"].items()}
    unit = min(near, key=near.__getitem__)
    return unit if near[unit] < 3.0 * NEAR else None


def _gyro_unit(sizes: Sequence[float]) -> str | None:
    top = percentile(sizes, TOP) if sizes else 0.0
    return next((unit for unit, factor in UNITS["gyro"].items() if top * factor <= MAX_GYRO), None)
