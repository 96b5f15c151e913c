"""Draws stride length, stride time and speed of each foot over time. Limits were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from operator import attrgetter
from xml.etree.ElementTree import Element

from ....events import GaitCycleMeasured
from ....types import Foot
from ...tables.svg import Point, add, marks
from ..clock import ReportClock
from ..markup import notes
from .axes import PATH, Chart, padded_range

MAX_SINGLE_MARKS = 240
"""Number of strides of a foot above which the marks would hide one another."""
MIN_TURN = 0.35
"""Turning angle, either way, above which a stride is marked as one in a turn, rad (20 degrees)."""
MIN_RANGE = 0.2
"""Smallest range of the y axis, in its unit."""
PANELS = (("stride_length", "Stride length", "m"), ("stride_time", "Stride time", "s"), ("speed", "Speed", "m/s"))

Values = list[tuple[GaitCycleMeasured, float]]
"""Strides with the value of one parameter."""


def stride_figures(parent: Element, strides: Mapping[Foot, Sequence[GaitCycleMeasured]], clock: ReportClock) -> None:
    """Draw a chart for each of PANELS, and below them what their marks mean."""
    for name, title, unit in PANELS:
        values: dict[Foot, Values] = {}
        for foot in strides:
            values[foot] = [(one, value) for one in strides[foot] if (value := getattr(one, name)) is not None]
        if any(values.values()):
            _panel(parent, title, unit, {foot: found for foot, found in values.items() if found}, clock)
    all_strides = [one for foot_strides in strides.values() for one in foot_strides]
    shown = {
        "faint, not in the table": not all([one.steady for one in all_strides]),
        "ticks at the bottom, in a turn": any(map(is_in_turn, all_strides)),
        "ticks at the top, degraded": any([one.degraded for one in all_strides]),
        "lines, means": any(map(is_dense, strides.values())),
    }
    if any(shown.values()):
        notes(parent, [f"Strides: {'; '.join([words for words, is_shown in shown.items() if is_shown])}."])


def is_in_turn(stride: GaitCycleMeasured) -> bool:
    """Return whether a stride is marked as one in a turn."""
    return abs(stride.turning_angle or 0.0) > MIN_TURN


def is_dense(strides: Sequence[object]) -> bool:
    """Return whether there are so many strides that their marks would hide one another."""
    return len(strides) > MAX_SINGLE_MARKS


def group_means(points: Sequence[Point]) -> list[Point]:
    """Return the mean points of groups of consecutive points; there are some 60 groups, or one for each point."""
    size = max(len(points) // 60, 1)
    groups = [points[k : k + size] for k in range(0, len(points), size)]
    return [(sum([x for x, _ in group]) / len(group), sum([y for _, y in group]) / len(group)) for group in groups]


def _panel(parent: Element, title: str, unit: str, pairs: Mapping[Foot, Values], clock: ReportClock) -> None:
    """Draw one parameter over time."""
    values = [value for foot_pairs in pairs.values() for _, value in foot_pairs]
    what = f"{title} of every stride over time: {len(values)} strides, {min(values):.2f} to {max(values):.2f} {unit}."
    labels = clock.label, f"{title.lower()}, {unit}"
    name = f"stride-{title.split()[-1].lower()}"
    chart = Chart.of(parent, name, f"{title} over time", what, clock.span, padded_range(values, MIN_RANGE), labels)
    if any(map(is_dense, pairs.values())):
        chart.svg.set("class", "dense")
    for foot, foot_pairs in pairs.items():
        points = {kind: [(clock.axis_value(one.t), value) for one, value in foot_pairs if one.steady is kind]
                  for kind in (False, True)}  # fmt: skip
        chart.marks(points[False], foot, "faint mark")
        chart.marks(points[True], foot)
        if is_dense(foot_pairs):
            chart.curve(group_means(points[True]), foot)
    for kind, shape, y, is_marked in (
        ("turn", "v-7", chart.y.start, is_in_turn),
        ("missing", "v5", chart.y.end, attrgetter("degraded")),
    ):
        found = [one.t for foot_pairs in pairs.values() for one, _ in foot_pairs if is_marked(one)]
        add(chart.svg, PATH, marks([(chart.x(clock.axis_value(t)), y) for t in found], shape), kind)
    chart.legend(list(pairs))
