"""Events that are measured from both feet: fused strides, touchdowns, walking modes."""

from __future__ import annotations

from ..types import Foot, Vec2, Vec3, WalkingMode
from ..types.attrs import frozen
from .happening import BaseEvent


@frozen(kw_only=True)
class StrideFused(BaseEvent):
    """A stride of one foot with its length calibrated by a stride of the other foot.

    Source: Chen et al. 2019, IEEE Internet of Things Journal, equations (9) to (13), to which the numbers in brackets
    refer. `t` is the foot-flat that ends the stride. It is reported with the StrideTaken of the stride."""

    foot: Foot
    """Foot that took the stride."""
    number: int
    """Number of the stride (StrideTaken.number)."""
    stride_length: float
    """Calibrated stride length D by (12), m."""
    own_length: float
    """Stride length d that this foot alone measured, m."""
    similarity: float | None
    """Similarity r of both feet's strides by (9), no unit; None without a stride of the other foot to compare with."""
    error_index: float | None
    """Error index EI by (10), m/s; None for an abnormal stride, which is not used for calibration."""
    coefficient: float
    """Share of `own_length` in `stride_length` by (11), 0 to 1."""
    chosen: Foot
    """Foot whose path is the wearer's path after this stride, by (13)."""
    distance: float
    """Sum of the calibrated stride lengths of the chosen foot, m."""
    position: Vec3
    """Position at the end of the chosen foot's calibrated path, world frame, m."""


@frozen
class TrackNode:
    """A position of the wearer in the past."""

    t: float
    """Time at which the wearer was there, s."""
    x: float
    """Position in the world frame, m."""
    y: float
    """Position in the world frame, m."""


@frozen(kw_only=True)
class TrackRevised(BaseEvent):
    """A position that a person has reported has corrected the track: where the wearer is and was.

    It is reported with the PositionReported. Earlier positions (WearerMoved, StrideTaken) were off in the way that the
    nodes show; from now on, positions and strides are corrected, but for the next StrideTaken of each foot."""

    by: Vec2
    """Correction of the position at `t`, x and y in the world frame, m."""
    turn: float
    """Correction of the heading at `t`, rad, counter-clockwise positive."""
    nodes: tuple[TrackNode, ...]
    """Revised path since the position that was reported before, or since the start: at most 41 nodes."""


@frozen(kw_only=True)
class PositionRejected(BaseEvent):
    """A position that a person has reported contradicts the track, or all places on the plan, which stay as they are.

    It is reported with the PositionReported."""

    distance: float
    """Distance of the reported position from the track or from the nearest place, m; 0 if it is not on the plan."""
    sigma: float
    """Standard deviation of that distance from the track, m; of the report, from a place."""
    what: str
    """Sentences for the person who reported it."""


@frozen(kw_only=True)
class TouchedDown(BaseEvent):
    """A foot touched down and bears load; the other foot's position is measured from it until that foot touches down.

    Source: Gong et al. 2023, Sensors 23, 5417, equations (1) to (3) and (8). `t` is the sample that shows it. It is
    reported with that sample, or up to 0.06 s later if the attitudes of limb sensors at `t` are still missing. From
    when the wearer's first heading is known, after 1.5 m of walking, these events are final."""

    foot: Foot
    """Foot that touched down."""
    position: Vec3
    """Position of the touchdown with `compensation` added, world frame, m."""
    mode: WalkingMode
    """Walking mode for which the compensation holds."""
    compensation: Vec3
    """Vector added to the measured position, world frame, m."""
    legs: tuple[tuple[Vec3, ...], tuple[Vec3, ...]] | None = None
    """Hip, knee, ankle and end of the foot at `t`, left and right, relative to the middle of the hips, world frame, m.

    None without the sensors of pelvis, thighs and shanks. The end of the foot is the tip of the rods of figure 8."""


@frozen(kw_only=True)
class WalkingModeChanged(BaseEvent):
    """The walking mode changed (Gong et al. 2023, section 3.3).

    One stance of a foot shows the change. `t` is the sample that ends this stance, most of a second after the
    touchdown. The event is reported with that sample, and is final."""

    mode: WalkingMode
    """The new walking mode."""
    foot: Foot
    """Foot whose stance showed the change."""
