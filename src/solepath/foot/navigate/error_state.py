"""The nine-state error-state filter: position, velocity and attitude errors, corrected by stance evidence.

After Foxlin, "Pedestrian tracking with shoe-mounted inertial sensors" (2005) and Sola, "Quaternion kinematics for the
error-state Kalman filter" (arXiv:1711.02508, 2017, section 7 with global angular errors). Gyroscope bias is not a
state: it is learnt at rest (attitude.py), which costs less and, on short walks, errs less than a 15-state filter.

Between corrections the covariance is carried in one stroke (carried.py), so a swing costs no more than its
integration. Evidence that the motion so far makes too unlikely is refused, since a slow swing can look as still as a
fast stance; but a filter that has refused everything for a while is lost and takes the quietest moment there is.
"""

from __future__ import annotations

from math import cos, inf, sin, sqrt
from typing import Final

from attrs import define, field

from ...types import Phase, Quat, Vec3
from ...types.vector import GRAVITY, TIE, ZERO
from ..stance.stance import Stance
from .clipping import Missed
from .corrector import LONGEST_BRIDGE
from .covariance import (
    HEIGHT,
    TILT_X,
    TILT_Y,
    VELOCITY_X,
    VELOCITY_Y,
    VELOCITY_Z,
    YAW,
    Covariance,
    believed_height,
    update,
)
from .level import LevelGround
from .propagated import Carried
from .recovery import Recovery
from .strapdown import WIDEST_SERIES, Strapdown

STATIONARY: Final = Phase.STATIONARY
"""Looked up once: a word of an enum costs as much as five multiplications."""

REFERENCE_INTERVAL = 0.005
"""The spacing of updates that a Stance's sigma is meant for, s; other spacings scale its variance."""
SHORTEST_INTERVAL = 0.0035
"""Corrections closer together than this are left out: neighbouring samples say the same, s."""
SETTLED = 0.06
"""After so much of a stance corrections are as close as this no longer, s,"""
SETTLED_INTERVAL = 0.0385
"""but as this: every fourth sample at 100 Hz. What they correct has hardly grown in between, s."""


