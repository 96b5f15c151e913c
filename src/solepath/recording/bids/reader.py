"""Reads the inertial samples of a recording in a Motion-BIDS dataset, from whatever program.

The path is that of any `_motion.tsv` of the recording: its other tracking systems are read with it. channels.tsv says
what the columns are: ACCEL in m/s^2 or g, GYRO in rad/s or deg/s, LATENCY in s; pressure cells as solepath writes them.
The tracked point says which foot it is: left_foot, LeftFoot, l_ankle, R-shoe and the like. Metadata are inherited from
the folders above (BIDS, "The Inheritance Principle")."""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterable, Sequence
from datetime import datetime
from math import isnan, nan
from pathlib import Path
from typing import Any

from attrs import define, field

from ...types import Foot
from ..bad_rows import BadRows
from ..errors import RecordingError, Report, os_error_text, printable, warn
from ..mapping.units import UNITS, unit_of
from ..mapping.words import foot_of_text
from ..samples.reader import SampleRecording, use_tables
from ..samples.table import FootTable, floats
from .columns import read_json, read_table
from .names import MOTION_END, TSV_MISSING, recording_of

CELL_UNITS = ("N", TSV_MISSING)
"""Units of pressure cells, whose values are taken as they are."""
_QUANTITY_OF_TYPE = {"ACCEL": "acc", "GYRO": "gyro"}
ON_FOOT = re.compile(r"foot|shoe|ankle|heel|toe|insole|instep|calcn|lf\b|rf\b", re.IGNORECASE)
"""Pattern of the tracked points that are on a foot."""


def load_motion(path: Path | str, foot: Foot | None = None, *, report: Report = warn) -> SampleRecording:
    """Return the samples of the feet in the recording to which the file `path` (`*_motion.tsv`) belongs.

    `foot`: of a recording of one sensor that names no foot, the foot that wore it (None: the right one); else the only
    foot to read (None: both). `report` receives sentences about rows that are left out. RecordingError when there is no
    foot with ACCEL or GYRO channels, and for a unit that is not known."""
    path = Path(path)
    if not path.name.endswith(MOTION_END):
        raise RecordingError(path, f"is no file of Motion-BIDS, whose name ends in {MOTION_END}")
    if not path.is_file():
        raise RecordingError(path, "no such file")
    beside = sorted(path.parent.glob(f"*{MOTION_END}"))
    systems = [_TrackingSystem(one) for one in beside if recording_of(one) == recording_of(path)]
    points = [
        (system, point, foot_of_text(point) if ON_FOOT.search(point) else None)
        for system in systems
        for point in system.points
    ]
    if len(points) == 1:
        points = [(system, point, side or foot or Foot.RIGHT) for system, point, side in points]
    named = [(system, point, side) for system, point, side in points if side is not None]
    if not named:
        found = printable(", ".join(sorted({point for _, point, _ in points})) or "none")
        raise RecordingError(path, f"no tracked point with ACCEL or GYRO is a foot; there are: {found}")
    for side in Foot:
        same = [point for _, point, other in named if other is side]
        if len(same) > 1:
            where = printable(", ".join(same))
            raise RecordingError(path, f"several tracked points are on the {side.value} foot: {where}")
    # without the start of every file, all are taken to start together
    starts = [nan if system.start is None else system.start for system in systems]
    first = min(starts) if not any(map(isnan, starts)) else None
    tables = [system.read(point, side, first) for system, point, side in named]
    return use_tables(path, sorted(tables, key=lambda one: one.foot.value), foot, BadRows(path, report, "row"))


