"""Gaps in walls: doors are cut out of walls, and walls out of walls."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Sequence
from math import hypot

from ..types.attrs import evolve
from .plan import Level, Point, Wall

BESIDE = 0.3
"""Largest distance of both ends of a door from the line of its wall, m.

Doors are drawn on one face of a wall, or between two rooms whose outlines are a wall's thickness apart."""

SHORTEST = 1e-3
"""Shortest gap that is cut and shortest piece of wall that stays, m."""

_ON = 1e-9
"""Distance from a wall's line, m, below which a door's own end is the end of the wall."""

Line = tuple[Point, Point]


class Openings:
    """Lines that leave gaps, indexed by position; `owners` says which outline each belongs to, where that matters."""

    def __init__(self, lines: Sequence[Line], owners: Sequence[int] = ()) -> None:
        order = sorted(range(len(lines)), key=lambda i: _leftmost(lines[i]))
        self._lines = [(lines[i], owners[i] if owners else -1) for i in order]
        self._lefts = [_leftmost(lines[i]) for i in order]
        self._widest = max((abs(b[0] - a[0]) for a, b in lines), default=0.0)

    def near(self, wall: Wall, beside: float, excluded: int | None) -> list[Line]:
        """Return the lines that may lie along a wall, except those of one owner."""
        left, right = min(wall.start[0], wall.end[0]) - beside, max(wall.start[0], wall.end[0]) + beside
        low, high = min(wall.start[1], wall.end[1]) - beside, max(wall.start[1], wall.end[1]) + beside
        first, last = bisect_left(self._lefts, left - self._widest), bisect_right(self._lefts, right)
        return [
            line for line, owner in self._lines[first:last]
            if owner != excluded and not (max(line[0][1], line[1][1]) < low or min(line[0][1], line[1][1]) > high)
        ]  # fmt: skip


def with_doors_cut(level: Level) -> Level:
    """Return the level with a gap in its walls wherever a door lies along them; idempotent."""
    return evolve(level, walls=cut(level.walls, Openings([(door.start, door.end) for door in level.doors]), BESIDE))


def cut(walls: Iterable[Wall], openings: Openings, beside: float, excluded: int | None = None) -> tuple[Wall, ...]:
    """Return the pieces of the walls after every opening along one of them is removed.

    An opening lies along a wall when both its ends are within `beside` (m) of the wall's line and it is at less than 45
    degrees to it. Openings of the owner `excluded` leave no gaps."""
    return tuple([piece for wall in walls for piece in _pieces(wall, openings.near(wall, beside, excluded), beside)])


def _leftmost(line: Line) -> float:
    return min(line[0][0], line[1][0])


def _pieces(wall: Wall, openings: list[Line], beside: float) -> list[Wall]:
    gaps = sorted(gap for gap in (_gap(wall, opening, beside) for opening in openings) if gap is not None)
    if not gaps:
        return [wall]
    (ax, ay), (bx, by) = wall.start, wall.end
    pieces = []
    since, start = 0.0, wall.start
    for low, high, end, next_start in gaps:
        if low - since >= SHORTEST:
            pieces.append(Wall(start, end))
        if high > since:
            since, start = high, next_start
    if hypot(bx - ax, by - ay) - since >= SHORTEST:
        pieces.append(Wall(start, wall.end))
    return pieces


def _gap(wall: Wall, opening: Line, beside: float) -> tuple[float, float, Point, Point] | None:
    """Return the start and end of an opening along the wall, m, and these two places; None when it is not along it."""
    (ax, ay), (bx, by) = wall.start, wall.end
    long = hypot(bx - ax, by - ay)
    wide = hypot(opening[1][0] - opening[0][0], opening[1][1] - opening[0][1])
    if long < SHORTEST or wide < SHORTEST:
        return None
    ux, uy = (bx - ax) / long, (by - ay) / long
    ends = []
    for x, y in opening:
        off = ux * (y - ay) - uy * (x - ax)
        if not abs(off) <= beside:
            return None
        along = ux * (x - ax) + uy * (y - ay)
        place = (x, y) if abs(off) <= _ON else (ax + along * ux, ay + along * uy)
        ends.append((along, place))
    (low, start), (high, end) = sorted(ends)
    if high - low < 0.7 * wide or min(high, long) - max(low, 0.0) < SHORTEST:
        return None
    return max(low, 0.0), min(high, long), start, end
