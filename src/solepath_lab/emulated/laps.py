"""Routes of published experiments: straight on, squares and bends over marks, a rectangle, a corridor, a field.

`Walker` and `emulate` take these routes. On routes with marks, `marks` returns which stride of which foot landed on
each mark. Marks are the points of the ground below the ankle, in the
world frame of the walk (origin between the feet at the start, x along the first heading)."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot, pi, tan
from operator import attrgetter

import numpy as np
from attrs import evolve, frozen

from solepath.emulate.routes.course import wrapped
from solepath.emulate.routes.planner import plan
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.gait import PlannedStride
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, Vec3, WalkingMode

Point = tuple[float, float]

SQUARE_SIDE, MARKS_PER_LAP = 11.7, 40
"""Side of the calibration square of Bebek et al. 2010 (section V-B), m, and number of marks around it for each foot."""
LAP_SPEED = 0.8
"""Walking speed around the square, m/s: 235 m in five minutes (Bebek et al. 2010, section V-D)."""
LAP_CORNER_RADIUS = 0.5
"""Radius of the bends at the corners of the square, m (assumed: subjects who follow a square turn tightly)."""

BEND_RADII = {
    WalkingMode.LEFT_WIDE: 4.0,
    WalkingMode.LEFT_TIGHT: 2.0,
    WalkingMode.RIGHT_WIDE: -4.0,
    WalkingMode.RIGHT_TIGHT: -2.0,
}
"""Radius of the bend of each mode, m; positive to the left (Gong et al. 2023, section 3.3)."""
MARK_SPACING = 0.55
"""Distance between marks along the path, m: "an average of 0.5-0.6 m intervals" (Gong et al. 2023, section 3.3)."""
STEPS_OVER_MARKS = 50
"""Number of steps over marks."""
MARK_SPEED = 1.1
"""Walking speed over marks, m/s (assumed)."""
MIN_TIGHT_CURVATURE, MIN_BEND_CURVATURE = 1.0 / (2.0 * 2.0**0.5), 1.0 / 8.0
"""Least curvatures of a tight bend and of any bend, 1/m.

They belong to radii of 2.8 m, the geometric mean of the tight and the wide bend, and of 8 m."""
MIN_WALKING_DISPLACEMENT = 0.15
"""Displacement of a foot over a stride, m, below which it is STANDING (L_w of table 2 of Gong et al. 2023)."""

ALONG, ACROSS = 2.8, 4.0
"""Length of the sides AB and CD, and of BC and DA, of the rectangle of Gong et al. 2023, section 3.4, m."""
RECTANGLE_CORNER_RADIUS = 0.5
"""Radius of the bends at the corners of the rectangle, m (assumed: without a halt, about one step on the arc).

They are walked at TIGHT_TURN_SPEED (route.py) at most."""
CORRIDOR_LENGTH = 91.0
"""Length of the walk around a floor of Chen et al. 2019, section IV-C, m."""
FIELD_SIZE = (60.0, 40.0)
"""Size of the field of a random walk, m, with the start in its middle (assumed: a part of a sports field)."""


@frozen
class FloorMark:
    """A mark on the floor and the stride that landed on it."""

    foot: Foot
    """Foot that landed on the mark."""
    step: int
    """Number of the stride among those of the foot, from 1."""
    t: float
    """Time of foot-flat on the mark, s."""
    x: float
    """Coordinate x of the mark in the world frame, m."""
    y: float
    """Coordinate y of the mark in the world frame, m."""
    mode: WalkingMode
    """Walking mode of the stride."""


@frozen
class LapCorner:
    """A corner of a rectangle that the wearer passed; positions are in the world frame."""

    name: str
    """Name of the corner."""
    t: float
    """Time at which the pelvis is nearest to the corner, s; at corner A the time of the halt."""
    place: Vec3
    """Position of the corner, m."""
    body: Vec3
    """Position of the pelvis at time `t`, projected to the ground, m."""
    stride_numbers: dict[Foot, int]
    """Number, from 1, of each foot's stride whose foot-flat is nearest to time `t`."""
    footprints: dict[Foot, Vec3]
    """Point of the ground below each ankle after the stride of `stride_numbers`, m."""


