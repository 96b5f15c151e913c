"""Reads the inertial samples of a recording in a Motion-BIDS dataset, from whatever program.

The path is that of any `_motion.tsv` of the recording: its other tracking systems are read with it. channels.tsv says
what the columns are: ACCEL in m/s^2 or g, GYRO in rad/s or deg/s, LATENCY in s; pressure cells as solepath writes them.
The tracked point says which foot it is: left_foot, LeftFoot, l_ankle, R-shoe and the like. Metadata are inherited from
the folders above (BIDS, "The Inheritance Principle")."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import datetime
from itertools import pairwise
from math import isnan
from pathlib import Path
from typing import Any

from ...types import Foot
from ..bad_rows import BadRows
from ..errors import RecordingError, Report, printable, warn
from ..mapping.mapping import TableMapping
from ..mapping.words import foot_of_text
from ..samples.columns import TableColumns
from ..samples.plausible import list_unit_problems
from ..samples.reader import SampleRecording, clean, read_file
from ..samples.table import FootTable, floats
from .columns import read_json, read_table
from .names import MOTION_END, recording_of

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
    systems = [(one, _read_channels(one)) for one in beside if recording_of(one) == recording_of(path)]
    points = [
        (system, point, foot_of_text(point) if ON_FOOT.search(point) else None)
        for system, channels in systems
        for point in dict.fromkeys(one.get("tracked_point", "") for one in channels if one["type"] in _QUANTITY_OF_TYPE)
    ]
    if len(points) == 1:
        points = [(system, point, side or foot or Foot.RIGHT) for system, point, side in points]
    named = sorted([(side.value, system, point) for system, point, side in points if side is not None])
    if not named:
        found = printable(", ".join(sorted({point for _, point, _ in points})) or "none")
        raise RecordingError(path, f"no tracked point with ACCEL or GYRO is a foot; there are: {found}")
    for (one, _, first), (other, _, second) in pairwise(named):
        if one == other:
            where = printable(f"{first}, {second}")
            raise RecordingError(path, f"several tracked points are on the {one} foot: {where}")
    # without the start of every file, all are taken to start together
    starts = {system: _start_of(system) for system, _ in systems}
    known = [start for start in starts.values() if start is not None]
    bad_rows, tables = BadRows(path, report, "row"), []
    for side, system, point in named:
        table = _read_point(system, dict(systems)[system], point, Foot(side), bad_rows)
        start = starts[system] if len(known) == len(starts) else None
        if start is not None:
            table.t = floats([t + (start - min(known)) for t in table.t])
        tables.append(table)
    used = clean(tables, foot, bad_rows)
    if not used:
        raise RecordingError(path, f"holds nothing of the {foot.value} foot" if foot else "holds no samples")
    problems = [problem for table in used for problem in list_unit_problems(table)]
    if problems:
        raise RecordingError.of(problems)
    return SampleRecording(path, tuple(used), bad_rows)


def _read_channels(path: Path) -> list[dict[str, str]]:
    """Return the rows of channels.tsv, which describe the columns of a `_motion.tsv` in their order."""
    beside = path.with_name(path.name.removesuffix(MOTION_END) + "_channels.tsv")
    channels = read_table(beside)
    if not channels or not all("type" in channel for channel in channels):
        raise RecordingError(beside, "describes no channels, each with a type")
    return channels


def _map_columns(path: Path, channels: Sequence[dict[str, str]], point: str, foot: Foot) -> TableMapping:
    """Return the mapping of the columns of a tracked point, which is on `foot`."""
    found: dict[str, dict[str, int]] = {}
    for number, channel in enumerate(channels):
        quantity, component = _QUANTITY_OF_TYPE.get(channel["type"], ""), channel.get("component", "").lower()
        if channel["type"] == "MISC" and re.fullmatch(r"pressure_[0-9]+", channel.get("name", "")):
            quantity, component = "pressure", channel["name"]
        if quantity and channel.get("tracked_point", "") == point:
            found.setdefault(quantity, {})[component] = number
    columns: dict[str, list[str]] = {}
    units = {}
    for quantity, numbers in found.items():
        if quantity != "pressure":
            if not {*"xyz"} <= numbers.keys():
                raise RecordingError(path, f"{quantity} of {printable(point)} has no x, y and z")
            numbers = {axis: numbers[axis] for axis in "xyz"}
            units[quantity] = ", ".join(dict.fromkeys(channels[number].get("units", "") for number in numbers.values()))
        columns[f"{quantity}_{foot.value}"] = [str(number + 1) for number in numbers.values()]
    latencies = [str(number + 1) for number, channel in enumerate(channels) if channel["type"] == "LATENCY"]
    if latencies:
        columns["t"] = latencies[:1]
    metadata = {} if latencies else _inherited(path)
    rates = [metadata.get(key) for key in ("SamplingFrequencyEffective", "SamplingFrequency")]
    rate = next((float(one) for one in rates if isinstance(one, int | float) and one > 0), None)
    if not latencies and rate is None:
        raise RecordingError(path, "has no LATENCY channel, and its metadata have no SamplingFrequency")
    try:
        return TableMapping(columns, units, rate=rate, separator="tab", header=0)
    except ValueError as error:
        raise RecordingError(path, printable(str(error))) from None


def _read_point(path: Path, channels: Sequence[dict[str, str]], point: str, foot: Foot, bad_rows: BadRows) -> FootTable:
    """Return the samples of a tracked point, which is on `foot`; a row without any inertial one is no sample."""
    headers: list[TableColumns] = []
    tables = read_file(path, foot, _map_columns(path, channels, point, foot), bad_rows, headers)
    count = len(headers[0].header.names)
    if count != len(channels):
        raise RecordingError(path, f"has {count} columns, and channels.tsv describes {len(channels)}")
    if problems := headers[0].list_problems():
        raise RecordingError.of(problems)
    (table,) = tables
    table.names["t"] = "latency"
    inertial = [zip(*columns, strict=True) for quantity, columns in table.columns.items() if quantity != "pressure"]
    table.select([any(not any(map(isnan, vector)) for vector in row) for row in zip(*inertial, strict=True)])
    if not len(table):
        bad_rows.finish()
    return table


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
