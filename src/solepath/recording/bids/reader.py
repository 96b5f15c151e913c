"""Reads the inertial samples of a recording in a Motion-BIDS dataset, from whatever program.

The path is that of any `_motion.tsv` of the recording: its other tracking systems are read with it. channels.tsv says
what the columns are: ACCEL in m/s^2 or g, GYRO in rad/s or deg/s, LATENCY in s; pressure cells as solepath writes them.
The tracked point says which foot it is: left_foot, LeftFoot, l_ankle, R-shoe and the like. Metadata are inherited from
the folders above (BIDS, "The Inheritance Principle")."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from datetime import datetime
from pathlib import Path
from typing import Any
from warnings import catch_warnings, simplefilter

import numpy as np
from attrs import define, field

from ...types import Foot
from ..bad_rows import BadRows
from ..errors import RecordingError, Report, os_error_text, printable, warn
from ..mapping.units import UNITS, factor_of
from ..samples.reader import SampleRecording, use_tables
from ..samples.table import Floats, FootTable
from .columns import read_json, read_table
from .names import MOTION_END, TSV_MISSING, recording_of

CELL_UNITS = ("N", TSV_MISSING)
"""Units of pressure cells, whose values are taken as they are."""
_QUANTITY_OF_TYPE = {"ACCEL": "acc", "GYRO": "gyro"}
_SIDE = re.compile(r"(?:^|[^a-z])(left|right|l|r)(?=[^a-z]|$)|(left|right)")
_ON_FOOT = re.compile(r"foot|shoe|ankle|heel|toe|insole|instep|calcn|lf\b|rf\b")


def load_motion(path: Path | str, foot: Foot | None = None, *, report: Report = warn) -> SampleRecording:
    """Return the samples of the feet in the recording to which the file `path` (`*_motion.tsv`) belongs.

    `foot`: of a recording of one sensor that names no foot, the foot that wore it (None: the right one); else the only
    foot to read (None: both). `report` receives sentences about rows that are left out. RecordingError when there is no
    foot with ACCEL or GYRO channels, and for a unit that is not known."""
    path = Path(path)
    systems = [_TrackingSystem(one) for one in _tracking_systems(path)]
    points = [(system, point) for system in systems for point in system.points]
    named = [(system, point, side) for system, point in points if (side := foot_of_point(point)) is not None]
    if not named and len(points) == 1:
        named = [(*points[0], foot or Foot.RIGHT)]
    if not named:
        found = ", ".join(sorted({point for _, point in points})) or "none"
        raise RecordingError(path, f"no tracked point with ACCEL or GYRO is a foot; there are: {printable(found)}")
    feet = [side for _, _, side in named]
    for side in Foot:
        if feet.count(side) > 1:
            where = ", ".join([point for _, point, other in named if other is side])
            raise RecordingError(path, f"several tracked points are on the {side.value} foot: {printable(where)}")
    starts = [system.start for system in systems if system.start is not None]
    # without the start of every file, all are taken to start together
    delays = [
        one.start - min(starts) if one.start is not None and len(starts) == len(systems) else 0.0 for one, _, _ in named
    ]
    tables = [system.table(point, side, delay) for (system, point, side), delay in zip(named, delays, strict=True)]
    return use_tables(path, sorted(tables, key=lambda one: one.foot.value), foot, BadRows(path, report, "row"))


def foot_of_point(point: str) -> Foot | None:
    """Return the foot that a tracked point names, such as LeftFoot or r_ankle; None for any other point."""
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", point).lower()
    side = _SIDE.search(words)
    if side is None or not _ON_FOOT.search(words):
        return None
    return Foot.LEFT if (side[1] or side[2]).startswith("l") else Foot.RIGHT


def _tracking_systems(path: Path) -> list[Path]:
    """Return the files of the same recording, one for each tracking system."""
    if not path.name.endswith(MOTION_END):
        raise RecordingError(path, f"is no file of Motion-BIDS, whose name ends in {MOTION_END}")
    if not path.is_file():
        raise RecordingError(path, "no such file")
    return [one for one in sorted(path.parent.glob(f"*{MOTION_END}")) if recording_of(one) == recording_of(path)]


@define
class _TrackingSystem:
    """One `_motion.tsv` with what its channels and metadata say."""

    path: Path
    channels: list[dict[str, str]] = field(init=False)
    metadata: dict[str, Any] = field(init=False)
    start: float | None = field(init=False)
    """Start of the recording as a count of seconds; None if it is not known."""
    _values: Floats | None = field(default=None, init=False)

    def __attrs_post_init__(self) -> None:
        beside = self.path.with_name(self.path.name.removesuffix(MOTION_END) + "_channels.tsv")
        try:
            self.channels = read_table(beside)
        except OSError as error:
            raise RecordingError(beside, os_error_text(error)) from error
        if not self.channels or not all("type" in channel for channel in self.channels):
            raise RecordingError(beside, "describes no channels, each with a type")
        self.metadata = _inherited(self.path)
        self.start = _start_of(self.path)

    @property
    def points(self) -> list[str]:
        """Tracked points with an accelerometer or gyroscope, in the order of their channels."""
        return list(
            dict.fromkeys([c.get("tracked_point", "") for c in self.channels if c.get("type") in _QUANTITY_OF_TYPE])
        )

    def table(self, point: str, foot: Foot, delay: float) -> FootTable:
        """Return the samples of a tracked point; `delay` is the start after that of the earliest file, s."""
        rows = self._read()
        columns: dict[str, Floats] = {}
        names = {"t": "latency"}
        for quantity, numbers in self._columns(point).items():
            units = dict.fromkeys(self.channels[number].get("units", "") for number in numbers)
            factors = {_factor_of(unit, quantity) for unit in units}
            if len(factors) != 1 or (factor := factors.pop()) is None:
                known = ", ".join(CELL_UNITS if quantity == "pressure" else UNITS[quantity])
                raise RecordingError(
                    self.path, f"{quantity} is in {printable(', '.join(units))}, not in one of {known}"
                )
            columns[quantity] = rows[:, numbers] * factor
            names[quantity] = f"{quantity}_{foot.value}"
        t = self._times(rows) + delay
        given = np.zeros(len(t), dtype=bool)
        for quantity in ("acc", "gyro"):
            if quantity in columns:
                given |= ~np.isnan(columns[quantity]).any(axis=1)
        lines = np.flatnonzero(given) + 1
        columns = {quantity: values[given] for quantity, values in columns.items()}
        return FootTable(self.path, foot, names, t[given], columns, lines)

    def _read(self) -> Floats:
        if self._values is None:
            try:
                with self.path.open(encoding="utf-8-sig") as file, catch_warnings():
                    simplefilter("ignore")  # of a file without rows, which is reported below
                    rows = np.loadtxt(_numeric(file), dtype=np.float64, delimiter="\t", ndmin=2)
            except ValueError as error:
                raise RecordingError(self.path, f"is no table of numbers: {printable(str(error))}") from None
            except OSError as error:
                raise RecordingError(self.path, os_error_text(error)) from error
            if not rows.size:
                raise RecordingError(self.path, "holds no samples")
            if rows.shape[1] != len(self.channels):
                what = f"has {rows.shape[1]} columns, and channels.tsv describes {len(self.channels)}"
                raise RecordingError(self.path, what)
            self._values = rows
        return self._values

    def _columns(self, point: str) -> dict[str, list[int]]:
        """Return the columns of each quantity of a tracked point, x, y and z in this order."""
        found: dict[str, dict[str, int]] = {}
        for number, channel in enumerate(self.channels):
            if channel.get("tracked_point") != point:
                continue
            quantity = _QUANTITY_OF_TYPE.get(channel.get("type", ""))
            name, component = channel.get("name", ""), channel.get("component", "").lower()
            if quantity is not None:
                found.setdefault(quantity, {})[component] = number
            elif channel.get("type") == "MISC" and re.fullmatch(r"pressure_[0-9]+", name):
                found.setdefault("pressure", {})[name] = number
        for quantity, numbers in found.items():
            if quantity != "pressure" and not {"x", "y", "z"} <= numbers.keys():
                raise RecordingError(self.path, f"{quantity} of {printable(point)} has no x, y and z")
        return {
            quantity: [numbers[axis] for axis in (("x", "y", "z") if quantity != "pressure" else numbers)]
            for quantity, numbers in found.items()
        }

    def _times(self, rows: Floats) -> Floats:
        latencies = [number for number, channel in enumerate(self.channels) if channel.get("type") == "LATENCY"]
        if latencies:
            return rows[:, latencies[0]]
        rates = [self.metadata.get(key) for key in ("SamplingFrequencyEffective", "SamplingFrequency")]
        rate = next((float(one) for one in rates if isinstance(one, int | float) and one > 0), None)
        if rate is None:
            raise RecordingError(self.path, "has no LATENCY channel, and its metadata have no SamplingFrequency")
        return np.arange(len(rows), dtype=np.float64) / rate


def _factor_of(unit: str, quantity: str) -> float | None:
    if quantity == "pressure":
        return 1.0 if unit.strip() in CELL_UNITS else None
    return factor_of(unit, quantity)


def _numeric(lines: Iterator[str]) -> Iterator[str]:
    for line in lines:
        yield line.replace(TSV_MISSING, "nan")


def _inherited(path: Path) -> dict[str, Any]:
    """Return the metadata of a file, with those of the folders above it up to the dataset's own."""
    entities = set(path.name.removesuffix(MOTION_END).split("_"))
    found: list[Mapping[str, Any]] = []
    for folder in path.parents:
        for one in sorted(folder.glob("*motion.json"), key=lambda file: -len(file.name)):
            if set(one.name.removesuffix("motion.json").strip("_").split("_")) - {""} <= entities:
                found.append(read_json(one))
        if (folder / "dataset_description.json").is_file():
            break
    merged: dict[str, Any] = {}
    for content in reversed(found):
        merged |= content
    return merged


def _start_of(path: Path) -> float | None:
    """Return the start of a file as scans.tsv of the folder above has it, in seconds; None if it does not."""
    for scans in path.parent.parent.glob("*_scans.tsv"):
        for row in read_table(scans):
            if Path(row.get("filename", "")).name == path.name:
                try:
                    return datetime.fromisoformat(row.get("acq_time", "")).timestamp()
                except ValueError:
                    return None
    return None
