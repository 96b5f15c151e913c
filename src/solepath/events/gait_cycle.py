"""The event of one measured gait cycle of one foot."""

from __future__ import annotations

from ..types import Foot
from ..types.attrs import frozen
from .happening import BaseEvent


@frozen(kw_only=True)
class GaitCycleMeasured(BaseEvent):
    """One gait cycle of a foot, from its initial contact to its next initial contact.

    Sources: Perry and Burnfield, Gait Analysis, 2nd ed. 2010, chapter 1; Whittle, Gait Analysis, 4th ed. 2007, chapter
    2. A contact is a HeelStrike, or the FootFlat of a foot that lands flat. `t` is the contact that ends the cycle. The
    event is reported at the next foot-flat, 0.1 to 0.2 s after `t`. If the other foot's data have not reached `t` then,
    the event waits for them until 0.5 s after `t` at most.

    A value that cannot be measured is None: lengths and angles without an inertial sensor; times between the feet
    while only one foot has data.

    Times between the feet (`step_time`, double and single support, `phase`) compare two devices' clocks. They are None
    if one of the two clocks was not settled during the cycle. A clock is settled 5 s after its stream started or its
    device or clock restarted; after a late start it takes longer, because a delay is corrected by 5 ms a second
    (link/clock.py). Between settled clocks the error of these times is up to 5 ms, with radios that hold packets back
    by up to 50 ms, plus the constant part of the radios' delay, which cannot be measured. They are also None if the
    other foot's contact or toe-off lies in a gap in its samples, after a DefectFound of the clocks of the feet or one
    that spoils a foot, and if the cycle would have both a double support and a flight of more than 50 ms, which neither
    a walk nor a run has.

    The conditions for a `steady` cycle, which counts in the running means, are in body/gait/cycles.py."""

    foot: Foot
    """Foot of the cycle."""
    number: int
    """Number of the measured cycle, 1 for the first of this foot, independent of `StrideTaken.number`."""
    t_start: float
    """Time of the contact that starts the cycle, s."""
    t_toe_off: float
    """Time of this foot's toe-off within the cycle, s."""
    stride_time: float
    """Time from contact to contact, s (Hollman et al. 2011, Gait & Posture 34)."""
    stance_time: float
    """Time from contact to toe-off, s."""
    swing_time: float
    """Time from toe-off to contact, s."""
    cadence: float
    """Steps a minute of both feet, 1/min: 120 / `stride_time`, because a cycle has two steps."""
    step_time: float | None
    """Time from the other foot's contact to the contact that ends the cycle, s."""
    initial_double_support: float | None
    """Time from this foot's first contact until the other foot's toe-off, s; negative in running. A negative value is
    the time for which both feet were in the air (Novacheck 1998, Gait & Posture 7)."""
    terminal_double_support: float | None
    """Time from the other foot's contact until this foot's toe-off, s; negative in running."""
    single_support: float | None
    """Time for which only this foot was on the ground, s."""
    phase: float | None
    """Time from the start of the cycle to the other foot's contact, as a share of the cycle; 0.5 for a symmetric gait.
    Plotnik et al. 2007, Exp. Brain Res. 181, give it in degrees."""
    stride_length: float | None
    """Horizontal distance from the foot-flat before the swing to the next, m (Mariani et al. 2010, J. Biomech. 43)."""
    speed: float | None
    """Speed of walking, `stride_length` / `stride_time`, m/s."""
    clearance: float | None
    """Highest rise of the sensor above the higher of the two foot-flats, m. It is not the minimum toe clearance, which
    a sensor on the instep cannot measure (Mariani et al. 2012, IEEE Trans. Biomed. Eng. 59, use the shoe's size)."""
    toe_off_angle: float | None
    """Pitch of the foot at toe-off relative to the flat sole at mid-stance, rad; positive when the heel is up."""
    heel_strike_angle: float | None
    """Pitch of the foot at the contact that ends the cycle, relative to the flat sole, rad; positive toe up."""
    turning_angle: float | None
    """Turn of the foot about the vertical over the stride, rad, counter-clockwise positive (Mariani et al. 2010)."""
    rise: float | None
    """Height of the foot after the stride above its height before, m."""
    degraded: bool
    """True when its stride has flaws, a gap in it would be one, one of its gait events is inferred, or a defect spoils
    the data of its foot."""
    steady: bool
    """True when the cycle counts in the means (`Session.gait`, summary, report) if another cycle of the foot follows at
    once, which starts at this `t`; so the last cycle before a stop counts in none."""

    @property
    def stance_share(self) -> float:
        """Stance as a share of the cycle, 0 to 1."""
        return self.stance_time / self.stride_time

    @property
    def swing_share(self) -> float:
        """Swing as a share of the cycle, 0 to 1."""
        return self.swing_time / self.stride_time

    @property
    def double_support(self) -> float | None:
        """Sum of initial and terminal double support, s; negative for a runner."""
        if self.initial_double_support is None or self.terminal_double_support is None:
            return None
        return self.initial_double_support + self.terminal_double_support

    @property
    def double_support_share(self) -> float | None:
        """Sum of initial and terminal double support as a share of the cycle; negative for a runner."""
        both = self.double_support
        return None if both is None else both / self.stride_time

    @property
    def single_support_share(self) -> float | None:
        """Single support as a share of the cycle, 0 to 1."""
        return None if self.single_support is None else self.single_support / self.stride_time

    @property
    def running(self) -> bool:
        """True if the foot was on the ground for less than half of the cycle, as only in running (Novacheck 1998)."""
        return self.stance_time < 0.5 * self.stride_time
