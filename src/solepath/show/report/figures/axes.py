"""Draws the axes of a figure, and what charts have in common: curves, marks, a legend of the feet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.etree.ElementTree import Element

from attrs import define

from ....types import Foot
from ...tables.svg import AxisScale, Point, add, grid, line, ticks, write
from ..markup import WIDTH, figure

LEFT, RIGHT, TOP, BOTTOM = 46.0, 18.0, 30.0, 40.0
"""Left, right, top and bottom margins of a chart, px."""
HEIGHT = 194.0
"""Height of a chart, px."""
HEAD = 16.0
"""Baseline of the words above a chart, px: below the top of letters of 19 px, which paper has."""
MARGIN_SHARE = 0.06
"""Margin at each end of an axis, as a share of its range."""
FOOT_MARKS = {Foot.LEFT: "h0", Foot.RIGHT: "m-2.6-2.6l5.2 5.2m0-5.2l-5.2 5.2"}
"""SVG shapes of the marks of the left foot, a disc, and of the right one, a cross."""
PATH, MARK = "<path d='{}' class='{}'/>", "<path d='M{} {}{}' class='{} {}'/>"


def padded_range(values: Sequence[float], least: float) -> Point:
    """Return the ends of an axis, at least `least` apart: the lowest and the highest value, with a margin."""
    low, high = min(values), max(values)
    half = (0.5 + MARGIN_SHARE) * max(high - low, least)
    return 0.5 * (low + high) - half, 0.5 * (low + high) + half


@define
class Chart:
    """A drawing with two axes; `x` and `y` transform values to px."""

    svg: Element
    x: AxisScale
    y: AxisScale

    @classmethod
    def of(
        cls, parent: Element, name: str, title: str, what: str, x: Point, y: Point, labels: Sequence[str], *notes: str
    ) -> Chart:
        """Add a figure with a grid from the ranges of its axes and their labels, x first."""
        svg = figure(parent, name, title, what, HEIGHT, *notes)
        chart = cls(svg, AxisScale(*x, LEFT, WIDTH - RIGHT), AxisScale(*y, HEIGHT - BOTTOM, TOP))
        grid(svg, chart.x, chart.y, ticks(*x, 6), ticks(*y, 5))
        write(svg, 0.5 * (LEFT + WIDTH - RIGHT), HEIGHT - 5.0, labels[0], "label")
        write(svg, 2.0, HEAD, labels[1], "label", "start")
        return chart

    def curves(self, curves: Mapping[Foot, Sequence[Point]]) -> None:
        """Draw a line through the points of each foot, in values of the axes, and the legend."""
        for foot, points in curves.items():
            add(self.svg, PATH, line([(self.x(x), self.y(y)) for x, y in points]), f"line {foot}")
        self.legend(list(curves), "m-20 0h20", "line")

    def legend(self, feet: Sequence[Foot], shape: str = "", kind: str = "mark") -> None:
        """Draw the mark of each foot, or another shape, above the chart, at its right end."""
        for k, foot in enumerate(reversed(feet)):
            x = 390.0 - 66.0 * k
            write(self.svg, x, HEAD, foot.value, "tick", "end")
            add(self.svg, MARK, x - 41.0, HEAD - 4.0, shape or FOOT_MARKS[foot], kind, foot.value)
