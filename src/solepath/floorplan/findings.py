"""What is wrong with a usable floor plan, in sentences with places.

A wearer is placed by what walls, doors, stairs and lifts allow. So these findings are what would exclude the true way,
or allow a wrong one: walls that do not close, a place to which no way leads, a wall through a door, a door beside all
walls, stairs or a lift that stop at one level only, in a wall or outside, a lift that moves aside, rooms over each
other, another unit than the metre."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, pairwise
from math import dist

from .checks import find_fault, scale_cells
from .doors import MAX_DOOR_OFFSET, MAX_DOOR_WIDTH, MIN_DOOR_WIDTH
from .enclosure import OUTSIDE, Cell, Enclosure
from .geometry import direction, distance, edges, touch
from .plan import Connector, ConnectorKind, ConnectorStop, Door, FloorPlan, Level, PlanFinding, Point, at, on_level
from .rooms import EDGE_SHARE, Rooms
from .walls import Walls

MAX_WALL_DISTANCE = MAX_DOOR_OFFSET + 0.05
"""Largest distance of the end of a door from the wall that it is in, m: a door may lie on one face of its wall."""
MIN_STANDING_DISTANCE = 0.05
"""Distance of the place of a stop from a wall below which one would stand in the wall, m: half of its thickness."""
DOOR_STEPS = (0.3, 0.6, 0.9)
"""Distances from a door at which the places are that it joins, m: beyond the thickness of its wall."""


MAX_SHIFT = 6.0
"""Largest distance between the places at which one leaves a lift on two levels, m: the deepest cabins are 3 m, with
doors at both ends and a step before each."""
MIN_SHARED_POINTS, MIN_SHARED, NESTED = 4, 0.25, 0.9
"""Points of the lattice, and share of the smaller room's, from which on two rooms overlap, and share from which on the
smaller one lies within the other; less is the thickness of a wall. Chosen by hand."""
MAX_LAYERS = 8
"""Largest number of rooms at one point that are compared."""
MAX_NAMES = 4
"""Largest number of rooms, stairs and lifts that a sentence names."""

Places = dict[str, Point]
"""Places of what has these ids, m."""
Stop = tuple[str, Connector, ConnectorStop]
"""A stop with the kind and the id of its stairs or lift."""


def find_findings(plan: FloorPlan, *, has_start: bool = False, reach: bool = True) -> tuple[PlanFinding, ...]:
    """Return what is wrong with a usable plan: what needs fixing, then the rest, the importer's remarks first.

    `has_start`: the first place is known, so that a plan without stairs and elevators needs no finding. `reach`: places
    to which no way leads are found, too, which takes most of the time, up to 0.5 s for a level. The rest takes about as
    long as indexing the plan."""
    if find_fault(plan) is not None:
        return ()
    found = [*plan.remarks, *_find(plan, has_start, reach)]
    return tuple(sorted(found, key=lambda one: not one.act))


def find_warnings(plan: FloorPlan, *, has_start: bool = False, reach: bool = True) -> tuple[str, ...]:
    """Return the sentences of `find_findings`."""
    return tuple([one.text for one in find_findings(plan, has_start=has_start, reach=reach)])


def _find(plan: FloorPlan, has_start: bool, reach: bool) -> Iterator[PlanFinding]:
    levels = plan.levels
    if not plan.heights_known and len(levels) > 1:
        yield PlanFinding("the plan does not say how high its levels lie")
    if plan.anchor is not None and not plan.has_degrees:
        x, y = plan.origin
        yield PlanFinding(
            f"the plan has no longitude and latitude: its anchor is at (0, 0), and ({x:.0f}, {y:.0f}) is far"
        )
    yield from _find_unit_faults(plan)
    named = [(f"{one.kind.value} {name!r}", one)
             for name, one in zip(plan.connector_ids, plan.connectors, strict=True)]  # fmt: skip
    scale = scale_cells(plan)
    for level in levels:
        walls = Walls([wall.line for wall in level.walls], scale)
        stops = [(what, one, stop) for what, one in named for stop in one.stops if stop.level == level.id]
        for what, _, stop in stops:
            if any(distance(*wall, *stop.place) < MIN_STANDING_DISTANCE for wall in walls.near(*stop.place)):
                text = f"{what}: at level {level.id!r} one would stand in a wall, at {at(stop.place)}"
                yield PlanFinding(text, True, level.id, stop.place)
        if not level.walls:
            yield on_level(level.id, "has no walls", act=False)
            continue
        enclosure, rooms = Enclosure(level, walls, len(levels)), Rooms(level, (), scale)
        for place, what in _find_openings(level, enclosure, rooms).items():
            yield on_level(level.id, f"its walls do not close near {at(place)}{what}", place)
        outer = [(what, stop.place) for what, _, stop in stops
                 if not (enclosure.inside(*stop.place) or rooms.inside(*stop.place))]  # fmt: skip
        for what, place in outer[:1]:
            others = _others(", and so are", [name for name, _ in outer])
            yield on_level(level.id, f"{what} at {at(place)} is outside of all walls and rooms{others}", place)
        places = plan.places(level.id)
        yield from _find_door_faults(places["door"], level, walls)
        if reach:
            yield from _find_overlaps(places["room"], level, enclosure)
            yield from _find_unreachable(places["room"], level, stops, walls, enclosure)
    if not plan.connectors and not has_start:
        yield PlanFinding("the plan has no stairs and no lifts: the place on it is known by a start only")
    for what, one in named:
        yield from _find_connector_faults(what, one, len(levels))
    joined = {stop.level for one in plan.connectors if len(one.stops) > 1 for stop in one.stops}
    for level in levels if plan.connectors and len(levels) > 1 else ():
        if level.id not in joined:
            yield on_level(level.id, "neither stairs nor a lift lead there")


def _find_unit_faults(plan: FloorPlan) -> Iterator[PlanFinding]:
    """Yield the middle one of all doors, in the order of their widths, if no door is so wide."""
    doors = sorted([(dist(door.start, door.end), level.id, number)
                    for level in plan.levels for number, door in enumerate(level.doors)])  # fmt: skip
    for width, level, number in doors[len(doors) // 2 :][:1]:
        if not MIN_DOOR_WIDTH <= width <= MAX_DOOR_WIDTH:
            name, place = [*plan.places(level)["door"].items()][number]
            what = f"door {name!r} at {at(place)} is {width:.3g} m wide, as most are"
            yield on_level(level, f"{what}; a plan must be in metres, is it in centimetres or another unit?", place)


def _find_connector_faults(what: str, one: Connector, levels: int) -> Iterator[PlanFinding]:
    first, stops = one.stops[0], one.stops
    if len(stops) == 1:
        text = f"{what}: stops at level {first.level!r} only, at {at(first.place)}"
        yield PlanFinding(text, levels > 1, first.level, first.place)
    for low, high in pairwise(stops if one.kind is ConnectorKind.LIFT else ()):
        if (aside := dist(low.place, high.place)) > MAX_SHIFT:
            text = f"{what}: from level {low.level!r} to {high.level!r} it goes {aside:.1f} m aside"
            text = f"{text}, from {at(low.place)} to {at(high.place)}"
            yield PlanFinding(text, True, high.level, high.place)


def _find_openings(level: Level, enclosure: Enclosure, rooms: Rooms) -> dict[Point, str]:
    """Return where one comes in from outside without a door, m, and into which room: the first place of each room.

    Without rooms it is the first loose end of a wall."""
    if not level.rooms:
        return dict.fromkeys(enclosure.open_ends[:1], "")
    found = dict[str, Point]()
    for place, before in enclosure.outside:
        for name in rooms.find(*place)[:1]:
            if not rooms.find(*before):  # else one comes through another room
                found.setdefault(name, place)
    return {place: f": room {name!r} is open to the outside" if name else "" for name, place in found.items()}


def _find_door_faults(places: Places, level: Level, walls: Walls) -> Iterator[PlanFinding]:
    """Yield doors that a wall crosses, and doors that are in no wall and on no outline of a room."""
    borders = Walls([edge for ring in level.rooms for edge in edges(ring) if edge[:2] != edge[2:]], walls.scale)
    for (name, middle), door in zip(places.items(), level.doors, strict=True):
        what = f"door {name!r} at {at(middle)}"
        (ax, ay), (bx, by) = door.start, door.end
        dx, dy = EDGE_SHARE * (bx - ax), EDGE_SHARE * (by - ay)
        inner = (ax + dx, ay + dy, bx - dx, by - dy)
        across = [wall for wall in level.walls if touch(*wall.line, *inner)] if walls.crosses(*inner) else []
        if across:
            ends = f"from {at(across[0].start)} to {at(across[0].end)}"
            yield on_level(level.id, f"{what} has a wall across it, {ends}", middle)
        elif not any(
            distance(*wall, *end) <= MAX_WALL_DISTANCE
            for end in (door.start, door.end)
            for wall in walls.near(*end) + borders.near(*end)
        ):
            yield on_level(level.id, f"{what} is in no wall", middle, act=False)


def _find_overlaps(places: Places, level: Level, enclosure: Enclosure) -> Iterator[PlanFinding]:
    """Yield rooms that lie over each other, neither within the other one as a booth in a hall."""
    points = {name: enclosure.find_points(ring)
              for name, ring in zip(places, level.rooms, strict=True)}  # fmt: skip
    rooms: dict[Cell, list[str]] = {}
    for name, own in points.items():
        for point in own:
            rooms.setdefault(point, []).append(name)
    shared: dict[tuple[str, str], list[Cell]] = {}
    for point, names in rooms.items():
        for pair in combinations(names[:MAX_LAYERS], 2):
            shared.setdefault(pair, []).append(point)
    for pair, both in shared.items():
        less, more = sorted([len(points[name]) for name in pair])
        is_within = len(both) >= NESTED * less and less < NESTED * more
        if len(both) >= max(MIN_SHARED_POINTS, MIN_SHARED * less) and not is_within:
            place = enclosure.point(*both[len(both) // 2])
            what = f"rooms {' and '.join(map(repr, pair))} lie over each other at {at(place)}"
            yield on_level(level.id, what, place, act=False)


def _find_unreachable(
    places: Places, level: Level, stops: list[Stop], walls: Walls, enclosure: Enclosure
) -> Iterator[PlanFinding]:
    """Yield rooms and stops to which no way leads.

    What doors join is a group. A group is entered from outside, by stairs or by a lift; only where none is, in a plan
    of a part of a building, that with the most rooms. Stairs and lifts are entered from a room."""
    groups = list(range(enclosure.number_regions()))
    for door in level.doors:
        joined = {groups[region] for region in _find_sides(door, walls, enclosure)}
        groups = [min(joined) if group in joined else group for group in groups]
    rooms = dict[int, list[str]]()
    for name, ring in zip(places, level.rooms, strict=True):
        # a room is where most of it is: another region in it is a shaft or a pillar
        for region, _ in enclosure.count_regions(ring).most_common(1):
            rooms.setdefault(groups[region], []).append(name)
    entered = {groups[OUTSIDE]}
    for what, one, stop in stops:
        here = enclosure.region(*stop.place)
        around = {groups[one] for one in (enclosure.count_regions(stop.outline) if stop.outline else ())}
        around |= set() if here is None else {groups[here]}
        entered |= around if len(one.stops) > 1 else set()
        if around.isdisjoint({groups[OUTSIDE], *rooms}) and around and level.rooms:
            yield on_level(level.id, f"no way leads to {what} at {at(stop.place)}", stop.place)
    if entered.isdisjoint(rooms):
        entered.add(max(rooms, key=lambda group: len(rooms[group]), default=OUTSIDE))
    for group in [one for one in rooms if one not in entered]:
        names, place = [f"room {name!r}" for name in rooms[group]], places[rooms[group][0]]
        what = f"no way leads to {names[0]} at {at(place)}{_others(', nor to', names)}"
        yield on_level(level.id, what, place)


def _others(words: str, names: list[str]) -> str:
    """Return words and the names after the first one, with the number of those that are too many; "" for one name."""
    more = f" and {len(names) - MAX_NAMES} more" if len(names) > MAX_NAMES else ""
    return f"{words} {', '.join(names[1:MAX_NAMES])}{more}" if len(names) > 1 else ""


def _find_sides(door: Door, walls: Walls, enclosure: Enclosure) -> list[int]:
    """Return the regions that an open door joins."""
    (x, y), (_, ux, uy) = door.middle, direction(door.start, door.end)
    beside = [(x - far * uy, y + far * ux) for step in DOOR_STEPS for far in (-step, step)]
    regions = [enclosure.region(*place) for place in beside if not walls.crosses(x, y, *place)]
    return [region for region in regions if region is not None]