@define
class _TrackingSystem:
    """One `_motion.tsv` with what its channels and metadata say."""

    path: Path
    channels: list[dict[str, str]] = field(init=False)
    points: dict[str, dict[str, dict[str, int]]] = field(factory=dict, init=False)
    """Number of the channel of each component, by quantity, of each tracked point with an inertial sensor."""
    metadata: dict[str, Any] = field(init=False)
    start: float | None = field(init=False)
    """Start of the recording as a count of seconds; None if it is not known."""

    def __attrs_post_init__(self) -> None:
        beside = self.path.with_name(self.path.name.removesuffix(MOTION_END) + "_channels.tsv")
        try:
            self.channels = read_table(beside)
        except OSError as error:
            raise RecordingError(beside, os_error_text(error)) from error
        if not self.channels or not all("type" in channel for channel in self.channels):
            raise RecordingError(beside, "describes no channels, each with a type")
        self.metadata, self.start = _inherited(self.path), _start_of(self.path)
        points: dict[str, dict[str, dict[str, int]]] = {}
        for number, channel in enumerate(self.channels):
            component, name = channel.get("component", "").lower(), channel.get("name", "")
            quantity = _QUANTITY_OF_TYPE.get(channel["type"], "")
            if channel["type"] == "MISC" and re.fullmatch(r"pressure_[0-9]+", name):
                quantity, component = "pressure", name
            if quantity:
                points.setdefault(channel.get("tracked_point", ""), {}).setdefault(quantity, {})[component] = number
        self.points = {point: found for point, found in points.items() if found.keys() & {"acc", "gyro"}}

    def read(self, point: str, foot: Foot, first: float | None) -> FootTable:
        """Return the samples of a tracked point; `first` is the start of the earliest file, s."""
        values = self._read_values()
        table = FootTable(self.path, foot, {"t": "latency"}, lines=range(1, len(values[0]) + 1))
        found = self.points[point]
        for quantity, numbers in found.items():
            if quantity != "pressure" and not {*"xyz"} <= numbers.keys():
                raise RecordingError(self.path, f"{quantity} of {printable(point)} has no x, y and z")
        for quantity, numbers in found.items():
            listed = [numbers[one] for one in (numbers if quantity == "pressure" else "xyz")]
            units = dict.fromkeys([self.channels[number].get("units", "") for number in listed])
            known = [*CELL_UNITS] if quantity == "pressure" else [*UNITS[quantity]]
            spellings = {unit_of(one, quantity) or one.strip() for one in units}
            if not spellings <= {*known} or (len(spellings) > 1 and quantity != "pressure"):
                what = f"{quantity} is in {printable(', '.join(units))}, not in one of {', '.join(known)}"
                raise RecordingError(self.path, what)
            unit = known[0] if quantity == "pressure" else spellings.pop()
            table.set_quantity(quantity, [values[number] for number in listed], unit)
            table.names[quantity] = f"{quantity}_{foot.value}"
        delay = 0.0 if first is None or self.start is None else self.start - first
        table.t = floats([t + delay for t in self._times(values)])
        inertial = [zip(*table.columns[q], strict=True) for q in ("acc", "gyro") if q in found]
        table.select(
            [any(not any(map(isnan, vector)) for vector in vectors) for vectors in zip(*inertial, strict=True)]
        )
        return table

    def _read_values(self) -> list[array[float]]:
        """Return the values of each channel."""
        values: list[array[float]] = []
        try:
            with self.path.open(encoding="utf-8-sig") as file:
                for number, line in enumerate(filter(str.strip, file)):
                    cells = line.rstrip("\n").split("\t")
                    values = values or [floats() for _ in cells]
                    if len(cells) != len(values):
                        what = f"the number of columns changed from {len(values)} to {len(cells)} at row {number}"
                        raise ValueError(what)
                    for k, cell in enumerate(cells):
                        values[k].append(_number(cell, number, k))
        except ValueError as error:
            raise RecordingError(self.path, f"is no table of numbers: {printable(str(error))}") from None
        except OSError as error:
            raise RecordingError(self.path, os_error_text(error)) from error
        if not values:
            raise RecordingError(self.path, "holds no samples")
        if len(values) != len(self.channels):
            what = f"has {len(values)} columns, and channels.tsv describes {len(self.channels)}"
            raise RecordingError(self.path, what)
        return values

    def _times(self, values: Sequence[array[float]]) -> Iterable[float]:
        for number, channel in enumerate(self.channels):
            if channel["type"] == "LATENCY":
                return values[number]
        for key in ("SamplingFrequencyEffective", "SamplingFrequency"):
            rate = self.metadata.get(key)
            if isinstance(rate, int | float) and rate > 0:
                return [row / float(rate) for row in range(len(values[0]))]
        raise RecordingError(self.path, "has no LATENCY channel, and its metadata have no SamplingFrequency")


def _number(cell: str, row: int, column: int) -> float:
    try:
        return nan if cell == TSV_MISSING else float(cell)
    except ValueError:
        raise ValueError(f"could not convert string {cell!r} to float64 at row {row}, column {column + 1}.") from None


def _inherited(path: Path) -> dict[str, Any]:
    """Return the metadata of a file, with those of the folders above it up to the dataset's own."""
    entities = {*path.name.removesuffix(MOTION_END).split("_")}
    merged: dict[str, Any] = {}
    for folder in path.parents:
        for one in sorted(folder.glob("*motion.json"), key=lambda file: -len(file.name)):
            if {*one.name.removesuffix("motion.json").strip("_").split("_")} - {""} <= entities:
                merged = read_json(one) | merged
        if (folder / "dataset_description.json").is_file():
            break
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
