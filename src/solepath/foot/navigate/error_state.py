"""Nine-state error-state filter: errors of position, velocity and attitude, corrected by stance evidence.

Sources: Foxlin, "Pedestrian tracking with shoe-mounted inertial sensors" (2005) and Sola, "Quaternion kinematics for
the error-state Kalman filter" (arXiv:1711.02508, 2017, section 7 with global angular errors). The gyroscope bias is not
a state: it is learnt at rest (attitude.py), which costs less and, on short walks, errs less than a 15-state filter.

The covariance is propagated in one step from one correction to the next (covariance.py), so a
swing costs no more than its integration. An innovation gate rejects evidence that the motion so far makes too unlikely,
because a slow swing can look as still as a fast stance. A foot whose evidence is rejected for as long as a stance lasts
stands after all."""

from __future__ import annotations

from math import inf, sqrt
from typing import TYPE_CHECKING

from ...types import Floats, Quat, Vec3
from ...types.attrs import define, field, state, stateful
from ...types.vector import GRAVITY, TIME_EPSILON, ZERO, scaled, sub, tipped
from ..phase import STATIONARY
from ..rhythm import StanceRhythm
from ..settings import ErrorStateSettings
from ..stance.stance import Stance
from .corrector import LONGEST_BRIDGE
from .covariance import (
    HEIGHT,
    Correction,
    Covariance,
    constrain_height,
    forget_position_and_yaw,
    inflate,
    propagate,
    scale,
    squared_innovation,
    update,
)
from .level import FLOOR_SIGMA, LevelGround
from .strapdown import Strapdown

if TYPE_CHECKING:
    from .clipping import ClippedPeaks, Recovery

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

EXPECTED_SQUARED_INNOVATION = 3.0
"""Mean of the squared innovation, weighted by its covariance, of a filter that is right: its degrees of freedom."""


LARGEST_REST_TILT = 0.03
"""Standard deviation of the first tilt below which it was measured at rest, rad.

attitude.py gives 0.02 at rest, otherwise 0.06 or 0.2."""
SPEED_AT_REST = 0.01
"""Standard deviation of the initial speed of a foot at rest, m/s."""
SPEED_PER_TILT = 2.0
"""Standard deviation of the initial speed of a foot not at rest, for each rad of that of the tilt, m/s.

It is 0.12 m/s in mid-stance and 0.4 m/s at any other moment."""


BRIDGED_VELOCITY, BRIDGED_ANGLE = 30.0, 15.0
"""Standard deviation of velocity, m/s^3, and angle, rad/s^2, after a bridged gap, for each square of its duration.

Force and rate are integrated as if they changed steadily in a gap, so that its error grows with the square: a gap of
20 ms adds 0.01 m/s, one of 60 ms 0.1 m/s. The table of `solepath-lab damage losses` shows how far that holds."""
GAP_SPEED, GAP_TILT = 1.0, 0.2
"""Standard deviation of velocity, m/s, and tilt, rad, after a gap that was not bridged."""
GAP_WALKING_SPEED, LONGEST_GAP_WALK = 1.5, 2.0
"""Speed at which a foot may have moved on in a gap that was not bridged, m/s, and longest time for which it did, s.

It may have stopped as well."""
GAP_RISE_RATIO = 0.04
"""Ratio of the variance of the height to that of the position after such a gap.

A foot moves a fifth as far up or down as along the ground."""
INFILL_POSITION_VARIANCE = 0.0025
"""Variance of each axis of the position after infill, m^2: that of 5 cm, because strides differ by some per cent."""
INFILL_SPEED_SIGMA = 1.0
"""Standard deviation of the mean speed in a filled gap, m/s (`solepath-lab damage losses`)."""
HEADING_DRIFT = 0.004
"""Growth of the heading error, rad/sqrt(s): half a degree in the first four seconds, two degrees in a minute.

The process noise of yaw is another number: it keeps the tilt correctable and cancels over a stride."""
INFILL_VELOCITY_SIGMA = 0.3
"""Standard deviation of the velocity after infill, m/s."""
INFILL_TILT_SIGMA = 0.1
"""Standard deviation of the tilt after infill, rad."""
INFILL_YAW_SIGMA = 0.06
"""Standard deviation of the heading after infill, rad."""
INTERVAL_RATIO = 1.3
"""Factor k of the interval between independent readings (IndependentInterval), below sqrt(2); no unit.

From 1.2 to 1.4 `ms_patient` has the same strides at 2, 3 and 4 times its rate. Up to 1.3 the ARMSE2d of `pyshoe_vicon`
is 0.0529 m as without this interval, at sqrt(2) it is 0.0539 m."""
LONGEST_INTERVAL = 0.05
"""Longest interval between independent readings, s: that of 20 Hz, the lowest rate for which the noise was chosen."""
MEMORY_TIME = 2.0
"""Time constant of the sums of an IndependentInterval, s: about two strides, so that each sum has some impacts."""


