"""Bends the tracks that were drawn when a position that a person reported has revised the path."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from math import hypot
from operator import itemgetter

from ....events import TrackRevised
from ....walk.links import SET_BACK_TOLERANCE
from .lists import TrackPoint

Bend = list[tuple[float, ...]]
"""The correction of drawn points over time: rows (t, x, y) in s and m, world frame, interpolated in between."""


def bend_of(event: TrackRevised, walked: Sequence[TrackPoint]) -> Bend:
    """Return how the drawn tracks are bent by a revision; `walked` is the wearer's track as it was drawn before.

    At each node the correction is the distance from the drawn track to the node. In between it grows with the distance
    walked, not with time: who stood still before the report was in one place."""
    nodes = event.nodes[_start_of_clock([node.t for node in event.nodes]) :]
    if not nodes:
        return []
    end = (event.t, nodes[-1].x - event.by[0], nodes[-1].y - event.by[1])
    drawn = list[tuple[float, ...]]()  # (t, x, y, distance walked)
    for t, x, y, *_ in (*walked[_start_of_track(walked) :], end):
        _, x_before, y_before, distance = drawn[-1] if drawn else (t, x, y, 0.0)
        drawn.append((t, x, y, distance + hypot(x - x_before, y - y_before)))
    shifts = list[tuple[float, ...]]()  # (distance walked, x, y)
    for node in nodes:
        x, y, distance = _interpolate(node.t, drawn)
        shifts.append((distance, node.x - x, node.y - y))
    bend = [(nodes[0].t, *shifts[0][1:])]
    for t, _, _, distance in drawn:
        if t > bend[-1][0]:
            bend.append((t, *_interpolate(distance, shifts)))
    return bend


def bent(points: Sequence[TrackPoint], bend: Bend) -> list[TrackPoint]:
    """Return the points of a track, (t, x, y, z) in s and m, with the correction of each one's time added.

    Points before the first correction stay where they are."""
    start = _start_of_track(points)
    moved = list(points)
    for k, (t, x, y, *rest) in enumerate(points[start:], start):
        if bend and t >= bend[0][0]:
            dx, dy = _interpolate(t, bend)
            moved[k] = (t, round(x + dx, 3), round(y + dy, 3), *rest)
    return moved


def span_of(times: Sequence[float], t_start: float, t_end: float) -> tuple[int, int]:
    """Return the number of points up to `t_start`, s, and the index of the first one from `t_end` on.

    `times` are those of the points of a track, s."""
    first = _start_of_clock(times, SET_BACK_TOLERANCE)
    return bisect_right(times, t_start, first), bisect_left(times, t_end, first)


def _interpolate(at: float, rows: Sequence[tuple[float, ...]]) -> tuple[float, ...]:
    """Return the values at a place; rows (place, values) are in the order of their places, and go on beyond an end."""
    k = bisect_right(rows, at, key=itemgetter(0))
    if k == 0 or k == len(rows):
        return rows[max(0, k - 1)][1:]
    (before, *values), (after, *others) = rows[k - 1 : k + 1]
    share = (at - before) / (after - before)
    return tuple([a + share * (b - a) for a, b in zip(values, others, strict=True)])


def _start_of_track(points: Sequence[TrackPoint]) -> int:
    return _start_of_clock([point[0] for point in points], SET_BACK_TOLERANCE)


def _start_of_clock(times: Sequence[float], tolerance: float = 0.0) -> int:
    """Return the index of the first time after a clock was set back for the last time; 0 if it never was, s."""
    falls = [k for k in range(1, len(times)) if times[k] < times[k - 1] - tolerance]
    return falls[-1] if falls else 0
