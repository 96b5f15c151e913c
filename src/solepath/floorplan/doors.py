"""Gaps in walls: doors and other lines are cut out of walls."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterable, Iterator
from math import dist

from ..types.attrs import evolve
from .geometry import direction
from .plan import Level, Point, Wall

MAX_DOOR_OFFSET = 0.3
"""Largest distance of both ends of a door from the line of its wall, m.

A map draws a door on one face of a wall, or between two rooms whose outlines are a wall's thickness apart."""

MIN_DOOR_WIDTH, MAX_DOOR_WIDTH = 0.4, 20.0
"""Range of the width of a door, m; other values are errors of units."""

MIN_PIECE_LENGTH = 1e-3
"""Length of the shortest gap that is cut and of the shortest piece of wall that stays, m."""

MIN_COSINE = 0.7
"""Smallest cosine of the angle between a wall and an opening along it: at most about 45 degrees."""

_ON_LINE_DISTANCE = 1e-9
"""Distance from a wall's line, m, below which the door's end itself becomes the end of the wall, without projection."""


class Openings:
    """The lines that are cut out of walls, in the order of x, each with the number of the outline that has it."""

    def __init__(self, lines: Iterable[tuple[Point, Point, int]]) -> None:
        self._lines = sorted([(min(a, b), max(a, b), owner) for a, b, owner in lines])
        self._widest = max([b[0] - a[0] for a, b, _ in self._lines], default=0.0)

    def find_near(self, left: float, right: float) -> list[tuple[Point, Point, int]]:
        """Return the lines that may have a place with x from `left` to `right`, m."""
        first = bisect_left(self._lines, left - self._widest, key=_left_of)
        return self._lines[first : bisect_right(self._lines, right, key=_left_of)]


def _left_of(line: tuple[Point, Point, int]) -> float:
    return line[0][0]


def cut_doors(level: Level) -> Level:
    """Return the level with a gap in its walls wherever a door lies along them; a second call changes nothing."""
    doors = Openings([(door.start, door.end, -1) for door in level.doors])
    return evolve(level, walls=cut_openings(level.walls, doors, MAX_DOOR_OFFSET))


def cut_openings(
    walls: Iterable[Wall], openings: Openings, beside: float, excluded: int | None = None
) -> tuple[Wall, ...]:
    """Return the pieces of the walls after every opening along one of them is removed.

    An opening lies along a wall when both its ends are within `beside` m of the wall's line and the cosine of its angle
    to the wall is at least MIN_COSINE. Openings of the owner `excluded` leave no gaps."""
    pieces: list[Wall] = []
    for wall in walls:
        left, right = sorted((wall.start[0], wall.end[0]))
        near = openings.find_near(left - beside, right + beside)
        pieces += _cut(wall, [(a, b) for a, b, owner in near if owner != excluded], beside)
    return tuple(pieces)


def _cut(wall: Wall, openings: list[tuple[Point, Point]], beside: float) -> Iterator[Wall]:
    ax, ay = wall.start
    length, ux, uy = direction(wall.start, wall.end)
    gaps = []  # start and end along the wall, m, and as places
    for opening in openings:
        ends = []
        for x, y in opening:
            offset, along = abs(ux * (y - ay) - uy * (x - ax)), ux * (x - ax) + uy * (y - ay)
            ends.append((along, (x, y) if offset <= _ON_LINE_DISTANCE else (ax + along * ux, ay + along * uy), offset))
        (first, start, off), (last, end, far_off) = sorted(ends)
        is_along = max(off, far_off) <= beside and last - first >= MIN_COSINE * dist(*opening)
        first, last = max(first, 0.0), min(last, length)
        if is_along and last - first >= MIN_PIECE_LENGTH:
            gaps.append((first, last, start, end))
    cut_to, piece_start = 0.0, wall.start
    for first, last, start, end in sorted(gaps):
        if first - cut_to >= MIN_PIECE_LENGTH:
            yield Wall(piece_start, start)
        if last > cut_to:
            cut_to, piece_start = last, end
    if not gaps or length - cut_to >= MIN_PIECE_LENGTH:
        yield Wall(piece_start, wall.end)
