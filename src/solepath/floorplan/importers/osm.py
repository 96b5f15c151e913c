"""Import of OpenStreetMap's Simple Indoor Tagging.

Sources: wiki.openstreetmap.org, Simple_Indoor_Tagging, Key:indoor, Key:repeat_on, Tag:highway=elevator.
protocol/floorplan.md describes the conversion of each tag. The tags draw rooms, not walls, and have no heights: walls
are outlines (drawing.py), and levels lie one storey apart. Everything in the file counts as one building."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import chain, combinations, groupby, pairwise, product
from math import floor, inf

from ...types.attrs import define, field
from ..checks import MAX_LEVELS, MAX_RISE, MIN_RISE
from ..doors import MAX_DOOR_WIDTH, MIN_DOOR_WIDTH
from ..earth import Tangent, south_west, to_mm
from ..geometry import Ring, direction, distance, share_along
from ..plan import ConnectorKind, Door, FloorPlan, FloorPlanError, Line, Point, at, naming, on_level
from ..walls import Walls
from .drawing import Border, ConnectorPart, Drawing, Space, Storey
from .features import crossed_outline, open_outline
from .osm_file import Element, OsmFile, Refs, find_shapes

BORDERS = {"room": Border.WALL, "corridor": Border.OPEN, "area": Border.FREE, "column": Border.SOLID,
           "wall": Border.SOLID, "level": Border.SOLID}  # fmt: skip
"""Border for each value of indoor=* (OpenStreetMap wiki, Key:indoor).

The values mean: a room with walls, a walled walkway between rooms, an area without walls, a pillar, a wall, and a whole
level, of which the outline is a wall and no room."""

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
        low, high = sorted([float(match[1]), float(match[2] or match[1])])
        if high - low > MAX_LEVELS:
            raise FloorPlanError(f"{text[:40]!r} tells more than {MAX_LEVELS} levels")
        levels |= {low + 0.0, high + 0.0, *(float(k) for k in range(floor(low) + 1, floor(high) + 1))}
    return sorted(levels)


def levels_of(element: Element) -> dict[str, float]:
    """Return the levels that an element is on, by `level` and `repeat_on`, ascending, each by its id."""
    levels: set[float] = set()
    for key in ("level", "repeat_on"):
        if key in element.tags:
            with naming(f"{element.name}: its {key}"):
                levels.update(parse_levels(element.tags[key]))
    return {f"{level:g}": level for level in sorted(levels)}


def connector_kind(element: Element) -> ConnectorKind | None:
    """Return whether the element is an elevator or stairs, None for neither; escalators are stairs."""
    return next((kind for tag, kind in CONNECTORS.items() if tag in element.tags.items()), None)


def is_door(element: Element) -> bool:
    """Return whether the element is a door, an entrance, or a gap to walk through.

    `door=no` is a gap without a door (OpenStreetMap wiki, Key:door)."""
    tags = element.tags
    return tags.get("indoor") == "door" or "door" in tags or tags.get("entrance", "no") != "no"


def is_indoor(element: Element) -> bool:
    """Return whether the element draws something inside a building, on known levels."""
    draws = element.tags.get("indoor") in BORDERS or connector_kind(element) is not None or is_door(element)
    return draws and not element.tags.keys().isdisjoint(("level", "repeat_on"))


def label_of(element: Element) -> str:
    """Return the name or number of the element, "" when it has none."""
    return element.tags.get("name") or element.tags.get("ref") or ""


def parse_length(text: str | None, least: float, most: float) -> float | None:
    """Return the length from `least` to `most` in a text ("0.9", "1.2 m", "90 cm"), m; None for any other text."""
    match = _LENGTH.fullmatch(text or "")
    if match is None:
        return None
    value = float(match[1].replace(",", ".")) / (100.0 if match[2] == "cm" else 1.0)
    return value if least <= value <= most else None


DEFAULT_DOOR_WIDTH = 1.0
"""Width of a door without a valid width, m."""

MAX_NODE_DISTANCE = 0.5
"""Largest distance of a door's node outside any wall from the wall that it belongs to, m."""

_MAX_STRAIGHT_COSINE = -0.94
"""Cosine of 160 degrees: two walls that meet at a node at a larger angle count as one straight wall."""


def door_at(place: Point, neighbours: list[Point], width: float) -> tuple[Point, Point] | None:
    """Return the door at a node of walls; None without a wall.

    `neighbours` are the other ends of the walls at the node, m. In the middle of a wall the door is centred on the
    node; at a corner it starts there, along the longest wall. `width` is in m."""
    directions = sorted({direction(place, other) for other in neighbours if other != place})
    if not directions:
        return None
    pairs = [(a[1] * b[1] + a[2] * b[2], a, b) for b, a in combinations(directions, 2)]
    longest = directions[-1]
    cosine, one, other = min(pairs, default=(1.0, longest, longest))
    if cosine <= _MAX_STRAIGHT_COSINE:
        return _move(place, one, 0.5 * width), _move(place, other, 0.5 * width)
    return place, _move(place, longest, min(width, longest[0]))