@define
class IndependentInterval:
    """Learns the interval between independent readings, which is longer than dt for a sensor read beyond its bandwidth.

    The filter knows what lies between two samples only by their difference: the larger it is, the larger may be the
    error of a straight line between them. Readings that are interpolated, or faster than the bandwidth of the sensor,
    show small differences although they show no more of an impact than at a lower rate. The noise would vanish with the
    third power of dt, and a landing that was measured badly would look like a swing (`ms_patient` at 102 Hz,
    interpolated to 410 Hz: the standard deviation of the vertical velocity at a landing fell from 0.37 to 0.06 m/s, its
    error stayed 0.9 m/s, and the gate rejected every sixth stance).

    The spectrum shows the interval. Let j be the jerk, the difference of two readings of the specific force divided by
    dt, and s the difference of two values of j divided by dt. Over some strides the interval is

        T = k sqrt(sum |j|^2 dt / sum |s|^2 dt),  not less than dt.

    The root is dt / sqrt(2) for readings that change at random. It does not depend on dt where the band is narrow
    against the rate, because the sums are integrals there."""

    jerk: Vec3 | None = None
    """Jerk up to the last sample, sensor frame, m/s^3; None before any and after a gap."""
    jerk_square: float = 0.0
    """Fading sum of |j|^2 dt, m^2/s^5."""
    snap_square: float = 0.0
    """Fading sum of |s|^2 dt, m^2/s^7."""

    def update(self, dt: float, acc: Vec3, last: Vec3) -> float:
        """Add a sample `dt` s after the last one; return T / dt.

        `acc` and `last` are the specific forces of both samples, sensor frame, m/s^2."""
        if dt <= 0.0:
            self.jerk = None
            return 1.0
        k = 1.0 / dt
        ax, ay, az = acc
        x, y, z = last
        ax, ay, az = k * (ax - x), k * (ay - y), k * (az - z)
        jerk, self.jerk = self.jerk, (ax, ay, az)
        if jerk is None:
            return 1.0
        remaining = 1.0 - dt / MEMORY_TIME if dt < MEMORY_TIME else 0.0
        jerk_square = self.jerk_square = remaining * self.jerk_square + (ax * ax + ay * ay + az * az) * dt
        x, y, z = jerk
        x, y, z = ax - x, ay - y, az - z
        snap_square = self.snap_square = remaining * self.snap_square + (x * x + y * y + z * z) * k
        ratio_square = INTERVAL_RATIO * INTERVAL_RATIO * k * k * jerk_square
        if ratio_square <= snap_square:
            return 1.0
        longest = LONGEST_INTERVAL * k
        if longest < 1.0:
            return 1.0
        return longest if ratio_square >= longest * longest * snap_square else sqrt(ratio_square / snap_square)


