"""Exports of the Gait Up Physilog: one .csv file for each sensor.

The first line is "Gait Up - Physilog data export". Three lines follow after a blank one: groups with their rates ("Time
[128 hz],Gyro [128 hz],,,Accel [128 hz],,,..."), names ("Time,Gyro X,Gyro Y,Gyro Z,Accel X,...") and units
("[s],[deg/s],..., [g],..."). Source: the files of the TRIPOD data set (HPI-CH/TRIPOD, doi:10.3390/data6090095).
Barometer and temperature are blank in most rows. Times start from 0 in each file; those of sensors that were
synchronised start together."""

from __future__ import annotations

from ..mapping.mapping import TableMapping
from .export import Export, TableHeader

GYRO, ACC = ("Gyro X", "Gyro Y", "Gyro Z"), ("Accel X", "Accel Y", "Accel Z")
"""Names of the columns of angular rate and specific force."""


def _is_own(header: TableHeader) -> bool:
    return header.starts("Gait Up - Physilog") and header.names[0] == "Time"


def _mapping(header: TableHeader) -> TableMapping:
    for names in (ACC, GYRO):
        if not header.find(*names):
            raise ValueError(f"has no columns {', '.join(names)}")
    return TableMapping({"t": "Time", "acc": ACC, "gyro": GYRO}, {"t": "s", "acc": "g", "gyro": "deg/s"})


PHYSILOG = Export(
    "physilog", "Gait Up Physilog", _mapping, _is_own, lacking="export accelerometer and gyroscope as well"
)
"""The format of the Physilog."""
