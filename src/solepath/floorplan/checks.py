"""Checks of a floor plan: faults that make it unusable, and warnings about a usable one."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from ..types.attrs import evolve
from .crossing import MOST_CELLS, Walls
from .enclosure import MOST_PLACES, Enclosure
from .grid import CELLS, PLACES, share
from .plan import Connector, FloorPlan, Level, Point
from .records import FARTHEST, misshapen, shown
from .rooms import Rooms

WIDEST = 5000.0
"""Largest width of a building, m: the longest are 4 km."""
NARROWEST = 1.0
"""Smallest width of a building, m: none is narrower than a step."""

HIGHEST_STOREY = 50.0
"""Largest height from one level to the next, m."""

MOST_LEVELS = 1000
MOST_STOPS = 2000
"""Largest number of stops of all stairs and lifts: a lift of twenty storeys has twenty."""
MOST_WALLS = 100_000
MOST_CORNERS = 100_000
"""Largest number of corners of rooms, stairwells and cabins, and of doors."""
LONGEST = 500e3
"""Largest total length of all walls, doors and outlines, m: grids are laid along them."""


def unusable(plan: FloorPlan) -> str | None:
    """Return the first fault that makes a plan unusable, in one line; None when it is usable.

    The limits are those of protocol/floorplan.md."""
    return next(_faults(plan), None)


def _faults(plan: FloorPlan) -> Iterator[str]:
    yield from misshapen(plan)
    if not plan.levels:
        yield "the plan has no levels"
    yield from _faults_of_size(plan)
    ids = set()
    for level in plan.levels:
        if not level.id:
            yield "a level has no id"
        if level.id in ids:
            yield f"two levels have the id {level.id!r}"
        ids.add(level.id)
    for level in plan.levels:
        yield from _faults_of_level(level)
    yield from _faults_of_units(plan)
    elevations = {level.id: level.elevation for level in plan.levels}
    for one in plan.connectors:
        yield from _faults_of_connector(one, elevations)
    yield from _faults_of_length(plan)
    anchor = plan.anchor
    if anchor is not None:
        if not abs(anchor.bearing) <= 10.0:
            yield f"the anchor's bearing is {shown(anchor.bearing)} rad"
        if not (abs(anchor.latitude) <= 89.0 and abs(anchor.longitude) <= 180.0):
            yield f"the anchor is at latitude {shown(anchor.latitude)}, longitude {shown(anchor.longitude)}"


def _faults_of_size(plan: FloorPlan) -> Iterator[str]:
    if len(plan.levels) > MOST_LEVELS or sum(len(level.walls) for level in plan.levels) > MOST_WALLS:
        yield f"the plan has more than {MOST_LEVELS} levels or {MOST_WALLS} walls"
    if len(plan.connectors) > MOST_STOPS or sum(len(one.stops) for one in plan.connectors) > MOST_STOPS:
        yield f"the plan's stairs and lifts have more than {MOST_STOPS} stops"
    corners = sum(len(level.doors) + sum(map(len, level.rooms)) for level in plan.levels)
    corners += sum(len(stop.outline) for one in plan.connectors for stop in one.stops)
    if corners > MOST_CORNERS:
        yield f"the plan has more than {MOST_CORNERS} doors and corners of rooms"


def _faults_of_length(plan: FloorPlan) -> Iterator[str]:
    lines = [(wall.start, wall.end) for level in plan.levels for wall in level.walls]
    lines += [(door.start, door.end) for level in plan.levels for door in level.doors]
    rings = [room for level in plan.levels for room in level.rooms]
    rings += [stop.outline for one in plan.connectors for stop in one.stops]
    lines += [line for ring in rings for line in zip(ring, (*ring[1:], *ring[:1]), strict=True)]
    long = sum([hypot(b[0] - a[0], b[1] - a[1]) for a, b in lines])
    if long > LONGEST:
        yield (f"the walls, doors and rooms of the plan come to {long / 1000.0:.0f} km; it can have "
               f"{LONGEST / 1000.0:.0f}")  # fmt: skip


def _faults_of_level(level: Level) -> Iterator[str]:
    name = f"level {level.id!r}"
    if not abs(level.elevation) <= FARTHEST:
        yield f"{name}: its elevation is {shown(level.elevation)}"
    for what, points in _drawn(level):
        for point in points:
            if not _is_place(point):
                yield f"{name}: {what} is at {shown(point)}"
    for i, wall in enumerate(level.walls):
        if wall.start == wall.end:
            yield f"{name}: wall {i} has no length, at {shown(wall.start)}"
    for i, room in enumerate(level.rooms):
        if len(room) < 3:
            yield f"{name}: room {i} has {len(room)} corners"


def _faults_of_connector(one: Connector, elevations: dict[str, float]) -> Iterator[str]:
    name = f"{one.kind.value} {one.name!r}"
    if not one.stops:
        yield f"{name}: has no stops"
    before = None
    for stop in one.stops:
        if stop.level not in elevations:
            yield f"{name}: stops at level {stop.level!r}, which the plan does not have"
            return
        for point in (stop.place, *stop.outline):
            if not _is_place(point):
                yield f"{name}: its stop at level {stop.level!r} is at {shown(point)}"
        if len(stop.outline) in (1, 2):
            yield f"{name}: its outline at level {stop.level!r} has {len(stop.outline)} corners"
        if before is not None and not elevations[stop.level] > before:
            yield f"{name}: its stops are not from the lowest to the highest"
        before = elevations[stop.level]
    if one.flights is not None and not 1 <= one.flights <= 100:
        yield f"{name}: has {shown(one.flights)} flights a storey"
    if one.rise is not None and not 0.02 <= one.rise <= 0.6:
        yield f"{name}: its steps rise {shown(one.rise)} m"


def _faults_of_units(plan: FloorPlan) -> Iterator[str]:
    points = [point for level in plan.levels for _, drawn in _drawn(level) for point in drawn]
    points += [point for one in plan.connectors for stop in one.stops for point in (stop.place, *stop.outline)]
    if any(not _is_place(point) for point in points) or not points:
        return
    wide = max([max(axis) - min(axis) for axis in zip(*points, strict=True)])
    if wide > WIDEST:
        yield f"the plan is {wide:.0f} wide; it must be in metres, is it in millimetres or another unit?"
    if wide < NARROWEST and any(level.walls or level.rooms for level in plan.levels):
        yield f"the plan is {wide:.2g} wide; it must be in metres, is it in degrees or another unit?"
    for below, above in zip(plan.levels, plan.levels[1:], strict=False):
        storey = above.elevation - below.elevation
        if storey < 0.0:
            yield f"level {above.id!r} comes after level {below.id!r} and lies below it"
        if storey > HIGHEST_STOREY:
            yield (f"level {above.id!r} lies {storey:.0f} above level {below.id!r}; elevations must be in metres, "
                   f"are they in millimetres or another unit?")  # fmt: skip


def _drawn(level: Level) -> Iterator[tuple[str, tuple[Point, ...]]]:
    for i, wall in enumerate(level.walls):
        yield f"wall {i}", (wall.start, wall.end)
    for i, door in enumerate(level.doors):
        yield f"door {i}", (door.start, door.end)
    for i, room in enumerate(level.rooms):
        yield f"room {i}", room


def _is_place(point: Point) -> bool:
    return abs(point[0]) <= FARTHEST and abs(point[1]) <= FARTHEST  # False for NaN


def warnings(plan: FloorPlan) -> tuple[str, ...]:
    """Return the warnings about a usable plan, one line each.

    They are the remarks of its reader, walls that do not close, no stairs or lifts, and levels that none of them leads
    to. Takes about as long as indexing the plan."""
    return (*plan.remarks, *_remarks(plan)) if unusable(plan) is None else ()


def _remarks(plan: FloorPlan) -> Iterator[str]:
    if not plan.heights_known and len(plan.levels) > 1:
        yield "the plan does not say how high its levels lie"
    count = len(plan.levels)
    cells, places = share(MOST_CELLS, CELLS, count), share(MOST_PLACES, PLACES, count)
    for level in plan.levels:
        yield from _remarks_of_walls(level, cells, places)
    if not plan.connectors:
        yield "the plan has no stairs and no lifts: nothing on it shows a level or a place"
    for one in plan.connectors:
        if len(one.stops) == 1:
            yield f"{one.kind.value} {one.name!r}: stops at level {one.stops[0].level!r} only"
    if plan.connectors and len(plan.levels) > 1:
        led_to = {stop.level for one in plan.connectors if len(one.stops) > 1 for stop in one.stops}
        for level in plan.levels:
            if level.id not in led_to:
                yield f"level {level.id!r}: neither stairs nor a lift lead there"


def _remarks_of_walls(level: Level, cells: int, places: int) -> Iterator[str]:
    if not level.walls:
        yield f"level {level.id!r}: has no walls"
        return
    found = Enclosure(level, Walls([(wall.start, wall.end) for wall in level.walls], cells), places)
    opening: Point | None = found.open_end
    if level.rooms:
        rooms = Rooms(evolve(level, doors=()), (), places)  # without doors, since a doorstep is no room
        opening = next((place for place in found.outside if rooms.inside(*place)), None)
    if opening is not None:
        yield f"level {level.id!r}: its walls do not close near ({opening[0]:.1f}, {opening[1]:.1f})"
