"""Events of both feet together: fused strides, touchdowns, walking modes."""

from __future__ import annotations

from ..types import Foot, Vec3, WalkingMode
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class StrideFused(Happening):
    """The stride of one foot, calibrated by the other foot's.

    It names the foot whose path is the wearer's from now on (Chen et al. 2019, IEEE Internet of Things Journal,
    equations (9) to (13)). Known with the StrideTaken of the stride; `t` is the same, the foot-flat that ends it."""

    foot: Foot
    """Foot that took the stride."""
    number: int
    """Number of the stride (StrideTaken.number)."""
    stride_length: float
    """Calibrated stride length, D of (12), m."""
    own_length: float
    """Stride length by this foot alone, d, m."""
    similarity: float | None
    """Similarity r of (9); None when there was no stride of the other foot to compare with."""
    error_index: float | None
    """Error index EI of (10), m/s; None for an abnormal stride, which neither is calibrated nor calibrates."""
    coefficient: float
    """Share of the foot's own length in the calibrated length, (11)."""
    chosen: Foot
    """Foot whose path is the wearer's after this stride, by (13)."""
    distance: float
    """Sum of the calibrated stride lengths of the chosen foot, m."""
    position: Vec3
    """End of the chosen foot's calibrated path, world frame, m."""


@frozen(kw_only=True)
class TouchedDown(Happening):
    """A foot touched down and bears load from now on; the other foot is measured from it.

    Source: Gong et al. 2023, Sensors 23, 5417, equations (1) to (3) and (8). Known with the sample that shows it, which
    is `t`; with sensors above the ankles up to 0.06 s later, when their attitudes of that moment are there. Not final
    before the wearer's first heading is settled, after 1.5 m of walking; later ones are."""

    foot: Foot
    """Foot that touched down."""
    position: Vec3
    """Compensated place of the touchdown, world frame, m."""
    mode: WalkingMode
    """Walking mode of the compensation."""
    compensation: Vec3
    """Vector added to the measured place, world frame, m."""


@frozen(kw_only=True)
class WalkingModeChanged(Happening):
    """The walking mode changed (Gong et al. 2023, section 3.3).

    Known with the sample that ends the contact which shows it, which is `t`: most of a second after that foot's
    touchdown. Final."""

    mode: WalkingMode
    """The new walking mode."""
    foot: Foot
    """Foot whose contact showed the change."""
