"""Draws the wearer's track from above, on the floor plan when there is one.

Sizes and limits were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import dist, fsum
from xml.etree.ElementTree import Element

from attrs import define, evolve, field

from ....events import Placed
from ...tables.plan import PANEL_GAP, PlanPicture
from ...tables.summary import end_line
from ...tables.svg import Point, View, add, grid, line, square_ticks, ticks, write
from ..content import ReportContent
from ..markup import WIDTH, caption, drawing, whole_sentences
from .axes import PATH

Span = tuple[float, float]
"""Lower and upper end, px."""
Box = tuple[float, float, float, float]
"""Left, right, upper and lower end, px."""
MAX_HEIGHT = 366.0
"""Largest height of a track on its drawing, px."""
WIDE_WIDTH, WIDE_HEIGHT = 840.0, 386.0
"""Width of the drawing for wide screens and paper, and largest height of the track on it, px."""
TEST_HEIGHT = 200.0
"""The same in the report of a test, which has a comparison on the same page of paper."""
MARGIN_SHARE, MIN_MARGIN = 0.08, 0.4
"""Margin around the track: as a share of its larger extent, with room for a label on a phone, and the least, m."""
MIN_HEIGHT = 118.0
"""Least height of the track on its drawing, px."""
LETTER_WIDTH, LABEL_HEIGHT = 8.6, 15.0
"""Size of a letter of a label with the space around it, px: the largest letters are 15.6 px high, on a phone."""
CLEARANCE = 3.0
"""Least distance of a label from the track, px."""
PLACES = [(0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (-1.0, 0.0), (1.0, -1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
"""Where a label may be, from its point on the track: so many widths to the right and heights down."""
FARTHEST = 2
"""Largest distance at which a place for a label is sought, in its sizes."""
TOP, LEFT, RIGHT, BOTTOM = 16.0, 40.0, 8.0, 38.0
"""Margins of the drawing of a track, px."""


def track_figure(
    parent: Element, report: ReportContent, *, wide: bool = True, name: str = "track", title: str = "Track from above"
) -> bool:
    """Draw the track from above, x to the right and y up; return False when there is none.

    A `wide` figure also holds a drawing for wide screens and for paper."""
    if len(report.track) < 2:
        return False
    element = add(parent, "<figure/>")
    most = WIDE_HEIGHT if report.outcomes is None or report.outcomes.test is None else TEST_HEIGHT
    for kind, width, height in [("wide", WIDE_WIDTH, most)] * wide + [("narrow", WIDTH, MAX_HEIGHT)]:
        svg = _draw(element, f"{name}-{kind}", title, report, width, height)
        svg.set("class", kind if wide else "")
    caption(element, title, "x along the first heading; times are along the way, where there is room.")
    return True


def _draw(parent: Element, name: str, title: str, report: ReportContent, width: float, max_height: float) -> Element:
    """Add a drawing of the track, `width` px wide."""
    way = [event.position[:2] for event in report.track]
    across, up = [max(values) - min(values) for values in zip(*way, strict=True)]
    length = fsum([dist(a, b) for a, b in pairwise(way)])
    what = f"The track from above, {across:.1f} m by {up:.1f} m, {length:.0f} m long as drawn."
    inner_width = width - LEFT - RIGHT
    view = View.fit(way, inner_width, max_height, MARGIN_SHARE, MIN_MARGIN)
    view = evolve(view, width=inner_width, height=max(view.height, MIN_HEIGHT), left=LEFT, top=TOP)
    svg = drawing(parent, name, title, what, view.height + TOP + BOTTOM, width)
    x, y = view.axes
    grid(svg, x, y, *square_ticks((x.low, x.high), (y.low, y.high))[:2])
    write(svg, 0.5 * (x.start + x.end), y.start + 33.0, "x and y, m", "label")
    add(svg, PATH, line(map(view.at, way)), "way")
    labels = _Labels([view.at(one) for one in way], width - RIGHT, y.start)
    for word, place in (("start", way[0]), ("end", way[-1])):
        point = view.at(place)
        add(svg, "<circle cx='{}' cy='{}' r='4.5' class='{}'/>", *point, word)
        labels.add(svg, point, word, "halo strong", is_needed=True)
    _times(svg, report, view, labels)
    return svg


def _box(middle: Point, width: float) -> Box:
    """Return the box of a label."""
    x, y = middle
    return x - 0.5 * width, x + 0.5 * width, y - 8.0, y + 8.0


@define
class _Labels:
    """The labels of a track: none is over another one, or over the track if there is a place that is free."""

    way: Sequence[Point]
    """Points of the track, px."""
    right: float
    """Right end of the grid, px; its left end is at LEFT."""
    bottom: float
    """Lower end of the grid, px."""
    boxes: list[Box] = field(factory=list)
    """Left, right, upper and lower ends of what has a label, px."""

    def add(self, svg: Element, point: Point, words: str, kind: str, *, is_needed: bool = False) -> bool:
        """Write words beside a point at the first free place; return whether they were written.

        Words that are needed go beyond another part of the track, or over it, if there is no such place."""
        width, (x, y) = LETTER_WIDTH * len(words), point
        middles = [
            (x + distance * right * (0.5 * width + 8.0), y + distance * down * LABEL_HEIGHT)
            for distance in range(1, FARTHEST + 1)
            for right, down in PLACES
        ]
        free = [one for one in middles if self._is_free(_box(one, width))]
        known = [one for one in free if self._is_beside(point, one)] or (free if is_needed else [])
        if is_needed:
            known.append((min(max(x, LEFT + 0.5 * width), self.right - 0.5 * width), y - LABEL_HEIGHT))
        if known:
            self.boxes.append(_box(known[0], width))
            write(svg, known[0][0], known[0][1] + 4.5, words, kind)
        return bool(known)

    def _is_beside(self, point: Point, middle: Point) -> bool:
        """Return whether no other part of the track is between a point of it and the middle of its label."""
        x, y = [0.7 * a + 0.3 * b for a, b in zip(point, middle, strict=True)]
        return not any([_meet((x, y), middle, a, b) for a, b in pairwise(self.way)])

    def _is_free(self, box: Box) -> bool:
        left, right, upper, lower = box
        if left < LEFT or right > self.right or upper < 0.0 or lower > self.bottom:
            return False
        if any([left < b and a < right and upper < d and c < lower for a, b, c, d in self.boxes]):
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


def _times(svg: Element, report: ReportContent, view: View, labels: _Labels) -> None:
    """Write up to seven times along the track, those that have room."""
    times = [(report.clock.axis_value(event.t), event.position[:2]) for event in report.track]
    for value, words in ticks(times[0][0], times[-1][0], 7).items():
        _, nearest = min(times, key=lambda one: abs(one[0] - value))
        if labels.add(svg, view.at(nearest), f"{words} {report.clock.unit}", "halo tick"):
            add(svg, "<circle cx='{}' cy='{}' r='2.4' class='time'/>", *view.at(nearest))


def plan_figure(parent: Element, report: ReportContent) -> bool:
    """Draw the track on the floor plan, as `solepath track` does; return False when there is no plan or no place.

    Only the levels where the wearer was are shown."""
    places, plan = [event for event in report.walk.placed if isinstance(event, Placed)], report.plan
    if plan is None or not places:
        return False
    visited = {place.level for place in places}
    levels = tuple([level for level in plan.levels if level.id in visited]) or plan.levels
    element = add(parent, "<figure/>")
    for kind, width, most in (("wide", WIDE_WIDTH, 2), ("narrow", 380.0, 1)):
        columns = min(most, max(len(levels), 1))
        level_width = (width - (columns - 1) * PANEL_GAP) / columns
        picture = PlanPicture(evolve(plan, levels=levels), report.walk.placed, level_width, 440.0, columns)
        svg = picture.drawn(plan.name or "Floor plan")
        del svg.attrib["xmlns"]
        svg.attrib |= {"class": f"plan {kind}", "role": "img", "id": f"solepath-plan-{kind}"}
        element.append(svg)
    notes = ["Colours go from the start to the end; dots are candidates, the fainter the less likely."]
    rooms = list(dict.fromkeys([place.room for place in places if place.room and place.decided]))
    if rooms:
        notes.append(f"On the way: {', '.join(rooms)}.")
    if report.walk.places.last is not None:
        notes += whole_sentences([end_line(report.walk.places.last)])
    if len(levels) < len(plan.levels):
        notes.append("Levels where the wearer was not are left out.")
    caption(element, "Track on the floor plan", *notes)
    return True
