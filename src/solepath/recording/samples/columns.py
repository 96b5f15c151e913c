"""Finding of the columns that a mapping names, in the header of a table, with all faults at once."""

from __future__ import annotations

from collections.abc import Sequence, Set
from difflib import get_close_matches
from pathlib import Path

from attrs import define, field

from ...types import Foot
from ..errors import RecordingError, printable
from ..exports import EXPORTS, OWN, Export
from ..mapping.mapping import COMPONENTS, MEASURED, QUANTITIES, NamedColumn, TableMapping, match_name
from ..mapping.units import UNITS, unit_of, unit_of_name
from ..mapping.words import foot_of_text
from .layout import SheetLayout
from .table import FootTable


@define
class TableColumns:
    """Columns of a table that a mapping names, with what is wrong with them."""

    header: SheetLayout
    given: TableMapping
    """Mapping of the user."""
    mapping: TableMapping
    """Mapping of the user, with what it leaves out."""
    export: Export | None
    feet: list[FootTable] = field(factory=list)
    """Tables of the feet, without rows."""
    faults: list[tuple[str, str]] = field(factory=list)
    """Key of a mapping and fault of its columns; the key "" for a fault of the whole table."""
    changes: dict[str, list[str]] = field(factory=dict)
    """Names of columns that would repair them, by key; "NAME" for one that is not known."""
    elsewhere: set[str] = field(factory=set)
    """Keys none of whose columns are here, and which another file may hold."""

    @property
    def is_empty(self) -> bool:
        """True when no column of a sensor was found."""
        return not any(one.sources.keys() & set(MEASURED) for one in self.feet)

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
        changes = {key: names for key, names in self.changes.items() if key not in found_elsewhere}
        problems = []
        for key, what in dict.fromkeys(self.faults):
            if key in found_elsewhere:
                continue
            repair = self.given.write_columns(key, changes) if key else self.export.repair if self.export else ""
            if key == "t" and changes["t"] == ["NAME"]:
                repair += f" or {self.given.write_setting('rate', 'HZ')}"
            problems.append(RecordingError(self.header.path, what, self.header.locate(), repair))
        return problems


def find_columns(header: SheetLayout, given: TableMapping, foot: Foot | None, *, is_alone: bool = True) -> TableColumns:
    """Return the columns of a table: those of `given`, and for what it leaves out those of a known format.

    `foot` is the foot of a table of one foot, None if that is not known. `is_alone`: no other file may hold what this
    one does not."""
    known = [EXPORTS[given.format]] if given.format else [one for one in EXPORTS.values() if one.fits(header)]
    export = known[0] if known else None
    found = TableColumns(header, given, given, export)
    tagged = None
    base = TableMapping()
    if export is not None:
        if foot is None:
            foot = tagged = foot_of_text(export.read_tag(header))
        try:
            base = export.read_mapping(header)
        except ValueError as error:
            if not any(key.startswith(("acc", "pressure")) for key in given.columns):
                found.faults.append(("", str(error)))
                return found
    found.mapping = given.completed(base)
    columns = found.mapping.columns
    for one in [foot] if found.mapping.is_of_one_foot else Foot:
        suffix = "" if found.mapping.is_of_one_foot or one is None else f"_{one.value}"
        keys = {}
        for q in QUANTITIES:
            named = q if one is None else f"{q}_{one.value}"
            keys[q] = named if named in columns or (suffix and q != "t") else q
        if not any(keys[q] in columns for q in MEASURED):
            continue
        sources = {q: _resolve(found, key, q) for q, key in keys.items() if key in columns}
        if not is_alone:
            found.elsewhere |= {keys[q] for q in sources if q != "t" and not sources[q]}
        sources = {q: its_columns for q, its_columns in sources.items() if its_columns}
        _divide_by_file(header.path, sources, is_alone)
        if "t" not in sources and "t" not in columns and found.mapping.rate is None:
            found.changes["t"] = ["NAME"]
            found.faults.append(("t", f"names no column t ({header.list_names()})"))
        labels = {q: _name_of(q, suffix, sources.get(q, ()), export) for q in QUANTITIES}
        units = {q: _find_unit(header, q, its_columns[0], given, base) for q, its_columns in sources.items()}
        found.feet.append(
            FootTable(
                header.path,
                one or Foot.RIGHT,
                labels,
                sources=sources,
                units=units,
                is_named=bool(suffix) or tagged is not None,
                is_assumed=one is None,
                mapping=given,
            )
        )
    return found