def straight(distance: float = 20.0, speed: float = 1.3) -> Route:
    """Return a straight route; like every complete route here it starts and ends with two seconds of standing."""
    return Route().stand(2.0).walk(distance, speed).stop(2.0)


def square(
    laps: int = 5, edge: float = SQUARE_SIDE, speed: float = LAP_SPEED, corner: float = LAP_CORNER_RADIUS
) -> Route:
    """Return laps of a square to the left without a halt; a foot steps on the same MARKS_PER_LAP marks in every lap."""
    lap = 4.0 * (edge - 2.0 * corner + 0.5 * pi * corner)
    route = Route().stand(2.0).paced(lap / (2 * MARKS_PER_LAP))
    for _ in range(4 * laps):
        route = route.walk(edge - 2.0 * corner, speed).turn(0.5 * pi, corner, speed)
    return route.stop(2.0)


def marked(
    mode: WalkingMode, steps: int = STEPS_OVER_MARKS, spacing: float = MARK_SPACING, speed: float = MARK_SPEED
) -> Route:
    """Return `steps` steps over marks, straight on or in the bend of the mode; raise ValueError for standing."""
    route = Route().stand(2.0).paced(spacing)
    if mode is WalkingMode.STRAIGHT:
        return route.walk(steps * spacing, speed).stop(2.0)
    if mode not in BEND_RADII:
        raise ValueError(f"marks are walked over, not {mode.value}")
    radius = BEND_RADII[mode]
    return route.turn(steps * spacing / radius, abs(radius), speed).stop(2.0)


def rectangle() -> Route:
    """Return a rectangle from A over B, C and D back to A, counter-clockwise, with A at the origin and B ahead of it.

    The walk ends on A itself, at the end of DA."""
    points = [(ALONG, 0.0), (ALONG, ACROSS), (0.0, ACROSS), (0.0, 0.0)]
    return through(points, 1.1, RECTANGLE_CORNER_RADIUS)


def corridor(length: float = CORRIDOR_LENGTH, speed: float = 1.3) -> Route:
    """Return one lap around the inner block of a building's floor, to the left and back to the start.

    Long sides are 1.5 times as long as short ones (assumed: the paper shows the path only in fig. 13)."""
    corner = 1.0  # radius of the bends, m
    short = (length - 2.0 * pi * corner) / 5.0 + 2.0 * corner
    long = 1.5 * (short - 2.0 * corner) + 2.0 * corner
    # The walk starts and ends in the middle of a long side, where there is no bend.
    points = [(0.5 * long, 0.0), (0.5 * long, short), (-0.5 * long, short), (-0.5 * long, 0.0), (0.0, 0.0)]
    return through(points, speed, corner)


def field_walk(duration: float = 1800.0, speed: float = 1.0, seed: int = 1) -> Route:
    """Return about `duration` s of walking from one random point in a field to the next, and back to the start."""
    rng = np.random.default_rng([seed, 7])
    half = (0.5 * FIELD_SIZE[0], 0.5 * FIELD_SIZE[1])
    points: list[Point] = [(0.4 * FIELD_SIZE[0], 0.0)]
    previous: Point = (0.0, 0.0)
    distance = points[0][0]
    while distance + hypot(*points[-1]) < speed * duration or not _is_walkable(previous, points[-1], (0.0, 0.0)):
        target = (float(rng.uniform(-half[0], half[0])), float(rng.uniform(-half[1], half[1])))
        if _is_walkable(previous, points[-1], target):
            distance += hypot(target[0] - points[-1][0], target[1] - points[-1][1])
            previous = points[-1]
            points.append(target)
    return through([*points, (0.0, 0.0)], speed, 1.5)


