"""Import of OpenStreetMap's Simple Indoor Tagging.

Sources: wiki.openstreetmap.org, Simple_Indoor_Tagging, Key:indoor, Key:repeat_on, Tag:highway=elevator.
protocol/floorplan.md describes the conversion of each tag. The tags draw rooms, not walls, and have no heights: walls
are outlines (drawing.py), and levels lie one storey apart. Everything in the file counts as one building."""

from __future__ import annotations

import re
from itertools import chain, groupby, pairwise
from math import floor, hypot, inf

from ..checks import MAX_LEVELS, MAX_RISE, MIN_RISE
from ..geometry import Ring, distance, edges, share_along
from ..plan import ConnectorKind, Door, FloorPlan, FloorPlanError, Line, Point
from ..walls import Walls
from .drawing import Border, ConnectorPart, Drawing, Space, Storey
from .earth import Tangent, south_west, to_mm
from .osm_file import Element, OsmFile, Refs, find_shapes, parse_elements

BORDERS = {"room": Border.WALL, "corridor": Border.OPEN, "area": Border.FREE, "column": Border.SOLID,
           "wall": Border.SOLID}  # fmt: skip
"""Border for each value of indoor=* (OpenStreetMap wiki, Key:indoor).

The values mean: a room with walls, a walled walkway between rooms, an area without walls, a pillar, a wall."""

CONNECTORS = {
    ("highway", "elevator"): ConnectorKind.LIFT,
    ("room", "elevator"): ConnectorKind.LIFT,
    ("elevator", "yes"): ConnectorKind.LIFT,
    ("highway", "steps"): ConnectorKind.STAIRS,
    ("room", "stairs"): ConnectorKind.STAIRS,
    ("stairs", "yes"): ConnectorKind.STAIRS,
}
"""Tags of elevators and stairs."""

_NUMBER = r"-?\d{1,4}(?:\.\d{1,3})?"
_RANGE = re.compile(rf"\s*({_NUMBER})\s*(?:-\s*({_NUMBER})\s*)?", re.ASCII)
_LENGTH = re.compile(r"\s*(\d{1,6}(?:[.,]\d{1,6})?)\s*(m|cm)?\s*", re.ASCII)


def parse_levels(text: str) -> list[float]:
    """Return the levels in a value of `level` or `repeat_on`, each once, ascending.

    Examples: "0", "-1", "0.5", "0;1", "0-3", "-3--1", "-1;2-4". A range gives its ends and the whole numbers between
    them. Raises FloorPlanError when the text is no list of levels."""
    levels: set[float] = set()
    for part in text.split(";"):
        match = _RANGE.fullmatch(part)
        if match is None:
            raise FloorPlanError(f"{text[:40]!r} tells no levels")
        low = float(match[1])
        high = float(match[2]) if match[2] is not None else low
        low, high = min(low, high), max(low, high)
        if high - low > MAX_LEVELS:
            raise FloorPlanError(f"{text[:40]!r} tells more than {MAX_LEVELS} levels")
        levels |= {low + 0.0, high + 0.0, *(float(k) for k in range(floor(low) + 1, floor(high) + 1))}
    return sorted(levels)


def levels_of(element: Element) -> list[float]:
    """Return the levels that an element is on, by `level` and `repeat_on`."""
    levels: set[float] = set()
    for key in [key for key in ("level", "repeat_on") if key in element.tags]:
        try:
            levels.update(parse_levels(element.tags[key]))
        except FloorPlanError as error:
            raise FloorPlanError(f"{element.name}: its {key} {error}") from None
    return sorted(levels)


def connector_kind(element: Element) -> ConnectorKind | None:
    """Return whether the element is an elevator or stairs, None for neither; escalators are stairs."""
    return next((kind for tag, kind in CONNECTORS.items() if tag in element.tags.items()), None)


def is_door(element: Element) -> bool:
    """Return whether the element is a door, an entrance, or a gap to walk through."""
    tags = element.tags
    return tags.get("indoor") == "door" or any(tags.get(key, "no") != "no" for key in ("door", "entrance"))


