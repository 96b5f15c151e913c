"""Draws the wearer's track from above, on the floor plan when there is one, and its height."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from xml.etree.ElementTree import Element

from attrs import evolve

from ....events import FootMoved, Placed, PlaceLost, StrideTaken, WearerMoved
from ....floorplan.plan import FloorPlan
from ....types import Foot
from ...tables.plan import PlanPicture, px
from ..clock import ReportClock
from ..markup import add, figure
from .axes import WIDTH, AxisScale, Chart, Point, around, drawing, grid, line, marks, tick_labels, ticks, write
from .stride import FOOT_MARKS, legend

MAX_FOOTPRINTS = 160
"""Footprints that are drawn at the most: more would hide the track."""
MAX_HEIGHT = 420.0
"""Largest height of the drawing of a track, px."""
MAX_OFFSET = 1.2
"""Largest distance of a stride's foot from the wearer's track, m; more means that the feet's tracks drift apart."""
MIN_EXTENT = 4.0
"""Length that the longer side shows at least, m, so that standing still is not magnified."""


TimedPosition = FootMoved | StrideTaken | WearerMoved
"""Event with a position of a foot or the wearer, and its time."""
FootPositions = Mapping[Foot, Sequence[TimedPosition]]


def track_figure(
    parent: Element, track: Sequence[TimedPosition], footprints: FootPositions, clock: ReportClock
) -> bool:
    """Draw the track from above, x to the right and y up; return False when there is none.

    `track` is the wearer's, or a foot's where only feet are known. `footprints` is where the feet stood."""
    few = sum([len(some) for some in footprints.values()]) <= MAX_FOOTPRINTS
    off = _largest_offset(track, footprints)
    beside = few and off <= MAX_OFFSET
    every = [*track, *(one for some in footprints.values() for one in some if beside)]
    if len(track) < 2:
        return False
    xs, ys = [one.position[0] for one in every], [one.position[1] for one in every]
    across, up = max(xs) - min(xs), max(ys) - min(ys)
    room = max(0.06 * max(across, up), 0.4)
    middle = 0.5 * (min(xs) + max(xs)), 0.5 * (min(ys) + max(ys))
    wide = max(across + 2.0 * room, MIN_EXTENT)
    top, left, right, bottom = 10.0, 34.0, 8.0, 34.0
    inner = WIDTH - left - right
    high = max(up + 2.0 * room, 0.34 * wide)
    scale = min(inner / wide, (MAX_HEIGHT - top - bottom) / high)
    wide, height = inner / scale, high * scale + top + bottom
    x = AxisScale(middle[0] - 0.5 * wide, middle[0] + 0.5 * wide, left, WIDTH - right)
    y = AxisScale(middle[1] - 0.5 * high, middle[1] + 0.5 * high, height - bottom, top)
    length = sum([_distance(a, b) for a, b in zip(track, track[1:], strict=False)])
    what = f"The track from above, {across:.1f} m by {up:.1f} m, {length:.0f} m long as drawn."
    svg = drawing("track", "Track from above", what, height)
    _grid(svg, x, y)

    def at(one: TimedPosition) -> Point:
        return x.at(one.position[0]), y.at(one.position[1])

    add(svg, "path", d=line([at(one) for one in track]), class_="way")
    if beside:
        for foot, some in footprints.items():
            if d := marks([at(one) for one in some], FOOT_MARKS[foot]):
                add(svg, "path", d=d, class_=f"mark {foot}")
    _times(svg, track, at, clock)
    for one, word, below in ((track[0], "start", -6.0), (track[-1], "end", 13.0)):
        a, b = at(one)
        add(svg, "circle", cx=px(a), cy=px(b), r="4.5", class_=word)
        aside, anchor = (-8.0, "end") if a > 0.85 * WIDTH else (8.0, "start")
        write(svg, a + aside, b + below, word, "halo strong", anchor)
    notes = ["x along the first heading; the numbers along the way are times."]
    if beside and any(footprints.values()):
        notes.append("\N{BLACK CIRCLE} where the left foot stood, \N{MULTIPLICATION SIGN} the right one.")
    if off > MAX_OFFSET:
        notes.append(f"The tracks of the single feet come to lie up to {off:.1f} m off it and are not shown.")
    figure(parent, svg, "Track from above", *notes)
    return True


