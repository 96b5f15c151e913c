"""GeoJSON features read from bytes, for any profile: checked, and named in every error message."""

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
"""Largest number of points of a file: more than any building has."""

LARGEST = 1e9
"""Limit on the size of a number: more than any coordinate in any unit."""

Position = tuple[float, float]
"""(x, y) as in the file: m, or (longitude, latitude) in degrees."""

Place = Callable[[Position], Point]
"""Function from the file's coordinates to the plan's."""

_DEPTHS = {"Point": 0, "MultiPoint": 1, "LineString": 1, "MultiLineString": 2, "Polygon": 2, "MultiPolygon": 3}
"""Nesting depth of the positions in the lists of each geometry."""


@frozen
class Feature:
    """One feature of a GeoJSON file.

    `name` is for error messages. `lines` holds the parts of a LineString, MultiLineString, Polygon or MultiPolygon, for
    a polygon its outline and then its holes; `points` holds those of a Point or MultiPoint."""

    id: str
    name: str
    kind: str
    properties: dict[str, Any]
    geometry: str = "none"
    points: tuple[Position, ...] = ()
    lines: tuple[tuple[tuple[Position, ...], ...], ...] = ()

    def fail(self, what: str) -> NoReturn:
        raise FloorPlanError(f"{self.name}: {what}")

    def text(self, key: str, otherwise: str | None = None) -> str:
        """Return a text or a number of the properties, as text; `otherwise` replaces a missing one.

        Raises FloorPlanError when both are missing."""
        value = self.properties.get(key)
        if value is None and otherwise is not None:
            return otherwise
        if isinstance(value, str):
            return value
        if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < LARGEST:
            return f"{value:g}" if isinstance(value, float) else str(value)
        return self.fail(f"its {key} is missing" if value is None else f"its {key} is {shown(value)}, not a text")

    def figure(self, key: str) -> float | None:
        """Return a number of the properties, or None if there is none."""
        value = self.properties.get(key)
        return None if value is None else parse_number(value, f"{self.name}: its {key}")

    def whole(self, key: str) -> int | None:
        """Return a whole number of the properties, or None if there is none."""
        value = self.figure(key)
        if value is not None and value != int(value):
            self.fail(f"its {key} is {value:g}, not a whole number")
        return None if value is None else int(value)

    def ordinal(self) -> int:
        """Return the ordinal of a level, which must have an id as well."""
        if not self.id:
            self.fail("a level needs an id")
        ordinal = self.whole("ordinal")
        return self.fail("its ordinal is missing") if ordinal is None else ordinal

    def place_line(self, line: Iterable[Position], place: Place) -> list[Point]:
        """Return a line of the feature in the plan's coordinates."""
        try:
            return [place(position) for position in line]
        except FloorPlanError as error:
            self.fail(str(error))

    def polygons(self, place: Place, remark: Callable[[str], None]) -> list[tuple[Ring, ...]]:
        """Return the outline and the holes of each of its polygons."""
        found = []
        for polygon in self.lines:
            rings = []
            for line in polygon:
                corners, open_by = ring(self.place_line(line, place))
                if len(corners) < 3:
                    self.fail("its outline has fewer than three corners")
                if open_by > CLOSED:
                    remark(not_closed(open_by))
                rings.append(corners)
            if rings:
                found.append(tuple(rings))
        return found or self.fail("has no outline")


def parse_json(data: bytes) -> dict[str, Any]:
    """Return the JSON object in these bytes; raise FloorPlanError when there is none."""
    try:
        value = json.loads(data.decode("utf-8-sig"), parse_constant=_reject_constant)
    except ValueError as error:
        raise FloorPlanError(f"is not JSON ({error})") from None
    except RecursionError:
        raise FloorPlanError("is nested too deeply") from None
    if not isinstance(value, dict):
        raise FloorPlanError("is no JSON object")
    return value


def _reject_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is no number")


def features(collection: dict[str, Any], kind_key: str, in_properties: bool) -> Iterator[Feature]:
    """Yield the features of a FeatureCollection.

    Their kind is the member `kind_key`, of the properties or of the feature."""
    if collection.get("type") != "FeatureCollection" or not isinstance(collection.get("features"), list):
        raise FloorPlanError("is not a GeoJSON FeatureCollection")
    seen: set[str] = set()
    corners = 0
    for i, value in enumerate(collection["features"]):
        if not isinstance(value, dict) or value.get("type") != "Feature":
            raise FloorPlanError(f"feature {i} is not a GeoJSON Feature")
        given = value.get("id")
        if not (given is None or isinstance(given, str) or type(given) is int and abs(given) < LARGEST):
            raise FloorPlanError(f"feature {i}: its id is {shown(given)}, neither a text nor a whole number")
        own = "" if given is None else str(given)
        if own and own in seen:
            raise FloorPlanError(f"two features have the id {own!r}")
        seen.add(own)
        properties = value.get("properties")
        if properties is None:
            properties = {}
        if not isinstance(properties, dict):
            raise FloorPlanError(f"feature {i}: its properties are no object")
        kind = (properties if in_properties else value).get(kind_key)
        if not isinstance(kind, str):
            raise FloorPlanError(f"feature {own[:60] or i!r}: its {kind_key} is missing")
        word = kind[:20] if kind.isascii() and kind.isalpha() else "feature"
        name = f"{word} {own[:60]!r}" if own else f"feature {i}"
        one = _with_geometry(Feature(own, name, kind, properties), value.get("geometry"))
        corners += len(one.points) + sum([len(line) for part in one.lines for line in part])
        if corners > MOST_CORNERS:
            raise FloorPlanError(f"has more than {MOST_CORNERS} points")
        yield one


def _with_geometry(feature: Feature, geometry: object) -> Feature:
    if geometry is None:
        return feature
    if not isinstance(geometry, dict) or not isinstance(geometry.get("type"), str):
        feature.fail("its geometry is no object with a type")
    kind = geometry["type"]
    if kind not in _DEPTHS:
        feature.fail(f"its geometry is a {kind[:30]!r}")
    found = parse_positions(geometry.get("coordinates"), feature, _DEPTHS[kind])
    if kind in ("Point", "MultiPoint"):
        return evolve(feature, geometry=kind, points=found if _DEPTHS[kind] else (found,))
    for _ in range(3 - _DEPTHS[kind]):
        found = (found,)
    return evolve(feature, geometry=kind, lines=found)


def parse_positions(value: object, feature: Feature, depth: int = 0) -> Any:
    """Return a position, or positions in tuples nested like the lists."""
    if not isinstance(value, list):
        feature.fail("its coordinates are no list")
    if depth:
        return tuple([parse_positions(one, feature, depth - 1) for one in value])
    if len(value) < 2:
        feature.fail("it has a position without two coordinates")
    what = f"{feature.name}: a coordinate"
    return parse_number(value[0], what), parse_number(value[1], what)


def find_anchor(some: Iterable[Feature]) -> Anchor:
    """Return the south-west corner of everything that is drawn, in degrees."""
    drawn = [p for one in some for p in (*one.points, *(p for part in one.lines for line in part for p in line))]
    return south_west([(latitude, longitude) for longitude, latitude in drawn])


def parse_number(value: object, what: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < LARGEST or not isfinite(value):
        raise FloorPlanError(f"{what} is {shown(value)}, not a number that can be")
    return float(value)