def through(points: Sequence[Point], speed: float, corner: float) -> Route:
    """Return a route from the origin on straight lines through the points, with bends of radius `corner`, m.

    The first turn is on the spot."""
    route, position, heading, cut_before = Route().stand(2.0), (0.0, 0.0), 0.0, 0.0
    for k, target in enumerate(points):
        direction = atan2(target[1] - position[1], target[0] - position[0])
        turn = wrapped(direction - heading)
        if abs(turn) > 1e-9:
            route = route.turn(turn, corner if k else 0.0)
        cut_after = 0.0
        if k + 1 < len(points):
            following = points[k + 1]
            next_turn = wrapped(atan2(following[1] - target[1], following[0] - target[0]) - direction)
            cut_after = corner * tan(0.5 * abs(next_turn))
        distance = hypot(target[0] - position[0], target[1] - position[1])
        route = route.walk(distance - cut_before - cut_after, speed)
        position, heading, cut_before = target, direction, cut_after
    return route.stop(2.0)


def mode_of(stride: PlannedStride) -> WalkingMode:
    """Return the walking mode of a stride, from the bend where the foot landed."""
    if hypot(stride.end.x - stride.start.x, stride.end.y - stride.start.y) < MIN_WALKING_DISPLACEMENT:
        return WalkingMode.STANDING
    if abs(stride.curvature) < MIN_BEND_CURVATURE:
        return WalkingMode.STRAIGHT
    left = stride.curvature > 0.0
    if abs(stride.curvature) < MIN_TIGHT_CURVATURE:
        return WalkingMode.LEFT_WIDE if left else WalkingMode.RIGHT_WIDE
    return WalkingMode.LEFT_TIGHT if left else WalkingMode.RIGHT_TIGHT


def marks(walker: Walker) -> tuple[FloorMark, ...]:
    """Return the marks of a walker on a paced route and the strides on them, in the order of time.

    The closing step before a halt has no mark."""
    exact = evolve(walker.wearer, width_variation=0.0, angle_variation=0.0, mark_error=0.0)
    exact_plan = plan(walker.route, exact, np.random.default_rng(0))
    closing = {
        max(s.heel_strike for foot in Foot for s in walker.plan.strides[foot] if start <= s.heel_strike <= end)
        for start, end in walker.plan.bouts
    }
    found = [
        FloorMark(foot, k, stride.foot_flat, exact_stride.end.x, exact_stride.end.y, mode_of(stride))
        for foot in Foot
        for k, (stride, exact_stride) in enumerate(
            zip(walker.plan.strides[foot], exact_plan.strides[foot], strict=True), 1
        )
        if stride.heel_strike not in closing
    ]
    return tuple(sorted(found, key=attrgetter("t")))


def corners(walker: Walker) -> tuple[LapCorner, ...]:
    """Return the corners B, C, D and A of one lap of a rectangle, with the times at which they were passed."""
    t = np.arange(0.0, walker.duration, 0.01)
    track = walker.body.pelvis(t)[0]
    found = []
    for name, x, y in (("B", ALONG, 0.0), ("C", ALONG, ACROSS), ("D", 0.0, ACROSS), ("A", 0.0, 0.0)):
        passed = t[int(np.argmin((track[:, 0] - x) ** 2 + (track[:, 1] - y) ** 2))]
        at = walker.plan.bouts[-1][1] if name == "A" else float(passed)
        body_x, body_y, _ = (float(value) for value in walker.body.pelvis(np.array([at]))[0][0])
        stride_numbers, footprints = {}, {}
        for foot in Foot:
            stride = min(walker.plan.strides[foot], key=lambda one: abs(one.foot_flat - at))
            stride_numbers[foot] = stride.number
            footprints[foot] = (stride.end.x, stride.end.y, stride.end.z)
        found.append(LapCorner(name, at, (x, y, 0.0), (body_x, body_y, 0.0), stride_numbers, footprints))
    return tuple(found)


def _is_walkable(previous: Point, position: Point, target: Point) -> bool:
    """Return whether `target` is at least 6 m away and not behind: the turn to it is below 2.1 rad."""
    displacement, direction = (
        (target[0] - position[0], target[1] - position[1]),
        atan2(position[1] - previous[1], position[0] - previous[0]),
    )
    return hypot(*displacement) >= 6.0 and abs(wrapped(atan2(displacement[1], displacement[0]) - direction)) < 2.1
