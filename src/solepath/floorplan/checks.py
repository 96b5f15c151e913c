"""Checks of a floor plan: faults that make it unusable. findings.py has what is wrong with a usable plan."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import dist, fsum, sqrt

from ..types import checking
from ..types.checking import describe
from .plan import MAX_COORDINATE, Connector, FloorPlan, at

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

MAX_AREA = 2e6
"""Largest area of all levels of a plan whose cells (walls.py, rooms.py) have the usual size, m^2."""


def scale_cells(plan: FloorPlan) -> float:
    """Return the factor of the side of all cells of a plan: 1, or more where its cells would be too many.

    Larger cells give the same answers, after a longer search."""
    width, depth = _measure(plan)
    return max(1.0, sqrt(len(plan.levels) * width * depth / MAX_AREA))


def _measure(plan: FloorPlan) -> list[float]:
    """Return width and depth of all levels together, m."""
    places = [point for _, _, points in plan.shapes() for point in points]
    return [max(axis) - min(axis) for axis in zip(*places, strict=True)] or [0.0, 0.0]


def find_fault(plan: FloorPlan) -> str | None:
    """Return the first fault that makes a plan unusable, in one line; None when it is usable.

    The limits are those of protocol/floorplan.md."""
    return next(_find_faults(plan), None)


def _find_faults(plan: FloorPlan) -> Iterator[str]:
    """Yield faults; only the first is reliable, since each check relies on those before it."""
    fault = checking.find_fault(plan, FloorPlan)
    if fault is not None:
        yield str(fault)
    levels, connectors = plan.levels, plan.connectors
    if not levels:
        yield "the plan has no levels"
    walls = sum(len(level.walls) for level in levels)
    for count, most, what in ((len(levels), MAX_LEVELS, "levels"), (walls, MAX_WALLS, "walls")):
        if count > most:
            yield f"the plan has {count} {what}, more than {most} {what}"
    if max(len(connectors), sum(len(connector.stops) for connector in connectors)) > MAX_STOPS:
        yield f"the plan's stairs and lifts have more than {MAX_STOPS} stops"
    corners = sum(len(points) for kind, _, points in plan.shapes() if kind in ("room", "outline"))
    if corners + sum(len(level.doors) for level in levels) > MAX_CORNERS:
        yield f"the plan has more than {MAX_CORNERS} doors and corners of rooms"
    elevations: dict[str, float] = {}
    for level in levels:
        if not level.id:
            yield "a level has no id"
        if level.id in elevations:
            yield f"two levels have the id {level.id!r}"
        if not abs(level.elevation) <= MAX_COORDINATE:
            yield f"level {level.id!r}: its elevation is {describe(level.elevation)}"
        elevations[level.id] = level.elevation
    lengths = []
    for kind, name, points in plan.shapes():
        for point in points:
            if not all([abs(value) <= MAX_COORDINATE for value in point]):  # also if it is NaN
                yield f"{name} is at {describe(point)}"
        if kind == "wall" and points[0] == points[1]:
            yield f"{name} has no length, at {describe(points[0])}"
        if kind == "room" and len(points) < 3 or kind == "outline" and len(points) in (1, 2):
            yield f"{name} has {len(points)} corners{f', at {describe(points[0])}' if points else ''}"
        lengths += [dist(a, b) for a, b in pairwise(points if kind in ("wall", "door") else points + points[:1])]
    yield from _find_faults_of_units(plan)
    for connector in connectors:
        yield from _find_faults_of_connector(connector, elevations)
    if fsum(lengths) > MAX_TOTAL_LENGTH:
        yield (f"the walls, doors and rooms of the plan come to {fsum(lengths) / 1000.0:.0f} km; they can have "
               f"{MAX_TOTAL_LENGTH / 1000.0:.0f} km")  # fmt: skip


def _find_faults_of_units(plan: FloorPlan) -> Iterator[str]:
    width = max(_measure(plan))
    if width > MAX_BUILDING_WIDTH:
        yield f"the plan is {width:.0f} m wide; it must be in metres, is it in millimetres or another unit?"
    if width < MIN_BUILDING_WIDTH and any(level.walls or level.rooms for level in plan.levels):
        yield f"the plan is {width:.2g} m wide; it must be in metres, is it in degrees or another unit?"
    for below, above in pairwise(plan.levels):
        storey = above.elevation - below.elevation
        if storey < 0.0:
            yield f"level {above.id!r} comes after level {below.id!r} and lies below it"
        if storey > MAX_STOREY_HEIGHT:
            yield (f"level {above.id!r} lies {storey:.0f} m above level {below.id!r}; elevations must be in metres, "
                   f"are they in millimetres or another unit?")  # fmt: skip


def _find_faults_of_connector(connector: Connector, elevations: dict[str, float]) -> Iterator[str]:
    name = connector.label
    if not connector.stops:
        yield f"{name}: has no stops"
    where = "".join([f"{name} at level {stop.level!r}, {at(stop.place)}" for stop in connector.stops[:1]])
    for stop in connector.stops:
        if stop.level not in elevations:
            yield f"{name}: stops at level {stop.level!r}, which the plan does not have"
    heights = [elevations[stop.level] for stop in connector.stops]
    if any(high <= low for low, high in pairwise(heights)):
        yield f"{name}: its stops are not from the lowest to the highest"
    if connector.flights is not None and not 1 <= connector.flights <= MAX_FLIGHTS:
        yield f"{where}: has {describe(connector.flights)} flights a storey; it can have 1 to {MAX_FLIGHTS}"
    if connector.rise is not None and not MIN_RISE <= connector.rise <= MAX_RISE:
        limits = f"they can rise {MIN_RISE} m to {MAX_RISE} m"
        yield f"{where}: its steps rise {describe(connector.rise)} m; {limits}; is that in another unit?"
