"""Nine-state error-state filter: errors of position, velocity and attitude, corrected by stance evidence.

Sources: Foxlin, "Pedestrian tracking with shoe-mounted inertial sensors" (2005) and Sola, "Quaternion kinematics for
the error-state Kalman filter" (arXiv:1711.02508, 2017, section 7 with global angular errors). The gyroscope bias is not
a state: it is learnt at rest (attitude.py), which costs less and, on short walks, errs less than a 15-state filter.

The covariance is propagated in one step from one correction to the next (propagated.py), so a swing costs no more than
its integration. An innovation gate rejects evidence that the motion so far makes too unlikely, because a slow swing can
look as still as a fast stance. A filter whose gate has rejected all evidence for some time is lost. It then accepts the
stillest moment that comes."""

from __future__ import annotations

from math import cos, inf, sin, sqrt
from typing import Final

from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, TIE, ZERO
from ..settings import ErrorStateSettings
from ..stance.stance import Stance
from .clipping import ClippedPeak
from .corrector import LONGEST_BRIDGE
from .covariance import HEIGHT, constrain_height, scale, squared_innovation, update
from .level import FLOOR_SIGMA, LevelGround
from .propagated import IndependentInterval, PropagatedCovariance
from .recovery import Recovery
from .stance_rhythm import StanceRhythm
from .strapdown import CONING, WIDEST_SERIES

STATIONARY: Final = Phase.STATIONARY
"""Local name of `Phase.STATIONARY`, because one look-up in the enum costs as much as five multiplications."""

REFERENCE_INTERVAL = 0.005
"""Interval between updates to which `Stance.sigma` refers, s; at other intervals the variance is scaled."""
SHORTEST_INTERVAL = 0.0035
"""Shortest interval between corrections, s, because neighbouring samples give the same evidence.

At 400 Hz every second sample corrects."""
EARLY_STANCE_TIME = 0.06
"""Time after the start of evidence at which the interval between corrections grows, s; chosen by hand."""
LATE_STANCE_INTERVAL = 0.0385
"""Shortest interval between corrections after EARLY_STANCE_TIME, s: every fourth sample at 100 Hz.

The interval hardly matters: with 5, 20 and 40 ms the ARMSE2d of `pyshoe_vicon` was 0.0503, 0.0500 and 0.0496 m."""

NO_STATISTIC = 1e12
"""Upper bound of any statistic, which stands for the least rejected one while none was rejected."""
LOST_STATISTIC_RATIO = 3.0
"""Largest ratio of a statistic that a lost filter accepts to the least statistic that its gate has rejected."""
EXPECTED_SQUARED_INNOVATION = 3.0
"""Mean of the squared innovation, weighted by its covariance, of a filter that is right: its degrees of freedom."""


