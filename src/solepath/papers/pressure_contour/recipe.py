"""The recipes of Bebek et al. 2010."""

from __future__ import annotations

from ...recipes import Recipe
from .bias_zupt import BiasZupt
from .contour_stance import ContourVelocity, GyroscopeMagnitude

PRESSURE_CONTOUR = Recipe("pressure-contour", ContourVelocity(), BiasZupt(), needs_pressure=True)
"""Bebek et al. 2010: zero velocity while the contours of heel pressure stand still, accelerometer bias, square laps."""

GYROSCOPE = Recipe("gyroscope", GyroscopeMagnitude(), BiasZupt())
"""Bebek et al.'s baseline: `PRESSURE_CONTOUR`, but with zero velocity while the gyroscope shows a low rate."""
