"""Finding of the columns that a mapping names, in the header of a table, with all faults at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
from .layout import Layout

NEED = {"acc": 3, "gyro": 3, "t": 1}
"""Number of columns of a quantity; an insole may have any number of cells."""


@frozen
class Column:
    """A column of a table, and the sign with which its numbers count."""

    index: int
    name: str
    sign: float = 1.0


@define
class FootColumns:
    """The columns of one foot in a table."""

    foot: Foot | None
    """Foot whose they are; None in a table of one foot that names none."""
    columns: dict[str, tuple[Column, ...]]
    """Columns of each quantity; without `t` in a table that has a rate instead."""
    names: dict[str, str]
    """Name of each quantity in messages."""
    units: dict[str, str]
    is_named: bool
    """Flag: the file itself says which foot it is."""


@define
class TableColumns:
    """What a mapping finds in a table."""

    feet: list[FootColumns]
    mapping: TableMapping
    export: Export | None
    header: TableHeader
    problems: list[RecordingError] = field(factory=list)

    @property
    def time_is_own(self) -> bool:
        """True when the times are in the column that this project calls t, so that they stay as they are."""
        return self.mapping.columns.get("t", ("t",))[0].lower() == "t"


def find_columns(path: Path, layout: Layout, given: TableMapping, foot: Foot | None) -> TableColumns:
    """Return the columns of a table: those of `given`, and for what it leaves out those of a known format.

    `foot` is the foot of a table of one foot, None if that is not known."""
    header = TableHeader(path, layout.names, layout.preamble, layout.units)
    where = f"line {layout.header}" if layout.header else ""
    found = TableColumns([], given, _find_export(header, given), header)
    tagged = None
    if foot is None and found.export is not None:
        foot = tagged = foot_of_text(found.export.tag(header))
    base = TableMapping()
    if found.export is not None:
        try:
            base = found.export.mapping(header)
        except ValueError as error:
            if not any(key.startswith(("acc", "pressure")) for key in given.columns):
                found.problems.append(RecordingError(path, str(error), where, found.export.lacking))
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
                columns[quantity] = tuple(_resolve(found, where, key, quantity, names))
        if "t" not in columns and found.mapping.rate is None:
            repair = f"{found.mapping.write_line('t', ['NAME'])} or {found.mapping.write_setting('rate', 'HZ')}"
            found.problems.append(RecordingError(path, f"names no column t ({_list(header)})", where, repair))
        labels = {q: _name_of(q, suffix, columns.get(q, ()), found.export) for q in ("t", *MEASURED)}
        units = _find_units(header, columns, given, base)
        found.feet.append(FootColumns(one, columns, labels, units, bool(suffix) or tagged is not None))
    return found


def _keys_of(foot: Foot, mapping: TableMapping) -> dict[str, str]:
    own_time = f"t_{foot.value}"
    return {"t": own_time if own_time in mapping.columns else "t", **{q: f"{q}_{foot.value}" for q in MEASURED}}


def _name_of(quantity: str, suffix: str, columns: Sequence[Column], export: Export | None) -> str:
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


def _resolve(found: TableColumns, where: str, key: str, quantity: str, names: Sequence[str]) -> Iterator[Column]:
    """Yield the columns with these names; faults go to the problems of `found`."""
    path, mapping = found.header.path, found.mapping
    columns: list[Column] = []
    missing: list[str] = []
    corrected: list[str] = []
    for name in names:
        matches = _match(found.header.names, name)
        if len(matches) > 1 and "*" not in name:
            numbers = " or ".join(f"#{match.index + 1}" for match in matches)
            repair = mapping.write_line(key, [f"#{matches[0].index + 1}" if n == name else n for n in names])
            what = f"names the column {printable(name, 40)} twice: it is {numbers}"
            found.problems.append(RecordingError(path, what, where, repair))
        columns += matches
        if not matches:
            missing.append(name)
        sign = "-" if name.startswith("-") else ""
        close = [] if matches else get_close_matches(name.lower(), [n.lower() for n in found.header.names], 1, 0.7)
        corrected += [sign + n for n in found.header.names if [n.lower()] == close][:1] if close else [name]
    if missing:
        text = ", ".join(printable(name.lstrip("-"), 40) for name in missing)
        repair = mapping.write_line(key, corrected if corrected != list(names) else ["NAME"] * len(names))
        what = f"names no column {text} ({_list(found.header)})"
        found.problems.append(RecordingError(path, what, where, repair))
    elif quantity in NEED and len(columns) != NEED[quantity]:
        listed = ", ".join(printable(column.name, 40) for column in columns)
        repair = mapping.write_line(key, ["X", "Y", "Z"][: NEED[quantity]])
        what = f"{key} needs {NEED[quantity]} columns, not {len(columns)} ({listed})"
        found.problems.append(RecordingError(path, what, where, repair))
    return iter(columns)


def _match(names: Sequence[str], name_given: str) -> list[Column]:
    """Return the columns that a name means: as it is or with a sign, as a number, a pattern, and in any case."""
    for name, sign in ((name_given, 1.0), (name_given.removeprefix("-"), -1.0)):
        if sign < 0.0 and not name_given.startswith("-"):
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
            return [Column(k, names[k], sign) for k in exact]
    return []


def _list(header: TableHeader) -> str:
    """Return what there is instead of a column that is missing."""
    names = [name for name in header.names if name]
    if all(name.replace(".", "").replace("-", "").isdecimal() for name in names):
        return "it holds numbers: is the line with the names missing?"
    return f"it names {printable(', '.join(names), 80)}"


def _find_units(
    header: TableHeader, columns: dict[str, tuple[Column, ...]], given: TableMapping, base: TableMapping
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
