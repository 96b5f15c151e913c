"""Type checks of a floor plan's records: a program may have put anything into them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .plan import Anchor, Connector, ConnectorKind, ConnectorStop, Door, FloorPlan, Level, Start, Wall

FARTHEST = 1e7
"""Largest absolute coordinate from the plan's origin, m: national grids have up to 1e7."""

HIGHEST_ORDINAL = 100_000
"""Largest absolute ordinal of a storey; a reader may number underground levels freely."""

WIDEST_SPREAD = 5000.0
"""Largest spread of a start, m: a start anywhere in the largest building says nothing."""

MOST_TURNED = 1000.0
"""Largest absolute heading, rad."""


def misshapen(plan: FloorPlan) -> Iterator[str]:
    """Yield one line for each field that is not of the type that plan.py declares.

    Only the first line is reliable: later checks assume that everything before them is right."""
    yield from _kind("the plan", plan, FloorPlan)
    yield from _text("the plan's name", plan.name)
    yield from _kind("heights_known", plan.heights_known, bool)
    for what, some, kind in (("level", plan.levels, Level), ("connector", plan.connectors, Connector),
                             ("remark", plan.remarks, str)):  # fmt: skip
        yield from _all(f"the plan's {what}s", some, kind)
    for level in plan.levels:
        yield from _of_level(level)
    for one in plan.connectors:
        yield from _of_connector(one)
    if plan.anchor is not None:
        yield from _kind("the anchor", plan.anchor, Anchor)
        for name in ("latitude", "longitude", "bearing"):
            yield from _number(f"the anchor's {name}", getattr(plan.anchor, name))


def _of_level(level: Level) -> Iterator[str]:
    yield from _text("a level's id", level.id)
    name = f"level {level.id!r}"
    yield from _text(f"{name}: its name", level.name)
    if isinstance(level.ordinal, bool) or not isinstance(level.ordinal, int) or abs(level.ordinal) > HIGHEST_ORDINAL:
        yield f"{name}: its ordinal is {shown(level.ordinal)}, not a whole number up to {HIGHEST_ORDINAL}"
    yield from _number(f"{name}: its elevation", level.elevation)
    for what, some, kind in (("wall", level.walls, Wall), ("door", level.doors, Door), ("room", level.rooms, tuple)):
        yield from _all(f"{name}: its {what}s", some, kind)
    for i, wall in enumerate(level.walls):
        if not (_is_point(wall.start) and _is_point(wall.end)):
            yield f"{name}: wall {i} is {shown((wall.start, wall.end))}, not from (x, y) to (x, y)"
    for i, door in enumerate(level.doors):
        if not (_is_point(door.start) and _is_point(door.end)):
            yield f"{name}: door {i} is {shown((door.start, door.end))}, not from (x, y) to (x, y)"
        yield from _text(f"{name}: the name of door {i}", door.name)
    for i, room in enumerate(level.rooms):
        for point in room:
            if not _is_point(point):
                yield f"{name}: room {i} has a corner {shown(point)}, not (x, y)"


def _of_connector(one: Connector) -> Iterator[str]:
    yield from _kind("a connector's kind", one.kind, ConnectorKind)
    yield from _text("a connector's name", one.name)
    name = f"{one.kind.value} {one.name!r}"
    yield from _all(f"{name}: its stops", one.stops, ConnectorStop)
    for stop in one.stops:
        yield from _text(f"{name}: the level of a stop", stop.level)
        yield from _all(f"{name}: an outline", stop.outline, tuple)
        for point in (stop.place, *stop.outline):
            if not _is_point(point):
                yield f"{name}: a stop has a place {shown(point)}, not (x, y)"
    if one.flights is not None and (isinstance(one.flights, bool) or not isinstance(one.flights, int)):
        yield f"{name}: has {shown(one.flights)} flights, not a whole number"
    if one.rise is not None:
        yield from _number(f"{name}: the rise of a step", one.rise)


def no_start(start: Start) -> str | None:
    """Return why this start is invalid on any plan, in one line; None when it is valid."""
    return next(_of_start(start), None)


def _of_start(start: Start) -> Iterator[str]:
    yield from _text("its level", start.level)
    if not (_is_point(start.place) and all([abs(value) <= FARTHEST for value in start.place])):
        yield f"its place is {shown(start.place)}, not (x, y) in m"
    heading, spread = start.heading, start.spread
    if heading is not None and not (_is_number(heading) and abs(heading) <= MOST_TURNED):
        yield f"its heading is {shown(heading)}, not in rad"
    if not (_is_number(spread) and 0.0 <= spread <= WIDEST_SPREAD):
        yield f"its spread is {shown(spread)}; it can be 0 to {WIDEST_SPREAD:g} m"


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_point(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 2 and _is_number(value[0]) and _is_number(value[1])


def _number(what: str, value: Any) -> Iterator[str]:
    if not _is_number(value):
        yield f"{what} is {shown(value)}, not a number"


def _text(what: str, value: Any) -> Iterator[str]:
    if not isinstance(value, str):
        yield f"{what} is {shown(value)}, not a text"


def _kind(what: str, value: Any, kind: type) -> Iterator[str]:
    if not isinstance(value, kind):
        yield f"{what} is {shown(value)}, no {kind.__name__}"


def _all(what: str, some: Any, kind: type) -> Iterator[str]:
    if not isinstance(some, tuple):
        yield f"{what} are {shown(some)}, not a tuple"
    for one in some:
        if not isinstance(one, kind):
            yield f"{what}: one is {shown(one)}, no {kind.__name__}"


def shown(value: object) -> str:
    """Return a value for use in a sentence: short, on one line, of any type."""
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, int) and not abs(value) < 10**30:
        return "a huge number"
    if isinstance(value, tuple) and len(value) <= 3:
        return f"({', '.join([shown(one) for one in value])})"
    if isinstance(value, str | int | None):
        return repr(value)[:60]
    return f"a {type(value).__name__}"
