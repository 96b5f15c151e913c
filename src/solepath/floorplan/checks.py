"""Checks of a floor plan: faults that make it unusable, and warnings about a usable plan."""

from __future__ import annotations

from collections.abc import Iterator
from math import fsum, hypot

from ..types import checking
from ..types.attrs import evolve
from ..types.checking import describe
from .crossing import MAX_CELLS, Walls
from .enclosure import MAX_LATTICE_POINTS, Enclosure
from .grid import MAX_CELLS_PER_PLAN, MAX_LATTICE_POINTS_PER_PLAN, share_limit
from .plan import MAX_COORDINATE, Connector, FloorPlan, Level, Point
from .rooms import Rooms

MAX_BUILDING_WIDTH = 5000.0
"""Largest width of a building, m: the longest are 4 km."""
MIN_BUILDING_WIDTH = 1.0
"""Smallest width of a building, m: none is narrower than a step."""

MAX_STOREY_HEIGHT = 50.0
"""Largest height from one level to the next, m."""

MIN_RISE, MAX_RISE = 0.02, 0.6
"""Range of the height of one tread of stairs, m."""
MAX_FLIGHTS = 100
MAX_LEVELS = 1000
MAX_STOPS = 2000
"""Largest number of stops of all stairs and elevators: an elevator of twenty storeys has twenty."""
MAX_WALLS = 100_000
MAX_CORNERS = 100_000
"""Largest number of doors and of corners of rooms, stairwells and cabins together."""
MAX_TOTAL_LENGTH = 500e3
"""Largest total length of all walls, doors and outlines, m: the time of indexing grows with it."""


def find_fault(plan: FloorPlan) -> str | None:
    """Return the first fault that makes a plan unusable, in one line; None when it is usable.

    The limits are those of protocol/floorplan.md."""
    return next(_find_faults(plan), None)


def _find_faults(plan: FloorPlan) -> Iterator[str]:
    fault = checking.find_fault(plan, FloorPlan)
    if fault is not None:
        yield str(fault)
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
    for connector in plan.connectors:
        yield from _faults_of_connector(connector, elevations)
    yield from _faults_of_length(plan)


def _faults_of_size(plan: FloorPlan) -> Iterator[str]:
    if len(plan.levels) > MAX_LEVELS or sum(len(level.walls) for level in plan.levels) > MAX_WALLS:
        yield f"the plan has more than {MAX_LEVELS} levels or {MAX_WALLS} walls"
    if len(plan.connectors) > MAX_STOPS or sum(len(one.stops) for one in plan.connectors) > MAX_STOPS:
        yield f"the plan's stairs and lifts have more than {MAX_STOPS} stops"
    corners = sum(len(level.doors) + sum(map(len, level.rooms)) for level in plan.levels)  # whole numbers
    corners += sum(len(stop.outline) for one in plan.connectors for stop in one.stops)
    if corners > MAX_CORNERS:
        yield f"the plan has more than {MAX_CORNERS} doors and corners of rooms"


def _faults_of_length(plan: FloorPlan) -> Iterator[str]:
    lines = [(wall.start, wall.end) for level in plan.levels for wall in level.walls]
    lines += [(door.start, door.end) for level in plan.levels for door in level.doors]
    rings = [room for level in plan.levels for room in level.rooms]
    rings += [stop.outline for one in plan.connectors for stop in one.stops]
    lines += [line for ring in rings for line in zip(ring, (*ring[1:], *ring[:1]), strict=True)]
    length = fsum([hypot(b[0] - a[0], b[1] - a[1]) for a, b in lines])
    if length > MAX_TOTAL_LENGTH:
        yield (f"the walls, doors and rooms of the plan come to {length / 1000.0:.0f} km; it can have "
               f"{MAX_TOTAL_LENGTH / 1000.0:.0f}")  # fmt: skip


def _faults_of_level(level: Level) -> Iterator[str]:
    name = f"level {level.id!r}"
    if not abs(level.elevation) <= MAX_COORDINATE:
        yield f"{name}: its elevation is {describe(level.elevation)}"
    for name_of_shape, points in _features_drawn(level):
        for point in points:
            if not _is_place(point):
                yield f"{name}: {name_of_shape} is at {describe(point)}"
    for i, wall in enumerate(level.walls):
        if wall.start == wall.end:
            yield f"{name}: wall {i} has no length, at {describe(wall.start)}"
    for i, room in enumerate(level.rooms):
        if len(room) < 3:
            yield f"{name}: room {i} has {len(room)} corners"


