"""Finding of the columns that a mapping names, in the header of a table, with all faults at once."""

from __future__ import annotations

from collections.abc import Sequence, Set
from difflib import get_close_matches
from fnmatch import fnmatchcase
from pathlib import Path

from attrs import define, field, frozen

from ...types import Foot
from ..errors import RecordingError, printable
from ..exports import EXPORTS, OWN, Export, TableHeader
from ..mapping.mapping import MEASURED, TableMapping
from ..mapping.units import UNITS, find_unit, unit_of_name
from .feet import foot_of_text
from .layout import SheetLayout

NEED = {"acc": 3, "gyro": 3, "t": 1}
"""Number of columns of a quantity; an insole may have any number of cells."""


@frozen
class NamedColumn:
    """A column of a table, and the sign with which its numbers count."""

    index: int
    """Number of the column, counted from 0."""
    name: str
    is_reversed: bool = False
    """Flag: its numbers count with the opposite sign."""


@define
class FootColumns:
    """The columns of one foot in a table."""

    foot: Foot | None
    """Foot that the columns belong to; None in a table of one foot that names none."""
    columns: dict[str, tuple[NamedColumn, ...]]
    """Columns of each quantity; without `t` in a table that has a rate instead."""
    names: dict[str, str]
    """Name of each quantity in messages."""
    units: dict[str, str]
    is_named: bool
    """Flag: the file itself says which foot it is."""


@define
class TableColumns:
    """Columns of a table that a mapping names, with what is wrong with them."""

    feet: list[FootColumns]
    given: TableMapping
    """Mapping of the user."""
    mapping: TableMapping
    """Mapping of the user, with what it leaves out."""
    export: Export | None
    header: TableHeader
    faults: list[tuple[str, str]] = field(factory=list)
    """Key of a mapping and fault of its columns; the key "" for a fault of the whole table."""
    changes: dict[str, list[str]] = field(factory=dict)
    """Names of columns that would repair them, by key; "NAME" for one that is not known."""
    elsewhere: set[str] = field(factory=set)
    """Keys none of whose columns are here, and which another file may hold."""

    @property
    def is_empty(self) -> bool:
        """True when no column of a sensor was found."""
        return not any(one.columns.keys() & set(MEASURED) for one in self.feet)

    @property
    def quantities(self) -> set[str]:
        """Quantities of sensors whose columns are here, or should be."""
        return {key.partition("_")[0] for key in self.mapping.columns.keys() - self.elsewhere} & set(MEASURED)

    @property
    def found_keys(self) -> set[str]:
        """Keys of the mapping whose columns are here."""
        return set(self.mapping.columns) - self.elsewhere - {key for key, _ in self.faults}

    def list_problems(self, found_elsewhere: Set[str] = frozenset()) -> list[RecordingError]:
        """Return what is wrong, with what repairs it, except for keys that another file holds."""
        header, changes = self.header, {k: v for k, v in self.changes.items() if k not in found_elsewhere}
        problems = []
        for key, what in dict.fromkeys(self.faults):
            if key in found_elsewhere:
                continue
            if not key:
                repair = self.export.lacking if self.export is not None else ""
            else:
                repair = self.given.write_columns(key, changes)
            if key == "t" and changes["t"] == ["NAME"]:
                repair += f" or {self.given.write_setting('rate', 'HZ')}"
            problems.append(RecordingError(header.path, what, f"line {header.line}" if header.line else "", repair))
        return problems

    @property
    def time_is_own(self) -> bool:
        """True when the times are in the column that this project calls t, so that they stay as they are."""
        return self.mapping.columns.get("t", ("t",))[0].lower() == "t"


def find_columns(
    path: Path, layout: SheetLayout, given: TableMapping, foot: Foot | None, *, is_alone: bool = True
) -> TableColumns:
    """Return the columns of a table: those of `given`, and for what it leaves out those of a known format.

    `foot` is the foot of a table of one foot, None if that is not known. `is_alone`: no other file may hold what this
    one does not."""
    header = TableHeader(path, layout.names, layout.preamble, layout.units, layout.header)
    found = TableColumns([], given, given, _find_export(header, given), header)
    tagged = None
    if foot is None and found.export is not None:
        foot = tagged = foot_of_text(found.export.tag(header))
    base = TableMapping()
    if found.export is not None:
        try:
            base = found.export.mapping(header)
        except ValueError as error:
            if not any(key.startswith(("acc", "pressure")) for key in given.columns):
                found.faults.append(("", str(error)))
                return found
    found.mapping = given.completed(base)
    if not any(key.startswith(MEASURED) for key in found.mapping.columns):
        return found
    if found.mapping.is_of_one_foot:
        keys = {q: q + (f"_{foot.value}" if foot and f"{q}_{foot.value}" in found.mapping.columns else "")
                for q in ("t", *MEASURED)}  # fmt: skip
        groups = [(foot, "", keys)]
    else:
        groups = [(one, f"_{one.value}", _keys_of(one, found.mapping)) for one in Foot]
    for one, suffix, keys in groups:
        if not any(keys[q] in found.mapping.columns for q in MEASURED):
            continue
        columns = {}
        for quantity, key in keys.items():
            if names := found.mapping.columns.get(key):
                columns[quantity] = _resolve(found, key, quantity, names)
        if not is_alone:
            found.elsewhere |= {keys[q] for q in MEASURED if q in columns and not columns[q]}
        columns = {q: its_columns for q, its_columns in columns.items() if its_columns}
        _divide_by_file(path, columns, is_alone)
        if "t" not in columns and "t" not in found.mapping.columns and found.mapping.rate is None:
            found.changes["t"] = ["NAME"]
            found.faults.append(("t", f"names no column t ({_list(header)})"))
        labels = {q: _name_of(q, suffix, columns.get(q, ()), found.export) for q in ("t", *MEASURED)}
        units = _find_units(header, columns, given, base)
        found.feet.append(FootColumns(one, columns, labels, units, bool(suffix) or tagged is not None))
    return found


