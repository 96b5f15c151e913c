"""Draws stride length, stride time and speed of each foot over time."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from ....events import GaitCycleMeasured
from ....types import Foot
from ...tables.plan import px
from ..clock import ReportClock
from ..markup import add, figure
from .axes import Chart, around, drawing, write

HEIGHT = 190.0
DISC_MARK, CROSS_MARK = "h0", "m-2.6-2.6l5.2 5.2m0-5.2l-5.2 5.2"
"""Marks of the left and the right foot, which differ without colours too."""
FOOT_MARKS = {Foot.LEFT: DISC_MARK, Foot.RIGHT: CROSS_MARK}
MAX_SINGLE_MARKS = 240
"""Number of strides of a foot above which its marks would hide one another."""
MIN_TURN = 0.35
"""Turn above which a stride is marked as one in a turn, rad (20 degrees)."""


MIN_RANGE = 0.2
"""Smallest range of an axis, in its unit."""
PANELS = (("stride_length", "Stride length", "m"), ("stride_time", "Stride time", "s"), ("speed", "Speed", "m/s"))


def stride_figures(parent: Element, strides: dict[Foot, list[GaitCycleMeasured]], clock: ReportClock) -> bool:
    """Draw a chart for each of the three; return False when there are no strides."""
    if not any(strides.values()):
        return False
    for name, title, unit in PANELS:
        known = {
            foot: [(one, getattr(one, name)) for one in some if getattr(one, name) is not None]
            for foot, some in strides.items()
        }
        if any(known.values()):
            _panel(parent, title, unit, known, clock)
    every = [one for some in strides.values() for one in some]
    notes = ["faint, strides that do not count in the table"] if any(not one.steady for one in every) else []
    notes += ["ticks at the bottom, strides in a turn"] if any(map(is_in_turn, every)) else []
    notes += ["ticks at the top, samples missing or saturated"] if any(one.degraded for one in every) else []
    notes += ["lines, means"] if any(map(is_dense, strides.values())) else []
    if notes:
        add(parent, "p", f"In the figures of strides: {'; '.join(notes)}.", class_="note")
    return True


def is_in_turn(one: GaitCycleMeasured) -> bool:
    """Return whether a stride is marked as one in a turn."""
    return one.turning_angle is not None and abs(one.turning_angle) > MIN_TURN


def is_dense(some: Sequence[object]) -> bool:
    """Return whether the marks of so many strides would hide one another."""
    return len(some) > MAX_SINGLE_MARKS


def group_means(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return means of as many consecutive points as give some 60 points in all."""
    count = max(len(points) // 60, 1)
    groups = [points[k : k + count] for k in range(0, len(points), count)]
    return [(sum([x for x, _ in one]) / len(one), sum([y for _, y in one]) / len(one)) for one in groups]


def _panel(
    parent: Element, title: str, unit: str, known: dict[Foot, list[tuple[GaitCycleMeasured, float]]], clock: ReportClock
) -> None:
    values = [value for some in known.values() for _, value in some]
    what = f"{title} of every stride over time: {len(values)} strides, {min(values):.2f} to {max(values):.2f} {unit}."
    svg = drawing(f"stride-{title.split()[-1].lower()}", f"{title} over time", what, HEIGHT)
    if any(map(is_dense, known.values())):
        svg.set("class", "dense")
    chart = Chart.of(
        svg, clock.span, around(values, least=MIN_RANGE), (clock.label, f"{title.lower()}, {unit}"), HEIGHT
    )
    for foot, some in known.items():
        for counted in (False, True):
            points = [(clock.of(one.t), value) for one, value in some if one.steady is counted]
            chart.marks(points, FOOT_MARKS[foot], f"mark {foot}{'' if counted else ' faint'}")
        if is_dense(some):
            chart.path(group_means([(clock.of(one.t), value) for one, value in some if one.steady]), f"line {foot}")
    every = [pair for some in known.values() for pair in some]
    turning = [clock.of(one.t) for one, _ in every if is_in_turn(one)]
    if turning:
        bottom = chart.y.start
        add(svg, "path", class_="turn", d="".join([f"M{px(chart.x.at(t))} {px(bottom)}v-7" for t in turning]))
    degraded = [clock.of(one.t) for one, _ in every if one.degraded]
    if degraded:
        add(svg, "path", class_="missing", d="".join([f"M{px(chart.x.at(t))} {px(chart.y.end)}v5" for t in degraded]))
    legend(svg, [foot for foot in Foot if known.get(foot)])
    figure(parent, svg, f"{title} over time")


def legend(svg: Element, feet: Sequence[Foot], *, lines: bool = False) -> None:
    """Draw which mark or line is of which foot, above a chart at the right: left solid, right dashed."""
    x = 390.0
    for foot in reversed(feet):
        write(svg, x, 12.0, foot.value, "tick", "end")
        x -= 5.6 * len(foot.value) + 8.0
        if lines:
            add(svg, "path", class_=f"line {foot}", d=f"M{px(x - 20.0)} 8h20")
            x -= 30.0
        else:
            add(svg, "path", class_=f"mark {foot}", d=f"M{px(x)} 8{FOOT_MARKS[foot]}")
            x -= 12.0
