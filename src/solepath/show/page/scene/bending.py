"""Bends the tracks that were drawn when a position that a person reported has revised the path."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from math import hypot

from attrs import frozen

from ....events import TrackRevised
from ....walk.links import SET_BACK_TOLERANCE
from ..messages import rounded
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
        bent = list(points)
        if not self.times:
            return bent
        for k in range(_first_of_clock(points), len(points)):
            t, x, y, *rest = points[k]
            if t is not None and x is not None and y is not None and t >= self.times[0]:
                dx, dy = _interpolate(t, self.times, self.shifts)
                bent[k] = (t, rounded(x + dx), rounded(y + dy), *rest)
        return bent


def bend_of(event: TrackRevised, walked: Sequence[TrackPoint]) -> Bend:
    """Return how the drawn tracks are bent by a revision; `walked` is the wearer's track as it was drawn before.

    At each node the correction is the distance from the drawn track to the node. In between it grows with the distance
    walked, not with time: who stood still before the report was in one place."""
    times, drawn = _drawn_until(event, walked)
    nodes = list(event.nodes)
    for k in range(len(nodes) - 1, 0, -1):
        if nodes[k - 1].t > nodes[k].t:  # a clock was set back in between
            nodes = nodes[k:]
            break
    distances, shifts = list[float](), list[Numbers]()
    for node in nodes:
        x, y, distance = _interpolate(node.t, times, drawn)
        distances.append(distance)
        shifts.append((node.x - x, node.y - y))
    if not nodes:
        return Bend((), ())
    bend_times, bend_shifts = [nodes[0].t], shifts[:1]
    for t, (_, _, distance) in zip(times, drawn, strict=True):
        if t > bend_times[-1]:
            bend_times.append(t)
            bend_shifts.append(_interpolate(distance, distances, shifts))
    return Bend(bend_times, bend_shifts)


def _drawn_until(event: TrackRevised, walked: Sequence[TrackPoint]) -> tuple[list[float], list[Numbers]]:
    """Return the times, s, of the wearer's track up to the event, and x, y and the distance walked at each, m."""
    places = [(t, x, y) for t, x, y, *_ in walked[_first_of_clock(walked) :]]
    if event.nodes:
        end = event.nodes[-1]
        places.append((event.t, end.x - event.by[0], end.y - event.by[1]))
    times, drawn, distance = list[float](), list[Numbers](), 0.0
    for t, x, y in places:
        if t is None or x is None or y is None:
            continue
        if drawn:
            distance += hypot(x - drawn[-1][0], y - drawn[-1][1])
        times.append(t)
        drawn.append((x, y, distance))
    return times, drawn


def _interpolate(at: float, places: Sequence[float], values: Sequence[Numbers]) -> Numbers:
    """Return the values at a place among `places`, which do not fall; beyond an end, those of the end."""
    k = bisect_right(places, at)
    if k == 0 or k == len(places):
        return values[max(0, k - 1)]
    share = (at - places[k - 1]) / (places[k] - places[k - 1])
    return tuple([a + share * (b - a) for a, b in zip(values[k - 1], values[k], strict=True)])


def _first_of_clock(points: Sequence[TrackPoint]) -> int:
    """Return the index of the first point after the newest time at which a clock was set back; 0 without one."""
    for k in range(len(points) - 1, 0, -1):
        t, before = points[k][0], points[k - 1][0]
        if t is not None and before is not None and t < before - SET_BACK_TOLERANCE:
            return k
    return 0
