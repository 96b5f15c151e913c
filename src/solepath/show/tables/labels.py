"""Places labels on a drawing, so that none is over another one; the report and the picture of a plan use it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from unicodedata import east_asian_width
from xml.etree.ElementTree import Element

from attrs import define, field

from ...recording import printable
from .svg import Point, write

Span = tuple[float, float]
"""Lower and upper end, px."""
Box = tuple[float, float, float, float]
"""Left, right, upper and lower end, px."""
AROUND = [(0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (-1.0, 0.0), (1.0, -1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
"""Where a label may be, from its point: so many widths to the right and heights down."""
FARTHEST = 2
"""Largest distance at which a place for a label is sought, in its sizes."""
CLEARANCE = 3.0
"""Least distance of a label from the track, px."""


def cut(words: str, most: int) -> str:
    """Return words of at most so many letters, the last one an ellipsis where some are left out."""
    words = printable(words, most + 1)
    return words if len(words) <= most else f"{words[: most - 1]}\u2026"


@define
class Labels:
    """The labels of a drawing: none is over another one, or over the track if there is a place that is free."""

    left: float
    right: float
    bottom: float
    """Left, right and lower end of where labels may be, px."""
    letter: float
    height: float
    """Width of a letter, with the space around it, and height of a label, px."""
    way: Sequence[Point] = ()
    """Points of the track, px."""
    boxes: dict[int, list[Box]] = field(factory=dict)
    """Left, right, upper and lower ends of what has a label, px, in rows of the height of a label."""

    def add(
        self,
        svg: Element,
        point: Point,
        words: str,
        kind: str,
        *,
        places: Sequence[Point] = AROUND,
        is_needed: bool = False,
    ) -> bool:
        """Write words beside a point at the first free place; return whether they were written.

        Words that are needed go beyond another part of the track, or over it, if there is no such place."""
        width = self.letter * sum([1 + (east_asian_width(one) in "WF") for one in words])
        x, y = point
        middles = [
            (x + distance * right * (0.5 * width + 8.0), y + distance * down * self.height)
            for distance in range(1, FARTHEST + 1)
            for right, down in places
        ]
        free = [one for one in middles if self._is_free(self._box(one, width))]
        known = [one for one in free if self._is_beside(point, one)] or (free if is_needed else [])
        if is_needed:
            known.append((min(max(x, self.left + 0.5 * width), self.right - 0.5 * width), y - self.height))
        if known:
            self.keep(self._box(known[0], width))
            write(svg, known[0][0], known[0][1] + 0.3 * self.height, words, kind)
        return bool(known)

    def keep(self, box: Box) -> None:
        """Keep a box free of labels, px."""
        for row in self._rows(box):
            self.boxes.setdefault(row, []).append(box)

    def _box(self, middle: Point, width: float) -> Box:
        """Return the box of a label."""
        (x, y), half = middle, 0.5 * self.height + 0.5
        return x - 0.5 * width, x + 0.5 * width, y - half, y + half

    def _rows(self, box: Box) -> range:
        return range(int(box[2] // self.height), int(box[3] // self.height) + 1)

    def _is_beside(self, point: Point, middle: Point) -> bool:
        """Return whether no other part of the track is between a point of it and the middle of its label."""
        x, y = [0.7 * a + 0.3 * b for a, b in zip(point, middle, strict=True)]
        return not any([_meet((x, y), middle, a, b) for a, b in pairwise(self.way)])

    def _is_free(self, box: Box) -> bool:
        left, right, upper, lower = box
        if left < self.left or right > self.right or upper < 0.0 or lower > self.bottom:
            return False
        near = [one for row in self._rows(box) for one in self.boxes.get(row, ())]
        if any([left < b and a < right and upper < d and c < lower for a, b, c, d in near]):
            return False
        ends = (left - CLEARANCE, right + CLEARANCE), (upper - CLEARANCE, lower + CLEARANCE)
        return not any([_crosses(a, b, *ends) for a, b in pairwise(self.way)])


def _meet(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Return whether the line from `a` to `b` and that from `c` to `d` cross."""

    def side(one: Point, other: Point, third: Point) -> bool:
        way, to = (other[0] - one[0], other[1] - one[1]), (third[0] - one[0], third[1] - one[1])
        return way[0] * to[1] > way[1] * to[0]

    return side(a, b, c) is not side(a, b, d) and side(c, d, a) is not side(c, d, b)


def _crosses(a: Point, b: Point, across: Span, down: Span) -> bool:
    """Return whether the line from `a` to `b` goes through a box, px (Liang and Barsky 1984, ACM Trans. Graph. 3)."""
    first, last = 0.0, 1.0
    for start, end, (low, high) in ((a[0], b[0], across), (a[1], b[1], down)):
        way = end - start
        if way == 0.0:
            if not low <= start <= high:
                return False
            continue
        enter, leave = sorted(((low - start) / way, (high - start) / way))
        first, last = max(first, enter), min(last, leave)
    return first <= last
