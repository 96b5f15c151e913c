"""The recipes of Bebek et al. 2010."""

from __future__ import annotations

from ...recipes import Recipe
from .bias_zupt import BiasZupt, BiasZuptSettings
from .contour_stance import ContourVelocity, GyroscopeMagnitude
from .printed import PrintedContour

AS_PRINTED = BiasZuptSettings(remove_swing_drift=False, gate_drift=False)
"""Settings of the corrector that do what is printed: velocity to zero, and the whole slope of the laps subtracted."""

PRESSURE_CONTOUR = Recipe("pressure-contour", ContourVelocity(), BiasZupt(), needs_pressure=True)
"""Bebek et al. 2010: zero velocity while the contours of heel pressure stand still, accelerometer bias, square laps."""

PRESSURE_CONTOUR_PRINTED = Recipe(
    "pressure-contour-printed", PrintedContour(), BiasZupt(settings=AS_PRINTED), needs_pressure=True
)
"""The same as printed: contours of 20 to 70 kPa slower than 4 mm/s (3), and no removal of the drift of a swing."""

GYROSCOPE = Recipe("gyroscope", GyroscopeMagnitude(), BiasZupt())
"""Bebek et al.'s baseline: `PRESSURE_CONTOUR`, but with zero velocity while the gyroscope shows a low rate."""
