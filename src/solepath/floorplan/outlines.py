"""Closed outlines: rings of points that do not repeat their first point at the end."""

from __future__ import annotations

from math import fsum, hypot

from .plan import Point
from .segments import distance

Ring = tuple[Point, ...]
Edges = tuple[tuple[float, float, float, float], ...]

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


def edges(outline: Ring) -> Edges:
    """Return the straight lines (ax, ay, bx, by) of an outline."""
    return tuple((*a, *b) for a, b in zip(outline, (*outline[1:], *outline[:1]), strict=True))


def contains(lines: Edges, x: float, y: float) -> bool:
    """Return whether (x, y), m, is within these edges, by the even-odd rule with a ray to +x."""
    odd = False
    for ax, ay, bx, by in lines:
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            odd = not odd
    return odd


def area(outline: Ring) -> float:
    """Return the area of the ring, m^2; positive if it runs counter-clockwise."""
    ox, oy = outline[0]
    return 0.5 * fsum((ax - ox) * (by - oy) - (bx - ox) * (ay - oy) for ax, ay, bx, by in edges(outline))


def find_inner_point(outline: Ring) -> Point:
    """Return a place within the outline, m.

    It is the centroid if that is inside, else the middle of the widest inner interval along x at the centroid's y."""
    lines, (ox, oy) = edges(outline), outline[0]
    x, y = fsum(p[0] for p in outline) / len(outline), fsum(p[1] for p in outline) / len(outline)
    size = area(outline)
    if abs(size) > 1e-9:
        sx = sy = 0.0
        for ax, ay, bx, by in lines:
            weight = (ax - ox) * (by - oy) - (bx - ox) * (ay - oy)
            sx, sy = sx + (ax + bx - 2.0 * ox) * weight, sy + (ay + by - 2.0 * oy) * weight
        x, y = ox + sx / (6.0 * size), oy + sy / (6.0 * size)
    if contains(lines, x, y):
        return x, y
    crossings = sorted(ax + (y - ay) * (bx - ax) / (by - ay) for ax, ay, bx, by in lines if (ay > y) != (by > y))
    intervals = list(zip(crossings[::2], crossings[1::2], strict=False))
    if not intervals:
        return x, y
    low, high = max(intervals, key=lambda interval: interval[1] - interval[0])
    return 0.5 * (low + high), y


def normalize_ring(outline: Ring) -> Ring:
    """Return the outline counter-clockwise, from its leftmost, lowest corner on, without corners on straight lines."""
    ordered = outline if area(outline) >= 0.0 else outline[::-1]
    corners = [
        b
        for a, b, c in zip((ordered[-1], *ordered), ordered, (*ordered[1:], ordered[0]), strict=False)
        if not _is_straight(a, b, c)
    ]
    ordered = tuple(corners) if len(corners) >= 3 else ordered
    first = ordered.index(min(ordered))
    return ordered[first:] + ordered[:first]


def _is_straight(a: Point, b: Point, c: Point) -> bool:
    """Return whether b lies between a and c within 1 mm of their line, so that it is no corner."""
    is_between = (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]) < 0.0
    return is_between and distance(*a, *c, *b) <= 1e-3


def join_holes(rings: tuple[Ring, ...]) -> Ring:
    """Return one ring for an outline and its holes.

    A line that runs to each hole and back joins it to the outline; the even-odd rule ignores this line."""
    outline = rings[0] if rings else ()
    for hole in rings[1:]:
        k = hole.index(min(hole))
        distances = [hypot(x - hole[k][0], y - hole[k][1]) for x, y in outline]
        i = distances.index(min(distances))
        outline = (*outline[: i + 1], *hole[k:], *hole[: k + 1], *outline[i:])
    return outline
