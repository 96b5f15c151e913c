"""Draws the distance of each minute of a six-minute walk."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from ...tables.svg import add
from .axes import MARGIN_SHARE, Chart, write

BAR_SHARE = 0.7
"""Width of a bar as a share of a minute."""


def minutes_figure(parent: Element, minutes: Sequence[float]) -> None:
    """Draw a bar for the distance, m, of each whole minute; nothing without any."""
    if not minutes:
        return
    what = f"Distances of the minutes in order: {', '.join([f'{distance:.1f} m' for distance in minutes])}."
    x, y = (0.5, len(minutes) + 0.5), (0.0, (1.0 + MARGIN_SHARE) * max(*minutes, 1.0))
    chart = Chart.of(parent, "minutes", "Distance of each minute", what, x, y, ("minute", "distance, m"))
    for minute, distance in enumerate(minutes, start=1):
        left, right, top = chart.x(minute - 0.5 * BAR_SHARE), chart.x(minute + 0.5 * BAR_SHARE), chart.y(distance)
        bar = "<rect x='{}' y='{}' width='{}' height='{}' class='bar'/>"
        add(chart.svg, bar, left, top, right - left, chart.y.start - top)
        write(chart.svg, chart.x(minute), top + 12.0, f"{distance:.0f}", "onbar")
