"""Known formats of tables of samples: how a file is recognised by its start, and the mapping with which it is read.

| format | what its files are like |
|---|---|
| movella-dot | Movella (Xsens) DOT, a file for each sensor. The logger of its SDK writes lines such as "DeviceTag:,". |
| | Columns are those of the mode (User Manual XD0502P, table 9). SampleTimeFine counts microseconds and starts again |
| | after 2^32 (4.2.5). FreeAcc is without gravity. MT Manager writes the same names for MTw and MTi in other units |
| mbientlab | MetaBase of MbientLab, a file for each sensor of each device (DataHandler.java of MetaWear-Android-MetaBase-App |
| | and sensor-config.js of MetaBase-Hub). `elapsed` starts from 0 in each file, so only `epoch`, `epoc` in MetaBase |
| | for iOS, is a common clock. Only the name of a file tells what the sensor fusion computed |
| physilog | Gait Up Physilog, a file for each sensor (HPI-CH/TRIPOD, doi:10.3390/data6090095): lines of groups with rates, |
| | names, and units. Times of sensors that were synchronised start together |
| moticon | Moticon OpenGo, both insoles in a file (text_import.py of moticon-rego/moticon-opengo). Axes are right handed in |
| | both, x to the toe: `solepath check` on the vendor's 8 strides of each foot |
| ngimu | x-io NGIMU, a folder for each device (xioTechnologies/NGIMU-MATLAB-Import-Logged-Data-Example). All devices count |
| | from the first time of any (NGIMU-Software-Public, issue 2) |
| solepath | this project: t,acc_x,acc_y,acc_z,gyro_x,...,pressure_0,... in SI units; acc_x_left or acc_left_x of a foot; |
| | 0, 1, 2 for x, y, z. Other columns are ignored |

In a file of both feet, a row in which all cells of one foot are blank has no sample of that foot."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING

from attrs import evolve, field, frozen

from .mapping.mapping import MEASURED, TableMapping, match_name

if TYPE_CHECKING:
    from .samples.layout import SheetLayout


@frozen
class Export:
    """A known format of tables."""

    name: str
    """Name of the format for --format."""
    mapping: TableMapping = field(factory=TableMapping)
    """Mapping of its columns; a file may lack those of a quantity."""
    marks: tuple[str, ...] = ()
    """Names that the header of each file has; the first one is that of the times if none of these is."""
    start: tuple[str, ...] = ()
    """Texts with one of which a line before the header starts, so that no other name is needed."""
    tag: str = ""
    """Start of the line with the name that the user gave the device, which may hold a foot."""
    flaws: Mapping[str, str] = field(factory=dict)
    """Patterns of lines before the header, with what they say about the worth of the file."""
    needed: tuple[str, ...] = ()
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
        if self.start and not any(line.startswith(self.start) for line in lines):
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
        found: dict[str, dict[int, str]] = {}
        for name in header.names:
            match = _OWN_NAME.fullmatch(name)
            if match is None or (match[2] and match[4]) or (match[1].lower() == "t" and match[3]):
                continue
            quantity, foot, axis = (text.lower() for text in (match[1], match[2] or match[4] or "", match[3] or "0"))
            numbers = found.setdefault("_".join(filter(None, (quantity, foot))), {})
            component = "xyz".index(axis) if axis in "xyz" else int(axis)
            if component in numbers:
                raise ValueError(f"names the column {name} twice")
            numbers[component] = name
        measured = [key for key in found if not key.startswith("t")]
        if 0 < sum("_" in key for key in measured) < len(measured):
            raise ValueError("has columns with and without a foot's name: is it of one foot or of two?")
        for key in measured:
            _check_components(key, sorted(found[key]))
        return TableMapping({key: [names[k] for k in sorted(names)] for key, names in found.items()})


_OWN_NAME = re.compile(
    r"(t|acc|gyro|pressure)(?:_(left|right))?(?:_([xyz]|[0-9]{1,4}))?(?:_(left|right))?", re.IGNORECASE
)


def _check_components(key: str, numbers: list[int]) -> None:
    quantity, _, foot = key.partition("_")
    first = min(1, *numbers) if quantity == "pressure" and len(numbers) > 1 else 0
    count = len(numbers) if quantity == "pressure" else 3
    for component in range(first, first + count):
        if component not in numbers:
            name = str(component) if quantity == "pressure" else "xyz"[component]
            raise ValueError(f"names no column {'_'.join(filter(None, (quantity, name, foot)))}")
    if len(numbers) > count:
        raise ValueError(f"names more than three columns of {key}")


OWN = _OwnExport("solepath")
"""The format with this project's own names."""
EXPORTS = {
    export.name: export
    for export in (
        Export(
            "movella-dot",
            TableMapping.parse(
                "t=SampleTimeFine,acc=Acc_X,Acc_Y,Acc_Z,gyro=Gyr_X,Gyr_Y,Gyr_Z", "us,deg/s", wrap=2.0**32
            ),
            marks=("PacketCounter", "SampleTimeFine"),
            start=("sep=", "DeviceTag:", "Measurement Mode:"),
            tag="DeviceTag:",
            flaws={
                r"SyncStatus:\s*,?\s*Un-?synced": "the sensor was not synchronised, so the feet have separate clocks"
            },
            needed=("acc", "gyro"),
            lacks="was recorded in a mode without {}",
            hints={"FreeAcc_X": "; FreeAcc is without gravity, from which no gait can be computed"},
            repair='record with "Rate quantities", "Custom mode 5", or with acceleration and angular velocity selected',
        ),
        Export(
            "mbientlab",
            TableMapping.parse(
                "t=epoc*,acc=x-axis (g),y-axis (g),z-axis (g),gyro=x-axis (deg/s),y-axis (deg/s),z-axis (deg/s)",
                "ms,g,deg/s",
            ),
            marks=("elapsed (s)",),
            computed="linear.?acceleration|gravity",
            repair="give the file of the Accelerometer instead",
        ),
        Export(
            "physilog",
            TableMapping.parse("t=Time,acc=Accel X,Accel Y,Accel Z,gyro=Gyro X,Gyro Y,Gyro Z", "g,deg/s"),
            start=("Gait Up - Physilog",),
            needed=("acc", "gyro"),
            repair="export accelerometer and gyroscope as well",
        ),
        Export(
            "moticon",
            TableMapping.parse(
                "t=time,"
                + ",".join(
                    f"acc_{foot}={foot} acceleration X*,{foot} acceleration Y*,{foot} acceleration Z*,"
                    f"gyro_{foot}={foot} angular X*,{foot} angular Y*,{foot} angular Z*,"
                    f"pressure_{foot}={foot} pressure *"
                    for foot in ("left", "right")
                ),
                "g,deg/s",
            ),
            needed=("acc",),
            lacks="has no columns of acceleration",
            repair="select acceleration and angular rate for the text export",
        ),
        Export(
            "ngimu",
            TableMapping.parse(
                "t=Time (s),acc=Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g),"
                "gyro=Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s)"
            ),
            marks=("Time (s)", "Gyroscope X (deg/s)", "Accelerometer X (g)"),
        ),
        OWN,
    )
}
"""Known formats by name (mapping.FORMATS), in the order in which they are tried."""
