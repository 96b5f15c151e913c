"""GeoJSON features out of bytes, whatever profile they follow: checked, and named in every complaint."""

from __future__ import annotations

import json
from collections.abc import Iterator
from math import isfinite
from typing import Any, NoReturn

from ...types.attrs import frozen
from ..plan import FloorPlanError

MOST_CORNERS = 1_000_000
"""Of a file: more points than any building has."""

LARGEST = 1e9
"""Of a number: more than any coordinate in any unit."""

Position = tuple[float, float]
"""(x, y) as the file has them: m, or (longitude, latitude) in degrees."""


@frozen
class Feature:
    """One feature. `name`: what complaints call it. `lines`: what a LineString, MultiLineString, Polygon or
    MultiPolygon is made of, for a polygon its outline and then its holes; `points` of a Point or MultiPoint."""

    id: str
    name: str
    kind: str
    properties: dict[str, Any]
    geometry: str
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
        return self.wrong(f"its {key} is missing" if value is None else f"its {key} is {_shown(value)}, not a text")

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
    corners = _Corners()
    for i, told in enumerate(collection["features"]):
        if not isinstance(told, dict) or told.get("type") != "Feature":
            raise FloorPlanError(f"feature {i} is not a GeoJSON Feature")
        given = told.get("id")
        if not (given is None or isinstance(given, str) or type(given) is int and abs(given) < LARGEST):
            raise FloorPlanError(f"feature {i}: its id is {_shown(given)}, neither a text nor a whole number")
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
        yield _shaped(Feature(own, name, kind, properties, "none"), told.get("geometry"), corners)


class _Corners:
    """How many points were read."""

    def __init__(self) -> None:
        self.count = 0


def _shaped(feature: Feature, geometry: object, corners: _Corners) -> Feature:
    if geometry is None:
        return feature
    if not isinstance(geometry, dict) or not isinstance(geometry.get("type"), str):
        feature.wrong("its geometry is no object with a type")
    kind, told = geometry["type"], geometry.get("coordinates")
    points: tuple[Position, ...] = ()
    lines: tuple[tuple[tuple[Position, ...], ...], ...] = ()
    if kind == "Point":
        points = (_position(told, feature),)
    elif kind == "MultiPoint":
        points = _line(told, feature, corners)
    elif kind == "LineString":
        lines = ((_line(told, feature, corners),),)
    elif kind in ("MultiLineString", "Polygon"):
        lines = (tuple(_line(line, feature, corners) for line in _list(told, feature)),)
    elif kind == "MultiPolygon":
        lines = tuple(tuple(_line(line, feature, corners) for line in _list(one, feature))
                      for one in _list(told, feature))  # fmt: skip
    else:
        feature.wrong(f"its geometry is a {kind[:30]!r}")
    return Feature(feature.id, feature.name, feature.kind, feature.properties, kind, points, lines)


def _list(told: object, feature: Feature) -> list[Any]:
    return told if isinstance(told, list) else feature.wrong("its coordinates are no list")


def _line(told: object, feature: Feature, corners: _Corners) -> tuple[Position, ...]:
    line = _list(told, feature)
    corners.count += len(line)
    if corners.count > MOST_CORNERS:
        raise FloorPlanError(f"has more than {MOST_CORNERS} points")
    return tuple([_position(one, feature) for one in line])


def _position(told: object, feature: Feature) -> Position:
    pair = _list(told, feature)
    if len(pair) < 2:
        feature.wrong("it has a position without two coordinates")
    what = f"{feature.name}: a coordinate"
    return number(pair[0], what), number(pair[1], what)


def number(told: object, what: str) -> float:
    if isinstance(told, bool) or not isinstance(told, int | float) or not abs(told) < LARGEST or not isfinite(told):
        raise FloorPlanError(f"{what} is {_shown(told)}, not a number that can be")
    return float(told)


def _shown(told: object) -> str:
    if isinstance(told, dict | list):
        return "a list" if isinstance(told, list) else "an object"
    return repr(told)[:40] if not isinstance(told, int) or abs(told) < 10**30 else "a huge number"