@stateful
class ErrorStateFilter(Strapdown):
    """Strapdown navigation with stance evidence, weighted by the covariance of the motion so far.

    Frame and units are those of `Corrector`. Position and velocity are live with every sample, and corrected at the
    sample with the evidence.

    Numbers in this module without a source were chosen by hand on the recordings of docs/accuracy.md and not swept.
    `solepath-lab evaluate --ablation` gives the accuracy of the default recipe without whole terms of the filter."""

    settings: ErrorStateSettings = field(default=ErrorStateSettings())
    uncertainty: Covariance = (0.0,) * 45
    """Covariance at the last propagation."""
    elapsed: float = 0.0
    """Time since the covariance was last propagated, s."""
    start_velocity: Vec3 = ZERO
    """Velocity at the last propagation, navigation frame, m/s."""
    start_position: Vec3 = ZERO
    """Position at the last propagation, navigation frame, m."""
    acc_variance: float = 0.0
    """Variance that noise has added to each axis of the velocity since the last propagation, (m/s)^2."""
    gyro_variance: float = 0.0
    """Variance that noise has added to each angle since the last propagation, rad^2."""
    time_since_anchor: float = 0.0
    """Time since the last anchor, s."""
    level: LevelGround = state(factory=LevelGround)
    """Height correction of level walking."""
    accepted_at: float | None = None
    """Time at which evidence was last accepted, s; None before any."""
    gated: bool = False
    """True if the gate has rejected evidence since `accepted_at`."""
    evidence_since: float | None = None
    """Start of the current unbroken evidence, s; None without evidence."""
    velocity_error: Vec3 = ZERO
    """Error of the velocity at the first accepted evidence of the newest stance, m/s; see `Corrector`."""
    rhythm: StanceRhythm = state(factory=StanceRhythm)
    """Usual durations of stance and swing, for evidence that the gate rejects."""
    recovery: Recovery | None = None
    """Recovery of the clipped peaks of both sensors; None before any sample."""
    interval: IndependentInterval = state(factory=IndependentInterval)
    """Interval between independent readings, for the noise of what lies between two samples."""

    def start(self, attitude: Quat, tilt_sigma: float) -> None:
        self.attitude = attitude
        self.velocity = self.position = ZERO
        self.force = self.rate = self.accepted_at = self.evidence_since = None
        self.gated = False
        self._mark_start()
        self.time_since_anchor = 0.0
        # a foot whose tilt was not measured at rest may move
        speed = SPEED_AT_REST if tilt_sigma < LARGEST_REST_TILT else SPEED_PER_TILT * tilt_sigma
        self.uncertainty = inflate((0.0,) * 45, velocity=speed * speed, tilt=tilt_sigma * tilt_sigma)

    def predict(self, dt: float, acc: Vec3, gyro: Vec3, saturated: bool = False) -> None:
        gx, gy, gz = gyro
        rate, last_force, recovery = self.rate or gyro, self.force, self.recovery or self._make_recovery()
        last_acc = recovery.last_acc
        gyro_peaks: ClippedPeaks = ()
        acc_peaks: ClippedPeaks = ()
        rate_square, (x, y, z) = gx * gx + gy * gy + gz * gz, acc
        if (
            rate_square > recovery.gyro_clipping.near_end_square
            or x * x + y * y + z * z > recovery.acc_clipping.near_end_square
            or recovery.watches
        ):  # a call for every sample would cost 1 % of it
            gyro_peaks, acc_peaks = recovery.watch(dt, acc, gyro, rate, self.attitude, saturated)
        recovery.earlier_acc, recovery.last_acc = last_acc, acc
        recovery.earlier_rate, recovery.earlier_dt = rate, dt
        ax, ay, az = self.integrate(dt, acc, gyro)
        fx, fy, fz = self.force or ZERO
        if last_force is None:
            x, y, z, ratio = fx, fy, fz, 1.0
            self.interval.jerk = scaled(sub(acc, last_acc), 1.0 / dt) if dt > 0.0 else None
        else:
            x, y, z = last_force
            x, y, z, ratio = fx - x, fy - y, fz - z, self.interval.update(dt, acc, last_acc)
        rx, ry, rz = rate
        rx, ry, rz = gx - rx, gy - ry, gz - rz
        # noise of the sensor, noise that grows with the motion, and noise from the motion between independent readings:
        # T / dt times the difference and the duration of a sample, in dt / T times as many (IndependentInterval)
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
            recovery.gyro_clipping.clipping and settings.recover
        ):
            noise += settings.clipping_noise * settings.clipping_noise
        self.gyro_variance += noise * dt
        self.elapsed += dt
        self.time_since_anchor += dt
        if (gyro_peaks or acc_peaks) and settings.recover:
            self._add_peaks(recovery, gyro_peaks, acc_peaks)

    def _make_recovery(self) -> Recovery:
        from .clipping import Recovery  # with the first sample, as the tracker

        recovery = self.recovery = Recovery()
        return recovery

    def _add_peaks(self, recovery: Recovery, gyro_peaks: ClippedPeaks, acc_peaks: ClippedPeaks) -> None:
        """Correct the state by the clipped peaks of gyroscope and accelerometer."""
        self._propagate()
        state = (self.attitude, self.velocity, self.position, self.uncertainty)
        state = recovery.add_turns(gyro_peaks, state)
        state = recovery.add_velocities(acc_peaks, state)
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
            SHORTEST_INTERVAL if t - self.evidence_since < EARLY_STANCE_TIME - TIME_EPSILON else LATE_STANCE_INTERVAL
        ):
            return self.accepted_at is not None and not self.gated  # same result as for the last sample
        r = sigma * sigma * REFERENCE_INTERVAL / self.elapsed
        self._propagate()
        stands = stance.hint is STATIONARY
        if self.accepted_at is None:
            self.accepted_at = t
        rx, ry, rz = stance.v_ref
        vx, vy, vz = self.velocity
        gate = inf if stands else self.settings.innovation_gate
        if self._stands_after_all(t, self.evidence_since, self.accepted_at):
            # The foot stands, so the motion since the last stance was less certain than its covariance says. The whole
            # covariance is scaled, so that the position is corrected too: its error has the same cause.
            squared = squared_innovation(self.uncertainty, rx - vx, ry - vy, rz - vz, r)
            if squared > EXPECTED_SQUARED_INNOVATION:
                self.uncertainty = scale(self.uncertainty, squared / EXPECTED_SQUARED_INNOVATION)
        outcome = update(self.uncertainty, rx - vx, ry - vy, rz - vz, r, gate)
        if outcome is None:
            self.gated = True
            return False
        self.uncertainty, error = outcome
        self._inject(error)
        self.rhythm.add(t, self.accepted_at)
        if self.accepted_at < self.evidence_since:
            self.velocity_error = sub((vx, vy, vz), stance.v_ref)
        self.accepted_at = t
        self.gated = False
        return True

    def _stands_after_all(self, t: float, evidence_since: float, accepted_at: float) -> bool:
        """Return whether evidence that the gate rejects has lasted so long that the foot stands."""
        share, longest = self.settings.stance_share, self.settings.time_until_ungated
        if accepted_at >= evidence_since:  # the gate let the start of this stance pass
            return t - accepted_at > self.rhythm.time_until_stance(inf, share, longest) - TIME_EPSILON
        until = self.rhythm.time_until_stance(evidence_since - accepted_at, share, longest)
        return t - evidence_since > until - TIME_EPSILON

    def bridge(self, dt: float) -> float:
        if dt <= LONGEST_BRIDGE:
            velocity, angle = BRIDGED_VELOCITY * dt * dt, BRIDGED_ANGLE * dt * dt
            self.acc_variance += velocity * velocity
            self.gyro_variance += angle * angle
            return dt
        if self.recovery is not None:
            self.recovery.reset()
        if dt == inf:  # times restart
            self.accepted_at = self.evidence_since = None
            self.rhythm.reset()
        self._propagate()
        self.velocity = self.start_velocity = ZERO
        self.force = self.rate = None
        distance = GAP_WALKING_SPEED * min(dt, LONGEST_GAP_WALK)
        self.uncertainty = inflate(
            self.uncertainty,
            position=distance * distance,
            height=GAP_RISE_RATIO * distance * distance,
            velocity=GAP_SPEED * GAP_SPEED,
            tilt=GAP_TILT * GAP_TILT,
        )
        return 0.0

    def infill(self, dt: float, attitude: Quat, velocity: Vec3, position: Vec3) -> None:
        if self.recovery is not None:
            self.recovery.reset()
        self._propagate()
        self.time_since_anchor += dt
        self.attitude, self.velocity, self.position = attitude, velocity, position
        self.force = self.rate = None
        self._mark_start()
        distance = INFILL_SPEED_SIGMA * dt
        self.uncertainty = inflate(
            self.uncertainty,
            position=INFILL_POSITION_VARIANCE + distance * distance,
            height=INFILL_POSITION_VARIANCE,
            velocity=INFILL_VELOCITY_SIGMA * INFILL_VELOCITY_SIGMA,
            tilt=INFILL_TILT_SIGMA * INFILL_TILT_SIGMA,
            yaw=INFILL_YAW_SIGMA * INFILL_YAW_SIGMA,
        )

    def repair(self, yaw: float, position: Vec3) -> None:
        self._propagate()
        Strapdown.repair(self, yaw, position)
        self._mark_start()

    def shift(self, yaw: float, by: Vec3) -> None:
        """Turn the state by `yaw` rad about the foot and move it by `by` m, navigation frame.

        The covariance does not change, because this is no motion."""
        self._propagate()
        self.turn_about(yaw, by)
        self._mark_start()

    def flat(self, start: Vec3, turn: float) -> None:
        if not self.settings.level:
            return
        self._propagate()
        x, y, _ = self.position
        variance = self.uncertainty[HEIGHT]
        height, level = self.level.judge(sub(self.position, start), turn, variance, self.attitude)
        # tilt and velocity stay, because the removed height is a systematic error and not caused by theirs
        self.position = self.start_position = (x, y, start[2] + height)
        least = FLOOR_SIGMA * FLOOR_SIGMA
        if variance > least:
            self.uncertainty = constrain_height(self.uncertainty, 1.0 - level * (1.0 - least / variance))

    @property
    def clipped(self) -> bool:
        return self.recovery is not None and self.recovery.clipped

    def anchor(self) -> Floats:
        if self.recovery is not None:
            self.recovery.end_stride()
        self._propagate()
        stretch = self.covariance()
        self.time_since_anchor = 0.0
        self.uncertainty = forget_position_and_yaw(self.uncertainty)
        return stretch

    def covariance(self) -> Floats:
        covariance = self._propagated() if self.elapsed > 0.0 else self.uncertainty
        return (*covariance[:6], HEADING_DRIFT * HEADING_DRIFT * self.time_since_anchor)

    def _propagated(self) -> Covariance:
        """Return the current covariance."""
        t = self.elapsed
        vx, vy, vz = self.velocity
        ux, uy, uz = self.start_velocity
        x, y, z = self.position
        ox, oy, oz = self.start_position
        # S = dv + g T, D = dp - v0 T + g T^2 / 2: integrals of the specific force, from its effect on the state
        s = (vx - ux, vy - uy, vz - uz + GRAVITY * t)
        d = (x - ox - ux * t, y - oy - uy * t, z - oz - uz * t + 0.5 * GRAVITY * t * t)
        q = self.acc_variance
        return propagate(self.uncertainty, t, s, d, q * t * t / 3.0, q * t / 2.0, q, self.gyro_variance)

    def _propagate(self) -> None:
        if self.elapsed > 0.0:
            self.uncertainty = self._propagated()
            self._mark_start()

    def _mark_start(self) -> None:
        self.elapsed = self.acc_variance = self.gyro_variance = 0.0
        self.start_velocity = self.velocity
        self.start_position = self.position

    def _inject(self, error: Correction) -> None:
        """Correct the state by `error`."""
        px, py, pz, vx, vy, vz, tx, ty, tz = error
        x, y, z = self.position
        self.position = self.start_position = (x + px, y + py, z + pz)
        x, y, z = self.velocity
        self.velocity = self.start_velocity = (x + vx, y + vy, z + vz)
        # q <- dq(theta) * q with a global attitude error (Sola 2017, section 7)
        self.attitude = tipped(self.attitude, 0.5 * tx, 0.5 * ty, 0.5 * tz)
