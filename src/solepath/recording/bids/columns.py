"""The channels of one sensor over a recording, and the three files in which Motion-BIDS has them."""

from __future__ import annotations

import json
import tomllib
from array import array
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from importlib.resources import files
from math import isfinite, nan
from pathlib import Path
from typing import Any

from attrs import define, field

from ...saving.provenance import installed_version
from ...types import Site
from ..errors import RecordingError, os_error_text, printable
from ..posed import PosedSample
from .names import TSV_MISSING

CHANNEL_COLUMNS = ("name", "component", "type", "tracked_point", "units", "reference_frame", "description")
"""Columns of channels.tsv."""
CHANNEL_TYPES = ("ACCEL", "ANGACCEL", "GYRO", "JNTANG", "LATENCY", "MAGN", "MISC", "ORNT", "POS", "VEL")
"""All types of channels of Motion-BIDS."""
CHANNELS: dict[str, dict[str, Any]] = tomllib.loads(
    files("solepath.recording.bids").joinpath("motion.toml").read_text()
)
"""Quantities in the order of their channels, with their components and cells of channels.tsv."""


@define
class MotionColumns:
    """The values of one sensor, one row for each sample; a channel starts with the first sample that has its quantity.

    Memory is 8 bytes for each value: about 1 GB for an hour of 96 cells at 100 Hz."""

    site: Site
    pressure_units: str = "N"
    """Unit of the pressure cells; "n/a" for counts."""
    t: array[float] = field(factory=lambda: array("d"), init=False)
    """Times of the rows, s, on the recording's clock."""
    _columns: dict[str, list[array[float]]] = field(factory=dict, init=False)
    """One column for each component, by quantity."""

    def add(self, posed: PosedSample) -> None:
        """Add a sample as a row."""
        sample, state, row = posed.sample, posed.state, len(self.t)
        values: dict[str, Sequence[float] | None] = {
            "device": sample.quat,
            "air_pressure": None if sample.air_pressure is None else (sample.air_pressure,),
            "saturated": (1.0,) if sample.saturated else (0.0,) if "saturated" in self._columns else None,
        }
        values |= {name: getattr(sample, name) for name in ("acc", "gyro", "mag", "pressure")}
        values |= {name: getattr(state, name, None) for name in ("position", "velocity", "attitude")}
        for name, value in values.items():
            if value is not None and name not in self._columns:
                before = [0.0 if name == "saturated" else nan] * row
                self._columns[name] = [array("d", before) for _ in value]
            columns = self._columns.get(name, ())
            for column, number in zip(columns, [*(value or ()), *[nan] * len(columns)], strict=False):
                column.append(number)
        self.t.append(sample.t)

    @property
    def tracksys(self) -> str:
        """Label of the tracking system: the sensor's site."""
        return self.site.value.replace("_", "")

    @property
    def interval(self) -> float:
        """Usual time between two samples, s; nan with fewer than two."""
        intervals = sorted([b - a for a, b in zip(self.t, self.t[1:], strict=False)])
        return intervals[len(intervals) // 2] if intervals else nan

    def channels(self) -> list[dict[str, str]]:
        """Return the rows of channels.tsv: one for each column of motion.tsv, in their order."""
        rows = []
        for quantity, kind in CHANNELS.items():
            for number, _ in enumerate([self.t] if quantity == "latency" else self._columns.get(quantity, ())):
                component = str(kind["components"][number]) if kind["components"] else TSV_MISSING
                end = (
                    "" if kind["components"] == [TSV_MISSING] else f"_{number if not kind['components'] else component}"
                )
                row = kind | {"name": quantity + end, "component": component, "tracked_point": self.site.value}
                rows.append(row | {"units": self.pressure_units} if quantity == "pressure" else row)
        return rows

    def metadata(self, task: str, start: float) -> dict[str, Any]:
        """Return the content of motion.json; `start` is the time of the recording's start, s."""
        channels = self.channels()
        duration = self.t[-1] - self.t[0]
        rate = round(1.0 / self.interval, 3) if self.interval > 0.0 else TSV_MISSING
        effective = (len(self.t) - 1) / duration if duration > 0.0 else TSV_MISSING
        counts = Counter(channel["type"] for channel in channels)
        return {
            "TaskName": task,
            "TrackingSystemName": f"sensor on the {self.site.words}",
            "SamplingFrequency": rate,
            "SamplingFrequencyEffective": effective,
            "RecordingDuration": duration,
            "StartTime": self.t[0] - start,
            "MissingValues": TSV_MISSING,
            "MotionChannelCount": len(channels),
            "TrackedPointsCount": 1,
            "SoftwareVersions": f"solepath {installed_version()}",
        } | {f"{kind}ChannelCount": counts[kind] for kind in CHANNEL_TYPES}

    def write_motion(self, path: Path, start: float) -> None:
        """Write motion.tsv, which has no header; latencies count from `start`, s."""
        columns = [column for quantity in CHANNELS for column in self._columns.get(quantity, ())]
        with path.open("w", encoding="ascii", newline="\n") as file:
            for row, t in enumerate(self.t):
                texts = [repr(value) if isfinite(value := column[row]) else TSV_MISSING for column in columns]
                file.write("\t".join([f"{t - start:.9f}", *texts]) + "\n")


def to_json(value: Any) -> str:
    """Return a value as the text of a metadata file."""
    return json.dumps(value, indent=2, allow_nan=False) + "\n"


def _read_text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig", errors="replace")
    except OSError as error:
        raise RecordingError(path, os_error_text(error)) from error


def read_json(path: Path) -> dict[str, Any]:
    """Return the content of a metadata file; RecordingError when it is not a JSON object."""
    try:
        content = json.loads(_read_text(path))
    except (ValueError, RecursionError) as error:
        raise RecordingError(path, f"is not JSON: {printable(str(error))}") from None
    if not isinstance(content, dict):
        raise RecordingError(path, "is not a JSON object")
    return content


def to_tsv(columns: Iterable[str], rows: Iterable[Mapping[str, str]]) -> str:
    """Return the text of a table with a header."""
    lines = [[*columns], *([row.get(column, TSV_MISSING) for column in columns] for row in rows)]
    return "".join(["\t".join(line) + "\n" for line in lines])


def read_table(path: Path) -> list[dict[str, str]]:
    """Return the rows of a table with a header, as texts by column; none for a file that does not exist."""
    lines = [line.split("\t") for line in _read_text(path).splitlines() if line.strip()] if path.exists() else []
    return [dict(zip(lines[0], line, strict=False)) for line in lines[1:]]
