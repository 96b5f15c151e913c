"""What the recipes of Gong et al. 2023 choose, and what is known of a wearer (walking-modes)."""

from __future__ import annotations

from ...calibration import Limbs
from ...types import Foot, WalkingMode
from ...types.attrs import frozen
from .compensation import Compensation, chosen
from .mode import TH


@frozen
class ModesSettings:
    """What `Modes` is set to, and all that it is made of."""

    compensation: Compensation | None = None
    """epsilon_P; None for methods I to III."""
    limbs: Limbs = Limbs()
    weight: float | None = None
    """Of the wearer, N; None: it is learnt as the mean of what both feet bear."""
    heading: float | None = None
    """Where the wearer looks in the N-pose, in the world that the devices share, rad, if it is known beforehand, as on
    a floor that was surveyed; None: where the first step goes."""
    th: float = TH
    """TH of mode.py."""

    @property
    def apart(self) -> float:
        """Between the feet at the start, m: the hips' width, as the chain has it in the N-pose. If feet that walk on
        are known to come down nearer to each other than the chain has them, they stood so as well."""
        apart = self.limbs.hip_width
        if self.compensation is None:
            return apart
        left, right = (chosen(self.compensation, foot, WalkingMode.STRAIGHT)[1] for foot in Foot)
        return apart + 0.5 * (left - right)
