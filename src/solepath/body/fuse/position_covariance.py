"""Covariance of the wearer's position from the covariance of the errors that both feet share (common_error.py)."""

from __future__ import annotations

from math import exp

from .common_error import HEADING, CommonError

LENGTH_ERROR = 0.007
"""Standard deviation of the relative error that all strides have in common, no unit.

Emulated strides are up to 1.6 % too long or too short on average (rms 0.7 %)."""


def position_covariance(error: CommonError, from_start: tuple[float, float]) -> tuple[float, float, float]:
    """Return the covariance of the position: xx, xy, yy, m^2.

    `from_start` is the displacement from the first position, m. The heading error h moves the position by h b + z, with
    b = P_eh / P_hh and z independent of h. For a small h that is a turn of the arm a = -c b by h, and a large one turns
    it too, by (R(h) - 1) a. With h normal and v its variance, E (cos h - 1)^2 = 3/2 - 2 exp(-v/2) + exp(-2v)/2 and
    E sin^2 h = (1 - exp(-2v))/2."""
    (xx, xy, xh, *_), (_, yy, yh, *_), (_, _, v, *_) = error.covariance[: HEADING + 1]
    if v > 1e-9:
        bx, by = xh / v, yh / v
        half, twice = exp(-0.5 * v), exp(-2.0 * v)
        across, along = 0.5 * (1.0 - twice), 1.5 - 2.0 * half + 0.5 * twice
        # b b' v leaves, across b b' + along a a' enters, with a = (by, -bx)
        across -= v
        xx += across * bx * bx + along * by * by
        xy += (across - along) * bx * by
        yy += across * by * by + along * bx * bx
    px, py = LENGTH_ERROR * from_start[0], LENGTH_ERROR * from_start[1]
    xx, xy, yy = max(0.0, xx) + px * px, xy + px * py, max(0.0, yy) + py * py
    bound = (xx * yy) ** 0.5  # |xy| exceeds it only by rounding
    return (xx, min(max(xy, -bound), bound), yy)
