"""Covariance of the wearer's position from the covariance of the errors that both feet share (common_error.py)."""

from __future__ import annotations

from math import exp

from .common_error import HEADING, CommonError, X, Y

POSITION_GATE = 11.8
"""Largest squared distance of a report, divided by its variance: 99.7 % of right ones (chi square, 2 axes)."""
LEAST_WAY = 10.0
"""Least way from a rejected position to one that confirms it, m: to repeat it on the spot does not."""
LENGTH_ERROR = 0.007
"""Standard deviation of the relative error that all strides have in common, no unit.

Emulated strides are up to 1.6 % too long or too short on average (rms 0.7 %)."""


def position_covariance(
    error: CommonError, displacement: tuple[float, float], since: int | None = None
) -> tuple[float, float, float]:
    """Return the covariance of the position: xx, xy, yy, m^2.

    `displacement` is that from the first position, m; or from a place whose errors have the rows from `since` on, and
    then the covariance is that of the displacement. The heading error h moves the position by h b + z, with
    b = P_eh / P_hh and z independent of h. For a small h that is a turn of the arm a = -c b by h, and a large one turns
    it too, by (R(h) - 1) a. With h normal and v its variance, E (cos h - 1)^2 = 3/2 - 2 exp(-v/2) + exp(-2v)/2 and
    E sin^2 h = (1 - exp(-2v))/2."""
    p = error.covariance
    xx, xy, xh, yy, yh, v = p[X][X], p[X][Y], p[X][HEADING], p[Y][Y], p[Y][HEADING], p[HEADING][HEADING]
    if since is not None:
        k, j = since, since + 1
        xx, yy = xx - 2.0 * p[X][k] + p[k][k], yy - 2.0 * p[Y][j] + p[j][j]
        xy, xh, yh = xy - p[X][j] - p[Y][k] + p[k][j], xh - p[k][HEADING], yh - p[j][HEADING]
    if v > 1e-9:
        bx, by = xh / v, yh / v
        half, twice = exp(-0.5 * v), exp(-2.0 * v)
        across, along = 0.5 * (1.0 - twice), 1.5 - 2.0 * half + 0.5 * twice
        # b b' v leaves, across b b' + along a a' enters, with a = (by, -bx)
        across -= v
        xx += across * bx * bx + along * by * by
        xy += (across - along) * bx * by
        yy += across * by * by + along * bx * bx
    px, py = LENGTH_ERROR * displacement[0], LENGTH_ERROR * displacement[1]
    xx, xy, yy = max(0.0, xx) + px * px, xy + px * py, max(0.0, yy) + py * py
    bound = (xx * yy) ** 0.5  # |xy| exceeds it only by rounding
    return (xx, min(max(xy, -bound), bound), yy)
