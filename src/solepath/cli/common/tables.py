"""Options that say what the columns of tables of samples mean, for the commands that read them."""

from __future__ import annotations

from argparse import ArgumentTypeError, Namespace
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ...events import DefectFound, Event
from ...recording import Source, TableMapping, read_mapping
from ...recording.mapping.mapping import FORMATS
from ...show.tables.table import counted
from ...types import Foot, Sample
from .failure import Failure, note, parse_positive
from .inputs import source_of
from .own_devices import add_own_devices, drivers_of
from .parser import Option, option, together

if TYPE_CHECKING:
    from ...link.driver import Driver
    from ...recording.errors import Report

MAPPING_OPTIONS = ("columns", "units", "scale", "rows", "mapping", "format", "rate")
"""Options from which a mapping is made."""


def source_named(options: Namespace, own: Iterable[Driver] = (), report: Report = note) -> Source:
    """Open the recording of FILE... as the options of tables and --foot say; the errors are those of `source_of`."""
    return source_of(options.files, feet_of(options, options.files), mapping_of(options), own, report)


def samples_named(options: Namespace) -> tuple[Foot | None, Iterable[Sample]]:
    """Return the foot of --foot, if it is one, and the samples of the recording of FILE..., also those of packets."""
    from ...recording.decoded import decode_recording

    source = source_named(options, drivers_of(options))
    return source.foot, decode_recording(source).samples


def parse_feet(text: str) -> tuple[Foot, ...]:
    """Parse a value of --foot: feet with commas between them."""
    try:
        return tuple(Foot(word.strip().lower()) for word in text.split(","))
    except ValueError:
        raise ArgumentTypeError(f"{text[:80]!r}: each foot is left or right, with commas between them") from None


def table_options(metavar: str = "FILE") -> Option:
    """Return FILE... under this name, and the options for tables of samples and for own devices."""
    files = option(
        "files",
        metavar=metavar,
        type=Path,
        nargs="+",
        help="the recording; of samples, one file or those of both feet or of several sensors (docs/formats.md)",
    )
    return together(files, mapping_options)


mapping_options = together(
    add_own_devices,
    option(
        "--foot",
        metavar="FOOT[,FOOT...]",
        type=parse_feet,
        help="left or right: whose the samples of one foot are (default: by the name of the file, else right); of "
        "other recordings, the foot to use; for several files, that of each in their order",
    ),
    option(
        "--columns", metavar="NAMES", help="names of columns, as in t=Time,acc=AX,AY,-AZ,gyro=GX,GY,-GZ; - turns a sign"
    ),
    option("--units", metavar="UNITS", help="units that are not SI, as in g,deg/s,ms"),
    option(
        "--scale",
        metavar="SCALES",
        help="counts per g and per degree/s of raw values, as in acc=2048,gyro=16.4 (also t: per s)",
    ),
    option(
        "--rows",
        metavar="COLUMN=VALUE",
        action="append",
        help="the rows that count, as in device=3 where a file has several; may be given again",
    ),
    option("--rate", metavar="HZ", type=parse_positive, help="samples a second, in place of a column of times"),
    option("--format", metavar="NAME", choices=FORMATS, help="name of a known format that has lost its first lines"),
    option("--mapping", metavar="FILE", type=Path, help="all of this from a TOML file"),
)
"""The options for tables of samples and for own devices."""


def feet_of(options: Namespace, files: Sequence[Path]) -> Foot | tuple[Foot, ...] | None:
    """Return the foot of --foot, or those of these files; None without it.

    Failure is raised when it names another number of feet than of files."""
    feet: tuple[Foot, ...] = options.foot or ()
    if len(feet) > 1 and len(feet) != len(files):
        raise Failure(
            f"--foot: that is {len(feet)} feet for {counted(len(files), 'file')}: {' '.join(map(str, files))}"
        )
    return feet if len(feet) > 1 else next(iter(feet), None)


def mapping_of(options: Namespace) -> TableMapping | None:
    """Return the mapping of --columns, --units, --scale, --rows, --format, --rate and --mapping; None without any.

    What options say goes before what the file says. Failure or RecordingError is raised for a malformed one."""
    if all(getattr(options, name) is None for name in MAPPING_OPTIONS):
        return None
    if options.mapping is not None and options.mapping.is_dir():
        raise Failure(f"{options.mapping}: is a folder, not a file")
    saved = TableMapping() if options.mapping is None else read_mapping(options.mapping)
    try:
        columns, units, scale = [getattr(options, name) or "" for name in ("columns", "units", "scale")]
        given = TableMapping.parse(columns, units, scale, options.rows or (), rate=options.rate)
        return saved.replaced(given, format=options.format or saved.format)
    except ValueError as error:
        raise Failure("; ".join(str(error).splitlines())) from None


def axes_repair(source: Source, event: Event | None) -> str:
    """Return what gives the gyroscope of a table the axes that fit; "" for anything else than wrong axes of a table."""
    if source.samples is None or not isinstance(event, DefectFound) or event.axes is None:
        return ""
    tables = source.samples.tables
    for table in tables:
        names = table.signed.get("gyro", ())
        if table.foot is event.site.foot and len(names) == 3:
            turned = [_turn(names[abs(axis) - 1]) if axis < 0 else names[abs(axis) - 1] for axis in event.axes]
            is_alone = len(tables) == 1 or table.mapping.is_of_one_foot and tables[0].signed == tables[-1].signed
            key = "gyro" if is_alone else f"gyro_{table.foot.value}"
            return f"; repair, if the gyroscope is wrong: {table.mapping.write_columns(key, {key: turned})}"
    return ""


def _turn(name: str) -> str:
    return name[1:] if name.startswith("-") else f"-{name}"