def _divide_by_file(path: Path, columns: dict[str, tuple[NamedColumn, ...]], is_alone: bool) -> None:
    """Remove a sensor whose columns have the names of another one's, if the name of the file says which it is of."""
    if not is_alone and "acc" in columns and columns["acc"] == columns.get("gyro"):
        sensor = sensor_of_file(path)
        if sensor is not None:
            del columns["gyro" if sensor == "acc" else "acc"]


def sensor_of_file(path: Path) -> str | None:
    """Return the quantity that the name of a file of one sensor says; None if it says none."""
    stem = path.stem.lower()
    return "gyro" if "gyr" in stem else "acc" if "acc" in stem else None


def _keys_of(foot: Foot, mapping: TableMapping) -> dict[str, str]:
    own_time = f"t_{foot.value}"
    return {"t": own_time if own_time in mapping.columns else "t", **{q: f"{q}_{foot.value}" for q in MEASURED}}


def _name_of(quantity: str, suffix: str, columns: Sequence[NamedColumn], export: Export | None) -> str:
    """Return the name of a quantity in messages: this project's own, or that of its first column."""
    if export is OWN:
        return quantity + ("" if quantity == "t" and columns and "_" not in columns[0].name else suffix)
    if columns and quantity == "t":
        return f"{quantity} ({columns[0].name})"
    return quantity + suffix


def _find_export(header: TableHeader, given: TableMapping) -> Export | None:
    if given.format:
        return EXPORTS[given.format]
    return next((export for export in EXPORTS.values() if export.is_own(header)), None)


def _resolve(found: TableColumns, key: str, quantity: str, names: Sequence[str]) -> tuple[NamedColumn, ...]:
    """Return the columns with these names; faults go to those of `found`."""
    all_names = found.header.names
    columns: list[NamedColumn] = []
    missing: list[str] = []
    corrected: list[str] = []
    for name in names:
        matches = _match(all_names, name)
        if len(matches) > 1 and "*" not in name:
            numbers = " or ".join(f"#{match.index + 1}" for match in matches)
            found.faults.append((key, f"names the column {printable(name, 40)} twice: it is {numbers}"))
            corrected.append(f"#{matches[0].index + 1}")
        elif matches:
            corrected.append(name)
        else:
            missing.append(name)
            corrected.append(_closest([one for one in all_names if one not in names], name))
        columns += matches[:1] if "*" not in name else matches
    if missing:
        text = ", ".join(printable(name.lstrip("-"), 40) for name in missing)
        found.faults.append((key, f"names no column {text} ({_list(found.header)})"))
    elif quantity in NEED and len(columns) != NEED[quantity]:
        listed = ", ".join(printable(column.name, 40) for column in columns)
        found.faults.append((key, f"{key} needs {NEED[quantity]} columns, not {len(columns)} ({listed})"))
        corrected = ["X", "Y", "Z"][: NEED[quantity]]
    if corrected != list(names):
        found.changes[key] = corrected
    return tuple(columns)


def _closest(names: Sequence[str], name: str) -> str:
    """Return the name of a column that is spelt much like another one, with its sign; "NAME" without one."""
    close = get_close_matches(name.lower().lstrip("-"), [one.lower() for one in names], 1, 0.7)
    sign = "-" if name.startswith("-") else ""
    return sign + next((one for one in names if [one.lower()] == close), "NAME")


def _match(names: Sequence[str], name_given: str) -> list[NamedColumn]:
    """Return the columns that a name means: as it is or with a sign, as a number, a pattern, and in any case."""
    for name, is_reversed in ((name_given, False), (name_given.removeprefix("-"), True)):
        if is_reversed and not name_given.startswith("-"):
            break
        exact = [k for k, one in enumerate(names) if one == name]
        if not exact and name.startswith("#") and name[1:].isdecimal() and 0 < int(name[1:]) <= len(names):
            exact = [int(name[1:]) - 1]
        if not exact and "*" in name:
            pattern = name.lower().replace("[", "[[]")
            exact = [k for k, one in enumerate(names) if fnmatchcase(one.lower(), pattern)]
        if not exact:
            exact = [k for k, one in enumerate(names) if one.lower() == name.strip().lower()]
        if exact:
            return [NamedColumn(k, names[k], is_reversed) for k in exact]
    return []


def _list(header: TableHeader) -> str:
    """Return what there is instead of a column that is missing."""
    names = [name for name in header.names if name]
    if all(name.replace(".", "").replace("-", "").isdecimal() for name in names):
        return "it holds numbers: is the line with the names missing?"
    return f"it names {printable(', '.join(names), 80)}"


def _find_units(
    header: TableHeader, columns: dict[str, tuple[NamedColumn, ...]], given: TableMapping, base: TableMapping
) -> dict[str, str]:
    """Return the unit of each quantity: as it is given, as the header says, as the known format has it, or SI."""
    units = {}
    for quantity, its_columns in columns.items():
        stated = None
        for column in its_columns[:1]:
            stated = unit_of_name(column.name, quantity)
            if stated is None and column.index < len(header.units):
                row_unit = find_unit(header.units[column.index])
                stated = row_unit[1] if row_unit is not None and row_unit[0] == quantity else None
        si = next(iter(UNITS[quantity]))
        known = find_unit(given.units[quantity]) if quantity in given.units else None
        units[quantity] = known[1] if known else stated or base.units.get(quantity, si)
    return units
