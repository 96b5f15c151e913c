"""Which steps turn and which go straight on (Liu et al. 2015, IEEE MASS, section IV.D).

"FootStep-Tracker use low-pass filter to extract the turning steps from the steps of walking straight ahead." The paper
gives no filter. A foot's turn of a straight step is not zero: it has a habit of its own (what the ankle does while the
foot is off the ground), and noise. The habit is the low-passed turn; a step that differs from it by more than
`straight` is a turning step and turns by that difference; any other goes straight on.
"""

from __future__ import annotations

from ...types.attrs import define, field


@define
class TurningSteps:
    """O(1), no latency."""

    straight: float = 0.12
    """What straight steps differ by, rad: 3 degrees are their standard deviation on recorded feet, and 11 degrees a
    step lead round a circle of 7 m."""
    corner: float = 0.35
    """A step that turns further is no habit, rad."""
    weight: float = 0.1
    """Of a step in the low pass."""
    most: float = 0.3
    """No habit is larger, rad."""
    # state
    habit: float = field(default=0.0, init=False)
    """rad."""

    def turn(self, angle: float) -> float:
        """One step that turned by `angle`, rad: by how much the way turned."""
        off = angle - self.habit
        if abs(off) < self.corner:
            self.habit = min(max(self.habit + self.weight * off, -self.most), self.most)
        return off if abs(off) > self.straight else 0.0