def _faults_of_connector(connector: Connector, elevations: dict[str, float]) -> Iterator[str]:
    name = f"{connector.kind.value} {connector.name!r}"
    if not connector.stops:
        yield f"{name}: has no stops"
    elevation_below = None
    for stop in connector.stops:
        if stop.level not in elevations:
            yield f"{name}: stops at level {stop.level!r}, which the plan does not have"
            return
        for point in (stop.place, *stop.outline):
            if not _is_place(point):
                yield f"{name}: its stop at level {stop.level!r} is at {describe(point)}"
        if len(stop.outline) in (1, 2):
            yield f"{name}: its outline at level {stop.level!r} has {len(stop.outline)} corners"
        if elevation_below is not None and not elevations[stop.level] > elevation_below:
            yield f"{name}: its stops are not from the lowest to the highest"
        elevation_below = elevations[stop.level]
    if connector.flights is not None and not 1 <= connector.flights <= MAX_FLIGHTS:
        yield f"{name}: has {describe(connector.flights)} flights a storey"
    if connector.rise is not None and not MIN_RISE <= connector.rise <= MAX_RISE:
        yield f"{name}: its steps rise {describe(connector.rise)} m"


def _faults_of_units(plan: FloorPlan) -> Iterator[str]:
    points = [point for level in plan.levels for _, shape_points in _features_drawn(level) for point in shape_points]
    points += [point for one in plan.connectors for stop in one.stops for point in (stop.place, *stop.outline)]
    if any(not _is_place(point) for point in points) or not points:
        return
    width = max([max(axis) - min(axis) for axis in zip(*points, strict=True)])
    if width > MAX_BUILDING_WIDTH:
        yield f"the plan is {width:.0f} wide; it must be in metres, is it in millimetres or another unit?"
    if width < MIN_BUILDING_WIDTH and any(level.walls or level.rooms for level in plan.levels):
        yield f"the plan is {width:.2g} wide; it must be in metres, is it in degrees or another unit?"
    for below, above in zip(plan.levels, plan.levels[1:], strict=False):
        storey = above.elevation - below.elevation
        if storey < 0.0:
            yield f"level {above.id!r} comes after level {below.id!r} and lies below it"
        if storey > MAX_STOREY_HEIGHT:
            yield (f"level {above.id!r} lies {storey:.0f} above level {below.id!r}; elevations must be in metres, "
                   f"are they in millimetres or another unit?")  # fmt: skip


def _features_drawn(level: Level) -> Iterator[tuple[str, tuple[Point, ...]]]:
    for i, wall in enumerate(level.walls):
        yield f"wall {i}", (wall.start, wall.end)
    for i, door in enumerate(level.doors):
        yield f"door {i}", (door.start, door.end)
    for i, room in enumerate(level.rooms):
        yield f"room {i}", room


def _is_place(point: Point) -> bool:
    return abs(point[0]) <= MAX_COORDINATE and abs(point[1]) <= MAX_COORDINATE  # False for NaN


def find_warnings(plan: FloorPlan, *, has_start: bool = False) -> tuple[str, ...]:
    """Return the warnings about a usable plan, one line each; takes about as long as indexing the plan.

    They are the importer's remarks, walls that do not close, and missing stairs and elevators. `has_start`: the first
    place is known, so that a plan without stairs and elevators needs no warning."""
    return (*plan.remarks, *_find_remarks(plan, has_start)) if find_fault(plan) is None else ()


def _find_remarks(plan: FloorPlan, has_start: bool) -> Iterator[str]:
    if not plan.heights_known and len(plan.levels) > 1:
        yield "the plan does not say how high its levels lie"
    count = len(plan.levels)
    cells = share_limit(MAX_CELLS, MAX_CELLS_PER_PLAN, count)
    points = share_limit(MAX_LATTICE_POINTS, MAX_LATTICE_POINTS_PER_PLAN, count)
    for level in plan.levels:
        yield from _remarks_of_walls(level, cells, points)
    if not plan.connectors and not has_start:
        yield "the plan has no stairs and no lifts: the place on it is known by a start only"
    for connector in plan.connectors:
        if len(connector.stops) == 1:
            yield f"{connector.kind.value} {connector.name!r}: stops at level {connector.stops[0].level!r} only"
    if plan.connectors and len(plan.levels) > 1:
        joined_levels = {
            stop.level for connector in plan.connectors if len(connector.stops) > 1 for stop in connector.stops
        }
        for level in plan.levels:
            if level.id not in joined_levels:
                yield f"level {level.id!r}: neither stairs nor a lift lead there"


def _remarks_of_walls(level: Level, cells: int, points: int) -> Iterator[str]:
    if not level.walls:
        yield f"level {level.id!r}: has no walls"
        return
    enclosure = Enclosure(level, Walls([(wall.start, wall.end) for wall in level.walls], cells), points)
    opening: Point | None = enclosure.open_end
    if level.rooms:
        rooms = Rooms(evolve(level, doors=()), (), points)  # without doors, since a doorstep is no room
        opening = next((place for place in enclosure.outside if rooms.inside(*place)), None)
    if opening is not None:
        yield f"level {level.id!r}: its walls do not close near ({opening[0]:.1f}, {opening[1]:.1f})"
