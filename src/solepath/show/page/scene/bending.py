"""Bends the tracks that were drawn when a position that a person reported has revised the path."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from math import hypot

from attrs import frozen

from ....events import TrackRevised
from ....walk.links import SET_BACK_TOLERANCE
from .lists import TrackPoint

Numbers = tuple[float, ...]


@frozen
class Bend:
    """The correction of drawn points over time: known at some times, and interpolated between them.

    Points before the first of `times`, s, stay where they are."""

    times: Sequence[float]
    shifts: Sequence[Numbers]
    """Correction in x and y at each of `times`, m, world frame."""

    def apply(self, points: Sequence[TrackPoint]) -> list[TrackPoint]:
        """Return the points of a track, (t, x, y, z) in s and m, with the correction of each one's time added."""
        start = _start_of_clock([point[0] for point in points], SET_BACK_TOLERANCE)
        return [*points[:start], *map(self._bent, points[start:])]

    def _bent(self, point: TrackPoint) -> TrackPoint:
        t, x, y, *rest = point
        if not self.times or t < self.times[0]:
            return point
        dx, dy = _interpolate(t, self.times, self.shifts)
        return (t, round(x + dx, 3), round(y + dy, 3), *rest)


def bend_of(event: TrackRevised, walked: Sequence[TrackPoint]) -> Bend:
    """Return how the drawn tracks are bent by a revision; `walked` is the wearer's track as it was drawn before.

    At each node the correction is the distance from the drawn track to the node. In between it grows with the distance
    walked, not with time: who stood still before the report was in one place."""
    nodes = event.nodes[_start_of_clock([node.t for node in event.nodes]) :]
    if not nodes:
        return Bend((), ())
    end = (event.t, nodes[-1].x - event.by[0], nodes[-1].y - event.by[1])
    times, drawn = list[float](), list[Numbers]()
    start = _start_of_clock([point[0] for point in walked], SET_BACK_TOLERANCE)
    for t, x, y, *_ in (*walked[start:], end):
        before = drawn[-1] if drawn else (x, y, 0.0)
        times.append(t)
        drawn.append((x, y, before[2] + hypot(x - before[0], y - before[1])))
    distances, shifts = list[float](), list[Numbers]()
    for node in nodes:
        x, y, distance = _interpolate(node.t, times, drawn)
        distances.append(distance)
        shifts.append((node.x - x, node.y - y))
    bend_times, bend_shifts = [nodes[0].t], shifts[:1]
    for t, (_, _, distance) in zip(times, drawn, strict=True):
        if t > bend_times[-1]:
            bend_times.append(t)
            bend_shifts.append(_interpolate(distance, distances, shifts))
    return Bend(bend_times, bend_shifts)


def _interpolate(at: float, places: Sequence[float], values: Sequence[Numbers]) -> Numbers:
    """Return the values at a place among `places`, which do not fall; beyond an end, those of the end."""
    k = bisect_right(places, at)
    if k == 0 or k == len(places):
        return values[max(0, k - 1)]
    share = (at - places[k - 1]) / (places[k] - places[k - 1])
    return tuple([a + share * (b - a) for a, b in zip(values[k - 1], values[k], strict=True)])


def _start_of_clock(times: Sequence[float], tolerance: float = 0.0) -> int:
    """Return the index of the first time after a clock was set back for the last time; 0 if it never was, s."""
    falls = [k for k in range(1, len(times)) if times[k] < times[k - 1] - tolerance]
    return falls[-1] if falls else 0
