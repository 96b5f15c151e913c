"""Settings of the recipes of Gong et al. 2023, and of a wearer (walking-modes)."""

from __future__ import annotations

from ...calibration import Limbs
from ...types import Foot, WalkingMode
from ...types.attrs import frozen
from .compensation import Compensation, compensation_of


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
    as_printed: bool = False
    """Flag: the mode is that of the loaded regions (mode.py), and `compensation` holds for any wearer. Otherwise the
    mode is that of how the feet turn (recognition.py), and a wearer's own compensation replaces `compensation`."""

    @property
    def feet_distance(self) -> float:
        """Distance between the feet at the start, m: the hips' width, corrected by the straight mode's compensation.

        If the feet come down nearer to each other than the chain computes, they stand nearer to each other, too."""
        distance = self.limbs.hip_width
        if self.compensation is None:
            return distance
        left, right = (compensation_of(self.compensation, foot, WalkingMode.STRAIGHT)[1] for foot in Foot)
        return distance + 0.5 * (left - right)
