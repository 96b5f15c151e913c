"""Doors of OpenStreetMap's nodes; a node has no direction, so its door lies along a wall."""

from __future__ import annotations

from math import hypot

from ..plan import Point
from .earth import to_mm

Line = tuple[Point, Point]

DEFAULT_DOOR_WIDTH = 1.0
"""Width of a door without a valid width, m."""

MIN_DOOR_WIDTH, MAX_DOOR_WIDTH = 0.4, 20.0
"""Range of valid widths, m; other values are errors of units and are ignored."""

MAX_NODE_DISTANCE = 0.5
"""Largest distance of a door's node outside any wall from the wall that it belongs to, m."""

_MAX_STRAIGHT_COSINE = -0.94
"""Cosine of 160 degrees: two walls that meet at a node at a larger angle count as one straight wall."""


def door_at(place: Point, neighbours: list[Point], width: float | None) -> Line | None:
    """Return the door at a node of walls; None without a wall.

    `neighbours` are the other ends of the walls at the node, m. In the middle of a wall the door is centred on the
    node; at a corner it starts there, along the longest wall. `width` is in m."""
    directions = sorted({_direction(place, other) for other in neighbours if other != place})
    if not directions:
        return None
    door_width = _door_width(width)
    pairs = [
        (ax * bx + ay * by, i, j)
        for i, (_, ax, ay) in enumerate(directions)
        for j, (_, bx, by) in enumerate(directions[:i])
    ]
    straightest = min(pairs, default=(1.0, 0, 0))
    if straightest[0] <= _MAX_STRAIGHT_COSINE:
        _, ux, uy = directions[straightest[1]]
        _, vx, vy = directions[straightest[2]]
        return _move(place, ux, uy, 0.5 * door_width), _move(place, vx, vy, 0.5 * door_width)
    length, ux, uy = directions[-1]
    return place, _move(place, ux, uy, min(door_width, length))


def door_beside(place: Point, walls: list[Line], width: float | None) -> Line | None:
    """Return the door of a node outside any wall, in the nearest wall within MAX_NODE_DISTANCE; None without one."""
    nearest_distance, door = MAX_NODE_DISTANCE, None
    for start, end in walls:
        dx, dy = end[0] - start[0], end[1] - start[1]
        length = hypot(dx, dy)
        if length == 0.0:
            continue
        along = min(max(((place[0] - start[0]) * dx + (place[1] - start[1]) * dy) / length, 0.0), length)
        point = _move(start, dx / length, dy / length, along)
        distance = hypot(point[0] - place[0], point[1] - place[1])
        if distance <= nearest_distance:
            half = 0.5 * _door_width(width)
            nearest_distance = distance
            door = _move(point, dx / length, dy / length, -half), _move(point, dx / length, dy / length, half)
    return door


def _door_width(width: float | None) -> float:
    return width if width is not None and MIN_DOOR_WIDTH <= width <= MAX_DOOR_WIDTH else DEFAULT_DOOR_WIDTH


def _direction(a: Point, b: Point) -> tuple[float, float, float]:
    length = hypot(b[0] - a[0], b[1] - a[1])
    return length, (b[0] - a[0]) / length, (b[1] - a[1]) / length


def _move(place: Point, ux: float, uy: float, by: float) -> Point:
    return to_mm((place[0] + by * ux, place[1] + by * uy))
