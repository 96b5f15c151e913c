"""Turns a floor plan into what a page draws."""

from __future__ import annotations

from typing import Any

from ....floorplan.plan import Connector, Door, FloorPlan, Level, Wall
from ..messages import EncodedOnce, rounded, rounded_all


def draw_plan(plan: FloorPlan) -> EncodedOnce:
    """Return the member "plan" of a scene, in the plan frame, m.

    It holds lines and outlines of each level, and the stops of stairs and elevators. Computing takes some 10 us a wall.
    """
    return EncodedOnce(
        name=plan.name,
        levels=[_level(level) for level in plan.levels],
        connectors=[_connector(connector) for connector in plan.connectors],
    )


def _level(level: Level) -> dict[str, Any]:
    return {
        "id": level.id,
        "name": level.name,
        "elevation": rounded(level.elevation),
        "walls": [_line(wall) for wall in level.walls],
        "doors": [_line(door) for door in level.doors],
        "rooms": [[rounded_all(point) for point in room] for room in level.rooms],
        "room_names": list(level.room_names),
    }


def _line(wall: Wall | Door) -> list[float | None]:
    return rounded_all((*wall.start, *wall.end))


def _connector(connector: Connector) -> dict[str, Any]:
    stops = [
        {
            "level": stop.level,
            "place": rounded_all(stop.place),
            "outline": [rounded_all(point) for point in stop.outline],
        }
        for stop in connector.stops
    ]
    return {"kind": connector.kind.value, "name": connector.name, "stops": stops}
