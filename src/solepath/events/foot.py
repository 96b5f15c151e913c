"""Events of one foot: gait events, which start its phases, and strides."""

from __future__ import annotations

from enum import Enum

from ..types import Foot, Vec2, Vec3
from ..types.attrs import field, frozen
from .happening import BaseEvent


@frozen(kw_only=True)
class GaitEvent(BaseEvent):
    """The fields of HeelStrike, FootFlat, HeelOff and ToeOff; only these are reported."""

    foot: Foot
    """Foot of the event."""
    inferred: bool = False
    """True when the event lies in a gap, so that its time comes from the stride template and not from samples."""
    sampled_at: float = field()
    """Time of the last sample that the event needed, s, by default `t`: `known_at` is the arrival of that sample."""

    @sampled_at.default
    def _with_it(self) -> float:
        return self.t


@frozen(kw_only=True)
class HeelStrike(GaitEvent):
    """The foot touched the ground; LOADING starts. `t` is the onset of the impact, or the time when cells show load.

    Latency with the default cues: one sample with pressure cells, about 50 ms without; if no impact shows, the time
    until the foot is still. `Session(impacts=True)` also reports an impact without cells at once, 10 to 20 ms after
    `t`, in an event that is not final. The final one follows within 0.1 s and names it in `revises`; its `t` is up to
    60 ms later, or some ms earlier. None follows where samples are missing or the device's clock restarts."""

    revises: float | None = None
    """Time `t` of the event that this event replaces, s; None when it replaces none."""


@frozen(kw_only=True)
class FootFlat(GaitEvent):
    """The whole sole is on the ground and still; STATIONARY starts, and a stride may end. Latency: about 40 ms."""


@frozen(kw_only=True)
class HeelOff(GaitEvent):
    """The heel left the ground; PUSH_OFF starts.

    The heel lifts slowly, so `t` is earlier than the sample that shows it. Latency: 40 to 140 ms, in slow walking up to
    320 ms."""


@frozen(kw_only=True)
class ToeOff(GaitEvent):
    """The toe left the ground; SWING starts. Latency: one sample, after the first push-off of this foot."""


@frozen
class StrideFeatures:
    """Measurements of one stride; a field that the sensors cannot measure is None.

    Both angles are about the axis to the wearer's left, which is known after the foot's first push-off."""

    clearance: float
    """Highest rise of the sensor above the higher end of the stride, m."""
    peak_speed: float
    """Largest speed of the sensor, m/s."""
    swing_pitch: float
    """Range of the pitch angle over the stride, rad."""
    contact_load: float | None = None
    """Mean load from foot-flat to toe-off, in the unit of the samples (N if a calibration converts counts to N)."""
    cop: tuple[Vec2, ...] = ()
    """Path (x, y) of the centre of pressure from foot-flat to toe-off, foot frame, m, at most 32 points at equal
    intervals of samples."""
    error_index: float | None = None
    """Difference of the integrated velocity from the known velocity at toe-off and heel-strike, m/s (Chen et al. 2019,
    equation (10)); None if the velocity of the rolling shoe was not used."""
    toe_off_angle: float | None = None
    """Pitch at toe-off relative to the flat sole at mid-stance before it, rad, positive when the heel is up."""
    heel_strike_angle: float | None = None
    """Pitch at heel-strike relative to the flat sole after it, rad, positive when the toe is up.

    Mid-stance is still to come, so earlier stances show how far the sensor turns from foot-flat to mid-stance; the
    angle is None in the first stride."""
    longest_rest: float = 0.0
    """Longest time in which the foot turned slower than 0.3 rad/s, or than 15 % of its peak rate, s."""
    rest_force: float | None = None
    """Root mean square of the specific force in that time, m/s^2; None when the foot did not rest."""
    peak_rate: float = 0.0
    """Largest angular rate of the stride and of the one before, rad/s."""
    force_range: float = 0.0
    """Largest minus smallest specific force of the stride, m/s^2."""
    rise: float | None = None
    """Height of the stride's end above its start, m, as integrated, before a level stride's height is set to 0."""
    tilt: float = 0.0
    """Angle by which the foot lies tilted at the end against the start, rad, whatever its heading."""


