"""What the parts of a foot are set to: what a recipe, a calibration or a researcher chooses. A number that nobody
chooses is a constant beside what it is for."""

from __future__ import annotations

from ..calibration import Newtons
from ..types.attrs import frozen


@frozen
class FootSettings:
    """Of one foot in a session."""

    poses: bool = False
    """Emit FootMoved for every navigated sample."""
    needs_pressure: bool = False
    """Without pressure cells nothing is said of this foot; where nobody says where they are, it is learnt."""


@frozen
class CycleSettings:
    """Of `Cycle`."""

    share: float = 0.45
    """Where the threshold lies between the log of the lowest and of the highest statistic, 0 to 1."""
    floor: float = 2e4
    """The threshold is never below this statistic, which a standing foot shows."""
    least_statistic: float = 3e3
    """A lower statistic counts as this one: after standing, the next stance is not as still as standing was."""
    ceiling: float = 6e6
    """The threshold is never above this statistic, which a runner's stance comes to."""
    certain: float = 2e3
    """Below this statistic the foot is still whatever the corrector believes."""
    sigma: float = 0.01
    """Noise of a foot that does not move at all, m/s."""
    arm: float = 0.05
    """Velocity noise for each rad/s, m: how well the height of the sensor is known at first."""
    arm2: float = 0.5
    """Velocity noise for each (rad/s)^2, m s: the rolling foot."""
    off_gravity: float = 0.05
    """Velocity noise for each m/s^2 off gravity, s."""
    off_gravity2: float = 0.02
    """Velocity noise for each (m/s^2)^2 off gravity, s^3/m: a foot that is braked before it lands may turn no more."""
    span_duration: float = 0.4
    """Length of one of the four spans over which the extremes are kept, s; together they are a stride of any walker but
    a slow one."""
    rolls: bool = True
    """The velocity that the sensor ought to have is that of a foot that rolls (`sensor_height`); otherwise zero."""


@frozen(kw_only=True)
class StanceThreshold:
    """Of a detector with a fixed threshold, in the unit of its own statistic: no two can do with the same."""

    base: float
    """The statistic up to which the foot is at rest for certain."""
    gate: float
    """The statistic from which on it is not."""
    sigma: float = 0.01
    """Noise of the zero velocity of a foot at rest, m/s."""


@frozen(kw_only=True)
class WindowThreshold(StanceThreshold):
    """Of `ShoeDetector`, `AngularRate` and `MovingVariance`."""

    window: float
    """How far back it looks, s."""


@frozen(kw_only=True)
class CountThreshold(StanceThreshold):
    """Of `Graph`."""

    count: int
    """So many samples it looks back over."""


@frozen
class ErrorStateSettings:
    """Of `ErrorStateFilter`."""

    acc_noise: float = 0.02
    """Accelerometer noise with all that stands for it (scale, g-sensitivity), m/s^2/sqrt(Hz)."""
    gyro_noise: float = 0.003
    """Gyroscope noise, rad/s/sqrt(Hz)."""
    in_motion: float = 0.001
    """Added noise as a share of the motion: scale and alignment errors, 1/sqrt(Hz)."""
    between: float = 0.25
    """What two neighbouring samples differ by and the straight line between them cannot know, as a share of it. Small
    at 400 Hz; at 20 Hz, where a heel-strike falls between two samples, all that there is."""
    recover: bool = True
    """Make up for the turn that a gyroscope at the end of its range missed (clipping.py, reintegration.py)."""
    suspect: float = 8.5
    """Rates beyond this may be clipped though no end of a range is seen (axes that were turned since, by a
    calibration), rad/s."""
    suspect_noise: float = 0.2
    """Noise of such a rate, rad/s/sqrt(Hz)."""
    innovation_gate: float = 12.0
    """Largest normalised innovation squared: of chi-square with three degrees of freedom, 99.3 % are below."""
    patience: float = 2.0
    """After refusing everything for this long the filter is lost, s."""
    lasting: float = 0.35
    """Evidence that goes on for this long is not refused any longer, s."""
    tilt_rate: float = 2.0
    """How fast gravity pulls the tilt upright while the evidence is certain, 1/s."""
    level: bool = True
    """Keep level walking level (level.py)."""


@frozen
class InsoleSettings:
    """Of `InsoleLoads`."""

    heel_end: float = 0.33
    """Cells behind this share of the insole's length are the heel's area."""
    forefoot_start: float = 0.55
    """Cells in front of this share are the forefoot's area."""
    newtons: Newtons | None = None
    noise: tuple[float, ...] = ()
    """Of each cell, in the unit of the samples, or N with `newtons`; not used on another number of cells."""


@frozen
class DedriftSettings:
    """Of `LinearDedrift`."""

    trusted: float = 0.05
    """Evidence with a sigma above this is no stance, m/s."""
    tilt_rate: float = 2.0
    """How fast stance pulls the tilt towards gravity, 1/s."""
    share: float = 0.01
    """What a stretch is wrong by, as a share of its length."""
    turn_drift: float = 0.002
    """Growth of the heading error, rad/sqrt(s)."""
