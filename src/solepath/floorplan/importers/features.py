"""Reading and checking of GeoJSON features, for any profile; every error message names its feature."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain, groupby
from math import dist
from typing import Any, NoReturn

from ...types.attrs import evolve, frozen
from ...types.checking import describe
from ..doors import MAX_DOOR_OFFSET
from ..earth import south_west
from ..enclosure import LATTICE_SPACING
from ..geometry import Ring, find_crossing
from ..plan import Anchor, FloorPlanError, PlanFinding, Point, at, naming, on_level

MAX_CORNERS = 1_000_000
"""Largest number of points in a file: more than any building has."""

MAX_NUMBER = 1e9
"""Limit on the absolute value of a number: more than any coordinate in any unit."""

Position = tuple[float, float]
"""Coordinates in a file: (x, y) in m, or (longitude, latitude) in degrees."""

ToPlan = Callable[[Position], Point]
"""Function from the file's coordinates to the plan's."""

MAX_CLOSING_DISTANCE = 0.05
"""Largest distance between the first and last point of a closed ring, m."""

MIN_LOOP = LATTICE_SPACING * LATTICE_SPACING
"""Area of the smaller loop of an outline that crosses itself from which on it must be mended, m^2."""

_DEPTHS = {"Point": 0, "MultiPoint": 1, "LineString": 1, "MultiLineString": 2, "Polygon": 2, "MultiPolygon": 3}
"""Number of lists around a position in the coordinates of each geometry."""


@frozen
class Feature:
    """One feature of a GeoJSON file.

    `name` is for error messages. `lines` holds the parts of the geometry with their lines: of a polygon the outline,
    then the holes; of points one line."""

    id: str
    name: str
    kind: str
    properties: dict[str, Any]
    geometry: str = "none"
    lines: tuple[tuple[tuple[Position, ...], ...], ...] = ()

    def fail(self, what: str) -> NoReturn:
        """Raise FloorPlanError with the feature's name and `what`."""
        raise FloorPlanError(f"{self.name}: {what}")

    def text(self, key: str, default: str | None = None) -> str:
        """Return a property as text; `default` replaces a missing one.

        Raises FloorPlanError when both are missing, and when the property is neither a text nor a number."""
        value = self.properties.get(key)
        value = default if value is None else value
        if isinstance(value, str):
            return value
        if _is_number(value):
            return f"{value:g}" if isinstance(value, float) else str(value)
        return self.fail(f"its {key} is missing" if value is None else f"its {key} is {describe(value)}, not a text")

    def number(self, key: str) -> float | None:
        """Return a property that must be a number; None when it is missing."""
        value = self.properties.get(key)
        return None if value is None else parse_number(value, f"{self.name}: its {key}")

    def whole_number(self, key: str) -> int | None:
        """Return a property that must be a whole number; None when it is missing."""
        value = self.number(key)
        if value is not None and value != int(value):
            self.fail(f"its {key} is {value:g}, not a whole number")
        return None if value is None else int(value)

    def ordinal(self) -> int:
        """Return the ordinal of a level; raise FloorPlanError without an ordinal or an id."""
        if not self.id:
            self.fail("a level needs an id")
        ordinal = self.whole_number("ordinal")
        return self.fail("its ordinal is missing") if ordinal is None else ordinal

    def convert_line(self, line: Iterable[Position], to_plan: ToPlan) -> list[Point]:
        """Return the points of a line of the feature, m, plan frame."""
        with naming(f"{self.name}:"):
            return [to_plan(position) for position in line]

    def polygons(self, to_plan: ToPlan, level: str, remarks: list[PlanFinding]) -> list[tuple[Ring, ...]]:
        """Return the outline and the holes of each polygon of the feature, m, plan frame.

        An outline that does not close is added to the remarks."""
        found = [tuple([self._ring(line, to_plan, level, remarks) for line in part]) for part in self.lines if part]
        return found or self.fail("has no outline")

    def _ring(self, line: tuple[Position, ...], to_plan: ToPlan, level: str, remarks: list[PlanFinding]) -> Ring:
        drawn = [point for point, _ in groupby(self.convert_line(line, to_plan))]
        is_closed = not drawn or dist(drawn[0], drawn[-1]) <= MAX_CLOSING_DISTANCE
        corners = drawn[:-1] if is_closed else drawn
        if corners and corners[0] == corners[-1]:
            corners = corners[:-1]
        if len(corners) < 3:
            self.fail("its outline has fewer than three corners")
        if not is_closed:
            remarks.append(open_outline(level, self.name, drawn))
        else:
            remarks += crossed_outline(level, self.name, tuple(corners))
        return tuple(corners)


def open_outline(level: str, name: str, line: Sequence[Point]) -> PlanFinding:
    """Return that the outline of what has this name does not close; a gap as wide as a wall is thick may be meant."""
    far = dist(line[0], line[-1])
    what = f"{name}: its outline does not close, it ends at {at(line[-1])}, {far:.2f} m from where it begins"
    return on_level(level, what, line[-1], act=far > MAX_DOOR_OFFSET)


