"""Interface of a corrector: navigation of one foot that uses stance evidence."""

from __future__ import annotations

from typing import Protocol, Self

from ...calibration import Calibration
from ...types import Floats, Foot, Quat, Vec3
from ...types.vector import ZERO
from ..phase import Cue
from ..stance.stance import Stance

LONGEST_BRIDGE = 0.25
"""Longest gap that is integrated over, with the rate and force around it, s; in a longer one a foot may turn back."""
LONGEST_FILLED_GAP = 1.5
"""Longest gap that is filled (gap.py), s; a longer one may hide several strides."""


class Corrector(Protocol):
    """The interface of a corrector, which keeps the integration of one foot from drifting.

    An app's own corrector extends this class, or `Strapdown`, and can be used in a Recipe. testing/promises.py checks
    the rules below, examples/own_parts.py shows an example.

    A corrector is an attrs class (`@define`) with fields that can be saved. It reads no clock and no random numbers,
    has a constant cost for each sample, uses bounded memory, and never raises. Samples are finite, at most 500 m/s^2
    and 100 rad/s, and come at any interval. The results of a corrector are finite."""

    __slots__ = ()

    attitude: Quat
    """Attitude, sensor to navigation frame."""
    velocity: Vec3
    """Velocity of the sensor, navigation frame, m/s."""
    position: Vec3
    """Position of the sensor, navigation frame, m."""
    rate: Vec3 | None
    """Angular rate of the last sample, sensor frame, rad/s; None before any sample and after a gap."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        """Start at the origin with this attitude, whose tilt has a standard deviation of `tilt_sigma` rad."""

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        """Integrate one sample that comes `dt` s after the last one.

        `acc` (m/s^2) and `gyro` (rad/s) are in the sensor frame, without bias. `saturated` is True when the device
        reports that a sensor was at the end of its range."""

    def correct(self, t: float, stance: Stance) -> bool:
        """Use the evidence at the sample last given to `predict`; return whether it agrees with the motion so far."""

    def bridge(self, dt: float) -> float:
        """Inflate the covariance for a gap of `dt` s; return how much of it the caller has to integrate, s.

        The result is `dt`, or 0 after more than `LONGEST_BRIDGE`: the foot then continues from its last position."""

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        """Set the state after `dt` s without samples to that of the infill."""

    def repair(self, yaw: float, position: Vec3) -> None:
        """Repair a stride that had a gap, at its end: turn the attitude by `yaw` rad and set `position`, m."""

    def anchor(self) -> Floats:
        """End a stretch of the path and start the next one; return the covariance of the one that ends.

        It consists of position xx, xy, xz, yy, yz, zz (m^2) and yaw (rad^2)."""

    def covariance(self) -> Floats:
        """Return the covariance of the current stretch, as `anchor` would, without a change."""

    # what follows is optional: the default does nothing

    @property
    def error_index(self) -> float | None:
        """Difference between the integrated velocity and that of the rolling shoe in the last swing, m/s.

        None for a corrector that uses no velocity of a rolling shoe. StrideFeatures reports it."""
        return None

    @property
    def velocity_error(self) -> Vec3:
        """Difference between the integrated velocity and that of the standing foot when it last came to stand, m/s.

        It is in the navigation frame, and 0 for a corrector that does not measure it."""
        return ZERO

    @property
    def clipped(self) -> bool:
        """Whether peaks since the last anchor are cut off at the end of a range; True if it does not look for them."""
        return True

    def scaled(self, scale: float) -> None:
        """Receive the factor by which the specific force is multiplied from now on, so that a foot at rest shows 1 g.

        A corrector may take the difference from 1 g for a bias instead."""
        return

    def use_attitude(self, attitude: Quat) -> None:
        """Use the device's own attitude at the next sample: sensor to a world frame of the device, z up."""
        return

    def mark(self, t: float, cue: Cue) -> None:
        """Receive the cue of an event that most likely happened just now (`Cues.mark`).

        CONTACT: heel-strike is most likely the sample just corrected, at `t` s. CLEAR: toe-off is most likely the
        sample before it. A later call for the same event replaces this one."""
        return

    def flat(self, start: Vec3, turn: float) -> None:
        """Use a foot-flat that ends a stride; a corrector that detects level strides corrects the height here.

        The stride started at the position `start`, m, and its heading changed by `turn` rad."""
        return

    def calibrated(self, foot: Foot, calibration: Calibration) -> Self:
        """Return the corrector with the calibration of `foot`."""
        return self
