"""Walks through BUILDING, with the true position of the wearer on its plan.

way = wandering(seed=7)
walker = Walker(way.route, seed=7)
session = Session(recipe, floorplan=BUILDING, start=way.start)
way.places(walker, t)"""

from __future__ import annotations

from collections import deque
from itertools import pairwise
from math import cos, pi, sin

import numpy as np
from attrs import frozen

from ...floorplan.plan import Point, Start
from ...types import Foot
from ..wearers.curves import Array, Rng
from ..wearers.shoe import Mounting
from ..wearers.walker import Walker
from .building import (
    APPROACH,
    BUILDING,
    CABINS,
    COLUMNS,
    GOING,
    GROUND,
    LANE,
    NORTH,
    ROWS,
    UPPER,
    WELLS,
    Cabin,
    Well,
    in_well,
)
from .course import OTHER_LEVEL, Course
from .path import ahead
from .route import Route

MAX_OFFSET = 0.3
"""Largest distance of a random walk from the middle of the corridors, m."""
FEWEST, MOST = 3, 7
"""Least and largest number of corners of a random walk before it heads for its exit."""
RUN_UP = 4.0
"""Distance walked along the corridor before and after stairs on the other floor, m."""
_ELEVATION = {level.id: level.elevation for level in BUILDING.levels}

Exit = Cabin | Well


@frozen
class BuildingWalk:
    """A route through the building."""

    route: Route
    """Route of the wearer."""
    start: Start
    """Start on the plan."""
    level: str
    """Id of the level of the walk."""
    entry: str = ""
    """Name of the lift or stairs by which the wearer comes to the level; "" when the walk starts there."""
    exit: str = ""
    """Name of the lift or stairs by which the wearer leaves the level; "" when the walk ends there."""

    def places(self, walker: Walker, t: Array | float) -> list[tuple[str, float, float]]:
        """Return level, x and y (plan frame, m) of the middle between both ankles at times `t`, s.

        In a lift and on stairs it is the nearer level."""
        when = np.atleast_1d(np.asarray(t, dtype=np.float64))
        x, y = self.track(walker, when).T
        high = _ELEVATION[self.start.level] + walker.truth().elevation(when)
        levels = [min(_ELEVATION, key=lambda name: abs(_ELEVATION[name] - z)) for z in high.tolist()]
        return list(zip(levels, x.tolist(), y.tolist(), strict=True))

    def track(self, walker: Walker, t: Array) -> Array:
        """Return x and y (plan frame, m) of the middle between both ankles at times `t`, s, (N, 2)."""
        ankle = Mounting((walker.wearer.shoe.ankle[0], 0.0, 0.0))
        middle = 0.5 * sum(walker.kinematics(foot, t, ankle).position[:, :2] for foot in Foot)
        heading = self.start.heading or 0.0
        c, s = cos(heading), sin(heading)
        return np.asarray(middle @ np.array([[c, s], [-s, c]]) + np.array(self.start.place))


def case_study() -> BuildingWalk:
    """Return the walk of section V-F of Liu et al. 2015.

    It goes down by the lift at the bottom left, along corridors, and away by another lift. The paper gives no lengths;
    this walk turns five times on the floor."""
    a, b = CABINS[:2]
    course = Course(UPPER, a.middle, a.out)
    course.stand()
    course.ride()
    west, middle, east = COLUMNS
    south, centre, _ = ROWS
    bends = ((west, a.middle[1]), (west, south), (middle, south), (middle, centre), (east, centre), (east, b.middle[1]))
    course.along([*bends, b.middle])
    course.face(b.out)
    course.ride()
    course.stand()
    return BuildingWalk(course.route, course.start, GROUND, a.name, b.name)


def corridor() -> BuildingWalk:
    """Return 63 m straight on from door to door, as the long corridor of section V-D of Liu et al. 2015."""
    course = Course(GROUND, (COLUMNS[0], 0.0), 0.5 * pi)
    course.stand()
    course.along([(COLUMNS[0], NORTH)])
    course.stand()
    return BuildingWalk(course.route, course.start, GROUND)


def wandering(seed: int) -> BuildingWalk:
    """Return a random walk that comes to a floor by a lift or stairs, follows corridors and leaves by another exit."""
    rng = np.random.default_rng([seed, 5])
    level = (GROUND, UPPER)[int(rng.integers(2))]
    exits: list[Exit] = [*CABINS, *WELLS]
    one, other = (exits[int(k)] for k in rng.choice(len(exits), 2, replace=False))
    off = rng.uniform(-MAX_OFFSET, MAX_OFFSET, 2)
    dx, dy = float(off[0]), float(off[1])
    course = _arriving(one, level, dx, dy)
    start, end = _beside(one, level, dx, dy), _beside(other, level, dx, dy)
    course.along([*_strolled(_network(dx, dy, start, end), start, end, rng), _inside(other, level)])
    _leaving(course, other, level, dx, dy)
    course.stand()
    return BuildingWalk(course.route, course.start, level, one.name, other.name)


