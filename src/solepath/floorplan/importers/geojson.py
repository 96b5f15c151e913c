"""Import of the GeoJSON profile of protocol/floorplan.md."""

from __future__ import annotations

from typing import Any

from ...types.attrs import evolve
from ...types.checking import find_fault
from ..doors import cut_doors
from ..outlines import Ring, find_inner_point, join_holes, without_repeats
from ..plan import (
    Anchor,
    Connector,
    ConnectorKind,
    ConnectorStop,
    Door,
    FloorPlan,
    FloorPlanError,
    Level,
    Wall,
    with_rooms,
)
from .earth import Tangent
from .features import Feature, ToPlan, find_anchor, parse_number, read_features

FORMAT = "solepath-floorplan"
VERSION = 1

_KINDS = ("level", "wall", "door", "room", "stairs", "lift")


def read_collection(collection: dict[str, Any], storey: float) -> FloorPlan:
    """Return the plan in a FeatureCollection of the profile; raise FloorPlanError when it is invalid.

    `storey` is the assumed height from one level to the next, m, for a file without elevations."""
    if collection.get("version") != VERSION or isinstance(collection.get("version"), bool):
        raise FloorPlanError(f"is of version {collection.get('version')!r}; this release reads {VERSION}")
    read = list(read_features(collection, "feature", in_properties=True))
    for feature in read:
        if feature.kind not in _KINDS:
            feature.fail(f"there is no feature {feature.kind[:30]!r}, only {', '.join(_KINDS)}")
    reader = _GeoJsonReader(read, *_frame(collection, read))
    name = collection.get("name", "")
    if not isinstance(name, str):
        raise FloorPlanError("its name is no text")
    return reader.plan(name, storey, collection.get("elevations", "known"))


def _frame(collection: dict[str, Any], read: list[Feature]) -> tuple[Anchor | None, ToPlan]:
    """Return the anchor, and the function from the file's coordinates to the plan's."""
    frame, raw_anchor = collection.get("frame"), collection.get("anchor")
    anchor = None if raw_anchor is None else _anchor(raw_anchor)
    if frame == "local":
        return anchor, lambda position: position
    if frame != "wgs84":
        raise FloorPlanError(f"its frame is {frame!r}; it can be 'local' or 'wgs84'")
    if anchor is None:
        anchor = find_anchor(read)
    return anchor, Tangent(anchor).place


def _anchor(raw_anchor: object) -> Anchor:
    if not isinstance(raw_anchor, dict):
        raise FloorPlanError("its anchor is no object")
    values = [parse_number(raw_anchor.get(key, 0.0 if key == "bearing" else None), f"the anchor's {key}")
              for key in ("latitude", "longitude", "bearing")]  # fmt: skip
    anchor = Anchor(*values)
    fault = find_fault(anchor, Anchor)
    if fault is not None:
        raise FloorPlanError(f"its anchor's {fault}")
    return anchor


