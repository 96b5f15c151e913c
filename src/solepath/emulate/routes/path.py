"""The path of a route on the floor: poses, pieces, flights of stairs, and paths from one halt to the next."""

from __future__ import annotations

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


@frozen
class Piece:
    """A straight line, an arc or a flight of stairs on the path."""

    start: Pose
    """Pose at the start of the piece."""
    length: float
    """Length of the piece, m."""
    curvature: float
    """Curvature, 1/m; positive to the left."""
    speed: float
    """Speed of walking or running, m/s."""
    spacing: float | None = None
    """Distance between marks to step on, m; None: no marks."""
    running: bool = False
    """True when the wearer runs."""
    flight: Flight | None = None
    """Flight of stairs that the piece is; None on the level."""
    slope: float = 0.0
    """Slope of a ramp along the piece, as rise over run, no unit; 0 on the level and on stairs."""
    direction: float = 0.0
    """Angle from the heading of the feet to the direction of the piece, rad; a straight line when it is not 0."""

    def leads_on_to(self, following: Piece) -> bool:
        """Return whether a wearer goes on to the next piece without bringing the feet together."""
        if self.flight is None and following.flight is None and self.spacing != following.spacing:
            return False
        return self.direction == following.direction

    def at(self, s: float) -> Pose:
        """Return the pose `s` m from the start; on stairs the height is that of a ramp over them."""
        pose = self.start.ahead(s, self.curvature)
        if self.direction:
            moved = evolve(self.start, heading=self.start.heading + self.direction).ahead(s, 0.0)
            pose = evolve(moved, heading=self.start.heading)
        if self.slope:
            return evolve(pose, z=pose.z + self.slope * s, grade=self.slope * cos(self.direction))
        return pose if self.flight is None else evolve(pose, z=pose.z + self.flight.height * s / self.length)


@frozen
class WalkPath:
    """The path from one halt to the next."""

    pieces: tuple[Piece, ...]
    """Pieces in order, all with the same direction."""

    @property
    def direction(self) -> float:
        """Angle from the heading of the feet to the direction of the path, rad: AHEAD, LEFT, RIGHT or BACK."""
        return self.pieces[0].direction

    @property
    def length(self) -> float:
        """Length of the path, m."""
        return sum(piece.length for piece in self.pieces)

    @property
    def end(self) -> Pose:
        """Pose at the end."""
        last = self.pieces[-1]
        return last.at(last.length)

    @property
    def spacing(self) -> float | None:
        """Distance between the marks to step on in the first piece, m; None: no marks."""
        return self.pieces[0].spacing

    def at(self, s: float) -> tuple[Pose, float]:
        """Return the pose `s` m after the halt, and the speed there, m/s."""
        piece, offset = self._piece(s)
        return piece.at(offset), piece.speed

    @property
    def sections(self) -> tuple[WalkPath, ...]:
        """Sections of the path, in order: each flight of stairs, and the level pieces between flights."""
        sections: list[list[Piece]] = []
        for piece in self.pieces:
            if sections and piece.flight is None and sections[-1][-1].flight is None:
                sections[-1].append(piece)
            else:
                sections.append([piece])
        return tuple(WalkPath(tuple(pieces)) for pieces in sections)

    def pace(self, s: float) -> tuple[float, bool]:
        """Return the speed `s` m after the halt, m/s, and whether the wearer runs there.

        A runner accelerates from the speed of the previous piece and slows down to that of the next one."""
        piece, offset = self._piece(s)
        if not piece.running:
            return piece.speed, False
        k = self.pieces.index(piece)
        before = self.pieces[k - 1].speed if k else RUN_START_SPEED
        after = self.pieces[k + 1].speed if k + 1 < len(self.pieces) else RUN_START_SPEED
        speed_after_start = sqrt(before**2 + 2.0 * RUN_ACCELERATION * max(offset, 0.0))
        speed_before_end = sqrt(after**2 + 2.0 * RUN_ACCELERATION * max(piece.length - offset, 0.0))
        speed = min(piece.speed, speed_after_start, speed_before_end)
        return speed, speed >= MIN_RUNNING_SPEED

    def curvature(self, s: float) -> float:
        """Return the curvature `s` m after the halt, 1/m; positive to the left."""
        return self._piece(s)[0].curvature

    def _piece(self, s: float) -> tuple[Piece, float]:
        """Return the piece `s` m after the halt, and the distance from its start, m."""
        for piece in self.pieces[:-1]:
            if s < piece.length:
                return piece, s
            s -= piece.length
        return self.pieces[-1], s


@frozen
class Pivot:
    """A turn on the spot, with the feet together before and after."""

    start: Pose
    """Pose before the turn."""
    angle: float
    """Angle of the turn, rad; counter-clockwise positive."""
    speed: float
    """Walking speed that sets the cadence of the steps, m/s."""

    @property
    def end(self) -> Pose:
        """Pose after the turn."""
        return self.turned(self.angle)

    def turned(self, angle: float) -> Pose:
        """Return the pose after the first `angle` rad of the turn; a ramp falls when it rose before half a turn."""
        start = self.start
        return evolve(start, heading=start.heading + angle, grade=start.grade * cos(angle))


@frozen
class ElevatorStage:
    """An elevator ride as a stage of a route."""

    start: Pose
    """Pose before the ride."""
    elevator: Elevator
    """Parameters of the ride."""

    @property
    def end(self) -> Pose:
        """Pose after the ride."""
        return evolve(self.start, z=self.start.z + self.elevator.height)


@frozen
class EscalatorStage:
    """A ride on an escalator, standing, as a stage of a route."""

    start: Pose
    """Pose before the ride."""
    escalator: Escalator
    """Parameters of the ride."""

    @property
    def end(self) -> Pose:
        """Pose after the ride, without the displacement by the escalator."""
        return self.start
