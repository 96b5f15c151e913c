"""Separation of turning strides from straight ones (Liu et al. 2015, IEEE MASS, section IV.D).

"FootStep-Tracker use low-pass filter to extract the turning steps from the steps of walking straight ahead." The paper
gives no filter. A foot's turn in a straight stride is not zero: each foot has its own usual turn (by the motion of the
ankle while the foot is off the ground), and noise. The usual turn is the low-passed turn. A stride that differs from it
by more than `NO_TURN` is a turning stride and turns by that difference; any other goes straight on."""

from __future__ import annotations

from ...types.attrs import define, field

NO_TURN = 0.12
"""Largest deviation of a straight stride, rad.

The standard deviation is 3 degrees on recorded feet, and 11 degrees a stride lead round a circle of 7 m."""
LARGEST_DEVIATION = 0.35
"""Largest deviation of a stride that enters the usual turn, rad."""
WEIGHT = 0.1
"""Weight of one stride in the low-pass filter."""
LARGEST_STRAIGHT_TURN = 0.3
"""Largest usual turn of a straight stride, rad."""


@define
class TurningSteps:
    """The low-pass filter of one foot: O(1), no latency."""

    straight_turn: float = field(default=0.0, init=False)
    """Usual turn of a straight stride, rad."""

    def turn(self, angle: float) -> float:
        """Add one stride that turned by `angle`, rad, and return by how much the path turned, rad."""
        off = angle - self.straight_turn
        if abs(off) < LARGEST_DEVIATION:
            self.straight_turn = min(
                max(self.straight_turn + WEIGHT * off, -LARGEST_STRAIGHT_TURN), LARGEST_STRAIGHT_TURN
            )
        return off if abs(off) > NO_TURN else 0.0
