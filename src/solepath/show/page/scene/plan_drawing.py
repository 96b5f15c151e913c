"""A floor plan as a page draws it."""

from __future__ import annotations

from functools import partial
from typing import Any
from weakref import ref

from ....floorplan.plan import Connector, Door, FloorPlan, Level, Wall
from ..messages import Written, placed, shown

_known: dict[int, tuple[ref[FloorPlan], Written]] = {}
"""By the plan's identity, since to compare or hash a large one takes as long as to draw it. What is drawn goes when its
plan does."""


def drawn(plan: FloorPlan) -> Written:
    """As "plan" of a scene: lines and outlines of each level, and where stairs and lifts stop; plan frame, m. A plan is
    drawn once, however many scenes and watchers there are: what comes back is shared and not to be changed. The first
    time takes some 10 us a wall."""
    key = id(plan)
    found = _known.get(key)
    if found is not None and found[0]() is plan:
        return found[1]
    drawing = Written(
        name=plan.name,
        levels=[_level(level) for level in plan.levels],
        connectors=[_connector(one) for one in plan.connectors],
    )
    _known[key] = ref(plan, partial(_forget, _known, key)), drawing
    return drawing


def _forget(known: dict[int, tuple[ref[FloorPlan], Written]], key: int, gone: ref[FloorPlan]) -> None:
    known.pop(key, None)


def _level(level: Level) -> dict[str, Any]:
    return {
        "id": level.id,
        "name": level.name,
        "elevation": shown(level.elevation),
        "walls": [_line(wall) for wall in level.walls],
        "doors": [_line(door) for door in level.doors],
        "rooms": [[placed(point) for point in room] for room in level.rooms],
    }


def _line(one: Wall | Door) -> list[float | None]:
    return placed((*one.start, *one.end))


def _connector(one: Connector) -> dict[str, Any]:
    stops = [
        {"level": stop.level, "place": placed(stop.place), "outline": [placed(point) for point in stop.outline]}
        for stop in one.stops
    ]
    return {"kind": one.kind.value, "name": one.name, "stops": stops}
