"""Event of the clinical stride: one gait cycle of one foot, measured."""

from __future__ import annotations

from ..types import Foot
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class GaitCycleMeasured(Happening):
    """One gait cycle of a foot, from its initial contact to its next one.

    Sources: Perry and Burnfield, Gait Analysis, 2nd ed. 2010, chapter 1; Whittle, Gait Analysis, 4th ed. 2007, chapter
    2. `t` is the second contact. Known at the foot-flat after it (0.1 to 0.2 s later), or when the other foot's data
    have reached `t` where that is later, by at most 0.5 s.

    A contact is a HeelStrike, or the FootFlat of a foot that lands flat. A value that cannot be measured is None:
    lengths and angles without an inertial sensor, values between the feet while only one foot has data, step length and
    width where no part of the recipe puts both feet into one frame. Times in s, lengths in m, angles in rad.

    Times between the feet (`step_time`, double and single support, `phase`) compare two devices' clocks. They are None
    in a cycle during which one of the two was not settled: for 5 s after its stream started or its device or clock
    restarted, and for as long as the delay of a late start is slewed away, 5 ms a second (link/clock.py). Otherwise
    they are right within 5 ms of the clocks' (with radios that hold packets back by up to 50 ms); the constant part of
    a radio's delay cannot be seen. They are None too where the other foot's contact or toe-off fell into a gap in its
    samples.

    The conditions for a `steady` stride, which counts in the running means, are in body/gait/measuring.py."""

    foot: Foot
    """Foot of the cycle."""
    number: int
    """Number of the measured cycle, 1 for the first of this foot; not the number of a StrideTaken."""
    t_start: float
    """Contact at which the cycle started, s."""
    t_toe_off: float
    """Toe-off of this foot within the cycle, s."""
    stride_time: float
    """Time from contact to contact, s (Hollman et al. 2011, Gait & Posture 34)."""
    stance_time: float
    """Time from contact to toe-off, s."""
    swing_time: float
    """Time from toe-off to contact, s."""
    cadence: float
    """Steps a minute: 120 / `stride_time`, two steps a stride."""
    step_time: float | None
    """Time from the other foot's contact to the one that ends the cycle, s."""
    initial_double_support: float | None
    """Time from this foot's first contact until the other's toe-off, s; negative for a flight phase. In a flight phase
    both feet were in the air for so long (Novacheck 1998, Gait & Posture 7)."""
    terminal_double_support: float | None
    """Time from the other foot's contact until this one's toe-off, s; negative for a flight phase."""
    single_support: float | None
    """Time for which only this foot was on the ground, s."""
    phase: float | None
    """Time of the other foot's contact, as a share of the cycle; 0.5 for a symmetric gait. Source: Plotnik et al. 2007,
    Exp. Brain Res. 181, who have it in degrees."""
    stride_length: float | None
    """Horizontal length from foot-flat to foot-flat around the swing, m (Mariani et al. 2010, J. Biomech. 43)."""
    speed: float | None
    """Speed of walking, `stride_length` / `stride_time`, m/s."""
    step_length: float | None
    """Distance from the other foot's place to this foot's landing place, along this foot's stride, m. Source: Huxham et
    al. 2006, Gait & Posture 23. It is measured between the sensors: right where both are mounted alike. It needs a
    recipe whose body measures the position of one foot from the other (body/gait/measuring.py); two tracks that are
    only assumed to lie beside one another do not give it."""
    step_width: float | None
    """Distance of the other foot from the line of this stride, m (Huxham et al. 2006); negative when the feet cross."""
    clearance: float | None
    """Highest rise of the sensor above the higher of both foot-flats, m. It is not the minimum toe clearance, which a
    sensor on the instep does not see (Mariani et al. 2012, IEEE Trans. Biomed. Eng. 59, need the shoe's size)."""
    toe_off_angle: float | None
    """Pitch of the foot at toe-off against flat, rad; positive when the heel is up."""
    heel_strike_angle: float | None
    """Angle by which the toe is up at the contact that ends the cycle, rad; negative for a forefoot landing."""
    turning_angle: float | None
    """Turn of the foot about the vertical over the stride, rad, counter-clockwise positive (Mariani et al. 2010)."""
    rise: float | None
    """Height of the foot after the stride above its height before, m."""
    degraded: bool
    """True when samples were missing or saturated within the cycle, or one of its events is inferred."""
    steady: bool
    """True when the cycle counts in the running means, if another stride follows."""

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
        """Sum of initial and terminal double support, s; negative for a runner."""
        if self.initial_double_support is None or self.terminal_double_support is None:
            return None
        return self.initial_double_support + self.terminal_double_support

    @property
    def double_support_share(self) -> float | None:
        """Double support as a share of the cycle."""
        both = self.double_support
        return None if both is None else both / self.stride_time

    @property
    def single_support_share(self) -> float | None:
        """Single support as a share of the cycle."""
        return None if self.single_support is None else self.single_support / self.stride_time

    @property
    def running(self) -> bool:
        """True if the foot was on the ground for less than half of the cycle, as in no walk (Novacheck 1998)."""
        return self.stance_time < 0.5 * self.stride_time
