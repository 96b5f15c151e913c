"""Walks through an emulated building, with the true position of the wearer on its plan.

way = wandering(seed=7)
walker = Walker(way.route, seed=7)
session = Session(recipe, floorplan=way.building.plan, start=way.start)
way.places(walker, t)"""

from __future__ import annotations

from collections import deque
from itertools import pairwise
from math import cos, pi

import numpy as np
from attrs import field, frozen

from ...floorplan.plan import Point, Start
from ..wearers.curves import Array, Rng
from ..wearers.walker import Walker
from .building import EDGE_OFFSET, FOUR_LOOPS, GOING, GROUND, LANE_OFFSET, UPPER, Building, Cabin, Well, unit
from .course import OTHER_LEVEL, Course, plan_track, wrapped
from .path import ahead
from .route import Route

MAX_OFFSET = 0.3
"""Largest distance of a random walk from the middle of the corridors, m."""
MIN_CORNERS, MAX_CORNERS = 3, 7
"""Least and largest number of corners of a random walk before it heads for its exit."""
STAIRS_APPROACH = 4.0
"""Distance walked along the corridor before or after stairs on the other floor, m."""

Passage = Cabin | Well


@frozen
class BuildingWalk:
    """A route through the building."""

    route: Route
    """Route of the wearer."""
    start: Start
    """Start on the plan."""
    level: str
    """Id of the level between entry and exit."""
    entry: str = ""
    """Name of the elevator or stairs by which the wearer comes to the level; "" when the walk starts there."""
    exit: str = ""
    """Name of the elevator or stairs by which the wearer leaves the level; "" when the walk ends there."""
    building: Building = field(default=FOUR_LOOPS, repr=False)
    """Building of the walk."""

    def places(self, walker: Walker, t: Array | float) -> list[tuple[str, float, float]]:
        """Return level id, x and y (plan frame, m) of the middle between both ankles at times `t`, s.

        In an elevator and on stairs the level is the nearer one."""
        when = np.atleast_1d(np.asarray(t, dtype=np.float64))
        x, y = self.track(walker, when).T
        floors = {level.id: level.elevation for level in self.building.plan.levels}
        high = floors[self.start.level] + walker.truth().elevation(when)
        levels = [min(floors, key=lambda name: abs(floors[name] - z)) for z in high.tolist()]
        return list(zip(levels, x.tolist(), y.tolist(), strict=True))

    def track(self, walker: Walker, t: Array) -> Array:
        """Return x and y (plan frame, m) of the middle between both ankles at times `t`, s, (N, 2)."""
        return plan_track(self.start, walker, t)


def case_study() -> BuildingWalk:
    """Return the walk of section V-F of Liu et al. 2015.

    The wearer goes down by the elevator at the bottom left, along corridors, and away by another elevator. The paper
    gives no lengths; this walk turns five times on the floor."""
    a, b = FOUR_LOOPS.cabins[:2]
    course = Course(UPPER, a.middle, a.door_heading)
    course.stand()
    course.ride()
    west, middle, east = FOUR_LOOPS.columns
    south, centre, _ = FOUR_LOOPS.rows
    bends = ((west, a.middle[1]), (west, south), (middle, south), (middle, centre), (east, centre), (east, b.middle[1]))
    course.walk_along([*bends, b.middle])
    course.face(b.door_heading)
    course.ride()
    course.stand()
    return BuildingWalk(course.route, course.start, GROUND, a.name, b.name)


def wandering(seed: int, building: Building = FOUR_LOOPS) -> BuildingWalk:
    """Return a random walk that enters a floor by an elevator or stairs and leaves it by another one."""
    rng = np.random.default_rng([seed, 5])
    level = (GROUND, UPPER)[int(rng.integers(2))]
    connectors: list[Passage] = [*building.cabins, *building.wells]
    entry, departure = (connectors[int(k)] for k in rng.choice(len(connectors), 2, replace=False))
    offsets = rng.uniform(-MAX_OFFSET, MAX_OFFSET, 2)
    dx, dy = float(offsets[0]), float(offsets[1])
    lines = _Lines(tuple([x + dx for x in building.columns]), tuple([y + dy for y in building.rows]))
    course = _arrival_course(entry, level, lines)
    start, end = lines.turning_point(entry, level), lines.turning_point(departure, level)
    course.walk_along([*_random_path(lines.network(start, end), start, end, rng), _standing_point(departure, level)])
    _add_departure(course, departure, level, lines)
    course.stand()
    return BuildingWalk(course.route, course.start, level, entry.name, departure.name, building)


