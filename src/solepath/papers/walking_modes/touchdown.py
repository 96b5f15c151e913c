"""Detection of touchdowns by three methods, and the rule that makes one foot the reference.

After "Improving Accuracy of Real-Time Positioning and Path Tracking by Using an Error Compensation Algorithm against
Walking Modes" (Gong et al. 2023, Sensors 23, 5417), section 2. The three parts turn the state of both feet in one
sample into the flags TD_L and TD_R and are interchangeable: `Height` is method I, `NetAcceleration` II,
`PressureTouchdown` III (and IV, which adds a compensation: modes.py).

The paper compares flags but does not say which foot is the reference while both are down, or neither. Here
(`ReferenceFoot`): a foot whose flag rises becomes the reference, whatever the other's; if the reference's flag falls,
the other foot becomes the reference if that is down; else nothing changes. So in walking each foot is the reference
from its own touchdown to the other's. A foot whose sign fails (evidence.py) may become the reference without a
touchdown since it moved on: it has come down unseen (modes.py)."""

from __future__ import annotations

from ...types import OTHER, Foot, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import TIE, ZERO, sub


def v_change(left: Vec3, right: Vec3, reference: Foot) -> Vec3:
    """Return the vector from the foot that is down to the one in the air, in the positions' frame, m.

    Equation (1), P_L - P_R, where the right foot is down, and (2), P_R - P_L, where the left one is."""
    return sub(left, right) if reference is Foot.RIGHT else sub(right, left)


def displace(reference: Vec3, change: Vec3, compensation: Vec3 = ZERO) -> Vec3:
    """Return the position of the foot in the air: equation (3), P_s = P_t + V_change; (8), + epsilon_P."""
    return (
        reference[0] + change[0] + compensation[0],
        reference[1] + change[1] + compensation[1],
        reference[2] + change[2] + compensation[2],
    )


@define
class FootState:
    """State of one foot; None for a value that is not measured."""

    height: float | None = None
    """Height of its end, z up, in the same frame as the other's, m."""
    acceleration: float | None = None
    """Acceleration |A| of (5), net of gravity, m/s^2."""
    pressure: float | None = None
    """MaxPressure of (6), unit of the samples."""
    highest_pressure: float | None = None
    """Highest value that any cell has shown, where the samples may not be in N; else None."""
    in_swing: bool = False
    """Flag: the foot swings by its own phase (types.Phase)."""
    flat_height: float = 0.0
    """Height of its own track at its last foot-flat, m."""


Flags = tuple[bool, bool]
"""Flags TD_L and TD_R."""

HEIGHT_MARGIN = 0.01
"""Least difference of height that changes the flags, m: both feet on a floor differ by their errors.

The paper has none."""
A_A, STEADY_TIME = 1.0, 0.05
"""Threshold of the net acceleration, m/s^2, and time for which it must last, s.

The paper gives neither A_a nor a filter. This is the band of 9 to 11 m/s^2 about gravity in which Jimenez, Seco,
Prieto, Guevara ("A comparison of pedestrian dead-reckoning algorithms using a low-cost MEMS IMU", WISP 2009, condition
C1) take a foot for still."""
RELEASE_SHARE = 0.5
"""Share of the threshold below which a foot that is down comes up, or a cell that flickers would make steps."""


@define
class Height:
    """Method I, equation (4): the lower foot is down."""

    down: Flags = field(default=(False, False), init=False)

    def update(self, t: float, left: FootState, right: FootState) -> Flags:
        if left.height is not None and right.height is not None:
            if right.height > left.height + HEIGHT_MARGIN:
                self.down = (True, False)
            elif left.height > right.height + HEIGHT_MARGIN:
                self.down = (False, True)
        return self.down


@define
class NetAcceleration:
    """Method II, equation (5): a foot is down while |A|, without gravity, is below A_a."""

    moving_at: tuple[float | None, float | None] = field(default=(None, None), init=False)
    """Time when each foot was last above the threshold, s; None before the first value."""

    def update(self, t: float, left: FootState, right: FootState) -> Flags:
        (was_left, down_left), (was_right, down_right) = (
            self._foot_down(t, left.acceleration, self.moving_at[0]),
            self._foot_down(t, right.acceleration, self.moving_at[1]),
        )
        self.moving_at = (was_left, was_right)
        return down_left, down_right

    def _foot_down(self, t: float, acceleration: float | None, moving_at: float | None) -> tuple[float | None, bool]:
        if acceleration is None:
            return moving_at, False
        if moving_at is None or moving_at > t or acceleration >= A_A:
            return t, False
        return moving_at, t - moving_at >= STEADY_TIME - TIE


@frozen
class PressureTouchdownSettings:
    """Settings of `PressureTouchdown`."""

    threshold: float = 5.0
    """Threshold of the most loaded cell, N (section 3.1: the least that the paper's insole records)."""
    share: float = 0.1
    """Threshold as a share of the highest value of this foot's cells, where their unit may not be N."""


@define
class PressureTouchdown:
    """Method III, equation (6): a foot is down while its most loaded cell is above a threshold."""

    settings: PressureTouchdownSettings = PressureTouchdownSettings()
    down: Flags = field(default=(False, False), init=False)

    def update(self, t: float, left: FootState, right: FootState) -> Flags:
        self.down = (self.is_down(left, self.down[0]), self.is_down(right, self.down[1]))
        return self.down

    def is_down(self, foot: FootState, down: bool) -> bool:
        """Return whether a foot is down, given whether it was `down` before."""
        if foot.pressure is None:
            return False
        threshold = (
            self.settings.threshold if foot.highest_pressure is None else self.settings.share * foot.highest_pressure
        )
        return foot.pressure > (threshold * RELEASE_SHARE if down else threshold)


AnyTouchdown = Height | NetAcceleration | PressureTouchdown


@define
class ReferenceFoot:
    """The foot that the other's place is measured from; None before any foot was down."""

    foot: Foot | None = field(default=None, init=False)
    down: Flags = field(default=(False, False), init=False)

    def update(self, flags: Flags) -> tuple[Foot, bool] | None:
        """Return the foot that becomes the reference with these flags, and whether it came down now; None if none.

        When both flags rise at once it is the foot that was not the reference, at the very first the left foot."""
        before, self.down = self.down, flags
        rose = (flags[0] and not before[0], flags[1] and not before[1])
        if self.foot is None:
            if not any(flags):
                return None
            self.foot = Foot.LEFT if flags[0] else Foot.RIGHT
            return self.foot, False
        other = OTHER[self.foot]
        index = 0 if other is Foot.LEFT else 1
        if rose[index]:
            self.foot = other
            return other, True
        if flags[index] and not flags[1 - index]:
            self.foot = other
            return other, False
        return None
