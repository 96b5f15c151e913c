"""Known formats of tables of samples: those of formats.toml, and this project's own.

The names of this project are t,acc_x,acc_y,acc_z,gyro_x,...,pressure_0,... in SI units; acc_x_left or acc_left_x of a
foot, with 0, 1, 2 for x, y, z. Other columns are ignored."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import TYPE_CHECKING

from attrs import evolve, field, frozen

from .mapping.mapping import MEASURED, TableMapping, match_name

if TYPE_CHECKING:
    from .samples.sheet import SheetLayout


@frozen
class Export:
    """A known format of tables."""

    mapping: TableMapping = field(factory=TableMapping)
    """Mapping of its columns; a file may lack those of a quantity."""
    marks: Sequence[str] = ()
    """Names that the header of each file has; the first one is that of the times if none of these is."""
    start: Sequence[str] = ()
    """Texts with one of which a line before the header starts, so that no other name is needed."""
    tag: str = ""
    """Start of the line with the name that the user gave the device, which may hold a foot."""
    flaws: Mapping[str, str] = field(factory=dict)
    """Patterns of lines before the header, with what they say about the worth of the file."""
    needed: Sequence[str] = ()
    """Quantities that each file has to have."""
    lacks: str = "has no columns {}"
    """Sentence for a file without the columns of a needed quantity."""
    hints: Mapping[str, str] = field(factory=dict)
    """What that sentence ends with for a file that has this column."""
    computed: str = ""
    """Pattern in the names of files of what no sensor measured."""
    repair: str = ""
    """Action that gives a file with what is needed."""

    def fits(self, header: SheetLayout) -> bool:
        """Return whether the start of a file is of this format."""
        lines = [line.lstrip('"') for line in header.preamble]
        if self.start and not any(line.startswith(tuple(self.start)) for line in lines):
            return False
        columns = self.mapping.columns
        has_time = columns["t"][0] in self.marks or match_name(header.names[:1], columns["t"][0])
        sensors = [name for key, names in columns.items() if key != "t" for name in names]
        has_sensor = self.start or any(match_name(header.names, name) for name in sensors)
        return bool(has_time and has_sensor and set(self.marks) <= set(header.names))

    def read_mapping(self, header: SheetLayout) -> TableMapping:
        """Return the mapping of a file; ValueError, with a sentence, for a file that lacks what is needed."""
        computed = re.search(self.computed, header.path.stem, re.IGNORECASE) if self.computed else None
        if computed is not None:
            raise ValueError(f'holds "{computed[0]}" of the sensor fusion, not what the accelerometer measured')
        columns = {
            key: names
            for key, names in self.mapping.columns.items()
            if key == "t" or any(match_name(header.names, name) for name in names)
        }
        for quantity in self.needed:
            names = self.mapping.columns.get(quantity, ())
            if not any(key.startswith(quantity) for key in columns) or any(n not in header.names for n in names):
                hint = "".join(text for name, text in self.hints.items() if name in header.names)
                raise ValueError(self.lacks.format(", ".join(names)) + hint)
        return evolve(self.mapping, columns=columns)

    def read_tag(self, header: SheetLayout) -> str:
        """Return the name that the user gave the device; "" without one."""
        tags = [line.partition(":")[2].strip(", ") for line in header.preamble if line.startswith(self.tag)]
        return tags[0] if self.tag and tags else ""

    def list_flaws(self, header: SheetLayout) -> list[str]:
        """Return what the start of a file says about its worth, in sentences."""
        lines = header.preamble
        return [text for one, text in self.flaws.items() if any(re.match(one, line, re.I) for line in lines)]


class _OwnExport(Export):
    """The format with this project's own names, whose meaning is in the name itself."""

    def fits(self, header: SheetLayout) -> bool:
        # other programs write Acc_X too, but not beside a column t
        names = [match[1] for match in map(_OWN_NAME.fullmatch, header.names) if match]
        has_time = "t" in map(str.lower, names)
        return any((name.lower() if has_time else name) in MEASURED for name in names)

    def read_mapping(self, header: SheetLayout) -> TableMapping:
        found: dict[str, dict[str, str]] = {}
        for name in header.names:
            match = _OWN_NAME.fullmatch(name)
            if match is None or (match[2] and match[4]) or (match[1].lower() == "t" and match[3]):
                continue
            quantity, foot, axis = (text.lower() for text in (match[1], match[2] or match[4] or "", match[3] or "0"))
            if quantity in ("acc", "gyro"):
                axis = {"0": "x", "1": "y", "2": "z"}.get(axis, axis)
            found.setdefault("_".join(filter(None, (quantity, foot))), {})[axis] = name
        measured = [key for key in found if not key.startswith("t")]
        if 0 < sum("_" in key for key in measured) < len(measured):
            raise ValueError("has columns with and without a foot's name: is it of one foot or of two?")
        columns = {}
        for key, names in found.items():
            quantity, _, foot = key.partition("_")
            first = int("0" not in names and len(names) > 1)
            axes = {"t": ["0"], "pressure": map(str, range(first, first + len(names)))}.get(quantity, "xyz")
            # a component that is missing has the name that it should have
            columns[key] = [names.pop(axis, "_".join(filter(None, (quantity, axis, foot)))) for axis in axes]
            columns[key] += names.values()
        return TableMapping(columns)


_OWN_NAME = re.compile(
    r"(t|acc|gyro|pressure)(?:_(left|right))?(?:_([xyz]|[0-9]{1,4}))?(?:_(left|right))?", re.IGNORECASE
)
OWN = _OwnExport()
"""The format with this project's own names."""
EXPORTS: dict[str, Export] = {}
"""Known formats by name (mapping.FORMATS), in the order in which they are tried."""
for _name, _row in tomllib.loads(files("solepath.recording").joinpath("formats.toml").read_text("utf-8")).items():
    _declared = {key: _row.pop(key) for key in ("columns", "units", "wrap") if key in _row}
    EXPORTS[_name] = Export(TableMapping(**_declared), **_row)
EXPORTS["solepath"] = OWN
