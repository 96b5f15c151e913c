"""How long the wearer's way is by the strides of the feet, where the mean of both feet has it too short.

Each foot's own track turns slowly away from the truth, and the other's to another side. The mean of two tracks that
point apart is shorter than either, by a quarter when they are 80 degrees apart; its direction is the mean of theirs.
The strides themselves are as long as ever. So the way from a foot's step to its next, with one of the other foot
between, is compared with the mean of both strides.
"""

from __future__ import annotations

from math import hypot

from ...events import StrideTaken
from ...types import Foot, Vec3
from ...types.attrs import define, field

GAIN = 0.06
"""Of one comparison."""
SHORTEST, LONGEST = 0.5, 3.0
"""m; less is no walking, and more no stride."""
STRAIGHT = 0.3
"""A foot that turned by more than this, rad, has walked a bend, which is longer than its chord."""
LEAST, MOST = 0.8, 1.6
"""What a comparison may say."""


@define
class PaceSide:
    """One foot: where the wearer was after its last step, m, and how long that was, m."""

    x: float
    y: float
    stride: float


@define
class StrideScale:
    """`factor`: what the wearer's moves are to be multiplied by."""

    factor: float = field(default=1.0, init=False)
    left: PaceSide | None = field(default=None, init=False)
    right: PaceSide | None = field(default=None, init=False)

    def stepped(self, step: StrideTaken, here: Vec3) -> None:
        """A foot took a step, and the wearer is at `here` now, m."""
        this, other = (self.left, self.right) if step.foot is Foot.LEFT else (self.right, self.left)
        sound = step.length < LONGEST
        if this is not None and other is not None and sound and abs(step.heading_change) < STRAIGHT:
            way, strides = hypot(here[0] - this.x, here[1] - this.y), 0.5 * (step.length + other.stride)
            if way > SHORTEST and LEAST * way < strides < MOST * way:
                self.factor += GAIN * (strides / way - self.factor)
        side = PaceSide(here[0], here[1], step.length) if sound else None
        if step.foot is Foot.LEFT:
            self.left = side
        else:
            self.right = side