def door_beside(place: Point, walls: list[Line], width: float) -> tuple[Point, Point] | None:
    """Return the door of a node outside any wall, in the nearest wall within MAX_NODE_DISTANCE; None without one."""
    far, wall = min([(distance(*wall, *place), wall) for wall in walls], default=(inf, (0.0, 0.0, 0.0, 0.0)))
    if far > MAX_NODE_DISTANCE:
        return None
    way = direction(wall[:2], wall[2:])
    middle = _move(wall[:2], way, share_along(*wall, *place) * way[0])
    return _move(middle, way, -0.5 * width), _move(middle, way, 0.5 * width)


def _move(place: Point, way: tuple[float, float, float], by: float) -> Point:
    return to_mm((place[0] + by * way[1], place[1] + by * way[2]))


def read_osm(file: OsmFile, storey: float) -> FloorPlan:
    """Return the plan in the elements of a file; raise FloorPlanError when it is invalid.

    `storey` is the assumed height from one level to the next, m."""
    return _OsmReader(file).plan(storey)


@define
class _Drawn:
    """An element that draws something on its levels: shapes and lines of a way or relation, or a node."""

    element: Element
    shapes: list[list[Refs]] = field(factory=list)
    lines: list[Refs] = field(factory=list)
    levels: dict[str, float] = field(init=False)

    def __attrs_post_init__(self) -> None:
        self.levels = levels_of(self.element)

    @property
    def chains(self) -> list[Refs]:
        """All lines and rings as chains of nodes."""
        return [*self.lines, *chain(*self.shapes)]


