"""`solepath calibrate sensor`: scale, axes and bias of a sensor, from rests and turns by hand."""

from __future__ import annotations

import argparse
from math import degrees, hypot
from typing import Any

from ...calibration import Calibration
from ...calibration.records import TriadCalibration, stale_feet
from ...show.tables.table import number, table
from ..common.inputs import source_of
from ..common.own_devices import add_own_devices, drivers_of
from ..common.tables import add_tables, feet_of, mapping_of

AXES = "xyz"
"""Names of the axes of a sensor."""


def add_sensor(kinds: Any) -> None:
    """Add the kind to the parser."""
    command: argparse.ArgumentParser = kinds.add_parser(
        "sensor",
        help="scale, axes and bias of a sensor, from rests and turns by hand",
        description="From a sensor in the hand: twelve rests of three seconds in any orientations, and five turns "
        "about each of two axes of the sensor that are held level, each from one rest to another. Every recipe then "
        "corrects the readings of this sensor. A recording that does not show all of it is no calibration, and the "
        "command says what is missing.",
        epilog="example: solepath calibrate sensor turns.jsonl --foot left --out me.json",
    )
    command.set_defaults(learn=_sensor)
    add_tables(command, "RECORDING")
    add_own_devices(command)


def _sensor(options: argparse.Namespace, known: Calibration) -> tuple[Calibration, list[str]]:
    from ...recording.decoded import decode_recording
    from .by_hand.sensor import fit_sensors, sensor_calibration

    source = source_of(options.files, feet_of(options), mapping_of(options), own=drivers_of(options))
    fits = fit_sensors(decode_recording(source).samples, source.foot)
    learnt = sensor_calibration(fits)
    lines, rows = [], []
    for fit in fits:
        turns = " and ".join(str(count) for count in fit.turned) or "no"
        lines.append(f"{fit.foot} foot: {fit.pauses} rests and {turns} turns in {fit.duration:.0f} s")
        lines += fit.notes
        for name, triad, factor in (
            ("accelerometer", fit.calibration.acc, 1.0), ("gyroscope", fit.calibration.gyro, degrees(1.0))
        ):  # fmt: skip
            rows += _rows(fit.foot.value, name, triad, factor)
    header = ["foot", "sensor", "axis", "reads too much %", "+-", "off its axis degrees", "+-", "bias", "+-"]
    lines.append(table(header, rows))
    lines.append("bias: accelerometer m/s^2, gyroscope degrees/s; another day has another one, and rests show it")
    errors = [
        [
            fit.foot.value, number(1000.0 * fit.gravity[0]), number(1000.0 * fit.gravity[1]),
            number(degrees(fit.closure[0]), 2), number(degrees(fit.closure[1]), 2),
        ]
        for fit in fits
    ]  # fmt: skip
    lines.append(
        table(["foot", "gravity at rest mm/s^2", "with it", "ways off at their ends degrees", "with it"], errors)
    )
    stale = [foot for foot in stale_feet(known, learnt) if foot in known.headings or foot in known.drift]
    if stale:
        names = " and ".join(foot.value for foot in stale)
        lines.append(f"{names}: heading or drift were learnt without this correction and are removed: learn them again")
    return learnt, lines


def _rows(foot: str, name: str, triad: TriadCalibration, factor: float) -> list[list[str]]:
    """Return a line for each axis; `factor` turns a bias into the unit that is shown."""
    rows = []
    for k, axis in enumerate(AXES):
        row, sigma = triad.matrix[3 * k : 3 * k + 3], triad.matrix_sigma[3 * k : 3 * k + 3]
        others = [j for j in range(3) if j != k]
        off, off_sigma = (hypot(*[values[j] for j in others]) for values in (row, sigma))
        rows.append(
            [
                foot, name, axis, number(100.0 * (1.0 / row[k] - 1.0), 2), number(100.0 * sigma[k], 2),
                number(degrees(off), 2), number(degrees(off_sigma), 2),
                number(factor * triad.bias[k], 3), number(factor * triad.bias_sigma[k], 3),
            ]
        )  # fmt: skip
    return rows
