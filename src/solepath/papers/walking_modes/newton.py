"""Conversion from counts to newtons: a cubic for each insole, fitted to forces of a gauge and counts of the insole.

After Gong et al. 2023 (Sensors 23, 5417), section 3.1 and fig. 6: a gauge presses a cell with 0 to 200 N, and "the
mathematical relationship between the pressure value and the AD value of the insole is a cubic polynomial"; forces below
5 N are not recorded, and 200 N is the most."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...calibration import CalibrationError, Newtons
from ...calibration.csv_table import read_rows
from ...types.attrs import frozen

THRESHOLD, MOST = 5.0, 200.0
"""Range of the paper's insole, N."""
LEAST_POINTS = 5
"""Fewest points of a fit: a cubic goes through any four."""


@frozen
class GaugeFit:
    """A conversion fitted to `points` points; `residual`: rms of the cubic's residuals, N; `worst`: the largest."""

    newtons: Newtons
    residual: float
    worst: float
    points: int


def fit_gauge(path: Path | str) -> GaugeFit:
    """Fit the cubic of a csv file with the columns `counts` and `newtons`, by least squares.

    CalibrationError for a file that cannot be read, too few points, or counts that do not rise with the force."""
    rows = read_rows(path, ("counts", "newtons"))
    counts = np.array([row.number("counts") for row in rows])
    forces = np.array([row.number("newtons", 0.0, MOST, "N") for row in rows])
    different = len(set(counts.tolist()))
    if different < LEAST_POINTS:
        raise CalibrationError(f"{path}: {different} different counts, and a cubic wants {LEAST_POINTS} or more")
    unit = float(np.abs(counts).max())
    # in shares of the largest count: the third power of 14 bits would cost half of the digits
    scaled = np.polynomial.polynomial.polyfit(counts / unit, forces, 3)
    steps = np.polynomial.polynomial.polyval(np.linspace(counts.min(), counts.max(), 200) / unit, scaled)
    if not (np.diff(steps[steps > THRESHOLD]) > 0.0).all() or steps[-1] <= THRESHOLD:
        raise CalibrationError(f"{path}: the fitted force does not rise with the counts")
    residuals = forces - np.polynomial.polynomial.polyval(counts / unit, scaled)
    a, b, c, d = (float(value) / unit**power for power, value in enumerate(scaled))
    newtons = Newtons((a, b, c, d), THRESHOLD, MOST)
    return GaugeFit(newtons, float(np.sqrt(np.mean(residuals**2))), float(np.abs(residuals).max()), len(rows))
