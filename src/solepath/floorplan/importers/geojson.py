"""Reader and writer of the GeoJSON profile of protocol/floorplan.md."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ...types.attrs import evolve
from ..doors import with_doors_cut
from ..outlines import Ring, middle, with_holes, without_repeats
from ..plan import Anchor, Connector, ConnectorKind, ConnectorStop, Door, FloorPlan, FloorPlanError, Level, Wall
from .earth import Tangent
from .features import Feature, Place, features, find_anchor, parse_number

FORMAT = "solepath-floorplan"
VERSION = 1

_KINDS = ("level", "wall", "door", "room", "stairs", "lift")


def read_collection(collection: dict[str, Any], storey: float) -> FloorPlan:
    """Return the plan in a FeatureCollection of the profile; raise FloorPlanError when it does not fit.

    `storey` is the height from level to level where it has no elevations, m."""
    if collection.get("version") != VERSION or isinstance(collection.get("version"), bool):
        raise FloorPlanError(f"is of version {collection.get('version')!r}; this release reads {VERSION}")
    known = list(features(collection, "feature", in_properties=True))
    for one in known:
        if one.kind not in _KINDS:
            one.fail(f"there is no feature {one.kind[:30]!r}, only {', '.join(_KINDS)}")
    reader = _GeoJsonReader(known, *_frame(collection, known))
    name = collection.get("name", "")
    if not isinstance(name, str):
        raise FloorPlanError("its name is no text")
    return reader.plan(name, storey, collection.get("elevations", "known"))


def _frame(collection: dict[str, Any], known: list[Feature]) -> tuple[Anchor | None, Place]:
    """Return the anchor, and the function from the file's coordinates to the plan's."""
    frame, given = collection.get("frame"), collection.get("anchor")
    anchor = None if given is None else _anchor(given)
    if frame == "local":
        return anchor, lambda position: position
    if frame != "wgs84":
        raise FloorPlanError(f"its frame is {frame!r}; it can be 'local' or 'wgs84'")
    if anchor is None:
        anchor = find_anchor(known)
    return anchor, Tangent(anchor).place


def _anchor(given: object) -> Anchor:
    if not isinstance(given, dict):
        raise FloorPlanError("its anchor is no object")
    values = [parse_number(given.get(key, 0.0 if key == "bearing" else None), f"the anchor's {key}")
              for key in ("latitude", "longitude", "bearing")]  # fmt: skip
    anchor = Anchor(*values)
    if not (abs(anchor.latitude) <= 89.0 and abs(anchor.longitude) <= 180.0 and abs(anchor.bearing) <= 10.0):
        raise FloorPlanError(f"its anchor is at latitude {anchor.latitude:g}, longitude {anchor.longitude:g}, "
                             f"bearing {anchor.bearing:g} rad")  # fmt: skip
    return anchor


class _GeoJsonReader:
    """Converts the features of one file into records."""

    def __init__(self, known: list[Feature], anchor: Anchor | None, place: Place) -> None:
        self._known, self._anchor, self._place = known, anchor, place
        self._remarks: list[str] = []
        self._walls: dict[str, list[Wall]] = {}
        self._doors: dict[str, list[Door]] = {}
        self._rooms: dict[str, list[Ring]] = {}
        self._stops: dict[tuple[str, str], list[tuple[Feature, ConnectorStop]]] = {}

    def plan(self, name: str, storey: float, elevations: object) -> FloorPlan:
        if elevations not in ("known", "assumed"):
            raise FloorPlanError(f"its elevations are {elevations!r}; they can be 'known' or 'assumed'")
        levels = self._levels(storey)
        for one in self._known:
            if one.kind != "level":
                self._read_feature(one)
        drawn = [
            with_doors_cut(evolve(level, walls=tuple(self._walls[level.id]), doors=tuple(self._doors[level.id]),
                                  rooms=tuple(self._rooms[level.id])))
            for level in levels
        ]  # fmt: skip
        heights = {level.id: level.elevation for level in levels}
        connectors = tuple(self._connector(stops, heights) for stops in self._stops.values())
        heights_known = elevations == "known" and any(one.kind == "level" and one.figure("elevation") is not None
                                             for one in self._known)  # fmt: skip
        return FloorPlan(name, tuple(drawn), connectors, self._anchor, heights_known, tuple(self._remarks))

    def _levels(self, storey: float) -> list[Level]:
        levels = [one for one in self._known if one.kind == "level"]
        high = [one.figure("elevation") for one in levels]
        found = []
        for one, elevation in zip(levels, high, strict=True):
            ordinal = one.ordinal()
            if elevation is None:
                if any(other is not None for other in high):
                    one.fail("its elevation is missing, while other levels have one")
                elevation = ordinal * storey
            found.append(Level(one.id, one.text("name", one.id), ordinal, elevation, ()))
            self._walls[one.id], self._doors[one.id], self._rooms[one.id] = [], [], []
        return sorted(found, key=lambda level: level.elevation)

    def _read_feature(self, one: Feature) -> None:
        level = one.text("level")
        if level not in self._walls:
            one.fail(f"is on level {level!r}, which the plan does not have")
        if one.kind == "wall":
            self._walls[level] += self._straight(one)
        elif one.kind == "door":
            if one.geometry != "LineString" or len(one.lines[0][0]) != 2 or one.lines[0][0][0] == one.lines[0][0][1]:
                one.fail("a door is a LineString of two points")
            start, end = one.place_line(one.lines[0][0], self._place)
            self._doors[level].append(Door(start, end, one.text("name", "")))
        elif one.kind == "room":
            if one.geometry != "Polygon":
                one.fail("a room is a Polygon")
            self._rooms[level].append(self._outline(one, level))
        else:
            self._stop(one, level)

    def _straight(self, one: Feature) -> list[Wall]:
        if one.geometry not in ("LineString", "MultiLineString", "Polygon"):
            one.fail("a wall is a LineString, a MultiLineString or a Polygon")
        found = []
        for line in one.lines[0]:
            points = without_repeats(one.place_line(line, self._place))
            found += [Wall(a, b) for a, b in zip(points, points[1:], strict=False)]
        if not found:
            one.fail("has no length")
        return found

    def _outline(self, one: Feature, level: str) -> Ring:
        on = f"{one.name} on level {level!r}"
        (rings,) = one.polygons(self._place, lambda what: self._remarks.append(f"{on}: {what}"))
        return with_holes(rings)

    def _stop(self, one: Feature, level: str) -> None:
        if one.geometry == "Point":
            stop = ConnectorStop(level, one.place_line(one.points, self._place)[0])
        elif one.geometry == "Polygon":
            outline = self._outline(one, level)
            given = one.properties.get("place")
            if given is None:
                stop = ConnectorStop(level, middle(outline), outline)
            elif isinstance(given, list) and len(given) == 2:
                x, y = (parse_number(value, f"{one.name}: its place") for value in given)
                stop = ConnectorStop(level, one.place_line([(x, y)], self._place)[0], outline)
            else:
                one.fail("its place is no position")
        else:
            one.fail(f"{one.kind} are a Point or a Polygon on each level where they stop")
        key = (one.kind, one.text("connector", one.text("name", "")))
        others = self._stops.setdefault(key, [])
        if any(other.level == level for _, other in others):
            one.fail(f"is a second stop of {one.kind} {key[1]!r} at level {level!r}")
        others.append((one, stop))

    def _connector(self, stops: list[tuple[Feature, ConnectorStop]], heights: dict[str, float]) -> Connector:
        first = stops[0][0]
        ordered = sorted((stop for _, stop in stops), key=lambda stop: heights[stop.level])
        flights = [one.whole("flights") for one, _ in stops if one.figure("flights") is not None]
        rises = [one.figure("rise") for one, _ in stops if one.figure("rise") is not None]
        if len(set(flights)) > 1 or len(set(rises)) > 1:
            first.fail("its stops tell different flights or rises")
        kind = ConnectorKind.STAIRS if first.kind == "stairs" else ConnectorKind.LIFT
        name, flight, rise = first.text("name", ""), flights[0] if flights else None, rises[0] if rises else None
        return Connector(kind, name, tuple(ordered), flight, rise)


def write_floorplan(path: Path | str, plan: FloorPlan) -> None:
    """Write the plan to a file in its own frame; read again it is equal, once its doors are cut out of its walls.

    Raises OSError when it cannot be written, ValueError for numbers that JSON does not have."""
    Path(path).write_text(text_of(plan), encoding="utf-8")


def text_of(plan: FloorPlan) -> str:
    """Return the file's text, with one feature a line."""
    head: dict[str, Any] = {"type": "FeatureCollection", "format": FORMAT, "version": VERSION, "name": plan.name,
                            "frame": "local", "elevations": "known" if plan.heights_known else "assumed"}  # fmt: skip
    if plan.anchor is not None:
        head["anchor"] = {"latitude": plan.anchor.latitude, "longitude": plan.anchor.longitude,
                          "bearing": plan.anchor.bearing}  # fmt: skip
    head_text = json.dumps(head, allow_nan=False)
    lines = ",\n".join(json.dumps(one, allow_nan=False) for one in _written(plan))
    return f'{head_text[:-1]}, "features": [\n{lines}\n]}}\n'


