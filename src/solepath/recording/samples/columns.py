"""Finding of the columns that a mapping names, in the header of a table, with all faults at once."""

from __future__ import annotations

from collections.abc import Sequence, Set
from difflib import get_close_matches
from pathlib import Path

from attrs import define, field

from ...types import Foot
from ..errors import RecordingError, printable
from ..exports import EXPORTS, OWN, Export
from ..mapping.mapping import COMPONENTS, MEASURED, QUANTITIES, SCALED, NamedColumn, TableMapping, match_name
from ..mapping.units import DATETIME, SI, unit_of, unit_of_name
from ..mapping.words import foot_of_text
from .sheet import SheetLayout, is_datetime
from .table import FootTable


@define
class TableColumns:
    """Columns of a table that a mapping names, with what is wrong with them."""

    header: SheetLayout
    given: TableMapping
    """Mapping of the user."""
    export: Export | None
    mapping: TableMapping
    """Mapping of the user, with what it leaves out."""
    feet: list[FootTable] = field(factory=list)
    """Tables of the feet, without rows."""
    faults: dict[str, list[str]] = field(factory=dict)
    """Faults by key of the mapping; the key "" for a fault of the whole table."""
    changes: dict[str, list[str]] = field(factory=dict)
    """Names of columns that would repair them, by key; "NAME" for one that is not known."""
    chosen: dict[int, str] = field(factory=dict)
    """Value of the rows that count in each of these columns, by its index."""
    scales: dict[str, str] = field(factory=dict)
    """Counts per unit of raw values, as far as they can be guessed."""
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
        return self.mapping.columns.keys() - self.elsewhere - self.faults.keys()

    def list_problems(self, found_elsewhere: Set[str] = frozenset()) -> list[RecordingError]:
        """Return what is wrong, with what repairs it, except for keys that another file holds."""
        changes = {key: names for key, names in self.changes.items() if key not in found_elsewhere}
        problems = []
        for key in [key for key in self.faults if key not in found_elsewhere]:
            repair = self.given.write_columns(key, changes) if key else self.export.repair if self.export else ""
            if key == "t" and changes["t"] == ["NAME"]:
                repair += f" or {self.given.write_setting('rate', 'HZ')}"
            problems += [RecordingError(self.header.path, what, self.header.where, repair) for what in self.faults[key]]
        return problems


def find_columns(header: SheetLayout, given: TableMapping, foot: Foot | None, *, is_alone: bool = True) -> TableColumns:
    """Return the columns of a table: those of `given`, and for what it leaves out those of a known format.

    `foot` is the foot of a table of one foot, None if that is not known. `is_alone`: no other file may hold what this
    one does not."""
    known = [EXPORTS[given.format]] if given.format else [one for one in EXPORTS.values() if one.fits(header)]
    export = known[0] if known else None
    found = TableColumns(header, given, export, given)
    tagged, base = None, TableMapping()
    if export is not None:
        tagged = foot_of_text(export.read_tag(header)) if foot is None else None
        try:
            base = export.read_mapping(header)
        except ValueError as error:
            if not any(key.startswith(("acc", "pressure")) for key in given.columns):
                found.faults[""] = [str(error)]
                return found
    found.mapping = given.completed(base)
    for name, value in given.rows.items():
        matches = match_name(header.names, name)
        if not matches:
            found.faults[""] = [f"has no column {printable(name, 40)} to choose rows by ({header.list_names()})"]
            return found
        found.chosen[matches[0].index] = value
    columns, is_of_one_foot = found.mapping.columns, found.mapping.is_of_one_foot
    for one in [foot or tagged] if is_of_one_foot else Foot:
        suffix = "" if is_of_one_foot or one is None else f"_{one.value}"
        both = {q: f"{q}_{one.value}" if one else q for q in QUANTITIES}
        keys = {q: key if key in columns or (suffix and q != "t") else q for q, key in both.items()}
        keys = {q: key for q, key in keys.items() if key in columns}
        if not keys.keys() & {*MEASURED}:
            continue
        sources = {q: its_columns for q, key in keys.items() if (its_columns := _resolve(found, key, q))}
        if not is_alone:
            found.elsewhere |= {keys[q] for q in keys.keys() - sources.keys() - {"t"}}
            _divide_by_file(found, sources)
        if "t" not in keys and found.mapping.rate is None:
            found.changes["t"] = ["NAME"]
            found.faults["t"] = [f"names no column t ({header.list_names()})"]
        names = {q: q + suffix for q in QUANTITIES}
        if "t" in sources:
            time = sources["t"][0]
            own = "t" + (suffix if "_" in time.name else "")
            names["t"] = own if export is OWN else f"t ({time.name})"
        found.feet.append(
            FootTable(
                header.path,
                one or Foot.RIGHT,
                names,
                sources=sources,
                units={q: _find_unit(header, q, its_columns[0], given, base) for q, its_columns in sources.items()},
                is_named=bool(suffix) or tagged is not None,
                is_assumed=one is None,
                mapping=given,
            )
        )
    return found


