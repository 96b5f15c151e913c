"""What one foot did: phases and steps."""

from __future__ import annotations

from ..types import Foot, Vec3
from ..types.attrs import frozen
from .happening import Happening


@frozen(kw_only=True)
class _Phase(Happening):
    foot: Foot
    inferred: bool = False
    """True when no sample was there to see it: it is what this foot does as a rule, dated within a gap."""


@frozen(kw_only=True)
class HeelStrike(_Phase):
    """The foot touched the ground; LOADING begins. `t` is the middle of the impact, or when cells feel load.

    Latency with the default cues: one sample with pressure cells, some 40 ms without; until the foot is still where no
    impact shows.
    """


@frozen(kw_only=True)
class FootFlat(_Phase):
    """The whole sole is on the ground and still; STATIONARY begins and a step may end. Latency: about 40 ms."""


@frozen(kw_only=True)
class HeelOff(_Phase):
    """The heel lifted; PUSH_OFF begins. It comes off slowly and is dated back.

    Latency: 40 to 140 ms, in slow walking up to 320 ms.
    """


@frozen(kw_only=True)
class ToeOff(_Phase):
    """The toe left the ground; SWING begins. Latency: one sample, once this foot has pushed off the first time."""


@frozen
class StrideFeatures:
    """What was measured along one step, for whoever compares steps; None where the sensors could not tell.

    `clearance`: highest rise of the sensor above the higher end of the step, m. `peak_speed`: m/s. `swing_pitch`:
    range of the pitch angle over the step, rad. `contact_load`: mean load from foot-flat to toe-off, in the unit of the
    samples. `cop`: centre-of-pressure path (x, y) in the foot frame over the same time, m, at most 32
    points evenly spaced in samples. `error_index`: by how much the integrated velocity missed the known one at toe-off
    and heel-strike, m/s (Chen et al. 2019, equation (10)); None where the velocity of the rolling shoe was not used.
    `toe_off_angle`: how far the heel is up at toe-off, against the sole lying flat before, rad; `heel_strike_angle`:
    how far the toe is up at heel-strike, against the sole lying flat after it, rad. Both are about the axis to the
    wearer's left, which a foot shows by its first push-off. `rise`: the height of the step as integration has it,
    before it is judged whether the step was level, m.
    """

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

    `t` is the second foot-flat. Vectors are in the world frame (z up, x along the first heading, y left), m.
    """

    foot: Foot
    number: int
    """1 for the first step of this foot, and so on."""
    t_start: float
    """The foot-flat at which the step began, s."""
    t_end: float
    """The foot-flat that ended it, s; the same as `t`."""
    displacement: Vec3
    """From the first to the second foot-flat, m."""
    position: Vec3
    """Where the foot stands after the step, m. A body that hands corrections back to the feet (BothFeet) moves a track
    between two steps: where this step began is `position` - `displacement`, and not always where the last one ended."""
    length: float
    """Horizontal length of `displacement`, m."""
    heading_change: float
    """Turn of the foot about the vertical between the two foot-flats, rad, counter-clockwise positive, in (-pi, pi]."""
    height_change: float
    """Vertical part of `displacement`, m."""
    covariance: tuple[float, float, float, float, float, float]
    """Of `displacement`: xx, xy, xz, yy, yz, zz in m^2."""
    t_toe_off: float | None = None
    """Of this foot within it, s; None where none was seen."""
    t_heel_strike: float | None = None
    """Likewise, s."""
    degraded: bool = False
    """True when samples were missing or saturated within the step."""
    features: StrideFeatures