def _written(plan: FloorPlan) -> Iterable[dict[str, Any]]:
    for level in plan.levels:
        about = {"name": level.name, "ordinal": level.ordinal, "elevation": level.elevation}
        yield {**_feature("level", None, about), "id": level.id}
    for level in plan.levels:
        here = {"level": level.id}
        for wall in level.walls:
            yield _feature("wall", _geometry("LineString", [wall.start, wall.end]), here)
        for door in level.doors:
            yield _feature("door", _geometry("LineString", [door.start, door.end]), {**here, "name": door.name})
        for room in level.rooms:
            yield _feature("room", _geometry("Polygon", [[*room, room[0]]]), here)
    for i, one in enumerate(plan.connectors):
        more: dict[str, Any] = {"name": one.name, "connector": str(i), "flights": one.flights, "rise": one.rise}
        more = {key: value for key, value in more.items() if value is not None}
        for stop in one.stops:
            about = {"level": stop.level, **more}
            if stop.outline:
                closed = [*stop.outline, stop.outline[0]]
                yield _feature(one.kind.value, _geometry("Polygon", [closed]), {**about, "place": stop.place})
            else:
                yield _feature(one.kind.value, _geometry("Point", stop.place), about)


def _geometry(kind: str, coordinates: object) -> dict[str, Any]:
    return {"type": kind, "coordinates": coordinates}


def _feature(kind: str, geometry: dict[str, Any] | None, properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "properties": {"feature": kind, **properties}, "geometry": geometry}
