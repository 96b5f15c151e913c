"""Events of one foot: phases and strides."""

from __future__ import annotations

from ..types import Foot, Vec3
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class _Phase(Happening):
    foot: Foot
    """Foot of the event."""
    inferred: bool = False
    """True when no sample showed the event: it follows from this foot's usual stride, dated within a gap."""


@frozen(kw_only=True)
class HeelStrike(_Phase):
    """The foot touched the ground; LOADING starts. `t` is the middle of the impact, or when cells show load.

    Latency with the default cues: one sample with pressure cells, some 40 ms without; until the foot is still where no
    impact shows."""


@frozen(kw_only=True)
class FootFlat(_Phase):
    """The whole sole is on the ground and still; STATIONARY starts and a stride may end. Latency: about 40 ms."""


@frozen(kw_only=True)
class HeelOff(_Phase):
    """The heel lifted; PUSH_OFF starts. The heel lifts slowly, so the event is dated back.

    Latency: 40 to 140 ms, in slow walking up to 320 ms."""


@frozen(kw_only=True)
class ToeOff(_Phase):
    """The toe left the ground; SWING starts. Latency: one sample, once this foot has pushed off the first time."""


@frozen
class StrideFeatures:
    """Measurements along one stride, for comparing strides; None where the sensors cannot measure one.

    `clearance`: highest rise of the sensor above the higher end of the stride, m. `peak_speed`: m/s. `swing_pitch`:
    range of the pitch angle over the stride, rad. `contact_load`: mean load from foot-flat to toe-off, in the unit of
    the samples. `cop`: centre-of-pressure path (x, y) in the foot frame over the same time, m, at most 32 points evenly
    spaced in samples. `error_index`: difference of the integrated velocity from the known one at toe-off and
    heel-strike, m/s (Chen et al. 2019, equation (10)); None where the velocity of the rolling shoe was not used.
    `toe_off_angle`: angle by which the heel is up at toe-off, against the sole lying flat before, rad;
    `heel_strike_angle`: angle by which the toe is up at heel-strike, against the sole lying flat after it, rad. Both
    are about the axis to the wearer's left, which a foot shows by its first push-off. `rise`: height of the stride as
    integrated, before the decision whether the stride was level, m."""

    clearance: float
    peak_speed: float
    swing_pitch: float
    contact_load: float | None = None
    cop: tuple[tuple[float, float], ...] = ()
    error_index: float | None = None
    toe_off_angle: float | None = None
    heel_strike_angle: float | None = None
    rise: float | None = None


@frozen(kw_only=True)
class StrideTaken(Happening):
    """One foot went from foot-flat to its next foot-flat (clinically: a stride). Known at the second foot-flat.

    `t` is the second foot-flat. Vectors are in the world frame (z up, x along the first heading, y left), m."""

    foot: Foot
    """Foot that took the stride."""
    number: int
    """Number of the stride; 1 for the first stride of this foot."""
    t_start: float
    """Foot-flat at which the stride started, s."""
    t_end: float
    """Foot-flat that ended the stride, s; the same as `t`."""
    displacement: Vec3
    """Vector from the first to the second foot-flat, m."""
    position: Vec3
    """Position of the foot after the stride, m. A body that returns corrections to the feet (BothFeet) moves a track
    between two strides: this stride started at `position` - `displacement`, which is not always where the last one
    ended."""
    length: float
    """Horizontal length of `displacement`, m."""
    heading_change: float
    """Turn of the foot about the vertical between the two foot-flats, rad, counter-clockwise positive, in (-pi, pi]."""
    height_change: float
    """Vertical part of `displacement`, m."""
    covariance: tuple[float, float, float, float, float, float]
    """Covariance of `displacement`: xx, xy, xz, yy, yz, zz in m^2."""
    t_toe_off: float | None = None
    """Toe-off of this foot within the stride, s; None where none was found."""
    t_heel_strike: float | None = None
    """Heel-strike of this foot within the stride, s; None where none was found."""
    degraded: bool = False
    """True when samples were missing or saturated within the stride."""
    features: StrideFeatures
    """Measurements along the stride."""
