"""Correction of the state of a filter for the clipped peaks of gyroscope and accelerometer.

clipping.py detects clipped peaks, reintegration.py gives their effect. This module stores the samples for both."""

from __future__ import annotations

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, from_rotation_vector, multiply, normalise, rotate
from .clipping import ACCELEROMETER, ClippedPeak, Clipping
from .covariance import Covariance
from .reintegration import INTEGRAL_STEP, SwingSamples, add_error, difference

State = tuple[Quat, Vec3, Vec3, Covariance]
"""Attitude (sensor to navigation frame), velocity (m/s), position (m) and their covariance."""


@define
class Recovery:
    """The clipping of both sensors of one foot; ErrorStateFilter calls `watch` only near the ends of their ranges."""

    gyro_clipping: Clipping = field(factory=Clipping, init=False)
    """Clipping of the gyroscope."""
    acc_clipping: Clipping = field(factory=lambda: Clipping(ACCELEROMETER), init=False)
    """Clipping of the accelerometer."""
    last_acc: Vec3 = field(default=ZERO, init=False)
    """Last acc, sensor frame, m/s^2; ErrorStateFilter sets it and the `earlier_...` fields between calls of `watch`."""
    earlier_acc: Vec3 = field(default=ZERO, init=False)
    """Acc before the last one, sensor frame, m/s^2."""
    swing: SwingSamples = field(factory=SwingSamples, init=False)
    """Samples since the gyroscope came near the end of its range."""
    earlier_rate: Vec3 = field(default=ZERO, init=False)
    """Rate before the last one, sensor frame, rad/s."""
    earlier_dt: float = field(default=0.0, init=False)
    """Time between the last two samples, s."""

    def watch(
        self, dt: float, acc: Vec3, gyro: Vec3, previous_rate: Vec3, attitude: Quat, saturated: bool
    ) -> tuple[tuple[ClippedPeak, ...] | None, tuple[ClippedPeak, ...] | None]:
        """Return the clipped peaks of gyroscope and accelerometer that become known with this sample.

        `acc` is in m/s^2, `gyro` in rad/s. `previous_rate` and `attitude` are those of the last sample. `saturated` is
        True when the device reports that a sensor is at the end of its range."""
        x, y, z = gyro
        gyro_clipping, gyro_peaks = self.gyro_clipping, None
        if gyro_clipping.clipping or x * x + y * y + z * z > gyro_clipping.near_end_square:
            gyro_peaks = gyro_clipping.update(dt, gyro, previous_rate, self.earlier_rate, self.earlier_dt, saturated)
            self.swing.add_sample(dt, gyro, previous_rate, acc, attitude)
        elif self.swing.rows:
            self.swing.rows = []
        x, y, z = acc
        acc_clipping, acc_peaks = self.acc_clipping, None
        if acc_clipping.clipping or x * x + y * y + z * z > acc_clipping.near_end_square:
            acc_peaks = acc_clipping.update(dt, acc, self.last_acc, self.earlier_acc, self.earlier_dt, saturated)
        self.earlier_acc, self.last_acc = self.last_acc, acc
        self.earlier_rate, self.earlier_dt = previous_rate, dt
        return gyro_peaks, acc_peaks

    def reset(self) -> None:
        """Discard clipped peaks that are not complete, after a gap."""
        self.gyro_clipping.reset()
        self.acc_clipping.reset()
        self.swing.rows = []

    def end_stride(self) -> None:
        """Let the largest readings decay at the end of a stride."""
        self.gyro_clipping.end_stride()
        self.acc_clipping.end_stride()

    def add_turns(self, gyro_peaks: tuple[ClippedPeak, ...], state: State) -> State:
        """Return the state corrected for clipped peaks of the gyroscope, with their uncertainty."""
        attitude, (vx, vy, vz), (x, y, z), covariance = state
        for peak in gyro_peaks:
            measured, corrected, perturbed = (
                self.swing.reintegrate(peak, integral)
                for integral in (0.0, peak.integral, peak.integral + INTEGRAL_STEP)
            )
            (px, py, pz), (ux, uy, uz), turn = difference(measured, corrected)
            x, y, z = x + px, y + py, z + pz
            vx, vy, vz = vx + ux, vy + uy, vz + uz
            attitude = normalise(multiply(from_rotation_vector(turn), attitude))
            covariance = add_error(covariance, *difference(corrected, perturbed), peak.sigma / INTEGRAL_STEP)
        return attitude, (vx, vy, vz), (x, y, z), covariance

    @staticmethod
    def add_velocities(acc_peaks: tuple[ClippedPeak, ...], state: State) -> State:
        """Return the state corrected for clipped peaks of the accelerometer, with their uncertainty."""
        attitude, (vx, vy, vz), (x, y, z), covariance = state
        for peak in acc_peaks:
            i, j, k = (1.0 if index == peak.axis else 0.0 for index in (0, 1, 2))
            axis_x, axis_y, axis_z = axis = rotate(attitude, (i, j, k))
            v, elapsed = peak.integral, peak.age + 0.5 * peak.duration  # elapsed since the middle of the peak
            x, y, z = x + v * elapsed * axis_x, y + v * elapsed * axis_y, z + v * elapsed * axis_z
            vx, vy, vz = vx + v * axis_x, vy + v * axis_y, vz + v * axis_z
            shift = (elapsed * axis_x, elapsed * axis_y, elapsed * axis_z)
            covariance = add_error(covariance, shift, axis, ZERO, peak.sigma)
        return attitude, (vx, vy, vz), (x, y, z), covariance