def is_indoor(element: Element) -> bool:
    """Return whether the element draws something inside a building, on known levels."""
    draws = element.tags.get("indoor") in (*BORDERS, "level") or connector_kind(element) is not None or is_door(element)
    return draws and ("level" in element.tags or "repeat_on" in element.tags)


def label_of(element: Element) -> str:
    """Return the name or number of the element, "" when it has none."""
    return element.tags.get("name") or element.tags.get("ref") or ""


def parse_length(text: str | None) -> float | None:
    """Return the length in a text ("0.9", "1.2 m", "90 cm"), m; None for any other text."""
    match = _LENGTH.fullmatch(text) if text is not None else None
    if match is None:
        return None
    value = float(match[1].replace(",", "."))
    return value / 100.0 if match[2] == "cm" else value


DEFAULT_DOOR_WIDTH = 1.0
"""Width of a door without a valid width, m."""

MIN_DOOR_WIDTH, MAX_DOOR_WIDTH = 0.4, 20.0
"""Range of valid widths, m; other values are errors of units and are ignored."""

MAX_NODE_DISTANCE = 0.5
"""Largest distance of a door's node outside any wall from the wall that it belongs to, m."""

_MAX_STRAIGHT_COSINE = -0.94
"""Cosine of 160 degrees: two walls that meet at a node at a larger angle count as one straight wall."""


def door_at(place: Point, neighbours: list[Point], width: float) -> tuple[Point, Point] | None:
    """Return the door at a node of walls; None without a wall.

    `neighbours` are the other ends of the walls at the node, m. In the middle of a wall the door is centred on the
    node; at a corner it starts there, along the longest wall. `width` is in m."""
    directions = sorted({_direction(place, other) for other in neighbours if other != place})
    if not directions:
        return None
    pairs = [(ax * bx + ay * by, i, j) for i, (_, ax, ay) in enumerate(directions)
             for j, (_, bx, by) in enumerate(directions[:i])]  # fmt: skip
    cosine, i, j = min(pairs, default=(1.0, 0, 0))
    if cosine <= _MAX_STRAIGHT_COSINE:
        return _move(place, directions[i], 0.5 * width), _move(place, directions[j], 0.5 * width)
    return place, _move(place, directions[-1], min(width, directions[-1][0]))


def door_beside(place: Point, walls: list[Line], width: float) -> tuple[Point, Point] | None:
    """Return the door of a node outside any wall, in the nearest wall within MAX_NODE_DISTANCE; None without one."""
    far, wall = min([(distance(*wall, *place), wall) for wall in walls], default=(inf, (0.0, 0.0, 0.0, 0.0)))
    if far > MAX_NODE_DISTANCE:
        return None
    direction = _direction(wall[:2], wall[2:])
    middle = _move(wall[:2], direction, share_along(*wall, *place) * direction[0])
    return _move(middle, direction, -0.5 * width), _move(middle, direction, 0.5 * width)


def _direction(a: Point, b: Point) -> tuple[float, float, float]:
    length = hypot(b[0] - a[0], b[1] - a[1])
    return length, (b[0] - a[0]) / length, (b[1] - a[1]) / length


def _move(place: Point, direction: tuple[float, float, float], by: float) -> Point:
    return to_mm((place[0] + by * direction[1], place[1] + by * direction[2]))


def read_osm(data: bytes, storey: float) -> FloorPlan:
    """Return the plan in an OSM XML file; raise FloorPlanError when it is invalid.

    `storey` is the assumed height from one level to the next, m."""
    return _OsmReader(parse_elements(data)).plan(storey)


