"""Geometry of straight lines and of rings, closed outlines that do not repeat their first point at the end."""

from __future__ import annotations

from fractions import Fraction
from math import dist, fsum, hypot

from .frame import Line, Point

Ring = tuple[Point, ...]

_ROUNDING = 3.4e-16
"""Bound of the error of a cross product, relative to the sum of the sizes of its two products.

Shewchuk 1997, Discrete and Computational Geometry 18: (3 + 16 u) u with u = 2^-53."""

UNDERFLOW = 1e-300
"""Bound above the loss by underflow of a product, m^2."""

MAX_COMPARED = 20
"""Largest number of edges at the same x with which an edge of a ring is compared: it limits the time for a comb."""

MAX_BEND = 1e-3
"""Largest distance of a corner from the line between its neighbours at which it is no corner, m."""


def side(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Return 1 when c lies to the left of the line from a to b, -1 to its right, 0 on it.

    Exact for all finite floats; fractions are used only where floats cannot decide."""
    u, v = (bx - ax) * (cy - ay), (by - ay) * (cx - ax)
    if u == v and (ax == bx or ay == cy) and (ay == by or ax == cx):  # along x or y, as most walls are
        return 0
    if abs(u - v) > _ROUNDING * (abs(u) + abs(v)) + UNDERFLOW:  # not if it is NaN, after an overflow
        return 1 if u > v else -1
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


def share_along(ax: float, ay: float, bx: float, by: float, x: float, y: float) -> float:
    """Return where on the line from a to b its nearest point to (x, y) is: 0 at a, 1 at b."""
    dx, dy = bx - ax, by - ay
    length2 = dx * dx + dy * dy
    return min(max(((x - ax) * dx + (y - ay) * dy) / length2, 0.0), 1.0) if length2 > 0.0 else 0.0


def distance(ax: float, ay: float, bx: float, by: float, x: float, y: float) -> float:
    """Return the distance from (x, y) to the nearest point of the straight line from a to b, m."""
    k = share_along(ax, ay, bx, by, x, y)
    return hypot(x - ax - k * (bx - ax), y - ay - k * (by - ay))


def direction(a: Point, b: Point) -> tuple[float, float, float]:
    """Return the length of the straight line from a to b, m, and the unit vector along it; 0 for one point."""
    length = dist(a, b)
    k = length or 1.0
    return length, (b[0] - a[0]) / k, (b[1] - a[1]) / k


def edges(ring: Ring) -> list[Line]:
    """Return the straight lines of a ring."""
    return [(*a, *b) for a, b in zip(ring, (*ring[1:], *ring[:1]), strict=True)]


def find_crossing(ring: Ring) -> tuple[Point, float] | None:
    """Return where two edges of a ring cross, m, and the area of the smaller of both loops there, m^2; None if none do.

    It is the first crossing from the left. Edges that only touch do not cross."""
    beside: list[tuple[int, Line]] = []
    for k, line in sorted(enumerate(edges(ring)), key=lambda one: min(one[1][0], one[1][2])):
        left = min(line[0], line[2])
        beside = [one for one in beside if max(one[1][0], one[1][2]) >= left][-MAX_COMPARED:]
        for i, other in beside:
            if _cross(*line, *other):
                place, (first, last) = _meet(line, other), sorted((i + 1, k + 1))
                loops = (place, *ring[first:last]), (place, *ring[last:], *ring[:first])
                return place, min([abs(area(loop)) for loop in loops])
        beside.append((k, line))
    return None


def _cross(ax: float, ay: float, bx: float, by: float, px: float, py: float, qx: float, qy: float) -> bool:
    """Return whether the straight lines a to b and p to q have one point in common that is an end of neither."""
    if max(ay, by) <= min(py, qy) or max(py, qy) <= min(ay, by):
        return False
    return (
        side(ax, ay, bx, by, px, py) * side(ax, ay, bx, by, qx, qy) < 0
        and side(px, py, qx, qy, ax, ay) * side(px, py, qx, qy, bx, by) < 0
    )


def _meet(line: Line, other: Line) -> Point:
    """Return where two straight lines that cross do so, m."""
    (ax, ay, bx, by), (px, py, qx, qy) = line, other
    dx, dy, ex, ey = bx - ax, by - ay, qx - px, qy - py
    k = ((px - ax) * ey - (py - ay) * ex) / (dx * ey - dy * ex or UNDERFLOW)
    return ax + k * dx, ay + k * dy


def contains(lines: list[Line], x: float, y: float) -> bool:
    """Return whether (x, y), m, is within these edges, by the even-odd rule with a ray to +x."""
    return len([east for east in _find_ends(lines, y) if x < east]) % 2 == 1


def _find_ends(lines: list[Line], y: float) -> list[float]:
    """Return the x of each place at which these edges meet the line along x at y, m."""
    return [ax + (y - ay) * (bx - ax) / (by - ay) for ax, ay, bx, by in lines if (ay > y) != (by > y)]


def area(ring: Ring) -> float:
    """Return the area of the ring, m^2; positive if it runs counter-clockwise."""
    return 0.5 * fsum(_weights(ring))


def _weights(ring: Ring) -> list[float]:
    """Return twice the area between each edge and the first corner, m^2."""
    ox, oy = ring[0]
    return [(ax - ox) * (by - oy) - (bx - ox) * (ay - oy) for ax, ay, bx, by in edges(ring)]


def find_inner_point(ring: Ring) -> Point:
    """Return a place within the ring, m.

    It is the centroid if that is inside, else the middle of the widest inner interval along x at the centroid's y."""
    lines, (ox, oy), size = edges(ring), ring[0], area(ring)
    if abs(size) > 1e-9:
        sx = sy = 0.0
        for (ax, ay, bx, by), weight in zip(lines, _weights(ring), strict=True):
            sx, sy = sx + (ax + bx - 2.0 * ox) * weight, sy + (ay + by - 2.0 * oy) * weight
        x, y = ox + sx / (6.0 * size), oy + sy / (6.0 * size)
    else:
        x, y = [fsum(axis) / len(ring) for axis in zip(*ring, strict=True)]
    if not contains(lines, x, y):
        ends = sorted(_find_ends(lines, y))
        west, east = min(zip(ends[::2], ends[1::2], strict=False), key=lambda one: one[0] - one[1], default=(x, x))
        x = 0.5 * (west + east)
    return x, y


def normalize_ring(ring: Ring) -> Ring:
    """Return the ring counter-clockwise, from its leftmost, lowest corner on, without corners on straight lines."""
    ordered = ring if area(ring) >= 0.0 else ring[::-1]
    corners = tuple([
        b for a, b, c in zip((ordered[-1], *ordered), ordered, (*ordered[1:], ordered[0]), strict=False)
        if (a[0] - b[0]) * (c[0] - b[0]) + (a[1] - b[1]) * (c[1] - b[1]) >= 0.0 or distance(*a, *c, *b) > MAX_BEND
    ])  # fmt: skip
    ordered = corners if len(corners) >= 3 else ordered
    first = ordered.index(min(ordered))
    return ordered[first:] + ordered[:first]


def join_holes(rings: tuple[Ring, ...]) -> Ring:
    """Return one ring for an outline and its holes; without rings an empty one.

    A line that runs to each hole and back joins it to the outline; the even-odd rule ignores this line."""
    outline = rings[0] if rings else ()
    for hole in rings[1:]:
        k = hole.index(min(hole))
        i = min(range(len(outline)), key=lambda i: dist(outline[i], hole[k]))
        outline = (*outline[: i + 1], *hole[k:], *hole[: k + 1], *outline[i:])
    return outline
