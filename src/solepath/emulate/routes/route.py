"""A route as a sequence of actions, and the path on the floor that it describes.

    Route().stand(2).walk(20, speed=1.3).turn(radians(90), radius=2).walk(10).stop(2)

The wearer walks successive moves without a halt, except that a turn on the spot starts and ends with the feet together.
At every halt the last step is a half step that brings the feet together. World frame: z up, x along the first heading,
y left, origin between the feet at the start.

Stairs and elevators change the floor; on landings the route has ordinary walks and turns:

    Route().stand(2).walk(5).stairs(11).turn(radians(180), 0.7).stairs(11).walk(5).lift(-3.5).jog(30).stop(2)"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, inf, isfinite, pi, remainder, sin
from numbers import Integral

import numpy as np
from attrs import evolve, frozen

from .elevator import Elevator
from .escalator import LEAST_HEIGHT, STEP_DEPTH, STEP_HEIGHT, Escalator, climbed_steps
from .path import AHEAD, BACK, LEFT, RIGHT, Action, Move, Pose, Stairs, Stand, Turn, follow
from .styles import (
    BACKWARDS_SPEED,
    LANDING,
    MAX_SLOPE,
    SHUFFLING_SPEED,
    SHUFFLING_STEP,
    SIDEWAYS_SPEED,
    STAIRS_DOWN_SPEED,
    STAIRS_UP_SPEED,
)

DIRECTION_TOLERANCE = 1e-6
"""Difference within which an angle is one of the main directions, rad: more than rounding makes."""
TIGHT_TURN_SPEED = 0.8
"""Largest speed in a bend of radius below 1 m, m/s; it holds for turns without a speed of their own (assumed)."""


@frozen
class Route:
    """A sequence of actions; a route never changes, and each method returns a longer one."""

    actions: tuple[Action, ...] = ()
    """Actions in order."""
    speed: float = 1.3
    """Speed of moves without a speed of their own, m/s: the last speed that `walk` was called with, or 1.3."""
    spacing: float | None = None
    """Distance between the marks to step on along the path, m; None: steps of natural length."""

    def paced(self, spacing: float) -> Route:
        """Let the wearer, who must stand here, step on marks from here on.

        Marks are `spacing` m apart along the path from one halt to the next; the spacing is scaled so that the last
        mark is at the end of the path."""
        return evolve(self, spacing=_positive("spacing", spacing))

    def stand(self, duration: float) -> Route:
        """Halt with a half step that brings the feet together, then stand for `duration` s."""
        return self._then(Stand(_positive("duration", duration)))

    def stop(self, duration: float = 2.0) -> Route:
        """Halt and stand for `duration` s, as `stand` does."""
        return self.stand(duration)

    def shuffle(self, distance: float, speed: float = SHUFFLING_SPEED) -> Route:
        """Shuffle `distance` m ahead in a queue, in steps of about SHUFFLING_STEP m; the speed is not kept.

        It starts and ends with the feet together. Idealised: the feet are lifted as high as in walking, and pitch as in
        any stride so short."""
        return self._then(Move(_positive("distance", distance), _positive("speed", speed), SHUFFLING_STEP))

    def crowded(self, distance: float, seed: int, speed: float | None = None) -> Route:
        """Go `distance` m ahead through a crowd: walks of 1 to 5 m and shuffles, with halts of 0.5 to 3 s between them.

        The walks have 0.4 to 0.9 of `speed`, m/s, which is not kept. No halt follows the last of them. All numbers are
        assumed; in dense crowds people stop and go (Portz and Seyfried 2011, Pedestrian and Evacuation Dynamics)."""
        rng, route, left = np.random.default_rng([seed, 34]), self, _positive("distance", distance)
        usual_speed = self.speed if speed is None else _positive("speed", speed)
        while True:
            shuffles = rng.uniform() < 0.4
            part = float(rng.uniform(0.3, 1.2) if shuffles else rng.uniform(1.0, 4.0))
            part = left if left - part < 1.0 else part
            if shuffles:
                route = route.shuffle(part, float(rng.uniform(0.2, 0.4)))
            else:
                route = route.walk(part, usual_speed * float(rng.uniform(0.4, 0.9)))
            left -= part
            if left <= 0.0:
                return evolve(route, speed=self.speed)
            route = route.stand(float(rng.uniform(0.5, 3.0)))

    def walk(
        self,
        distance: float,
        speed: float | None = None,
        *,
        slope: float = 0.0,
        direction: float = AHEAD,
        stops: Sequence[tuple[float, float]] = (),
    ) -> Route:
        """Walk `distance` m straight on at `speed` m/s; the speed is kept for later moves.

        `slope` makes the ground a ramp that rises by `slope` m per metre, negative downwards; `distance` and `speed`
        are horizontal. The feet lie on the ramp. Two things are idealised: the gait is that on the level, and a foot
        that stands where a ramp starts or ends lies on one of the two slopes.

        `direction` is the angle from where the feet point to where the wearer goes, rad, counter-clockwise: 0 ahead, pi
        or -pi backwards, pi/2 to the left, -pi/2 to the right. The heading stays. Such a walk starts and ends with the
        feet together, its speed is not kept, and it has no marks; `slope` is positive when it rises in the direction of
        the move, and 0 sideways. Idealised are the pitch of the feet, which is small and the same in every stride,
        and the load under a foot, which in every stance ends under the toes.

        `stops` are halts on the way, as at a door: the distance from the start of the walk, m, and how long the wearer
        stands there, s, in order."""
        if stops:
            route, done = self, 0.0
            for place, duration in (*stops, (distance, 0.0)):
                if not done < place <= distance:
                    raise ValueError(f"walk: stops must be in order and on the way of {distance} m, got {place}")
                route, done = route.walk(place - done, speed, slope=slope, direction=direction), place
                route = route.stand(duration) if done < distance else route
            return route
        direction = _main_direction(direction)
        if not abs(slope) <= MAX_SLOPE:
            raise ValueError(f"walk: slope must be between -{MAX_SLOPE} and {MAX_SLOPE}, got {slope}")
        if slope and self._ends_near(lambda move: move.stairs is not None):
            raise ValueError(f"walk: {LANDING} m on the level lie between a flight of stairs and a ramp")
        is_ahead = direction == AHEAD
        if slope and not is_ahead and direction != BACK:
            raise ValueError("walk: side steps are on the level")
        usual_speed = {AHEAD: self.speed, BACK: BACKWARDS_SPEED}.get(direction, SIDEWAYS_SPEED)
        chosen_speed = usual_speed if speed is None else _positive("speed", speed)
        spacing = self.spacing if is_ahead else None
        move = Move(_positive("distance", distance), chosen_speed, spacing, slope=slope, direction=direction)
        return evolve(self._then(move), speed=chosen_speed if is_ahead else self.speed)

    def jog(self, distance: float, speed: float = 2.6) -> Route:
        """Run `distance` m straight on at `speed` m/s; the speed is not kept for later moves.

        The runner walks the first steps after a halt and the last steps before one."""
        move = Move(_positive("distance", distance), _positive("speed", speed), self.spacing, running=True)
        return self._then(move)

    def stairs(
        self, steps: int, up: bool = True, rise: float = 0.16, going: float = 0.30, speed: float | None = None
    ) -> Route:
        """Walk a flight of `steps` risers, each foot on every other tread; the speed is not kept for later moves.

        `rise` is the height of a riser, m, `going` the distance between risers, m, and `speed` the horizontal speed
        along the flight, m/s. The first edge is `path.ahead` m ahead of the ankles of a wearer who stands before it.
        The flight is `steps * going` m long."""
        whole("stairs: steps", steps)
        if going < 0.25 or not 0.0 < rise <= 0.22:
            raise ValueError(f"stairs: going from 0.25 m, rise to 0.22 m, got {going}, {rise}")
        return self._flight(Stairs(steps, rise if up else -rise, going), speed)

    def lift(
        self, height: float, speed: float = 1.0, acceleration: float = 0.8, jerk: float = 1.0, doors: float = 2.5
    ) -> Route:
        """Ride in an elevator by `height` m, negative downwards; the other parameters are those of `Elevator`."""
        if not isfinite(height) or abs(height) < 0.5:
            raise ValueError(f"lift: it goes at least half a metre, got {height}")
        for limit in (speed, acceleration, jerk, doors):
            _positive("lift", limit)
        return self._then(Elevator(height, speed, acceleration, jerk, doors))

    def escalator(self, height: float, speed: float = 0.5, *, walking: bool = False) -> Route:
        """Ride on an escalator by `height` m, negative downwards, whose steps move at `speed` m/s; stand or walk on it.

        The wearer stands before and after a ride; who walks climbs a flight on moving steps, at the pace of stairs. The
        route goes on at the other end, `Escalator.run` m ahead and `height` m higher."""
        if not isfinite(height) or abs(height) < LEAST_HEIGHT * (2.0 if walking else 1.0):
            raise ValueError(f"escalator: it rises by a metre at least, two for walking, got {height}")
        escalator = Escalator(height, _positive("speed", speed))
        if not walking:
            return self._then(escalator)
        up = height > 0.0
        steps = climbed_steps(escalator, (STAIRS_UP_SPEED if up else STAIRS_DOWN_SPEED) / STEP_DEPTH)
        rise = STEP_HEIGHT if up else -STEP_HEIGHT
        stairs = Stairs(steps, rise, STEP_DEPTH, evolve(escalator, height=height - steps * rise))
        return self._flight(stairs)

    def turn(self, angle: float, radius: float = 0.0, speed: float | None = None) -> Route:
        """Turn by `angle` rad, counter-clockwise positive, along an arc of `radius` m; 0: on the spot."""
        if not isfinite(angle) or not isfinite(radius) or radius < 0.0:
            raise ValueError(f"turn: angle must be finite and radius not negative, got {angle}, {radius}")
        if speed is None:
            speed = min(self.speed, TIGHT_TURN_SPEED if radius < 1.0 else inf)
        _positive("speed", speed)
        if radius == 0.0:
            return self._then(Turn(angle, speed))
        bend = (1.0 if angle > 0.0 else -1.0) / radius
        return self._then(Move(abs(angle) * radius, speed, self.spacing, bend))

    @property
    def length(self) -> float:
        """Length of the path's centre line, m."""
        return sum(action.length for action in self.actions if isinstance(action, Move))

    @property
    def end(self) -> Pose:
        """Pose at the end of the route, between the feet, where escalators have moved the wearer."""
        pose, (x, y, z) = Pose(0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        for start, action, _, after in follow(self.actions):
            pose, escalator = after, action if isinstance(action, Escalator) else None
            if isinstance(action, Move) and action.stairs is not None:
                escalator = action.stairs.escalator
            if escalator is not None:
                x, y = x + escalator.run * cos(start.heading), y + escalator.run * sin(start.heading)
                z += escalator.height
        return evolve(pose, x=pose.x + x, y=pose.y + y, z=pose.z + z)

    def _flight(self, stairs: Stairs, speed: float | None = None) -> Route:
        last = self.actions[-1] if self.actions else None
        if isinstance(last, Move) and last.stairs is not None:
            raise ValueError("stairs: a landing lies between two flights, walk or turn on it")
        if self._ends_near(lambda move: move.slope != 0.0):
            raise ValueError(f"stairs: {LANDING} m on the level lie between a ramp and a flight of stairs")
        usual_speed = STAIRS_UP_SPEED if stairs.rise > 0.0 else STAIRS_DOWN_SPEED
        chosen_speed = usual_speed if speed is None else _positive("speed", speed)
        return self._then(Move(stairs.steps * stairs.going, chosen_speed, stairs=stairs))

    def _ends_near(self, is_meant: Callable[[Move], bool]) -> bool:
        """Return whether the route ends less than LANDING m after a move that is meant."""
        room = 0.0
        for move in reversed([action for action in self.actions if isinstance(action, Move)]):
            if is_meant(move):
                return room < LANDING
            room += move.length
        return False

    def _then(self, action: Action) -> Route:
        return evolve(self, actions=(*self.actions, action))


def _positive(name: str, value: float) -> float:
    if not (isfinite(value) and value > 0.0):
        raise ValueError(f"{name} must be a positive number, got {value}")
    return value


def whole(name: str, value: int) -> None:
    """Raise ValueError for a value that is no whole number of 1 or more."""
    if isinstance(value, bool) or not isinstance(value, Integral) or value < 1:
        raise ValueError(f"{name}: a whole number of 1 or more, got {value!r}")


def _main_direction(direction: float) -> float:
    """Return the main direction that is meant, rad; ValueError when none is near."""
    meant = min((AHEAD, LEFT, RIGHT, BACK), key=lambda one: abs(remainder(direction - one, 2.0 * pi)))
    if abs(remainder(direction - meant, 2.0 * pi)) < DIRECTION_TOLERANCE:
        return meant
    raise ValueError(f"walk: direction must be 0, pi/2, -pi/2 or pi, got {direction}")