def _inside(one: Exit, level: str) -> Point:
    """Return the point where the wearer stands in a cabin, or before the first edge of the stairs."""
    if isinstance(one, Cabin):
        return one.middle
    lane = -LANE if level == GROUND else LANE  # the lane that starts, and ends, on this level
    return in_well(one, APPROACH - ahead(level == GROUND, GOING), lane)


def _beside(one: Exit, level: str, dx: float, dy: float) -> Point:
    """Return the point where the wearer turns into a cabin or a stairwell, on the walked line of its corridor."""
    x, y = _inside(one, level)
    heading = one.out if isinstance(one, Cabin) else one.inward
    if abs(cos(heading)) > 0.5:
        return (min(COLUMNS, key=lambda column: abs(column - x)) + dx, y)
    return (x, min(ROWS, key=lambda row: abs(row - y)) + dy)


def _network(dx: float, dy: float, *turnings: Point) -> dict[Point, list[Point]]:
    """Return the graph of crossings and turning points, with their neighbours along the corridors."""
    columns, rows = [x + dx for x in COLUMNS], [y + dy for y in ROWS]
    places = {*turnings, *((x, y) for x in columns for y in rows)}
    nodes: dict[Point, list[Point]] = {place: [] for place in sorted(places)}
    lines = [sorted(place for place in places if place[0] == x) for x in columns]
    lines += [sorted(place for place in places if place[1] == y) for y in rows]
    for line in lines:
        for one, other in pairwise(line):
            nodes[one].append(other)
            nodes[other].append(one)
    return nodes


def _strolled(nodes: dict[Point, list[Point]], start: Point, end: Point, rng: Rng) -> list[Point]:
    """Return a path from `start` to `end` without reversing: random for some corners, then with the fewest points."""
    path = [start, nodes[start][int(rng.integers(len(nodes[start])))]]
    corners = int(rng.integers(FEWEST, MOST + 1))
    while corners > 0 or path[-1] == end:
        onward = _onward(nodes, path)
        path.append(onward[int(rng.integers(len(onward)))])
        corners -= len(path) > 2 and not _straight(*path[-3:])
    ways = deque([path[-2:]])
    known = {(path[-2], path[-1])}
    while ways[0][-1] != end:
        way = ways.popleft()
        for place in _onward(nodes, way):
            if (way[-1], place) not in known:
                known.add((way[-1], place))
                ways.append([*way, place])
    return [*path[:-2], *ways[0]]


def _onward(nodes: dict[Point, list[Point]], path: list[Point]) -> list[Point]:
    """Return the next possible points; back only at a corridor's end."""
    return [place for place in nodes[path[-1]] if place != path[-2]] or [path[-2]]


def _straight(a: Point, b: Point, c: Point) -> bool:
    return a[0] == b[0] == c[0] or a[1] == b[1] == c[1]


def _arriving(one: Exit, level: str, dx: float, dy: float) -> Course:
    """Return a course from the other floor to this one; it ends where the wearer comes out."""
    if isinstance(one, Cabin):
        course = Course(OTHER_LEVEL[level], one.middle, one.out)
        course.stand()
        course.ride()
        return course
    inside, turning = _inside(one, OTHER_LEVEL[level]), _beside(one, OTHER_LEVEL[level], dx, dy)
    if one.inward == pi:
        course = Course(OTHER_LEVEL[level], (turning[0], turning[1] - RUN_UP), 0.5 * pi)
    else:
        course = Course(OTHER_LEVEL[level], (turning[0] - RUN_UP, turning[1]), 0.0)
    course.stand()
    course.along([turning, inside])
    course.climb(up=level == UPPER)
    return course


def _leaving(course: Course, other: Exit, level: str, dx: float, dy: float) -> None:
    """Continue the course from a cabin, or from the first edge of stairs, to the other floor."""
    if isinstance(other, Cabin):
        course.face(other.out)
        course.ride()
        return
    course.climb(up=level == GROUND)
    x, y = _beside(other, OTHER_LEVEL[level], dx, dy)
    course.along([(x, y), (x, y - RUN_UP) if other.inward == pi else (x - RUN_UP, y)])
