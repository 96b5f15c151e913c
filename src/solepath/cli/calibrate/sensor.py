"""`solepath calibrate sensor`: scale, axes and bias of a sensor, from rests and turns by hand."""

from __future__ import annotations

from argparse import Namespace
from math import degrees, hypot

from ...calibration import Calibration
from ...calibration.records import TriadCalibration, stale_feet
from ...show.tables.table import number, table
from ..common.parser import command
from ..common.tables import samples_named, table_options


def _sensor(options: Namespace, known: Calibration) -> tuple[Calibration, list[str]]:
    from .by_hand.sensor import fit_sensors, sensor_calibration

    foot, samples = samples_named(options)
    fits = fit_sensors(samples, foot)
    learnt = sensor_calibration(fits)
    lines, rows = [], []
    for fit in fits:
        turns = " + ".join(str(count) for count in fit.turned) or "no"
        lines.append(f"{fit.foot} foot: {fit.pauses} rests, {turns} turns in {fit.duration:.0f} s")
        lines += fit.notes
        rows += _rows(fit.foot.value, "accelerometer", fit.calibration.acc, 1.0)
        rows += _rows(fit.foot.value, "gyroscope", fit.calibration.gyro, degrees(1.0))
    header = ["foot", "sensor", "axis", "reads too much %", "+-", "off its axis degrees", "+-", "bias", "+-"]
    lines.append(table(header, rows))
    lines.append("bias: accelerometer m/s^2, gyroscope degrees/s; it changes daily; measure it at rest")
    header = ["foot", "gravity error at rest mm/s^2", "corrected", "rotation error between rests degrees", "corrected"]
    errors = [
        [one.foot.value, *[number(1e3 * value) for value in one.gravity], *map(number, map(degrees, one.closure))]
        for one in fits
    ]
    lines.append(table(header, errors))
    stale = [foot for foot in stale_feet(known, learnt) if foot in known.headings or foot in known.drift]
    if stale:
        names = " and ".join(foot.value for foot in stale)
        lines.append(f"{names}: heading or drift were learnt without this correction and are removed: learn them again")
    return learnt, lines


def _rows(foot: str, name: str, triad: TriadCalibration, factor: float) -> list[list[str]]:
    """Return a line for each axis; `factor` turns a bias into the unit that is shown."""
    rows = []
    for k, axis in enumerate("xyz"):
        row, sigma = list(triad.matrix[3 * k : 3 * k + 3]), list(triad.matrix_sigma[3 * k : 3 * k + 3])
        scale, scale_sigma = 100.0 * (1.0 / row.pop(k) - 1.0), 100.0 * sigma.pop(k)
        figures = (scale, scale_sigma, degrees(hypot(*row)), degrees(hypot(*sigma)))
        biases = [number(factor * bias, 3) for bias in (triad.bias[k], triad.bias_sigma[k])]
        rows.append([foot, name, axis, *map(number, figures), *biases])
    return rows


add_sensor = command(
    "sensor",
    "From a sensor in the hand: twelve rests of three seconds in any orientations, and five turns "
    "about each of two axes of the sensor that are held level, each from one rest to another. Every recipe then "
    "corrects the readings of this sensor. A recording that does not show all of it is no calibration, and the "
    "command says what is missing.",
    "solepath calibrate sensor turns.jsonl --foot left --out me.json",
    table_options("RECORDING"),
    learn=_sensor,
)
