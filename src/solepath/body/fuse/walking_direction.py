"""Walking directions: of one foot relative to its own heading, and of both feet's tracks relative to each other."""

from __future__ import annotations

from math import cos, sin

from ...types import Vec3
from ...types.attrs import define, field
from .position import PlacedTrack
from .straightness import wrap_angle

STRIDE_WEIGHT = 0.1
"""Weight of one stride in the running mean of a foot's walking direction."""
LEAST_DIVERGENCE = 0.5
"""Least angle between two tracks that is corrected, rad; first strides of a straight walk may differ by less."""
REPEAT_TOLERANCE = 0.25
"""Largest difference between two angles that count as equal, rad."""


@define
class DirectedStride:
    """The newest stride of a foot."""

    t_end: float
    """End of the stride, s."""
    end: Vec3
    """Position at the end, on the foot's own track, m."""
    direction: float | None
    """Direction on the foot's own track, rad; None for a short, turning or degraded stride."""


@define
class WalkingDirection:
    """The walking direction of a foot relative to its own heading.

    It changes when the wearer walks backwards or sideways; the usual position of the other foot does not apply then."""

    turn_sum: float = field(default=0.0, init=False)
    """Sum of the foot's turns, rad."""
    direction_offset: float | None = field(default=None, init=False)
    """Mean direction of the foot's strides minus `turn_sum`, rad; None before any stride."""

    def add_stride(self, direction: float, turn: float) -> float:
        """Add a stride with this direction (common frame) and turn, rad; return its deviation from the mean, rad."""
        middle = self.turn_sum + 0.5 * turn
        self.turn_sum = wrap_angle(self.turn_sum + turn)
        if self.direction_offset is None:
            self.direction_offset = wrap_angle(direction - middle)
        deviation = wrap_angle(direction - middle - self.direction_offset)
        self.direction_offset = wrap_angle(self.direction_offset + STRIDE_WEIGHT * deviation)
        return deviation


@define
class TrackDivergence:
    """Detects that the tracks of two feet diverge at the start of a walk.

    A foot's world frame has its x axis along the foot's own first stride. When that stride leads sideways or backwards,
    the two tracks have a large angle between them, which small corrections cannot remove. Two walking feet must have
    the same direction."""

    last_angle: float | None = field(default=None, init=False)
    """The newest angle between the tracks, rad; None before any and after a correction."""

    def update(
        self, stride: DirectedStride, turn: float, other_stride: DirectedStride, other_turn: float, side: float
    ) -> float | None:
        """Return the angle from the other track to this one, rad, if it is large and repeated; None otherwise.

        `other_stride` is the other foot's stride that ended during `stride`. `turn` and `other_turn` are the rotations
        of the tracks, rad. `side` is 1 when `stride` is the left foot's, -1 for the right foot."""
        if stride.direction is None or other_stride.direction is None:
            return None
        previous = self.last_angle
        angle = wrap_angle(side * (stride.direction + turn - other_stride.direction - other_turn))
        self.last_angle = angle
        if previous is None or abs(angle) < LEAST_DIVERGENCE or abs(wrap_angle(angle - previous)) > REPEAT_TOLERANCE:
            return None
        self.last_angle = None
        return side * angle


def align_tracks(
    track: PlacedTrack,
    stride: DirectedStride,
    other_track: PlacedTrack,
    other_stride: DirectedStride,
    angle: float,
    half_stride: float,
    lateral_distance: float,
) -> None:
    """Rotate each of two tracks by half the `angle`, rad, between them, and move both by equal distances.

    Afterwards the other foot stands beside the middle of the stride: `half_stride`, m, before its end and
    `lateral_distance`, m, to the right (negative: to the left)."""
    track.correct(stride.end, -0.5 * angle, 0.0, 0.0)
    other_track.correct(other_stride.end, 0.5 * angle, 0.0, 0.0)
    direction = track.turn + (stride.direction or 0.0)
    ux, uy = cos(direction), sin(direction)
    (x, y, _), (bx, by, _) = track.place(stride.end), other_track.place(other_stride.end)
    dx = 0.5 * (x - half_stride * ux + lateral_distance * uy - bx)
    dy = 0.5 * (y - half_stride * uy - lateral_distance * ux - by)
    track.correct(stride.end, 0.0, -dx, -dy)
    other_track.correct(other_stride.end, 0.0, dx, dy)
