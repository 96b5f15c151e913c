"""Import of the GeoJSON profile of protocol/floorplan.md."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from ...types.attrs import define, evolve, field
from ...types.checking import find_fault
from ..doors import cut_doors
from ..earth import Tangent
from ..geometry import Ring, find_inner_point, join_holes
from ..plan import (
    Anchor,
    Connector,
    ConnectorKind,
    ConnectorStop,
    Door,
    FloorPlan,
    FloorPlanError,
    Level,
    PlanFinding,
    Wall,
    with_rooms,
)
from .features import Feature, ToPlan, crossed_outline, find_anchor, parse_number, read_features

FORMAT = "solepath-floorplan"
VERSION = 1

_KINDS = ("level", "wall", "door", "room", "stairs", "lift")


def read_collection(collection: dict[str, Any], storey: float) -> FloorPlan:
    """Return the plan in a FeatureCollection of the profile; raise FloorPlanError when it is invalid.

    `storey` is the assumed height from one level to the next, m, for a file without elevations."""
    version, frame, name = [collection.get(key, "") for key in ("version", "frame", "name")]
    if version != VERSION or isinstance(version, bool):
        raise FloorPlanError(f"is of version {collection.get('version')!r}; this release reads {VERSION}")
    features = list(read_features(collection, "feature", in_properties=True))
    for feature in features:
        if feature.kind not in _KINDS:
            feature.fail(f"there is no feature {feature.kind[:30]!r}, only {', '.join(_KINDS)}")
    anchor = _read_anchor(collection.get("anchor"))
    if frame not in ("local", "wgs84"):
        raise FloorPlanError(f"its frame is {collection.get('frame')!r}; it can be 'local' or 'wgs84'")
    if frame == "wgs84" and anchor is None:
        anchor = find_anchor(features)
    if not isinstance(name, str):
        raise FloorPlanError("its name is no text")
    elevations = collection.get("elevations", "known")
    if elevations not in ("known", "assumed"):
        raise FloorPlanError(f"its elevations are {elevations!r}; they can be 'known' or 'assumed'")
    to_plan: ToPlan = Tangent(anchor).place if frame == "wgs84" and anchor is not None else lambda position: position
    levels = [feature for feature in features if feature.kind == "level"]
    heights = [feature.number("elevation") for feature in levels]
    known = any(height is not None for height in heights)
    reader = _GeoJsonReader(to_plan)
    for feature, height in zip(levels, heights, strict=True):
        reader.read_level(feature, storey, height, known)
    for feature in features:
        if feature.kind != "level":
            reader.read(feature)
    return reader.plan(name, anchor, elevations == "known" and known)


def _read_anchor(value: object) -> Anchor | None:
    if value is None:
        return None
    if not isinstance(value, dict):
        raise FloorPlanError("its anchor is no object")
    numbers = [parse_number(value.get(key, 0.0 if key == "bearing" else None), f"the anchor's {key}")
              for key in ("latitude", "longitude", "bearing")]  # fmt: skip
    anchor = Anchor(*numbers)
    fault = find_fault(anchor, Anchor)
    if fault is not None:
        raise FloorPlanError(f"its anchor's {fault}")
    return anchor


@define
class _Storey:
    """A level, and what is drawn on it."""

    level: Level
    walls: list[Wall] = field(factory=list)
    doors: list[Door] = field(factory=list)
    rooms: list[tuple[Ring, str]] = field(factory=list)


@define
class _GeoJsonReader:
    """The conversion of the features of one file into records."""

    to_plan: ToPlan
    storeys: dict[str, _Storey] = field(factory=dict)
    stops: dict[tuple[str, str], list[tuple[Feature, ConnectorStop]]] = field(factory=dict)
    remarks: list[PlanFinding] = field(factory=list)

    def plan(self, name: str, anchor: Anchor | None, heights_known: bool) -> FloorPlan:
        levels = [
            cut_doors(evolve(with_rooms(one.level, one.rooms), walls=tuple(one.walls), doors=tuple(one.doors)))
            for one in sorted(self.storeys.values(), key=lambda one: one.level.elevation)
        ]
        connectors = tuple([self._connector(stops) for stops in self.stops.values()])
        return FloorPlan(name, tuple(levels), connectors, anchor, heights_known, tuple(self.remarks))

    def read_level(self, feature: Feature, storey: float, elevation: float | None, known: bool) -> None:
        ordinal = feature.ordinal()
        if elevation is None and known:
            feature.fail("its elevation is missing, while other levels have one")
        height = ordinal * storey if elevation is None else elevation
        self.storeys[feature.id] = _Storey(Level(feature.id, feature.text("name", feature.id), ordinal, height, ()))

    def read(self, feature: Feature) -> None:
        level = feature.text("level")
        if level not in self.storeys:
            feature.fail(f"is on level {level!r}, which the plan does not have")
        storey = self.storeys[level]
        if feature.kind == "wall":
            storey.walls += self._walls(feature, level)
        elif feature.kind == "door":
            line = feature.lines[0][0] if feature.geometry == "LineString" else ()
            if len(line) != 2 or line[0] == line[1]:
                feature.fail("a door is a LineString of two points")
            start, end = feature.convert_line(line, self.to_plan)
            storey.doors.append(Door(start, end, feature.text("name", "")))
        elif feature.kind == "room":
            if feature.geometry != "Polygon":
                feature.fail("a room is a Polygon")
            storey.rooms.append((self._outline(feature, level), feature.text("name", "")))
        else:
            self._read_stop(feature, level)

    def _walls(self, feature: Feature, level: str) -> list[Wall]:
        if feature.geometry not in ("LineString", "MultiLineString", "Polygon"):
            feature.fail("a wall is a LineString, a MultiLineString or a Polygon")
        lines = [feature.convert_line(line, self.to_plan) for line in feature.lines[0]]
        for line in lines if feature.geometry == "Polygon" else ():
            self.remarks += crossed_outline(level, feature.name, tuple(line))
        walls = [Wall(a, b) for line in lines for a, b in pairwise(line) if a != b]
        return walls or feature.fail("has no length")

    def _outline(self, feature: Feature, level: str) -> Ring:
        (rings,) = feature.polygons(self.to_plan, level, self.remarks)
        return join_holes(rings)

    def _read_stop(self, feature: Feature, level: str) -> None:
        if feature.geometry not in ("Point", "Polygon"):
            feature.fail(f"{feature.kind} are a Point or a Polygon on each level where they stop")
        outline = self._outline(feature, level) if feature.geometry == "Polygon" else ()
        given = feature.properties.get("place") if outline else list(feature.lines[0][0][0])
        if given is None:
            place = find_inner_point(outline)
        elif isinstance(given, list) and len(given) == 2:
            x, y = [parse_number(value, f"{feature.name}: its place") for value in given]
            (place,) = feature.convert_line([(x, y)], self.to_plan)
        else:
            feature.fail("its place is no position")
        key = (feature.kind, feature.text("connector", feature.text("name", "")))
        others = self.stops.setdefault(key, [])
        if any(other.level == level for _, other in others):
            named = f" {key[1]!r}" if key[1] else ", which have no name of their own,"
            feature.fail(f"is a second stop of {feature.kind}{named} at level {level!r}")
        others.append((feature, ConnectorStop(level, place, outline)))

    def _connector(self, stops: list[tuple[Feature, ConnectorStop]]) -> Connector:
        first = stops[0][0]
        flights = {feature.whole_number("flights") for feature, _ in stops} - {None} or {None}
        rises = {feature.number("rise") for feature, _ in stops} - {None} or {None}
        if len(flights) + len(rises) > 2:
            first.fail("its stops tell different flights or rises")
        ordered = sorted([stop for _, stop in stops], key=lambda stop: self.storeys[stop.level].level.elevation)
        return Connector(ConnectorKind(first.kind), first.text("name", ""), tuple(ordered), *flights, *rises)
