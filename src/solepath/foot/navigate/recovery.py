"""Recovery of the clipped peaks of both sensors of a foot, for the state of a filter.

clipping.py detects clipped peaks, reintegration.py gives their effect; this module stores the samples that both need.
"""

from __future__ import annotations

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, from_rotation_vector, multiply, normalise, rotate
from .clipping import ACCELEROMETER, ClippedPeak, Clipping
from .covariance import Covariance
from .reintegration import NUDGE, SwingSamples, add_error, difference

State = tuple[Quat, Vec3, Vec3, Covariance]
"""Attitude, velocity (m/s), position (m) and their covariance."""


@define
class Recovery:
    """The clipping of both sensors of one foot. Call `watch` for every sample before it is integrated."""

    turns: Clipping = field(factory=Clipping, init=False)
    """Clipping of the gyroscope."""
    impacts: Clipping = field(factory=lambda: Clipping(ACCELEROMETER), init=False)
    """Clipping of the accelerometer."""
    last_acc: Vec3 = field(default=ZERO, init=False)
    """Last acc, sensor frame, m/s^2."""
    earlier_acc: Vec3 = field(default=ZERO, init=False)
    """Acc before the last one, sensor frame, m/s^2."""
    swing: SwingSamples = field(factory=SwingSamples, init=False)
    earlier_rate: Vec3 = field(default=ZERO, init=False)
    """Rate before the last one, sensor frame, rad/s."""
    earlier_dt: float = field(default=0.0, init=False)
    """Time between the last two samples, s."""

    def watch(
        self, dt: float, acc: Vec3, gyro: Vec3, before: Vec3, attitude: Quat, saturated: bool
    ) -> tuple[tuple[ClippedPeak, ...] | None, tuple[ClippedPeak, ...] | None]:
        """Return the clipped peaks of gyroscope and accelerometer that one sample completes.

        `before` and `attitude` are the rate and the attitude before the sample."""
        x, y, z = gyro
        turns, peaks = self.turns, None
        if turns.clipping or x * x + y * y + z * z > turns.watch_square:
            peaks = turns.update(dt, gyro, before, self.earlier_rate, self.earlier_dt, saturated)
            self.swing.add_sample(dt, gyro, before, acc, attitude)
        elif self.swing.rows:
            self.swing.rows = []
        x, y, z = acc
        impacts, acc_peaks = self.impacts, None
        if impacts.clipping or x * x + y * y + z * z > impacts.watch_square:
            acc_peaks = impacts.update(dt, acc, self.last_acc, self.earlier_acc, self.earlier_dt, saturated)
        self.earlier_acc, self.last_acc = self.last_acc, acc
        self.earlier_rate, self.earlier_dt = before, dt
        return peaks, acc_peaks

    def reset(self) -> None:
        """Discard clipped peaks after a gap."""
        self.turns.reset()
        self.impacts.reset()
        self.swing.rows = []

    def end_stride(self) -> None:
        """Let the largest readings decay at the end of a stride."""
        self.turns.end_stride()
        self.impacts.end_stride()

    def add_turns(self, peaks: tuple[ClippedPeak, ...], state: State) -> State:
        """Return the state with the clipped peaks of the gyroscope, and with their covariance."""
        attitude, (vx, vy, vz), (x, y, z), covariance = state
        for one in peaks:
            seen, likely, more = (
                self.swing.reintegrate(one, integral) for integral in (0.0, one.integral, one.integral + NUDGE)
            )
            (px, py, pz), (ux, uy, uz), turn = difference(seen, likely)
            x, y, z = x + px, y + py, z + pz
            vx, vy, vz = vx + ux, vy + uy, vz + uz
            attitude = normalise(multiply(from_rotation_vector(turn), attitude))
            covariance = add_error(covariance, *difference(likely, more), one.sigma / NUDGE)
        return attitude, (vx, vy, vz), (x, y, z), covariance

    @staticmethod
    def add_velocities(acc_peaks: tuple[ClippedPeak, ...], state: State) -> State:
        """Return the state with the clipped peaks of the accelerometer, and with their covariance."""
        attitude, (vx, vy, vz), (x, y, z), covariance = state
        for one in acc_peaks:
            i, j, k = (1.0 if axis == one.axis else 0.0 for axis in (0, 1, 2))
            ux, uy, uz = rotate(attitude, (i, j, k))
            v, since = one.integral, one.ago + 0.5 * one.duration
            x, y, z = x + v * since * ux, y + v * since * uy, z + v * since * uz
            vx, vy, vz = vx + v * ux, vy + v * uy, vz + v * uz
            covariance = add_error(covariance, (since * ux, since * uy, since * uz), (ux, uy, uz), ZERO, one.sigma)
        return attitude, (vx, vy, vz), (x, y, z), covariance
