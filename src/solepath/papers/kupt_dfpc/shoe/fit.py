"""Geometry of the wearer's own shoe, from static postures measured with rulers (Chen et al. 2019, section III.C.3).

The wearer stands still in postures between flat and toe-off; in the paper these are five, each taken three times. The
file has a header, and one line for each time, with the heel-up pitch by the sensor and two measured lengths:

    pitch_deg,L_r_m,L_p2t_m
    0,0.070,0.090
    15,0.077,0.083

`L_r_m` is the length along the shoe's bottom from the point below the sensor to where a ruler laid along the bottom
meets the ground, m. (A round sole touches the ground a little further ahead. With that point (6) would make the
velocity at toe-off too low by some decimetres per second.) `L_p2t_m` is the length on the ground from the ruler's point
to where the tip of the flat shoe was, m. Columns may have any order, and unknown columns are ignored. Optional columns
of the geometry are `H_imu_m`, the sensor's height, and `heel_L_r_m`, the distance along the bottom from the heel's end
to the point below the sensor. They have the same value in every line. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import degrees, radians
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....calibration import Calibration, CalibrationError, ShoeGeometry
from ....recording.text_table import read_rows
from ....saving.files import write_whole
from ....types import Floats
from ....types.attrs import frozen

COLUMNS = ("pitch_deg", "L_r_m", "L_p2t_m")
"""Names of the columns that a file must have."""
CONSTANT_COLUMNS = ("H_imu_m", "heel_L_r_m")
"""Names of the columns that a file may have, with one value in all lines."""
POLYNOMIAL_DEGREE = 2
"""Degree of the fitted polynomials; 1 with three postures.

The velocity depends on the sensor's displacement per pitch. Its error at 50 degrees, for the round sole of
kinematics.py, five postures up to 60 degrees, each taken three times, and rulers off by 2 mm: 5 mm/rad with degree 1,
4 with degree 2, 6 with degrees 3 and 4."""
LARGEST_PITCH = 80.0
"""Pitch of the steepest posture, degrees."""
LONGEST_SHOE = 0.5
"""Length of the longest shoe, m."""
SAME_POSTURE = 2.0
"""Difference of two pitches up to which they are one posture, degrees."""

Column = NDArray[np.float64]


@frozen
class ShoeFit:
    """A fitted shoe geometry and its residuals."""

    calibration: Calibration
    postures: int
    """Number of different postures."""
    measurements: int
    """Number of lines of the file."""
    residual_radius: float
    """Root mean square of the residuals of L_r, m."""
    residual_to_toe: float
    """Root mean square of the residuals of L_p2t, m."""
    worst: float
    """Largest absolute residual of both, m."""


def fit_shoe(path: Path | str) -> ShoeFit:
    """Fit the geometry of the shoe whose postures are in the file.

    Raises CalibrationError when the file cannot be used. The message names the file and, if possible, the line."""
    rows, constants = _read(path)
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
        heel_radius=constants.get("heel_L_r_m", ShoeGeometry().heel_radius),
        height=constants.get("H_imu_m", ShoeGeometry().height),
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


@frozen
class MeasuredPosture:
    """One measurement of a static posture."""

    pitch: float
    """Heel-up pitch by the sensor, rad."""
    to_ruler: float
    """Length L_r, m."""
    ruler_to_toe: float
    """Length L_p2t, m."""


def write_measurements(
    path: Path | str, measurements: Iterable[MeasuredPosture], constants: Mapping[str, float]
) -> None:
    """Write the file that `fit_shoe` reads; `constants` has those of CONSTANT_COLUMNS that are known, m.

    Raises OSError when it cannot be written; the file has its earlier content then."""
    ends = [f"{value:.4f}" for value in constants.values()]
    rows = [
        [f"{degrees(one.pitch):.2f}", f"{one.to_ruler:.4f}", f"{one.ruler_to_toe:.4f}", *ends] for one in measurements
    ]
    lines = [[*COLUMNS, *constants], *rows]
    write_whole(path, "".join([",".join(line) + "\n" for line in lines]))


def _fit(pitch: Column, length: Column, degree: int) -> tuple[Floats, Column]:
    """Return the coefficients of length (m) over pitch (rad), constant first, and each measurement's residual, m."""
    coefficients = np.polynomial.polynomial.polyfit(pitch, length, degree)
    residual = length - np.polynomial.polynomial.polyval(pitch, coefficients)
    return tuple(coefficients.tolist()), np.asarray(residual, dtype=np.float64)


def _read(path: Path | str) -> tuple[Column, dict[str, float]]:
    rows: list[list[float]] = []
    constants: dict[str, float] = {}
    for row in read_rows(path, COLUMNS):
        pitch = row.number(COLUMNS[0], -5.0, LARGEST_PITCH, "degrees")
        rows.append([pitch, *(row.number(name, 0.0, LONGEST_SHOE, "m") for name in COLUMNS[1:])])
        for name in [name for name in CONSTANT_COLUMNS if name in row.cells]:
            value = row.number(name, 0.0, LONGEST_SHOE, "m")
            if constants.setdefault(name, value) != value:
                raise CalibrationError(f"{row.where}: {name} is {value:g} here and {constants[name]:g} before")
    if not rows:
        raise CalibrationError(f"{path}: holds no postures")
    return np.array(rows, dtype=np.float64), constants
