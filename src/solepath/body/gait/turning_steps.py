"""Separation of turning strides from straight strides (Liu et al. 2015, IEEE MASS, section IV.D).

"FootStep-Tracker use low-pass filter to extract the turning steps from the steps of walking straight ahead." The paper
gives no filter. A foot's turn in a straight stride is not zero: it is a usual turn of that foot (by the motion of the
ankle while the foot is off the ground) plus noise. A low-pass filter of the turns estimates the usual turn. A stride
whose turn differs from it by more than `STRAIGHT_TOLERANCE` is a turning stride, and the path turns by the difference.
Any other stride is straight.

That loses two things, which `corner_turn` keeps. A filter that learns from turning strides learns a curve: after ten
strides on a circle of 6 m radius, 15 degrees each, the circle is straight and the way after it bends. So only straight
strides are learnt from. And a corner starts and ends with strides that turn by less than the tolerance, so it comes out
too small. So the stride before and the stride after a turning one turn the path as well."""

from __future__ import annotations

from ...types.attrs import define, field

STRAIGHT_TOLERANCE = 0.12
"""Largest deviation of a straight stride from the usual turn, rad.

In recordings its standard deviation is 3 degrees. On a circle of 7 m radius a stride turns by 11 degrees."""
MAX_FILTERED_DEVIATION = 0.35
"""Limit of the deviation from the usual turn below which a stride updates that turn, rad."""
STRIDE_WEIGHT = 0.1
"""Weight of one stride in the low-pass filter."""
MAX_STRAIGHT_TURN = 0.3
"""Largest size of the estimated usual turn, rad."""


@define
class TurningStrideFilter:
    """The low-pass filter of one foot's turns; time and memory are O(1), and there is no latency."""

    straight_turn: float = field(default=0.0, init=False)
    """Usual turn of a straight stride, rad, counter-clockwise positive."""

    straight_deviation: float | None = field(default=0.0, init=False)
    """Deviation of the last stride from the usual turn, rad, or 0; None when the path has turned with it."""

    def turn(self, angle: float) -> float:
        """Add a stride that turned by `angle`, rad, and return the turn of the path, rad; 0 for a straight stride."""
        deviation = self._learn(angle, MAX_FILTERED_DEVIATION)
        return deviation if abs(deviation) > STRAIGHT_TOLERANCE else 0.0

    def corner_turn(self, angle: float) -> float:
        """Add a stride that turned by `angle`, rad, and return the turn of the path since the last one, rad.

        It includes the strides beside a turning stride. A usual turn above `STRAIGHT_TOLERANCE` is not learnt."""
        deviation, before = self._learn(angle, STRAIGHT_TOLERANCE), self.straight_deviation
        if abs(deviation) > STRAIGHT_TOLERANCE:
            self.straight_deviation = None
            return deviation + (before or 0.0)
        if before is None:
            self.straight_deviation = 0.0
            return deviation
        self.straight_deviation = deviation
        return 0.0

    def forget_corner(self) -> None:
        """Forget the last stride, which the next one does not follow."""
        self.straight_deviation = 0.0

    def _learn(self, angle: float, within: float) -> float:
        """Return the deviation from the usual turn, which it updates if it is below `within`; both in rad."""
        deviation = angle - self.straight_turn
        if abs(deviation) < within:
            self.straight_turn = min(
                max(self.straight_turn + STRIDE_WEIGHT * deviation, -MAX_STRAIGHT_TURN), MAX_STRAIGHT_TURN
            )
        return deviation
