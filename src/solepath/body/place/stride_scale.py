"""Scale of the wearer's path: the strides of the feet against the mean of both tracks, which is too short.

The heading of each foot's own track drifts from the truth, and the other's to another side. The mean of two tracks that
diverge is shorter than either, by a quarter at an angle of 80 degrees; its direction is the mean of theirs. The lengths
of the strides do not change. Therefore the distance from one stride end of a foot to its next, with one of the other
foot between, is compared with the mean of both strides."""

from __future__ import annotations

from math import hypot

from ...events import StrideTaken
from ...types import Foot, Vec3
from ...types.attrs import define, field

GAIN = 0.06
"""Gain of one comparison."""
SHORTEST_DISTANCE, LONGEST_STRIDE = 0.5, 3.0
"""Least distance that is compared, m (less is no walking), and longest stride, m."""
LARGEST_TURN = 0.3
"""Largest turn of a foot in a stride that is compared, rad: a bend is longer than its chord."""
LEAST_RATIO, LARGEST_RATIO = 0.8, 1.6
"""Least and largest ratio of stride and distance that is used."""


@define
class LastStride:
    """The last stride of one foot: place of the wearer after it, m, and its length, m."""

    x: float
    y: float
    stride: float


@define
class StrideScale:
    """The scale by which the wearer's moves are multiplied, `factor`."""

    factor: float = field(default=1.0, init=False)
    """Scale of the wearer's moves."""
    left: LastStride | None = field(default=None, init=False)
    right: LastStride | None = field(default=None, init=False)

    def add_stride(self, stride: StrideTaken, here: Vec3) -> None:
        """Add a stride of a foot; `here` is the wearer's place after it, m."""
        this, other = (self.left, self.right) if stride.foot is Foot.LEFT else (self.right, self.left)
        sound = stride.length < LONGEST_STRIDE
        if this is not None and other is not None and sound and abs(stride.heading_change) < LARGEST_TURN:
            distance, mean_stride = hypot(here[0] - this.x, here[1] - this.y), 0.5 * (stride.length + other.stride)
            if distance > SHORTEST_DISTANCE and LEAST_RATIO * distance < mean_stride < LARGEST_RATIO * distance:
                self.factor += GAIN * (mean_stride / distance - self.factor)
        side = LastStride(here[0], here[1], stride.length) if sound else None
        if stride.foot is Foot.LEFT:
            self.left = side
        else:
            self.right = side
