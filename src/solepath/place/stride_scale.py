"""Scale of the wearer's path: the ratio of the feet's stride lengths to the moves of the mean of both tracks.

The headings of the two feet's tracks drift apart. The mean of two tracks that diverge is shorter than either, by a
quarter at an angle of 80 degrees, while the stride lengths do not change. Therefore the distance between two stride
ends of one foot on the mean track is compared with the mean length of this stride and the other foot's last stride."""

from __future__ import annotations

from math import hypot

from ..events import StrideTaken
from ..types import Foot, Vec3
from ..types.attrs import define, field

SCALE_GAIN = 0.06
"""Gain of the scale's low-pass filter for one comparison."""
MIN_DISTANCE, MAX_STRIDE_LENGTH = 0.5, 3.0
"""Least distance that is compared, m (less is not walking), and longest plausible stride, m."""
MAX_TURN = 0.3
"""Largest turn of a foot in a stride that is compared, rad: a bend is longer than its chord."""
MIN_RATIO, MAX_RATIO = 0.8, 1.6
"""Least and largest ratio of stride length to distance that is used."""


@define
class LastStride:
    """The last stride of one foot: position of the wearer after it, m, and stride length, m."""

    x: float
    y: float
    stride: float


@define
class StrideScale:
    """Estimates the factor by which the wearer's moves are multiplied."""

    factor: float = field(default=1.0, init=False)
    """Factor of the wearer's moves."""
    left: LastStride | None = field(default=None, init=False)
    right: LastStride | None = field(default=None, init=False)

    def add_stride(self, stride: StrideTaken, here: Vec3) -> None:
        """Add a stride of a foot; `here` is the wearer's position after it, m."""
        this, other = (self.left, self.right) if stride.foot is Foot.LEFT else (self.right, self.left)
        is_plausible = stride.length < MAX_STRIDE_LENGTH
        if this is not None and other is not None and is_plausible and abs(stride.heading_change) < MAX_TURN:
            distance, mean_stride = hypot(here[0] - this.x, here[1] - this.y), 0.5 * (stride.length + other.stride)
            if distance > MIN_DISTANCE and MIN_RATIO * distance < mean_stride < MAX_RATIO * distance:
                self.factor += SCALE_GAIN * (mean_stride / distance - self.factor)
        side = LastStride(here[0], here[1], stride.length) if is_plausible else None
        if stride.foot is Foot.LEFT:
            self.left = side
        else:
            self.right = side

    def forget(self) -> None:
        """Forget the last strides, whose positions no longer belong to the track."""
        self.left = self.right = None
