"""Closed outlines: rings of points that do not repeat their first point at the end."""

from __future__ import annotations

from math import hypot

from .geometry import Ring
from .plan import Point

MAX_CLOSING_DISTANCE = 0.05
"""Largest distance between the first and last point of a closed ring, m."""


def without_repeats(points: list[Point]) -> list[Point]:
    """Return the points without those that equal the previous point."""
    return [point for i, point in enumerate(points) if i == 0 or point != points[i - 1]]


def make_ring(points: list[Point]) -> tuple[Ring, float]:
    """Return an outline from points whose last repeats the first, and the distance between these two points, m.

    If the distance is more than MAX_CLOSING_DISTANCE, the last point stays as a corner."""
    open_by = hypot(points[-1][0] - points[0][0], points[-1][1] - points[0][1]) if points else 0.0
    corners = without_repeats(points[:-1] if open_by <= MAX_CLOSING_DISTANCE and len(points) > 1 else points)
    if len(corners) > 1 and corners[0] == corners[-1]:
        corners.pop()
    return tuple(corners), open_by


def describe_open_ring(open_by: float) -> str:
    """Return the remark about a ring that ends `open_by` m from its start."""
    return f"its outline does not close, it ends {open_by:.2f} m from where it begins"
