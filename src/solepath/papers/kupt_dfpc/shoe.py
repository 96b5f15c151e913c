"""The wearer's own shoe, from static postures measured with rulers (Chen et al. 2019, section III.C.3).

The wearer stands in postures between flat and toe-off, the paper's in five of them, three times each. For each the
file has the heel-up pitch that the sensor showed and two lengths, in a line of comma-separated values with a header:

    pitch_deg,L_r_m,L_p2t_m
    0,0.070,0.090
    15,0.077,0.083

`L_r_m`: along the shoe's bottom, from the point below the sensor to where the ruler meets the ground, m. (Where a round
sole touches the ground is a little further ahead; with that point (6) would have the velocity at toe-off too low by
some decimetres per second.) `L_p2t_m`: on the ground, from there to where the tip of the flat shoe was, m. Columns may
come in any order, others are ignored; `H_imu_m` and `heel_L_r_m`, where there are such columns, are the same in every
line and go into the geometry.
"""

from __future__ import annotations

import csv
from math import isfinite, radians
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...calibration import Calibration, CalibrationError, ShoeGeometry
from ...calibration.file import bounded_text
from ...types.attrs import frozen

COLUMNS = ("pitch_deg", "L_r_m", "L_p2t_m")
SINGLE = ("H_imu_m", "heel_L_r_m")
DEGREE = 2
"""Of the polynomials; 1 with three postures. For the round sole of kinematics.py, five postures to 60 degrees, three
times each, rulers off by 2 mm: the sensor's way per pitch, which is what velocity needs, errs at 50 degrees by 5 mm/rad
with a straight line, by 4 with degree 2, by 6 with 3 and with 4."""
STEEPEST = 80.0
"""Nobody stands steeper than this, degrees."""
LONGEST = 0.5
"""No shoe is longer than this, m."""
SAME = 2.0
"""Pitches this near to each other are one posture, degrees."""

Column = NDArray[np.float64]


@frozen
class Fitted:
    """`residual_radius`, `residual_to_toe`: root mean square of what the curves leave, m. `worst`: the largest, m."""

    calibration: Calibration
    postures: int
    measurements: int
    residual_radius: float
    residual_to_toe: float
    worst: float


def fit_shoe(path: Path | str) -> Fitted:
    """The geometry of the shoe whose postures are in the file. CalibrationError with one sentence that names the file,
    and the line where there is one, when it cannot be used."""
    rows, single = _read(Path(path))
    pitch = np.radians(rows[:, 0])
    postures = _count(rows[:, 0])
    if postures < 3:
        raise CalibrationError(f"{path}: {postures} postures; three different ones at least make a curve")
    if (steepest := float(pitch.max())) < radians(30.0):
        raise CalibrationError(f"{path}: the steepest posture is {rows[:, 0].max():g} degrees; a toe-off is 50 or more")
    degree = min(DEGREE, postures - 2)
    radius, left_radius = _fit(pitch, rows[:, 1], degree)
    to_toe, left_to_toe = _fit(pitch, rows[:, 2], degree)
    shoe = ShoeGeometry(
        heel_radius=single.get("heel_L_r_m", ShoeGeometry().heel_radius),
        height=single.get("H_imu_m", ShoeGeometry().height),
        forefoot_radius=radius,
        pivot_to_toe=to_toe,
        steepest=steepest,
    )
    return Fitted(
        calibration=Calibration(shoe=shoe),
        postures=postures,
        measurements=len(rows),
        residual_radius=float(np.sqrt(np.mean(left_radius**2))),
        residual_to_toe=float(np.sqrt(np.mean(left_to_toe**2))),
        worst=float(max(np.abs(left_radius).max(), np.abs(left_to_toe).max())),
    )


def _fit(pitch: Column, length: Column, degree: int) -> tuple[tuple[float, ...], Column]:
    """Coefficients, constant first, and what they leave of each measurement."""
    coefficients = np.polynomial.polynomial.polyfit(pitch, length, degree)
    left = length - np.polynomial.polynomial.polyval(pitch, coefficients)
    return tuple(coefficients.tolist()), np.asarray(left, dtype=np.float64)


def _count(degrees: Column) -> int:
    """How many postures, when those near to each other are one."""
    ordered = np.sort(degrees)
    return 1 + int(np.count_nonzero(np.diff(ordered) > SAME))


def _read(path: Path) -> tuple[Column, dict[str, float]]:
    try:
        lines = bounded_text(path, "utf-8-sig").splitlines()
    except OSError as error:
        raise CalibrationError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise CalibrationError(f"{path}: is not text") from None
    if not lines:
        raise CalibrationError(f"{path}: is empty")
    header = _cells(lines[0])
    for name in COLUMNS:
        if header.count(name) != 1:
            raise CalibrationError(f"{path}: line 1: wants one column {name} (of {', '.join(COLUMNS)})")
    rows: list[list[float]] = []
    single: dict[str, float] = {}
    for number, line in enumerate(lines[1:], start=2):
        if not line.strip():
            continue
        where = f"{path}: line {number}"
        cells = _cells(line)
        if len(cells) != len(header):
            raise CalibrationError(f"{where}: {len(cells)} values for {len(header)} columns")
        named = dict(zip(header, cells, strict=True))
        rows.append([_number(named[name], name, where) for name in COLUMNS])
        for name in SINGLE:
            if name in named:
                value = _number(named[name], name, where)
                if single.setdefault(name, value) != value:
                    raise CalibrationError(f"{where}: {name} is {value:g} here and {single[name]:g} before")
    if not rows:
        raise CalibrationError(f"{path}: holds no postures")
    return np.array(rows, dtype=np.float64), single


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in next(csv.reader([line]), [])]


def _number(text: str, name: str, where: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise CalibrationError(f"{where}: {name} is {text!r}, not a number") from None
    low, high = (-5.0, STEEPEST) if name == "pitch_deg" else (0.0, LONGEST)
    if not isfinite(value) or not low <= value <= high:
        unit = "degrees" if name == "pitch_deg" else "m"
        raise CalibrationError(f"{where}: {name} is {text}, which is not between {low:g} and {high:g} {unit}")
    return value
