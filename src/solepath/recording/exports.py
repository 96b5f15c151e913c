"""Known formats of tables of samples: those of formats.toml, and this project's own.

The names of this project are t,acc_x,acc_y,acc_z,gyro_x,...,pressure_0,... in SI units, and acc_x_left of a foot. Other
columns are ignored."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from importlib.resources import files
from typing import TYPE_CHECKING

from attrs import evolve, field, frozen

from .mapping.mapping import TableMapping, match_name

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
        return any(not key.startswith("t") for key in self._find(header))

    def read_mapping(self, header: SheetLayout) -> TableMapping:
        columns = self._find(header)
        if 0 < sum("_" in key for key in columns if key[0] != "t") < sum(key[0] != "t" for key in columns):
            raise ValueError("has columns with and without a foot's name: is it of one foot or of two?")
        return TableMapping(columns)

    def _find(self, header: SheetLayout) -> dict[str, list[str]]:
        """Return the names that the columns of each key should have, if the header has any of them."""
        expected = {}
        for end in ("", "_left", "_right"):
            cells = len([name for name in header.names if re.fullmatch(f"pressure_[0-9]+{end}", name)])
            expected[f"t{end}"] = [f"t{end}"]
            for quantity, axes in (("acc", "xyz"), ("gyro", "xyz"), ("pressure", range(cells))):
                expected[quantity + end] = [f"{quantity}_{axis}{end}" for axis in axes]
        return {key: names for key, names in expected.items() if not set(names).isdisjoint(header.names)}


OWN = _OwnExport()
"""The format with this project's own names."""
EXPORTS: dict[str, Export] = {}
"""Known formats by name (mapping.FORMATS), in the order in which they are tried."""
for _name, _row in tomllib.loads(files("solepath.recording").joinpath("formats.toml").read_text("utf-8")).items():
    _declared = {key: _row.pop(key) for key in ("columns", "units", "wrap") if key in _row}
    EXPORTS[_name] = Export(TableMapping(**_declared), **_row)
EXPORTS["solepath"] = OWN
