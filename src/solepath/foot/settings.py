"""Settings of the parts of a foot, which a recipe, a calibration or a researcher chooses.

A number that nobody chooses is a constant in the module that uses it.

Numbers of `CycleSettings` and `ErrorStateSettings` without a source were chosen by hand on the recordings of
docs/accuracy.md; `solepath-lab sensitivity` prints the effect of half and of twice each. The origin of those of
`InsoleSettings` and `DedriftSettings` is not recorded."""

from __future__ import annotations

from ..calibration import HeadingCalibration, InsoleCalibration, Newtons
from ..types import Floats, Layout
from ..types.attrs import evolve, frozen


@frozen
class InsoleSettings:
    """The settings of `InsoleLoads`."""

    heel_end: float = 0.33
    """Front end of the heel area, measured from the heel, as a share of the length of the insole, 0 to 1."""
    forefoot_start: float = 0.55
    """Rear end of the forefoot area, measured from the heel, as a share of the length of the insole, 0 to 1."""
    newtons: Newtons | None = None
    """Conversion of raw cell values to N; None leaves the values in the unit of the samples."""
    noise: Floats = ()
    """Value of each unloaded cell, to be subtracted: N with `newtons`, otherwise in the unit of the samples.

    It is not used for an insole with another number of cells."""

    def calibrated(self, insole: InsoleCalibration) -> InsoleSettings:
        """Return the settings for an insole that was calibrated."""
        return evolve(self, newtons=insole.newtons or self.newtons, noise=insole.noise or self.noise)


@frozen
class FootSettings:
    """The settings of one foot in a session."""

    poses: bool = False
    """Emit FootMoved for every navigated sample."""
    needs_pressure: bool = False
    """The recipe needs pressure cells.

    A foot without cells then reports nothing, and an unknown layout of the cells is learnt."""
    every_stride: bool = False
    """Report the strides of a foot that carries nobody, too (bearing.py), as the published systems do."""
    heading: HeadingCalibration | None = None
    """Drift of the heading that is removed at the end of every stride; None when it was not calibrated."""
    insole: InsoleSettings = InsoleSettings()
    layout: Layout | None = None
    """Layout of the cells by the calibration; it is used if samples have as many cells."""


@frozen
class CycleSettings:
    """The settings of `Cycle`."""

    threshold_position: float = 0.45
    """Position of the stance threshold between the lowest (0) and the highest (1) statistic, on a logarithmic scale."""
    least_threshold: float = 2e4
    """Smallest stance threshold, no unit: a standing foot shows statistics up to this."""
    least_statistic: float = 3e3
    """Smallest statistic that enters the threshold, no unit: a stance of walking is less still than standing."""
    standing_statistic: float = 2e3
    """Statistic below which the foot stands for certain, no unit, whatever velocity the corrector estimates."""
    sigma: float = 0.01
    """Standard deviation of the velocity of a foot that shows no motion, m/s."""
    noise_per_rate_square: float = 0.5
    """Standard deviation of the velocity for each (rad/s)^2, m s: a foot that turns fast rolls unevenly."""
    noise_per_acceleration: float = 0.05
    """Standard deviation of the velocity for each m/s^2 by which the specific force differs from gravity, s."""
    noise_per_acceleration_square: float = 0.02
    """Standard deviation of the velocity for each (m/s^2)^2 of that difference, s^3/m.

    It grows steeply because a foot that brakes before it lands may turn as little as one in stance."""
    span_duration: float = 0.4
    """Duration of each of the four spans over which the extremes of the statistic are kept, s.

    Together they cover one stride of any walker who is not slow."""
    rolls: bool = True
    """The reference velocity is that of a foot that rolls (`sensor_height`); if False, it is zero."""


@frozen
class ShoeSettings:
    """The settings of `ShoeDetector`."""

    rest_statistic: float = 1e4
    """Statistic up to which the foot is certainly at rest, no unit."""
    motion_statistic: float = 3.5e5
    """Statistic from which on the foot is not at rest, so that there is no evidence, no unit."""
    sigma: float = 0.01
    """Standard deviation of the zero velocity of a foot at rest, m/s."""
    window: float = 0.025
    """Duration of the window that ends with the current sample, s."""


@frozen
class ErrorStateSettings:
    """The settings of `ErrorStateFilter`."""

    acc_noise: float = 0.02
    """Noise density of the accelerometer with its scale and g-sensitivity errors, m/s^2/sqrt(Hz)."""
    gyro_noise: float = 0.003
    """Noise density of the gyroscope, rad/s/sqrt(Hz)."""
    noise_per_motion: float = 0.001
    """Noise density for each unit of acceleration or rate, 1/sqrt(Hz): scale and alignment errors."""
    noise_per_difference: float = 0.25
    """Noise of each acceleration and angular rate, as a share of the difference between neighbouring samples, 0 to 1.

    It stands for the motion between them, which is taken as a straight line. It is small at 400 Hz, unless the readings
    show that the band of the sensor is narrow (IndependentInterval). At 20 Hz, where a heel-strike falls between two
    samples, it is the largest term."""
    recover: bool = True
    """Add the turn that a clipped gyroscope did not show (clipping.py)."""
    clipping_rate: float = 8.5
    """Angular rate above which a gyroscope may clip although its readings do not stay at one value, rad/s.

    A calibration may have rotated the axes, so that the readings no longer stay at one value."""
    clipping_noise: float = 0.2
    """Additional noise density of an angular rate above `clipping_rate`, rad/s/sqrt(Hz)."""
    innovation_gate: float = 12.0
    """Largest squared innovation, weighted by its covariance, at which evidence is still used; no unit.

    It is the 99.3 % point of chi-square with three degrees of freedom."""
    stance_share: float = 0.5
    """Share of the wearer's usual stance for which gated evidence must last until the foot stands for certain.

    From 0.35 to 0.6 `openshoe_loops` has the same strides."""
    time_until_ungated: float = 0.35
    """Longest duration of unbroken evidence that the innovation gate rejects, s, whatever the usual stance."""
    level: bool = True
    """Remove height errors of level walking (level.py)."""


@frozen
class DedriftSettings:
    """The settings of `LinearDedrift`."""

    largest_stance_sigma: float = 0.05
    """Largest standard deviation of evidence that counts as stance, m/s."""
    tilt_rate: float = 2.0
    """Inverse time constant with which gravity corrects the tilt in stance, 1/s."""
    path_error: float = 0.01
    """Standard deviation of the position at the end of a stretch, as a share of the length of its path."""
    turn_drift: float = 0.002
    """Growth of the standard deviation of the heading, rad/sqrt(s)."""
