"""Closed outlines: rings of points whose last is not the first again."""

from __future__ import annotations

from math import hypot, isfinite

from .plan import Point

Ring = tuple[Point, ...]

CLOSED = 0.05
"""m; a ring that ends this near to where it began is closed."""


def without_repeats(points: list[Point]) -> list[Point]:
    """The points without those that are the same as the one before."""
    return [point for i, point in enumerate(points) if i == 0 or point != points[i - 1]]


def ring(points: list[Point]) -> tuple[Ring, float]:
    """An outline from points whose last one repeats the first, and how far from it that last one is, m. Where this is
    more than CLOSED the last point stays, as a corner."""
    open_by = hypot(points[-1][0] - points[0][0], points[-1][1] - points[0][1]) if points else 0.0
    kept = without_repeats(points[:-1] if open_by <= CLOSED and len(points) > 1 else points)
    if len(kept) > 1 and kept[0] == kept[-1]:
        kept.pop()
    return tuple(kept), open_by


def area(outline: Ring) -> float:
    """m^2; positive where the ring runs counter-clockwise."""
    ox, oy = outline[0]
    return 0.5 * sum(
        (ax - ox) * (by - oy) - (bx - ox) * (ay - oy)
        for (ax, ay), (bx, by) in zip(outline, (*outline[1:], outline[0]), strict=True)
    )


def holds(outline: Ring, place: Point) -> bool:
    """Even and odd: how many edges a ray to +x meets."""
    x, y = place
    odd = False
    for (ax, ay), (bx, by) in zip(outline, (*outline[1:], outline[0]), strict=True):
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            odd = not odd
    return odd


def middle(outline: Ring) -> Point:
    """A place within the outline: its centre of area where that is inside, and else the middle of its widest stretch
    at that height."""
    twice, (ox, oy) = 2.0 * area(outline), outline[0]
    edges = list(zip(outline, (*outline[1:], outline[0]), strict=True))
    x, y = sum(p[0] for p in outline) / len(outline), sum(p[1] for p in outline) / len(outline)
    if abs(twice) > 1e-9:
        sx = sy = 0.0
        for (ax, ay), (bx, by) in edges:
            weight = (ax - ox) * (by - oy) - (bx - ox) * (ay - oy)
            sx, sy = sx + (ax + bx - 2.0 * ox) * weight, sy + (ay + by - 2.0 * oy) * weight
        centre = ox + sx / (3.0 * twice), oy + sy / (3.0 * twice)
        if isfinite(centre[0]) and isfinite(centre[1]):
            x, y = centre
    if holds(outline, (x, y)):
        return x, y
    met = sorted(ax + (y - ay) * (bx - ax) / (by - ay) for (ax, ay), (bx, by) in edges if (ay > y) != (by > y))
    stretches = list(zip(met[::2], met[1::2], strict=False))
    if not stretches:
        return x, y
    low, high = max(stretches, key=lambda stretch: stretch[1] - stretch[0])
    return 0.5 * (low + high), y


def tidy(outline: Ring) -> Ring:
    """The same outline counter-clockwise and from its leftmost, lowest corner on, whoever drew it."""
    way = outline if area(outline) >= 0.0 else outline[::-1]
    first = way.index(min(way))
    return way[first:] + way[:first]


def with_holes(outline: Ring, holes: list[Ring]) -> Ring:
    """One ring for an outline with holes: each hole is joined to it by a cut, walked there and back, which counts for
    nothing where edges are counted even and odd."""
    for hole in holes:
        i, k = min(
            ((i, k) for i in range(len(outline)) for k in range(len(hole))),
            key=lambda pair: hypot(outline[pair[0]][0] - hole[pair[1]][0], outline[pair[0]][1] - hole[pair[1]][1]),
        )
        outline = (*outline[: i + 1], *hole[k:], *hole[: k + 1], *outline[i:])
    return outline
