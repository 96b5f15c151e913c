"""Draws a floor plan with the track as an SVG picture: a panel for each level, all at one scale, +y upwards.

The colour of the track changes from the start to the end of the recording. While a place has several candidates, they
are drawn as dots; the smaller the weight, the fainter the dot. Sizes were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import cos, sin
from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

from attrs import define, field

from ...events import Placed, PlaceLost
from ...floorplan.plan import Connector, ConnectorKind, ConnectorStop, FloorPlan, Level, Point
from ..output import os_errors_naming
from .svg import INK_COLOUR, PAPER_COLOUR, plain_text, px, write_text

MAX_LEVEL_WIDTH = 720.0
"""Largest width of the drawing of a level by default, px."""
MAX_LEVEL_HEIGHT = 640.0
"""Largest height of the drawing of a level by default, px."""
MARGIN, PANEL_GAP, SPACE_ABOVE, SPACE_BELOW = 24.0, 36.0, 64.0, 64.0
"""Margin of the picture, gap between panels, space above the panels and below them, px."""
NARROW_WIDTH = 640.0
"""Width of the picture below which the legend has two lines, px."""
POINTS_PER_COLOUR = 12
"""Number of strides of the track that share a colour."""
NAME_SIZE, LETTER_WIDTH = 12.0, 7.5
"""Size of the letters of a room's name, and the largest mean width of a letter that is expected, px."""
MAX_CANDIDATE_DOTS = 4000
"""Approximate limit of the number of candidates that are drawn."""

SOFT_COLOUR, FLOOR_COLOUR, WALL_COLOUR = "#5f6b78", "#f4f6f8", "#323f4b"
DOOR_COLOUR, STAIRS_COLOUR, ELEVATOR_COLOUR, CANDIDATE_COLOUR = "#d9b382", "#9fb3c8", "#b8a9c9", "#6b7a8c"
START_COLOUR, END_COLOUR = "#2e7d32", "#c62828"
TRACK_COLOURS = ("#440154", "#3b528b", "#21918c", "#5ec962", "#f0b420")
"""Colours of the track from its start to its end."""


