"""Polynomials over the unit interval 0 <= s <= 1, as arrays of coefficients with the constant first."""

from __future__ import annotations

from math import comb

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Rng = np.random.Generator
EndState = tuple[float, float, float]
"""Value of a curve at one of its ends, and its first and second derivative by time there (per s, per s^2)."""

DEGREE = 7
"""Degree of every curve here: a quintic joins the two ends, and LEVELLING has two degrees more."""

BUMP: Array = np.array([0.0, 0.0, 0.0, 64.0, -192.0, 192.0, -64.0, 0.0])
"""Curve 64 s^3 (1 - s)^3, which is 1 in the middle; value, slope and curvature are 0 at both ends."""

LEVELLING: Array = np.array([0.0, 0.0, 0.0, 1.0, -5.0, 9.0, -7.0, 2.0])
"""Curve s^3 (1 - s)^3 (1 - 2 s); a motion to which it is added starts earlier, is slower in the middle and stops later.

Value, slope and curvature are 0 at both ends."""


def constant(value: float) -> Array:
    """Return a constant curve."""
    curve = np.zeros(DEGREE + 1)
    curve[0] = value
    return curve


def join(start: EndState, end: EndState, duration: float) -> Array:
    """Return the quintic in s = t / duration with these values and derivatives at its ends; `duration` is in s."""
    p0, v0, a0 = start[0], start[1] * duration, start[2] * duration**2
    p1, v1, a1 = end[0], end[1] * duration, end[2] * duration**2
    remainder, slope, curve = p1 - p0 - v0 - 0.5 * a0, v1 - v0 - a0, a1 - a0
    return np.array(
        [
            p0,
            v0,
            0.5 * a0,
            10.0 * remainder - 4.0 * slope + 0.5 * curve,
            -15.0 * remainder + 7.0 * slope - curve,
            6.0 * remainder - 3.0 * slope + 0.5 * curve,
            0.0,
            0.0,
        ]
    )


def subcurve(curve: Array, start: float, end: float) -> Array:
    """Return the curve that runs over the unit interval as `curve` runs from s = start to s = end.

    The powers (start + (end - start) s)^k are expanded by the binomial theorem."""
    moved = _BINOMIALS * (float(start) ** _POWERS)[_EXPONENTS]
    return np.asarray((moved @ curve) * (end - start) ** _POWERS)


def evaluate(curve: Array, s: Array | float, order: int = 0) -> Array:
    """Return the values of a curve at `s`, or of its derivative of this `order` by s."""
    factors = curve
    for _ in range(order):
        factors = factors[1:] * np.arange(1, len(factors))
    total = np.full(np.shape(s), factors[-1])
    for factor in factors[-2::-1]:
        total *= s
        total += factor
    return total


_POWERS = np.arange(DEGREE + 1)
_EXPONENTS = np.maximum(_POWERS - _POWERS[:, None], 0)
_BINOMIALS: Array = np.array([[comb(k, j) for k in range(DEGREE + 1)] for j in range(DEGREE + 1)], dtype=np.float64)


def hand_over(s: Array) -> Array:
    """Return a curve from 0 at s = 0 to 1 at s = 1 with a slope at both ends, as force plates show it."""
    s = np.clip(s, 0.0, 1.0)
    return np.asarray(0.5 * s + s * s * (1.5 - s))
