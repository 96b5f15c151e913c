"""A door's node has no width and no direction: both come from the wall that it stands in."""

from __future__ import annotations

from math import hypot

from ..doors import Line
from ..plan import Point
from .earth import to_mm

WIDTH = 1.0
"""m; of a door whose node tells none."""

NARROWEST, WIDEST = 0.4, 20.0
"""m; other widths are mistakes of units, and count as not told."""

BESIDE = 0.5
"""m; a door's node that is part of no wall belongs to the nearest one within this."""

_OPPOSITE = -0.94
"""Cosine of 160 degrees: two walls that go on from a node more than that apart are one wall."""


def door_at(place: Point, neighbours: list[Point], width: float | None) -> Line | None:
    """The door at a node of walls. `neighbours`: where the walls go on to. In the midst of a wall it is centred on the
    node; on a corner it begins there, along the longest wall. None where no wall goes on."""
    ways = sorted({_way(place, other) for other in neighbours if other != place})
    if not ways:
        return None
    wide = _wide(width)
    pairs = [(ax * bx + ay * by, i, j) for i, (_, ax, ay) in enumerate(ways) for j, (_, bx, by) in enumerate(ways[:i])]
    straightest = min(pairs, default=(1.0, 0, 0))
    if straightest[0] <= _OPPOSITE:
        _, ux, uy = ways[straightest[1]]
        _, vx, vy = ways[straightest[2]]
        return _moved(place, ux, uy, 0.5 * wide), _moved(place, vx, vy, 0.5 * wide)
    long, ux, uy = ways[-1]
    return place, _moved(place, ux, uy, min(wide, long))


def door_beside(place: Point, walls: list[Line], width: float | None) -> Line | None:
    """The door of a node that is part of no wall, in the nearest wall within BESIDE; None when there is none."""
    best, found = BESIDE, None
    for start, end in walls:
        dx, dy = end[0] - start[0], end[1] - start[1]
        long = hypot(dx, dy)
        if long == 0.0:
            continue
        along = min(max(((place[0] - start[0]) * dx + (place[1] - start[1]) * dy) / long, 0.0), long)
        at = _moved(start, dx / long, dy / long, along)
        away = hypot(at[0] - place[0], at[1] - place[1])
        if away <= best:
            half = 0.5 * _wide(width)
            best, found = away, (_moved(at, dx / long, dy / long, -half), _moved(at, dx / long, dy / long, half))
    return found


def _wide(width: float | None) -> float:
    return width if width is not None and NARROWEST <= width <= WIDEST else WIDTH


def _way(a: Point, b: Point) -> tuple[float, float, float]:
    long = hypot(b[0] - a[0], b[1] - a[1])
    return long, (b[0] - a[0]) / long, (b[1] - a[1]) / long


def _moved(place: Point, ux: float, uy: float, by: float) -> Point:
    return to_mm((place[0] + by * ux, place[1] + by * uy))
