"""Exports of x-io Technologies' NGIMU: a folder for each device in the folder of a session, with sensors.csv in it.

Header: "Time (s),Gyroscope X (deg/s),...,Accelerometer X (g),...,Magnetometer X (uT),...,Barometer (hPa)". Source: the
session of xioTechnologies/NGIMU-MATLAB-Import-Logged-Data-Example. All devices of a session count their times from the
first one of any of them (xioTechnologies/NGIMU-Software-Public, issue 2), so the feet have one clock. The name of the
folder has that of the device, as in "NGIMU-Left - 0029AAAA". Sensors are right handed, specific force is up at rest."""

from __future__ import annotations

from ..mapping.mapping import TableMapping
from .export import Export, TableHeader

GYRO = tuple(f"Gyroscope {axis} (deg/s)" for axis in "XYZ")
ACC = tuple(f"Accelerometer {axis} (g)" for axis in "XYZ")


def _is_own(header: TableHeader) -> bool:
    return header.find("Time (s)", *GYRO, *ACC)


def _mapping(header: TableHeader) -> TableMapping:
    return TableMapping({"t": "Time (s)", "acc": ACC, "gyro": GYRO}, {"t": "s", "acc": "g", "gyro": "deg/s"})


NGIMU = Export("ngimu", "x-io NGIMU", _mapping, _is_own)
"""The format of the NGIMU."""
