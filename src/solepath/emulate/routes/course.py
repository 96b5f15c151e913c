"""A route through BUILDING under way: where it has come to on the plan, and what is walked next."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, tan

from attrs import Factory, define

from ...floorplan.plan import Point, Start
from .building import APPROACH, GOING, GROUND, LANE, RISE, STEPS, STOREY, UPPER
from .path import ahead
from .route import TIGHT_TURN, Route

STAND_TIME = 2.0
"""s of standing at the beginning and at the end."""
SPEED = 1.3
"""m/s."""
CORNER = 0.9
"""m: radius at which corners of corridors are walked."""
TURNING = 5.6
"""m inside the door of a stairwell where the turn on its landing begins."""
OTHER_LEVEL = {GROUND: UPPER, UPPER: GROUND}


@define
class Course:
    """A route under way: the level, the place and the heading where it has come to."""

    level: str
    at: Point
    heading: float
    start: Start = Factory(lambda course: Start(course.level, course.at, course.heading), takes_self=True)
    route: Route = Route(speed=SPEED)

    def stand(self) -> None:
        self.route = self.route.stand(STAND_TIME)

    def ride(self) -> None:
        """To the other floor."""
        self.route = self.route.lift(STOREY if self.level == GROUND else -STOREY)
        self.level = OTHER_LEVEL[self.level]

    def face(self, heading: float) -> None:
        """Turn on the spot."""
        self.route = self.route.turn(wrapped(heading - self.heading))
        self.heading = heading

    def ahead(self, distance: float) -> None:
        self.route = self.route.walk(distance, SPEED)
        x, y = self.at
        self.at = (x + distance * cos(self.heading), y + distance * sin(self.heading))

    def bend(self, angle: float, radius: float) -> None:
        self.route = self.route.turn(angle, radius, min(SPEED, TIGHT_TURN if radius < 1.0 else SPEED))
        chord, way = 2.0 * radius * abs(sin(0.5 * angle)), self.heading + 0.5 * angle
        self.at = (self.at[0] + chord * cos(way), self.at[1] + chord * sin(way))
        self.heading += angle

    def along(self, points: list[Point]) -> None:
        """From place to place, the corners between them rounded; the first one lies straight ahead."""
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
        """Two flights and the landing between them, turned in to the left upwards and to the right downwards."""
        edge, far = ahead(up, GOING), APPROACH + (STEPS - 1) * GOING
        self.flight(up)
        self.ahead(TURNING - (APPROACH - edge + STEPS * GOING))
        self.bend(pi if up else -pi, LANE)
        self.ahead(TURNING - (far + edge))
        self.flight(up)
        self.level = OTHER_LEVEL[self.level]

    def flight(self, up: bool) -> None:
        self.route = self.route.stairs(STEPS, up, RISE, GOING)
        x, y = self.at
        self.at = (x + STEPS * GOING * cos(self.heading), y + STEPS * GOING * sin(self.heading))


def wrapped(angle: float) -> float:
    return atan2(sin(angle), cos(angle))
