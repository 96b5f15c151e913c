"""State of the integration at one sample of a motion, and the settings of the correctors that keep such states."""

from __future__ import annotations

from ...foot.settings import DedriftSettings
from ...types import Vec3
from ...types.attrs import frozen

LARGEST_ROLLING_ERROR = 0.6
"""Horizontal difference of rolling and raw velocity in push-off above which the rolling velocity is not used, m/s.

In 0.3 s a tilt error of 2 degrees and an accelerometer error of 20 mg cause an error of 0.16 m/s. A rolling velocity
has an error of 0.1 m/s. Three times their combination is 0.57. The difference is up to 0.05 for emulated feet, up to
0.5 for recorded feet that roll, and 0.7 to 1.3 for recorded insoles whose cells release the load late."""


@frozen
class MotionMoment:
    """The state of the integration at one sample of a motion, navigation frame."""

    elapsed: float
    """Time since motion start, s."""
    velocity: Vec3
    """Raw velocity, m/s."""
    raw_displacement: Vec3
    """Integral of the raw velocity, m."""
    known_displacement: Vec3
    """Integral of the known velocities, m."""
    error: Vec3 | None
    """Mean raw velocity minus known velocity over the interval that ended here, m/s; None when unknown."""
    drift: float = 0.0
    """Sum since motion start of the squared changes of specific force between samples times time, m^2/s^2."""
    drift_moment: float = 0.0
    """Sum of the same terms, each times its time since motion start, m^2/s."""
    cos_pitch: float = 1.0
    """Cosine of the tilt of the sensor since motion start."""
    lift_rate: float = 0.0
    """Rate at which `cos_pitch` fell in the interval that ended here, 1/s."""
    rise_error: float = 0.0
    """Rise by the raw velocity minus that by the rolling shoe in push-off, m."""


@frozen
class SwingSettings(DedriftSettings):
    """Settings of `SwingDedrift` and `SoftSwing`."""

    slide_time: float = 0.02
    """Time after heel-strike in which the heel still slides, s; 0 in the paper."""
    largest_rolling_error: float = LARGEST_ROLLING_ERROR
    """Largest difference of rolling and raw velocity in push-off that is used, m/s; there is no limit in the paper."""
    vertical: bool = False
    """Flag: the known velocity is used for heights too, because (5) and (7) have V^z and (8) has no axis of its own;
    only `SwingDedrift` has it."""
    bias_share: float = 0.8
    """Share of the difference from 1 g at rest that `SoftSwing` takes for an upward bias of the accelerometer, not for
    an error of its scale.

    Typical zero-g offsets in data sheets (LSM6DSOX, MPU-9250, MPU-6050) are twice as large as 1 g times the tolerance
    of the scale; so four fifths of the variance of that difference are offset."""
    uses_rolling: bool = True
    """Flag: `SoftSwing` uses the velocities of the rolling shoe."""
    learns_rolling: bool = True
    """Flag: `SoftSwing` learns pivot and slide; if False, their starting values stay."""
    learns_time: bool = True
    """Flag: `SoftSwing` learns the time of the drift in swing; if False, the drift is linear."""


NO_LIMIT = 1e3
"""Velocity that no foot has, m/s."""

PRINTED = SwingSettings(slide_time=0.0, largest_rolling_error=NO_LIMIT, vertical=True)
"""Settings with which equation (8) is applied as printed."""
