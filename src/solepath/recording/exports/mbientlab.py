"""Exports of MbientLab's MetaBase: one .csv file for each sensor of each device.

Header: "epoch (ms),time (-13:00),elapsed (s),x-axis (g),y-axis (g),z-axis (g)" and the same with (deg/s); in MetaBase
for iOS it begins with "epoc (ms),timestamp (-0700)". Sources: DataHandler.java of
mbientlab/MetaWear-Android-MetaBase-App and lib/sensor-config.js of mbientlab/MetaBase-Hub. `elapsed` starts from 0 in
each file, so only `epoch` is a common clock of the files. Linear acceleration and gravity of the sensor fusion have the
header of the accelerometer; the name of the file alone says which it is."""

from __future__ import annotations

import re

from ..mapping.mapping import TableMapping
from .export import Export, TableHeader

AXES = ("x-axis", "y-axis", "z-axis")
TIMES = ("epoch (ms)", "epoc (ms)")
"""Names of the column of times, in MetaBase for Android and for iOS."""


def _names(unit: str) -> tuple[str, ...]:
    return tuple(f"{axis} ({unit})" for axis in AXES)


def _is_own(header: TableHeader) -> bool:
    has_axes = header.find(*_names("g")) or header.find(*_names("deg/s"))
    return has_axes and header.names[0] in TIMES and "elapsed (s)" in header.names


def _mapping(header: TableHeader) -> TableMapping:
    fused = re.search("linear.?acceleration|gravity", header.path.stem, re.IGNORECASE)
    if fused is not None:
        raise ValueError(f'holds "{fused[0]}" of the sensor fusion, not what the accelerometer measured')
    columns: dict[str, tuple[str, ...]] = {"t": (header.names[0],)}
    for quantity, unit in (("acc", "g"), ("gyro", "deg/s")):
        if header.find(*_names(unit)):
            columns[quantity] = _names(unit)
    return TableMapping(columns, {"t": "ms", "acc": "g", "gyro": "deg/s"})


MBIENTLAB = Export(
    "mbientlab", "MbientLab MetaBase", _mapping, _is_own, lacking="give the file of the Accelerometer instead"
)
"""The format of MetaBase."""
