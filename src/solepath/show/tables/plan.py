"""Draws a floor plan as an SVG picture: a panel for each level, +y upwards.

With ids, it has a grid, grows with the plan, and what is wrong with the plan is marked. An id that would be over
another one, or over a door, is a dot, which shows it where a pointer is. Otherwise it has the track, whose colour
changes from the start to the end of the recording. While a place has several candidates, they are drawn as dots; the
smaller the weight, the fainter the dot. Sizes were chosen by hand and not swept."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import degrees, fsum
from pathlib import Path
from typing import TypeGuard
from xml.etree.ElementTree import Element, ElementTree, indent

from attrs import define, evolve, field

from ...events import Placed, PlaceLost
from ...floorplan.plan import Connector, ConnectorKind, ConnectorStop, FloorPlan, Level, PlanFinding, Point, Start
from ...saving.files import os_errors_naming
from .labels import AROUND, Labels, cut
from .svg import STEPS, Ticks, View, add, colour_bar, grid, line, shade, square_ticks

MAX_LEVEL_WIDTH = 720.0
"""Largest width of the drawing of a level by default, px."""
MAX_LEVEL_HEIGHT = 640.0
"""Largest height of the drawing of a level by default, px."""
MARGIN, PANEL_GAP, SPACE_ABOVE, SPACE_BELOW = 24.0, 36.0, 64.0, 92.0
"""Margin of the picture, gap between panels, space above the panels and below them, px."""
NAME_SIZE, LETTER_WIDTH = 12.0, 7.5
"""Size of the letters of a room's name, and the largest mean width of a letter that is expected, px."""
MARGIN_SHARE, MIN_MARGIN = 0.02, 0.5
"""Margin around what is drawn: as a share of its larger extent, and the least, m."""
TIMES_LEFT = 184.0
"""Place of the scale of times, px."""
MAX_CANDIDATE_DOTS = 4000
"""Approximate limit of the number of candidates that are drawn."""

SOFT_COLOUR, FLOOR_COLOUR, WALL_COLOUR = "#5f6b78", "#f4f6f8", "#323f4b"
DOOR_COLOUR, CANDIDATE_COLOUR = "#d9b382", "#6b7a8c"
START_COLOUR, END_COLOUR = "#2e7d32", "#c62828"
TRACK_COLOURS = (
    "#440154", "#482173", "#433e85", "#38598c", "#2d708e", "#25858e", "#1e9b8a", "#2ab07f", "#52c569", "#86d549",
    "#b8d030", "#f0b420",
)  # fmt: skip
"""Colours of the track from its start to its end."""
CONNECTORS = {
    ConnectorKind.STAIRS: ("#9fb3c8", "M-4 3h2.7v-2.3h2.7v-2.3h2.7"),
    ConnectorKind.LIFT: ("#b8a9c9", "M-2.6 -0.8l2.6 -3l2.6 3M-2.6 0.8l2.6 3l2.6 -3"),
}
"""Colour and sign of stairs and lifts."""


