"""Reads the inertial samples of a recording in a Motion-BIDS dataset, from whatever program.

The path is that of any `_motion.tsv` of the recording: its other tracking systems are read with it. channels.tsv says
what the columns are: ACCEL in m/s^2 or g, GYRO in rad/s or deg/s, LATENCY in s; pressure cells as solepath writes them.
The tracked point says which foot it is: left_foot, LeftFoot, l_ankle, R-shoe and the like. Metadata are inherited from
the folders above (BIDS, "The Inheritance Principle")."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from attrs import evolve

from ...types import Foot
from ..errors import RecordingError, Report, printable, warn
from ..mapping.mapping import TableMapping
from ..mapping.units import UNITS, unit_of
from ..mapping.words import foot_of_text
from ..samples.reader import SampleFile, SampleRecording, load_files
from .columns import read_json, read_table
from .names import MOTION_END, channels_of, systems_of

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
    systems = {one: _read_channels(one) for one in systems_of(path)}
    points = [
        (system, point, foot_of_text(point) if ON_FOOT.search(point) else None)
        for system, channels in systems.items()
        for point in dict.fromkeys(one.get("tracked_point", "") for one in channels if one["type"] in _QUANTITY_OF_TYPE)
    ]
    if len(points) == 1:
        points = [(system, point, side or foot or Foot.RIGHT) for system, point, side in points]
    named = [(system, point, side) for system, point, side in points if side is not None]
    if not named:
        found = printable(", ".join(sorted({point for _, point, _ in points})) or "none")
        raise RecordingError(path, f"no tracked point with ACCEL or GYRO is a foot; there are: {found}")
    if len(named) > len({side for _, _, side in named}):
        where = printable(", ".join(f"{point} ({side.value})" for _, point, side in named))
        raise RecordingError(path, f"several tracked points are on the same foot: {where}")
    # without the start of every file, all are taken to start together
    starts = {system: _start_of(system) for system in systems}
    known = [start for start in starts.values() if start is not None]
    files = []
    for system in dict.fromkeys(system for system, _, _ in named):
        file = _describe(system, systems[system], {point: side for one, point, side in named if one == system})
        start = starts[system]
        files.append(file if start is None or len(known) < len(starts) else evolve(file, delay=start - min(known)))
    return load_files(files, foot, report)


def _read_channels(path: Path) -> list[dict[str, str]]:
    """Return the rows of channels.tsv, which describe the columns of a `_motion.tsv` in their order."""
    channels = read_table(channels_of(path))
    if not channels or not all("type" in channel for channel in channels):
        raise RecordingError(channels_of(path), "describes no channels, each with a type")
    return channels


def _name_of(channel: Mapping[str, str], sides: Mapping[str, Foot]) -> str:
    """Return the name that this project has for a column, such as acc_x_left; "" for one that is not used."""
    kind, name, foot = channel["type"], channel.get("name", ""), sides.get(channel.get("tracked_point", ""))
    if kind in _QUANTITY_OF_TYPE and foot is not None:
        return f"{_QUANTITY_OF_TYPE[kind]}_{channel.get('component', '').lower()}_{foot.value}"
    if kind == "MISC" and re.fullmatch(r"pressure_[0-9]+", name) and foot is not None:
        return f"{name}_{foot.value}"
    return "t" if kind == "LATENCY" else ""


def _describe(path: Path, channels: Sequence[dict[str, str]], sides: Mapping[str, Foot]) -> SampleFile:
    """Return a file with the names, units and rate that its channels and metadata say.

    `sides`: foot of each tracked point."""
    names = [_name_of(channel, sides) for channel in channels]
    units = [channel.get("units", "") for channel in channels]
    for name, unit in zip(names, units, strict=True):
        quantity = name.partition("_")[0]
        if quantity in ("acc", "gyro") and unit_of(unit, quantity) is None:
            raise RecordingError(
                path, f"{quantity} is in {printable(unit)}, not in one of {', '.join(UNITS[quantity])}"
            )
    rate = None
    if "t" not in names:
        metadata = _inherited(path)
        rates = [metadata.get(key) for key in ("SamplingFrequencyEffective", "SamplingFrequency")]
        rate = next((float(one) for one in rates if isinstance(one, int | float) and one > 0), None)
        if rate is None:
            raise RecordingError(path, "has no LATENCY channel, and its metadata have no SamplingFrequency")
    return SampleFile(path, None, TableMapping(rate=rate, separator="tab", header=0), names, units)


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
