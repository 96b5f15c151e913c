"""Navigation of Bebek et al. 2010, figure 8: zero-velocity updates, accelerometer bias and calibrated drift.

"Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans. Instrum. Meas. 59,
2010). The acceleration without its bias is integrated. The velocity is set to zero while the foot stands. The drift
that calibration laps have shown (papers/pressure_contour/square.py) is subtracted from the position."""

from __future__ import annotations

from math import atan2, inf

from ...calibration import Calibration
from ...foot.navigate.corrector import LONGEST_BRIDGE
from ...foot.navigate.dedrift import LinearDedrift
from ...foot.settings import DedriftSettings
from ...foot.stance.stance import Stance
from ...types import Foot, Quat, Vec2, Vec3
from ...types.attrs import evolve, field, frozen, state, stateful
from ...types.vector import GRAVITY, ZERO, add, conjugate, from_yaw, multiply, normalise, rotate, rotate_back, sub
from .acc_bias import AccelerometerBias

STANDING_DELAY = 1.0
"""Time after the start of a stance from which the calibrated drift is no longer subtracted, s; chosen by hand."""


@frozen
class BiasZuptSettings(DedriftSettings):
    """Settings of `BiasZupt`."""

    drift: Vec2 | None = None
    """Calibrated drift of the position (x, y), m/s; None without a calibration. Its frame is the device's own world
    frame if the device reports attitudes, otherwise the navigation frame."""
    remove_swing_drift: bool = True
    """Flag: a linear drift of the velocity in swing is removed from the position. The velocity left at the end of a
    swing is assumed to have grown evenly, so half of it times the time since the foot last stood is subtracted from the
    position. The paper only sets the velocity to zero. Then a tilt error of a quarter of a degree, the accuracy of its
    sensor, costs a centimetre per stride."""
    estimate_bias: bool = True
    """Flag: the bias of the accelerometer is estimated (7) to (10); the paper's "calibrated position" (figs. 14
    and 15) has both this bias and the laps' slope (`drift`), its "position" has neither."""


@stateful
class BiasZupt(LinearDedrift):
    """Corrector: strapdown navigation with zero-velocity updates, an accelerometer bias and a calibrated drift.

    Frame and units are those of `Corrector`. Latency: the position is corrected, in one jump, at the first sample of
    stance.

    If the device reports its attitude, as the paper's InertiaCube3 does, that attitude is used. A constant is added to
    its heading, so that the heading of navigation continues. Otherwise the attitude is integrated, and tilted towards
    gravity while the foot stands. Then a horizontal bias looks the same as a tilt, so the filter can learn the vertical
    bias only."""

    settings: BiasZuptSettings = field(default=BiasZuptSettings())
    bias: AccelerometerBias = state(factory=AccelerometerBias)
    """Bias of the accelerometer."""
    device_attitude: Quat | None = None
    """Attitude that the device reports for the next sample."""
    heading_offset: float | None = None
    """Heading of navigation minus the device's heading, rad, left positive; None before the device's first attitude."""
    motion_acc: Vec3 = ZERO
    """Acceleration a_m of the last sample, without gravity, sensor frame, m/s^2."""
    standing_time: float = 0.0
    """Time for which the foot has stood without a break, s."""
    last_dt: float = 0.0
    """Time between the last two samples, s."""
    integrated: bool = True
    """Flag: the attitude of the last sample is integrated, not reported by the device."""

    def calibrated(self, foot: Foot, calibration: Calibration) -> BiasZupt:
        drift = calibration.drift.get(foot)
        return self if drift is None else evolve(self, settings=evolve(self.settings, drift=drift))

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        LinearDedrift.start(self, attitude, tilt_sigma)
        self.heading_offset = None
        self.standing_time = self.last_dt = 0.0

    def use_attitude(self, attitude: Quat) -> None:
        self.device_attitude = attitude

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        self.bias.propagate(dt)
        unbiased = add(acc, self.bias.bias)  # (6), and (10) with the sign of (6): R (acc + a_b) - g = a_m + R a_b
        self.integrated = self.device_attitude is None
        if self.device_attitude is None:
            LinearDedrift.predict(self, dt, unbiased, gyro, saturated)
        else:
            self.attitude = self._to_navigation_frame(self.device_attitude)
            self.device_attitude = None
            self.rate = None
            LinearDedrift.predict(self, dt, unbiased, ZERO, saturated)
            self.rate = gyro
        # (4): a_m is the specific force minus gravity, which the attitude turns into the sensor frame
        self.motion_acc = sub(acc, rotate_back(self.attitude, (0.0, 0.0, GRAVITY)))
        drift = self.settings.drift
        if drift is not None and self.standing_time < STANDING_DELAY:
            dx, dy = drift
            if self.heading_offset is not None:
                dx, dy, _ = rotate(from_yaw(self.heading_offset), (dx, dy, 0.0))
            self.position = add(self.position, (dx, dy, 0.0), -dt)
        self.last_dt = dt

    def correct(self, t: float, stance: Stance) -> bool:
        position = self.position
        if not LinearDedrift.correct(self, t, stance):
            self.standing_time = 0.0
            return False
        if not self.settings.remove_swing_drift:
            self.position = position
        self.standing_time += self.last_dt
        if self.settings.estimate_bias:
            self.bias.correct(self.motion_acc)
        return True

    def bridge(self, dt: float) -> float:
        if dt > LONGEST_BRIDGE:
            self.standing_time = 0.0
        if dt == inf:  # the clock restarts, so the device may have restarted with another world frame
            self.heading_offset = self.device_attitude = None
        return LinearDedrift.bridge(self, dt)

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        LinearDedrift.infill(self, dt, attitude, velocity, position)
        self.standing_time = 0.0

    def _to_navigation_frame(self, device_attitude: Quat) -> Quat:
        """Return the device's own attitude in the navigation frame."""
        if self.heading_offset is None:
            w, _, _, z = multiply(self.attitude, conjugate(device_attitude))
            self.heading_offset = 2.0 * atan2(z, w)
        return normalise(multiply(from_yaw(self.heading_offset), device_attitude))

    def _level(self) -> None:
        """Tilt an integrated attitude towards gravity by the measured specific force, in which the bias remains.

        With the bias removed, bias and tilt could drift in opposite directions."""
        if self.integrated:
            self._pull(rotate(self.attitude, self.motion_acc), self.last_dt)
