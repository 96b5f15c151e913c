"""Builder of a route through BUILDING: it keeps the position on the plan while moves are added."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, tan

from attrs import Factory, define

from ...floorplan.plan import Point, Start
from .building import APPROACH, GOING, GROUND, LANE, RISE, STEPS, STOREY, UPPER
from .path import ahead
from .route import TIGHT_TURN, Route

STAND_TIME = 2.0
"""Time of standing at the start and at the end, s."""
SPEED = 1.3
"""Walking speed, m/s."""
CORNER = 0.9
"""Radius at which corners of corridors are walked, m."""
TURNING = 5.6
"""Distance from the door of a stairwell to the start of the turn on its landing, m."""
OTHER_LEVEL = {GROUND: UPPER, UPPER: GROUND}
"""Id of the other level for each level."""


@define
class Course:
    """A route through BUILDING that grows move by move."""

    level: str
    """Id of the level where the route ends so far."""
    at: Point
    """Position where the route ends so far, plan frame, m."""
    heading: float
    """Heading where the route ends so far, plan frame, rad."""
    start: Start = Factory(lambda course: Start(course.level, course.at, course.heading), takes_self=True)
    """Start of the route on the plan."""
    route: Route = Route(speed=SPEED)
    """Route so far."""

    def stand(self) -> None:
        """Stand for STAND_TIME s."""
        self.route = self.route.stand(STAND_TIME)

    def ride(self) -> None:
        """Take the lift to the other floor."""
        self.route = self.route.lift(STOREY if self.level == GROUND else -STOREY)
        self.level = OTHER_LEVEL[self.level]

    def face(self, heading: float) -> None:
        """Turn on the spot to this heading in the plan frame, rad."""
        self.route = self.route.turn(wrapped(heading - self.heading))
        self.heading = heading

    def ahead(self, distance: float) -> None:
        """Walk `distance` m straight on."""
        self.route = self.route.walk(distance, SPEED)
        x, y = self.at
        self.at = (x + distance * cos(self.heading), y + distance * sin(self.heading))

    def bend(self, angle: float, radius: float) -> None:
        """Walk a bend of `angle` rad, counter-clockwise positive, and `radius` m."""
        self.route = self.route.turn(angle, radius, min(SPEED, TIGHT_TURN if radius < 1.0 else SPEED))
        chord, way = 2.0 * radius * abs(sin(0.5 * angle)), self.heading + 0.5 * angle
        self.at = (self.at[0] + chord * cos(way), self.at[1] + chord * sin(way))
        self.heading += angle

    def along(self, points: list[Point]) -> None:
        """Walk from point to point with rounded corners; the first point is straight ahead."""
        for k, (x, y) in enumerate(points):
            away = hypot(x - self.at[0], y - self.at[1])
            if k + 1 == len(points):
                self.ahead(away)
                return
            onward = atan2(points[k + 1][1] - y, points[k + 1][0] - x)
            angle = wrapped(onward - self.heading)
            if abs(angle) > pi - 0.1:
                self.ahead(away)
                self.face(onward)
            elif abs(angle) > 1e-9:
                self.ahead(away - CORNER * tan(0.5 * abs(angle)))
                self.bend(angle, CORNER)
            elif away > 0.0:
                self.ahead(away)

    def climb(self, up: bool) -> None:
        """Walk two flights and the landing between them, on which the turn is left upwards and right downwards."""
        edge, far = ahead(up, GOING), APPROACH + (STEPS - 1) * GOING
        self.flight(up)
        self.ahead(TURNING - (APPROACH - edge + STEPS * GOING))
        self.bend(pi if up else -pi, LANE)
        self.ahead(TURNING - (far + edge))
        self.flight(up)
        self.level = OTHER_LEVEL[self.level]

    def flight(self, up: bool) -> None:
        """Walk one flight of stairs."""
        self.route = self.route.stairs(STEPS, up, RISE, GOING)
        x, y = self.at
        self.at = (x + STEPS * GOING * cos(self.heading), y + STEPS * GOING * sin(self.heading))


def wrapped(angle: float) -> float:
    """Return an angle wrapped to [-pi, pi], rad."""
    return atan2(sin(angle), cos(angle))
