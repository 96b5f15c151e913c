"""Draws the wearer's track in space, as an isometric projection without perspective.

Lengths along x and along y have the same scale on paper. Heights are drawn larger where the track is flat. Sizes and
limits were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, radians, sin
from xml.etree.ElementTree import Element

from attrs import evolve

from ...tables.svg import Point, View, add, line, square_ticks, write
from ..content import TimedPosition
from ..markup import WIDTH, figure
from .axes import PATH

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
BORDER = 1.0
"""Width of the floor around the track, m."""

Space = tuple[float, float, float]


def project(position: Space, exaggeration: float) -> Point:
    """Return the place on paper, right and down, m, of a position in space, m: x to the lower right, y to the upper."""
    x, y, z = position
    return (x + y) * cos(SLANT), (x - y) * sin(SLANT) - z * exaggeration


def space_figure(parent: Element, track: Sequence[TimedPosition]) -> None:
    """Draw the track in space above its floor; nothing when it is flat.

    `track` is the wearer's or, if that is not known, the track of a foot."""
    places = [event.position for event in track]
    if not places:
        return
    (x0, y0, low), (x1, y1, high) = [[end(values) for values in zip(*places, strict=True)] for end in (min, max)]
    if high - low < LEAST_RISE:
        return
    x0, y0, x1, y1 = x0 - BORDER, y0 - BORDER, x1 + BORDER, y1 + BORDER
    least = LEAST_HEIGHT_SHARE * (x1 - x0 + y1 - y0) * cos(SLANT) / (high - low)
    exaggeration = next((k for k in EXAGGERATIONS if k >= least), 10.0)
    across, up, step = square_ticks((x0, x1), (y0, y1))
    lines = [("grid", [(x, y0, low), (x, y1, low)]) for x in across]
    lines += [("grid", [(x0, y, low), (x1, y, low)]) for y in up]
    lines += [("flight", [(x, y, low) for x, y, _ in places]), ("way", places)]
    lines += [("axis", [(x, y, z), (x, y, low)]) for x, y, z in (places[0], places[-1])]

    def on_paper(place: Space) -> Point:
        right, down = project(place, exaggeration)
        return right, -down

    shown = [on_paper(place) for _, path in lines for place in path]
    view = View.fit(shown, WIDTH - 2.0 * MARGIN, MAX_HEIGHT - 2.0 * MARGIN)
    view = evolve(view, left=0.5 * (WIDTH - view.width), top=MARGIN)
    notes = [
        f"Heights are from {low:.1f} to {high:.1f} m.",
        f"A square of the floor is {step:g} m wide; the dashed line is the track on the floor.",
    ]
    notes += [f"Heights are drawn {exaggeration:g} times as large."] if exaggeration > 1.0 else []
    what = f"The track in space, with heights from {low:.1f} to {high:.1f} m."
    svg = figure(parent, "space", "Track in space", what, view.height + 2.0 * MARGIN, *notes)
    for kind, path in lines:
        add(svg, PATH, line([view.at(on_paper(place)) for place in path]), kind)
    _mark_end(svg, view.at(on_paper(places[0])), "start", -6.0)
    _mark_end(svg, view.at(on_paper(places[-1])), "end", 13.0)


def _mark_end(svg: Element, point: Point, word: str, offset: float) -> None:
    """Draw the start or the end of a track with its name."""
    x, y = point
    add(svg, "<circle cx='{}' cy='{}' r='4.5' class='{}'/>", x, y, word)
    at_edge = x > 0.85 * WIDTH
    write(svg, x + (-8.0 if at_edge else 8.0), y + offset, word, "halo strong", "end" if at_edge else "start")
