"""Settings of the recipes of Gong et al. 2023, and of a wearer (walking-modes)."""

from __future__ import annotations

from ...calibration import Limbs
from ...types import Foot, WalkingMode
from ...types.attrs import frozen
from .compensation import Compensation, compensation_of
from .mode import MODE_THRESHOLD


@frozen
class ModesSettings:
    """Settings of `Modes` and of all its parts."""

    compensation: Compensation | None = None
    """Compensation epsilon_P; None for methods I to III."""
    limbs: Limbs = Limbs()
    weight: float | None = None
    """Weight of the wearer, N; None: learnt as the mean load of both feet."""
    heading: float | None = None
    """Wearer's heading in the N-pose, in the world that the devices share, rad; None: the direction of the first step.
    It is known beforehand on a floor that was surveyed."""
    th: float = MODE_THRESHOLD
    """Threshold TH of mode.py."""

    @property
    def feet_distance(self) -> float:
        """Distance between the feet at the start, m: the hips' width, corrected by the compensation of straight walking.

        If the feet come down nearer to each other than the chain computes, they stand nearer to each other, too."""
        distance = self.limbs.hip_width
        if self.compensation is None:
            return distance
        left, right = (compensation_of(self.compensation, foot, WalkingMode.STRAIGHT)[1] for foot in Foot)
        return distance + 0.5 * (left - right)
