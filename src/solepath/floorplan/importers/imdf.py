"""Import of the Indoor Mapping Data Format (IMDF) 1.0.0 (OGC 20-094).

An IMDF plan is an archive, or a folder, of GeoJSON files, one for each kind of feature. protocol/floorplan.md describes
their conversion. IMDF has units (rooms and other spaces) but no walls and no heights: the outlines of units become
walls (drawing.py), and levels lie one storey apart."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby, pairwise

from ..earth import Tangent
from ..geometry import Ring
from ..plan import ConnectorKind, Door, FloorPlan, FloorPlanError, Point, make_ids, naming
from .drawing import Border, ConnectorPart, Drawing, Space, Storey
from .features import Feature, find_anchor, parse_json, parse_positions, read_features

_KINDS = ("level", "unit", "opening", "fixture", "building", "venue")

FILES = ("manifest.json", *[f"{kind}.geojson" for kind in _KINDS])
"""Files of an archive that are read."""

_CONNECTORS = {
    "elevator": ConnectorKind.LIFT,
    "escalator": ConnectorKind.STAIRS,
    "stairs": ConnectorKind.STAIRS,
    "steps": ConnectorKind.STAIRS,
}

_SOLID = {"brick", "column", "concrete", "drywall", "glass", "opentobelow", "structure"}
"""Categories of units that are walls, pillars or have no floor."""

_OPEN = {"fieldofplay", "footbridge", "lobby", "movingwalkway", "parking", "platform", "ramp", "road", "terrace",
         "unenclosedarea", "vegetation", "walkway"}  # fmt: skip
"""Categories of units that have no wall between each other."""

_OBSTACLES = {"obstruction", "wall"}
"""Categories of fixtures that nobody can walk through; desks and the like may be moved."""


def read_archive(files: Mapping[str, bytes], storey: float) -> FloorPlan:
    """Return the plan in the files of an archive, by name; raise FloorPlanError when it is invalid.

    `storey` is the assumed height from one ordinal to the next, m."""
    if "manifest.json" not in files:
        raise FloorPlanError("has no manifest.json, which every IMDF archive has")
    with naming("manifest.json:"):
        manifest = parse_json(files["manifest.json"])
        version = manifest.get("version")
        if not isinstance(version, str) or not version.startswith("1."):
            raise FloorPlanError(f"is of version {version!r}; this release reads IMDF 1")
    for needed in ("level.geojson", "unit.geojson"):
        if needed not in files:
            raise FloorPlanError(f"has no {needed}")
    language = manifest.get("language")
    return _ImdfReader(files, language if isinstance(language, str) else "en").plan(storey)


def _read_features(files: Mapping[str, bytes], kind: str) -> list[Feature]:
    name, found = f"{kind}.geojson", list[Feature]()
    with naming(f"{name}:"):
        if name in files:
            found += read_features(parse_json(files[name]), "feature_type", in_properties=False)
        for feature in found:
            if feature.kind != kind:
                feature.fail(f"is a {feature.kind[:30]!r} among the {kind}s")
    return found


class _ImdfReader:
    """The conversion of the features of one archive into a Drawing."""

    def __init__(self, files: Mapping[str, bytes], language: str) -> None:
        self._language = language
        self._levels, self._units, self._openings, self._fixtures, self._buildings, venues = [
            _read_features(files, kind) for kind in _KINDS
        ]
        names = [self._label(feature, "name") for feature in self._buildings + venues]
        self._drawing = Drawing(next(filter(None, names), ""))
        self._anchor = find_anchor(self._levels + self._units)
        self._to_plan = Tangent(self._anchor).place
        self._names: dict[str, str] = {}

    def _label(self, feature: Feature, key: str) -> str:
        """Return a LABELS value in the archive's language, else in English, else in any other language; "" for none."""
        labels = feature.properties.get(key)
        if not isinstance(labels, dict):
            return ""
        texts = {tag: text for tag, text in labels.items() if isinstance(text, str)}
        preferred = (self._language, self._language.split("-")[0], "en", *sorted(texts))
        return next((texts[tag] for tag in preferred if tag in texts), "")

    def _name(self, feature: Feature) -> str:
        """Return the name of a unit or an opening, else its other name, "" when it has none."""
        return self._label(feature, "name") or self._label(feature, "alt_name")

    def plan(self, storey: float) -> FloorPlan:
        self._storeys()
        for feature in self._units:
            self._unit(feature)
        for feature in self._fixtures:
            if feature.text("category", "") in _OBSTACLES:
                self._space(feature, self._level(feature), Border.SOLID)
        for feature in self._openings:
            self._opening(feature)
        return self._drawing.plan(self._anchor, storey)

    def _storeys(self) -> None:
        """Add the levels.

        The id of each is its short name, else its name, else that of the feature, with the name of its building where
        several levels have the same one, and with a number where that is not enough."""
        levels = sorted(self._levels, key=lambda feature: (feature.ordinal(), feature.id))
        names = [self._label(one, "short_name") or self._label(one, "name") or one.id for one in levels]
        whole = [name if names.count(name) == 1 else f"{self._building(feature)} {name}".strip()
                 for feature, name in zip(levels, names, strict=True)]  # fmt: skip
        for feature, name in zip(levels, make_ids([(name, "level") for name in whole]), strict=True):
            ordinal = feature.ordinal()
            self._names[feature.id] = name
            self._drawing.storeys[name] = Storey(self._label(feature, "name") or name, ordinal, float(ordinal))
            if feature.properties.get("outdoor") is not True:
                self._space(feature, name, Border.SOLID)

    def _building(self, level: Feature) -> str:
        """Return the name of the first building of a level, "" when none is known."""
        known, ids = {one.id: one for one in self._buildings}, level.properties.get("building_ids")
        named = [self._label(known[one], "name") for one in ids if one in known] if isinstance(ids, list) else []
        return next(filter(None, named), "")

    def _level(self, feature: Feature) -> str:
        level = feature.properties.get("level_id")
        if not isinstance(level, str) or level not in self._names:
            feature.fail(f"is on level {str(level)[:60]!r}, which the archive does not have")
        return self._names[level]

    def _unit(self, feature: Feature) -> None:
        level, category = self._level(feature), feature.text("category", "unspecified")
        kind = _CONNECTORS.get(category)
        if kind is None:
            border = Border.SOLID if category in _SOLID else Border.OPEN if category in _OPEN else Border.WALL
            self._space(feature, level, border)
            return
        for i, rings in enumerate(self._rings(feature, level)):
            point = None if i else self._display_point(feature)
            name, group = self._name(feature), f"{feature.id or feature.name}.{i}"
            self._drawing.parts.append(ConnectorPart(kind, name, level, point, rings, group))

    def _display_point(self, feature: Feature) -> Point | None:
        value = feature.properties.get("display_point")
        if not isinstance(value, dict) or value.get("type") != "Point":
            return None
        return feature.convert_line([parse_positions(value.get("coordinates"), feature)], self._to_plan)[0]

    def _space(self, feature: Feature, level: str, border: Border) -> None:
        name = self._name(feature)
        self._drawing.storeys[level].spaces += [Space(rings, border, name) for rings in self._rings(feature, level)]

    def _opening(self, feature: Feature) -> None:
        level = self._level(feature)
        if feature.geometry != "LineString":
            feature.fail("an opening is a LineString")
        points = [point for point, _ in groupby(feature.convert_line(feature.lines[0][0], self._to_plan))]
        name = self._name(feature)
        self._drawing.storeys[level].doors += [Door(a, b, name) for a, b in pairwise(points)]

    def _rings(self, feature: Feature, level: str) -> list[tuple[Ring, ...]]:
        """Return the outline and the holes of each polygon."""
        if feature.geometry not in ("Polygon", "MultiPolygon"):
            feature.fail(f"is no Polygon but a {feature.geometry}")
        return feature.polygons(self._to_plan, level, self._drawing.remarks)
