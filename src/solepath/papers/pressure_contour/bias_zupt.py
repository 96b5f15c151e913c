"""Navigation of "Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans.
Instrum. Meas. 59, 2010), figure 8: the acceleration without its bias is integrated, the velocity is reset to zero
while the foot stands, and the drift that calibration laps have shown (papers/pressure_contour/square.py) is taken off
the position.
"""

from __future__ import annotations

from math import atan2, exp, inf, sqrt

from attrs import define, evolve, field

from ...calibration import Calibration
from ...foot.navigate.corrector import LONGEST_BRIDGE
from ...foot.navigate.strapdown import Strapdown
from ...foot.stance.stance import Stance
from ...types import Foot, Phase, Quat, Vec3
from ...types.vector import GRAVITY, ZERO, conjugate, from_yaw, multiply, normalise, rotate, sub, tipped
from .acc_bias import AccelerometerBias

STANDS = 1.0
"""A foot that has stood for this long no longer drifts, s."""


@define
class BiasZupt(Strapdown):
    """Strapdown navigation with zero-velocity resets, an accelerometer bias and a calibrated drift.

    Frame and units as in `Corrector`. Latency: the position is corrected, in one jump, with the first sample of stance.

    The attitude is the device's own where it tells one, as the paper's InertiaCube3 does: its heading is turned once,
    so that the heading of navigation goes on as it was. Where it tells none, it is integrated, and pulled towards
    gravity while the foot stands; a horizontal bias then looks like a tilt, and only the vertical one can be seen.
    """

    trusted: float = 0.05
    """Evidence with a sigma above this is no stance, m/s."""
    tilt_rate: float = 2.0
    """How fast stance pulls an attitude of our own towards gravity, 1/s."""
    drift: tuple[float, float] | None = None
    """Calibrated slope of the position, m/s (x, y): in the device's own world where it tells its attitude, otherwise in
    the navigation frame."""
    spread: bool = True
    """The velocity that a swing ends with was gathered evenly over it, so the position loses half of it times the time
    since the foot last stood. The paper speaks of resets alone. Without this a tilt of a quarter of a degree, which is
    what its sensor promises, costs a centimetre a stride."""
    share: float = 0.01
    """What a stretch is wrong by, as a share of its length."""
    turn_drift: float = 0.002
    """Growth of the heading error of an attitude of our own, rad/sqrt(s)."""
    turn_error: float = 0.0175
    """Heading error of a device's own attitude: the InertiaCube3's data sheet has 1 degree, rad."""
    bias: AccelerometerBias = field(factory=AccelerometerBias)
    # state
    given: Quat | None = field(default=None, init=False)
    """The device's own attitude at the sample that comes next."""
    turned: float | None = field(default=None, init=False)
    """From the device's own heading to that of navigation, rad; None as long as it has told none since its clock began.
    """
    measured: Vec3 = field(default=ZERO, init=False)
    """a_m of the last sample, sensor frame, m/s^2."""
    swing: float = field(default=0.0, init=False)
    """Time since the foot last stood, s."""
    stood: float = field(default=0.0, init=False)
    """For how long the foot has stood without a break, s."""
    step: float = field(default=0.0, init=False)
    """How long the last sample lasted, s."""
    own: bool = field(default=True, init=False)
    """The attitude of the last sample is our own."""
    length: float = field(default=0.0, init=False)
    """Way since the last anchor, m."""
    lasted: float = field(default=0.0, init=False)
    """Time since the last anchor, s."""

    def calibrated(self, foot: Foot, calibration: Calibration) -> BiasZupt:
        """The same with the drift that is known."""
        return evolve(self, drift=calibration.drift[foot]) if foot in calibration.drift else self

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.attitude = attitude
        self.velocity = self.position = ZERO
        self.force = self.rate = None
        self.turned = None
        self.swing = self.stood = self.step = self.length = self.lasted = 0.0

    def told(self, attitude: Quat) -> None:
        self.given = attitude

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        self.bias.pass_time(dt)
        bx, by, bz = self.bias.bias
        ax, ay, az = acc
        actual = (ax + bx, ay + by, az + bz)  # (6), and (10) with the sign of (6): R (acc + a_b) - g = a_m + R a_b
        self.own = self.given is None
        if self.given is None:
            self.integrate(dt, actual, gyro)
        else:
            self.attitude = self._turned(self.given)
            self.given = None
            self.rate = None
            self.integrate(dt, actual, ZERO)
            self.rate = gyro
        # (4): a_m in the sensor frame is the specific force without the gravity that the attitude sees there
        self.measured = sub(acc, rotate(conjugate(self.attitude), (0.0, 0.0, GRAVITY)))
        if self.drift is not None and self.stood < STANDS:
            self._take_off_drift(dt)
        vx, vy, vz = self.velocity
        self.length += sqrt(vx * vx + vy * vy + vz * vz) * dt
        self.step = dt
        self.swing += dt
        self.lasted += dt

    def correct(self, t: float, stance: Stance) -> bool:
        if stance.sigma > self.trusted or stance.hint is Phase.SWING:
            self.stood = 0.0
            return False
        if self.spread:
            rx, ry, rz = stance.v_ref
            vx, vy, vz = self.velocity
            x, y, z = self.position
            half = 0.5 * self.swing
            self.position = (x + (rx - vx) * half, y + (ry - vy) * half, z + (rz - vz) * half)
        self.velocity = stance.v_ref
        self.swing = 0.0
        self.stood += self.step
        self.bias.stood(self.measured)
        if self.own:
            self._level(self.step)
        return True

    def bridge(self, dt: float) -> float:
        # nothing is estimated from noise here; the gap only makes the stretch less certain
        self.length += min(dt, LONGEST_BRIDGE) * 1.0
        if dt <= LONGEST_BRIDGE:
            return dt
        self.velocity = ZERO
        self.force = self.rate = None
        self.stood = self.swing = 0.0
        if dt == inf:  # a clock that begins anew may be that of a device that did, and its world with it
            self.turned = self.given = None
        return 0.0

    def leap(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self.length += sqrt(sum(v * v for v in sub(position, self.position)))
        self.lasted += dt
        self.swing += dt
        self.stood = 0.0
        self.attitude, self.velocity, self.position = attitude, velocity, position
        self.force = self.rate = None

    def anchor(self) -> tuple[float, ...]:
        stretch = self.covariance()
        self.length = self.lasted = 0.0
        return stretch

    def covariance(self) -> tuple[float, ...]:
        variance = (self.share * self.length) ** 2
        if self.turned is not None:
            # Each stretch has its heading anew, so what it is off by moves this stretch sideways and no other.
            variance += (self.turn_error * self.length) ** 2
            return (variance, 0.0, 0.0, variance, 0.0, variance, 0.0)
        yaw = self.turn_drift * self.turn_drift * self.lasted
        return (variance, 0.0, 0.0, variance, 0.0, variance, yaw)

    def _turned(self, given: Quat) -> Quat:
        """The device's own attitude in the navigation frame."""
        if self.turned is None:
            w, _, _, z = multiply(self.attitude, conjugate(given))
            self.turned = 2.0 * atan2(z, w)
        return normalise(multiply(from_yaw(self.turned), given))

    def _take_off_drift(self, dt: float) -> None:
        if self.drift is None:
            return
        dx, dy = self.drift
        if self.turned is not None:
            dx, dy, _ = rotate(from_yaw(self.turned), (dx, dy, 0.0))
        x, y, z = self.position
        self.position = (x - dx * dt, y - dy * dt, z)

    def _level(self, dt: float) -> None:
        """Turn the attitude so that the measured force points up, by 1 - exp(-rate dt) of the way. It is the force
        without the bias: with it, bias and tilt could drift against each other."""
        ax, ay, _ = rotate(self.attitude, self.measured)
        share = 0.5 * (1.0 - exp(-self.tilt_rate * min(dt, 0.1))) / GRAVITY
        self.attitude = tipped(self.attitude, share * ay, -share * ax)