def _divide_by_file(found: TableColumns, columns: dict[str, tuple[NamedColumn, ...]]) -> None:
    """Remove a sensor whose columns have the names of another one's, if the name of the file says which it is of."""
    sensor = sensor_of_file(found.header.path)
    if sensor is not None and "acc" in columns and columns["acc"] == columns.get("gyro"):
        other = "gyro" if sensor == "acc" else "acc"
        found.elsewhere.add(other)
        del columns[other]


def sensor_of_file(path: Path) -> str | None:
    """Return the quantity that the name of a file of one sensor says; None if it says none."""
    stem = path.stem.lower()
    return "gyro" if "gyr" in stem else "acc" if "acc" in stem else None


def _resolve(found: TableColumns, key: str, quantity: str) -> tuple[NamedColumn, ...]:
    """Return the columns that the mapping names for a key; faults go to those of `found`."""
    names, header = found.mapping.columns[key], found.header
    columns: list[NamedColumn] = []
    missing: list[str] = []
    corrected: list[str] = []
    faults: list[str] = []
    for name in names:
        matches = match_name(header.names, name)
        corrected.append(name)
        if not matches:
            missing.append(printable(name.lstrip("-"), 40))
            corrected[-1] = _closest([one for one in header.names if one not in names], name)
        elif len(matches) > 1 and "*" not in name:
            numbers = [f"#{match.index + 1}" for match in matches]
            faults.append(f"names the column {printable(name, 40)} twice: it is {' or '.join(numbers)}")
            corrected[-1] = numbers[0]
        columns += matches if "*" in name else matches[:1]
    if missing:
        faults.append(f"names no column {', '.join(missing)} ({header.list_names()})")
    elif len(columns) != COMPONENTS.get(quantity, len(columns)):
        listed = printable(", ".join(column.name for column in columns), 80)
        faults.append(f"{key} needs {COMPONENTS[quantity]} columns, not {len(columns)} ({listed})")
        corrected = ["X", "Y", "Z"][: COMPONENTS[quantity]]
    if faults:
        found.faults[key], found.changes[key] = faults, corrected
    return tuple(columns)


def _closest(names: Sequence[str], name: str) -> str:
    """Return the name of a column that is spelt much like another one, with its sign; "NAME" without one."""
    close = get_close_matches(name.lower().lstrip("-"), [one.lower() for one in names], 1, 0.7)
    sign = "-" if name.startswith("-") else ""
    return sign + next((one for one in names if [one.lower()] == close), "NAME")


def _find_unit(header: SheetLayout, quantity: str, column: NamedColumn, given: TableMapping, base: TableMapping) -> str:
    """Return the unit of a quantity: as it is given, as the header says, as the known format has it, or SI."""
    if quantity == "t" and any(is_datetime(text, header.decimal) for text in header.example[column.index :][:1]):
        return DATETIME
    if quantity in given.scale:
        return SCALED[quantity]
    if quantity in given.units:
        return unit_of(given.units[quantity], quantity) or given.units[quantity]
    below = "".join(header.units[column.index :][:1])
    stated = unit_of_name(column.name, quantity) or unit_of(below, quantity)
    return stated or base.units.get(quantity, SI[quantity])
