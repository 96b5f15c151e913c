"""Draws stride length, stride time and speed of each foot over time. Limits were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from ....events import GaitCycleMeasured
from ....types import Foot
from ...tables.svg import px
from ..clock import ReportClock
from ..markup import add, figure
from .axes import Chart, drawing, padded_range, write

HEIGHT = 190.0
DISC_MARK, CROSS_MARK = "h0", "m-2.6-2.6l5.2 5.2m0-5.2l-5.2 5.2"
"""SVG shapes of the marks of the left foot and of the right one."""
FOOT_MARKS = {Foot.LEFT: DISC_MARK, Foot.RIGHT: CROSS_MARK}
MAX_SINGLE_MARKS = 240
"""Number of strides of a foot above which the marks would hide one another."""
MIN_TURN = 0.35
"""Turning angle, either way, above which a stride is marked as one in a turn, rad (20 degrees)."""
MIN_RANGE = 0.2
"""Smallest range of the y axis, in its unit."""
PANELS = (("stride_length", "Stride length", "m"), ("stride_time", "Stride time", "s"), ("speed", "Speed", "m/s"))


def stride_figures(parent: Element, strides: dict[Foot, list[GaitCycleMeasured]], clock: ReportClock) -> bool:
    """Draw a chart for each of PANELS; return False when there are no strides."""
    if not any(strides.values()):
        return False
    for name, title, unit in PANELS:
        values = {
            foot: [(stride, getattr(stride, name)) for stride in foot_strides if getattr(stride, name) is not None]
            for foot, foot_strides in strides.items()
        }
        if any(values.values()):
            _panel(parent, title, unit, values, clock)
    all_strides = [stride for foot_strides in strides.values() for stride in foot_strides]
    notes = ["faint, not in the table"] if any(not one.steady for one in all_strides) else []
    notes += ["ticks at the bottom, in a turn"] if any(map(is_in_turn, all_strides)) else []
    notes += ["ticks at the top, degraded"] if any(one.degraded for one in all_strides) else []
    notes += ["lines, means"] if any(map(is_dense, strides.values())) else []
    if notes:
        add(parent, "p", f"Strides: {'; '.join(notes)}.", class_="note")
    return True


def is_in_turn(stride: GaitCycleMeasured) -> bool:
    """Return whether a stride is marked as one in a turn."""
    return stride.turning_angle is not None and abs(stride.turning_angle) > MIN_TURN


def is_dense(strides: Sequence[object]) -> bool:
    """Return whether there are so many strides that their marks would hide one another."""
    return len(strides) > MAX_SINGLE_MARKS


def group_means(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the mean points of groups of consecutive points; there are some 60 groups, or one for each point."""
    size = max(len(points) // 60, 1)
    groups = [points[k : k + size] for k in range(0, len(points), size)]
    return [(sum([x for x, _ in group]) / len(group), sum([y for _, y in group]) / len(group)) for group in groups]


def _panel(
    parent: Element, title: str, unit: str, pairs: dict[Foot, list[tuple[GaitCycleMeasured, float]]], clock: ReportClock
) -> None:
    """Draw one parameter over time from pairs (stride, value)."""
    values = [value for foot_pairs in pairs.values() for _, value in foot_pairs]
    what = f"{title} of every stride over time: {len(values)} strides, {min(values):.2f} to {max(values):.2f} {unit}."
    svg = drawing(f"stride-{title.split()[-1].lower()}", f"{title} over time", what, HEIGHT)
    if any(map(is_dense, pairs.values())):
        svg.set("class", "dense")
    chart = Chart.of(
        svg, clock.span, padded_range(values, least=MIN_RANGE), (clock.label, f"{title.lower()}, {unit}"), HEIGHT
    )
    for foot, foot_pairs in pairs.items():
        for steady in (False, True):
            points = [(clock.axis_value(stride.t), value) for stride, value in foot_pairs if stride.steady is steady]
            chart.marks(points, FOOT_MARKS[foot], f"mark {foot}{'' if steady else ' faint'}")
        if is_dense(foot_pairs):
            chart.path(
                group_means([(clock.axis_value(stride.t), value) for stride, value in foot_pairs if stride.steady]),
                f"line {foot}",
            )
    all_pairs = [pair for foot_pairs in pairs.values() for pair in foot_pairs]
    turning = [clock.axis_value(stride.t) for stride, _ in all_pairs if is_in_turn(stride)]
    if turning:
        bottom = chart.y.start
        add(svg, "path", class_="turn", d="".join([f"M{px(chart.x.at(t))} {px(bottom)}v-7" for t in turning]))
    degraded = [clock.axis_value(stride.t) for stride, _ in all_pairs if stride.degraded]
    if degraded:
        add(svg, "path", class_="missing", d="".join([f"M{px(chart.x.at(t))} {px(chart.y.end)}v5" for t in degraded]))
    legend(svg, [foot for foot in Foot if pairs.get(foot)])
    element = figure(parent, svg, f"{title} over time")
    element.set("class", f"stride-{title.split()[-1].lower()}")


def legend(svg: Element, feet: Sequence[Foot], *, lines: bool = False) -> None:
    """Draw the mark or, with `lines`, the line of each foot above a chart, at its right end."""
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