@define
class ErrorStateFilter(Carried):
    """Strapdown navigation corrected by stance evidence, weighted by what the motion so far makes likely.

    Frame, units and latency as in `Corrector`: live position and velocity with every sample, corrected with the sample
    that brings the evidence.
    """

    acc_noise: float = 0.02
    """Accelerometer noise with all that stands for it (scale, g-sensitivity), m/s^2/sqrt(Hz)."""
    gyro_noise: float = 0.003
    """Gyroscope noise, rad/s/sqrt(Hz)."""
    in_motion: float = 0.001
    """Added noise as a share of the motion: scale and alignment errors, 1/sqrt(Hz)."""
    between: float = 0.25
    """What two neighbouring samples differ by and the straight line between them cannot know, as a share of it. Small
    at 400 Hz; at 20 Hz, where a heel-strike falls between two samples, all that there is."""
    recover: bool = True
    """Make up for the turn that a gyroscope at the end of its range missed (clipping.py, missed.py)."""
    suspect: float = 8.5
    """Rates beyond this may be clipped though no end of a range is seen (axes that were turned since, by a
    calibration), rad/s."""
    suspect_noise: float = 0.2
    """Noise of such a rate, rad/s/sqrt(Hz)."""
    heading_drift: float = 0.004
    """Growth of the heading error, rad/sqrt(s): half a degree in the first four seconds, two in a minute. What the
    noise above makes of yaw is not it: that noise is there to keep tilt correctable, and over a step it cancels."""
    refuse: float = 12.0
    """Largest normalised innovation squared (chi-square, three degrees of freedom)."""
    patience: float = 2.0
    """After refusing everything for this long the filter is lost, s."""
    lasting: float = 0.35
    """Evidence that goes on for this long is not refused any longer, s."""
    tilt_rate: float = 2.0
    """How fast gravity pulls the tilt upright while the evidence is certain, 1/s."""
    leap_velocity: float = 0.3
    """What a stride taken by habit may differ by, m/s, rad and rad."""
    leap_tilt: float = 0.1
    leap_yaw: float = 0.06
    level: LevelGround = field(factory=LevelGround)
    """What keeps level walking level."""
    # state
    stretch: float = field(default=0.0, init=False)
    """Time since the last anchor, s."""
    accepted: float | None = field(default=None, init=False)
    quietest: float = field(default=1e12, init=False)
    quiet_since: float | None = field(default=None, init=False)
    recovery: Recovery = field(factory=Recovery, init=False)

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.attitude = attitude
        self.velocity = self.position = self.start_velocity = self.start_position = ZERO
        self.force = self.rate = None
        covariance = [0.0] * 45
        # who was not seen to lie still may be moving
        speed = 0.01 if tilt_sigma < 0.03 else 2.0 * tilt_sigma
        covariance[VELOCITY_X] = covariance[VELOCITY_Y] = covariance[VELOCITY_Z] = speed * speed
        covariance[TILT_X] = covariance[TILT_Y] = tilt_sigma * tilt_sigma
        self.uncertainty = tuple(covariance)
        self.since = self.stretch = self.acc_variance = self.gyro_variance = 0.0
        self.accepted = self.quiet_since = None
        self.quietest = 1e12

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        """As in `Corrector`: `Strapdown.integrate` and the noise that it adds, in one stroke."""
        gx, gy, gz = gyro
        fx, fy, fz = acc
        rate, was, attitude = self.rate or gyro, self.force, self.attitude
        rx, ry, rz = rate
        turning = gx * gx + gy * gy + gz * gz
        # what the sensors may miss at the ends of their ranges
        recovery = self.recovery
        turns, blows = recovery.turns, recovery.blows
        missed = lost = None
        if (
            turning > turns.watch
            or fx * fx + fy * fy + fz * fz > blows.watch
            or turns.busy
            or blows.busy
            or recovery.swing.rows
        ):
            missed, lost = recovery.watch(dt, acc, gyro, rate, attitude, saturated)
        else:  # far from them: what `watch` keeps
            recovery.felt_before, recovery.felt = recovery.felt, acc
            recovery.earlier, recovery.earlier_dt = rate, dt
        # half the turn by the mean rate, and its sin and cos by their series
        k = 0.25 * dt
        hx, hy, hz = k * (gx + rx), k * (gy + ry), k * (gz + rz)
        n = hx * hx + hy * hy + hz * hz
        if n < WIDEST_SERIES:
            c = 1.0 - n * (0.5 - n * (1.0 / 24.0 - n * (1.0 / 720.0 - n / 40320.0)))
            s = 1.0 - n * (1.0 / 6.0 - n * (1.0 / 120.0 - n * (1.0 / 5040.0 - n / 362880.0)))
        else:
            angle = sqrt(n)
            c, s = cos(angle), sin(angle) / angle
        hx *= s
        hy *= s
        hz *= s
        # q <- q (c, h), one Newton step towards length 1
        w, x, y, z = attitude
        qw = w * c - x * hx - y * hy - z * hz
        qx = w * hx + x * c + y * hz - z * hy
        qy = w * hy - x * hz + y * c + z * hx
        qz = w * hz + x * hy - y * hx + z * c
        k = 1.5 - 0.5 * (qw * qw + qx * qx + qy * qy + qz * qz)
        w = qw * k
        x = qx * k
        y = qy * k
        z = qz * k
        self.attitude = (w, x, y, z)
        # the specific force in this frame, q f q*
        tx = 2.0 * (y * fz - z * fy)
        ty = 2.0 * (z * fx - x * fz)
        tz = 2.0 * (x * fy - y * fx)
        fx = fx + w * tx + y * tz - z * ty
        fy = fy + w * ty + z * tx - x * tz
        fz = fz + w * tz + x * ty - y * tx
        self.rate, self.force = gyro, (fx, fy, fz)
        # trapezoidal rule: a = (f + f before) / 2 - g, v <- v + a dt, p <- p + (v + v before) dt / 2
        if was is None:
            ax, ay, az, x, y, z = fx, fy, fz - GRAVITY, fx, fy, fz
        else:
            px, py, pz = was
            ax, ay, az = 0.5 * (fx + px), 0.5 * (fy + py), 0.5 * (fz + pz) - GRAVITY
            x, y, z = fx - px, fy - py, fz - pz
        vx, vy, vz = self.velocity
        ux, uy, uz = vx + ax * dt, vy + ay * dt, vz + az * dt
        px, py, pz = self.position
        k = 0.5 * dt
        self.position = (px + (vx + ux) * k, py + (vy + uy) * k, pz + (vz + uz) * k)
        self.velocity = (ux, uy, uz)
        # noise: the sensor's own, a share of the motion, and of what neighbouring samples differ by
        rx, ry, rz = gx - rx, gy - ry, gz - rz
        share, unknown = self.in_motion * self.in_motion, self.between * self.between * dt
        self.acc_variance += (
            self.acc_noise * self.acc_noise + share * (ax * ax + ay * ay + az * az) + unknown * (x * x + y * y + z * z)
        ) * dt
        noise = self.gyro_noise * self.gyro_noise + share * turning + unknown * (rx * rx + ry * ry + rz * rz)
        if turning > self.suspect * self.suspect and not (turns.busy and self.recover):
            noise += self.suspect_noise * self.suspect_noise
        self.gyro_variance += noise * dt
        self.since += dt
        self.stretch += dt
        if (missed or lost) and self.recover:
            self._make_up(missed, lost)

    def _make_up(self, missed: tuple[Missed, ...] | None, lost: tuple[Missed, ...] | None) -> None:
        """What gyroscope and accelerometer turned out to have missed."""
        self._carry()
        state = (self.attitude, self.velocity, self.position, self.uncertainty)
        if missed:
            state = self.recovery.turned(missed, state)
        if lost:
            state = self.recovery.struck(lost, state)
        self.attitude, self.velocity, self.position, self.uncertainty = state
        self._here()

    def correct(self, t: float, stance: Stance) -> bool:
        sigma = stance.sigma
        if sigma == inf:
            self.quiet_since = None
            return False
        if self.quiet_since is None:
            self.quiet_since = t
        if self.since < (SHORTEST_INTERVAL if t - self.quiet_since < SETTLED - TIE else SETTLED_INTERVAL):
            return self.accepted is not None and self.quietest >= 1e12  # as the sample before was judged
        share = self.tilt_rate * min(self.since, SETTLED_INTERVAL)
        r = sigma * sigma * REFERENCE_INTERVAL / self.since
        self._carry()
        certain = stance.hint is STATIONARY
        if self.accepted is None:
            self.accepted = t
        rx, ry, rz = stance.v_ref
        vx, vy, vz = self.velocity
        if not certain and t - self.accepted > self.patience - TIE and stance.statistic <= 3.0 * self.quietest:
            self._doubt(velocity=0.3, tilt=0.03)
        elif min(t - self.quiet_since, t - self.accepted) > self.lasting - TIE:
            # not even a foot that is carried is quiet for so long: it stands, and the velocity is what is wrong
            self._doubt(velocity=abs(vx - rx) + abs(vy - ry) + abs(vz - rz), tilt=0.1)
        outcome = update(self.uncertainty, rx - vx, ry - vy, rz - vz, r, inf if certain else self.refuse)
        if outcome is None:
            self.quietest = min(self.quietest, stance.statistic)
            return False
        self.uncertainty, error = outcome
        tx, ty = self._off_plumb(share) if certain else (0.0, 0.0)
        self._inject(error, tx, ty)
        self.accepted = t
        self.quietest = 1e12
        return True

    def bridge(self, dt: float) -> float:
        # a foot accelerates by some 10 m/s^2 and turns by some rad/s; what happened in between is anyone's guess
        if dt <= LONGEST_BRIDGE:
            self.acc_variance += 4.0 * dt
            self.gyro_variance += 0.25 * dt
            return dt
        self.recovery.interrupt()
        self._carry()
        if dt == inf:  # times begin anew
            self.accepted = self.quiet_since = None
        self.velocity = self.start_velocity = ZERO
        self.force = self.rate = None
        self._doubt(velocity=1.0, tilt=0.2)
        # it may have gone on as it was going, or have stopped: metres either way, but hardly up or down
        far = 1.5 * min(dt, 2.0)
        covariance = list(self.uncertainty)
        covariance[0] += far * far
        covariance[3] += far * far
        covariance[5] += 0.04 * far * far
        self.uncertainty = tuple(covariance)
        return 0.0

    def leap(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self.recovery.interrupt()
        self._carry()
        self.stretch += dt
        self.attitude, self.velocity, self.position = attitude, velocity, position
        self.force = self.rate = None
        self._here()
        # two strides differ by some per cent
        self._doubt(velocity=self.leap_velocity, tilt=self.leap_tilt)
        covariance = list(self.uncertainty)
        for i in (0, 3, 5):
            covariance[i] += 0.0025
        covariance[YAW] += self.leap_yaw * self.leap_yaw
        self.uncertainty = tuple(covariance)

    def mend(self, yaw: float, position: Vec3) -> None:
        self._carry()
        Strapdown.mend(self, yaw, position)
        self._here()

    def shift(self, yaw: float, by: Vec3) -> None:
        """Turn everything by `yaw` rad about the foot and move it `by` m, navigation frame: nothing has happened."""
        self._carry()
        self.turn_about(yaw, by)
        self._here()

    def flat(self, start: Vec3, turn: float) -> None:
        if not self.level.gate:
            return
        self._carry()
        (x, y, z), (sx, sy, sz) = self.position, start
        variance = self.uncertainty[HEIGHT]
        height, level = self.level.judge((x - sx, y - sy, z - sz), turn, variance, self.attitude)
        # tilt and velocity are left out of it: what heights have in common is no random error of theirs
        self.position = self.start_position = (x, y, sz + height)
        least = self.level.uneven * self.level.uneven
        if variance > least:
            self.uncertainty = believed_height(self.uncertainty, 1.0 - level * (1.0 - least / variance))

    def anchor(self) -> tuple[float, ...]:
        self.recovery.stepped()
        self._carry()
        stretch = self._stretch(self.uncertainty)
        self.stretch = 0.0
        covariance = list(self.uncertainty)
        # position and yaw are exact again by definition, so nothing is correlated with them: pp, pv, pt and all of yaw
        for i in (*range(24), 32, 35, 38, 41, 43, 44):
            covariance[i] = 0.0
        self.uncertainty = tuple(covariance)
        return stretch

    def covariance(self) -> tuple[float, ...]:
        return self._stretch(self._carried() if self.since > 0.0 else self.uncertainty)

    def _stretch(self, covariance: Covariance) -> tuple[float, ...]:
        return (*covariance[:6], self.heading_drift * self.heading_drift * self.stretch)

    def _off_plumb(self, share: float) -> tuple[float, float]:
        """Tilt aiding: this share of the turn, f x up / g, that would make the measured force point up, rad.

        Outside the covariance on purpose: a foot that stands is loaded and trembles, and the lag of this pull, half a
        second, averages what a Kalman update would take for independent measurements.
        """
        if self.force is None:
            return 0.0, 0.0
        fx, fy, _ = self.force
        return share * fy / GRAVITY, -share * fx / GRAVITY
