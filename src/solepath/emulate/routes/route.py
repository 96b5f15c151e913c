"""A route as a script, and the path on the floor that it describes.

    Route().stand(2).walk(20, speed=1.3).turn(radians(90), radius=2).walk(10).stop(2)

Moves that follow each other without a stand are walked through without a halt, except that turning on the spot begins
and ends with the feet together. Every halt is reached with a closing half step. World frame: z up, x along the first
heading, y left, origin between the feet at the start.

Stairs and lifts change the floor; landings are ordinary walks and turns:

    Route().stand(2).walk(5).stairs(11).turn(radians(180), 0.7).stairs(11).walk(5).lift(-3.5).jog(30).stop(2)
"""

from __future__ import annotations

from math import inf, isfinite

from attrs import evolve, frozen

from .lift import Lift
from .path import Flight, Lifted, Piece, Pivot, Pose, WalkPath, ahead
from .styles import SPEED_DOWN, SPEED_UP

TIGHT_TURN = 0.8
"""m/s: nobody walks a bend of less than about a metre faster; used when a turn names no speed."""


@frozen
class Stand:
    """Stand still with the feet side by side for `duration` s."""

    duration: float


@frozen
class Walk:
    """Walk straight on: `distance` in m at `speed` in m/s."""

    distance: float
    speed: float
    spacing: float | None = None
    running: bool = False


@frozen
class TurnAction:
    """Turn by `angle` rad, counter-clockwise positive, along an arc of `radius` m, or on the spot when it is 0."""

    angle: float
    radius: float
    speed: float
    spacing: float | None = None


@frozen
class Stairs:
    """A flight of `steps` risers, foot over foot: `rise` m each, negative down, `going` m apart; `speed` along them."""

    steps: int
    rise: float
    going: float
    speed: float


Action = Stand | Walk | TurnAction | Stairs | Lift


