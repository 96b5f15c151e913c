"""Both sensors of a foot watched at the ends of their ranges, and what they missed put into a filter's state.

clipping.py says what was missed, missed.py what follows from it; this keeps the samples that both need.
"""

from __future__ import annotations

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, from_rotation_vector, multiply, normalise, rotate
from .clipping import ACCELEROMETER, Clipping, Missed
from .covariance import Covariance
from .missed import NUDGE, Swing, apart, spread

State = tuple[Quat, Vec3, Vec3, Covariance]
"""Attitude, velocity (m/s), position (m) and their covariance."""


@define
class Recovery:
    """Fed every sample before it is integrated. A plain record."""

    turns: Clipping = field(factory=Clipping, init=False)
    """The gyroscope."""
    impacts: Clipping = field(factory=lambda: Clipping(ACCELEROMETER), init=False)
    """The accelerometer; and its last two readings, m/s^2:"""
    felt: Vec3 = field(default=ZERO, init=False)
    felt_before: Vec3 = field(default=ZERO, init=False)
    swing: Swing = field(factory=Swing, init=False)
    earlier: Vec3 = field(default=ZERO, init=False)
    """The rate before the last one, rad/s, and how long before it, s:"""
    earlier_dt: float = field(default=0.0, init=False)

    def watch(
        self, dt: float, acc: Vec3, gyro: Vec3, before: Vec3, attitude: Quat, saturated: bool
    ) -> tuple[tuple[Missed, ...] | None, tuple[Missed, ...] | None]:
        """A sample; `before` and `attitude`: rate and attitude before it. What the gyroscope and the accelerometer
        turn out to have missed, as soon as they are within their ranges again."""
        x, y, z = gyro
        turns, missed = self.turns, None
        if turns.clipping or x * x + y * y + z * z > turns.watch:
            missed = turns.update(dt, gyro, before, self.earlier, self.earlier_dt, saturated)
            self.swing.keep(dt, gyro, before, acc, attitude)
        elif self.swing.rows:
            self.swing.rows = []
        x, y, z = acc
        impacts, lost = self.impacts, None
        if impacts.clipping or x * x + y * y + z * z > impacts.watch:
            lost = impacts.update(dt, acc, self.felt, self.felt_before, self.earlier_dt, saturated)
        self.felt_before, self.felt = self.felt, acc
        self.earlier, self.earlier_dt = before, dt
        return missed, lost

    def reset(self) -> None:
        """There was a gap."""
        self.turns.reset()
        self.impacts.reset()
        self.swing.rows = []

    def stepped(self) -> None:
        """A step is over."""
        self.turns.stepped()
        self.impacts.stepped()

    def turned(self, missed: tuple[Missed, ...], state: State) -> State:
        """The state as it is with the turn that the gyroscope missed, and the doubt."""
        attitude, (vx, vy, vz), (x, y, z), covariance = state
        for one in missed:
            seen, likely, more = (self.swing.reintegrated(one, angle) for angle in (0.0, one.angle, one.angle + NUDGE))
            (px, py, pz), (ux, uy, uz), turn = apart(seen, likely)
            x, y, z = x + px, y + py, z + pz
            vx, vy, vz = vx + ux, vy + uy, vz + uz
            attitude = normalise(multiply(from_rotation_vector(turn), attitude))
            covariance = spread(covariance, *apart(likely, more), one.sigma / NUDGE)
        return attitude, (vx, vy, vz), (x, y, z), covariance

    @staticmethod
    def struck(lost: tuple[Missed, ...], state: State) -> State:
        """The same of the velocity that the accelerometer missed."""
        attitude, (vx, vy, vz), (x, y, z), covariance = state
        for one in lost:
            i, j, k = (1.0 if axis == one.axis else 0.0 for axis in (0, 1, 2))
            ux, uy, uz = rotate(attitude, (i, j, k))
            v, since = one.angle, one.ago + 0.5 * one.lasted
            x, y, z = x + v * since * ux, y + v * since * uy, z + v * since * uz
            vx, vy, vz = vx + v * ux, vy + v * uy, vz + v * uz
            covariance = spread(covariance, (since * ux, since * uy, since * uz), (ux, uy, uz), ZERO, one.sigma)
        return attitude, (vx, vy, vz), (x, y, z), covariance
