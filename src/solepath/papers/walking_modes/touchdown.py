"""Detection of touchdowns by three methods, and the rule that makes one foot the reference.

After "Improving Accuracy of Real-Time Positioning and Path Tracking by Using an Error Compensation Algorithm against
Walking Modes" (Gong et al. 2023, Sensors 23, 5417), section 2. Three interchangeable classes compute the touchdown
flags TD_L and TD_R, which are true while the foot is down, from the state of both feet in one sample: `Height` is
method I, `NetAcceleration` method II, `PressureTouchdown` method III (and IV, which adds a compensation: modes.py).

The other foot's position is measured from the reference foot. The paper does not say which foot is the reference while
both are down, or neither. Here (`ReferenceFoot`) a foot that comes down becomes the reference. When the reference foot
comes up, the other foot becomes the reference if it is down. So in walking each foot is the reference from its own
touchdown to the other's. A foot whose sign fails (signs.py) may become the reference after an undetected touchdown
(modes.py)."""

from __future__ import annotations

from ...types import OTHER, Foot, Vec3
from ...types.attrs import define, stateful
from ...types.vector import TIME_EPSILON, ZERO, add, sub


def v_change(left: Vec3, right: Vec3, reference: Foot) -> Vec3:
    """Return the vector from the reference foot to the other foot, m, in the frame of the positions `left` and `right`.

    It is P_L - P_R (1) if the right foot is the reference, otherwise P_R - P_L (2)."""
    return sub(left, right) if reference is Foot.RIGHT else sub(right, left)


def displace(reference: Vec3, change: Vec3, compensation: Vec3 = ZERO) -> Vec3:
    """Return the sum of the vectors: P_s = P_t + V_change (3) + epsilon_P (8), all in m and in one frame."""
    return add(add(reference, change), compensation)


@define
class FootState:
    """The state of one foot; a value that is not measured is None."""

    height: float | None = None
    """Height of the foot, m, upwards positive, in a frame that both feet share."""
    acceleration: float | None = None
    """Magnitude |A| of the acceleration without gravity (5), m/s^2."""
    pressure: float | None = None
    """Value of the most loaded cell, MaxPressure of (6), unit of the samples."""
    highest_pressure: float | None = None
    """Highest value of any cell so far; None if the samples are in N."""


Flags = tuple[bool, bool]
"""Flags TD_L and TD_R."""

HEIGHT_MARGIN = 0.01
"""Least difference of height that changes the flags, m; not in the paper, chosen by hand.

The computed heights of two feet on one floor differ by their errors."""
A_A, STEADY_TIME = 1.0, 0.05
"""Threshold A_a of the net acceleration, m/s^2, and time for which it must be lower until the foot is down, s.

The paper gives neither A_a nor a filter. The threshold is the half width of the band of 9 to 11 m/s^2 in which Jimenez,
Seco, Prieto, Guevara ("A comparison of pedestrian dead-reckoning algorithms using a low-cost MEMS IMU", WISP 2009,
condition C1) take a foot for still. The time was chosen by hand."""
RELEASE_SHARE = 0.5
"""Pressure below which a foot is no longer down, as a share of the threshold: a noisy cell must not make touchdowns."""


@stateful
class Height:
    """Method I, equation (4): the lower foot is down."""

    down: Flags = (False, False)
    """Flags of the last sample."""

    def update(self, t: float, left: FootState, right: FootState) -> Flags:
        if left.height is not None and right.height is not None:
            if right.height > left.height + HEIGHT_MARGIN:
                self.down = (True, False)
            elif left.height > right.height + HEIGHT_MARGIN:
                self.down = (False, True)
        return self.down


@stateful
class NetAcceleration:
    """Method II, equation (5): a foot is down while |A|, without gravity, is below A_a."""

    moving_t: tuple[float | None, float | None] = (None, None)
    """Time, s, at which the left and the right foot last exceeded the threshold; None before the first value."""

    def update(self, t: float, left: FootState, right: FootState) -> Flags:
        a, b = self.moving_t
        self.moving_t = (_last_moved(t, left.acceleration, a), _last_moved(t, right.acceleration, b))
        down = [
            foot.acceleration is not None and moved is not None and t - moved >= STEADY_TIME - TIME_EPSILON
            for foot, moved in zip((left, right), self.moving_t, strict=True)
        ]
        return down[0], down[1]


def _last_moved(t: float, acceleration: float | None, before: float | None) -> float | None:
    """Return the time, s, at which a foot last exceeded A_a, which was `before` until this sample at `t` s."""
    if acceleration is None:
        return before
    return t if before is None or before > t or acceleration >= A_A else before


THRESHOLD, THRESHOLD_SHARE = 5.0, 0.1
"""Threshold of the most loaded cell, N: the least force that the paper's insole records (section 3.1). Share of the
highest value of this foot's cells so far that takes its place if their unit is not known to be N (chosen by hand)."""


@stateful
class PressureTouchdown:
    """Method III, equation (6): a foot is down while its most loaded cell is above a threshold."""

    down: Flags = (False, False)
    """Flags of the last sample."""

    def update(self, t: float, left: FootState, right: FootState) -> Flags:
        self.down = (self.is_down(left, self.down[0]), self.is_down(right, self.down[1]))
        return self.down

    def is_down(self, foot: FootState, down: bool) -> bool:
        """Return whether a foot is down; `down` is true if it was down in the previous sample."""
        if foot.pressure is None:
            return False
        threshold = THRESHOLD if foot.highest_pressure is None else THRESHOLD_SHARE * foot.highest_pressure
        return foot.pressure > (threshold * RELEASE_SHARE if down else threshold)


AnyTouchdown = Height | NetAcceleration | PressureTouchdown
"""Method I, II or III."""


@stateful
class ReferenceFoot:
    """The choice of the reference foot, from which the other foot's place is measured."""

    foot: Foot | None = None
    """Reference foot; None before any foot was down."""
    down: Flags = (False, False)
    """Flags of the last sample."""

    def update(self, flags: Flags) -> tuple[Foot, bool] | None:
        """Return the foot that becomes the reference, and whether it comes down now; None if the reference stays.

        If both feet come down at once, it is the foot that was not the reference; the first time, the left foot."""
        old_flags, self.down = self.down, flags
        came_down = (flags[0] and not old_flags[0], flags[1] and not old_flags[1])
        if self.foot is None:
            if not any(flags):
                return None
            self.foot = Foot.LEFT if flags[0] else Foot.RIGHT
            return self.foot, False
        other = OTHER[self.foot]
        index = 0 if other is Foot.LEFT else 1
        if came_down[index]:
            self.foot = other
            return other, True
        if flags[index] and not flags[1 - index]:
            self.foot = other
            return other, False
        return None