def crossed_outline(level: str, name: str, ring: Ring) -> list[PlanFinding]:
    """Return that the outline of what has this name crosses itself, if it does; a small loop may be a slip."""
    crossing = find_crossing(ring)
    if crossing is None:
        return []
    place, loop = crossing
    return [on_level(level, f"{name}: its outline crosses itself at {at(place)}", place, act=loop >= MIN_LOOP)]


def parse_json(data: bytes) -> dict[str, Any]:
    """Return the JSON object in these bytes; raise FloorPlanError when there is none."""
    try:
        value = json.loads(data.decode("utf-8-sig"), parse_constant=_reject_constant)
    except ValueError as error:
        raise FloorPlanError(f"is not JSON ({error})") from None
    except RecursionError:
        raise FloorPlanError("is nested too deeply") from None
    if not isinstance(value, dict):
        raise FloorPlanError("is not a JSON object")
    return value


def _reject_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is no number")


def read_features(collection: dict[str, Any], kind_key: str, in_properties: bool) -> Iterator[Feature]:
    """Yield the features of a FeatureCollection.

    The kind of a feature is the member `kind_key` of its properties if `in_properties`, else of the feature itself;
    with "" no kind is read."""
    if collection.get("type") != "FeatureCollection" or not isinstance(collection.get("features"), list):
        raise FloorPlanError("is not a GeoJSON FeatureCollection")
    known: dict[str, str] = {}
    corners = 0
    for i, value in enumerate(collection["features"], 1):
        number = f"feature {i} of the file"
        if not isinstance(value, dict) or value.get("type") != "Feature":
            raise FloorPlanError(f"{number} is not a GeoJSON Feature")
        raw_id = value.get("id", "")
        if not (raw_id is None or isinstance(raw_id, str) or type(raw_id) is int and abs(raw_id) < MAX_NUMBER):
            raise FloorPlanError(f"{number}: its id is {describe(raw_id)}, neither a text nor a whole number")
        own_id = "" if raw_id is None else str(raw_id)
        properties = value.get("properties")
        properties = {} if properties is None else properties
        if not isinstance(properties, dict):
            raise FloorPlanError(f"{number}: its properties are no object")
        kind = (properties if in_properties else value).get(kind_key) if kind_key else ""
        if not isinstance(kind, str):
            raise FloorPlanError(f"{f'feature {own_id[:60]!r}' if own_id else number}: its {kind_key} is missing")
        word = kind[:20] if kind.isascii() and kind.isalpha() else "feature"
        label = own_id or properties.get("name")
        name = f"{word} {label[:60]!r}" if isinstance(label, str) and label else ""
        feature = _with_geometry(Feature(own_id, name or number, kind, properties), value.get("geometry"))
        if not own_id and (first := next(chain(*feature.lines), ())):
            x, y = first[0]
            feature = evolve(feature, name=f"{name or word} at ({x:.7g}, {y:.7g})")
        if own_id:
            here = _describe_place(feature, word, number)
            if own_id in known:
                raise FloorPlanError(f"two features have the id {own_id!r}: {known[own_id]}, and {here}")
            known[own_id] = here
        corners += sum(map(len, chain(*feature.lines)))
        if corners > MAX_CORNERS:
            raise FloorPlanError(f"has more than {MAX_CORNERS} points")
        yield feature


def _describe_place(feature: Feature, word: str, number: str) -> str:
    """Return the kind of a feature and where it is: its level and its first point, or its number in the file."""
    level, first = feature.properties.get("level", feature.properties.get("level_id")), next(chain(*feature.lines), ())
    on = f" on level {describe(level)}" if isinstance(level, str | int) else ""
    return f"{word}{on} at ({first[0][0]:.7g}, {first[0][1]:.7g})" if first else f"{word}{on}, {number}"


def _with_geometry(feature: Feature, geometry: object) -> Feature:
    if geometry is None:
        return feature
    if not isinstance(geometry, dict) or not isinstance(geometry.get("type"), str):
        feature.fail("its geometry is no object with a type")
    kind = geometry["type"]
    if kind not in _DEPTHS:
        feature.fail(f"its geometry is a {kind[:30]!r}")
    positions = parse_positions(geometry.get("coordinates"), feature, _DEPTHS[kind])
    for _ in range(3 - _DEPTHS[kind]):
        positions = (positions,)
    return evolve(feature, geometry=kind, lines=positions)


def parse_positions(value: object, feature: Feature, depth: int = 0) -> Any:
    """Return a position, or positions in tuples nested like the lists."""
    if not isinstance(value, list):
        feature.fail("its coordinates are no list")
    if depth:
        return tuple([parse_positions(item, feature, depth - 1) for item in value])
    if len(value) < 2:
        feature.fail("it has a position without two coordinates")
    what = f"{feature.name}: a coordinate"
    return parse_number(value[0], what), parse_number(value[1], what)


def find_anchor(features: Iterable[Feature]) -> Anchor:
    """Return the south-west corner of all features, degrees, as an anchor."""
    return south_west([*chain(*chain(*[part for feature in features for part in feature.lines]))])


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < MAX_NUMBER  # not if NaN


def parse_number(value: Any, what: str) -> float:
    """Return the value as a number; FloorPlanError, which names it `what`, for anything else."""
    if not _is_number(value):
        raise FloorPlanError(f"{what} is {describe(value)}, not a number that can be")
    return float(value)
