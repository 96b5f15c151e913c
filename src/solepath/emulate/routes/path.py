"""The path on the floor that a route describes: poses, pieces, and what is walked from one halt to the next."""

from __future__ import annotations

from math import cos, sin, sqrt

from attrs import evolve, frozen

from .lift import Lift
from .stairs import Flight
from .styles import GETTING_GOING, RUNNING_FROM

TURNING_POINT = 1.2
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
        before = self.pieces[k - 1].speed if k else TURNING_POINT
        after = self.pieces[k + 1].speed if k + 1 < len(self.pieces) else TURNING_POINT
        gained = sqrt(before**2 + 2.0 * GETTING_GOING * max(rest, 0.0))
        left = sqrt(after**2 + 2.0 * GETTING_GOING * max(piece.length - rest, 0.0))
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
