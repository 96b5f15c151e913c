"""Draws the activities of the wearer over time."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ....types import Activity
from ...tables.svg import px
from ...tables.table import duration_text
from ...tables.words import activity_words
from ..clock import ReportClock
from ..markup import add, figure
from .axes import AxisScale, drawing, grid, ticks, write

ROW_HEIGHT = 20.0
LEFT = 104.0


def activity_figure(parent: Element, spans: list[tuple[float, float, Activity]], clock: ReportClock) -> bool:
    """Draw a row for every activity, with a bar for every time span of it; return False without activities."""
    rows = [activity for activity in Activity if any(spanned is activity for _, _, spanned in spans)]
    if not rows:
        return False
    height = 8.0 + ROW_HEIGHT * len(rows) + 42.0
    totals = {row: sum([end - start for start, end, spanned in spans if spanned is row]) for row in rows}
    texts = "; ".join([f"{activity_words(row)} {duration_text(totals[row])}" for row in rows])
    svg = drawing("activities", "Activities over time", f"How long in all: {texts}.", height)
    x = AxisScale(*clock.span, LEFT, 390.0)
    bottom = 8.0 + ROW_HEIGHT * len(rows)
    lines = grid(svg, x, AxisScale(0.0, 1.0, bottom, 8.0), ticks(*clock.span, 6), [])
    for k, activity in enumerate(rows):
        y = 8.0 + ROW_HEIGHT * k
        lines.set("d", f"{lines.get('d')}M{px(LEFT)} {px(y + ROW_HEIGHT)}H390")
        write(svg, LEFT - 6.0, y + 14.0, activity_words(activity), "tick", "end")
        bars = []
        for t_start, t_end, spanned in spans:
            if spanned is activity:
                start, end = x.at(clock.axis_value(t_start)), x.at(clock.axis_value(t_end))
                bars.append(
                    f"M{px(start)} {px(y + 4.0)}H{px(max(end, start + 0.6))}v{px(ROW_HEIGHT - 8.0)}H{px(start)}z"
                )
        add(svg, "path", d="".join(bars), class_="bar")
    write(svg, 0.5 * (LEFT + 390.0), bottom + 35.0, clock.label, "label", "middle")
    figure(parent, svg, "Activities over time")
    return True
