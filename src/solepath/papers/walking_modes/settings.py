"""Settings of the recipes of Gong et al. 2023, and of a wearer (walking-modes)."""

from __future__ import annotations

from enum import Enum

from ...calibration import Limbs
from ...types import Foot, WalkingMode
from ...types.attrs import frozen
from .compensation import Compensation, compensation_of
from .mode import MODE_THRESHOLD


class ModeRule(Enum):
    """Rule by which the walking mode is recognised."""

    TURN = "turn"
    """By how far the feet turn over a stride (turning.py); ours."""
    TABLE_2 = "table 2"
    """By the loaded regions of the soles (mode.py), as printed."""
    TABLE_2_AT_SPEED = "table 2 at speed"
    """By the loaded regions after conversion to one speed (mode.py)."""


@frozen
class ModesSettings:
    """Settings of `Modes` and of all its parts."""

    compensation: Compensation | None = None
    """Compensation epsilon_P; None for methods I to III."""
    limbs: Limbs = Limbs()
    """Lengths of the wearer's limbs."""
    weight: float | None = None
    """Weight of the wearer, N; None if it is to be learnt as the mean load of both feet."""
    heading: float | None = None
    """Heading of the wearer in the N-pose (limbs.py), rad, left positive, in the world that the devices share. None for
    the direction of the first step. On a surveyed floor it may be known beforehand."""
    rule: ModeRule = ModeRule.TURN
    """Rule by which the walking mode is recognised."""
    th: float = MODE_THRESHOLD
    """Threshold th of mode.py, as a multiple of the mean load of a cell; for the rules of table 2."""
    own_compensation: bool = True
    """Flag: a wearer's own compensation (`Calibration.modes`) replaces `compensation`; as printed, it does not."""

    @property
    def feet_distance(self) -> float:
        """Distance between the feet at the start, m: the hips' width, corrected by the straight mode's compensation.

        If the feet come down nearer to each other than the chain computes, they stand nearer to each other, too."""
        distance = self.limbs.hip_width
        if self.compensation is None:
            return distance
        left, right = (compensation_of(self.compensation, foot, WalkingMode.STRAIGHT)[1] for foot in Foot)
        return distance + 0.5 * (left - right)
