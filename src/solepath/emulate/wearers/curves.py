"""Polynomials over a unit interval, as coefficient arrays (constant first), and functions that join them smoothly."""

from __future__ import annotations

from math import comb

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Rng = np.random.Generator
End = tuple[float, float, float]
"""Value, velocity and acceleration at one end of a curve."""

DEGREE = 7
"""Degree of every curve here: a quintic joins the two ends, and two more degrees shape what lies between."""

BUMP: Array = np.array([0.0, 0.0, 0.0, 64.0, -192.0, 192.0, -64.0, 0.0])
"""Curve 64 s^3 (1 - s)^3: 1 in the middle; value, slope and curvature are 0 at both ends."""

EVEN_OUT: Array = np.array([0.0, 0.0, 0.0, 1.0, -5.0, 9.0, -7.0, 2.0])
"""Curve s^3 (1 - s)^3 (1 - 2 s); added to a curve, it makes it start earlier, move slower in the middle, stop later.

Value, slope and curvature are 0 at both ends."""


def constant(value: float) -> Array:
    """Return a constant curve."""
    curve = np.zeros(DEGREE + 1)
    curve[0] = value
    return curve


def join(start: End, end: End, duration: float) -> Array:
    """Return the quintic in s = t / duration with the given value, velocity and acceleration (per s) at both ends."""
    p0, v0, a0 = start[0], start[1] * duration, start[2] * duration**2
    p1, v1, a1 = end[0], end[1] * duration, end[2] * duration**2
    rest, slope, curve = p1 - p0 - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0
    return np.array(
        [
            p0,
            v0,
            0.5 * a0,
            10.0 * rest - 4.0 * slope + 0.5 * curve,
            -15.0 * rest + 7.0 * slope - curve,
            6.0 * rest - 3.0 * slope + 0.5 * curve,
            0.0,
            0.0,
        ]
    )


def part(curve: Array, start: float, end: float) -> Array:
    """Return the part of a curve between s = start and s = end, over a unit interval of its own.

    It expands (start + (end - start) s)^k by the binomial theorem."""
    moved = _BINOMIALS * np.where(_LOWER >= 0, float(start) ** np.maximum(_LOWER, 0), 0.0)
    return np.asarray((moved @ curve) * (end - start) ** np.arange(DEGREE + 1))


def evaluate(curve: Array, s: Array | float, order: int = 0) -> Array:
    """Return the value of one curve, or of its derivative of `order` by s, at s."""
    factors = curve
    for _ in range(order):
        factors = factors[1:] * np.arange(1, len(factors))
    total = np.full(np.shape(s), factors[-1])
    for factor in factors[-2::-1]:
        total = total * s + factor
    return np.asarray(total)


_LOWER = np.arange(DEGREE + 1) - np.arange(DEGREE + 1)[:, None]
_BINOMIALS: Array = np.array([[comb(k, j) for k in range(DEGREE + 1)] for j in range(DEGREE + 1)], dtype=np.float64)
