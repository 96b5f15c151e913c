"""Directions in which feet walk: of one foot against its own heading, and of both tracks against one another."""

from __future__ import annotations

from math import cos, sin

from ...types import Vec3
from ...types.attrs import define, field
from .corridor import wrapped
from .position import PlacedTrack

STRIDE_WEIGHT = 0.1
"""Weight of one stride in the walking direction of a foot."""
LEAST_DIVERGENCE = 0.5
"""Least angle between two tracks that is corrected, rad; first strides may differ by less when walking straight off."""
REPEAT_TOLERANCE = 0.25
"""Largest difference at which two angles count as the same, rad."""


@define
class DirectedStride:
    """The newest stride of a foot."""

    t_end: float
    """End of the stride, s."""
    end: Vec3
    """Place at the end on the foot's own track, m."""
    direction: float | None
    """Direction on the foot's own track, rad; None for a stride that is short, turns a corner or is not well known."""


@define
class WalkingDirection:
    """The direction in which a foot walks against its own heading.

    A wearer who walks backwards or sideways has the other foot elsewhere."""

    turned: float = field(default=0.0, init=False)
    """Sum of the foot's turns, rad."""
    ahead: float | None = field(default=None, init=False)
    """Direction of the foot's strides minus the sum of its turns, rad."""

    def deviation(self, direction: float, turn: float) -> float:
        """Add one stride and return how far it deviates from the direction before, rad; the foot turned by `turn`."""
        middle = self.turned + 0.5 * turn
        self.turned = wrapped(self.turned + turn)
        if self.ahead is None:
            self.ahead = wrapped(direction - middle)
        off = wrapped(direction - middle - self.ahead)
        self.ahead = wrapped(self.ahead + STRIDE_WEIGHT * off)
        return off


@define
class TrackDivergence:
    """The angle by which the tracks of two feet diverge as they set out.

    A foot's world frame starts along its own first stride. A wearer who first puts one foot aside, or steps back and
    then walks, has two tracks at any angle to one another, which no small correction can align. Two feet that walk go
    the same way."""

    found: float | None = field(default=None, init=False)
    """The last angle, rad."""

    def update(
        self, this: DirectedStride, turn: float, beside: DirectedStride, others: float, side: float
    ) -> float | None:
        """Return the angle by which this track leads further round, rad, if it is large and repeated; else None.

        `this` is a stride, `beside` the other foot's that ended within it; `turn` and `others` are the turns of their
        tracks, rad. `side` is 1 for the left foot, -1 for the right one."""
        if this.direction is None or beside.direction is None:
            return None
        before, angle = self.found, wrapped(side * (this.direction + turn - beside.direction - others))
        self.found = angle
        if before is None or abs(angle) < LEAST_DIVERGENCE or abs(wrapped(angle - before)) > REPEAT_TOLERANCE:
            return None
        self.found = None
        return side * angle


def align_tracks(
    own: PlacedTrack,
    this: DirectedStride,
    other: PlacedTrack,
    beside: DirectedStride,
    angle: float,
    half: float,
    aside: float,
) -> None:
    """Turn each of two tracks by half the `angle`, rad, that this one leads further round, and move both as much.

    Then the other foot stands beside the middle of the stride, `half` m before its end and `aside` m to the right."""
    own.correct(this.end, -0.5 * angle, 0.0, 0.0)
    other.correct(beside.end, 0.5 * angle, 0.0, 0.0)
    direction = own.turn + (this.direction or 0.0)
    ux, uy = cos(direction), sin(direction)
    (x, y, _), (bx, by, _) = own.place(this.end), other.place(beside.end)
    dx = 0.5 * (x - half * ux + aside * uy - bx)
    dy = 0.5 * (y - half * uy - aside * ux - by)
    own.correct(this.end, 0.0, -dx, -dy)
    other.correct(beside.end, 0.0, dx, dy)
