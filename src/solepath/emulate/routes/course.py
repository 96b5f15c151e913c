"""Builder of a route through a building, which knows the position on the plan while moves are added.

course = Course("0", (2.0, 3.0), radians(90))
course.stand()
course.walk_along([(2.0, 9.0), (14.0, 9.0)])
walk = emulate(course.route)
Session(floorplan=plan, start=course.start).feed(walk.packets)
course.place(walk.walker, walk.truth.duration)"""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, tan

import numpy as np
from attrs import Factory, define

from ...floorplan.plan import Point, Start
from ...types import Foot
from ..wearers.curves import Array
from ..wearers.shoe import Mounting
from ..wearers.walker import Walker
from .building import EDGE_OFFSET, GOING, GROUND, LANE_OFFSET, RISE, RISERS, STOREY, UPPER
from .escalator import Escalator
from .path import ahead
from .route import TIGHT_TURN_SPEED, Route, whole

STAND_TIME = 2.0
"""Time for which the wearer stands at the start and at the end, s."""
WALKING_SPEED = 1.3
"""Walking speed, m/s."""
CORNER_RADIUS = 0.9
"""Radius of the bends in which the wearer walks around corners of corridors, m."""
MIN_RADIUS, LEG_SHARE = 0.3, 0.9
"""Radius of the tightest bend, m, and share of a short leg that it may take; chosen by hand."""
TURN_DISTANCE = 5.6
"""Distance from the door of a stairwell to where the wearer starts to turn on the landing, m."""
LANDING_LENGTH = 0.6
"""Length of a landing before and after the turn on it, m: with the turn, 1.2 m or more, as building codes ask for."""
OTHER_LEVEL = {GROUND: UPPER, UPPER: GROUND}
"""Id of the other level for each level."""


