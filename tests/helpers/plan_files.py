"""Files of floor plans in the profile of protocol/floorplan.md, as a program that draws plans writes them."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from solepath.floorplan.importers.geojson import FORMAT, VERSION
from solepath.floorplan.plan import FloorPlan


def format_floorplan(plan: FloorPlan) -> str:
    """Return the file's text, with one feature a line."""
    head: dict[str, Any] = {"type": "FeatureCollection", "format": FORMAT, "version": VERSION, "name": plan.name,
                            "frame": "local", "elevations": "known" if plan.heights_known else "assumed"}  # fmt: skip
    if plan.anchor is not None:
        head["anchor"] = {"latitude": plan.anchor.latitude, "longitude": plan.anchor.longitude,
                          "bearing": plan.anchor.bearing}  # fmt: skip
    head_text = json.dumps(head, allow_nan=False)
    lines = ",\n".join(json.dumps(feature, allow_nan=False) for feature in _written(plan))
    return f'{head_text[:-1]}, "features": [\n{lines}\n]}}\n'


def _written(plan: FloorPlan) -> Iterable[dict[str, Any]]:
    for level in plan.levels:
        properties = {"name": level.name, "ordinal": level.ordinal, "elevation": level.elevation}
        yield {**_feature("level", None, properties), "id": level.id}
    for level in plan.levels:
        on_level = {"level": level.id}
        for wall in level.walls:
            yield _feature("wall", _geometry("LineString", [wall.start, wall.end]), on_level)
        for door in level.doors:
            yield _feature("door", _geometry("LineString", [door.start, door.end]), {**on_level, "name": door.name})
        for i, room in enumerate(level.rooms):
            named = {**on_level, "name": level.room_names[i]} if level.room_names else on_level
            yield _feature("room", _geometry("Polygon", [[*room, room[0]]]), named)
    for i, connector in enumerate(plan.connectors):
        counts = {"flights": connector.flights, "rise": connector.rise}
        known = {key: value for key, value in counts.items() if value is not None}
        for stop in connector.stops:
            properties = {"level": stop.level, "name": connector.name, "connector": str(i), **known}
            if stop.outline:
                outline = _geometry("Polygon", [[*stop.outline, stop.outline[0]]])
                yield _feature(connector.kind.value, outline, {**properties, "place": stop.place})
            else:
                yield _feature(connector.kind.value, _geometry("Point", stop.place), properties)


def _geometry(kind: str, coordinates: object) -> dict[str, Any]:
    return {"type": kind, "coordinates": coordinates}


def _feature(kind: str, geometry: dict[str, Any] | None, properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "properties": {"feature": kind, **properties}, "geometry": geometry}