def _divide_by_file(path: Path, columns: dict[str, tuple[NamedColumn, ...]], is_alone: bool) -> None:
    """Remove a sensor whose columns have the names of another one's, if the name of the file says which it is of."""
    sensor = sensor_of_file(path)
    if not is_alone and sensor is not None and "acc" in columns and columns["acc"] == columns.get("gyro"):
        del columns["gyro" if sensor == "acc" else "acc"]


def sensor_of_file(path: Path) -> str | None:
    """Return the quantity that the name of a file of one sensor says; None if it says none."""
    stem = path.stem.lower()
    return "gyro" if "gyr" in stem else "acc" if "acc" in stem else None


def _name_of(quantity: str, suffix: str, columns: Sequence[NamedColumn], export: Export | None) -> str:
    """Return the name of a quantity in messages: this project's own, or that of its first column."""
    if quantity != "t" or not columns:
        return quantity + suffix
    if export is OWN:
        return quantity + (suffix if "_" in columns[0].name else "")
    return f"{quantity} ({columns[0].name})"


def _resolve(found: TableColumns, key: str, quantity: str) -> tuple[NamedColumn, ...]:
    """Return the columns that the mapping names for a key; faults go to those of `found`."""
    names, header = found.mapping.columns[key], found.header
    columns: list[NamedColumn] = []
    missing: list[str] = []
    corrected: list[str] = []
    for name in names:
        matches = match_name(header.names, name)
        if not matches:
            missing.append(printable(name.lstrip("-"), 40))
            corrected.append(_closest([one for one in header.names if one not in names], name))
        elif len(matches) > 1 and "*" not in name:
            numbers = [f"#{match.index + 1}" for match in matches]
            found.faults.append((key, f"names the column {printable(name, 40)} twice: it is {' or '.join(numbers)}"))
            corrected.append(numbers[0])
        else:
            corrected.append(name)
        columns += matches if "*" in name else matches[:1]
    if missing:
        found.faults.append((key, f"names no column {', '.join(missing)} ({header.list_names()})"))
    elif quantity in COMPONENTS and len(columns) != COMPONENTS[quantity]:
        listed = ", ".join(printable(column.name, 40) for column in columns)
        found.faults.append((key, f"{key} needs {COMPONENTS[quantity]} columns, not {len(columns)} ({listed})"))
        corrected = ["X", "Y", "Z"][: COMPONENTS[quantity]]
    if corrected != list(names):
        found.changes[key] = corrected
    return tuple(columns)


def _closest(names: Sequence[str], name: str) -> str:
    """Return the name of a column that is spelt much like another one, with its sign; "NAME" without one."""
    close = get_close_matches(name.lower().lstrip("-"), [one.lower() for one in names], 1, 0.7)
    sign = "-" if name.startswith("-") else ""
    return sign + next((one for one in names if [one.lower()] == close), "NAME")


def _find_unit(header: SheetLayout, quantity: str, column: NamedColumn, given: TableMapping, base: TableMapping) -> str:
    """Return the unit of a quantity: as it is given, as the header says, as the known format has it, or SI."""
    if quantity in given.units:
        return unit_of(given.units[quantity], quantity) or given.units[quantity]
    below = header.units[column.index] if column.index < len(header.units) else ""
    stated = unit_of_name(column.name, quantity) or unit_of(below, quantity)
    return stated or base.units.get(quantity, next(iter(UNITS[quantity])))
