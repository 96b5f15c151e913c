"""Exports of the Movella (Xsens) DOT: one .csv file for each sensor.

Lines before the header: the logger of Movella's SDK writes "sep=,", "DeviceTag:,", "FirmwareVersion:,", "AppVersion:,",
"SyncStatus:,", "OutputRate:,", "FilterProfile:,", "Measurement Mode:,", "StartTime:,". Columns: those of the mode, of
which "Rate quantities", "Custom mode 5" and recordings on the sensor have Acc and Gyr. Units: Xsens DOT User Manual
XD0502P, table 9 (acceleration m/s^2, with gravity; angular velocity degree/s). SampleTimeFine counts microseconds and
starts again after 2^32 of them, about 1.2 hours (section 4.2.5); sensors that were synchronised share it. FreeAcc is
without gravity and in the earth's frame, so no gait can be computed from it."""

from __future__ import annotations

import re

from ..mapping.mapping import TableMapping
from .export import Export, TableHeader

WRAP = 2.0**32
"""Count at which SampleTimeFine starts again, us."""
ACC, GYRO = ("Acc_X", "Acc_Y", "Acc_Z"), ("Gyr_X", "Gyr_Y", "Gyr_Z")
"""Names of the columns of specific force and angular rate."""


def _is_own(header: TableHeader) -> bool:
    # MT Manager writes the same names for MTw and MTi, with tabs, in other units
    return header.find("PacketCounter", "SampleTimeFine") and header.starts("sep=", "DeviceTag:", "Measurement Mode:")


def _mapping(header: TableHeader) -> TableMapping:
    if not header.find(*ACC, *GYRO):
        lacks = "Acc" if not header.find(*ACC) else "Gyr"
        free = "; FreeAcc is without gravity, from which no gait can be computed" if "FreeAcc_X" in header.names else ""
        raise ValueError(f"was recorded in a mode without {lacks}_X, {lacks}_Y, {lacks}_Z{free}")
    columns = {"t": "SampleTimeFine", "acc": ACC, "gyro": GYRO}
    return TableMapping(columns, {"t": "us", "acc": "m/s^2", "gyro": "deg/s"}, wrap=WRAP)


def _tag(header: TableHeader) -> str:
    return next((line.partition(":")[2].strip(", ") for line in header.preamble if line.startswith("DeviceTag:")), "")


def _flaws(header: TableHeader) -> tuple[str, ...]:
    apart = any(re.match(r"SyncStatus:\s*,?\s*Un-?synced", line, re.IGNORECASE) for line in header.preamble)
    return ("the sensor was not synchronised, so the feet have separate clocks",) if apart else ()


MOVELLA_DOT = Export(
    "movella-dot",
    "Movella DOT",
    _mapping,
    _is_own,
    _tag,
    _flaws,
    'record with "Rate quantities", "Custom mode 5", or with acceleration and angular velocity selected',
)
"""The format of the Movella DOT."""
