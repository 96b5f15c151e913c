"""The path on the floor that a route describes: poses, pieces, stairs, and what is walked from one halt to the next."""

from __future__ import annotations

from math import cos, sin, sqrt

import numpy as np
from attrs import evolve, frozen

from ..wearers.curves import Array
from .lift import Lift
from .styles import RUN_ACCELERATION, RUNNING_FROM

UP, DOWN = 0.25, 0.17
"""m from the ankle of who stands before a flight, and on every tread, to the next edge ahead. Upwards the heel is over
the edge behind by 4 cm on treads of 0.30 m, and the forefoot rocker ends 9 cm before the next riser; downwards the ball
of the foot is 6 cm behind the edge and the toes are over it."""
HEEL = 0.13
"""m from the ankle back to the riser behind it on the way down, at least; on shorter treads the toes are out more."""


def ahead(up: bool, going: float) -> float:
    """m from the ankle to the next edge on treads of this depth."""
    return UP if up else min(DOWN, going - HEEL)


@frozen
class Flight:
    """`steps` risers, `rise` m each (negative: down) and `going` m apart, the first one at (x, y).

    `z`: of the floor before it, m; `heading`: in which it is walked, rad. It is as wide as one likes.
    """

    x: float
    y: float
    z: float
    heading: float
    steps: int
    rise: float
    going: float

    @property
    def height(self) -> float:
        """m from floor to floor, negative when it leads down."""
        return self.steps * self.rise

    def along(self, x: Array, y: Array) -> Array:
        """How far points are beyond the first edge, m."""
        return np.asarray((x - self.x) * cos(self.heading) + (y - self.y) * sin(self.heading))

    def ground(self, x: Array, y: Array) -> Array:
        """Height of the tread or floor below points, m."""
        return self._tread(self.along(x, y))

    def above(self, x: Array, y: Array, radius: Array) -> Array:
        """How high the centre of a disc must be to rest on the treads or an edge below it, m.

        The disc stands upright along the flight with its centre above (x, y).
        """
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
"""m/s: of a runner's first step from a halt and the last one to it."""


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
    """A straight line or an arc from `start`, walked or run at `speed`, or a flight; with marks `spacing` m apart, or
    None."""

    start: Pose
    length: float
    curvature: float
    speed: float
    spacing: float | None = None
    running: bool = False
    flight: Flight | None = None

    def at(self, s: float) -> Pose:
        """The pose `s` m from its beginning; on stairs as high as a ramp over the treads' middles."""
        pose = self.start.ahead(s, self.curvature)
        return pose if self.flight is None else evolve(pose, z=pose.z + self.flight.height * s / self.length)


@frozen
class WalkPath:
    """What is walked from one halt to the next."""

    pieces: tuple[Piece, ...]

    @property
    def length(self) -> float:
        return sum(piece.length for piece in self.pieces)

    @property
    def end(self) -> Pose:
        last = self.pieces[-1]
        return last.at(last.length)

    @property
    def spacing(self) -> float | None:
        """Of the marks to step on, m: what its first move says."""
        return self.pieces[0].spacing

    def at(self, s: float) -> tuple[Pose, float]:
        """The pose after `s` m from the halt, and the speed asked for there."""
        piece, rest = self._piece(s)
        return piece.at(rest), piece.speed

    @property
    def sections(self) -> tuple[WalkPath, ...]:
        """Its flights one by one, and what is level between them."""
        found: list[list[Piece]] = []
        for piece in self.pieces:
            if found and piece.flight is None and found[-1][-1].flight is None:
                found[-1].append(piece)
            else:
                found.append([piece])
        return tuple(WalkPath(tuple(pieces)) for pieces in found)

    def pace(self, s: float) -> tuple[float, bool]:
        """The speed after `s` m, and whether that is running.

        Who runs gets there from the speed of what was before, and in time to that of what follows.
        """
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


@frozen
class Lifted:
    """A ride that begins at `start`."""

    start: Pose
    lift: Lift

    @property
    def end(self) -> Pose:
        return evolve(self.start, z=self.start.z + self.lift.height)
