"""Draws the axes of a figure: ticks at round numbers, a scale from values to px, a chart with both.

A drawing is 400 px wide and scales with the page: two are side by side on a desktop screen, one on a phone."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import ceil, floor, isfinite, log10
from xml.etree.ElementTree import Element

from attrs import define, frozen

from ...tables.svg import px
from ..markup import add

WIDTH = 400.0
LEFT, RIGHT, TOP, BOTTOM = 46.0, 12.0, 26.0, 40.0
"""Left, right, top and bottom margins of a chart, px."""
MARGIN_SHARE = 0.06
"""Margin at each end of an axis, as a share of its range."""

Point = tuple[float, float]


def ticks(low: float, high: float, most: int = 6) -> list[float]:
    """Return evenly spaced round values within [low, high], at most `most` but at least one.

    Their spacing is 1, 2 or 5 times a power of ten."""
    span = high - low
    if not (isfinite(span) and span > 1e-9 * max(abs(low), abs(high), 1e-300)):
        return [low]
    power = 10.0 ** floor(log10(span / most))
    for multiple in (1.0, 2.0, 5.0, 10.0, 20.0):
        step = multiple * power
        first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
        if last - first < most:
            return [k * step for k in range(first, last + 1)] or [low]
    return [low]


def tick_labels(values: Sequence[float]) -> list[str]:
    """Return labels of ticks, all with the least number of digits that distinguishes them."""
    if len(values) < 2:
        return [f"{value:.3g}" for value in values]
    step = abs(values[1] - values[0])
    digits = min(max(-floor(log10(step) + 1e-9), 0), 9)
    return [f"{value if abs(value) > 1e-9 * step else 0.0:.{digits}f}" for value in values]


def padded_range(values: Iterable[float], *, least: float, zero: bool = False) -> tuple[float, float]:
    """Return the ends of an axis, at least `least` apart: the lowest and the highest value, with a margin.

    With `zero`, 0 is within the axis."""
    known = list(values)
    low, high = min(known, default=0.0), max(known, default=0.0)
    if zero:
        low, high = min(low, 0.0), max(high, 0.0)
    missing = max(least - (high - low), 0.0)
    margin = MARGIN_SHARE * (high - low + missing)
    low, high = low - 0.5 * missing - margin, high + 0.5 * missing + margin
    return (max(low, 0.0) if zero and min(known, default=0.0) >= 0.0 else low), high


@frozen
class AxisScale:
    """A linear scale that maps values from `low` to `high` to px from `start` to `end`."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        """Return the coordinate of a value, px."""
        span = self.high - self.low
        return self.start if span <= 0.0 else self.start + (value - self.low) / span * (self.end - self.start)


def drawing(name: str, title: str, what: str, height: float, width: float = WIDTH) -> Element:
    """Return an empty <svg> of this size, px.

    `name` is unique on the page. A screen reader reads `title` and the description `what` aloud."""
    svg = Element("svg", {"viewBox": f"0 0 {px(width)} {px(height)}", "role": "img"})
    svg.set("aria-labelledby", f"{name}-title {name}-what")
    add(svg, "title", title, id=f"{name}-title")
    add(svg, "desc", what, id=f"{name}-what")
    return svg


def write(parent: Element, x: float, y: float, words: str, kind: str = "", anchor: str = "start") -> Element:
    """Write words at (x, y), px; `kind` holds classes of the style sheet."""
    return add(parent, "text", words, x=px(x), y=px(y), class_=kind, text_anchor=anchor)


def line(points: Iterable[Point]) -> str:
    """Return an SVG path through the points, px; a point that is drawn where the last one is is left out."""
    commands: list[str] = []
    last: tuple[str, str] | None = None
    for x, y in points:
        rounded_point = (px(x), px(y))
        if rounded_point != last:
            commands.append(f"{'L' if commands else 'M'}{rounded_point[0]} {rounded_point[1]}")
            last = rounded_point
    return "".join(commands) if len(commands) != 1 else f"{commands[0]}h0"


def marks(points: Iterable[Point], shape: str) -> str:
    """Return one SVG path with the same shape at every point, px."""
    return "".join([f"M{px(x)} {px(y)}{shape}" for x, y in points])


def grid(svg: Element, x: AxisScale, y: AxisScale, across: Sequence[float], up: Sequence[float]) -> Element:
    """Draw a grid at the values `across` of x and `up` of y, with labels beside the axes; return its path."""
    path = add(svg, "path", class_="grid")
    lines = []
    for value, words in zip(across, tick_labels(across), strict=True):
        lines.append(f"M{px(x.at(value))} {px(y.end)}V{px(y.start)}")
        write(svg, x.at(value), y.start + 16.0, words, "tick", "middle")
    for value, words in zip(up, tick_labels(up), strict=True):
        lines.append(f"M{px(x.start)} {px(y.at(value))}H{px(x.end)}")
        write(svg, x.start - 5.0, y.at(value) + 4.0, words, "tick", "end")
    path.set("d", "".join(lines))
    return path


@define
class Chart:
    """A drawing with two axes; `x` and `y` transform values to px."""

    svg: Element
    x: AxisScale
    y: AxisScale

    @classmethod
    def of(
        cls, svg: Element, x: tuple[float, float], y: tuple[float, float], labels: tuple[str, str], height: float
    ) -> Chart:
        """Make a chart with a grid from the ranges of its axes and their labels, x first."""
        chart = cls(svg, AxisScale(*x, LEFT, WIDTH - RIGHT), AxisScale(*y, height - BOTTOM, TOP))
        grid(svg, chart.x, chart.y, ticks(*x, 6), ticks(*y, 5))
        write(svg, 0.5 * (LEFT + WIDTH - RIGHT), height - 5.0, labels[0], "label", "middle")
        write(svg, 2.0, 12.0, labels[1], "label")
        return chart

    def at(self, x: float, y: float) -> Point:
        """Return the coordinates of a point, px."""
        return self.x.at(x), self.y.at(y)

    def path(self, points: Iterable[Point], kind: str) -> None:
        """Draw a line through points, in values of the axes."""
        if d := line([self.at(x, y) for x, y in points]):
            add(self.svg, "path", d=d, class_=kind)

    def marks(self, points: Iterable[Point], shape: str, kind: str) -> None:
        """Draw the same shape at every point, in values of the axes."""
        if d := marks([self.at(x, y) for x, y in points], shape):
            add(self.svg, "path", d=d, class_=kind)
