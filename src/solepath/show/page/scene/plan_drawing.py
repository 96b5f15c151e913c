"""Turns a floor plan into what a page draws."""

from __future__ import annotations

from typing import Any

from ....floorplan.plan import Door, FloorPlan, Level, Wall
from ..messages import members, plain

PlanDrawing = dict[str, Any]
"""Member "plan" of a scene."""


def draw_plan(plan: FloorPlan | PlanDrawing | None) -> PlanDrawing | None:
    """Return the member "plan" of a scene, in the plan frame, m; a drawing and None are returned as they are.

    It holds lines and outlines of each level, and the stops of stairs and elevators. Computing takes some 10 us a wall.
    """
    if not isinstance(plan, FloorPlan):
        return plan
    connectors = [
        members(one, "kind", "name") | {"stops": [members(stop, "level", "place", "outline") for stop in one.stops]}
        for one in plan.connectors
    ]
    return {"name": plan.name, "levels": [*map(_level, plan.levels)], "connectors": connectors}


def _level(level: Level) -> dict[str, Any]:
    lines = {"walls": _lines(level.walls), "doors": _lines(level.doors)}
    return members(level, "id", "name", "elevation", "rooms", "room_names") | lines


def _lines(walls: tuple[Wall, ...] | tuple[Door, ...]) -> Any:
    return plain([(*wall.start, *wall.end) for wall in walls])
