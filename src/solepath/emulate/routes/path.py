"""The path of a route on the floor: poses, pieces, stairs, and the parts between two halts."""

from __future__ import annotations

from math import cos, sin, sqrt

import numpy as np
from attrs import evolve, frozen

from ..wearers.curves import Array
from .lift import Lift
from .styles import RUN_ACCELERATION, RUNNING_FROM

UP, DOWN = 0.25, 0.17
"""Distance from the ankle to the next edge ahead, before a flight and on every tread, upwards and downwards, m.

Upwards the heel is over the edge behind by 4 cm on treads of 0.30 m, and the forefoot rocker ends 9 cm before the next
riser; downwards the ball of the foot is 6 cm behind the edge and the toes are over it."""
HEEL = 0.13
"""Least distance from the ankle back to the riser behind it downwards, m; on shorter treads the toes are out more."""


def ahead(up: bool, going: float) -> float:
    """Return the distance from the ankle to the next edge on treads of depth `going`, m."""
    return UP if up else min(DOWN, going - HEEL)


@frozen
class Flight:
    """A flight of stairs in the world frame, without a limit of its width."""

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

    @property
    def height(self) -> float:
        """Height from floor to floor, m; negative downwards."""
        return self.steps * self.rise

    def along(self, x: Array, y: Array) -> Array:
        """Return the distance of points beyond the first edge, m."""
        return np.asarray((x - self.x) * cos(self.heading) + (y - self.y) * sin(self.heading))

    def ground(self, x: Array, y: Array) -> Array:
        """Return the height of the tread or floor below points, m."""
        return self._tread(self.along(x, y))

    def above(self, x: Array, y: Array, radius: Array) -> Array:
        """Return the height of the centre of a disc that touches the treads or an edge below it, m.

        The disc is vertical along the flight with its centre above (x, y)."""
        u = self.along(x, y)
        least = self._tread(u) + radius
        for k in range(self.steps):
            edge = self.z + self.rise * (k + 1 if self.rise > 0.0 else k)
            inside = radius**2 - (u - k * self.going) ** 2
            least = np.where(inside > 0.0, np.maximum(least, edge + np.sqrt(np.maximum(inside, 0.0))), least)
        return np.asarray(least)

    def _tread(self, u: Array) -> Array:
        return np.asarray(self.z + self.rise * np.clip(np.floor(u / self.going) + 1.0, 0.0, self.steps))


RUN_START_SPEED = 1.2
"""Speed of a runner's first step after a halt and of the last step before one, m/s."""


@frozen
class Pose:
    """A position and a heading on the path, in the world frame."""

    x: float
    """Coordinate x, m."""
    y: float
    """Coordinate y, m."""
    z: float
    """Coordinate z, m."""
    heading: float
    """Heading, rad, not wrapped."""

    def ahead(self, distance: float, curvature: float) -> Pose:
        """Return the pose `distance` m further along an arc of `curvature` 1/m (a straight line when it is 0)."""
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
    """A part of the path: a straight line, an arc or a flight of stairs."""

    start: Pose
    """Pose at the start."""
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
    """Flight of stairs; None on the level."""

    def at(self, s: float) -> Pose:
        """Return the pose `s` m from the start; on stairs its height is that of a ramp."""
        pose = self.start.ahead(s, self.curvature)
        return pose if self.flight is None else evolve(pose, z=pose.z + self.flight.height * s / self.length)


@frozen
class WalkPath:
    """The path from one halt to the next."""

    pieces: tuple[Piece, ...]
    """Pieces in order."""

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
        """Distance between the marks to step on, m: that of the first piece; None: no marks."""
        return self.pieces[0].spacing

    def at(self, s: float) -> tuple[Pose, float]:
        """Return the pose `s` m after the halt, and the speed there, m/s."""
        piece, rest = self._piece(s)
        return piece.at(rest), piece.speed

    @property
    def sections(self) -> tuple[WalkPath, ...]:
        """Flights of stairs one by one, and the level parts between them."""
        found: list[list[Piece]] = []
        for piece in self.pieces:
            if found and piece.flight is None and found[-1][-1].flight is None:
                found[-1].append(piece)
            else:
                found.append([piece])
        return tuple(WalkPath(tuple(pieces)) for pieces in found)

    def pace(self, s: float) -> tuple[float, bool]:
        """Return the speed `s` m after the halt, m/s, and whether the wearer runs there.

        A runner accelerates from the speed of the previous piece and slows down to that of the next one."""
        piece, rest = self._piece(s)
        if not piece.running:
            return piece.speed, False
        k = self.pieces.index(piece)
        before = self.pieces[k - 1].speed if k else RUN_START_SPEED
        after = self.pieces[k + 1].speed if k + 1 < len(self.pieces) else RUN_START_SPEED
        gained = sqrt(before**2 + 2.0 * RUN_ACCELERATION * max(rest, 0.0))
        left = sqrt(after**2 + 2.0 * RUN_ACCELERATION * max(piece.length - rest, 0.0))
        speed = min(piece.speed, gained, left)
        return speed, speed >= RUNNING_FROM

    def curvature(self, s: float) -> float:
        """Return the curvature `s` m after the halt, 1/m; positive to the left."""
        return self._piece(s)[0].curvature

    def _piece(self, s: float) -> tuple[Piece, float]:
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
        return Pose(self.start.x, self.start.y, self.start.z, self.start.heading + self.angle)


@frozen
class Lifted:
    """A ride in a lift."""

    start: Pose
    """Pose before the ride."""
    lift: Lift
    """Parameters of the ride."""

    @property
    def end(self) -> Pose:
        """Pose after the ride."""
        return evolve(self.start, z=self.start.z + self.lift.height)
