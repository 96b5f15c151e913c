"""Which steps turn and which go straight on (Liu et al. 2015, IEEE MASS, section IV.D).

"FootStep-Tracker use low-pass filter to extract the turning steps from the steps of walking straight ahead." The paper
gives no filter. A foot's turn of a straight step is not zero: it has a habit of its own (what the ankle does while the
foot is off the ground), and noise. The habit is the low-passed turn; a step that differs from it by more than
`NO_TURN` is a turning step and turns by that difference; any other goes straight on.
"""

from __future__ import annotations

from ...types.attrs import define, field

NO_TURN = 0.12
"""What straight steps differ by, rad: 3 degrees are their standard deviation on recorded feet, and 11 degrees a step
lead round a circle of 7 m."""
CORNER = 0.35
"""A step that turns further is no habit, rad."""
WEIGHT = 0.1
"""Of a step in the low pass."""
LARGEST_HABIT = 0.3
"""No habit is larger, rad."""


@define
class TurningSteps:
    """O(1), no latency."""

    habit: float = field(default=0.0, init=False)
    """rad."""

    def turn(self, angle: float) -> float:
        """One step that turned by `angle`, rad: by how much the way turned."""
        off = angle - self.habit
        if abs(off) < CORNER:
            self.habit = min(max(self.habit + WEIGHT * off, -LARGEST_HABIT), LARGEST_HABIT)
        return off if abs(off) > NO_TURN else 0.0
