"""Guess of the mapping of a table of no known format: it is offered as options to type, and never used silently."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

import numpy as np
from attrs import frozen

from ..errors import RecordingError, printable
from ..mapping.mapping import KEYS, join_names, shell_word
from ..mapping.units import GRAVITY, UNITS, find_unit, unit_of_name
from .columns import sensor_of_file
from .layout import SheetLayout, is_number
from .numbers import is_datetime, number_reader
from .plausible import MAX_GYRO, NEAR, USUAL_INTERVAL
from .sheet import Row
from .table import Floats

MAX_ROWS = 20_000
"""Number of rows from which units are guessed: more than a minute at 256 Hz."""
TIME = re.compile(r"(?:^|[^a-z])(?:t|time|times|timestamp|sampletime|elapsed|zeit|temps|tiempo)(?:[^a-z]|$)")
ACC = re.compile(r"(?:^|[^a-z])a(?:[^a-z]|[xyz](?:[^a-z]|$)|$)|acc|beschl")
GYRO = re.compile(r"(?:^|[^a-z])[gw](?:[^a-z]|[xyz](?:[^a-z]|$))|gyr|omega|ang(?:ular)?.?(?:vel|rate)|dreh|rot")
OTHER = re.compile(r"free|lin(?:ear)?.?acc|user.?acc|gravity|mag|quat|euler|angle|roll|pitch|yaw|temp[^o]|baro")
"""Patterns of names in lower case: of times, specific force, angular rate, and of what is none of them."""
AXIS = re.compile(r"([xyz])(?:[^a-z]*(?:axis|achse)?)$|[^a-z]([xyz])(?:[^a-z]|$)")
"""Pattern of the axis in a name in lower case without its unit: at its end, or alone."""
FEET = {"left": re.compile(r"left|(?:^|[^a-z])l(?:[^a-z]|$)"), "right": re.compile(r"right|(?:^|[^a-z])r(?:[^a-z]|$)")}
"""Patterns of the feet in names of columns."""


class UnknownTable(RecordingError):
    """Error for a table of no known format, with the options that may fit it; `feet`: the one that names the feet."""

    def __init__(self, path: Path, what: str, where: str, guess: Guess | None, feet: str = "") -> None:
        example = "t=1,acc=2,3,4,gyro=5,6,7" if "it holds numbers" in what else "t=NAME,acc=X,Y,Z,gyro=X,Y,Z"
        needed = f"say which columns hold what, as in --columns {example} --units g,deg/s,ms"
        super().__init__(path, what, where, needed if guess is None else guess.write(feet))
        self.guess = guess

    @property
    def quantities(self) -> set[str]:
        """Quantities that the columns may hold; none if the names of columns say of which foot they are."""
        keys = set() if self.guess is None else {*self.guess.columns}
        return set() if any("_" in key for key in keys) else keys


@frozen
class Guess:
    """Options that may fit one or more tables."""

    columns: dict[str, tuple[str, ...]]
    units: tuple[str, ...]
    needs_rate: bool

    def write(self, feet: str = "") -> str:
        """Return the options as they are typed, with that of the `feet`."""
        text = ",".join(f"{key}={join_names(names)}" for key, names in self.columns.items())
        units = f" --units {','.join(self.units)}" if self.units else ""
        rate = " --rate HZ" if self.needs_rate else ""
        return f"this may fit: --columns {shell_word(text)}{units}{rate}{f' {feet}' if feet else ''}"


def guess_mapping(path: Path, layout: SheetLayout, rows: Iterator[Row]) -> UnknownTable:
    """Return the error for a table of no known format, with the options that may fit it."""
    names = [name for name in layout.names if name]
    holds_numbers = not layout.header or all(map(is_number, names))
    what = "it holds numbers: is the line with the names missing?" if holds_numbers else ""
    what = what or f"it names {printable(', '.join(names), 80)}"
    where = f"line {layout.header or 1}"
    columns = {} if holds_numbers else _guess_columns(layout, sensor_of_file(path))
    if not columns.keys() - {"t"}:
        return UnknownTable(path, f"names no column acc_x or pressure_0 ({what})", where, None)
    units, is_count = _guess_units(layout, rows, columns)
    if is_count:
        del columns["t"]
    named = {key: tuple(layout.names[k] for k in numbers) for key, numbers in columns.items()}
    guess = Guess(named, tuple(units), "t" not in columns)
    return UnknownTable(path, f"is of no known format ({what})", where, guess)


def merge_guesses(problems: Sequence[RecordingError], feet: str = "") -> list[RecordingError]:
    """Return the problems; those of unknown tables offer the same options, unless those of two files contradict.

    `feet` is the option that names the feet, "" if it is not needed."""
    guesses = [one.guess for one in problems if isinstance(one, UnknownTable) and one.guess is not None]
    columns = {key: names for guess in guesses for key, names in guess.columns.items()}
    units = tuple(dict.fromkeys(unit for guess in guesses for unit in guess.units))
    quantities = [known[0] for known in map(find_unit, units) if known is not None]
    fits = all(columns[key] == names for guess in guesses for key, names in guess.columns.items())
    if not fits or len(set(quantities)) < len(quantities):
        return list(problems)
    merged = Guess({key: columns[key] for key in KEYS if key in columns}, units, any(one.needs_rate for one in guesses))
    return [
        UnknownTable(one.path, one.what, one.where, merged, feet)
        if isinstance(one, UnknownTable) and one.guess
        else one
        for one in problems
    ]


def _guess_columns(layout: SheetLayout, sensor: str | None) -> dict[str, list[int]]:
    """Return the columns that the names suggest, by key of a mapping; `sensor`: quantity of axes without a name."""
    axes: dict[str, dict[str, int]] = {}
    columns: dict[str, list[int]] = {}
    for number, name in enumerate(layout.names):
        text = re.sub(r"[\[(].*?[\])]", " ", name).strip()
        spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text).lower()
        if OTHER.search(spaced):
            continue
        unit = next((q for q in UNITS if unit_of_name(name, q)), "")
        axis = AXIS.search(spaced)
        named = "gyro" if GYRO.search(spaced) else "acc" if ACC.search(spaced) else sensor or ""
        quantity = unit if unit in ("acc", "gyro") else named
        if axis is not None and quantity:
            foot = next((f"_{foot}" for foot, pattern in FEET.items() if pattern.search(spaced)), "")
            axes.setdefault(quantity + foot, {}).setdefault(axis[1] or axis[2], number)
        elif "t" not in columns and (TIME.search(spaced) or unit == "t"):
            columns["t"] = [number]
    columns |= {key: [found[axis] for axis in "xyz"] for key, found in axes.items() if set(found) == set("xyz")}
    return {key: columns[key] for key in KEYS if key in columns}


def _guess_units(layout: SheetLayout, rows: Iterator[Row], columns: dict[str, list[int]]) -> tuple[list[str], bool]:
    """Return the units that the numbers suggest where the names say none, and whether the times are sample numbers."""
    number_of = number_reader(layout.decimal)
    indices = sorted({k for numbers in columns.values() for k in numbers})
    read: list[list[float]] = []
    is_text = False
    for row in islice(rows, MAX_ROWS):
        cells = row.cells or []
        values = []
        for k in indices:
            try:
                values.append(number_of(cells[k]))
            except (ValueError, TypeError, IndexError):
                is_text = is_text or (k in columns.get("t", ()) and k < len(cells) and is_datetime(cells[k], number_of))
                values.append(np.nan)
        read.append(values)
    table = np.array(read, dtype=np.float64).reshape(len(read), len(indices))
    units, counts = [], False
    for key, numbers in columns.items():
        quantity = key.split("_")[0]
        if any(unit in units for unit in UNITS[quantity]) or unit_of_name(layout.names[numbers[0]], quantity):
            continue
        part = table[:, [indices.index(k) for k in numbers]]
        part = part[np.isfinite(part).all(axis=1)]
        if quantity == "t":
            unit, counts = ("datetime", False) if is_text else _time_unit(part[:, 0])
        else:
            unit = _acc_unit(part) if quantity == "acc" else _gyro_unit(part)
        units += [unit] if unit else []
    return units, counts


def _time_unit(times: Floats) -> tuple[str, bool]:
    """Return the unit of times, "" if none fits, and whether they are sample numbers."""
    if len(times) < 3:
        return "", False
    interval = float(np.median(np.diff(times)))
    if interval == 1.0 and bool(np.all(np.diff(times) == 1.0)):
        return "", True
    low, high = USUAL_INTERVAL
    return next((unit for unit, factor in UNITS["t"].items() if low <= interval * factor <= high), ""), False


def _acc_unit(vectors: Floats) -> str:
    lengths = np.linalg.norm(vectors, axis=1)
    median = float(np.median(lengths)) if len(lengths) else 0.0
    near = {unit: abs(np.log(max(median, 1e-9) * factor / GRAVITY)) for unit, factor in UNITS["acc"].items()}
    unit = min(near, key=lambda one: float(near[one]))
    return unit if near[unit] < 3.0 * NEAR else ""


def _gyro_unit(vectors: Floats) -> str:
    top = float(np.percentile(np.linalg.norm(vectors, axis=1), 99.0)) if len(vectors) else 0.0
    return next((unit for unit, factor in UNITS["gyro"].items() if top * factor <= MAX_GYRO), "")
