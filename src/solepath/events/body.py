"""What both feet together did: fused strides, touchdowns, walking modes."""

from __future__ import annotations

from ..types import Foot, Vec3, WalkingMode
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class StrideFused(Happening):
    """The stride of one foot, calibrated by the other's, and whose path the wearer's is now (Chen et al. 2019, IEEE
    Internet of Things Journal, equations (9) to (13)).

    Known with the StrideTaken of the stride; `t` is the same, the foot-flat that ends it.
    """

    foot: Foot
    number: int
    """Of the foot's step (StrideTaken.number)."""
    stride_length: float
    """Calibrated, D of (12), m."""
    own_length: float
    """As this foot alone has it, d, m."""
    similarity: float | None
    """r of (9); None when there was no stride of the other foot to compare with."""
    error_index: float | None
    """EI of (10), m/s; None for an abnormal stride, which neither is calibrated nor calibrates."""
    coefficient: float
    """Of (11): the share of the foot's own length in the calibrated one."""
    chosen: Foot
    """Whose path is the wearer's after this step, by (13)."""
    distance: float
    """Sum of the calibrated stride lengths of the chosen foot, m."""
    position: Vec3
    """End of the chosen foot's calibrated path, world frame, m."""


@frozen(kw_only=True)
class TouchedDown(Happening):
    """A foot came down and carries from now on; the other is measured from it (Gong et al. 2023, Sensors 23, 5417,
    equations (1) to (3) and (8)). Known with the sample that shows it, which is `t`; with sensors above the ankles up
    to 0.06 s later, when their attitudes of that moment are there. Not final before the wearer's first heading is
    settled, by 1.5 m of way; later ones are."""

    foot: Foot
    position: Vec3
    """Where it came down, compensated, world frame, m."""
    mode: WalkingMode
    """The walking mode that the compensation is of."""
    compensation: Vec3
    """What was added to the measured place, world frame, m."""


@frozen(kw_only=True)
class WalkingModeChanged(Happening):
    """The wearer walks another way than before (Gong et al. 2023, section 3.3). Known with the sample that ends the
    contact which shows it, which is `t`: most of a second after that foot came down. Final."""

    mode: WalkingMode
    foot: Foot
    """Whose contact showed it."""
