"""Draws the wearer's track from above, on the floor plan when there is one.

Sizes and limits were chosen by hand and not swept."""

from __future__ import annotations

from itertools import pairwise
from math import dist, fsum
from xml.etree.ElementTree import Element

from attrs import evolve

from ....events import Placed
from ...tables.labels import Labels
from ...tables.plan import PANEL_GAP, PlanPicture
from ...tables.summary import end_line
from ...tables.svg import View, add, grid, line, square_ticks, ticks, write
from ..content import ReportContent
from ..markup import WIDTH, caption, drawing, whole_sentences
from .axes import PATH

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
    labels = Labels(LEFT, width - RIGHT, y.start, LETTER_WIDTH, LABEL_HEIGHT, [view.at(one) for one in way])
    for word, place in (("start", way[0]), ("end", way[-1])):
        point = view.at(place)
        add(svg, "<circle cx='{}' cy='{}' r='4.5' class='{}'/>", *point, word)
        labels.add(svg, point, word, "halo strong", is_needed=True)
    _times(svg, report, view, labels)
    return svg


def _times(svg: Element, report: ReportContent, view: View, labels: Labels) -> None:
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
        notes.append(f"Decided rooms on the way: {', '.join(rooms)}.")
    if report.walk.places.last is not None:
        notes += whole_sentences([end_line(report.walk.places.last)])
    if len(levels) < len(plan.levels):
        notes.append("Levels where the wearer was not are left out.")
    caption(element, "Track on the floor plan", *notes)
    return True
