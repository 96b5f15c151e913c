"""Which foot carries: three ways to see that a foot is down, and the rule by which one foot takes over from the other.

After "Improving Accuracy of Real-Time Positioning and Path Tracking by Using an Error Compensation Algorithm against
Walking Modes" (Gong et al. 2023, Sensors 23, 5417), section 2. The three parts turn what both feet show in one sample
into the flags TD_L and TD_R and are interchangeable: `Height` is method I, `NetAcceleration` II, `PressureTouchdown`
III (and IV, which adds a compensation: modes.py).

The paper compares flags but does not say which foot carries while both are down, or neither. Here (`Carrier`): a foot
whose flag rises takes over, whatever the other's; a foot whose flag falls hands over to the other if that one is down;
else nothing changes. So in walking each foot carries from its own touchdown to the other's. Where a sign fails a foot
(evidence.py) it may take over with no touchdown seen since it went on: it has come down unseen (modes.py).
"""

from __future__ import annotations

from ...types import OTHER, Foot, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import TIE, ZERO, sub


def v_change(left: Vec3, right: Vec3, carrying: Foot) -> Vec3:
    """From the foot that is down to the one in the air: equation (1), P_L - P_R, where the right foot is down, and (2),
    P_R - P_L, where the left one is. Both positions in one frame, m."""
    return sub(left, right) if carrying is Foot.RIGHT else sub(right, left)


def suspended(carrying: Vec3, change: Vec3, compensation: Vec3 = ZERO) -> Vec3:
    """Where the foot in the air is: equation (3), P_s = P_t + V_change, and with a `compensation` (8), + epsilon_P."""
    return (
        carrying[0] + change[0] + compensation[0],
        carrying[1] + change[1] + compensation[1],
        carrying[2] + change[2] + compensation[2],
    )


@define
class FootState:
    """What one foot shows; what nobody measured is None."""

    height: float | None = None
    """Of its end, z up, in the frame of the other's, m."""
    acceleration: float | None = None
    """|A| of (5): net of gravity, m/s^2."""
    pressure: float | None = None
    """MaxPressure of (6), unit of the samples."""
    full: float | None = None
    """What the most loaded cell has ever shown, where the unit of the samples is not known to be N; else None."""
    swings: bool = False
    """By its own phase (types.Phase)."""
    floor: float = 0.0
    """Height of its own track at its last foot-flat, m."""


Flags = tuple[bool, bool]
"""TD_L, TD_R."""

MARGIN = 0.01
"""A foot that is down is by so much lower, m; within it the last answer stands, since both feet on a floor differ by
their errors. The paper has none."""
A_A, STEADY = 1.0, 0.05
"""m/s^2 and s. The paper gives neither A_a nor its filter. This is the band of 9 to 11 m/s^2 about gravity in which
Jimenez, Seco, Prieto, Guevara ("A comparison of pedestrian dead-reckoning algorithms using a low-cost MEMS IMU", WISP
2009, condition C1) take a foot for still, and it has to last for `STEADY`."""
RELEASE = 0.5
"""A foot that is down comes up below this share of the threshold, or a cell that flickers about it would step."""


@define
class Height:
    """Method I, equation (4): the lower foot is down."""

    down: Flags = field(default=(False, False), init=False)

    def update(self, t: float, left: FootState, right: FootState) -> Flags:
        if left.height is not None and right.height is not None:
            if right.height > left.height + MARGIN:
                self.down = (True, False)
            elif left.height > right.height + MARGIN:
                self.down = (False, True)
        return self.down


@define
class NetAcceleration:
    """Method II, equation (5): a foot is down while |A|, without gravity, is below A_a."""

    moved: tuple[float | None, float | None] = field(default=(None, None), init=False)
    """When each foot was last beyond the threshold, s; None before anything is known."""

    def update(self, t: float, left: FootState, right: FootState) -> Flags:
        (was_left, down_left), (was_right, down_right) = (
            self._one(t, left.acceleration, self.moved[0]),
            self._one(t, right.acceleration, self.moved[1]),
        )
        self.moved = (was_left, was_right)
        return down_left, down_right

    def _one(self, t: float, acceleration: float | None, moved: float | None) -> tuple[float | None, bool]:
        if acceleration is None:
            return moved, False
        if moved is None or moved > t or acceleration >= A_A:
            return t, False
        return moved, t - moved >= STEADY - TIE


@frozen
class PressureTouchdownSettings:
    """What `PressureTouchdown` is set to."""

    threshold: float = 5.0
    """N (section 3.1: the least that the paper's insole records)."""
    share: float = 0.1
    """Where nobody knows what a newton is: of the most that a cell of this foot has ever shown."""


@define
class PressureTouchdown:
    """Method III, equation (6): a foot is down while its most loaded cell is beyond a threshold."""

    settings: PressureTouchdownSettings = PressureTouchdownSettings()
    down: Flags = field(default=(False, False), init=False)

    def update(self, t: float, left: FootState, right: FootState) -> Flags:
        self.down = (self.one(left, self.down[0]), self.one(right, self.down[1]))
        return self.down

    def one(self, foot: FootState, down: bool) -> bool:
        """Whether a foot is down that was `down` before."""
        if foot.pressure is None:
            return False
        threshold = self.settings.threshold if foot.full is None else self.settings.share * foot.full
        return foot.pressure > (threshold * RELEASE if down else threshold)


AnyTouchdown = Height | NetAcceleration | PressureTouchdown


@define
class Carrier:
    """Which foot carries, by the rule above. None before any foot was down."""

    foot: Foot | None = field(default=None, init=False)
    down: Flags = field(default=(False, False), init=False)

    def update(self, flags: Flags) -> tuple[Foot, bool] | None:
        """The foot that takes over with these flags, and whether it came down just now; None when nothing changes.

        When both flags rise at once it is the one that did not carry, at the very first the left foot."""
        before, self.down = self.down, flags
        rose = (flags[0] and not before[0], flags[1] and not before[1])
        if self.foot is None:
            if not any(flags):
                return None
            self.foot = Foot.LEFT if flags[0] else Foot.RIGHT
            return self.foot, False
        other = OTHER[self.foot]
        there = 0 if other is Foot.LEFT else 1
        if rose[there]:
            self.foot = other
            return other, True
        if flags[there] and not flags[1 - there]:
            self.foot = other
            return other, False
        return None