@define
class PlanPicture:
    """Draws the places that a session reported: `events` are its events Placed and PlaceLost, in their order.

    Places are in the frame of the floor plan `plan`, m. `width` and `height` are the largest size of the drawing of a
    level, px. `columns` is the number of panels side by side; None chooses it by the number of levels."""

    plan: FloorPlan
    events: Iterable[Placed | PlaceLost] = ()
    width: float = MAX_LEVEL_WIDTH
    height: float = MAX_LEVEL_HEIGHT
    columns: int | None = None
    places: list[Placed] = field(factory=list, init=False)
    breaks: set[int] = field(factory=set, init=False)
    """Indices of the places that follow a loss of the place (PlaceLost)."""

    def __attrs_post_init__(self) -> None:
        for event in self.events:
            if isinstance(event, Placed):
                self.places.append(event)
            else:
                self.breaks.add(len(self.places))

    def write(self, path: Path, title: str) -> None:
        """Write the picture to a file, UTF-8; raise OSError, naming the file, when it cannot be written."""
        tree = ElementTree(self.drawn(title))
        indent(tree, space=" ")
        with os_errors_naming(path):
            tree.write(path, encoding="utf-8", xml_declaration=True)

    def drawn(self, title: str) -> Element:
        """Return the picture as an <svg> element."""
        frame = _Frame.fit(self.plan, self.places, self.width, self.height)
        count = max(len(self.plan.levels), 1)
        columns = self.columns or (count if count <= 3 else 3 if count > 4 else 2)
        rows = -(-count // columns)
        width = 2.0 * MARGIN + columns * frame.width + (columns - 1) * PANEL_GAP
        lines = 2 if width < NARROW_WIDTH else 1
        height = SPACE_ABOVE + rows * (frame.height + PANEL_GAP) + lines * SPACE_BELOW
        size = {"width": px(width), "height": px(height), "viewBox": f"0 0 {px(width)} {px(height)}"}
        svg = Element(
            "svg",
            {
                "id": "solepath-plan",
                "xmlns": "http://www.w3.org/2000/svg",
                **size,
                "font-family": "system-ui, sans-serif",
            },
        )
        SubElement(svg, "title").text = plain_text(title)
        SubElement(svg, "rect", {"width": "100%", "height": "100%", "fill": PAPER_COLOUR})
        write_text(svg, MARGIN, 30.0, title, size=17.0, weight="600")
        for k, level in enumerate(self.plan.levels):
            left = MARGIN + (k % columns) * (frame.width + PANEL_GAP)
            top = SPACE_ABOVE + (k // columns) * (frame.height + PANEL_GAP)
            name = f"level {level.id}" if level.name in ("", level.id) else f"{level.name} ({level.id})"
            write_text(svg, left, top - 8.0, f"{name}, {level.elevation:.1f} m", size=13.0, colour=SOFT_COLOUR)
            move = {"transform": f"translate({px(left)} {px(top)})"}
            panel = SubElement(svg, "g", move)
            self._level(panel, level, frame)
        self._legend(svg, frame, width, height - lines * SPACE_BELOW + 14.0)
        return svg

    def _level(self, panel: Element, level: Level, frame: _Frame) -> None:
        size = {"width": px(frame.width), "height": px(frame.height)}
        SubElement(panel, "rect", {**size, "rx": "6", "fill": PAPER_COLOUR if level.rooms else FLOOR_COLOUR})
        for room in level.rooms:
            SubElement(panel, "polygon", {"points": frame.points(room), "fill": FLOOR_COLOUR})
        for connector in self.plan.connectors:
            for stop in connector.stops:
                if stop.level == level.id:
                    _connector(panel, connector, stop, frame)
        lines = {"stroke-linecap": "round", "fill": "none"}
        doors = "".join([frame.line(door.start, door.end) for door in level.doors])
        if doors:
            SubElement(panel, "path", {"d": doors, "stroke": DOOR_COLOUR, "stroke-width": px(frame.pen * 0.8), **lines})
        walls = "".join([frame.line(wall.start, wall.end) for wall in level.walls])
        if walls:
            SubElement(panel, "path", {"d": walls, "stroke": WALL_COLOUR, "stroke-width": px(frame.pen), **lines})
        self._candidates(panel, level.id, frame)
        _room_names(panel, level, frame)
        self._track(panel, level.id, frame)

    def _candidates(self, panel: Element, level: str, frame: _Frame) -> None:
        undecided = [place for place in self.places if len(place.candidates) > 1]
        interval = max(1, sum([len(place.candidates) for place in undecided]) // MAX_CANDIDATE_DOTS)
        group = SubElement(panel, "g", {"fill": CANDIDATE_COLOUR, "stroke": "none"})
        for place in undecided[::interval]:
            for candidate in place.candidates:
                if candidate.level == level:
                    x, y = frame.to_px(candidate.position[:2])
                    opacity = f"{0.06 + 0.5 * candidate.weight:.2f}"
                    SubElement(group, "circle", {"cx": px(x), "cy": px(y), "r": "2.2", "fill-opacity": opacity})

    def _track(self, panel: Element, level: str, frame: _Frame) -> None:
        """Draw a line through the places with one candidate only; other places have dots."""
        decided = [
            place if place.level == level and len(place.candidates) == 1 and k not in self.breaks else None
            for k, place in enumerate(self.places)
        ]
        style = {"fill": "none", "stroke-width": "2.6", "stroke-linecap": "round", "stroke-linejoin": "round"}
        piece: list[Placed] = []
        for k, place in enumerate([*decided, None]):
            if place is not None:
                piece.append(place)
            if piece and (place is None or len(piece) > POINTS_PER_COLOUR):
                if len(piece) > 1:
                    points = frame.points(tuple([end.position[:2] for end in piece]))
                    share = (k - 0.5 * len(piece)) / max(len(self.places), 1)
                    SubElement(panel, "polyline", {"points": points, "stroke": blend(TRACK_COLOURS, share), **style})
                piece = [] if place is None else [place]
        all_decided = [place for place in self.places if len(place.candidates) == 1]
        first_word = "start" if all_decided[:1] == self.places[:1] else "found"
        ends = [(all_decided[0], START_COLOUR, first_word), (all_decided[-1], END_COLOUR, "end")] if all_decided else []
        for end, fill, word in ends:
            if end.level == level:
                x, y = frame.to_px(end.position[:2])
                ring = {"fill": fill, "stroke": PAPER_COLOUR, "stroke-width": "2"}
                SubElement(panel, "circle", {"cx": px(x), "cy": px(y), "r": "6", **ring})
                write_text(panel, x + 9.0, y + 4.0, word, size=11.0, colour=fill, weight="600", halo=True)

    def _legend(self, svg: Element, frame: _Frame, width: float, top: float) -> None:
        """Draw the scale, the times, the meaning of the marks, and an arrow to north if the plan has an anchor."""
        metres = _round_length(120.0 / frame.scale)
        bar = metres * frame.scale
        path = f"M{px(MARGIN)} {px(top + 4)}v6h{px(bar)}v-6"
        SubElement(svg, "path", {"d": path, "fill": "none", "stroke": INK_COLOUR, "stroke-width": "1.5"})
        write_text(svg, MARGIN, top + 28.0, f"{metres:g} m", size=12.0)
        left = MARGIN + max(bar, 60.0) + 40.0
        if self.places:
            for k in range(40):
                box = {"x": px(left + 3.0 * k), "y": px(top + 2.0), "width": "3.2", "height": "8"}
                SubElement(svg, "rect", {**box, "fill": blend(TRACK_COLOURS, k / 39.0)})
            first, last = self.places[0].t, self.places[-1].t
            write_text(svg, left, top + 28.0, f"{first:.0f} s", size=12.0)
            write_text(svg, left + 120.0, top + 28.0, f"{last:.0f} s", size=12.0, anchor="end")
            left += 160.0
        if width < NARROW_WIDTH:
            left, top = MARGIN + 5.0, top + 0.8 * SPACE_BELOW
        kinds = {connector.kind for connector in self.plan.connectors}
        marks = [(CANDIDATE_COLOUR, "0.4", "candidate")]
        marks += [(STAIRS_COLOUR, "1", "stairs")] * (ConnectorKind.STAIRS in kinds)
        marks += [(ELEVATOR_COLOUR, "1", "lift")] * (ConnectorKind.LIFT in kinds)
        for fill, opacity, word in marks:
            dot = {"cx": px(left), "cy": px(top + 6.0), "r": "5", "fill": fill, "fill-opacity": opacity}
            SubElement(svg, "circle", dot)
            write_text(svg, left + 10.0, top + 10.0, word, size=12.0)
            left += 30.0 + 8.0 * len(word)
        if self.plan.anchor is not None:
            _north(svg, width - MARGIN - 16.0, top + 12.0, self.plan.anchor.bearing)


@define
class _Frame:
    """The transform from the plan frame, m, to a panel, px with y downwards; `left` and `top` are in m."""

    left: float
    top: float
    scale: float
    width: float
    height: float

    @classmethod
    def fit(cls, plan: FloorPlan, places: list[Placed], width: float, height: float) -> _Frame:
        """Return the frame that shows all levels and the track, with a margin, in at most `width` by `height` px."""
        corners = [end for level in plan.levels for wall in level.walls for end in (wall.start, wall.end)]
        corners += [point for level in plan.levels for room in level.rooms for point in room]
        corners += [stop.place for connector in plan.connectors for stop in connector.stops]
        corners += [place.position[:2] for place in places]
        xs, ys = [x for x, _ in corners] or [0.0], [y for _, y in corners] or [0.0]
        across, up = max(max(xs) - min(xs), 1.0), max(max(ys) - min(ys), 1.0)
        margin = 0.02 * max(across, up) + 0.5
        scale = min(width / (across + 2.0 * margin), height / (up + 2.0 * margin))
        size = ((across + 2.0 * margin) * scale, (up + 2.0 * margin) * scale)
        return cls(min(xs) - margin, max(ys) + margin, scale, *size)

    @property
    def pen(self) -> float:
        """Line width of a wall, px."""
        return min(max(0.14 * self.scale, 1.0), 4.0)

    def to_px(self, point: Point) -> Point:
        return ((point[0] - self.left) * self.scale, (self.top - point[1]) * self.scale)

    def points(self, ring: tuple[Point, ...]) -> str:
        return " ".join([f"{px(x)},{px(y)}" for x, y in map(self.to_px, ring)])

    def line(self, start: Point, end: Point) -> str:
        (x, y), (x1, y1) = self.to_px(start), self.to_px(end)
        return f"M{px(x)} {px(y)}L{px(x1)} {px(y1)}"


def _room_names(panel: Element, level: Level, frame: _Frame) -> None:
    """Write the names of the rooms whose outlines have room for them."""
    for ring, name in zip(level.rooms, level.room_names, strict=False):
        corners = [frame.to_px(point) for point in ring]
        left, right = min([x for x, _ in corners]), max([x for x, _ in corners])
        top, bottom = min([y for _, y in corners]), max([y for _, y in corners])
        if name and right - left > LETTER_WIDTH * (len(name) + 1) and bottom - top > 2.0 * NAME_SIZE:
            place = (0.5 * (left + right), 0.5 * (top + bottom) + 0.35 * NAME_SIZE)
            write_text(panel, *place, name, size=NAME_SIZE, colour=SOFT_COLOUR, anchor="middle")


def _connector(panel: Element, connector: Connector, stop: ConnectorStop, frame: _Frame) -> None:
    steps, arrows = "M-4 3h2.7v-2.3h2.7v-2.3h2.7", "M-2.6 -0.8l2.6 -3l2.6 3M-2.6 0.8l2.6 3l2.6 -3"
    fill, sign = (STAIRS_COLOUR, steps) if connector.kind is ConnectorKind.STAIRS else (ELEVATOR_COLOUR, arrows)
    x, y = frame.to_px(stop.place)
    if stop.outline:
        SubElement(panel, "polygon", {"points": frame.points(stop.outline), "fill": fill, "fill-opacity": "0.55"})
    mark = SubElement(panel, "g", {"transform": f"translate({px(x)} {px(y)})"})
    SubElement(mark, "title").text = plain_text(connector.name)
    SubElement(mark, "circle", {"r": "7", "fill": fill, "stroke": PAPER_COLOUR, "stroke-width": "1.5"})
    SubElement(mark, "path", {"d": sign, "stroke": INK_COLOUR, "stroke-width": "1.2", "fill": "none"})


def _north(svg: Element, x: float, y: float, bearing: float) -> None:
    """Draw an arrow to true north; the plan's +y, upwards in the picture, points `bearing` rad clockwise of north."""
    east, up = -sin(bearing), cos(bearing)
    path = f"M{px(x - 12 * east)} {px(y + 12 * up)}L{px(x + 12 * east)} {px(y - 12 * up)}"
    for side in (0.5, -0.5):
        dx, dy = -sin(bearing + side), cos(bearing + side)
        path += f"M{px(x + 12 * east)} {px(y - 12 * up)}l{px(-7 * dx)} {px(7 * dy)}"
    SubElement(svg, "path", {"d": path, "fill": "none", "stroke": INK_COLOUR, "stroke-width": "1.6"})
    write_text(svg, x + 20.0 * east, y - 20.0 * up + 4.0, "N", size=11.0, weight="600", anchor="middle")


def blend(colours: Sequence[str], share: float) -> str:
    """Return the colour at `share`, 0 to 1, of a scale through the evenly spaced `colours`."""
    position = min(max(share, 0.0), 1.0) * (len(colours) - 1)
    k = min(int(position), len(colours) - 2)
    pairs = zip(bytes.fromhex(colours[k][1:]), bytes.fromhex(colours[k + 1][1:]), strict=True)
    return f"#{bytes([round(a + (position - k) * (b - a)) for a, b in pairs]).hex()}"


def _round_length(metres: float) -> float:
    """Return the largest length, m, of 1, 2 or 5 times a power of ten that is not longer than `metres`."""
    power = 1.0
    while power * 10.0 <= metres:
        power *= 10.0
    while power > metres > 0.0:
        power /= 10.0
    return max([k * power for k in (1.0, 2.0, 5.0) if k * power <= metres], default=power)
