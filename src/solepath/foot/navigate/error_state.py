"""Nine-state error-state filter: errors of position, velocity and attitude, corrected by stance evidence.

Sources: Foxlin, "Pedestrian tracking with shoe-mounted inertial sensors" (2005) and Sola, "Quaternion kinematics for
the error-state Kalman filter" (arXiv:1711.02508, 2017, section 7 with global angular errors). The gyroscope bias is not
a state: it is learnt at rest (attitude.py), which costs less and, on short walks, errs less than a 15-state filter.

Between corrections the covariance is propagated at once (propagated.py), so a swing costs no more than its integration.
An innovation gate rejects evidence that the motion so far makes too unlikely, because a slow swing can look as still as
a fast stance. A filter that has gated everything for some time is lost and takes the most still moment there is."""

from __future__ import annotations

from math import cos, inf, sin, sqrt
from typing import Final

from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, TIE
from ..settings import ErrorStateSettings
from ..stance.stance import Stance
from .clipping import ClippedPeak
from .corrector import LONGEST_BRIDGE
from .covariance import HEIGHT, constrain_height, update
from .level import UNEVEN, LevelGround
from .propagated import PropagatedCovariance
from .recovery import Recovery
from .strapdown import WIDEST_SERIES

STATIONARY: Final = Phase.STATIONARY
"""Local name of `Phase.STATIONARY`, because one look-up in the enum costs as much as five multiplications."""

REFERENCE_INTERVAL = 0.005
"""Interval of updates for which the sigma of a Stance is meant, s; other intervals scale its variance."""
SHORTEST_INTERVAL = 0.0035
"""Shortest interval between corrections, s, because neighbouring samples give the same evidence.

At 400 Hz every second sample corrects."""
SETTLED = 0.06
"""Time after the start of a stance at which the interval between corrections grows, s; chosen by hand."""
SETTLED_INTERVAL = 0.0385
"""Interval between corrections from then on, s: every fourth sample at 100 Hz.

The error has hardly grown in between: with 5, 20 and 40 ms the ARMSE2d of `pyshoe_vicon` was 0.0503, 0.0500 and 0.0496
m."""

NONE_GATED = 1e12
"""Upper bound of any statistic."""
LOST_STATISTIC_RATIO = 3.0
"""Largest ratio of a statistic that a lost filter accepts to the least one that it has gated."""
LOST_SPEED, LOST_TILT = 0.3, 0.03
"""Standard deviations that inflate the covariance of a lost filter: velocity, m/s, and tilt, rad."""
LASTING_TILT = 0.1
"""Standard deviation that inflates the tilt when evidence lasts, rad.

The velocity is inflated by its whole difference from the evidence."""


