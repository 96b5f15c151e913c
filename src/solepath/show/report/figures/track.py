"""Draws the wearer's track from above, on the floor plan when there is one, and the height of the feet.

Sizes and limits were chosen by hand and not swept."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from itertools import pairwise
from math import dist, fsum, inf
from xml.etree.ElementTree import Element

from attrs import evolve

from ....events import Placed, StrideTaken
from ...tables.plan import PANEL_GAP, PlanPicture
from ...tables.svg import Point, View, add, line, ticks
from ..content import ReportContent, TimedPosition
from ..markup import WIDTH, caption, drawing
from .axes import FOOT_MARKS, MARK, PATH, Chart, grid, padded_range, square_ticks, write

MAX_FOOTPRINTS = 160
"""Largest number of footprints, the positions of foot-flats, that are drawn; more would hide the track."""
MAX_HEIGHT = 366.0
"""Largest height of a track on its drawing, px."""
WIDE_WIDTH, WIDE_HEIGHT = 840.0, 386.0
"""Width of the drawing for wide screens and paper, and largest height of the track on it, px."""
MAX_ROOMS = 12
"""Largest number of rooms that are named below the plan."""
MIN_RISE = 0.5
"""Least range of heights that is drawn over time, m; below it the way is level."""
MAX_OFFSET = 1.2
"""Distance of a footprint from the wearer's track above which no footprints are drawn, m: the tracks drift apart."""
MARGIN_SHARE, MIN_MARGIN = 0.06, 0.4
"""Margin around the track: as a share of its larger extent, and the least, m."""
MIN_HEIGHT = 118.0
"""Least height of the track on its drawing, px."""
TOP, LEFT, RIGHT, BOTTOM = 16.0, 40.0, 8.0, 38.0
"""Margins of the drawing of a track, px."""


def track_figure(
    parent: Element, report: ReportContent, *, wide: bool = True, name: str = "track", title: str = "Track from above"
) -> bool:
    """Draw the track from above, x to the right and y up; return False when there is none.

    A `wide` figure also holds a drawing for wide screens and for paper."""
    track, prints = report.track, report.footprints
    if len(track) < 2:
        return False
    notes = ["x along the first heading; the numbers along the way are times."]
    offset = _largest_offset(track, prints) if len(prints) <= MAX_FOOTPRINTS else inf
    if offset > MAX_OFFSET:
        prints = []
    if prints:
        notes.append("\N{BLACK CIRCLE} where the left foot stood, \N{MULTIPLICATION SIGN} the right one.")
    if MAX_OFFSET < offset < inf:
        notes.append(f"The tracks of the single feet come to lie up to {offset:.1f} m off it and are not shown.")
    element = add(parent, "<figure/>")
    for kind, width, height in [("wide", WIDE_WIDTH, WIDE_HEIGHT)] * wide + [("narrow", WIDTH, MAX_HEIGHT)]:
        svg = _draw(element, f"{name}-{kind}", title, report, prints, width, height)
        svg.set("class", kind if wide else "")
    caption(element, title, *notes)
    return True


def _draw(
    parent: Element,
    name: str,
    title: str,
    report: ReportContent,
    prints: Sequence[StrideTaken],
    width: float,
    max_height: float,
) -> Element:
    """Add a drawing of the track, `width` px wide."""
    way = [event.position[:2] for event in report.track]
    points = way + [event.position[:2] for event in prints]
    across, up = [max(values) - min(values) for values in zip(*points, strict=True)]
    length = fsum([dist(a, b) for a, b in pairwise(way)])
    what = f"The track from above, {across:.1f} m by {up:.1f} m, {length:.0f} m long as drawn."
    inner_width = width - LEFT - RIGHT
    view = View.fit(points, inner_width, max_height, MARGIN_SHARE, MIN_MARGIN)
    view = evolve(view, width=inner_width, height=max(view.height, MIN_HEIGHT), left=LEFT, top=TOP)
    svg = drawing(parent, name, title, what, view.height + TOP + BOTTOM, width)
    x, y = view.axes
    grid(svg, x, y, *square_ticks((x.low, x.high), (y.low, y.high))[:2])
    write(svg, 0.5 * (x.start + x.end), y.start + 33.0, "x and y, m", "label")
    add(svg, PATH, line(map(view.at, way)), "way")
    for one in prints:
        add(svg, MARK, *view.at(one.position[:2]), FOOT_MARKS[one.foot], "mark", one.foot.value)
    _times(svg, report, view)
    mark_end(svg, view.at(way[0]), "start", -8.0, width)
    mark_end(svg, view.at(way[-1]), "end", 17.0, width)
    return svg


def mark_end(svg: Element, point: Point, word: str, offset: float, width: float = WIDTH) -> None:
    """Draw the start or the end of a track with its name."""
    x, y = point
    add(svg, "<circle cx='{}' cy='{}' r='4.5' class='{}'/>", x, y, word)
    at_edge = x > 0.85 * width
    write(svg, x + (-8.0 if at_edge else 8.0), y + offset, word, "halo strong", "end" if at_edge else "start")


def _largest_offset(track: Sequence[TimedPosition], prints: Sequence[StrideTaken]) -> float:
    """Return the largest horizontal distance of a footprint from the wearer's position at that time, m."""
    times, offsets = [event.t for event in track], [0.0]
    for one in prints:
        k = bisect_left(times, one.t)
        near = track[max(k - 1, 0) : k + 1]
        offsets.append(min([dist(one.position[:2], event.position[:2]) for event in near]))
    return max(offsets)


def _times(svg: Element, report: ReportContent, view: View) -> None:
    """Write up to seven times along the track, without those that would overlap."""
    labelled: list[Point] = []
    times = [(report.clock.axis_value(event.t), event.position[:2]) for event in report.track]
    for value, words in ticks(times[0][0], times[-1][0], 7).items():
        _, nearest = min(times, key=lambda one: abs(one[0] - value))
        x, y = view.at(nearest)
        if all([abs(x - a) > 44.0 or abs(y - b) > 18.0 for a, b in labelled]):
            labelled.append((x, y))
            add(svg, "<circle cx='{}' cy='{}' r='2.4' class='time'/>", x, y)
            write(svg, x, y - 6.0, f"{words} {report.clock.unit}", "halo tick")


def height_figure(parent: Element, report: ReportContent) -> None:
    """Draw the height of each stationary foot over time, m; nothing when it is level."""
    clock, curves = report.clock, {}
    for foot, events in report.walk.standing.items():
        if len(events):
            curves[foot] = [(clock.axis_value(event.t), event.position[2]) for event in events]
    values = [z for curve in curves.values() for _, z in curve]
    if not values or max(values) - min(values) < MIN_RISE:
        return
    what = f"Height of the standing feet over time, {min(values):.2f} to {max(values):.2f} m from where they began."
    title, note = "Height of the feet over time", "Of the foot on the ground, against where it began."
    y, labels = padded_range(values, 1.0), (clock.label, "height, m")
    Chart.of(parent, "height", title, what, clock.span, y, labels, note).curves(curves)


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
        more = f" and {len(rooms) - MAX_ROOMS} more" if len(rooms) > MAX_ROOMS else ""
        notes.append(f"On the way: {', '.join(rooms[:MAX_ROOMS])}{more}.")
    if len(levels) < len(plan.levels):
        notes.append("Levels where the wearer was not are left out.")
    caption(element, "Track on the floor plan", *notes)
    return True