LONGEST_HARMLESS_GAP = 0.06
"""Longest gap that is no flaw at any rate, s: shorter ones cost a centimetre of a length (`solepath-lab damage
losses`)."""
HARMLESS_INTERVALS = 3.5
"""Longest gap that is no flaw at a low rate, in intervals: with up to two lost samples. At 25 Hz lengths err by
0.115 m without a loss and by 0.141 m with one lost sample (pyshoe_vicon, every eighth sample); two were rare."""


def is_harmless(gap: float, interval: float) -> bool:
    """Return whether a gap of samples that come every `interval` s is no flaw; both in s."""
    return gap <= max(LONGEST_HARMLESS_GAP, HARMLESS_INTERVALS * interval)


class Flaw(Enum):
    """What makes a stride wrong."""

    GAP = "gap"
    """Samples are missing for too long (`is_harmless`), so that the motion had to be guessed."""
    RANGE = "range"
    """Values are at the end of the sensor's range, so that peaks are cut off."""
    TWO_STRIDES = "two strides"
    """It is two strides, because no stance was found between them, or longer than a stride can be."""
    IMPOSSIBLE = "impossible"
    """It has a speed, length, height or angle that no person has."""
    DEFECT = "defect"
    """A defect of the data spoils it (DefectFound)."""


@frozen(kw_only=True)
class StrideTaken(BaseEvent):
    """One stride: a foot went from a foot-flat to its next foot-flat.

    `t` is the second foot-flat. The stride is known with that FootFlat once the foot is known to carry its walker.
    The first stride of a bout is known with the second one, after at most four strides or 5 s (foot/bearing.py). What
    a foot does on a pedal, in a vehicle or below a chair is no stride. Vectors are in the world frame, m. The first
    stride after the foot stood starts at the foot-flat before the standing, and so contains it: `t_end` - `t_start`
    is then no stride time. GaitCycleMeasured, from contact to contact, contains no standing of the start."""

    foot: Foot
    """Foot that took the stride."""
    number: int
    """Number of the stride; 1 for the first stride of this foot. It goes on after a change of clock or device."""
    t_start: float
    """Foot-flat at which the stride started, s."""
    t_end: float
    """Foot-flat that ended the stride, s; the same as `t`."""
    displacement: Vec3
    """Vector from the first to the second foot-flat, m."""
    position: Vec3
    """Position of the foot after the stride, m. This stride started at `position` - `displacement`. That may differ
    from the end of the previous stride, because a body part that corrects the feet (BothFeet) moves their tracks."""
    length: float
    """Horizontal length of `displacement`, m."""
    heading_change: float
    """Turn of the foot about the vertical between the two foot-flats, rad, counter-clockwise positive, in (-pi, pi]."""
    height_change: float
    """Vertical component of `displacement`, m, positive upwards."""
    covariance: tuple[float, float, float, float, float, float]
    """Covariance of `displacement`, m^2: the upper triangle of the matrix, row by row: xx, xy, xz, yy, yz, zz.

    It counts from the heel-off of the stride, because a foot that stands does not move."""
    t_toe_off: float | None = None
    """Time of this foot's toe-off within the stride, s; None when none was detected."""
    t_heel_strike: float | None = None
    """Time of this foot's heel-strike within the stride, s; None when none was detected."""
    missing: float = 0.0
    """Share of the stride's samples that are missing, 0 to 1."""
    longest_gap: float = 0.0
    """Time from one sample to the next in the longest gap of the stride, s; 0 without a gap."""
    length_sigma: float = 0.0
    """Standard deviation of `length`, m, with what its gaps and the correction of its start add.

    Without gaps it is 0 where the recipe's corrector keeps no covariance."""
    flaws: tuple[Flaw, ...] = ()
    """What makes the stride wrong rather than less sure. A gap that is bridged well, as most lost packets, is none.
    `degraded` is whether there are any."""
    features: StrideFeatures
    """Further measurements of the stride."""

    @property
    def degraded(self) -> bool:
        """True when there are flaws."""
        return bool(self.flaws)