class _OsmReader:
    """The conversion of the elements of one file into a Drawing."""

    def __init__(self, file: OsmFile) -> None:
        ways = [*file["way"].values(), *file["relation"].values()]
        self._ways = [_Drawn(way, *find_shapes(way, file)) for way in ways if is_indoor(way)]
        drawn_refs = {ref for way in self._ways for ref in chain(*way.chains)}
        if not drawn_refs:
            raise FloorPlanError("has no ways or relations with indoor=* and level=*")
        self._nodes = [
            _Drawn(node) for node in file["node"].values()
            if is_indoor(node) or node.id in drawn_refs and (connector_kind(node) is not None or is_door(node))
        ]  # fmt: skip
        nodes = [file["node"][ref] for ref in sorted(drawn_refs.union([node.element.id for node in self._nodes]))]
        self._anchor = south_west([node.position for node in nodes])
        tangent = Tangent(self._anchor)
        self._places: dict[str, Point] = {}
        for node in nodes:
            with naming(f"{node.name}:"):
                self._places[node.id] = tangent.place(node.position)
        named = [element.tags.get("name") for element in (*file["relation"].values(), *file["way"].values())
                 if "building" in element.tags]  # fmt: skip
        self._drawing = Drawing(next(filter(None, named), ""))
        self._neighbours: dict[str, dict[str, list[str]]] = {}
        """Nodes that a wall joins to each node, by level and node."""
        self._walls_by_level: dict[str, Walls] = {}

    def plan(self, storey: float) -> FloorPlan:
        self._storeys()
        for way in self._ways:
            self._draw(way)
        for node in self._nodes:
            self._draw_node(node)
        self._remove_inner_flights()
        self._open_walls()
        return self._drawing.plan(self._anchor, storey)

    def _storeys(self) -> None:
        levels = dict(chain(*[one.levels.items() for one in self._ways + self._nodes]))
        ordered = sorted(levels, key=levels.__getitem__)
        all_whole = all([level == floor(level) for level in levels.values()])
        first = -len([level for level in levels.values() if level < 0.0])
        for rank, (own_id, level) in enumerate([(own_id, levels[own_id]) for own_id in ordered], first):
            self._drawing.storeys[own_id] = Storey(own_id, int(level) if all_whole else rank, level)
        for way in self._ways:
            tags = way.element.tags
            name = tags.get("name") or tags.get("level:ref")
            for own_id in way.levels if name and tags.get("indoor") == "level" else ():
                self._drawing.storeys[own_id].name = name or own_id

    def _draw(self, way: _Drawn) -> None:
        element, indoor = way.element, way.element.tags.get("indoor", "")
        kind = connector_kind(element)
        if kind is not None or indoor in BORDERS:
            for level, ring in product(way.levels, chain(*self._outlines(way))):
                self._drawing.remarks += crossed_outline(level, element.name, ring)
        if kind is not None:
            self._connector(way, kind)
        elif indoor in BORDERS:
            self._space(way, BORDERS[indoor])
        else:
            doors = [Door(*line, label_of(element)) for refs in way.chains for line in pairwise(self._line(refs))]
            for level in way.levels:
                self._drawing.storeys[level].doors += doors

    def _space(self, way: _Drawn, border: Border) -> None:
        open_lines = [self._line(refs) for refs in way.lines if way.element.tags["indoor"] != "wall"]
        for level in way.levels:
            self._drawing.remarks += [open_outline(level, way.element.name, line) for line in open_lines]
            storey = self._drawing.storeys[level]
            storey.spaces += [Space(rings, border, label_of(way.element)) for rings in self._outlines(way)]
            if border is not Border.FREE:
                storey.lines += [(*a, *b) for refs in way.lines for a, b in pairwise(self._line(refs))]
                self._add_walls(level, way.chains)

    def _connector(self, way: _Drawn, kind: ConnectorKind) -> None:
        element, parts = way.element, self._drawing.parts
        rise = parse_length(element.tags.get("step:height"), MIN_RISE, MAX_RISE)
        label, group = label_of(element), element.name
        for rings in self._outlines(way):
            parts += [ConnectorPart(kind, label, level, None, rings, group, rise) for level in way.levels]
        for level in way.levels:
            self._add_walls(level, chain(*way.shapes))
        for refs in way.lines:
            up = refs[::-1] if element.tags.get("incline", "up").startswith(("down", "-")) else refs
            for i, level in enumerate(way.levels):  # the ends are known; levels in between are interpolated
                place = self._places[up[round(i * (len(up) - 1) / max(len(way.levels) - 1, 1))]]
                parts.append(ConnectorPart(kind, label, level, place, (), group, rise))

    def _line(self, refs: Refs) -> list[Point]:
        """Return the places of nodes, m, plan frame, each different from the one before it."""
        return [place for place, _ in groupby([self._places[ref] for ref in refs])]

    def _outlines(self, way: _Drawn) -> list[tuple[Ring, ...]]:
        """Return the outline and the holes of each shape, m, plan frame."""
        shapes = [[tuple(self._line(refs[:-1])) for refs in shape] for shape in way.shapes]
        return [*filter(None, [tuple([ring for ring in rings if len(set(ring)) >= 3]) for rings in shapes])]

    def _add_walls(self, level: str, chains: Iterable[Refs]) -> None:
        """Add the pairs of nodes that walls join to `_neighbours`."""
        neighbours = self._neighbours.setdefault(level, {})
        for a, b in chain(*map(pairwise, chains)):
            neighbours.setdefault(a, []).append(b)
            neighbours.setdefault(b, []).append(a)

    def _remove_inner_flights(self) -> None:
        """Remove flights drawn as lines within stairs drawn as an area, since they are part of these stairs."""
        stairs = [part for part in self._drawing.parts if part.kind is ConnectorKind.STAIRS]
        flights = [part for part in stairs if part.place is not None]
        outer = {
            flight.group for flight in flights
            if not any(part.level == flight.level and part.contains(flight.middle) for part in stairs)
        }  # fmt: skip
        inner = {flight.group for flight in flights} - outer
        self._drawing.parts = [part for part in self._drawing.parts if part.group not in inner]

    def _open_walls(self) -> None:
        """Make a gap in each wall at a node of which stairs or a lift end: one steps on and off there."""
        for level, neighbours in self._neighbours.items():
            ends = {part.place for part in self._drawing.parts if part.level == level and not part.rings}
            for ref in [ref for ref in neighbours if self._places[ref] in ends]:
                others = [self._places[one] for one in neighbours[ref]]
                line = door_at(self._places[ref], others, DEFAULT_DOOR_WIDTH)
                if line is not None:
                    self._drawing.storeys[level].doors.append(Door(*line))

    def _draw_node(self, node: _Drawn) -> None:
        element, label = node.element, label_of(node.element)
        kind, place = connector_kind(element), self._places[element.id]
        if kind is not None:
            self._drawing.parts += [ConnectorPart(kind, label, level, place, (), element.name) for level in node.levels]
            return
        text = element.tags.get("width", element.tags.get("door:width"))
        width = parse_length(text, MIN_DOOR_WIDTH, MAX_DOOR_WIDTH) or DEFAULT_DOOR_WIDTH
        for level in node.levels or sorted(self._neighbours):
            neighbours = [self._places[ref] for ref in self._neighbours.get(level, {}).get(element.id, [])]
            line = door_at(place, neighbours, width)
            if line is None and node.levels:
                line = door_beside(place, self._near(place, level), width)
                if line is None:
                    what = f"{element.name}, a door, at {at(place)} is in no wall"
                    self._drawing.remarks.append(on_level(level, what, place, act=False))
            if line is not None:
                self._drawing.storeys[level].doors.append(Door(*line, label))

    def _near(self, place: Point, level: str) -> list[Line]:
        if level not in self._walls_by_level:
            pairs = [(self._places[a], self._places[b])
                     for a, others in self._neighbours.get(level, {}).items() for b in others]  # fmt: skip
            self._walls_by_level[level] = Walls([(*a, *b) for a, b in pairs if a != b])
        return self._walls_by_level[level].near(*place)