class _OsmReader:
    """The conversion of the elements of one file into a Drawing."""

    def __init__(self, file: OsmFile) -> None:
        drawn_elements = [element for element in (*file.way.values(), *file.relation.values()) if is_indoor(element)]
        self._shapes = [(element, *find_shapes(element, file)) for element in drawn_elements]
        drawn_refs = {ref for _, shapes, lines in self._shapes for refs in _join_shapes(shapes, lines) for ref in refs}
        nodes_drawn = [
            element for element in file.node.values() if connector_kind(element) is not None or is_door(element)
        ]
        self._nodes = [element for element in nodes_drawn if element.id in drawn_refs or is_indoor(element)]
        if not drawn_refs:
            raise FloorPlanError("has no ways or relations with indoor=* and level=*")
        nodes = [file.node[ref] for ref in sorted(drawn_refs)] + [
            element for element in self._nodes if element.id not in drawn_refs
        ]
        self._anchor = south_west([(node.latitude, node.longitude) for node in nodes])
        tangent = Tangent(self._anchor)
        self._places: dict[str, Point] = {}
        for node in nodes:
            try:
                self._places[node.id] = tangent.place((node.longitude, node.latitude))
            except FloorPlanError as error:
                raise FloorPlanError(f"{node.name}: {error}") from None
        named = [element.tags["name"] for element in (*file.relation.values(), *file.way.values())
                 if "building" in element.tags and element.tags.get("name")]  # fmt: skip
        self._drawing = Drawing(named[0] if named else "")
        self._levels = {element.id: levels_of(element) for element in self._nodes}
        self._neighbours: dict[str, dict[str, list[str]]] = {}
        """Nodes that a wall joins to each node, by level and node."""
        self._walls_by_level: dict[str, Walls] = {}

    def plan(self, storey: float) -> FloorPlan:
        self._storeys()
        for element, shapes, lines in self._shapes:
            self._draw(element, shapes, lines)
        for element in self._nodes:
            self._draw_node(element)
        self._remove_inner_flights()
        return self._drawing.plan(self._anchor, storey)

    def _storeys(self) -> None:
        levels = sorted({level for element, *_ in self._shapes for level in levels_of(element)}
                       | {level for node_levels in self._levels.values() for level in node_levels})  # fmt: skip
        all_whole, count_below = all(level == floor(level) for level in levels), sum(level < 0.0 for level in levels)
        for i, level in enumerate(levels):
            own_id = f"{level:g}"
            self._drawing.storeys[own_id] = Storey(own_id, int(level) if all_whole else i - count_below, level)
        for element, *_ in self._shapes:
            if element.tags.get("indoor") == "level":
                name = element.tags.get("name") or element.tags.get("level:ref")
                for level in levels_of(element):
                    if name:
                        self._drawing.storeys[f"{level:g}"].name = name

    def _draw(self, element: Element, shapes: list[list[Refs]], lines: list[Refs]) -> None:
        level_ids = [f"{level:g}" for level in levels_of(element)]
        kind, indoor = connector_kind(element), element.tags.get("indoor", "")
        if kind is not None:
            self._connector(element, kind, level_ids, shapes, lines)
        elif indoor == "level" or indoor in BORDERS:
            self._space(element, level_ids, shapes, lines, BORDERS.get(indoor))
        else:
            chains = _join_shapes(shapes, lines)
            for level in level_ids:
                self._drawing.storeys[level].doors += [
                    Door(a, b, label_of(element)) for refs in chains for a, b in self._lines(refs)
                ]

    def _space(self, element: Element, level_ids: list[str], shapes: list[list[Refs]], lines: list[Refs],
               border: Border | None) -> None:  # fmt: skip
        """Draw a space; `border` is None for the outline of a level, which is a wall and no room."""
        if lines and element.tags["indoor"] != "wall":
            self._drawing.remarks.append(f"{element.name}: its outline does not close")
        outlines = self._outlines(shapes)
        for level in level_ids:
            storey = self._drawing.storeys[level]
            if border in (None, Border.SOLID):
                storey.lines += [line for rings in outlines for ring in rings for line in edges(ring)]
            else:
                storey.spaces += [Space(rings, border, label_of(element)) for rings in outlines if border]
            if border is not Border.FREE:
                storey.lines += [(*a, *b) for refs in lines for a, b in self._lines(refs)]
                self._add_walls(level, shapes, lines)

    def _connector(self, element: Element, kind: ConnectorKind, level_ids: list[str], shapes: list[list[Refs]],
                   lines: list[Refs]) -> None:  # fmt: skip
        rise = parse_length(element.tags.get("step:height"))
        rise = rise if MIN_RISE <= (rise or 0.0) <= MAX_RISE else None
        for rings in self._outlines(shapes):
            parts = self._drawing.parts
            parts += [
                ConnectorPart(kind, label_of(element), level, None, rings, element.name, rise) for level in level_ids
            ]
        for level in level_ids:
            self._add_walls(level, shapes, [])
        for refs in lines:
            up = refs[::-1] if element.tags.get("incline", "up").startswith(("down", "-")) else refs
            for i, level in enumerate(level_ids):  # the ends are known; levels in between are interpolated
                place = self._places[up[round(i * (len(up) - 1) / max(len(level_ids) - 1, 1))]]
                self._drawing.parts.append(ConnectorPart(kind, label_of(element), level, place, (), element.name, rise))

    def _outlines(self, shapes: list[list[Refs]]) -> list[tuple[Ring, ...]]:
        """Return the outline and the holes of each shape, m, plan frame."""
        outlines = []
        for shape in shapes:
            rings = [tuple([place for place, _ in groupby([self._places[ref] for ref in refs])]) for refs in shape]
            outlines.append(tuple([ring for ring in rings if len(set(ring)) >= 3]))
        return [rings for rings in outlines if rings]

    def _lines(self, refs: Refs) -> list[tuple[Point, Point]]:
        return list(pairwise([place for place, _ in groupby([self._places[ref] for ref in refs])]))

    def _add_walls(self, level: str, shapes: list[list[Refs]], lines: list[Refs]) -> None:
        """Add the pairs of nodes that walls join to `_neighbours`."""
        neighbours = self._neighbours.setdefault(level, {})
        for a, b in chain(*map(pairwise, _join_shapes(shapes, lines))):
            neighbours.setdefault(a, []).append(b)
            neighbours.setdefault(b, []).append(a)

    def _remove_inner_flights(self) -> None:
        """Remove flights drawn as lines within stairs drawn as an area, since they are part of these stairs."""
        stairs = [part for part in self._drawing.parts if part.kind is ConnectorKind.STAIRS]
        flights = [(part.group, part.level, part.place) for part in stairs if part.place is not None]
        outer = {
            group for group, level, place in flights
            if not any(part.level == level and part.contains(place) for part in stairs)
        }  # fmt: skip
        inner = {group for group, _, _ in flights} - outer
        self._drawing.parts = [part for part in self._drawing.parts if part.group not in inner]

    def _draw_node(self, element: Element) -> None:
        kind, place = connector_kind(element), self._places[element.id]
        level_ids = [f"{level:g}" for level in self._levels[element.id]]
        if kind is not None:
            self._drawing.parts += [
                ConnectorPart(kind, label_of(element), level, place, (), element.name) for level in level_ids
            ]
            return
        width = parse_length(element.tags.get("width", element.tags.get("door:width"))) or 0.0
        width = width if MIN_DOOR_WIDTH <= width <= MAX_DOOR_WIDTH else DEFAULT_DOOR_WIDTH
        for level in level_ids or sorted(self._neighbours):
            neighbours = [self._places[ref] for ref in self._neighbours.get(level, {}).get(element.id, [])]
            line = door_at(place, neighbours, width)
            if line is None and level_ids:
                line = door_beside(place, self._near(place, level), width)
                if line is None:
                    self._drawing.remarks.append(f"{element.name}: a door on level {level!r} that is in no wall")
            if line is not None:
                self._drawing.storeys[level].doors.append(Door(*line, label_of(element)))

    def _near(self, place: Point, level: str) -> list[Line]:
        walls = self._walls_by_level.get(level)
        if walls is None:
            pairs = [(self._places[a], self._places[b])
                     for a, others in self._neighbours.get(level, {}).items() for b in others]  # fmt: skip
            walls = self._walls_by_level[level] = Walls([(*a, *b) for a, b in pairs if a != b])
        return walls.near(*place)


def _join_shapes(shapes: list[list[Refs]], lines: list[Refs]) -> list[Refs]:
    """Return all lines and rings as chains of nodes, in which a ring repeats its first node."""
    return [*lines, *([*refs, refs[0]] for shape in shapes for refs in shape)]
