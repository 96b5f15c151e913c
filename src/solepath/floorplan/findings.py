"""What is wrong with a usable floor plan, in sentences with places.

A wearer is placed by what walls, doors, stairs and lifts allow. So these findings are what would exclude the true way,
or allow a wrong one: walls that do not close, a place to which no way leads, a wall through a door, a door beside all
walls, stairs or a lift that stop at one level only."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from ..types.attrs import frozen
from .checks import find_fault, scale_cells
from .doors import MAX_DOOR_OFFSET
from .enclosure import OUTSIDE, Enclosure
from .geometry import direction, distance, edges, touch
from .plan import Door, FloorPlan, Level, Point
from .rooms import EDGE_SHARE, Rooms
from .walls import Walls

MAX_WALL_DISTANCE = MAX_DOOR_OFFSET + 0.05
"""Largest distance of the end of a door from the wall that it is in, m: a door may lie on one face of its wall."""
MIN_STANDING_DISTANCE = 0.05
"""Distance of the place of a stop from a wall below which one would stand in the wall, m: half of its thickness."""
DOOR_STEPS = (0.3, 0.6, 0.9)
"""Distances from a door at which the places are that it joins, m: beyond the thickness of its wall."""


@frozen
class PlanFinding:
    """One thing that is wrong with a floor plan.

    `text` is a sentence that names level, place and id. `act`: places will be wrong until somebody mends it. `level` is
    the id of a level and `place` is in m, plan frame, where there is such a place."""

    text: str
    act: bool = False
    level: str = ""
    place: Point | None = None


def find_findings(plan: FloorPlan, *, has_start: bool = False, reach: bool = True) -> tuple[PlanFinding, ...]:
    """Return what is wrong with a usable plan: what must be mended, then the rest, the importer's remarks first.

    `has_start`: the first place is known, so that a plan without stairs and elevators needs no finding. `reach`: places
    to which no way leads are found, too, which takes most of the time, up to 0.5 s for a level. The rest takes about as
    long as indexing the plan."""
    if find_fault(plan) is not None:
        return ()
    found = [*[PlanFinding(line) for line in plan.remarks], *_find(plan, has_start, reach)]
    return tuple(sorted(found, key=lambda one: not one.act))


def find_warnings(plan: FloorPlan, *, has_start: bool = False, reach: bool = True) -> tuple[str, ...]:
    """Return the sentences of `find_findings`."""
    return tuple([one.text for one in find_findings(plan, has_start=has_start, reach=reach)])


def _at(place: Point) -> str:
    return f"({place[0]:.1f}, {place[1]:.1f})"


def _find(plan: FloorPlan, has_start: bool, reach: bool) -> Iterator[PlanFinding]:
    levels, connectors = plan.levels, plan.connectors
    if not plan.heights_known and len(levels) > 1:
        yield PlanFinding("the plan does not say how high its levels lie")
    scale = scale_cells(plan)
    walls = [Walls([wall.line for wall in level.walls], scale) for level in levels]
    for level, inner in zip(levels, walls, strict=True):
        enclosure = Enclosure(level, inner, len(levels))
        name = f"level {level.id!r}"
        if not level.walls:
            yield PlanFinding(f"{name}: has no walls", level=level.id)
            continue
        for place, what in _find_openings(level, enclosure, scale).items():
            yield PlanFinding(f"{name}: its walls do not close near {_at(place)}{what}", True, level.id, place)
        yield from _find_door_faults(plan, level, inner)
        yield from _find_unreachable(plan, level, inner, enclosure) if reach else ()
    if not connectors and not has_start:
        yield PlanFinding("the plan has no stairs and no lifts: the place on it is known by a start only")
    for name, connector in zip(plan.connector_ids, connectors, strict=True):
        what, stops = f"{connector.kind.value} {name!r}", connector.stops
        if len(stops) == 1:
            text = f"{what}: stops at level {stops[0].level!r} only, at {_at(stops[0].place)}"
            yield PlanFinding(text, len(levels) > 1, stops[0].level, stops[0].place)
        for stop in stops:
            near = walls[[level.id for level in levels].index(stop.level)].near(*stop.place)
            if any(distance(*wall, *stop.place) < MIN_STANDING_DISTANCE for wall in near):
                text = f"{what}: at level {stop.level!r} one would stand in a wall, at {_at(stop.place)}"
                yield PlanFinding(text, True, stop.level, stop.place)
    joined = {stop.level for connector in connectors if len(connector.stops) > 1 for stop in connector.stops}
    for level in levels if connectors and len(levels) > 1 else ():
        if level.id not in joined:
            yield PlanFinding(f"level {level.id!r}: neither stairs nor a lift lead there", True, level.id)


def _find_openings(level: Level, enclosure: Enclosure, scale: float) -> dict[Point, str]:
    """Return where one comes in from outside without a door, m, and into which room: the first place of each room.

    Without rooms it is the first loose end of a wall."""
    if not level.rooms:
        return dict.fromkeys(enclosure.open_ends[:1], "")
    rooms, found = Rooms(level, (), scale), dict[str, Point]()
    for place, before in enclosure.outside:
        for name in rooms.find(*place)[:1]:
            if not rooms.find(*before):  # else one comes through another room
                found.setdefault(name, place)
    return {place: f": room {name!r} is open to the outside" if name else "" for name, place in found.items()}


def _find_door_faults(plan: FloorPlan, level: Level, walls: Walls) -> Iterator[PlanFinding]:
    """Yield doors that a wall crosses, and doors that are in no wall and on no outline of a room."""
    borders = Walls([edge for ring in level.rooms for edge in edges(ring) if edge[:2] != edge[2:]], walls.scale)
    for (name, middle), door in zip(plan.places(level.id)["door"].items(), level.doors, strict=True):
        what = f"level {level.id!r}: door {name!r} at {_at(middle)}"
        (ax, ay), (bx, by) = door.start, door.end
        dx, dy = EDGE_SHARE * (bx - ax), EDGE_SHARE * (by - ay)
        inner = (ax + dx, ay + dy, bx - dx, by - dy)
        across = [wall for wall in level.walls if touch(*wall.line, *inner)] if walls.crosses(*inner) else []
        if across:
            text = f"{what} has a wall across it, from {_at(across[0].start)} to {_at(across[0].end)}"
            yield PlanFinding(text, True, level.id, middle)
        elif not any(
            distance(*wall, *end) <= MAX_WALL_DISTANCE
            for end in (door.start, door.end)
            for wall in walls.near(*end) + borders.near(*end)
        ):
            yield PlanFinding(f"{what} is in no wall", False, level.id, middle)


def _find_unreachable(plan: FloorPlan, level: Level, walls: Walls, enclosure: Enclosure) -> Iterator[PlanFinding]:
    """Yield rooms and stops to which no way leads.

    What doors join is a group. A group is reached from outside, by stairs or a lift, or, in a plan of a part of a
    building, as the one with the most rooms. Stairs and lifts are reached from a room."""
    groups = list(range(enclosure.number_regions()))
    for door in level.doors:
        joined = {groups[region] for region in _find_sides(door, walls, enclosure)}
        groups = [min(joined) if group in joined else group for group in groups]
    places = plan.places(level.id)
    # a room is where most of it is: another region in it is a shaft or a pillar
    rooms = {name: [groups[region] for region, _ in enclosure.count_regions(ring).most_common(1)]
             for name, ring in zip(places["room"], level.rooms, strict=True)}  # fmt: skip
    counts = Counter([group for name in rooms for group in rooms[name]])
    entered = {groups[OUTSIDE], *[group for group, _ in counts.most_common(1)]}
    stops = [(one, stop) for one in plan.connectors for stop in one.stops if stop.level == level.id]
    found = []
    for name, (one, stop) in zip(places["connector"], stops, strict=True):
        region = enclosure.region(*stop.place)
        around = {groups[one] for one in (enclosure.count_regions(stop.outline) if stop.outline else ())}
        around |= set() if region is None else {groups[region]}
        entered |= around if len(one.stops) > 1 else set()
        if around.isdisjoint({groups[OUTSIDE], *counts}) and around and level.rooms:
            found.append((f"{one.kind.value} {name!r}", stop.place))
    found += [(f"room {name!r}", places["room"][name]) for name, own in rooms.items() if own and own[0] not in entered]
    for what, place in found:
        yield PlanFinding(f"level {level.id!r}: no way leads to {what} at {_at(place)}", True, level.id, place)


def _find_sides(door: Door, walls: Walls, enclosure: Enclosure) -> list[int]:
    """Return the regions that an open door joins."""
    (x, y), (_, ux, uy) = door.middle, direction(door.start, door.end)
    beside = [(x - far * uy, y + far * ux) for step in DOOR_STEPS for far in (-step, step)]
    regions = [enclosure.region(*place) for place in beside if not walls.crosses(x, y, *place)]
    return [region for region in regions if region is not None]
