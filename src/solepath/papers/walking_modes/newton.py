"""Conversion from counts to newtons: a cubic for each insole, fitted to forces of a gauge and counts of the insole.

After Gong et al. 2023 (Sensors 23, 5417), section 3.1 and fig. 6: a gauge presses a cell with 0 to 200 N, and "the
mathematical relationship between the pressure value and the AD value of the insole is a cubic polynomial". The insole
does not record forces below 5 N or above 200 N. Here the largest force of the gauge takes the place of these 200 N,
because nothing shows whether the cubic still rises beyond it."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...calibration import CalibrationError, Newtons
from ...recording.text_table import read_rows
from ...types.attrs import frozen

LOWEST_FORCE = 5.0
"""Least force that the paper's insole records, N."""
HEAVIEST_WEARER = 5000.0
"""Largest force on a cell, N: the largest weight of a wearer that a calibration may have."""
LEAST_POINTS = 5
"""Least number of points of a fit; a cubic goes through any four."""


@frozen
class GaugeFit:
    """A fitted conversion and its residuals."""

    newtons: Newtons
    residual: float
    """Root mean square of the residuals, N."""
    worst: float
    """Largest absolute residual, N."""
    points: int
    """Number of measured points."""


def fit_gauge(path: Path | str) -> GaugeFit:
    """Fit a cubic to the points of a csv file with the columns `counts` and `newtons`, by least squares.

    Raises CalibrationError when the file cannot be read, has too few points, or the fitted force does not rise with the
    counts."""
    rows = read_rows(path, ("counts", "newtons"))
    counts = np.array([row.number("counts") for row in rows])
    forces = np.array([row.number("newtons", 0.0, HEAVIEST_WEARER, "N") for row in rows])
    distinct_counts = len(set(counts.tolist()))
    if distinct_counts < LEAST_POINTS:
        raise CalibrationError(f"{path}: {distinct_counts} different counts, and a cubic needs {LEAST_POINTS} or more")
    unit = float(np.abs(counts).max())
    # fit over counts divided by the largest one: the third power of a 14-bit count would cost half of the digits
    coefficients = np.polynomial.polynomial.polyfit(counts / unit, forces, 3)
    fitted_forces = np.polynomial.polynomial.polyval(np.linspace(counts.min(), counts.max(), 200) / unit, coefficients)
    if not (np.diff(fitted_forces[fitted_forces > LOWEST_FORCE]) > 0.0).all() or fitted_forces[-1] <= LOWEST_FORCE:
        raise CalibrationError(f"{path}: the fitted force does not rise with the counts")
    residuals = forces - np.polynomial.polynomial.polyval(counts / unit, coefficients)
    a, b, c, d = (float(value) / unit**power for power, value in enumerate(coefficients))
    newtons = Newtons((a, b, c, d), LOWEST_FORCE, float(forces.max()))
    return GaugeFit(newtons, float(np.sqrt(np.mean(residuals**2))), float(np.abs(residuals).max()), len(rows))