@define
class ErrorStateFilter(PropagatedCovariance):
    """Strapdown navigation with stance evidence, weighted by the covariance of the motion so far.

    Frame and units are those of `Corrector`. Position and velocity are live with every sample, and corrected at the
    sample with the evidence.

    Numbers in this module without a source were chosen by hand on the recordings of docs/accuracy.md and not swept. A
    table in that document gives the accuracy of the default recipe without whole terms of the filter."""

    settings: ErrorStateSettings = ErrorStateSettings()
    level: LevelGround = field(factory=LevelGround, init=False)
    """Height correction of level walking."""
    accepted_at: float | None = field(default=None, init=False)
    """Time at which evidence was last accepted, s; None before any."""
    least_gated_statistic: float = field(default=NO_STATISTIC, init=False)
    """Smallest statistic that the gate has rejected since `accepted_at`."""
    evidence_since: float | None = field(default=None, init=False)
    """Start of the current unbroken evidence, s; None without evidence."""
    landing_error: Vec3 = field(default=ZERO, init=False)
    """Error of the velocity at the first accepted evidence of the newest stance, m/s; see `velocity_error`."""
    rhythm: StanceRhythm = field(factory=StanceRhythm, init=False)
    """Usual durations of stance and swing, for evidence that the gate rejects."""
    recovery: Recovery = field(factory=Recovery, init=False)
    """Recovery of the clipped peaks of both sensors."""
    interval: IndependentInterval = field(factory=IndependentInterval, init=False)
    """Interval between independent readings, for the noise of what lies between two samples."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        PropagatedCovariance.start(self, attitude, tilt_sigma)
        self.accepted_at = self.evidence_since = None
        self.least_gated_statistic = NO_STATISTIC

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        """Integrate one sample as in `Corrector`; this is `Strapdown.integrate` with the noise in one function.

        A call of `integrate` would cost 5 % of this function (tests/foot/test_alike.py checks that both are equal)."""
        gx, gy, gz = gyro
        fx, fy, fz = acc
        rate, previous_force, attitude = self.rate or gyro, self.force, self.attitude
        rx, ry, rz = rate
        rate_square = gx * gx + gy * gy + gz * gz
        # clipped peaks of the sensors
        recovery = self.recovery
        gyro_clipping, acc_clipping = recovery.gyro_clipping, recovery.acc_clipping
        dt_before, last_acc, earlier_acc = recovery.earlier_dt, recovery.last_acc, recovery.earlier_acc
        gyro_peaks = acc_peaks = None
        if (
            rate_square > gyro_clipping.near_end_square
            or fx * fx + fy * fy + fz * fz > acc_clipping.near_end_square
            or gyro_clipping.clipping
            or acc_clipping.clipping
            or recovery.swing.rows
        ):
            gyro_peaks, acc_peaks = recovery.watch(dt, acc, gyro, rate, attitude, saturated)
        else:  # far from the ends of the ranges: store only what `watch` would store
            recovery.earlier_acc, recovery.last_acc = recovery.last_acc, acc
            recovery.earlier_rate, recovery.earlier_dt = rate, dt
        # half the rotation vector by a rate that changes linearly, and its sin and cos by their series
        k, m = 0.25 * dt, CONING * dt * dt
        hx = k * (gx + rx) + m * (ry * gz - rz * gy)
        hy = k * (gy + ry) + m * (rz * gx - rx * gz)
        hz = k * (gz + rz) + m * (rx * gy - ry * gx)
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
        # the specific force in the navigation frame, q f q*
        tx = 2.0 * (y * fz - z * fy)
        ty = 2.0 * (z * fx - x * fz)
        tz = 2.0 * (x * fy - y * fx)
        fx = fx + w * tx + y * tz - z * ty
        fy = fy + w * ty + z * tx - x * tz
        fz = fz + w * tz + x * ty - y * tx
        self.rate, self.force = gyro, (fx, fy, fz)
        # trapezoidal rule: a = (f + f_previous) / 2 - g, v <- v + a dt, p <- p + (v + v_previous) dt / 2
        if previous_force is None:
            ax, ay, az, x, y, z = fx, fy, fz - GRAVITY, fx, fy, fz
            ratio = 1.0
        else:
            px, py, pz = previous_force
            ax, ay, az = 0.5 * (fx + px), 0.5 * (fy + py), 0.5 * (fz + pz) - GRAVITY
            x, y, z = fx - px, fy - py, fz - pz
            ratio = self.interval.update(dt, acc, dt_before, last_acc, earlier_acc)
        vx, vy, vz = self.velocity
        ux, uy, uz = vx + ax * dt, vy + ay * dt, vz + az * dt
        px, py, pz = self.position
        k = 0.5 * dt
        self.position = (px + (vx + ux) * k, py + (vy + uy) * k, pz + (vz + uz) * k)
        self.velocity = (ux, uy, uz)
        # noise of the sensor, noise that grows with the motion, and noise from the motion between independent readings:
        # T / dt times the difference and the duration of a sample, in dt / T times as many (IndependentInterval)
        rx, ry, rz = gx - rx, gy - ry, gz - rz
        settings = self.settings
        motion_factor, difference_factor = (
            settings.noise_per_motion * settings.noise_per_motion,
            settings.noise_per_difference * settings.noise_per_difference * dt * ratio * ratio * ratio,
        )
        self.acc_variance += (
            settings.acc_noise * settings.acc_noise
            + motion_factor * (ax * ax + ay * ay + az * az)
            + difference_factor * (x * x + y * y + z * z)
        ) * dt
        noise = (
            settings.gyro_noise * settings.gyro_noise
            + motion_factor * rate_square
            + difference_factor * (rx * rx + ry * ry + rz * rz)
        )
        if rate_square > settings.clipping_rate * settings.clipping_rate and not (
            gyro_clipping.clipping and settings.recover
        ):
            noise += settings.clipping_noise * settings.clipping_noise
        self.gyro_variance += noise * dt
        self.elapsed += dt
        self.time_since_anchor += dt
        if (gyro_peaks or acc_peaks) and settings.recover:
            self._add_peaks(gyro_peaks, acc_peaks)

    def _add_peaks(self, gyro_peaks: tuple[ClippedPeak, ...] | None, acc_peaks: tuple[ClippedPeak, ...] | None) -> None:
        """Correct the state by the clipped peaks of gyroscope and accelerometer."""
        self._propagate()
        state = (self.attitude, self.velocity, self.position, self.uncertainty)
        if gyro_peaks:
            state = self.recovery.add_turns(gyro_peaks, state)
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
        if self.elapsed < (
            SHORTEST_INTERVAL if t - self.evidence_since < EARLY_STANCE_TIME - TIE else LATE_STANCE_INTERVAL
        ):
            return (
                self.accepted_at is not None and self.least_gated_statistic >= NO_STATISTIC
            )  # same result as for the last sample
        settings = self.settings
        share = settings.tilt_rate * min(self.elapsed, LATE_STANCE_INTERVAL)
        r = sigma * sigma * REFERENCE_INTERVAL / self.elapsed
        self._propagate()
        stands = stance.hint is STATIONARY
        if self.accepted_at is None:
            self.accepted_at = t
        rx, ry, rz = stance.v_ref
        vx, vy, vz = self.velocity
        is_lost = (
            not stands
            and t - self.accepted_at > settings.time_until_lost - TIE
            and stance.statistic <= LOST_STATISTIC_RATIO * self.least_gated_statistic
        )
        if is_lost or self._stands_after_all(t, self.evidence_since, self.accepted_at):
            # The foot stands, so the motion since the last stance was less certain than its covariance says. The whole
            # covariance is scaled, so that the position is corrected too: its error has the same cause.
            squared = squared_innovation(self.uncertainty, rx - vx, ry - vy, rz - vz, r)
            if squared > EXPECTED_SQUARED_INNOVATION:
                self.uncertainty = scale(self.uncertainty, squared / EXPECTED_SQUARED_INNOVATION)
        outcome = update(self.uncertainty, rx - vx, ry - vy, rz - vz, r, inf if stands else settings.innovation_gate)
        if outcome is None:
            self.least_gated_statistic = min(self.least_gated_statistic, stance.statistic)
            return False
        self.uncertainty, error = outcome
        tx, ty = self._tilt_correction(share) if stands else (0.0, 0.0)
        self._inject(error, tx, ty)
        self.rhythm.add(t, self.accepted_at)
        if self.accepted_at < self.evidence_since:
            self.landing_error = (vx - rx, vy - ry, vz - rz)
        self.accepted_at = t
        self.least_gated_statistic = NO_STATISTIC
        return True

    def _stands_after_all(self, t: float, evidence_since: float, accepted_at: float) -> bool:
        """Return whether evidence that the gate rejects has lasted so long that the foot stands."""
        share, longest = self.settings.stance_share, self.settings.time_until_ungated
        if accepted_at >= evidence_since:  # the gate let the start of this stance pass
            return t - accepted_at > self.rhythm.time_until_stance(inf, share, longest) - TIE
        until = self.rhythm.time_until_stance(evidence_since - accepted_at, share, longest)
        return t - evidence_since > until - TIE

    @property
    def velocity_error(self) -> Vec3:
        return self.landing_error

    def bridge(self, dt: float) -> float:
        if dt > LONGEST_BRIDGE:
            self.recovery.reset()
        if dt == inf:  # times restart
            self.accepted_at = self.evidence_since = None
            self.rhythm.reset()
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
        # tilt and velocity stay, because the removed height is a systematic error and not caused by theirs
        self.position = self.start_position = (x, y, sz + height)
        least = FLOOR_SIGMA * FLOOR_SIGMA
        if variance > least:
            self.uncertainty = constrain_height(self.uncertainty, 1.0 - level * (1.0 - least / variance))

    def anchor(self) -> tuple[float, ...]:
        self.recovery.end_stride()
        return PropagatedCovariance.anchor(self)

    def _tilt_correction(self, share: float) -> tuple[float, float]:
        """Return `share` (0 to 1) of the turn about x and y, f x up / g, rad, that makes the force f point up.

        This correction of the tilt is outside the covariance on purpose: a standing foot trembles. The correction has a
        time constant of half a second, so it averages the trembling. A Kalman update would take the trembling for
        independent measurements."""
        if self.force is None:
            return 0.0, 0.0
        fx, fy, _ = self.force
        return share * fy / GRAVITY, -share * fx / GRAVITY
