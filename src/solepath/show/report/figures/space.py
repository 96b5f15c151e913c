"""Draws the wearer's track in space, as an isometric projection without perspective.

Lengths along x and along y have the same scale on paper. Heights are drawn larger where the track is flat. Sizes and
limits were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import ceil, cos, floor, radians, sin
from xml.etree.ElementTree import Element

from ...tables.svg import px
from ..markup import add, figure
from .axes import WIDTH, Point, drawing, line, tick_labels, ticks, write
from .track import TimedPosition

LEAST_RISE = 1.0
"""Least range of heights of a track that is drawn in space, m: half a storey's flight."""
SLANT = radians(30.0)
"""Angle of the x and the y axis to the horizontal of the paper."""
EXAGGERATIONS = (1.0, 2.0, 5.0, 10.0)
"""Factors by which heights may be drawn larger."""
LEAST_HEIGHT_SHARE = 0.25
"""Height of the track on paper, as a share of the width of its floor, that the factor is to reach."""
MAX_HEIGHT, MARGIN = 420.0, 26.0
"""Largest height of the drawing and its margin, px."""
LEAST_EXTENT = 2.0
"""Least side of the floor that is drawn, m."""

Space = tuple[float, float, float]


def project(position: Space, exaggeration: float) -> Point:
    """Return the place on paper, right and down, m, of a position in space, m: x to the lower right, y to the upper."""
    x, y, z = position
    return (x + y) * cos(SLANT), (x - y) * sin(SLANT) - z * exaggeration


def space_figure(parent: Element, track: Sequence[TimedPosition]) -> bool:
    """Draw the track in space above its floor; return False when it is flat.

    `track` is the wearer's or, if that is not known, the track of a foot."""
    places = [event.position for event in track]
    if len(places) < 2:
        return False
    heights = [z for _, _, z in places]
    low, rise = min(heights), max(heights) - min(heights)
    if rise < LEAST_RISE:
        return False
    step, (x0, x1), (y0, y1) = _floor([x for x, _, _ in places], [y for _, y, _ in places])
    width = (x1 - x0 + y1 - y0) * cos(SLANT)
    exaggeration = next((k for k in EXAGGERATIONS if k * rise >= LEAST_HEIGHT_SHARE * width), EXAGGERATIONS[-1])
    corners = [(x, y, low) for x in (x0, x1) for y in (y0, y1)]
    on_paper = [project(place, exaggeration) for place in (*corners, (x0, y0, low + rise), *places)]
    left, top = min([u for u, _ in on_paper]), min([v for _, v in on_paper])
    across, down = max([u for u, _ in on_paper]) - left, max([v for _, v in on_paper]) - top
    scale = min((WIDTH - 2.0 * MARGIN) / across, (MAX_HEIGHT - 2.0 * MARGIN) / down)
    indent = 0.5 * (WIDTH - across * scale)

    def point(place: Space) -> Point:
        u, v = project(place, exaggeration)
        return indent + (u - left) * scale, MARGIN + (v - top) * scale

    what = f"The track in space, with heights from {low:.1f} to {low + rise:.1f} m."
    svg = drawing("space", "Track in space", what, down * scale + 2.0 * MARGIN)
    rules = [line([point((x, y0, low)), point((x, y1, low))]) for x in _marks(x0, x1, step)]
    rules += [line([point((x0, y, low)), point((x1, y, low))]) for y in _marks(y0, y1, step)]
    add(svg, "path", d="".join(rules), class_="grid")
    add(svg, "path", d=line([point((x, y, low)) for x, y, _ in places]), class_="flight")
    add(svg, "path", d=line([point(place) for place in places]), class_="way")
    for place, word, offset in ((places[0], "start", -6.0), (places[-1], "end", 13.0)):
        x, y, _ = place
        (a, b), foot = point(place), point((x, y, low))
        add(svg, "path", d=line([(a, b), foot]), class_="axis")
        add(svg, "circle", cx=px(a), cy=px(b), r="4.5", class_=word)
        at_edge = a > 0.85 * WIDTH
        write(svg, a + (-8.0 if at_edge else 8.0), b + offset, word, "halo strong", "end" if at_edge else "start")
    _upright(svg, point, (x0, y0), low, rise)
    notes = [f"A square of the floor is {step:g} m wide; the dashed line is the track on the floor."]
    if exaggeration > 1.0:
        notes.append(f"Heights are drawn {exaggeration:g} times as large.")
    figure(parent, svg, "Track in space", *notes)
    return True


def _floor(xs: Sequence[float], ys: Sequence[float]) -> tuple[float, Point, Point]:
    """Return the side of a square of the floor, and the ends of the floor along x and along y, m."""
    extent = max(max(xs) - min(xs), max(ys) - min(ys), LEAST_EXTENT)
    marked = ticks(0.0, extent, 8)
    step = marked[1] - marked[0]
    ends = [
        (floor(min(values) / step) * step, max(ceil(max(values) / step), floor(min(values) / step) + 1) * step)
        for values in (xs, ys)
    ]
    return step, ends[0], ends[1]


def _marks(low: float, high: float, step: float) -> list[float]:
    return [low + k * step for k in range(round((high - low) / step) + 1)]


def _upright(svg: Element, point: Callable[[Space], Point], corner: Point, low: float, rise: float) -> None:
    """Draw the axis of heights at the left corner of the floor."""
    x, y = corner
    add(svg, "path", d=line([point((x, y, low)), point((x, y, low + rise))]), class_="axis")
    marked = ticks(low, low + rise, 5)
    for z, words in zip(marked, tick_labels(marked), strict=True):
        a, b = point((x, y, z))
        write(svg, a - 4.0, b + 4.0, words, "tick", "end")
    write(svg, 2.0, 12.0, "height, m", "label")