class _GeoJsonReader:
    """The conversion of the features of one file into records."""

    def __init__(self, read: list[Feature], anchor: Anchor | None, to_plan: ToPlan) -> None:
        self._known, self._anchor, self._to_plan = read, anchor, to_plan
        self._remarks: list[str] = []
        self._walls: dict[str, list[Wall]] = {}
        self._doors: dict[str, list[Door]] = {}
        self._rooms: dict[str, list[tuple[Ring, str]]] = {}
        self._stops: dict[tuple[str, str], list[tuple[Feature, ConnectorStop]]] = {}

    def plan(self, name: str, storey: float, elevations: object) -> FloorPlan:
        if elevations not in ("known", "assumed"):
            raise FloorPlanError(f"its elevations are {elevations!r}; they can be 'known' or 'assumed'")
        levels = self._levels(storey)
        for feature in self._known:
            if feature.kind != "level":
                self._read_feature(feature)
        levels_with_shapes = [
            cut_doors(
                evolve(
                    with_rooms(level, self._rooms[level.id]),
                    walls=tuple(self._walls[level.id]),
                    doors=tuple(self._doors[level.id]),
                )
            )
            for level in levels
        ]
        heights = {level.id: level.elevation for level in levels}
        connectors = tuple(self._connector(stops, heights) for stops in self._stops.values())
        heights_known = elevations == "known" and any(
            feature.kind == "level" and feature.number("elevation") is not None for feature in self._known
        )
        return FloorPlan(name, tuple(levels_with_shapes), connectors, self._anchor, heights_known, tuple(self._remarks))

    def _levels(self, storey: float) -> list[Level]:
        levels = [feature for feature in self._known if feature.kind == "level"]
        elevations = [feature.number("elevation") for feature in levels]
        levels_found = []
        for feature, elevation in zip(levels, elevations, strict=True):
            ordinal = feature.ordinal()
            if elevation is None:
                if any(other is not None for other in elevations):
                    feature.fail("its elevation is missing, while other levels have one")
                elevation = ordinal * storey
            levels_found.append(Level(feature.id, feature.text("name", feature.id), ordinal, elevation, ()))
            self._walls[feature.id], self._doors[feature.id], self._rooms[feature.id] = [], [], []
        return sorted(levels_found, key=lambda level: level.elevation)

    def _read_feature(self, feature: Feature) -> None:
        level = feature.text("level")
        if level not in self._walls:
            feature.fail(f"is on level {level!r}, which the plan does not have")
        if feature.kind == "wall":
            self._walls[level] += self._straight(feature)
        elif feature.kind == "door":
            if (
                feature.geometry != "LineString"
                or len(feature.lines[0][0]) != 2
                or feature.lines[0][0][0] == feature.lines[0][0][1]
            ):
                feature.fail("a door is a LineString of two points")
            start, end = feature.convert_line(feature.lines[0][0], self._to_plan)
            self._doors[level].append(Door(start, end, feature.text("name", "")))
        elif feature.kind == "room":
            if feature.geometry != "Polygon":
                feature.fail("a room is a Polygon")
            self._rooms[level].append((self._outline(feature, level), feature.text("name", "")))
        else:
            self._stop(feature, level)

    def _straight(self, one: Feature) -> list[Wall]:
        if one.geometry not in ("LineString", "MultiLineString", "Polygon"):
            one.fail("a wall is a LineString, a MultiLineString or a Polygon")
        found = []
        for line in one.lines[0]:
            points = without_repeats(one.convert_line(line, self._to_plan))
            found += [Wall(a, b) for a, b in zip(points, points[1:], strict=False)]
        if not found:
            one.fail("has no length")
        return found

    def _outline(self, feature: Feature, level: str) -> Ring:
        feature_name = f"{feature.name} on level {level!r}"
        (rings,) = feature.polygons(self._to_plan, lambda what: self._remarks.append(f"{feature_name}: {what}"))
        return join_holes(rings)

    def _stop(self, feature: Feature, level: str) -> None:
        if feature.geometry == "Point":
            stop = ConnectorStop(level, feature.convert_line(feature.points, self._to_plan)[0])
        elif feature.geometry == "Polygon":
            outline = self._outline(feature, level)
            place_given = feature.properties.get("place")
            if place_given is None:
                stop = ConnectorStop(level, find_inner_point(outline), outline)
            elif isinstance(place_given, list) and len(place_given) == 2:
                x, y = (parse_number(value, f"{feature.name}: its place") for value in place_given)
                stop = ConnectorStop(level, feature.convert_line([(x, y)], self._to_plan)[0], outline)
            else:
                feature.fail("its place is no position")
        else:
            feature.fail(f"{feature.kind} are a Point or a Polygon on each level where they stop")
        key = (feature.kind, feature.text("connector", feature.text("name", "")))
        others = self._stops.setdefault(key, [])
        if any(other.level == level for _, other in others):
            feature.fail(f"is a second stop of {feature.kind} {key[1]!r} at level {level!r}")
        others.append((feature, stop))

    def _connector(self, stops: list[tuple[Feature, ConnectorStop]], heights: dict[str, float]) -> Connector:
        first = stops[0][0]
        ordered = sorted((stop for _, stop in stops), key=lambda stop: heights[stop.level])
        flights = [feature.whole_number("flights") for feature, _ in stops if feature.number("flights") is not None]
        rises = [feature.number("rise") for feature, _ in stops if feature.number("rise") is not None]
        if len(set(flights)) > 1 or len(set(rises)) > 1:
            first.fail("its stops tell different flights or rises")
        kind = ConnectorKind.STAIRS if first.kind == "stairs" else ConnectorKind.LIFT
        name, flight, rise = first.text("name", ""), flights[0] if flights else None, rises[0] if rises else None
        return Connector(kind, name, tuple(ordered), flight, rise)
