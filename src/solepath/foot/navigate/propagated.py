"""Strapdown navigation that knows how far it is off: its covariance is carried over any interval in one stroke.

Between two uses of the covariance only the noise is added up, so a sample costs no more than its integration
(covariance.py).
"""

from __future__ import annotations

from attrs import define, field

from ...types import Vec3
from ...types.vector import GRAVITY, ZERO, normalise
from .covariance import TILT_X, TILT_Y, VELOCITY_X, VELOCITY_Y, VELOCITY_Z, Correction, Covariance, propagate
from .strapdown import Strapdown


@define
class Carried(Strapdown):
    """The state, its covariance as it was `since` s ago, and where the state was then."""

    uncertainty: Covariance = field(default=(0.0,) * 45, init=False)
    since: float = field(default=0.0, init=False)
    """Time since the covariance was last carried forward, s."""
    start_velocity: Vec3 = field(default=ZERO, init=False)
    start_position: Vec3 = field(default=ZERO, init=False)
    acc_variance: float = field(default=0.0, init=False)
    """What noise has added since then to the variance of a velocity, (m/s)^2,"""
    gyro_variance: float = field(default=0.0, init=False)
    """and of an angle, rad^2."""

    def _carried(self) -> Covariance:
        """The covariance as it is now."""
        t = self.since
        vx, vy, vz = self.velocity
        ux, uy, uz = self.start_velocity
        x, y, z = self.position
        ox, oy, oz = self.start_position
        # S = dv + g T, D = dp - v0 T + g T^2 / 2: the integrals of the specific force, out of what it did
        s = (vx - ux, vy - uy, vz - uz + GRAVITY * t)
        d = (x - ox - ux * t, y - oy - uy * t, z - oz - uz * t + 0.5 * GRAVITY * t * t)
        q = self.acc_variance
        return propagate(self.uncertainty, t, s, d, q * t * t / 3.0, q * t / 2.0, q, self.gyro_variance)

    def _carry(self) -> None:
        if self.since > 0.0:
            self.uncertainty = self._carried()
            self._here()

    def _here(self) -> None:
        self.since = self.acc_variance = self.gyro_variance = 0.0
        self.start_velocity = self.velocity
        self.start_position = self.position

    def _doubt(self, velocity: float, tilt: float) -> None:
        """Add these standard deviations, m/s and rad, to what is known."""
        covariance = list(self.uncertainty)
        for i in (VELOCITY_X, VELOCITY_Y, VELOCITY_Z):
            covariance[i] += velocity * velocity
        for i in (TILT_X, TILT_Y):
            covariance[i] += tilt * tilt
        self.uncertainty = tuple(covariance)

    def _inject(self, error: Correction, tilt_x: float, tilt_y: float) -> None:
        """Correct the state by what it was off by, and turn it by as much besides, rad."""
        px, py, pz, vx, vy, vz, tx, ty, tz = error
        tx += tilt_x
        ty += tilt_y
        x, y, z = self.position
        self.position = self.start_position = (x + px, y + py, z + pz)
        x, y, z = self.velocity
        self.velocity = self.start_velocity = (x + vx, y + vy, z + vz)
        # q <- dq(theta) * q with a global attitude error (Sola 2017, section 7)
        w, x, y, z = self.attitude
        tx, ty, tz = 0.5 * tx, 0.5 * ty, 0.5 * tz
        self.attitude = normalise(
            (w - tx * x - ty * y - tz * z, x + tx * w + ty * z - tz * y,
             y + ty * w + tz * x - tx * z, z + tz * w + tx * y - ty * x)
        )  # fmt: skip
