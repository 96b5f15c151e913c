"""The clinical stride: one gait cycle of one foot, measured."""

from __future__ import annotations

from ..types import Foot
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class GaitCycleMeasured(Happening):
    """One gait cycle of a foot, from its initial contact to its next one (Perry and Burnfield, Gait Analysis, 2nd ed.
    2010, chapter 1; Whittle, Gait Analysis, 4th ed. 2007, chapter 2). `t` is the second contact. Known at the foot-flat
    after it (0.1 to 0.2 s later), or when the other foot was heard up to `t` where that is later, by at most 0.5 s.

    A contact is a HeelStrike, or the FootFlat of a foot that comes down flat. What cannot be told is None: lengths and
    angles without an inertial sensor, whatever is between the feet while only one is heard, step length and width
    where no part of the recipe puts both feet into one frame. Times in s, lengths in m, angles in rad.

    Times between the feet (`step_time`, double and single support, `phase`) compare two devices' clocks. They are None
    in a cycle during which one of the two was not settled: for 5 s after its stream began or its device or clock began
    anew, and for as long as a late beginning is made good, 5 ms a second (link/clock.py). Given, they are right within
    5 ms of the clocks' (with radios that hold packets back by up to 50 ms); the constant part of what a radio is late
    nobody sees. They are None too where the other foot's contact or toe-off fell into a gap in its samples.

    What it takes for a stride to be `steady`, and so to count in the running means, is in body/gait/measuring.py.
    """

    foot: Foot
    number: int
    """1 for the first stride of this foot that was measured, and so on; not the number of a StrideTaken."""
    t_start: float
    """The contact at which the cycle began, s."""
    t_toe_off: float
    """Of this foot within it, s."""
    stride_time: float
    """From contact to contact (Hollman et al. 2011, Gait & Posture 34)."""
    stance_time: float
    """From contact to toe-off."""
    swing_time: float
    """From toe-off to contact."""
    cadence: float
    """Steps a minute: 120 / `stride_time`, two steps a stride."""
    step_time: float | None
    """From the other foot's contact to the one that ends the cycle."""
    initial_double_support: float | None
    """From this foot's first contact until the other's toe-off, s; below zero it is a flight phase: both feet were in
    the air for so long (Novacheck 1998, Gait & Posture 7)."""
    terminal_double_support: float | None
    """From the other foot's contact until this one's toe-off, s; below zero as above."""
    single_support: float | None
    """How long only this foot was on the ground."""
    phase: float | None
    """When the other foot came down, as a share of the cycle; 0.5 of a symmetric gait (Plotnik et al. 2007, Exp. Brain
    Res. 181, have it in degrees)."""
    stride_length: float | None
    """Horizontal, from foot-flat to foot-flat around the swing (Mariani et al. 2010, J. Biomech. 43)."""
    speed: float | None
    """`stride_length` / `stride_time`, m/s."""
    step_length: float | None
    """From where the other foot stood to where this one came down, along this foot's stride (Huxham et al. 2006, Gait &
    Posture 23), between the sensors: right where both are mounted alike. It takes a recipe whose body measures where
    one foot is from the other (body/gait/measuring.py); two tracks that are only supposed to lie beside one another do
    not tell it."""
    step_width: float | None
    """The other foot's distance from the line of this stride (as above); below zero when the feet cross."""
    clearance: float | None
    """Highest rise of the sensor above the higher of both foot-flats. It is not the minimum toe clearance, which a
    sensor on the instep does not see (Mariani et al. 2012, IEEE Trans. Biomed. Eng. 59, need the shoe's size)."""
    toe_off_angle: float | None
    """How far the heel is up at toe-off: pitch of the foot against flat."""
    heel_strike_angle: float | None
    """How far the toe is up at the contact that ends the cycle; below zero of who lands on the forefoot."""
    turning_angle: float | None
    """Turn of the foot about the vertical over the stride, counter-clockwise positive (Mariani et al. 2010)."""
    rise: float | None
    """How much higher the foot stands afterwards."""
    degraded: bool
    """Samples were missing or saturated within it, or one of its events is inferred."""
    steady: bool
    """It counts in the running means, if another stride follows."""

    @property
    def stance_share(self) -> float:
        """Stance as a share of the cycle."""
        return self.stance_time / self.stride_time

    @property
    def swing_share(self) -> float:
        """Swing as a share of the cycle."""
        return self.swing_time / self.stride_time

    @property
    def double_support(self) -> float | None:
        """Initial and terminal double support together, s; below zero of a runner."""
        if self.initial_double_support is None or self.terminal_double_support is None:
            return None
        return self.initial_double_support + self.terminal_double_support

    @property
    def double_support_share(self) -> float | None:
        """The same as a share of the cycle."""
        both = self.double_support
        return None if both is None else both / self.stride_time

    @property
    def single_support_share(self) -> float | None:
        """Single support as a share of the cycle."""
        return None if self.single_support is None else self.single_support / self.stride_time

    @property
    def running(self) -> bool:
        """The foot was on the ground for less than half of the cycle, as in no walk (Novacheck 1998)."""
        return self.stance_time < 0.5 * self.stride_time
