"""Linear dedrift: integration in swing, velocity of the evidence in stance, linear removal of the drift of a swing.

This is the textbook corrector (for instance Ojeda and Borenstein, "Non-GPS navigation for security personnel and first
responders", 2007): the velocity error at the end of a swing has grown evenly over it. With e(t) = e_T t/T removed from
the velocity, the position changes by the integral, e_T T/2. The tilt drifts with the gyroscope, so in stance the
measured direction of gravity corrects the attitude (the proportional term of Mahony, Hamel, Pflimlin, IEEE Trans.
Autom. Control 53, 2008)."""

from __future__ import annotations

from math import exp, fsum, sqrt

from ...types import Floats, Phase, Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, ZERO, add, sub, tipped
from ..settings import DedriftSettings
from ..stance.stance import Stance
from .corrector import LONGEST_BRIDGE
from .strapdown import Strapdown


@define
class LinearDedrift(Strapdown):
    """Strapdown navigation that takes the velocity of the evidence in stance and removes the drift of the swing.

    Frame and units as in `Corrector`. Latency: the position is corrected, in one jump, at the first sample of stance.
    """

    settings: DedriftSettings = DedriftSettings()
    swing: float = field(default=0.0, init=False)
    """Time since the last evidence of stance, s."""
    length: float = field(default=0.0, init=False)
    """Length of the path since the last anchor, m."""
    time_since_anchor: float = field(default=0.0, init=False)
    """Time since the last anchor, s."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.attitude = attitude
        self.velocity = self.position = ZERO
        self.force = self.rate = None
        self.swing = self.length = self.time_since_anchor = 0.0

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        self.integrate(dt, acc, gyro)
        vx, vy, vz = self.velocity
        self.length += sqrt(vx * vx + vy * vy + vz * vz) * dt
        self.swing += dt
        self.time_since_anchor += dt

    def correct(self, t: float, stance: Stance) -> bool:
        if stance.sigma > self.settings.largest_stance_sigma or stance.hint is Phase.SWING:
            return False
        self.position = add(self.position, sub(stance.v_ref, self.velocity), 0.5 * self.swing)
        self.velocity = stance.v_ref
        self._level()
        self.swing = 0.0
        return True

    def bridge(self, dt: float) -> float:
        # this corrector has no noise model: the gap only makes the stretch less certain
        self.length += min(dt, LONGEST_BRIDGE)
        if dt <= LONGEST_BRIDGE:
            return dt
        self.velocity = ZERO
        self.force = self.rate = None
        self.swing = 0.0
        return 0.0

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self.length += sqrt(fsum(v * v for v in sub(position, self.position)))
        self.swing += dt
        self.time_since_anchor += dt
        self.attitude, self.velocity, self.position = attitude, velocity, position
        self.force = self.rate = None

    def anchor(self) -> Floats:
        stretch = self.covariance()
        self.length = self.time_since_anchor = 0.0
        return stretch

    def covariance(self) -> Floats:
        variance = (self.settings.path_error * self.length) ** 2
        drift = self.settings.turn_drift
        yaw = drift * drift * self.time_since_anchor
        return (variance, 0.0, 0.0, variance, 0.0, variance, yaw)

    def _level(self) -> None:
        """Turn the attitude towards the specific force of a standing foot, which points up."""
        if self.force is not None:
            self._pull(self.force, self.swing)

    def _pull(self, force: Vec3, dt: float) -> None:
        """Turn the attitude about `force` x z towards `force` (m/s^2) up, by the share 1 - exp(-tilt_rate dt)."""
        fx, fy, _ = force
        share = 0.5 * (1.0 - exp(-self.settings.tilt_rate * min(dt, 0.1))) / GRAVITY
        self.attitude = tipped(self.attitude, share * fy, -share * fx)
