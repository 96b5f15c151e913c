"""The actions of a route, and where they lie on the floor: poses, flights of stairs, and paths from halt to halt."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby
from math import cos, pi, sin, sqrt

import numpy as np
from attrs import evolve, frozen

from ..wearers.curves import Array
from .elevator import Elevator
from .escalator import Escalator
from .styles import MIN_RUNNING_SPEED, RUN_ACCELERATION

EDGE_DISTANCE_UP, EDGE_DISTANCE_DOWN = 0.25, 0.17
"""Distance from the ankle to the next edge ahead, before a flight and on every tread, upwards and downwards, m.

Upwards, on treads of 0.30 m, the heel stands 4 cm back over its edge, and the forefoot rocker ends 9 cm before the next
riser. Downwards the ball of the foot is 6 cm behind the edge, and the toes stand over the edge."""
MIN_RISER_DISTANCE = 0.13
"""Least distance from the ankle to the riser behind it on the way down, m; it may push the toes over the edge."""


def ahead(up: bool, going: float) -> float:
    """Return the distance from the ankle to the next edge ahead on treads of depth `going`, m."""
    return EDGE_DISTANCE_UP if up else min(EDGE_DISTANCE_DOWN, going - MIN_RISER_DISTANCE)


@frozen
class Flight:
    """A flight of stairs of unlimited width in the world frame."""

    x: float
    """Coordinate x of the first edge, m."""
    y: float
    """Coordinate y of the first edge, m."""
    z: float
    """Height of the floor before the flight, m."""
    heading: float
    """Heading of the flight, rad."""
    steps: int
    """Number of risers."""
    rise: float
    """Height of a riser, m; negative downwards."""
    going: float
    """Distance between risers, m."""
    escalator: Escalator | None = None
    """Escalator whose steps these are; None for a flight that does not move."""

    @property
    def height(self) -> float:
        """Height from floor to floor, m; negative downwards."""
        return self.steps * self.rise

    def along(self, x: Array, y: Array) -> Array:
        """Return the distance along the flight from the first edge to points, m; negative before that edge."""
        return np.asarray((x - self.x) * cos(self.heading) + (y - self.y) * sin(self.heading))

    def clear_height(self, x: Array, y: Array, radius: Array) -> Array:
        """Return the least height, m, at which the centre of a disc above (x, y) clears treads and edges.

        The disc stands upright along the flight; its radius is `radius`, m."""
        u = self.along(x, y)
        height = self._tread(u) + radius
        for k in range(self.steps):
            edge = self.z + self.rise * (k + 1 if self.rise > 0.0 else k)
            squared_height = radius**2 - (u - k * self.going) ** 2
            height = np.where(
                squared_height > 0.0, np.maximum(height, edge + np.sqrt(np.maximum(squared_height, 0.0))), height
            )
        return np.asarray(height)

    def _tread(self, u: Array) -> Array:
        return np.asarray(self.z + self.rise * np.clip(np.floor(u / self.going) + 1.0, 0.0, self.steps))


AHEAD, LEFT, RIGHT, BACK = 0.0, 0.5 * pi, -0.5 * pi, pi
"""Directions of a path relative to the heading of the feet, rad."""
RUN_START_SPEED = 1.2
"""Speed of a runner's first step after a halt and of the last step before one, m/s."""


@frozen
class Pose:
    """A position and a heading in the world frame."""

    x: float
    """Coordinate x, m."""
    y: float
    """Coordinate y, m."""
    z: float
    """Coordinate z, m."""
    heading: float
    """Heading, rad, not wrapped."""
    grade: float = 0.0
    """Slope of the ground along the heading, as rise over run, no unit; it is level across the heading."""

    def ahead(self, distance: float, curvature: float) -> Pose:
        """Return the pose `distance` m further along an arc of `curvature` 1/m (a straight line when it is 0).

        The ground there is level and as high as here."""
        turned = self.heading + distance * curvature
        if abs(distance * curvature) < 1e-9:
            return Pose(self.x + distance * cos(self.heading), self.y + distance * sin(self.heading), self.z, turned)
        return Pose(
            self.x + (sin(turned) - sin(self.heading)) / curvature,
            self.y - (cos(turned) - cos(self.heading)) / curvature,
            self.z,
            turned,
        )

    def turned(self, angle: float) -> Pose:
        """Return the pose after a turn on the spot; a ramp falls when it rose before half a turn."""
        return evolve(self, heading=self.heading + angle, grade=self.grade * cos(angle))


@frozen
class Stand:
    """An action: stand still with the feet side by side."""

    duration: float
    """Duration of standing, s."""


@frozen
class Turn:
    """An action: turn on the spot, with the feet together before and after."""

    angle: float
    """Angle of the turn, rad; counter-clockwise positive."""
    speed: float
    """Walking speed that sets the cadence of the steps, m/s."""


@frozen
class Stairs:
    """The stairs of a flight."""

    steps: int
    """Number of risers."""
    rise: float
    """Height of a riser, m; negative downwards."""
    going: float
    """Distance between risers, m."""
    escalator: Escalator | None = None
    """Escalator whose steps these are; None for stairs that do not move."""


