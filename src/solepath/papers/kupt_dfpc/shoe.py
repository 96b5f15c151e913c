"""Geometry of the wearer's own shoe, from static postures measured with rulers (Chen et al. 2019, section III.C.3).

The wearer stands in postures between flat and toe-off, the paper's in five of them, three times each. For each the file
has the heel-up pitch that the sensor showed and two lengths, in a line of comma-separated values with a header:

    pitch_deg,L_r_m,L_p2t_m
    0,0.070,0.090
    15,0.077,0.083

`L_r_m`: along the shoe's bottom, from the point below the sensor to where the ruler meets the ground, m. (Where a round
sole touches the ground is a little further ahead; with that point (6) would have the velocity at toe-off too low by
some decimetres per second.) `L_p2t_m`: on the ground, from there to where the tip of the flat shoe was, m. Columns may
come in any order, others are ignored; `H_imu_m` and `heel_L_r_m`, where there are such columns, are the same in every
line and go into the geometry."""

from __future__ import annotations

from math import radians
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...calibration import Calibration, CalibrationError, ShoeGeometry
from ...calibration.csv_table import read_rows
from ...types.attrs import frozen

COLUMNS = ("pitch_deg", "L_r_m", "L_p2t_m")
"""Names of the columns that a file must have."""
CONSTANT_COLUMNS = ("H_imu_m", "heel_L_r_m")
"""Names of the columns that a file may have, with one value in all lines."""
POLYNOMIAL_DEGREE = 2
"""Degree of the polynomials; 1 with three postures.

For the round sole of kinematics.py, five postures to 60 degrees, three times each, rulers off by 2 mm: the sensor's way
per pitch, which is what velocity needs, errs at 50 degrees by 5 mm/rad with a straight line, by 4 with degree 2, by 6
with 3 and with 4."""
LARGEST_PITCH = 80.0
"""Steepest posture, degrees."""
LONGEST_SHOE = 0.5
"""Length of the longest shoe, m."""
SAME_POSTURE = 2.0
"""Difference of two pitches up to which they are one posture, degrees."""

Column = NDArray[np.float64]


@frozen
class ShoeFit:
    """A fitted shoe geometry and its residuals.

    `residual_radius`, `residual_to_toe`: root mean square of the curves' residuals, m. `worst`: the largest residual,
    m."""

    calibration: Calibration
    postures: int
    measurements: int
    residual_radius: float
    residual_to_toe: float
    worst: float


def fit_shoe(path: Path | str) -> ShoeFit:
    """Fit the geometry of the shoe whose postures are in the file.

    CalibrationError with one sentence that names the file, and the line where there is one, when it cannot be used."""
    rows, single = _read(path)
    pitch = np.radians(rows[:, 0])
    postures = 1 + int(np.count_nonzero(np.diff(np.sort(rows[:, 0])) > SAME_POSTURE))
    if postures < 3:
        raise CalibrationError(f"{path}: {postures} postures; three different ones at least make a curve")
    if (steepest := float(pitch.max())) < radians(30.0):
        raise CalibrationError(f"{path}: the steepest posture is {rows[:, 0].max():g} degrees; a toe-off is 50 or more")
    degree = min(POLYNOMIAL_DEGREE, postures - 2)
    radius, residual_r = _fit(pitch, rows[:, 1], degree)
    to_toe, residual_t = _fit(pitch, rows[:, 2], degree)
    shoe = ShoeGeometry(
        heel_radius=single.get("heel_L_r_m", ShoeGeometry().heel_radius),
        height=single.get("H_imu_m", ShoeGeometry().height),
        forefoot_radius=radius,
        pivot_to_toe=to_toe,
        steepest=steepest,
    )
    return ShoeFit(
        calibration=Calibration(shoe=shoe),
        postures=postures,
        measurements=len(rows),
        residual_radius=float(np.sqrt(np.mean(residual_r**2))),
        residual_to_toe=float(np.sqrt(np.mean(residual_t**2))),
        worst=float(max(np.abs(residual_r).max(), np.abs(residual_t).max())),
    )


def _fit(pitch: Column, length: Column, degree: int) -> tuple[tuple[float, ...], Column]:
    """Return the coefficients, constant first, and the residual of each measurement."""
    coefficients = np.polynomial.polynomial.polyfit(pitch, length, degree)
    residual = length - np.polynomial.polynomial.polyval(pitch, coefficients)
    return tuple(coefficients.tolist()), np.asarray(residual, dtype=np.float64)


def _read(path: Path | str) -> tuple[Column, dict[str, float]]:
    rows: list[list[float]] = []
    single: dict[str, float] = {}
    for row in read_rows(path, COLUMNS):
        pitch = row.number(COLUMNS[0], -5.0, LARGEST_PITCH, "degrees")
        rows.append([pitch, *(row.number(name, 0.0, LONGEST_SHOE, "m") for name in COLUMNS[1:])])
        for name in [name for name in CONSTANT_COLUMNS if name in row.cells]:
            value = row.number(name, 0.0, LONGEST_SHOE, "m")
            if single.setdefault(name, value) != value:
                raise CalibrationError(f"{row.where}: {name} is {value:g} here and {single[name]:g} before")
    if not rows:
        raise CalibrationError(f"{path}: holds no postures")
    return np.array(rows, dtype=np.float64), single