PICTURE = (
    "<svg id='solepath-plan' width='{}' height='{}' viewBox='0 0 {} {}' font-family='system-ui, sans-serif' "
    "font-size='12'><title>{}</title><rect width='100%' height='100%' fill='white'/>"
    "<text x='{}' y='30' font-size='17' font-weight='600'>{}</text></svg>"
)
STYLE = (
    "<style>.grid{{stroke:#1f2933;stroke-opacity:.12}}.tick{{font-size:10px;fill:#5f6b78}}"
    ".id{{font-size:11px;fill:#1f2933;paint-order:stroke;stroke:white;stroke-opacity:.7;stroke-width:2px}}"
    ".door{{font-size:9px;fill:#8a5a17}}.connector{{font-weight:600}}</style>"
)
"""Style of the grid and the ids."""
ID_SCALE, MIN_ID_WIDTH, MAX_ID_WIDTH = 20.0, 900.0, 12_000.0
"""Size of a metre of a level with ids, px, and the least and the largest size of its longer side, px."""
ID_LETTER, ID_HEIGHT, MAX_ID_LETTERS = 6.3, 13.0, 28
"""Width of a letter of an id and its height with the space around it, px; most letters of an id."""
HEADING_LETTER, TITLE_LETTER = 10.0, 9.0
"""Width of a letter of the heading, and that of a level's title with the space for its height, px."""
ID_PLACES = {
    "connector": [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)],
    "room": [(0.0, 0.0), *AROUND[:2]],
    "door": AROUND[:4],
}
"""Where ids may be, the most needed ones first."""
MARK_SIZE, LINE_SIZE = 7.0, 2.0
"""Half of the size of a mark and of the width of a door, px, over which no id is."""
UNNAMED = "<circle cx='{}' cy='{}' r='1.6' fill='{}'><title>{}</title></circle>"
UNNAMED_COLOUR = "#8a5a17"
"""Place of an id that has no room, and its colour."""
TICK_WIDTH = 6.0
"""Width of a digit of the grid, px."""
FINDING = (
    "<g transform='translate({} {})'><title>{}</title><circle r='7' fill='#c62828' fill-opacity='.85'/>"
    "<text y='3' font-size='8' font-weight='600' fill='white' text-anchor='middle'>{}</text></g>"
)
"""Mark of a place where something is wrong."""
FINDING_COLOUR, FINDING_SHIFT = "#c62828", 12.0
"""Colour of that mark, and how far above the place it is, px."""
MAX_GRID_LINES, GRID_GAP = 16, 12.0
"""Largest number of lines of the grid along x of a small level, and height of its labels, px."""
GRID_SPACING, MARK_WIDTH, MAX_MARKS = 80.0, 110.0, 6
"""Least distance of the lines of the grid of a large level, px, width of a word of the legend, px, and most words."""
TEXT, AREA = "<text x='{}' y='{}'>{}</text>", "<path d='{}' fill='{}'/>"
END = (
    "<g><circle cx='{}' cy='{}' r='6' fill='{}' stroke='white' stroke-width='2'/><text x='{}' y='{}' font-size='11' "
    "font-weight='600' fill='{}' stroke='white' stroke-width='3' paint-order='stroke'>{}</text></g>"
)
DOT = "<g><circle cx='{}' cy='{}' r='5' fill='{}' fill-opacity='0.7'/><text x='{}' y='{}'>{}</text></g>"
MARK = (
    "<g transform='translate({} {})' stroke-width='1.2'><title>{}</title><circle r='7' fill='{}' stroke='white'/>"
    "<path d='{}' stroke='#1f2933' fill='none'/></g>"
)
"""Mark of stairs and lifts."""
NORTH = (
    "<g transform='translate({} {}) rotate({})'><path d='M0 12V-12m-5 7l5 -7l5 7' fill='none' stroke='#1f2933' "
    "stroke-width='1.6'/><text y='-16' font-size='11' font-weight='600' text-anchor='middle'>N</text></g>"
)
"""Arrow to true north; the plan's +y, upwards in the picture, points `bearing` clockwise of north."""


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
    ids: bool = False
    """Whether there are a grid in m, and the ids of rooms, stairs, lifts and doors (`FloorPlan.places`)."""
    findings: Sequence[PlanFinding] = ()
    """What is wrong with the plan: each has its number, from 1 on, at its place."""
    start: Start | None = None
    """Start that was given, which is marked if it has a place; without one, the first place is if it is decided."""
    left_out: int = field(init=False, default=0)
    """Number of ids in the drawing that have no room."""

    @property
    def places(self) -> list[Placed]:
        """Places of the session in their order."""
        return [event for event in self.events if isinstance(event, Placed)]

    def write(self, path: Path, title: str) -> None:
        """Write the picture to a file, UTF-8; raise OSError, naming the file, when it cannot be written."""
        tree = ElementTree(self.drawn(title))
        indent(tree, space=" ")
        with os_errors_naming(path):
            tree.write(path, encoding="utf-8", xml_declaration=True)

    def drawn(self, title: str) -> Element:
        """Return the picture as an <svg> element."""
        levels = self.plan.levels
        views = [self._view([level]) for level in levels] if self.ids else [self._view(levels)] * len(levels)
        view, gap = max(views, key=lambda one: one.width, default=self._view(levels)), PANEL_GAP + GRID_GAP * self.ids
        digits = [len(words) for one in views if self.ids for words in _ticks(one)[1].values()]
        margin = max(MARGIN, 12.0 + TICK_WIDTH * max(digits, default=0))
        count = max(len(levels), 1)
        columns = self.columns or min(count, 3)
        width = MARGIN + margin + columns * view.width + (columns - 1) * PANEL_GAP
        width = max(width, 2.0 * MARGIN + MARK_WIDTH * MAX_MARKS * self.ids)
        rows = [views[k : k + columns] for k in range(0, count, columns)]
        heights = [max([one.height for one in row], default=view.height) for row in rows]
        bottom = SPACE_ABOVE + fsum(heights) + len(heights) * gap
        height = bottom + SPACE_BELOW
        heading, most = cut(title, int(width / HEADING_LETTER)), int(width / columns / TITLE_LETTER)
        svg = add(Element("figure"), PICTURE, width, height, width, height, title, MARGIN, heading)
        svg.set("xmlns", "http://www.w3.org/2000/svg")
        if self.ids:
            add(svg, STYLE)
        self.left_out = 0
        for k, level in enumerate(levels):
            left = margin + (k % columns) * (view.width + PANEL_GAP)
            top = SPACE_ABOVE + fsum(heights[: k // columns]) + k // columns * gap
            name = f"level {level.id}" if level.name in ("", level.id) else f"{level.name} ({level.id})"
            panel, box = add(svg, "<g/>"), evolve(views[k], left=left, top=top)
            self._level(panel, level, box, f"{cut(name, most)}, {level.elevation:.1f} m")
            for number, finding in enumerate(self.findings, 1):
                if finding.level == level.id and finding.place is not None:
                    x, y = box.at(finding.place)
                    add(panel, FINDING, x, y - FINDING_SHIFT, finding.text, f"{number}")
        self._legend(svg, None if self.ids else view.scale, width, bottom + 14.0)
        return svg

    def _view(self, levels: Sequence[Level]) -> View:
        """Return a box that shows these levels and the track."""
        shown = {level.id for level in levels}
        points = [end for level in levels for wall in level.walls for end in (wall.start, wall.end)]
        points += [point for level in levels for room in level.rooms for point in room]
        points += [stop.place for one in self.plan.connectors for stop in one.stops if stop.level in shown]
        points += [place.position[:2] for place in self.places]
        points += [place for level, place in self._start() if level in shown]
        points = points or [(0.0, 0.0)]
        width, height = self.width, self.height
        if self.ids:
            size = ID_SCALE * max([max(axis) - min(axis) for axis in zip(*points, strict=True)])
            width = height = min(max(size, MIN_ID_WIDTH), MAX_ID_WIDTH)
        return View.fit(points, width, height, MARGIN_SHARE, MIN_MARGIN)

    def _level(self, panel: Element, level: Level, view: View, title: str) -> None:
        add(
            panel,
            "<text x='{}' y='{}' font-size='13' fill='{}'>{}</text>",
            view.left,
            view.top - 8.0,
            SOFT_COLOUR,
            title,
        )
        floor = "white" if level.rooms else FLOOR_COLOUR
        box = "<rect x='{}' y='{}' width='{}' height='{}' rx='6' fill='{}'/>"
        add(panel, box, view.left, view.top, view.width, view.height, floor)
        for room in level.rooms:
            add(panel, AREA, line(map(view.at, room), "z"), FLOOR_COLOUR)
        for connector in self.plan.connectors:
            for stop in connector.stops:
                if stop.level == level.id:
                    _connector(panel, connector, stop, view)
        pen = min(max(0.14 * view.scale, 1.0), 4.0)
        for lines, colour, width in ((level.doors, DOOR_COLOUR, 0.8 * pen), (level.walls, WALL_COLOUR, pen)):
            d = [part for one in lines for part in line(map(view.at, (one.start, one.end)), "")]
            add(
                panel,
                "<path d='{}' stroke='{}' stroke-width='{}' stroke-linecap='round' fill='none'/>",
                d,
                colour,
                width,
            )
        self._candidates(panel, level.id, view)
        if self.ids:
            grid(panel, *view.axes, *_ticks(view)[:2])
            self._ids(panel, level, view)
        else:
            _room_names(panel, level, view)
        self._track(panel, level.id, view)

    def _ids(self, panel: Element, level: Level, view: View) -> None:
        """Write the ids that have room; the other ones are dots."""
        places = self.plan.places(level.id)
        labels = Labels(view.left, view.left + view.width, view.top + view.height, ID_LETTER, ID_HEIGHT)
        for door in level.doors:
            xs, ys = zip(*map(view.at, (door.start, door.end)), strict=True)
            labels.keep((min(xs) - LINE_SIZE, max(xs) + LINE_SIZE, min(ys) - LINE_SIZE, max(ys) + LINE_SIZE))
        marks = [view.at(place) for place in places["connector"].values()]
        for one in self.findings:
            if one.level == level.id and one.place is not None:
                marks.append((view.at(one.place)[0], view.at(one.place)[1] - FINDING_SHIFT))
        for x, y in marks:
            labels.keep((x - MARK_SIZE, x + MARK_SIZE, y - MARK_SIZE, y + MARK_SIZE))
        for kind, around in ID_PLACES.items():
            for name, place in places[kind].items():
                point = view.at(place)
                if not labels.add(panel, point, cut(name, MAX_ID_LETTERS), f"id {kind}", places=around):
                    self.left_out += 1
                    add(panel, UNNAMED, *point, UNNAMED_COLOUR, name)

    def _marks(self) -> dict[str, str]:
        """Return the colours of the marks that there are, by their names."""
        kinds = {connector.kind for connector in self.plan.connectors}
        marks = {kind.value: colour for kind, (colour, _) in CONNECTORS.items() if kind in kinds}
        if not self.ids:
            return {"candidate": CANDIDATE_COLOUR} | marks
        doors = {"door": DOOR_COLOUR} if any(level.doors for level in self.plan.levels) else {}
        wrong = {"wrong": FINDING_COLOUR} if any(one.place for one in self.findings) else {}
        return (
            {"wall": WALL_COLOUR} | doors | marks | ({"id on hover": UNNAMED_COLOUR} if self.left_out else {}) | wrong
        )

    def _candidates(self, panel: Element, level: str, view: View) -> None:
        undecided = [place for place in self.places if not place.decided]
        interval = max(1, sum([len(place.candidates) for place in undecided]) // MAX_CANDIDATE_DOTS)
        for place in undecided[::interval]:
            for candidate in place.candidates:
                if candidate.level == level:
                    dot = "<circle cx='{}' cy='{}' r='2.2' fill='{}' fill-opacity='{}'/>"
                    opacity = f"{0.06 + 0.5 * candidate.weight:.2f}"
                    add(panel, dot, *view.at(candidate.position[:2]), CANDIDATE_COLOUR, opacity)

    def _start(self) -> list[tuple[str, Point]]:
        """Return level and place of the start that was given, m, if it has a place."""
        return [(self.start.level, self.start.place)] if self.start is not None and self.start.place is not None else []

    def _track(self, panel: Element, level: str, view: View) -> None:
        """Draw a line through the decided places; other places have dots."""
        lines, places = add(panel, "<g stroke-width='2.6' stroke-linecap='round'/>"), self.places
        for k, (before, after) in enumerate(pairwise(self.events)):
            if _is_decided(before) and _is_decided(after) and before.level == after.level == level:
                ends = *view.at(before.position[:2]), *view.at(after.position[:2])
                colour = shade(TRACK_COLOURS, k / len(places))
                add(lines, "<polyline points='{},{} {},{}' stroke='{}'/>", *ends, colour)
        decided = [place for place in places if _is_decided(place)]
        known_first, given = decided[:1] == places[:1], self._start()
        marked = [(*one, START_COLOUR, "start") for one in given]
        if decided and not (given and known_first):
            marked.append((*_where(decided[0]), START_COLOUR, "start" if known_first else "found"))
        match [*self.events][-1:]:
            case [Placed(level_decided=True) as end]:
                marked.append((*_where(end), END_COLOUR, "end" if end.decided else "likely end"))
            case [_] if decided:
                marked.append((*_where(decided[-1]), END_COLOUR, "last known"))
        for on, place, colour, word in marked:
            if on == level:
                x, y = view.at(place)
                add(panel, END, x, y, colour, x + 9.0, y + 4.0, colour, word)

    def _legend(self, svg: Element, scale: float | None, width: float, top: float) -> None:
        """Draw the scale, the times, the meaning of the marks, and an arrow to north if the plan has an anchor.

        `scale` is the size of a metre, px; with None there is a grid instead."""
        if scale is None:
            add(svg, TEXT, MARGIN, top + 28.0, "grid: x and y, m")
        else:
            metres = max([step for step, _ in STEPS if step * scale <= 120.0])
            bar = "<path d='M{} {}v6h{}v-6' fill='none' stroke='#1f2933' stroke-width='1.5'/>"
            add(svg, bar, MARGIN, top + 4.0, metres * scale)
            add(svg, TEXT, MARGIN, top + 28.0, f"{metres:g} m")
        if self.places:
            add(svg, TEXT, TIMES_LEFT, top - 6.0, "line: the decided way")
            colour_bar(svg, TRACK_COLOURS, TIMES_LEFT, top + 2.0, 120.0)
            add(svg, TEXT, TIMES_LEFT, top + 28.0, f"{self.places[0].t:.0f} s")
            add(svg, TEXT, TIMES_LEFT + 90.0, top + 28.0, f"{self.places[-1].t:.0f} s")
        for k, (word, colour) in enumerate(self._marks().items()):
            left = MARGIN + MARK_WIDTH * k
            add(svg, DOT, left + 5.0, top + 57.0, colour, left + 15.0, top + 61.0, word)
        if self.plan.anchor is not None:
            bearing = f"{-degrees(self.plan.anchor.bearing):.1f}"
            add(svg, NORTH, width - MARGIN - 16.0, top + 12.0, bearing)


def _ticks(view: View) -> tuple[Ticks, Ticks, float]:
    """Return the grid of a level."""
    x, y = view.axes
    spacing = max(MAX_GRID_LINES, int(view.width / GRID_SPACING))
    return square_ticks((x.low, x.high), (y.low, y.high), spacing)


def _where(event: Placed) -> tuple[str, Point]:
    return event.level, event.position[:2]


def _is_decided(event: Placed | PlaceLost) -> TypeGuard[Placed]:
    return isinstance(event, Placed) and event.decided


def _room_names(panel: Element, level: Level, view: View) -> None:
    """Write the names of the rooms whose outlines have room for them."""
    for ring, name in zip(level.rooms, level.room_names, strict=False):
        xs, ys = zip(*map(view.at, ring), strict=True)
        if name and max(xs) - min(xs) > LETTER_WIDTH * (len(name) + 1) and max(ys) - min(ys) > 2.0 * NAME_SIZE:
            x, y = 0.5 * (min(xs) + max(xs)), 0.5 * (min(ys) + max(ys)) + 0.35 * NAME_SIZE
            add(panel, TEXT, x, y, name).attrib |= {"text-anchor": "middle", "fill": SOFT_COLOUR}


def _connector(panel: Element, connector: Connector, stop: ConnectorStop, view: View) -> None:
    colour, sign = CONNECTORS[connector.kind]
    add(panel, AREA, line(map(view.at, stop.outline), "z"), colour).set("fill-opacity", "0.55")
    add(panel, MARK, *view.at(stop.place), connector.name, colour, sign)
