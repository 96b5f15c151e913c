"""A route as a script, and the path on the floor that it describes.

    Route().stand(2).walk(20, speed=1.3).turn(radians(90), radius=2).walk(10).stop(2)

Moves that follow each other without a stand are walked through without a halt, except that turning on the spot begins
and ends with the feet together. Every halt is reached with a closing half step. World frame: z up, x along the first
heading, y left, origin between the feet at the start.
"""

from __future__ import annotations

from math import cos, inf, isfinite, sin

from attrs import evolve, frozen

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


@frozen
class Turn:
    """Turn by `angle` rad, counter-clockwise positive, along an arc of `radius` m, or on the spot when it is 0."""

    angle: float
    radius: float
    speed: float
    spacing: float | None = None


Action = Stand | Walk | Turn


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

    def turn(self, angle: float, radius: float = 0.0, speed: float | None = None) -> Route:
        if not isfinite(angle) or not isfinite(radius) or radius < 0.0:
            raise ValueError(f"turn: angle must be finite and radius not negative, got {angle}, {radius}")
        if speed is None:
            speed = min(self.speed, TIGHT_TURN if radius < 1.0 else inf)
        return self._then(Turn(angle, radius, _positive("speed", speed), self.spacing))

    @property
    def length(self) -> float:
        """Length of the path's centre line, m."""
        return sum(piece.length for leg in legs(self) if isinstance(leg, Path) for piece in leg.pieces)

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


# --- the path -------------------------------------------------------------------------------------------------------


@frozen
class Pose:
    """A place on the path: x, y, z in m and the heading in rad (not wrapped)."""

    x: float
    y: float
    z: float
    heading: float

    def ahead(self, distance: float, curvature: float) -> Pose:
        """The pose `distance` m further along an arc of `curvature` 1/m (a straight line when it is 0)."""
        turned = self.heading + distance * curvature
        if abs(distance * curvature) < 1e-9:
            return Pose(self.x + distance * cos(self.heading), self.y + distance * sin(self.heading), self.z, turned)
        return Pose(
            self.x + (sin(turned) - sin(self.heading)) / curvature,
            self.y - (cos(turned) - cos(self.heading)) / curvature,
            self.z,
            turned,
        )


@frozen
class Piece:
    """A straight line or an arc from `start`, walked at `speed`; with marks `spacing` m apart, or None."""

    start: Pose
    length: float
    curvature: float
    speed: float
    spacing: float | None = None


@frozen
class Path:
    """What is walked from one halt to the next."""

    pieces: tuple[Piece, ...]

    @property
    def length(self) -> float:
        return sum(piece.length for piece in self.pieces)

    @property
    def end(self) -> Pose:
        last = self.pieces[-1]
        return last.start.ahead(last.length, last.curvature)

    @property
    def spacing(self) -> float | None:
        """Of the marks to step on, m: what its first move says."""
        return self.pieces[0].spacing

    def at(self, s: float) -> tuple[Pose, float]:
        """The pose after `s` m from the halt, and the speed asked for there."""
        piece, rest = self._piece(s)
        return piece.start.ahead(rest, piece.curvature), piece.speed

    def curvature(self, s: float) -> float:
        """1/m after `s` m from the halt; positive to the left."""
        return self._piece(s)[0].curvature

    def _piece(self, s: float) -> tuple[Piece, float]:
        for piece in self.pieces[:-1]:
            if s < piece.length:
                return piece, s
            s -= piece.length
        return self.pieces[-1], s


@frozen
class Pivot:
    """A turn on the spot, feet together before and after."""

    start: Pose
    angle: float
    speed: float

    @property
    def end(self) -> Pose:
        return Pose(self.start.x, self.start.y, self.start.z, self.start.heading + self.angle)


Leg = Stand | Path | Pivot


def legs(route: Route) -> list[Leg]:
    """The route cut at its halts: stands, turns on the spot, and paths in between."""
    found: list[Leg] = []
    pieces: list[Piece] = []
    pose = Pose(0.0, 0.0, 0.0, 0.0)

    def close() -> None:
        if pieces:
            found.append(Path(tuple(pieces)))
            pieces.clear()

    for action in route.actions:
        match action:
            case Stand():
                close()
                found.append(action)
                continue
            case Turn(angle=angle, radius=0.0):
                close()
                pivot = Pivot(pose, angle, action.speed)
                found.append(pivot)
                pose = pivot.end
                continue
            case Turn(angle=angle, radius=radius):
                bend = (1.0 if angle > 0.0 else -1.0) / radius
                piece = Piece(pose, abs(angle) * radius, bend, action.speed, action.spacing)
            case Walk(distance=distance):
                piece = Piece(pose, distance, 0.0, action.speed, action.spacing)
        pieces.append(piece)
        pose = piece.start.ahead(piece.length, piece.curvature)
    close()
    return found