@frozen
class Move:
    """An action: go along a straight line, an arc or a flight of stairs."""

    length: float
    """Length of the move, m."""
    speed: float
    """Speed of walking or running, m/s; horizontal along a flight."""
    spacing: float | None = None
    """Distance between marks to step on, m; None: no marks."""
    curvature: float = 0.0
    """Curvature, 1/m; positive to the left."""
    running: bool = False
    """True when the wearer runs."""
    slope: float = 0.0
    """Slope of a ramp along the move, as rise over run, no unit; 0 on the level and on stairs."""
    direction: float = AHEAD
    """Angle from the heading of the feet to the direction of the move, rad: AHEAD, LEFT, RIGHT or BACK; a straight line
    when it is not AHEAD."""
    stairs: Stairs | None = None
    """Stairs of the flight that the move is; None on the level."""


Action = Stand | Turn | Move | Elevator | Escalator


@frozen
class Piece:
    """A move at its place on the path."""

    start: Pose
    """Pose at the start of the move."""
    move: Move
    flight: Flight | None = None
    """Flight of stairs that the piece is; None on the level."""

    @classmethod
    def of(cls, start: Pose, move: Move) -> Piece:
        """Return the piece of a move from this pose on."""
        stairs = move.stairs
        if stairs is None:
            return cls(start, move)
        edge = start.ahead(ahead(stairs.rise > 0.0, stairs.going), 0.0)
        place = (edge.x, edge.y, start.z, start.heading)
        return cls(start, move, Flight(*place, stairs.steps, stairs.rise, stairs.going, stairs.escalator))

    def leads_on_to(self, following: Piece) -> bool:
        """Return whether a wearer goes on to the next piece without bringing the feet together."""
        one, other = self.move, following.move
        if one.stairs is None and other.stairs is None and one.spacing != other.spacing:
            return False
        return one.direction == other.direction

    def at(self, s: float) -> Pose:
        """Return the pose `s` m from the start; on stairs the height is that of a ramp over them."""
        move, pose = self.move, self.start.ahead(s, self.move.curvature)
        if move.direction:
            moved = evolve(self.start, heading=self.start.heading + move.direction).ahead(s, 0.0)
            pose = evolve(moved, heading=self.start.heading)
        if move.slope:
            return evolve(pose, z=pose.z + move.slope * s, grade=move.slope * cos(move.direction))
        return pose if self.flight is None else evolve(pose, z=pose.z + self.flight.height * s / move.length)


@frozen
class WalkPath:
    """The path from one halt to the next."""

    pieces: tuple[Piece, ...]
    """Pieces in order, all with the same direction."""

    @property
    def length(self) -> float:
        """Length of the path, m."""
        return sum(piece.move.length for piece in self.pieces)

    def at(self, s: float) -> tuple[Pose, Move]:
        """Return the pose `s` m after the halt, and the move there."""
        piece, offset = self._piece(s)
        return piece.at(offset), piece.move

    @property
    def sections(self) -> tuple[WalkPath, ...]:
        """Sections of the path, in order: each flight of stairs, and the level pieces between flights."""
        return tuple(
            [WalkPath(tuple(pieces)) for _, pieces in groupby(self.pieces, lambda piece: piece.flight is None)]
        )

    def pace(self, s: float) -> tuple[float, bool]:
        """Return the speed `s` m after the halt, m/s, and whether the wearer runs there.

        A runner accelerates from the speed of the previous piece and slows down to that of the next one."""
        piece, offset = self._piece(s)
        move, k = piece.move, self.pieces.index(piece)
        if not move.running:
            return move.speed, False
        before = self.pieces[k - 1].move.speed if k else RUN_START_SPEED
        after = self.pieces[k + 1].move.speed if k + 1 < len(self.pieces) else RUN_START_SPEED
        speed_after_start = sqrt(before**2 + 2.0 * RUN_ACCELERATION * max(offset, 0.0))
        speed_before_end = sqrt(after**2 + 2.0 * RUN_ACCELERATION * max(move.length - offset, 0.0))
        speed = min(move.speed, speed_after_start, speed_before_end)
        return speed, speed >= MIN_RUNNING_SPEED

    def _piece(self, s: float) -> tuple[Piece, float]:
        """Return the piece `s` m after the halt, and the distance from its start, m."""
        for piece in self.pieces[:-1]:
            if s < piece.move.length:
                return piece, s
            s -= piece.move.length
        return self.pieces[-1], s


Stage = Stand | Turn | Elevator | Escalator | WalkPath
"""Part of a route between two halts."""


def follow(actions: Iterable[Action]) -> Iterator[tuple[Pose, Action, Piece | None, Pose]]:
    """Yield each action with the pose before it, the piece of a path that it is or None, and the pose after it.

    Poses are on the ground as it lies at the start: those after an escalator do not contain its displacement."""
    pose = Pose(0.0, 0.0, 0.0, 0.0)
    for action in actions:
        start, piece = pose, None
        match action:
            case Turn(angle=angle):
                pose = start.turned(angle)
            case Elevator(height=height):
                pose = evolve(start, z=start.z + height)
            case Move(length=length):
                piece = Piece.of(start, action)
                pose = piece.at(length)
        yield start, action, piece, pose


def stages(actions: Iterable[Action]) -> Iterator[tuple[Pose, Stage]]:
    """Yield the stages that actions make, each with the pose before it."""
    pieces: list[Piece] = []
    for start, action, piece, _ in follow(actions):
        if pieces and (piece is None or not pieces[-1].leads_on_to(piece)):
            yield pieces[0].start, WalkPath(tuple(pieces))
            pieces = []
        if piece is not None:
            pieces.append(piece)
        elif not isinstance(action, Move):
            yield start, action
    if pieces:
        yield pieces[0].start, WalkPath(tuple(pieces))
