"""Checks of the types in a floor plan's records, which a program can fill with anything."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .plan import Anchor, Connector, ConnectorKind, ConnectorStop, Door, FloorPlan, Level, Start, Wall

MAX_COORDINATE = 1e7
"""Largest absolute coordinate from the plan's origin, m: national grids have up to 1e7."""

MAX_ORDINAL = 100_000
"""Largest absolute ordinal of a storey."""

MAX_SPREAD = 5000.0
"""Largest spread of a start, m: the largest width of a building."""

MAX_HEADING = 1000.0
"""Largest absolute heading, rad."""


def find_type_faults(plan: FloorPlan) -> Iterator[str]:
    """Yield one line for each field that is not of the type that plan.py declares.

    Only the first line is reliable: later checks assume that everything before them is right."""
    yield from _check_kind("the plan", plan, FloorPlan)
    yield from _check_text("the plan's name", plan.name)
    yield from _check_kind("heights_known", plan.heights_known, bool)
    for noun, values, type_ in (("level", plan.levels, Level), ("connector", plan.connectors, Connector),
                             ("remark", plan.remarks, str)):  # fmt: skip
        yield from _check_all(f"the plan's {noun}s", values, type_)
    for level in plan.levels:
        yield from _check_level(level)
    for connector in plan.connectors:
        yield from _check_connector(connector)
    if plan.anchor is not None:
        yield from _check_kind("the anchor", plan.anchor, Anchor)
        for name in ("latitude", "longitude", "bearing"):
            yield from _check_number(f"the anchor's {name}", getattr(plan.anchor, name))


def _check_level(level: Level) -> Iterator[str]:
    yield from _check_text("a level's id", level.id)
    name = f"level {level.id!r}"
    yield from _check_text(f"{name}: its name", level.name)
    if isinstance(level.ordinal, bool) or not isinstance(level.ordinal, int) or abs(level.ordinal) > MAX_ORDINAL:
        yield f"{name}: its ordinal is {describe(level.ordinal)}, not a whole number up to {MAX_ORDINAL}"
    yield from _check_number(f"{name}: its elevation", level.elevation)
    for noun, values, type_ in (("wall", level.walls, Wall), ("door", level.doors, Door), ("room", level.rooms, tuple)):
        yield from _check_all(f"{name}: its {noun}s", values, type_)
    for i, wall in enumerate(level.walls):
        if not (_is_point(wall.start) and _is_point(wall.end)):
            yield f"{name}: wall {i} is {describe((wall.start, wall.end))}, not from (x, y) to (x, y)"
    for i, door in enumerate(level.doors):
        if not (_is_point(door.start) and _is_point(door.end)):
            yield f"{name}: door {i} is {describe((door.start, door.end))}, not from (x, y) to (x, y)"
        yield from _check_text(f"{name}: the name of door {i}", door.name)
    for i, room in enumerate(level.rooms):
        for point in room:
            if not _is_point(point):
                yield f"{name}: room {i} has a corner {describe(point)}, not (x, y)"
    yield from _check_all(f"{name}: the names of its rooms", level.room_names, str)
    if len(level.room_names) not in (0, len(level.rooms)):
        yield f"{name}: has {len(level.room_names)} names of rooms and {len(level.rooms)} rooms"


def _check_connector(connector: Connector) -> Iterator[str]:
    yield from _check_kind("a connector's kind", connector.kind, ConnectorKind)
    yield from _check_text("a connector's name", connector.name)
    name = f"{connector.kind.value} {connector.name!r}"
    yield from _check_all(f"{name}: its stops", connector.stops, ConnectorStop)
    for stop in connector.stops:
        yield from _check_text(f"{name}: the level of a stop", stop.level)
        yield from _check_all(f"{name}: an outline", stop.outline, tuple)
        for point in (stop.place, *stop.outline):
            if not _is_point(point):
                yield f"{name}: a stop has a place {describe(point)}, not (x, y)"
    if connector.flights is not None and (
        isinstance(connector.flights, bool) or not isinstance(connector.flights, int)
    ):
        yield f"{name}: has {describe(connector.flights)} flights, not a whole number"
    if connector.rise is not None:
        yield from _check_number(f"{name}: the rise of a step", connector.rise)


def find_start_fault(start: Start) -> str | None:
    """Return why this start is invalid on any plan, in one line; None when it is valid."""
    return next(_check_start(start), None)


def _check_start(start: Start) -> Iterator[str]:
    heading, spread = start.heading, start.spread
    if start.place is None:
        if heading is None or start.level != "":
            yield "it has no place: give level and place, or the heading alone"
    else:
        yield from _check_text("its level", start.level)
        if not (_is_point(start.place) and all([abs(value) <= MAX_COORDINATE for value in start.place])):
            yield f"its place is {describe(start.place)}, not (x, y) in m"
    if heading is not None and not (_is_number(heading) and abs(heading) <= MAX_HEADING):
        yield f"its heading is {describe(heading)}, not in rad"
    if not (_is_number(spread) and 0.0 <= spread <= MAX_SPREAD):
        yield f"its spread is {describe(spread)}; it can be 0 to {MAX_SPREAD:g} m"


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_point(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 2 and _is_number(value[0]) and _is_number(value[1])


def _check_number(what: str, value: Any) -> Iterator[str]:
    if not _is_number(value):
        yield f"{what} is {describe(value)}, not a number"


def _check_text(what: str, value: Any) -> Iterator[str]:
    if not isinstance(value, str):
        yield f"{what} is {describe(value)}, not a text"


def _check_kind(what: str, value: Any, type_: type) -> Iterator[str]:
    if not isinstance(value, type_):
        yield f"{what} is {describe(value)}, no {type_.__name__}"


def _check_all(what: str, values: Any, type_: type) -> Iterator[str]:
    if not isinstance(values, tuple):
        yield f"{what} are {describe(values)}, not a tuple"
    for value in values:
        if not isinstance(value, type_):
            yield f"{what}: one is {describe(value)}, no {type_.__name__}"


def describe(value: object) -> str:
    """Return a value for use in a sentence: short, on one line, of any type."""
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, int) and not abs(value) < 10**30:
        return "a huge number"
    if isinstance(value, tuple) and len(value) <= 3:
        return f"({', '.join([describe(item) for item in value])})"
    if isinstance(value, str | int | None):
        return repr(value)[:60]
    return f"a {type(value).__name__}"
