"""Doors from nodes: a node has no width and no direction, so both come from the wall that it stands in."""

from __future__ import annotations

from math import hypot

from ..doors import Line
from ..plan import Point
from .earth import to_mm

WIDTH = 1.0
"""Width of a door whose node has none, m."""

NARROWEST, WIDEST = 0.4, 20.0
"""Range of valid widths, m; others are errors of units and are ignored."""

BESIDE = 0.5
"""Largest distance of a door's node outside any wall from the wall that it belongs to, m."""

_OPPOSITE = -0.94
"""Cosine of 160 degrees: two walls that leave a node at a larger angle are one wall."""


def door_at(place: Point, neighbours: list[Point], width: float | None) -> Line | None:
    """Return the door at a node of walls; None where no wall goes on.

    `neighbours` are the nodes to which the walls go. In the middle of a wall the door is centred on the node; at a
    corner it starts there, along the longest wall."""
    directions = sorted({_direction(place, other) for other in neighbours if other != place})
    if not directions:
        return None
    wide = _door_width(width)
    pairs = [
        (ax * bx + ay * by, i, j)
        for i, (_, ax, ay) in enumerate(directions)
        for j, (_, bx, by) in enumerate(directions[:i])
    ]
    straightest = min(pairs, default=(1.0, 0, 0))
    if straightest[0] <= _OPPOSITE:
        _, ux, uy = directions[straightest[1]]
        _, vx, vy = directions[straightest[2]]
        return _move(place, ux, uy, 0.5 * wide), _move(place, vx, vy, 0.5 * wide)
    long, ux, uy = directions[-1]
    return place, _move(place, ux, uy, min(wide, long))


def door_beside(place: Point, walls: list[Line], width: float | None) -> Line | None:
    """Return the door of a node outside any wall, in the nearest wall within BESIDE; None when there is none."""
    best, found = BESIDE, None
    for start, end in walls:
        dx, dy = end[0] - start[0], end[1] - start[1]
        long = hypot(dx, dy)
        if long == 0.0:
            continue
        along = min(max(((place[0] - start[0]) * dx + (place[1] - start[1]) * dy) / long, 0.0), long)
        at = _move(start, dx / long, dy / long, along)
        away = hypot(at[0] - place[0], at[1] - place[1])
        if away <= best:
            half = 0.5 * _door_width(width)
            best, found = away, (_move(at, dx / long, dy / long, -half), _move(at, dx / long, dy / long, half))
    return found


def _door_width(width: float | None) -> float:
    return width if width is not None and NARROWEST <= width <= WIDEST else WIDTH


def _direction(a: Point, b: Point) -> tuple[float, float, float]:
    long = hypot(b[0] - a[0], b[1] - a[1])
    return long, (b[0] - a[0]) / long, (b[1] - a[1]) / long


def _move(place: Point, ux: float, uy: float, by: float) -> Point:
    return to_mm((place[0] + by * ux, place[1] + by * uy))