def _largest_offset(track: Sequence[TimedPosition], footprints: FootPositions) -> float:
    """Return the largest distance of a print from the wearer's position at that time, m."""
    times, farthest = [one.t for one in track], 0.0
    for one in [one for some in footprints.values() for one in some] if track else []:
        k = bisect_left(times, one.t)
        farthest = max(farthest, min([_distance(one, other) for other in track[max(k - 1, 0) : k + 1]], default=0.0))
    return farthest


def _distance(a: TimedPosition, b: TimedPosition) -> float:
    (x, y, _), (x1, y1, _) = a.position, b.position
    dx, dy = x1 - x, y1 - y
    return float((dx * dx + dy * dy) ** 0.5)


def _grid(svg: Element, x: AxisScale, y: AxisScale) -> None:
    """Draw the grid with one step for both axes."""
    marked = ticks(x.low, x.high, 8)
    step = marked[1] - marked[0] if len(marked) > 1 else 1.0
    up = [k * step for k in range(int(y.low // step) + 1, int(y.high // step) + 1)]
    grid(svg, x, y, marked, up)
    write(svg, 0.5 * (x.start + x.end), y.start + 29.0, "x and y, m", "label", "middle")


def _times(
    svg: Element, track: Sequence[TimedPosition], at: Callable[[TimedPosition], Point], clock: ReportClock
) -> None:
    """Write a few times along the track."""
    if len(track) < 3:
        return
    tick_times = ticks(clock.of(track[0].t), clock.of(track[-1].t), 7)
    unit = "min" if clock.per_unit > 1.0 else "s"
    taken: list[Point] = []
    for value, words in zip(tick_times, tick_labels(tick_times), strict=True):
        near = min(track, key=lambda one: abs(clock.of(one.t) - value))
        a, b = at(near)
        if all(abs(a - c) > 36.0 or abs(b - d) > 14.0 for c, d in taken):
            taken.append((a, b))
            add(svg, "circle", cx=px(a), cy=px(b), r="2.4", class_="time")
            write(svg, a, b - 6.0, f"{words} {unit}", "halo tick", "middle")


def height_figure(parent: Element, heights: FootPositions, clock: ReportClock) -> bool:
    """Draw the height of the standing foot over time; return False when there is none."""
    known = {foot: some for foot, some in heights.items() if len(some) > 1}
    if not known:
        return False
    values = [one.position[2] for some in known.values() for one in some]
    what = f"Height of the standing feet over time, {min(values):.2f} to {max(values):.2f} m from where they began."
    svg = drawing("height", "Height over time", what, 180.0)
    chart = Chart.of(svg, clock.span, around(values, least=1.0), (clock.label, "height, m"), 180.0)
    for foot, some in known.items():
        chart.path([(clock.of(one.t), one.position[2]) for one in some], f"line {foot}")
    legend(svg, list(known), lines=True)
    figure(parent, svg, "Height of the feet over time", "Of the foot on the ground, against where it began.")
    return True


def plan_figure(parent: Element, plan: FloorPlan, events: Sequence[Placed | PlaceLost]) -> bool:
    """Draw the track on the floor plan, as `solepath track` does; return False when there is no place.

    Only the levels where the wearer was are shown."""
    places = [one for one in events if isinstance(one, Placed)]
    if not places:
        return False
    visited = {one.level for one in places}
    levels = tuple([level for level in plan.levels if level.id in visited])
    shown = evolve(plan, levels=levels) if levels else plan
    picture = PlanPicture(shown, width=380.0, height=420.0, columns=1)
    for one in events:
        picture.add(one)
    svg = picture.drawn(plan.name or "Floor plan")
    svg.set("role", "img")
    svg.set("class", "plan")
    del svg.attrib["xmlns"], svg.attrib["width"], svg.attrib["height"], svg.attrib["font-family"]
    notes = ["Colours go from the start to the end; dots are candidates, the fainter the less they are believed."]
    if len(levels) < len(plan.levels):
        notes.append("Levels where the wearer was not are left out.")
    figure(parent, svg, "Track on the floor plan", *notes)
    return True
