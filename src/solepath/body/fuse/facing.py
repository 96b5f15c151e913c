"""Which way feet walk: each seen from itself, and both seen from one another."""

from __future__ import annotations

from math import cos, sin

from ...types import Vec3
from ...types.attrs import define, field
from .corridor import wrapped
from .position import PlacedTrack

STRIDE_SAYS = 0.1
"""How much a stride says of which way a foot walks."""
LEAST_ASKEW = 0.5
"""What the first steps of who walks straight off may differ by, rad."""
ALIKE = 0.25
"""So well the same angle is found again, rad."""


@define
class FacingStride:
    """The newest one of a foot."""

    t_end: float
    end: Vec3
    """On its own track, m."""
    direction: float | None
    """In which it led there, rad; None where it was short, led round a corner or is not known well."""


@define
class Facing:
    """Which way a foot walks, seen from itself: who walks backwards or sideways has the other foot elsewhere."""

    turned: float = field(default=0.0, init=False)
    """Sum of the foot's turns, rad."""
    ahead: float | None = field(default=None, init=False)
    """The direction of its strides less that, rad."""

    def off(self, direction: float, turn: float) -> float:
        """By how much a stride in this direction leads elsewhere than those before, rad; the foot turned by `turn`."""
        middle = self.turned + 0.5 * turn
        self.turned = wrapped(self.turned + turn)
        if self.ahead is None:
            self.ahead = wrapped(direction - middle)
        off = wrapped(direction - middle - self.ahead)
        self.ahead = wrapped(self.ahead + STRIDE_SAYS * off)
        return off


@define
class Askew:
    """By how much the tracks of two feet lead apart as they set out.

    A foot's world frame begins along its own first step. Who first puts one foot aside, or steps back and then walks,
    has two tracks at any angle to one another, of which nothing small is true. Two feet that walk go the same way.
    """

    found: float | None = field(default=None, init=False)
    """The last angle, rad."""

    def between(
        self, this: FacingStride, turn: float, beside: FacingStride, others: float, side: float
    ) -> float | None:
        """A stride, the other foot's that ended within it, and by how much their tracks are turned, rad. `side`: 1 of
        the left foot, -1 of the right one. Returns by how much this one leads further round when that is much and as
        much as the last time, rad; None while there is nothing to mend."""
        if this.direction is None or beside.direction is None:
            return None
        before, angle = self.found, wrapped(side * (this.direction + turn - beside.direction - others))
        self.found = angle
        if before is None or abs(angle) < LEAST_ASKEW or abs(wrapped(angle - before)) > ALIKE:
            return None
        self.found = None
        return side * angle


def lay_alongside(
    own: PlacedTrack,
    this: FacingStride,
    other: PlacedTrack,
    beside: FacingStride,
    angle: float,
    half: float,
    aside: float,
) -> None:
    """Turn each of two tracks by half the `angle`, rad, that the one leads further round, and move both as much: then
    the other foot stands beside the middle of the stride, `half` m before its end and `aside` m to the right."""
    own.correct(this.end, -0.5 * angle, 0.0, 0.0)
    other.correct(beside.end, 0.5 * angle, 0.0, 0.0)
    direction = own.turn + (this.direction or 0.0)
    ux, uy = cos(direction), sin(direction)
    (x, y, _), (bx, by, _) = own.place(this.end), other.place(beside.end)
    dx = 0.5 * (x - half * ux + aside * uy - bx)
    dy = 0.5 * (y - half * uy - aside * ux - by)
    own.correct(this.end, 0.0, -dx, -dy)
    other.correct(beside.end, 0.0, dx, dy)
