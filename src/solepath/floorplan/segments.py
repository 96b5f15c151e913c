"""Geometry of straight lines; the sign of a cross product is exact, without rounding errors."""

from __future__ import annotations

from fractions import Fraction
from math import hypot

_ROUNDING = 3.4e-16
"""Bound of the error of the cross product, relative to the sum of the sizes of its two products.

Shewchuk 1997, Discrete and Computational Geometry 18: (3 + 16 u) u with u = 2^-53."""

_UNDERFLOW = 1e-300
"""Bound above the loss by underflow of a product."""


def side(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return 1 when c lies to the left of the line from a to b, -1 to its right, 0 on it.

    Exact for all finite floats; fractions are used only where floats cannot decide."""
    ux, uy, vx, vy = bx - ax, cy - ay, by - ay, cx - ax
    u, v = ux * uy, vx * vy
    cross = u - v
    error_bound = _ROUNDING * (abs(u) + abs(v)) + _UNDERFLOW
    if cross > error_bound:
        return 1
    if cross < -error_bound:
        return -1
    if (ux == 0.0 or uy == 0.0) and (vx == 0.0 or vy == 0.0):  # a difference is 0 only for equal numbers
        return 0
    x, y = Fraction(ax), Fraction(ay)
    exact = (Fraction(bx) - x) * (Fraction(cy) - y) - (Fraction(by) - y) * (Fraction(cx) - x)
    return (exact > 0) - (exact < 0)


def touch(ax: float, ay: float, bx: float, by: float, px: float, py: float, qx: float, qy: float) -> bool:
    """Return whether the straight lines a to b and p to q, ends included, have a point in common.

    Exact for all finite floats, also when a line is a single point."""
    if max(ax, bx) < min(px, qx) or max(px, qx) < min(ax, bx) or max(ay, by) < min(py, qy) or max(py, qy) < min(ay, by):
        return False
    # with overlapping boxes, lines that lie on one straight line touch as well
    return (
        side(ax, ay, bx, by, px, py) * side(ax, ay, bx, by, qx, qy) <= 0
        and side(px, py, qx, qy, ax, ay) * side(px, py, qx, qy, bx, by) <= 0
    )


def distance(ax: float, ay: float, bx: float, by: float, x: float, y: float) -> float:
    """Return the distance from (x, y) to the nearest point of the straight line from a to b, m."""
    dx, dy = bx - ax, by - ay
    length2 = dx * dx + dy * dy
    along = ((x - ax) * dx + (y - ay) * dy) / length2 if length2 > 0.0 else 0.0
    along = min(max(along, 0.0), 1.0)
    return hypot(x - ax - along * dx, y - ay - along * dy)