@define
class Course:
    """A route through a building that grows move by move."""

    level: str
    """Id of the level where the route ends so far."""
    position: Point
    """Position where the route ends so far, plan frame, m."""
    heading: float
    """Heading where the route ends so far, plan frame, rad."""
    start: Start = Factory(lambda course: Start(course.level, course.position, course.heading), takes_self=True)
    """Start of the route on the plan."""
    route: Route = Route(speed=WALKING_SPEED)
    """Route so far."""

    def stand(self) -> None:
        """Stand for STAND_TIME s."""
        self.route = self.route.stand(STAND_TIME)

    def ride(self, level: str = "", height: float = 0.0) -> None:
        """Take the elevator to `level`, `height` m higher, negative downwards; without these to the other floor."""
        self.route = self.route.lift(height or (STOREY if self.level == GROUND else -STOREY))
        self.level = level or OTHER_LEVEL[self.level]

    def place(self, walker: Walker, t: float) -> Point:
        """Return x and y of the middle between both ankles at time `t`, s, of a walker on this route, m, plan frame."""
        ((x, y),) = plan_track(self.start, walker, np.array([t])).tolist()
        return x, y

    def face(self, heading: float) -> None:
        """Turn on the spot to this heading in the plan frame, rad."""
        self.route = self.route.turn(wrapped(heading - self.heading))
        self.heading = heading

    def walk(self, distance: float) -> None:
        """Walk `distance` m straight on."""
        self._go(self.route.walk(distance, WALKING_SPEED), distance, self.heading)

    def bend(self, angle: float, radius: float) -> None:
        """Walk a bend by `angle` rad, counter-clockwise positive, with radius `radius` m."""
        speed = min(WALKING_SPEED, TIGHT_TURN_SPEED if radius < 1.0 else WALKING_SPEED)
        chord = 2.0 * radius * abs(sin(0.5 * angle))
        self._go(self.route.turn(angle, radius, speed), chord, self.heading + 0.5 * angle)
        self.heading += angle

    def flight(self, up: bool, risers: int = RISERS, rise: float = RISE, going: float = GOING) -> None:
        """Walk one flight of stairs: the height of a riser is `rise` m, the depth of a tread `going` m."""
        self._go(self.route.stairs(risers, up, rise, going), risers * going, self.heading)

    def stairs(
        self,
        level: str,
        risers: int,
        up: bool = True,
        *,
        rise: float = RISE,
        going: float = GOING,
        flights: int = 1,
        turn: float = 0.0,
        landing: float = LANDING_LENGTH,
    ) -> None:
        """Walk stairs to `level`: `flights` flights of `risers` risers, of `rise` m, with treads of `going` m.

        They begin where the wearer is. Between two flights is a landing: the wearer walks `landing` m on it, turns by
        `turn` rad along a bend of LANE_OFFSET m, counter-clockwise positive, and walks as far again. With half a turn,
        two flights end beside where they began, 2 LANE_OFFSET to the side of the turn; `position` has the end. Raises
        ValueError for a number of flights or risers that cannot be."""
        whole("stairs: risers", risers)
        whole("stairs: flights", flights)
        for number in range(flights):
            if number:
                self.walk(landing)
                if turn:
                    self.bend(turn, LANE_OFFSET)
                self.walk(landing)
            self.flight(up, risers, rise, going)
        self.level = level

    def escalator(self, level: str, height: float, speed: float = 0.5, *, walking: bool = False) -> None:
        """Take an escalator to `level`, `height` m higher, negative downwards; stand on it, or walk.

        Its steps move at `speed` m/s. It begins where the wearer is, who stands before and after the ride, and ends
        `Escalator.run` m ahead: the incline of 30 degrees and the level ends. Raises ValueError for a height of less
        than 1 m, or 2 m for walking."""
        self._go(self.route.escalator(height, speed, walking=walking), Escalator(height).run, self.heading)
        self.level = level

    def _go(self, route: Route, distance: float, direction: float) -> None:
        """Go on to a longer route, `distance` m away in this direction of the plan frame, rad."""
        self.route, (x, y) = route, self.position
        self.position = (x + distance * cos(direction), y + distance * sin(direction))

    def walk_along(self, points: list[Point]) -> None:
        """Walk from point to point, m, plan frame, with rounded corners; turn on the spot to the first one.

        Where a leg is too short for a bend of CORNER_RADIUS the bend is tighter, or a turn on the spot."""
        ahead_turn = wrapped(atan2(points[0][1] - self.position[1], points[0][0] - self.position[0]) - self.heading)
        if self.position != points[0] and abs(ahead_turn) > 1e-9:
            self.face(self.heading + ahead_turn)
        for k, (x, y) in enumerate(points):
            distance = hypot(x - self.position[0], y - self.position[1])
            if k + 1 == len(points):
                self.walk(distance)
                return
            next_heading = atan2(points[k + 1][1] - y, points[k + 1][0] - x)
            angle = wrapped(next_heading - self.heading)
            slope = tan(0.5 * abs(angle))
            leg = min(distance, hypot(points[k + 1][0] - x, points[k + 1][1] - y))
            radius = CORNER_RADIUS if not slope or CORNER_RADIUS * slope < leg else LEG_SHARE * leg / slope
            if abs(angle) > pi - 0.1 or radius < MIN_RADIUS:
                self.walk(distance)
                self.face(next_heading)
            elif abs(angle) > 1e-9:
                self.walk(distance - radius * slope)
                self.bend(angle, radius)
            elif distance > 0.0:
                self.walk(distance)

    def climb(self, up: bool) -> None:
        """Walk two flights and the landing between them; the way up turns to the left, the way down to the right."""
        edge, last_edge = ahead(up, GOING), EDGE_OFFSET + (RISERS - 1) * GOING
        self.flight(up)
        self.walk(TURN_DISTANCE - (EDGE_OFFSET - edge + RISERS * GOING))
        self.bend(pi if up else -pi, LANE_OFFSET)
        self.walk(TURN_DISTANCE - (last_edge + edge))
        self.flight(up)
        self.level = OTHER_LEVEL[self.level]


def plan_track(start: Start, walker: Walker, t: Array) -> Array:
    """Return x and y (plan frame, m) of the middle between both ankles at times `t`, s, (N, 2)."""
    ankle = Mounting((walker.wearer.shoe.ankle[0], 0.0, 0.0))
    middle = 0.5 * sum(walker.kinematics(foot, t, ankle).position[:, :2] for foot in Foot)
    heading = start.heading or 0.0
    c, s = cos(heading), sin(heading)
    return np.asarray(middle @ np.array([[c, s], [-s, c]]) + np.array(start.place))


def wrapped(angle: float) -> float:
    """Return an angle wrapped to [-pi, pi], rad."""
    return atan2(sin(angle), cos(angle))
