"""Reader of OpenStreetMap's Simple Indoor Tagging.

Sources: wiki.openstreetmap.org, Simple_Indoor_Tagging, Key:indoor, Key:repeat_on, Tag:highway=elevator.
protocol/floorplan.md describes the conversion of each tag. The tags draw rooms, not walls, and have no heights: walls
are outlines (drawing.py), and levels lie one storey apart. Everything in the file counts as one building."""

from __future__ import annotations

from math import floor

from ..doors import Line, Openings
from ..outlines import Ring, edges, holds, without_repeats
from ..plan import ConnectorKind, FloorPlan, FloorPlanError, Point, Wall
from .drawing import Border, ConnectorPart, Drawing, Space, Storey
from .earth import Tangent, south_west
from .osm_doors import BESIDE, door_at, door_beside
from .osm_file import Element, OsmFile, Refs, elements, shapes_of
from .osm_tags import BORDERS, connector_kind, is_door, is_indoor, label, level_id, levels, parse_length


def read_osm(data: bytes, storey: float) -> FloorPlan:
    """Return the plan in an OSM XML file; raise FloorPlanError when it does not fit.

    `storey` is the height from one level to the next, m."""
    return _OsmReader(elements(data)).plan(storey)


class _OsmReader:
    """Draws the elements of one file."""

    def __init__(self, file: OsmFile) -> None:
        drawn = [one for one in (*file.ways.values(), *file.relations.values()) if is_indoor(one)]
        self._shapes = [(one, *shapes_of(one, file)) for one in drawn]
        refs = {ref for _, shapes, lines in self._shapes for refs in (*lines, *(r for shape in shapes for r in shape))
                for ref in refs}  # fmt: skip
        nodes_drawn = [one for one in file.nodes.values() if connector_kind(one) is not None or is_door(one)]
        self._nodes = [one for one in nodes_drawn if one.id in refs or is_indoor(one)]
        if not refs:
            raise FloorPlanError("has no ways or relations with indoor=* and level=*")
        nodes = [file.nodes[ref] for ref in sorted(refs)] + [one for one in self._nodes if one.id not in refs]
        self._anchor = south_west([(node.latitude, node.longitude) for node in nodes])
        tangent = Tangent(self._anchor)
        self._places: dict[str, Point] = {}
        for node in nodes:
            try:
                self._places[node.id] = tangent.place((node.longitude, node.latitude))
            except FloorPlanError as error:
                raise FloorPlanError(f"{node.name}: {error}") from None
        named = [one.tags["name"] for one in (*file.relations.values(), *file.ways.values())
                 if "building" in one.tags and one.tags.get("name")]  # fmt: skip
        self._drawing = Drawing(named[0] if named else "")
        self._levels = {one.id: levels(one) for one in self._nodes}
        self._next: dict[str, dict[str, list[str]]] = {}
        """Nodes to which a wall goes from each node, by level and node."""
        self._lines_on: dict[str, Openings] = {}

    def plan(self, storey: float) -> FloorPlan:
        self._storeys()
        for one, shapes, lines in self._shapes:
            self._draw(one, shapes, lines)
        for one in self._nodes:
            self._draw_node(one)
        self._remove_inner_flights()
        return self._drawing.plan(self._anchor, storey)

    def _storeys(self) -> None:
        every = sorted({level for one, *_ in self._shapes for level in levels(one)}
                       | {level for known in self._levels.values() for level in known})  # fmt: skip
        whole, below = all(level == floor(level) for level in every), sum(level < 0.0 for level in every)
        for i, level in enumerate(every):
            own = level_id(level)
            self._drawing.storeys[own] = Storey(own, int(level) if whole else i - below, level)
        for one, *_ in self._shapes:
            if one.tags.get("indoor") == "level":
                name = one.tags.get("name") or one.tags.get("level:ref")
                for level in levels(one):
                    if name:
                        self._drawing.storeys[level_id(level)].name = name

    def _draw(self, one: Element, shapes: list[list[Refs]], lines: list[Refs]) -> None:
        on = [level_id(level) for level in levels(one)]
        kind, indoor = connector_kind(one), one.tags.get("indoor", "")
        if kind is not None:
            self._connector(one, kind, on, shapes, lines)
        elif indoor == "level" or indoor in BORDERS:
            self._space(one, on, shapes, lines, BORDERS.get(indoor))
        else:
            chains = [*lines, *([*refs, refs[0]] for shape in shapes for refs in shape)]
            self._drawing.doors += [(level, *line, label(one)) for level in on for refs in chains
                                    for line in self._lines(refs)]  # fmt: skip

    def _space(self, one: Element, on: list[str], shapes: list[list[Refs]], lines: list[Refs],
               border: Border | None) -> None:  # fmt: skip
        """Draw a space; `border` is None for the outline of a level, which is a wall and no room."""
        if lines and one.tags["indoor"] != "wall":
            self._drawing.remarks.append(f"{one.name}: its outline does not close")
        outlines = self._outlines(shapes)
        for level in on:
            if border in (None, Border.SOLID):
                self._drawing.lines += [(level, (ax, ay), (bx, by)) for rings in outlines for ring in rings
                                        for ax, ay, bx, by in edges(ring)]  # fmt: skip
            else:
                self._drawing.spaces += [Space(level, rings, border) for rings in outlines if border]
            if border is not Border.FREE:
                self._drawing.lines += [(level, *line) for refs in lines for line in self._lines(refs)]
                self._add_walls(level, shapes, lines)

    def _connector(self, one: Element, kind: ConnectorKind, on: list[str], shapes: list[list[Refs]],
                   lines: list[Refs]) -> None:  # fmt: skip
        rise = parse_length(one.tags.get("step:height"))
        rise = rise if rise is not None and 0.02 <= rise <= 0.6 else None
        for rings in self._outlines(shapes):
            parts = self._drawing.parts
            parts += [ConnectorPart(kind, label(one), level, None, rings, one.name, rise) for level in on]
        for level in on:
            self._add_walls(level, shapes, [])
        for refs in lines:
            up = refs[::-1] if one.tags.get("incline", "up").startswith(("down", "-")) else refs
            for i, level in enumerate(on):  # the ends are known; levels in between are interpolated
                at = self._places[up[round(i * (len(up) - 1) / max(len(on) - 1, 1))]]
                self._drawing.parts.append(ConnectorPart(kind, label(one), level, at, (), one.name, rise))

    def _outlines(self, shapes: list[list[Refs]]) -> list[tuple[Ring, ...]]:
        """Return the outline and the holes of each shape."""
        found = []
        for shape in shapes:
            rings = [tuple(without_repeats([self._places[ref] for ref in refs])) for refs in shape]
            found.append(tuple([ring for ring in rings if len(set(ring)) >= 3]))
        return [rings for rings in found if rings]

    def _lines(self, refs: Refs) -> list[Line]:
        points = without_repeats([self._places[ref] for ref in refs])
        return list(zip(points, points[1:], strict=False))

    def _add_walls(self, level: str, shapes: list[list[Refs]], lines: list[Refs]) -> None:
        """Remember the pairs of nodes that are joined by walls."""
        known = self._next.setdefault(level, {})
        for refs in (*lines, *([*refs, refs[0]] for shape in shapes for refs in shape)):
            for a, b in zip(refs, refs[1:], strict=False):
                known.setdefault(a, []).append(b)
                known.setdefault(b, []).append(a)

    def _remove_inner_flights(self) -> None:
        """Remove a flight drawn as a line within stairs drawn as an area: it belongs to them."""
        stairs = [part for part in self._drawing.parts if part.kind is ConnectorKind.STAIRS]
        areas = [(part.level, edges(part.ring)) for part in stairs if part.ring]
        within: dict[str, bool] = {}
        for part in stairs:
            if part.place is not None:
                x, y = part.place
                inside = any(level == part.level and holds(lines, x, y) for level, lines in areas)
                within[part.group] = within.get(part.group, True) and inside
        self._drawing.parts = [part for part in self._drawing.parts if not within.get(part.group, False)]

    def _draw_node(self, one: Element) -> None:
        kind, place = connector_kind(one), self._places[one.id]
        level_ids = [level_id(level) for level in self._levels[one.id]]
        if kind is not None:
            self._drawing.parts += [ConnectorPart(kind, label(one), level, place, (), one.name) for level in level_ids]
            return
        width = parse_length(one.tags.get("width", one.tags.get("door:width")))
        for level in level_ids or sorted(self._next):
            neighbours = [self._places[ref] for ref in self._next.get(level, {}).get(one.id, [])]
            line = door_at(place, neighbours, width)
            if line is None and level_ids:
                line = door_beside(place, self._near(place, level), width)
                if line is None:
                    self._drawing.remarks.append(f"{one.name}: a door on level {level!r} that is in no wall")
            if line is not None:
                self._drawing.doors.append((level, *line, label(one)))

    def _near(self, place: Point, level: str) -> list[Line]:
        known = self._lines_on.get(level)
        if known is None:
            known = Openings([(self._places[a], self._places[b]) for a, others in self._next.get(level, {}).items()
                              for b in others])  # fmt: skip
            self._lines_on[level] = known
        return known.near(Wall(place, place), BESIDE, None)
