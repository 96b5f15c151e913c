"""Draws the distance of each minute of a six-minute walk."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element

from ...tables.svg import px
from ..markup import add, figure
from .axes import Chart, drawing, padded_range, write

HEIGHT = 190.0
BAR_SHARE = 0.7
"""Width of a bar as a share of a minute."""


def minutes_figure(parent: Element, minutes: Sequence[float]) -> bool:
    """Draw a bar for the distance, m, of each whole minute; return False without any."""
    if not minutes:
        return False
    texts = ", ".join([f"{distance:.1f} m" for distance in minutes])
    svg = drawing("minutes", "Distance of each minute", f"Distances of the minutes in order: {texts}.", HEIGHT)
    spans = (0.5, len(minutes) + 0.5), padded_range(minutes, least=1.0, zero=True)
    chart = Chart.of(svg, *spans, ("minute", "distance, m"), HEIGHT)
    bars = add(svg, "path", class_="bar")
    paths = []
    for minute, distance in enumerate(minutes, start=1):
        left, top = chart.at(minute - 0.5 * BAR_SHARE, distance)
        right = chart.x.at(minute + 0.5 * BAR_SHARE)
        paths.append(f"M{px(left)} {px(chart.y.start)}V{px(top)}H{px(right)}V{px(chart.y.start)}z")
        write(svg, 0.5 * (left + right), top + 12.0, f"{distance:.0f}", "onbar", "middle")
    bars.set("d", "".join(paths))
    figure(parent, svg, "Distance of each minute")
    return True
