"""Navigation of "Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans.
Instrum. Meas. 59, 2010), figure 8: the acceleration without its bias is integrated, the velocity is reset to zero
while the foot stands, and the drift that calibration laps have shown (papers/pressure_contour/square.py) is taken off
the position.
"""

from __future__ import annotations

from math import atan2, inf

from ...calibration import Calibration
from ...foot.navigate.corrector import LONGEST_BRIDGE
from ...foot.navigate.dedrift import LinearDedrift
from ...foot.settings import DedriftSettings
from ...foot.stance.stance import Stance
from ...types import Foot, Quat, Vec3
from ...types.attrs import define, evolve, field, frozen
from ...types.vector import GRAVITY, ZERO, conjugate, from_yaw, multiply, normalise, rotate, rotate_back, sub
from .acc_bias import AccelerometerBias

STANDS = 1.0
"""A foot that has stood for this long no longer drifts, s."""


@frozen
class BiasZuptSettings(DedriftSettings):
    """What `BiasZupt` is set to."""

    drift: tuple[float, float] | None = None
    """Calibrated slope of the position, m/s (x, y): in the device's own world where it has an attitude of its own,
    otherwise in the navigation frame."""
    spread: bool = True
    """The velocity that a swing ends with was gathered evenly over it, so the position loses half of it times the time
    since the foot last stood. The paper speaks of resets alone. Without this a tilt of a quarter of a degree, which is
    what its sensor promises, costs a centimetre a stride."""
    turn_error: float = 0.0175
    """Heading error of a device's own attitude: the InertiaCube3's data sheet has 1 degree, rad."""


@define
class BiasZupt(LinearDedrift):
    """Strapdown navigation with zero-velocity resets, an accelerometer bias and a calibrated drift.

    Frame and units as in `Corrector`. Latency: the position is corrected, in one jump, with the first sample of stance.

    The attitude is the device's own where it tells one, as the paper's InertiaCube3 does: its heading is turned once,
    so that the heading of navigation goes on as it was. Where it tells none, it is integrated, and pulled towards
    gravity while the foot stands; a horizontal bias then looks like a tilt, and only the vertical one can be seen.
    """

    settings: BiasZuptSettings = BiasZuptSettings()
    bias: AccelerometerBias = field(factory=AccelerometerBias)
    given: Quat | None = field(default=None, init=False)
    """The device's own attitude at the sample that comes next."""
    turned: float | None = field(default=None, init=False)
    """From the device's own heading to that of navigation, rad; None as long as it has told none since its clock began.
    """
    measured: Vec3 = field(default=ZERO, init=False)
    """a_m of the last sample, sensor frame, m/s^2."""
    stood: float = field(default=0.0, init=False)
    """For how long the foot has stood without a break, s."""
    step: float = field(default=0.0, init=False)
    """How long the last sample lasted, s."""
    own: bool = field(default=True, init=False)
    """The attitude of the last sample is our own."""

    def calibrated(self, foot: Foot, calibration: Calibration) -> BiasZupt:
        drift = calibration.drift.get(foot)
        return self if drift is None else evolve(self, settings=evolve(self.settings, drift=drift))

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        LinearDedrift.start(self, attitude, tilt_sigma)
        self.turned = None
        self.stood = self.step = 0.0

    def use_attitude(self, attitude: Quat) -> None:
        self.given = attitude

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        self.bias.pass_time(dt)
        bx, by, bz = self.bias.bias
        ax, ay, az = acc
        actual = (ax + bx, ay + by, az + bz)  # (6), and (10) with the sign of (6): R (acc + a_b) - g = a_m + R a_b
        self.own = self.given is None
        if self.given is None:
            LinearDedrift.predict(self, dt, actual, gyro, saturated)
        else:
            self.attitude = self._turned(self.given)
            self.given = None
            self.rate = None
            LinearDedrift.predict(self, dt, actual, ZERO, saturated)
            self.rate = gyro
        # (4): a_m in the sensor frame is the specific force without the gravity that the attitude sees there
        self.measured = sub(acc, rotate_back(self.attitude, (0.0, 0.0, GRAVITY)))
        drift = self.settings.drift
        if drift is not None and self.stood < STANDS:
            dx, dy = drift
            if self.turned is not None:
                dx, dy, _ = rotate(from_yaw(self.turned), (dx, dy, 0.0))
            x, y, z = self.position
            self.position = (x - dx * dt, y - dy * dt, z)
        self.step = dt

    def correct(self, t: float, stance: Stance) -> bool:
        where = self.position
        if not LinearDedrift.correct(self, t, stance):
            self.stood = 0.0
            return False
        if not self.settings.spread:
            self.position = where
        self.stood += self.step
        self.bias.stood(self.measured)
        return True

    def bridge(self, dt: float) -> float:
        if dt > LONGEST_BRIDGE:
            self.stood = 0.0
        if dt == inf:  # a clock that begins anew may be that of a device that did, and its world with it
            self.turned = self.given = None
        return LinearDedrift.bridge(self, dt)

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        LinearDedrift.infill(self, dt, attitude, velocity, position)
        self.stood = 0.0

    def covariance(self) -> tuple[float, ...]:
        found = LinearDedrift.covariance(self)
        if self.turned is None:
            return found
        # Each stretch has its heading anew, so what it is off by moves this stretch sideways and no other.
        variance = found[0] + (self.settings.turn_error * self.length) ** 2
        return (variance, 0.0, 0.0, variance, 0.0, variance, 0.0)

    def _turned(self, given: Quat) -> Quat:
        """The device's own attitude in the navigation frame."""
        if self.turned is None:
            w, _, _, z = multiply(self.attitude, conjugate(given))
            self.turned = 2.0 * atan2(z, w)
        return normalise(multiply(from_yaw(self.turned), given))

    def _level(self) -> None:
        """An attitude of our own is pulled by the force without the bias: with it, bias and tilt could drift against
        each other."""
        if self.own:
            self._pull(rotate(self.attitude, self.measured), self.step)
