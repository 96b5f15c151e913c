"""Draws the wearer's track from above, on the floor plan when there is one, and the height of the feet.

Sizes and limits were chosen by hand and not swept."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from math import fsum
from xml.etree.ElementTree import Element

from attrs import evolve

from ....events import FootMoved, Placed, PlaceLost, StrideTaken, WearerMoved
from ....floorplan.plan import FloorPlan
from ....types import Foot
from ...tables.plan import PANEL_GAP, PlanPicture
from ...tables.svg import px
from ..clock import ReportClock
from ..markup import add, figure
from .axes import WIDTH, AxisScale, Chart, Point, drawing, grid, line, marks, padded_range, tick_labels, ticks, write
from .stride import FOOT_MARKS, legend

MAX_FOOTPRINTS = 160
"""Largest number of footprints, the positions of foot-flats, that are drawn; more would hide the track."""
MAX_HEIGHT = 420.0
"""Largest height of the drawing of a track, px."""
WIDE_WIDTH, MAX_WIDE_HEIGHT = 840.0, 440.0
"""Width and largest height of the drawing for wide screens and paper, px."""
MAX_ROOMS = 12
"""Largest number of rooms that are named below the plan."""
MIN_RISE = 0.5
"""Least range of heights that is drawn over time, m; below it the way is level."""
MAX_OFFSET = 1.2
"""Distance of a footprint from the wearer's track above which no footprints are drawn, m: the tracks drift apart."""
MIN_EXTENT = 4.0
"""Least width that the drawing shows, m, so that standing still is not magnified."""
MARGIN_SHARE, MIN_MARGIN = 0.06, 0.4
"""Margin around the track: as a share of its larger extent, and the least, m."""
MIN_ASPECT = 0.34
"""Least height of what the drawing shows, as a share of its width."""

TimedPosition = FootMoved | StrideTaken | WearerMoved
"""Event with the position of a foot or the wearer, world frame, m."""
FootPositions = Mapping[Foot, Sequence[TimedPosition]]


def track_figure(
    parent: Element,
    track: Sequence[TimedPosition],
    footprints: FootPositions,
    clock: ReportClock,
    *,
    wide: bool = True,
    name: str = "track",
    title: str = "Track from above",
) -> bool:
    """Draw the track from above, x to the right and y up; return False when there is none.

    `track` is the wearer's or, if that is not known, the track of a foot. A `wide` figure also holds a drawing for wide
    screens and for paper."""
    if len(track) < 2:
        return False
    is_few = sum([len(prints) for prints in footprints.values()]) <= MAX_FOOTPRINTS  # whole numbers
    offset = _largest_offset(track, footprints)
    shown_prints = footprints if is_few and offset <= MAX_OFFSET else {}
    notes = ["x along the first heading; the numbers along the way are times."]
    if any(shown_prints.values()):
        notes.append("\N{BLACK CIRCLE} where the left foot stood, \N{MULTIPLICATION SIGN} the right one.")
    if offset > MAX_OFFSET:
        notes.append(f"The tracks of the single feet come to lie up to {offset:.1f} m off it and are not shown.")
    narrow = _drawn(name, title, track, shown_prints, clock, WIDTH, MAX_HEIGHT)
    element = figure(parent, narrow, title, *notes)
    if wide:
        narrow.set("class", "narrow")
        drawn = _drawn(f"{name}-wide", title, track, shown_prints, clock, WIDE_WIDTH, MAX_WIDE_HEIGHT)
        drawn.set("class", "wide")
        element.insert(0, drawn)
    return True


def _drawn(
    name: str,
    title: str,
    track: Sequence[TimedPosition],
    footprints: FootPositions,
    clock: ReportClock,
    width: float,
    max_height: float,
) -> Element:
    """Return a drawing of a track, `width` px wide and at most `max_height` px high."""
    shown = [*track, *(event for prints in footprints.values() for event in prints)]
    xs, ys = [event.position[0] for event in shown], [event.position[1] for event in shown]
    across, up = max(xs) - min(xs), max(ys) - min(ys)
    margin = max(MARGIN_SHARE * max(across, up), MIN_MARGIN)
    middle = 0.5 * (min(xs) + max(xs)), 0.5 * (min(ys) + max(ys))
    width_m = max(across + 2.0 * margin, MIN_EXTENT)
    top, left, right, bottom = 16.0, 40.0, 8.0, 38.0
    inner_width = width - left - right
    height_m = max(up + 2.0 * margin, MIN_ASPECT * width_m * WIDTH / width)
    scale = min(inner_width / width_m, (max_height - top - bottom) / height_m)
    width_m, height = inner_width / scale, height_m * scale + top + bottom
    x = AxisScale(middle[0] - 0.5 * width_m, middle[0] + 0.5 * width_m, left, width - right)
    y = AxisScale(middle[1] - 0.5 * height_m, middle[1] + 0.5 * height_m, height - bottom, top)
    length = fsum([_distance(a, b) for a, b in zip(track, track[1:], strict=False)])
    what = f"The track from above, {across:.1f} m by {up:.1f} m, {length:.0f} m long as drawn."
    svg = drawing(name, title, what, height, width)
    _grid(svg, x, y)

    def point_of(event: TimedPosition) -> Point:
        return x.at(event.position[0]), y.at(event.position[1])

    add(svg, "path", d=line([point_of(event) for event in track]), class_="way")
    for foot, prints in footprints.items():
        if d := marks([point_of(event) for event in prints], FOOT_MARKS[foot]):
            add(svg, "path", d=d, class_=f"mark {foot}")
    _times(svg, track, point_of, clock)
    for event, word, offset_y in ((track[0], "start", -8.0), (track[-1], "end", 17.0)):
        a, b = point_of(event)
        add(svg, "circle", cx=px(a), cy=px(b), r="4.5", class_=word)
        offset_x, anchor = (-8.0, "end") if a > 0.85 * width else (8.0, "start")
        write(svg, a + offset_x, b + offset_y, word, "halo strong", anchor)
    return svg


