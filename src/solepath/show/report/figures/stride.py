"""Draws stride length, stride time and speed of each foot over time. Limits were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from ....events import GaitCycleMeasured
from ....types import Foot
from ...tables.svg import add
from ..clock import ReportClock
from ..markup import notes
from .axes import FOOT_MARKS, MARK, Chart, padded_range

MAX_SINGLE_MARKS = 480
"""Number of strides above which the marks would hide one another, so that they are thin."""
MIN_TURN = 0.35
"""Turning angle, either way, above which a stride is marked as one in a turn, rad (20 degrees)."""
MIN_RANGE = 0.2
"""Smallest range of the y axis, in its unit."""
PANELS = (("stride_length", "Stride length", "m"), ("stride_time", "Stride time", "s"), ("speed", "Speed", "m/s"))


def stride_figures(parent: Element, strides: Sequence[GaitCycleMeasured], clock: ReportClock) -> None:
    """Draw a chart for each of PANELS, and below them what their marks mean."""
    for name, title, unit in PANELS:
        pairs = [(one, value) for one in strides if (value := getattr(one, name)) is not None]
        if pairs:
            _panel(parent, title, unit, pairs, clock)
    words = ["faint, not in the table"] if not all([one.steady for one in strides]) else []
    words += ["ticks at the bottom, in a turn"] if any(map(is_in_turn, strides)) else []
    words += ["ticks at the top, degraded"] if any([one.degraded for one in strides]) else []
    notes(parent, [f"Strides: {'; '.join(words)}."] if words else [])


def is_in_turn(stride: GaitCycleMeasured) -> bool:
    """Return whether a stride is marked as one in a turn."""
    return abs(stride.turning_angle or 0.0) > MIN_TURN


def _panel(
    parent: Element, title: str, unit: str, pairs: Sequence[tuple[GaitCycleMeasured, float]], clock: ReportClock
) -> None:
    """Draw one parameter over time."""
    values = [value for _, value in pairs]
    what = f"{title} of every stride over time: {len(values)} strides, {min(values):.2f} to {max(values):.2f} {unit}."
    labels = clock.label, f"{title.lower()}, {unit}"
    name = f"stride-{title.split()[-1].lower()}"
    chart = Chart.of(parent, name, f"{title} over time", what, clock.span, padded_range(values, MIN_RANGE), labels)
    chart.svg.set("class", "dense" if len(pairs) > MAX_SINGLE_MARKS else "")
    for stride, value in pairs:
        t = clock.axis_value(stride.t)
        kind = "mark" if stride.steady else "faint mark"
        add(chart.svg, MARK, chart.x(t), chart.y(value), FOOT_MARKS[stride.foot], kind, stride.foot.value)
        if is_in_turn(stride):
            add(chart.svg, "<path d='M{} {}v-7' class='turn'/>", chart.x(t), chart.y.start)
        if stride.degraded:
            add(chart.svg, "<path d='M{} {}v5' class='missing'/>", chart.x(t), chart.y.end)
    chart.legend([foot for foot in Foot if foot in {stride.foot for stride, _ in pairs}])
