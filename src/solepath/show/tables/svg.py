"""Makes the elements of pictures and pages; text never becomes markup.

Places on a picture are px, x to the right and y downwards."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from math import ceil, floor
from xml.etree.ElementTree import Element, fromstring

from attrs import frozen

from ...recording import printable

MAX_LENGTH = 300
"""Largest number of characters of a text that are shown; chosen by hand."""
ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", "'": "&apos;", '"': "&quot;"})
"""What stands for the characters that would be markup."""
STEPS = [(multiple * 10.0**power, max(-power, 0)) for power in range(-9, 18) for multiple in (1.0, 2.0, 5.0)]
"""Round numbers, 1, 2 or 5 times a power of ten, from the least on, each with its digits after the point."""

Point = tuple[float, float]
Ticks = dict[float, str]
"""Values on an axis with their labels."""
Value = str | float | Sequence[str]
"""Value in a template: text, a number of px, or the parts of a path."""


def add(parent: Element, template: str, *values: Value) -> Element:
    """Add a new last child to `parent` and return it: an element of XML in which each "{}" stands for a value.

    Text is escaped and cut to MAX_LENGTH; numbers are written as px."""
    element = fromstring(template.format(*map(_written, values)))
    parent.append(element)
    return element


def _written(value: Value) -> str:
    if isinstance(value, str):
        return printable(value, MAX_LENGTH).translate(ESCAPES)
    return px(value) if isinstance(value, int | float) else "".join(value)


def px(value: float) -> str:
    """Return px as text with at most one digit after the point, the same on every platform."""
    short = f"{value:.1f}".removesuffix(".0")
    return "0" if short == "-0" else short


def line(points: Iterable[Point], end: str = "h0") -> list[str]:
    """Return an SVG path through the points, px; a point that is drawn where the last one is is left out.

    The path of a single point is a dot, and that of none is empty. With the end "z" the path is closed."""
    places = [place for place, _ in groupby([f"{px(x)} {px(y)}" for x, y in points])]
    return [f"M{'L'.join(places)}{end}"] if places else []


def ticks(low: float, high: float, most: int = 6, least: float = 0.0) -> Ticks:
    """Return evenly spaced round values within [low, high], at most `most`, with their labels; none may be round.

    They are at least `least` apart."""
    for step, digits in STEPS:
        first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
        if last - first < most and step > 0.99 * least:
            return {k * step: f"{k * step:.{digits}f}" for k in range(first, last + 1)}
    return {}


@frozen
class AxisScale:
    """A linear scale that transforms values from `low` to `high` to px from `start` to `end`."""

    low: float
    high: float
    start: float
    end: float

    def __call__(self, value: float) -> float:
        """Return the place of a value, px."""
        return self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)


@frozen
class View:
    """A box of a picture with one scale along x and y: +x to the right and +y upwards, m."""

    centre: Point
    """Position in the middle of the box, m."""
    scale: float
    """Size of a metre, px."""
    width: float
    height: float
    """Width and height of the box, px."""
    left: float = 0.0
    top: float = 0.0
    """Upper left corner of the box, px."""

    @classmethod
    def fit(cls, points: Sequence[Point], width: float, height: float, share: float = 0.0, margin: float = 0.0) -> View:
        """Return the box around the points that is at most `width` by `height` px.

        Its margin is a share of the larger extent of the points, and at least `margin`, m."""
        xs, ys = [x for x, _ in points], [y for _, y in points]
        extents = max(xs) - min(xs), max(ys) - min(ys)
        margin = max(share * max(extents), margin)
        across, up = [extent + 2.0 * margin for extent in extents]
        scale = min(width / across, height / up)
        return cls((0.5 * (min(xs) + max(xs)), 0.5 * (min(ys) + max(ys))), scale, across * scale, up * scale)

    def at(self, point: Point) -> Point:
        """Return the place of a position, px."""
        x, y = self.axes
        return x(point[0]), y(point[1])

    @property
    def axes(self) -> tuple[AxisScale, AxisScale]:
        """Scales of x and of y along the edges of the box."""
        (x, y), across, up = self.centre, 0.5 * self.width / self.scale, 0.5 * self.height / self.scale
        return (
            AxisScale(x - across, x + across, self.left, self.left + self.width),
            AxisScale(y - up, y + up, self.top + self.height, self.top),
        )


def shade(colours: Sequence[str], share: float) -> str:
    """Return the colour at `share`, 0 to 1, of a scale of colours."""
    return colours[min(max(int(share * len(colours)), 0), len(colours) - 1)]


def colour_bar(parent: Element, colours: Sequence[str], left: float, top: float, width: float) -> None:
    """Draw a scale of colours, from left to right."""
    step = width / len(colours)
    for k, colour in enumerate(colours):
        add(parent, "<rect x='{}' y='{}' width='{}' height='8' fill='{}'/>", left + step * k, top, step + 0.3, colour)


def square_ticks(x: Point, y: Point, most: int = 8) -> tuple[Ticks, Ticks, float]:
    """Return ticks with the same spacing within the ranges of two axes of one scale, and that spacing.

    `most` is the largest number of ticks of x plus one."""
    across = ticks(*x, most)
    step = (max(across) - min(across)) / (len(across) - 1)
    return across, ticks(*y, most, step), step


def write(parent: Element, x: float, y: float, words: str, kind: str, anchor: str = "middle") -> None:
    """Write words at (x, y), px; `kind` holds classes of the style sheet."""
    add(parent, "<text x='{}' y='{}' class='{}' text-anchor='{}'>{}</text>", x, y, kind, anchor, words)


def grid(svg: Element, x: AxisScale, y: AxisScale, across: Ticks, up: Ticks) -> None:
    """Draw a grid at the values `across` of x and `up` of y, with their labels beside the axes."""
    for value, words in across.items():
        add(svg, "<path d='M{} {}V{}' class='grid'/>", x(value), y.end, y.start)
        write(svg, x(value), y.start + 16.0, words, "tick")
    for value, words in up.items():
        add(svg, "<path d='M{} {}H{}' class='grid'/>", x.start, y(value), x.end)
        write(svg, x.start - 5.0, y(value) + 4.0, words, "tick", "end")
