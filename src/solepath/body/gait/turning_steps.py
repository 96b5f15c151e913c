"""Separation of turning strides from straight strides (Liu et al. 2015, IEEE MASS, section IV.D).

"FootStep-Tracker use low-pass filter to extract the turning steps from the steps of walking straight ahead." The paper
gives no filter. A foot's turn in a straight stride is not zero: it is a usual turn of that foot (by the motion of the
ankle while the foot is off the ground) plus noise. A low-pass filter of the turns estimates the usual turn. A stride
whose turn differs from it by more than `STRAIGHT_TOLERANCE` is a turning stride, and the path turns by the difference.
Any other stride is straight.

A filter that learns from turning strides too learns a curve: after ten strides on a circle of 6 m radius, 15 degrees
each, the circle is straight and the way after it bends. A filter that learns from straight strides only does not, but
a usual turn above `STRAIGHT_TOLERANCE`, as (7) of the paper may give, then stays unknown."""

from __future__ import annotations

from ...types.attrs import define, field

STRAIGHT_TOLERANCE = 0.12
"""Largest deviation of a straight stride from the usual turn, rad.

In recordings its standard deviation is 3 degrees. On a circle of 7 m radius a stride turns by 11 degrees."""
MAX_FILTERED_DEVIATION = 0.35
"""Limit of the deviation below which a stride updates the usual turn, rad, if turning strides do that, too."""
STRIDE_WEIGHT = 0.1
"""Weight of one stride in the low-pass filter."""
MAX_STRAIGHT_TURN = 0.3
"""Largest size of the estimated usual turn, rad."""


@define
class TurningStrideFilter:
    """The low-pass filter of one foot's turns; time and memory are O(1), and there is no latency."""

    straight_turn: float = field(default=0.0, init=False)
    """Usual turn of a straight stride, rad, counter-clockwise positive."""

    def turn(self, angle: float, learns_within: float = MAX_FILTERED_DEVIATION) -> float:
        """Add a stride that turned by `angle`, rad, and return the turn of the path, rad; 0 for a straight stride.

        It updates the usual turn if it differs from that by less than `learns_within`, rad."""
        deviation = angle - self.straight_turn
        if abs(deviation) < learns_within:
            self.straight_turn = min(
                max(self.straight_turn + STRIDE_WEIGHT * deviation, -MAX_STRAIGHT_TURN), MAX_STRAIGHT_TURN
            )
        return deviation if abs(deviation) > STRAIGHT_TOLERANCE else 0.0
