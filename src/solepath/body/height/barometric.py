"""Height by the pressure of the air."""

from __future__ import annotations

from math import log

SCALE_HEIGHT = 8578.0
"""Height over which the pressure of air at 20 degrees Celsius falls to 1/e, m: R T / (M g)."""
STANDARD_PRESSURE = 101325.0
"""Standard air pressure, Pa."""
MIN_PRESSURE, MAX_PRESSURE = 2e4, 2e5
"""Limits of a plausible air pressure, Pa."""


def height_of(pressure: float) -> float | None:
    """Return the height above standard pressure, m, at an air pressure, Pa; None when that is not plausible."""
    return SCALE_HEIGHT * log(STANDARD_PRESSURE / pressure) if MIN_PRESSURE < pressure < MAX_PRESSURE else None
