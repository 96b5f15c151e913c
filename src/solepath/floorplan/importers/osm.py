"""Import of OpenStreetMap's Simple Indoor Tagging.

Sources: wiki.openstreetmap.org, Simple_Indoor_Tagging, Key:indoor, Key:repeat_on, Tag:highway=elevator.
protocol/floorplan.md describes the conversion of each tag. The tags draw rooms, not walls, and have no heights: walls
are outlines (drawing.py), and levels lie one storey apart. Everything in the file counts as one building."""

from __future__ import annotations

from itertools import groupby, pairwise
from math import floor

from ..checks import MAX_RISE, MIN_RISE
from ..geometry import Ring, edges
from ..plan import ConnectorKind, Door, FloorPlan, FloorPlanError, Point
from ..walls import Walls
from .drawing import Border, ConnectorPart, Drawing, Space, Storey
from .earth import Tangent, south_west
from .osm_doors import Line, door_at, door_beside
from .osm_file import Element, OsmFile, Refs, find_shapes, parse_elements
from .osm_tags import BORDERS, connector_kind, is_door, is_indoor, label_of, level_id, levels_of, parse_length


def read_osm(data: bytes, storey: float) -> FloorPlan:
    """Return the plan in an OSM XML file; raise FloorPlanError when it is invalid.

    `storey` is the assumed height from one level to the next, m."""
    return _OsmReader(parse_elements(data)).plan(storey)


class _OsmReader:
    """The conversion of the elements of one file into a Drawing."""

    def __init__(self, file: OsmFile) -> None:
        drawn = [element for element in (*file.way.values(), *file.relation.values()) if is_indoor(element)]
        self._shapes = [(element, *find_shapes(element, file)) for element in drawn]
        drawn_refs = {ref for _, shapes, lines in self._shapes
                      for refs in (*lines, *(r for shape in shapes for r in shape)) for ref in refs}  # fmt: skip
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
            own_id = level_id(level)
            self._drawing.storeys[own_id] = Storey(own_id, int(level) if all_whole else i - count_below, level)
        for element, *_ in self._shapes:
            if element.tags.get("indoor") == "level":
                name = element.tags.get("name") or element.tags.get("level:ref")
                for level in levels_of(element):
                    if name:
                        self._drawing.storeys[level_id(level)].name = name

    def _draw(self, element: Element, shapes: list[list[Refs]], lines: list[Refs]) -> None:
        level_ids = [level_id(level) for level in levels_of(element)]
        kind, indoor = connector_kind(element), element.tags.get("indoor", "")
        if kind is not None:
            self._connector(element, kind, level_ids, shapes, lines)
        elif indoor == "level" or indoor in BORDERS:
            self._space(element, level_ids, shapes, lines, BORDERS.get(indoor))
        else:
            chains = [*lines, *([*refs, refs[0]] for shape in shapes for refs in shape)]
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
        rise = rise if rise is not None and MIN_RISE <= rise <= MAX_RISE else None
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

    def _lines(self, refs: Refs) -> list[Line]:
        return list(pairwise([place for place, _ in groupby([self._places[ref] for ref in refs])]))

    def _add_walls(self, level: str, shapes: list[list[Refs]], lines: list[Refs]) -> None:
        """Add the pairs of nodes that walls join to `_neighbours`."""
        neighbours = self._neighbours.setdefault(level, {})
        for refs in (*lines, *([*refs, refs[0]] for shape in shapes for refs in shape)):
            for a, b in zip(refs, refs[1:], strict=False):
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
        level_ids = [level_id(level) for level in self._levels[element.id]]
        if kind is not None:
            self._drawing.parts += [
                ConnectorPart(kind, label_of(element), level, place, (), element.name) for level in level_ids
            ]
            return
        width = parse_length(element.tags.get("width", element.tags.get("door:width")))
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
        return [(line[:2], line[2:]) for line in walls.near(*place)]
