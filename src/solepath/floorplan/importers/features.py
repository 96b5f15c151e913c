"""GeoJSON features out of bytes, whatever profile they follow: checked, and named in every complaint."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from math import isfinite
from typing import Any, NoReturn

from ...types.attrs import evolve, frozen
from ..outlines import CLOSED, Ring, not_closed, ring
from ..plan import Anchor, FloorPlanError, Point
from ..records import shown
from .earth import south_west

MOST_CORNERS = 1_000_000
"""Of a file: more points than any building has."""

LARGEST = 1e9
"""Of a number: more than any coordinate in any unit."""

Position = tuple[float, float]
"""(x, y) as the file has them: m, or (longitude, latitude) in degrees."""

Place = Callable[[Position], Point]
"""From the file's coordinates to the plan's."""

_DEPTHS = {"Point": 0, "MultiPoint": 1, "LineString": 1, "MultiLineString": 2, "Polygon": 2, "MultiPolygon": 3}
"""How deep the positions of a geometry lie in lists."""


@frozen
class Feature:
    """One feature. `name`: what complaints call it. `lines`: what a LineString, MultiLineString, Polygon or
    MultiPolygon is made of, for a polygon its outline and then its holes; `points` of a Point or MultiPoint."""

    id: str
    name: str
    kind: str
    properties: dict[str, Any]
    geometry: str = "none"
    points: tuple[Position, ...] = ()
    lines: tuple[tuple[tuple[Position, ...], ...], ...] = ()

    def wrong(self, what: str) -> NoReturn:
        raise FloorPlanError(f"{self.name}: {what}")

    def text(self, key: str, otherwise: str | None = None) -> str:
        """A text or a number of the properties, as text; FloorPlanError when it is missing and there is no other."""
        value = self.properties.get(key)
        if value is None and otherwise is not None:
            return otherwise
        if isinstance(value, str):
            return value
        if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < LARGEST:
            return f"{value:g}" if isinstance(value, float) else str(value)
        return self.wrong(f"its {key} is missing" if value is None else f"its {key} is {shown(value)}, not a text")

    def figure(self, key: str) -> float | None:
        """A number of the properties, or None where there is none."""
        value = self.properties.get(key)
        return None if value is None else number(value, f"{self.name}: its {key}")

    def whole(self, key: str) -> int | None:
        """A whole number of the properties, or None where there is none."""
        value = self.figure(key)
        if value is not None and value != int(value):
            self.wrong(f"its {key} is {value:g}, not a whole number")
        return None if value is None else int(value)

    def ordinal(self) -> int:
        """Of a level, which has an id as well."""
        if not self.id:
            self.wrong("a level needs an id")
        ordinal = self.whole("ordinal")
        return self.wrong("its ordinal is missing") if ordinal is None else ordinal

    def placed(self, line: Iterable[Position], place: Place) -> list[Point]:
        """A line of it on the plan."""
        try:
            return [place(position) for position in line]
        except FloorPlanError as error:
            self.wrong(str(error))

    def polygons(self, place: Place, remark: Callable[[str], None]) -> list[tuple[Ring, ...]]:
        """Of each of its polygons: the outline and the holes."""
        found = []
        for polygon in self.lines:
            rings = []
            for line in polygon:
                corners, open_by = ring(self.placed(line, place))
                if len(corners) < 3:
                    self.wrong("its outline has fewer than three corners")
                if open_by > CLOSED:
                    remark(not_closed(open_by))
                rings.append(corners)
            if rings:
                found.append(tuple(rings))
        return found or self.wrong("has no outline")


def parsed(data: bytes) -> dict[str, Any]:
    """The JSON object in these bytes. FloorPlanError when there is none."""
    try:
        told = json.loads(data.decode("utf-8-sig"), parse_constant=_no_number)
    except ValueError as error:
        raise FloorPlanError(f"is not JSON ({error})") from None
    except RecursionError:
        raise FloorPlanError("is nested too deeply") from None
    if not isinstance(told, dict):
        raise FloorPlanError("is no JSON object")
    return told


def _no_number(name: str) -> NoReturn:
    raise ValueError(f"{name} is no number")


def features(collection: dict[str, Any], kind_key: str, of_properties: bool) -> Iterator[Feature]:
    """The features of a FeatureCollection. Their kind is the member `kind_key`, of the properties or of the feature."""
    if collection.get("type") != "FeatureCollection" or not isinstance(collection.get("features"), list):
        raise FloorPlanError("is not a GeoJSON FeatureCollection")
    seen: set[str] = set()
    corners = 0
    for i, told in enumerate(collection["features"]):
        if not isinstance(told, dict) or told.get("type") != "Feature":
            raise FloorPlanError(f"feature {i} is not a GeoJSON Feature")
        given = told.get("id")
        if not (given is None or isinstance(given, str) or type(given) is int and abs(given) < LARGEST):
            raise FloorPlanError(f"feature {i}: its id is {shown(given)}, neither a text nor a whole number")
        own = "" if given is None else str(given)
        if own and own in seen:
            raise FloorPlanError(f"two features have the id {own!r}")
        seen.add(own)
        properties = told.get("properties")
        if properties is None:
            properties = {}
        if not isinstance(properties, dict):
            raise FloorPlanError(f"feature {i}: its properties are no object")
        kind = (properties if of_properties else told).get(kind_key)
        if not isinstance(kind, str):
            raise FloorPlanError(f"feature {own[:60] or i!r}: its {kind_key} is missing")
        word = kind[:20] if kind.isascii() and kind.isalpha() else "feature"
        name = f"{word} {own[:60]!r}" if own else f"feature {i}"
        one = _shaped(Feature(own, name, kind, properties), told.get("geometry"))
        corners += len(one.points) + sum([len(line) for part in one.lines for line in part])
        if corners > MOST_CORNERS:
            raise FloorPlanError(f"has more than {MOST_CORNERS} points")
        yield one


def _shaped(feature: Feature, geometry: object) -> Feature:
    if geometry is None:
        return feature
    if not isinstance(geometry, dict) or not isinstance(geometry.get("type"), str):
        feature.wrong("its geometry is no object with a type")
    kind = geometry["type"]
    if kind not in _DEPTHS:
        feature.wrong(f"its geometry is a {kind[:30]!r}")
    found = positions(geometry.get("coordinates"), feature, _DEPTHS[kind])
    if kind in ("Point", "MultiPoint"):
        return evolve(feature, geometry=kind, points=found if _DEPTHS[kind] else (found,))
    for _ in range(3 - _DEPTHS[kind]):
        found = (found,)
    return evolve(feature, geometry=kind, lines=found)


def positions(told: object, feature: Feature, depth: int = 0) -> Any:
    """A position, or positions in tuples as deep as they are in lists."""
    if not isinstance(told, list):
        feature.wrong("its coordinates are no list")
    if depth:
        return tuple([positions(one, feature, depth - 1) for one in told])
    if len(told) < 2:
        feature.wrong("it has a position without two coordinates")
    what = f"{feature.name}: a coordinate"
    return number(told[0], what), number(told[1], what)


def anchor_of(some: Iterable[Feature]) -> Anchor:
    """The south-west corner of all that is drawn, in degrees."""
    drawn = [p for one in some for p in (*one.points, *(p for part in one.lines for line in part for p in line))]
    return south_west([(latitude, longitude) for longitude, latitude in drawn])


def number(told: object, what: str) -> float:
    if isinstance(told, bool) or not isinstance(told, int | float) or not abs(told) < LARGEST or not isfinite(told):
        raise FloorPlanError(f"{what} is {shown(told)}, not a number that can be")
    return float(told)