@frozen
class Route:
    """What to do, in order. Each method returns a longer route; a route itself never changes."""

    actions: tuple[Action, ...] = ()
    speed: float = 1.3
    """The speed of a move that names none, m/s: the last one named, or 1.3."""
    spacing: float | None = None
    """Of the marks that are stepped on, m along the path; None: steps of natural length."""

    def paced(self, spacing: float | None) -> Route:
        """From here on every footfall is on a mark: they are `spacing` m apart along the path from one halt to the
        next, made even so that the last one is at its end. Halt before this; None: naturally again."""
        return evolve(self, spacing=None if spacing is None else _positive("spacing", spacing))

    def stand(self, duration: float) -> Route:
        return self._then(Stand(_positive("duration", duration)))

    def stop(self, duration: float = 2.0) -> Route:
        """The same as `stand`: halt with a closing half step, then stand."""
        return self.stand(duration)

    def walk(self, distance: float, speed: float | None = None) -> Route:
        chosen = self.speed if speed is None else _positive("speed", speed)
        return evolve(self._then(Walk(_positive("distance", distance), chosen, self.spacing)), speed=chosen)

    def jog(self, distance: float, speed: float = 2.6) -> Route:
        """Run straight on; the runner walks the first and last steps from and to a halt. The speed is not kept."""
        move = Walk(_positive("distance", distance), _positive("speed", speed), self.spacing, running=True)
        return self._then(move)

    def stairs(
        self, steps: int, up: bool = True, rise: float = 0.16, going: float = 0.30, speed: float | None = None
    ) -> Route:
        """Walk a flight of `steps` risers, each foot on every other tread: `rise` and `going` of each in m, `speed`
        along in m/s. The first edge is `stairs.ahead` m ahead of the ankles of who stands before it, and the flight is
        `steps * going` m long. The speed is not kept."""
        if steps < 1 or going < 0.25 or not 0.0 < rise <= 0.22:
            raise ValueError(f"stairs: 1 step or more, going from 0.25 m, rise to 0.22 m, got {steps}, {going}, {rise}")
        if self.actions and isinstance(self.actions[-1], Stairs):
            raise ValueError("stairs: a landing lies between two flights, walk or turn on it")
        chosen = (SPEED_UP if up else SPEED_DOWN) if speed is None else _positive("speed", speed)
        return self._then(Stairs(steps, rise if up else -rise, going, chosen))

    def lift(
        self,
        height: float,
        speed: float = 1.0,
        acceleration: float = 0.8,
        jerk: float = 1.0,
        doors: float = 2.5,
        creep: float = 0.0,
    ) -> Route:
        """Stand in a lift that goes `height` m up, or down when negative; the rest as in `Lift`."""
        if not isfinite(height) or abs(height) < 0.5:
            raise ValueError(f"lift: it goes at least half a metre, got {height}")
        for limit in (speed, acceleration, jerk, doors):
            _positive("lift", limit)
        if not 0.0 <= creep <= 0.3 * speed:
            raise ValueError(f"lift: creep must be between 0 and 0.3 of the speed, got {creep}")
        return self._then(Lift(height, speed, acceleration, jerk, doors, creep))

    def turn(self, angle: float, radius: float = 0.0, speed: float | None = None) -> Route:
        if not isfinite(angle) or not isfinite(radius) or radius < 0.0:
            raise ValueError(f"turn: angle must be finite and radius not negative, got {angle}, {radius}")
        if speed is None:
            speed = min(self.speed, TIGHT_TURN if radius < 1.0 else inf)
        return self._then(TurnAction(angle, radius, _positive("speed", speed), self.spacing))

    @property
    def length(self) -> float:
        """Length of the path's centre line, m."""
        return sum(piece.length for leg in legs(self) if isinstance(leg, WalkPath) for piece in leg.pieces)

    @property
    def end(self) -> Pose:
        """Where the route ends: between the feet."""
        pose = Pose(0.0, 0.0, 0.0, 0.0)
        for leg in legs(self):
            if not isinstance(leg, Stand):
                pose = leg.end
        return pose

    def _then(self, action: Action) -> Route:
        return evolve(self, actions=(*self.actions, action))


def _positive(name: str, value: float) -> float:
    if not (isfinite(value) and value > 0.0):
        raise ValueError(f"{name} must be a positive number, got {value}")
    return value


Leg = Stand | WalkPath | Pivot | Lifted


def legs(route: Route) -> list[Leg]:
    """The route cut at its halts: stands, rides, turns on the spot, and paths in between."""
    found: list[Leg] = []
    pieces: list[Piece] = []
    pose = Pose(0.0, 0.0, 0.0, 0.0)

    def close() -> None:
        if pieces:
            found.append(WalkPath(tuple(pieces)))
            pieces.clear()

    for action in route.actions:
        match action:
            case Stand():
                close()
                found.append(action)
                continue
            case TurnAction(angle=angle, radius=0.0):
                close()
                pivot = Pivot(pose, angle, action.speed)
                found.append(pivot)
                pose = pivot.end
                continue
            case Lift():
                close()
                ridden = Lifted(pose, action)
                found.append(ridden)
                pose = ridden.end
                continue
            case TurnAction(angle=angle, radius=radius):
                bend = (1.0 if angle > 0.0 else -1.0) / radius
                piece = Piece(pose, abs(angle) * radius, bend, action.speed, action.spacing)
            case Walk(distance=distance):
                piece = Piece(pose, distance, 0.0, action.speed, action.spacing, action.running)
            case Stairs(steps=steps, rise=rise, going=going):
                edge = pose.ahead(ahead(rise > 0.0, going), 0.0)
                flight = Flight(edge.x, edge.y, pose.z, pose.heading, steps, rise, going)
                piece = Piece(pose, steps * going, 0.0, action.speed, None, flight=flight)
        pieces.append(piece)
        pose = piece.at(piece.length)
    close()
    return found