@define
class ErrorStateFilter(PropagatedCovariance):
    """Strapdown navigation with stance evidence, weighted by the covariance of the motion so far.

    Frame, units and latency as in `Corrector`: live position and velocity with every sample, corrected at the sample
    with the evidence.

    Numbers in this module without source were chosen by hand on the recordings of docs/accuracy.md and not swept. The
    table of the default without one of its parts in that document gives the effect of whole terms."""

    settings: ErrorStateSettings = ErrorStateSettings()
    level: LevelGround = field(factory=LevelGround, init=False)
    """Height correction of level walking."""
    accepted: float | None = field(default=None, init=False)
    """Time at which evidence was last accepted, s; None before any."""
    least_gated: float = field(default=NONE_GATED, init=False)
    """Smallest statistic that was gated since then."""
    evidence_since: float | None = field(default=None, init=False)
    """Start of the current unbroken evidence, s; None without evidence."""
    recovery: Recovery = field(factory=Recovery, init=False)
    """Recovery of the clipped peaks of both sensors."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        PropagatedCovariance.start(self, attitude, tilt_sigma)
        self.accepted = self.evidence_since = None
        self.least_gated = NONE_GATED

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        """Integrate one sample as in `Corrector`: `Strapdown.integrate` and its noise in one function.

        A call of `integrate` would cost 5 % of this function (tests/foot/test_alike.py checks that both are equal)."""
        gx, gy, gz = gyro
        fx, fy, fz = acc
        rate, previous_force, attitude = self.rate or gyro, self.force, self.attitude
        rx, ry, rz = rate
        turning = gx * gx + gy * gy + gz * gz
        # clipped peaks of the sensors
        recovery = self.recovery
        turns, impacts = recovery.turns, recovery.impacts
        peaks = acc_peaks = None
        if (
            turning > turns.watch_square
            or fx * fx + fy * fy + fz * fz > impacts.watch_square
            or turns.clipping
            or impacts.clipping
            or recovery.swing.rows
        ):
            peaks, acc_peaks = recovery.watch(dt, acc, gyro, rate, attitude, saturated)
        else:  # far from the ends of the ranges: store only what `watch` would store
            recovery.earlier_acc, recovery.last_acc = recovery.last_acc, acc
            recovery.earlier_rate, recovery.earlier_dt = rate, dt
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
        if previous_force is None:
            ax, ay, az, x, y, z = fx, fy, fz - GRAVITY, fx, fy, fz
        else:
            px, py, pz = previous_force
            ax, ay, az = 0.5 * (fx + px), 0.5 * (fy + py), 0.5 * (fz + pz) - GRAVITY
            x, y, z = fx - px, fy - py, fz - pz
        vx, vy, vz = self.velocity
        ux, uy, uz = vx + ax * dt, vy + ay * dt, vz + az * dt
        px, py, pz = self.position
        k = 0.5 * dt
        self.position = (px + (vx + ux) * k, py + (vy + uy) * k, pz + (vz + uz) * k)
        self.velocity = (ux, uy, uz)
        # noise of the sensor, a share of the motion, and a share of the difference of neighbouring samples
        rx, ry, rz = gx - rx, gy - ry, gz - rz
        settings = self.settings
        share, unknown = settings.noise_per_motion * settings.noise_per_motion, settings.between * settings.between * dt
        self.acc_variance += (
            settings.acc_noise * settings.acc_noise
            + share * (ax * ax + ay * ay + az * az)
            + unknown * (x * x + y * y + z * z)
        ) * dt
        noise = settings.gyro_noise * settings.gyro_noise + share * turning + unknown * (rx * rx + ry * ry + rz * rz)
        if turning > settings.clipping_rate * settings.clipping_rate and not (turns.clipping and settings.recover):
            noise += settings.clipping_noise * settings.clipping_noise
        self.gyro_variance += noise * dt
        self.since += dt
        self.stretch += dt
        if (peaks or acc_peaks) and settings.recover:
            self._add_peaks(peaks, acc_peaks)

    def _add_peaks(self, peaks: tuple[ClippedPeak, ...] | None, acc_peaks: tuple[ClippedPeak, ...] | None) -> None:
        """Correct the state by the clipped peaks of gyroscope and accelerometer."""
        self._propagate()
        state = (self.attitude, self.velocity, self.position, self.uncertainty)
        if peaks:
            state = self.recovery.add_turns(peaks, state)
        if acc_peaks:
            state = self.recovery.add_velocities(acc_peaks, state)
        self.attitude, self.velocity, self.position, self.uncertainty = state
        self._mark_start()

    def correct(self, t: float, stance: Stance) -> bool:
        sigma = stance.sigma
        if sigma == inf:
            self.evidence_since = None
            return False
        if self.evidence_since is None:
            self.evidence_since = t
        if self.since < (SHORTEST_INTERVAL if t - self.evidence_since < SETTLED - TIE else SETTLED_INTERVAL):
            return self.accepted is not None and self.least_gated >= NONE_GATED  # same result as for the last sample
        settings = self.settings
        share = settings.tilt_rate * min(self.since, SETTLED_INTERVAL)
        r = sigma * sigma * REFERENCE_INTERVAL / self.since
        self._propagate()
        certain = stance.hint is STATIONARY
        if self.accepted is None:
            self.accepted = t
        rx, ry, rz = stance.v_ref
        vx, vy, vz = self.velocity
        if (
            not certain
            and t - self.accepted > settings.patience - TIE
            and stance.statistic <= LOST_STATISTIC_RATIO * self.least_gated
        ):
            self._inflate(velocity=LOST_SPEED, tilt=LOST_TILT)
        elif min(t - self.evidence_since, t - self.accepted) > settings.lasting - TIE:
            # not even a foot that is lifted is still for so long: it stands, so the velocity is wrong
            self._inflate(velocity=abs(vx - rx) + abs(vy - ry) + abs(vz - rz), tilt=LASTING_TILT)
        outcome = update(self.uncertainty, rx - vx, ry - vy, rz - vz, r, inf if certain else settings.innovation_gate)
        if outcome is None:
            self.least_gated = min(self.least_gated, stance.statistic)
            return False
        self.uncertainty, error = outcome
        tx, ty = self._tilt_correction(share) if certain else (0.0, 0.0)
        self._inject(error, tx, ty)
        self.accepted = t
        self.least_gated = NONE_GATED
        return True

    def bridge(self, dt: float) -> float:
        if dt > LONGEST_BRIDGE:
            self.recovery.reset()
        if dt == inf:  # times restart
            self.accepted = self.evidence_since = None
        return PropagatedCovariance.bridge(self, dt)

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        self.recovery.reset()
        PropagatedCovariance.infill(self, dt, attitude, velocity, position)

    def flat(self, start: Vec3, turn: float) -> None:
        if not self.settings.level:
            return
        self._propagate()
        (x, y, z), (sx, sy, sz) = self.position, start
        variance = self.uncertainty[HEIGHT]
        height, level = self.level.judge((x - sx, y - sy, z - sz), turn, variance, self.attitude)
        # tilt and velocity stay, because the common part of the heights is not their random error
        self.position = self.start_position = (x, y, sz + height)
        least = UNEVEN * UNEVEN
        if variance > least:
            self.uncertainty = constrain_height(self.uncertainty, 1.0 - level * (1.0 - least / variance))

    def anchor(self) -> tuple[float, ...]:
        self.recovery.end_stride()
        return PropagatedCovariance.anchor(self)

    def _tilt_correction(self, share: float) -> tuple[float, float]:
        """Return `share` of the turn, f x up / g, that would make the measured force point up, rad.

        This tilt aiding is outside the covariance on purpose. A foot that stands is loaded and trembles. The lag of
        this correction, half a second, averages the trembling, which a Kalman update would take for independent
        measurements."""
        if self.force is None:
            return 0.0, 0.0
        fx, fy, _ = self.force
        return share * fy / GRAVITY, -share * fx / GRAVITY
