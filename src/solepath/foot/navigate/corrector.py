"""What a corrector is asked: navigation of one foot that uses stance evidence."""

from __future__ import annotations

from typing import Protocol, Self

from ...calibration import Calibration
from ...types import Foot, Quat, Vec3
from ..phase import Cue
from ..stance.stance import Stance

LONGEST_BRIDGE = 0.25
"""A gap longer than this is not integrated over: a foot turns and turns back within it, s."""


class Corrector(Protocol):
    """What keeps the integration of one foot from drifting. An app's own extends this, or `Strapdown`, and may stand in
    a Recipe beside ours; testing/promises.py tries whether it keeps what follows, docs/extending.md shows one.

    An attrs class (`@define`) with fields of kinds that can be saved. It reads no clock and no random numbers, costs
    the same at every sample, remembers no more the longer it is fed, and never raises: samples are finite, but
    otherwise of any size (up to 500 m/s^2, 100 rad/s) and at any distance in time. What it says is finite.
    """

    __slots__ = ()

    attitude: Quat
    velocity: Vec3
    position: Vec3
    rate: Vec3 | None
    """Angular rate of the last sample, sensor frame, rad/s; None when there was none or a gap since."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        """Stand still at the origin with this attitude, its tilt known to `tilt_sigma` rad."""

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        """One sample: `acc` in m/s^2 and `gyro` in rad/s, sensor frame, bias removed, `dt` s after the one before;
        `saturated` when the device says that a sensor was at the end of its range."""

    def correct(self, t: float, stance: Stance) -> bool:
        """Use the evidence of the sample just predicted; True when it agreed with the motion so far."""

    def bridge(self, dt: float) -> float:
        """`dt` s without samples lie before the next one: trust the motion accordingly less. Returns how long to
        integrate over: all of it, or 0 after `LONGEST_BRIDGE`, when the foot is taken up where it was."""

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        """`dt` s without samples lie before the next one, and this is where the foot is taken to be by its habit."""

    def repair(self, yaw: float, position: Vec3) -> None:
        """A gap has spoilt the stride that ends here: turn the attitude by `yaw` rad, and take `position`, m."""

    def anchor(self) -> tuple[float, ...]:
        """Begin a new stretch here. Returns the covariance of the stretch that ends: position xx, xy, xz, yy, yz, zz
        (m^2) and yaw (rad^2)."""

    def covariance(self) -> tuple[float, ...]:
        """What `anchor` would return now, changing nothing."""

    # what a corrector may pay heed to; it need not

    @property
    def error_index(self) -> float | None:
        """By how much the integration missed a known velocity in the motion that ended last, m/s (StrideFeatures); None
        where no velocity but zero is known."""
        return None

    def use_attitude(self, attitude: Quat) -> None:
        """The device says its own attitude at the sample that comes next: sensor to a world of its own, z up."""
        return

    def mark(self, t: float, cue: Cue) -> None:
        """Of all samples so far the one just corrected, at `t` s, is most likely that of heel-strike (CONTACT), or the
        one before it that of toe-off (CLEAR)."""
        return

    def flat(self, start: Vec3, turn: float) -> None:
        """The foot is flat again, turned by `turn` rad since it was so at `start`, m: a corrector that knows whether a
        step was level puts the height right."""
        return

    def calibrated(self, foot: Foot, calibration: Calibration) -> Self:
        """The corrector to be used for that foot, with what the calibration says of it."""
        return self