def _largest_offset(track: Sequence[TimedPosition], footprints: FootPositions) -> float:
    """Return the largest horizontal distance of a footprint from the wearer's position at that time, m."""
    times, largest = [event.t for event in track], 0.0
    for footprint in [event for prints in footprints.values() for event in prints] if track else []:
        k = bisect_left(times, footprint.t)
        largest = max(
            largest, min([_distance(footprint, event) for event in track[max(k - 1, 0) : k + 1]], default=0.0)
        )
    return largest


def _distance(a: TimedPosition, b: TimedPosition) -> float:
    (x, y, _), (x1, y1, _) = a.position, b.position
    dx, dy = x1 - x, y1 - y
    return float((dx * dx + dy * dy) ** 0.5)


def _grid(svg: Element, x: AxisScale, y: AxisScale) -> None:
    """Draw a grid with the same spacing on both axes."""
    marked = ticks(x.low, x.high, 8)
    step = marked[1] - marked[0] if len(marked) > 1 else 1.0
    up = [k * step for k in range(int(y.low // step) + 1, int(y.high // step) + 1)]
    grid(svg, x, y, marked, up)
    write(svg, 0.5 * (x.start + x.end), y.start + 33.0, "x and y, m", "label", "middle")


def _times(
    svg: Element, track: Sequence[TimedPosition], point_of: Callable[[TimedPosition], Point], clock: ReportClock
) -> None:
    """Write up to seven times along the track, without those that would overlap."""
    if len(track) < 3:
        return
    tick_times = ticks(clock.axis_value(track[0].t), clock.axis_value(track[-1].t), 7)
    unit = "min" if clock.per_unit > 1.0 else "s"
    labelled: list[Point] = []
    for value, words in zip(tick_times, tick_labels(tick_times), strict=True):
        nearest = min(track, key=lambda event: abs(clock.axis_value(event.t) - value))
        a, b = point_of(nearest)
        if all(abs(a - c) > 44.0 or abs(b - d) > 18.0 for c, d in labelled):
            labelled.append((a, b))
            add(svg, "circle", cx=px(a), cy=px(b), r="2.4", class_="time")
            write(svg, a, b - 6.0, f"{words} {unit}", "halo tick", "middle")


def height_figure(parent: Element, heights: FootPositions, clock: ReportClock) -> bool:
    """Draw the height of each stationary foot over time, m; return False when it is level."""
    curves = {foot: events for foot, events in heights.items() if len(events) > 1}
    if not curves:
        return False
    values = [event.position[2] for events in curves.values() for event in events]
    if max(values) - min(values) < MIN_RISE:
        return False
    what = f"Height of the standing feet over time, {min(values):.2f} to {max(values):.2f} m from where they began."
    svg = drawing("height", "Height over time", what, 180.0)
    chart = Chart.of(svg, clock.span, padded_range(values, least=1.0), (clock.label, "height, m"), 180.0)
    for foot, events in curves.items():
        chart.path([(clock.axis_value(event.t), event.position[2]) for event in events], f"line {foot}")
    legend(svg, list(curves), lines=True)
    figure(parent, svg, "Height of the feet over time", "Of the foot on the ground, against where it began.")
    return True


def plan_figure(parent: Element, plan: FloorPlan, events: Sequence[Placed | PlaceLost]) -> bool:
    """Draw the track on the floor plan, as `solepath track` does; return False when there is no place.

    Only the levels where the wearer was are shown."""
    places = [event for event in events if isinstance(event, Placed)]
    if not places:
        return False
    visited = {place.level for place in places}
    levels = tuple([level for level in plan.levels if level.id in visited])
    shown = evolve(plan, levels=levels) if levels else plan
    wide, narrow = [_plan_picture(shown, events, *size) for size in ((WIDE_WIDTH, 440.0, 2), (380.0, 420.0, 1))]
    wide.set("class", "plan wide")
    narrow.set("class", "plan narrow")
    notes = ["Colours go from the start to the end; dots are candidates, the fainter the less likely."]
    rooms = list(dict.fromkeys([place.room for place in places if place.room and len(place.candidates) == 1]))
    if rooms:
        more = f" and {len(rooms) - MAX_ROOMS} more" if len(rooms) > MAX_ROOMS else ""
        notes.append(f"On the way: {', '.join(rooms[:MAX_ROOMS])}{more}.")
    if len(levels) < len(plan.levels):
        notes.append("Levels where the wearer was not are left out.")
    figure(parent, narrow, "Track on the floor plan", *notes).insert(0, wide)
    return True


def _plan_picture(
    plan: FloorPlan, events: Sequence[Placed | PlaceLost], width: float, height: float, columns: int
) -> Element:
    """Return the drawing of the places on the plan, with at most so many levels side by side."""
    columns = min(columns, max(len(plan.levels), 1))
    level_width = (width - (columns - 1) * PANEL_GAP) / columns
    picture = PlanPicture(plan, events, width=level_width, height=height, columns=columns)
    svg = picture.drawn(plan.name or "Floor plan")
    svg.set("role", "img")
    for name in ("xmlns", "width", "height", "font-family"):
        del svg.attrib[name]
    svg.set("id", f"solepath-plan-{columns}-{width:.0f}")
    return svg
