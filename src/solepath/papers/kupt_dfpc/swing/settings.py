"""Settings of the correctors of KUPT, and those with which equation (8) is applied as printed."""

from __future__ import annotations

from ....foot.settings import DedriftSettings
from ....types.attrs import frozen

LARGEST_ROLLING_ERROR = 0.6
"""Horizontal difference of rolling and raw velocity in push-off above which the rolling velocity is not used, m/s.

In 0.3 s a tilt error of 2 degrees and an accelerometer error of 20 mg cause an error of 0.16 m/s. A rolling velocity
has an error of 0.1 m/s. Three times their combination is 0.57. The difference is up to 0.05 for emulated feet, up to
0.5 for recorded feet that roll, and 0.7 to 1.3 for recorded insoles whose cells release the load late."""


@frozen
class SwingSettings(DedriftSettings):
    """Settings of `SwingDedrift`."""

    slide_time: float = 0.02
    """Time after heel-strike in which the heel still slides, s; 0 in the paper."""
    largest_rolling_error: float = LARGEST_ROLLING_ERROR
    """Largest difference of rolling and raw velocity in push-off that is used, m/s; there is no limit in the paper."""
    vertical: bool = False
    """Flag: the known velocity is used for heights too, because (5) and (7) have V^z and (8) has no axis of its own.

    `SoftSwing` does not read it."""


@frozen
class SoftSwingSettings(SwingSettings):
    """Settings of `SoftSwing`."""

    bias_share: float = 0.8
    """Share of the difference from 1 g at rest that is taken for an upward bias of the accelerometer.

    The remainder is an error of its scale. Typical zero-g offsets in data sheets (LSM6DSOX, MPU-9250, MPU-6050) are
    twice as large as 1 g times the tolerance of the scale; so four fifths of the variance of that difference are
    offset."""
    uses_rolling: bool = True
    """Flag: the velocities of the rolling shoe correct the track; if False, they only give the error index (10)."""
    learns_rolling: bool = True
    """Flag: pivot and slide are learnt; if False, their starting values stay."""
    learns_time: bool = True
    """Flag: the time of the drift in swing is learnt; if False, the drift is linear."""


NO_LIMIT = 1e3
"""Velocity that no foot has, m/s."""

PRINTED = SwingSettings(slide_time=0.0, largest_rolling_error=NO_LIMIT, vertical=True)
"""Settings with which equation (8) is applied as printed."""
