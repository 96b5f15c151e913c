"""Draws the axes of a figure, and what charts have in common: curves, marks, a legend of the feet."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from xml.etree.ElementTree import Element

from attrs import define

from ....types import Foot
from ...tables.svg import AxisScale, Point, add, line, px, ticks
from ..markup import WIDTH, figure

LEFT, RIGHT, TOP, BOTTOM = 46.0, 12.0, 26.0, 40.0
"""Left, right, top and bottom margins of a chart, px."""
HEIGHT = 190.0
"""Height of a chart, px."""
MARGIN_SHARE = 0.06
"""Margin at each end of an axis, as a share of its range."""
FOOT_MARKS = {Foot.LEFT: "h0", Foot.RIGHT: "m-2.6-2.6l5.2 5.2m0-5.2l-5.2 5.2"}
"""SVG shapes of the marks of the left foot, a disc, and of the right one, a cross."""


def padded_range(values: Sequence[float], least: float) -> tuple[float, float]:
    """Return the ends of an axis, at least `least` apart: the lowest and the highest value, with a margin."""
    low, high = min(values), max(values)
    half = (0.5 + MARGIN_SHARE) * max(high - low, least)
    return 0.5 * (low + high) - half, 0.5 * (low + high) + half


def write(parent: Element, x: float, y: float, words: str, kind: str, anchor: str = "middle") -> None:
    """Write words at (x, y), px; `kind` holds classes of the style sheet."""
    add(parent, "text", words, x=x, y=y, class_=kind, text_anchor=anchor)


def marks(svg: Element, points: Iterable[Point], shape: str, kind: str) -> None:
    """Draw the same shape at every point, px."""
    add(svg, "path", d=[f"M{px(x)} {px(y)}{shape}" for x, y in points], class_=kind)


def grid(svg: Element, x: AxisScale, y: AxisScale, across: Mapping[float, str], up: Mapping[float, str]) -> None:
    """Draw a grid at the values `across` of x and `up` of y, with their labels beside the axes."""
    lines = [("M", x(value), y.end, "V", y.start) for value in across]
    lines += [("M", x.start, y(value), "H", x.end) for value in up]
    add(svg, "path", d=[part for one in lines for part in one], class_="grid")
    for value, words in across.items():
        write(svg, x(value), y.start + 16.0, words, "tick")
    for value, words in up.items():
        write(svg, x.start - 5.0, y(value) + 4.0, words, "tick", "end")


@define
class Chart:
    """A drawing with two axes; `x` and `y` transform values to px."""

    svg: Element
    x: AxisScale
    y: AxisScale

    @classmethod
    def of(
        cls,
        parent: Element,
        name: str,
        title: str,
        what: str,
        ranges: tuple[tuple[float, float], tuple[float, float]],
        labels: tuple[str, str],
        *notes: str,
    ) -> Chart:
        """Add a figure with a grid from the ranges of its axes and their labels, x first."""
        svg = figure(parent, name, title, what, HEIGHT, *notes)
        x, y = AxisScale(*ranges[0], LEFT, WIDTH - RIGHT), AxisScale(*ranges[1], HEIGHT - BOTTOM, TOP)
        grid(svg, x, y, ticks(*ranges[0], 6), ticks(*ranges[1], 5))
        write(svg, 0.5 * (x.start + x.end), HEIGHT - 5.0, labels[0], "label")
        write(svg, 2.0, 12.0, labels[1], "label", "start")
        return cls(svg, x, y)

    def curves(self, curves: Mapping[Foot, Sequence[Point]]) -> None:
        """Draw a line through the points of each foot, in values of the axes, and the legend."""
        for foot, points in curves.items():
            self.curve(points, foot)
        self.legend(list(curves), lines=True)

    def curve(self, points: Iterable[Point], foot: Foot) -> None:
        """Draw a line through points, in values of the axes, in the colour of a foot."""
        add(self.svg, "path", d=line([(self.x(x), self.y(y)) for x, y in points]), class_=f"line {foot}")

    def marks(self, points: Iterable[Point], foot: Foot, kind: str = "mark") -> None:
        """Draw the mark of a foot at every point, in values of the axes."""
        marks(self.svg, [(self.x(x), self.y(y)) for x, y in points], FOOT_MARKS[foot], f"{kind} {foot}")

    def legend(self, feet: Sequence[Foot], *, lines: bool = False) -> None:
        """Draw the mark or, with `lines`, the line of each foot above the chart, at its right end."""
        for k, foot in enumerate(reversed(feet)):
            x = 390.0 - 66.0 * k
            write(self.svg, x, 12.0, foot.value, "tick", "end")
            shape, kind = ("m-20 0h20", "line") if lines else (FOOT_MARKS[foot], "mark")
            marks(self.svg, [(x - 36.0, 8.0)], shape, f"{kind} {foot}")