def _standing_point(connector: Passage, level: str) -> Point:
    """Return the point where the wearer stands in a cabin, or before the first edge of the stairs."""
    if isinstance(connector, Cabin):
        return connector.middle
    lane = -LANE_OFFSET if level == GROUND else LANE_OFFSET  # the lane whose stairs end on this level
    return connector.inside(EDGE_OFFSET - ahead(level == GROUND, GOING), lane)


@frozen
class _Lines:
    """The lines along which the wearer walks in the corridors."""

    columns: tuple[float, ...]
    """Coordinates x of those that run north, m."""
    rows: tuple[float, ...]
    """Coordinates y of those that run east, m."""

    def turning_point(self, connector: Passage, level: str) -> Point:
        """Return the point where the wearer turns into a cabin or a stairwell, on the walked line of its corridor."""
        x, y = _standing_point(connector, level)
        if abs(cos(connector.door_heading)) > 0.5:
            return (min(self.columns, key=lambda column: abs(column - x)), y)
        return (x, min(self.rows, key=lambda row: abs(row - y)))

    def network(self, *turnings: Point) -> dict[Point, list[Point]]:
        """Return the crossings and turning points of the corridors, each with its neighbours along them."""
        places = {*turnings, *((x, y) for x in self.columns for y in self.rows)}
        nodes: dict[Point, list[Point]] = {place: [] for place in sorted(places)}
        lines = [sorted(place for place in places if place[0] == x) for x in self.columns]
        lines += [sorted(place for place in places if place[1] == y) for y in self.rows]
        for line in lines:
            for point, neighbour in pairwise(line):
                nodes[point].append(neighbour)
                nodes[neighbour].append(point)
        return nodes


def _random_path(nodes: dict[Point, list[Point]], start: Point, end: Point, rng: Rng) -> list[Point]:
    """Return a path that does not turn back: random for some corners, then with the fewest points to `end`."""
    path = [start, nodes[start][int(rng.integers(len(nodes[start])))]]
    corners = int(rng.integers(MIN_CORNERS, MAX_CORNERS + 1))
    while corners > 0 or path[-1] == end:
        onward = _next_points(nodes, path)
        path.append(onward[int(rng.integers(len(onward)))])
        corners -= len(path) > 2 and not _is_straight(*path[-3:])
    paths = deque([path[-2:]])
    known = {(path[-2], path[-1])}
    while paths[0][-1] != end:
        path_so_far = paths.popleft()
        for place in _next_points(nodes, path_so_far):
            if (path_so_far[-1], place) not in known:
                known.add((path_so_far[-1], place))
                paths.append([*path_so_far, place])
    return [*path[:-2], *paths[0]]


def _next_points(nodes: dict[Point, list[Point]], path: list[Point]) -> list[Point]:
    """Return the possible next points; only at a corridor's end it is the previous point."""
    return [place for place in nodes[path[-1]] if place != path[-2]] or [path[-2]]


def _is_straight(a: Point, b: Point, c: Point) -> bool:
    return a[0] == b[0] == c[0] or a[1] == b[1] == c[1]


def _arrival_course(connector: Passage, level: str, lines: _Lines) -> Course:
    """Return a course from the other floor to `level`; it ends in the cabin, or after the stairs."""
    if isinstance(connector, Cabin):
        course = Course(OTHER_LEVEL[level], connector.middle, connector.door_heading)
        course.stand()
        course.ride()
        return course
    before, turning = _approach(connector, OTHER_LEVEL[level], lines)
    course = Course(OTHER_LEVEL[level], before, wrapped(connector.inward - 0.5 * pi))
    course.stand()
    course.walk_along([turning, _standing_point(connector, OTHER_LEVEL[level])])
    course.climb(up=level == UPPER)
    return course


def _approach(well: Well, level: str, lines: _Lines) -> tuple[Point, Point]:
    """Return a point in the corridor, with the stairwell ahead to the left, and where the wearer turns into it."""
    (x, y), (ux, uy) = lines.turning_point(well, level), unit(well.inward - 0.5 * pi)
    return (x - STAIRS_APPROACH * ux, y - STAIRS_APPROACH * uy), (x, y)


def _add_departure(course: Course, connector: Passage, level: str, lines: _Lines) -> None:
    """Continue the course from a cabin, or from the first edge of stairs, to the other floor."""
    if isinstance(connector, Cabin):
        course.face(connector.door_heading)
        course.ride()
        return
    course.climb(up=level == GROUND)
    before, turning = _approach(connector, OTHER_LEVEL[level], lines)
    course.walk_along([turning, before])
