"""The recipes of Bebek et al. 2010."""

from __future__ import annotations

from ...body.checks.motion import PossibleMotion
from ...body.checks.sensors import SensorChecks
from ...recipes import Recipe
from ...types.attrs import evolve
from .bias_zupt import BiasZupt, BiasZuptSettings
from .contour_stance import ContourVelocity, GyroscopeMagnitude, PrintedContour
from .printed_checks import PrintedMotion, SampleChecks

AS_PRINTED = BiasZuptSettings(remove_swing_drift=False)
"""Settings of the corrector that do what is printed: only the velocity is set to zero."""

PRESSURE_CONTOUR = Recipe("pressure-contour", ContourVelocity(), BiasZupt(), needs_pressure=True)
"""Bebek et al. 2010: zero velocity while the contours of heel pressure stand still, accelerometer bias, square laps."""

PRESSURE_CONTOUR_PRINTED = evolve(
    PRESSURE_CONTOUR.replace_part(SensorChecks, SampleChecks()).replace_part(PossibleMotion, PrintedMotion()),
    name="pressure-contour-printed",
    detector=PrintedContour(),
    corrector=BiasZupt(settings=AS_PRINTED),
    every_stride=True,
)
"""The same as printed: contours of 20 to 70 kPa slower than 4 mm/s (3), and no removal of the drift of a swing."""

GYROSCOPE = Recipe("gyroscope", GyroscopeMagnitude(), BiasZupt())
"""Bebek et al.'s baseline: `PRESSURE_CONTOUR`, but with zero velocity while the gyroscope shows a low rate."""
