"""Draws the activities of the wearer over time."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ....types import Activity
from ...tables.svg import AxisScale, add, grid, ticks, write
from ...tables.table import duration_text
from ...tables.words import activity_words
from ..clock import ReportClock
from ..markup import figure

ROW_HEIGHT = 20.0
LEFT, RIGHT, TOP = 104.0, 390.0, 8.0


def activity_figure(parent: Element, spans: list[tuple[float, float, Activity]], clock: ReportClock) -> None:
    """Draw a row for every activity, with a bar for every time span of it; nothing without activities."""
    rows = {activity: [(a, b) for a, b, one in spans if one is activity] for activity in Activity}
    rows = {activity: found for activity, found in rows.items() if found}
    if not rows:
        return
    texts = [f"{activity_words(one)} {duration_text(sum([b - a for a, b in rows[one]]))}" for one in rows]
    bottom = TOP + ROW_HEIGHT * len(rows)
    what = f"How long in all: {'; '.join(texts)}."
    svg = figure(parent, "activities", "Activities over time", what, bottom + 42.0)
    x = AxisScale(*clock.span, LEFT, RIGHT)
    grid(svg, x, AxisScale(0.0, 1.0, bottom, TOP), ticks(*clock.span), {})
    for k, (activity, found) in enumerate(rows.items()):
        top = TOP + ROW_HEIGHT * k
        add(svg, "<path d='M{} {}H{}' class='grid'/>", LEFT, top + ROW_HEIGHT, RIGHT)
        write(svg, LEFT - 6.0, top + 14.0, activity_words(activity), "tick", "end")
        for times in found:
            start, end = [x(clock.axis_value(t)) for t in times]
            bar = "<rect x='{}' y='{}' width='{}' height='12' class='bar'/>"
            add(svg, bar, start, top + 4.0, max(end - start, 0.6))
    write(svg, 0.5 * (LEFT + RIGHT), bottom + 35.0, clock.label, "label")
