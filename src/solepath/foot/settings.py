"""Settings of the parts of a foot, which a recipe, a calibration or a researcher chooses.

A number that nobody chooses is a constant in the module that uses it."""

from __future__ import annotations

from ..calibration import Newtons
from ..types.attrs import frozen


@frozen
class FootSettings:
    """The settings of one foot in a session."""

    poses: bool = False
    """Emit FootMoved for every navigated sample."""
    needs_pressure: bool = False
    """The recipe needs pressure cells. A foot without cells reports nothing. If the layout of the cells is unknown, it
    is learnt."""


@frozen
class CycleSettings:
    """The settings of `Cycle`."""

    share: float = 0.45
    """Position of the threshold between the logarithms of the lowest and the highest statistic, 0 to 1."""
    floor: float = 2e4
    """Lower limit of the threshold: a statistic that a standing foot shows."""
    least_statistic: float = 3e3
    """Lower limit of a statistic. After standing, the next stance is not as still as standing was."""
    ceiling: float = 6e6
    """Upper limit of the threshold: a statistic that a runner's stance reaches."""
    certain: float = 2e3
    """Statistic below which the foot is still, whatever the corrector estimates."""
    sigma: float = 0.01
    """Noise of the velocity of a foot that does not move at all, m/s."""
    arm: float = 0.05
    """Velocity noise for each rad/s, m: initial uncertainty of the sensor height."""
    arm2: float = 0.5
    """Velocity noise for each (rad/s)^2, m s: noise of the rolling foot."""
    off_gravity: float = 0.05
    """Velocity noise for each m/s^2 of difference from gravity, s."""
    off_gravity2: float = 0.02
    """Velocity noise for each (m/s^2)^2 of difference from gravity, s^3/m. A foot that brakes before it lands may no
    longer turn."""
    span_duration: float = 0.4
    """Duration of one of the four spans over which the extremes are kept, s. Together the spans cover one stride of any
    walker except a slow one."""
    rolls: bool = True
    """The reference velocity is that of a foot that rolls (`sensor_height`); if False, it is zero."""


@frozen(kw_only=True)
class StanceThreshold:
    """The settings of a detector with a fixed threshold, in the unit of its own statistic.

    Each detector needs its own values."""

    rest_statistic: float
    """Statistic up to which the foot is certainly at rest."""
    motion_statistic: float
    """Statistic from which on the foot is not at rest."""
    sigma: float = 0.01
    """Noise of the zero velocity of a foot at rest, m/s."""


@frozen(kw_only=True)
class WindowThreshold(StanceThreshold):
    """The settings of `ShoeDetector`, `AngularRate` and `MovingVariance`."""

    window: float
    """Duration of the window that ends with the current sample, s."""


@frozen(kw_only=True)
class CountThreshold(StanceThreshold):
    """The settings of `Graph`."""

    count: int
    """Number of samples in the window."""


@frozen
class ErrorStateSettings:
    """The settings of `ErrorStateFilter`."""

    acc_noise: float = 0.02
    """Accelerometer noise, which includes scale and g-sensitivity errors, m/s^2/sqrt(Hz)."""
    gyro_noise: float = 0.003
    """Gyroscope noise, rad/s/sqrt(Hz)."""
    in_motion: float = 0.001
    """Additional noise as a share of the motion, for scale and alignment errors, 1/sqrt(Hz)."""
    between: float = 0.25
    """Noise as a share of the difference between two neighbouring samples. It covers what a straight line between them
    cannot know. It is small at 400 Hz; at 20 Hz, where a heel-strike falls between two samples, it is the largest
    term."""
    recover: bool = True
    """Add the turn that a clipped gyroscope did not show (clipping.py, reintegration.py)."""
    suspect: float = 8.5
    """Rate above which clipping is possible although no end of a range is seen, rad/s. A calibration may have rotated
    the axes since."""
    suspect_noise: float = 0.2
    """Noise of a rate that may be clipped, rad/s/sqrt(Hz)."""
    innovation_gate: float = 12.0
    """Innovation gate: 99.3 % of chi-square with three degrees of freedom are below."""
    patience: float = 2.0
    """Time without accepted evidence after which the filter is lost, s."""
    lasting: float = 0.35
    """Duration of unbroken evidence after which it is no longer gated, s."""
    tilt_rate: float = 2.0
    """Rate at which gravity corrects the tilt while the evidence is certain, 1/s."""
    level: bool = True
    """Remove height errors of level walking (level.py)."""


@frozen
class InsoleSettings:
    """The settings of `InsoleLoads`."""

    heel_end: float = 0.33
    """Front end of the heel area, as a share of the length of the insole."""
    forefoot_start: float = 0.55
    """Rear end of the forefoot area, as a share of the length of the insole."""
    newtons: Newtons | None = None
    """Conversion of raw values to N; None leaves them in the unit of the samples."""
    noise: tuple[float, ...] = ()
    """Noise of each cell in the air, in the unit of the samples, or N with `newtons`. It is not used on another number
    of cells."""


@frozen
class DedriftSettings:
    """The settings of `LinearDedrift`."""

    trusted: float = 0.05
    """Largest sigma of evidence that counts as stance, m/s."""
    tilt_rate: float = 2.0
    """Rate at which gravity corrects the tilt in stance, 1/s."""
    share: float = 0.01
    """Standard deviation of a stretch as a share of its length."""
    turn_drift: float = 0.002
    """Growth of the heading error, rad/sqrt(s)."""
