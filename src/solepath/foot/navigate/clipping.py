"""Detection of clipping, and its correction: the end of a sensor's range, and the clipped peak beyond it.

The range of many gyroscopes ends at 250 or 500 degrees/s. A foot exceeds this as its heel rises and again as its leg
swings. The impact of a heel-strike exceeds the 2 g of some accelerometers. The reading then stays at the end of the
range for D seconds. The clipped peak can be estimated, because the slopes at which the reading leaves the range (rise)
and comes back (fall) are visible. The area under the cubic through both ends with these slopes is
D^2 (rise + fall) / 12. The longer the clipping lasts and the more its slopes differ, the flatter the true motion of a
foot is. So the estimate is

    m = D^2 sqrt(rise fall) / (6 (1 + D / FLATTENING_TIME)).

On recorded feet, cut off at 250 degrees/s, its error is a third of m as a rule. `Recovery` uses m.

The end of a range is learnt: an axis that stays at its largest reading for D seconds is at its end, unless a smooth
maximum could look the same. Between slopes rise and fall a smooth maximum would be D sqrt(rise fall) / 4 high. The
numbers were chosen by hand and not swept."""

from __future__ import annotations

from math import asin, fsum, sqrt
from typing import NamedTuple

from ...types import Quat, Vec3
from ...types.attrs import define, field, frozen, state, stateful
from ...types.vector import (
    GRAVITY,
    IDENTITY,
    ZERO,
    add,
    conjugate,
    from_rotation_vector,
    multiply,
    normalise,
    rotate,
    scaled,
    sub,
)
from .covariance import Covariance, add_error

SAME_READING_SHARE = 0.025
"""Largest relative difference between readings that are all at the end of a range.

They differ because a calibration may mix the axes and subtract a bias."""
NEAR_END_RATIO = 0.85
"""Smallest ratio of the end of an axis' range to the largest reading of any axis; the ranges of the axes are alike."""
LARGEST_GROWTH = 1.5
"""Largest ratio by which one reading may raise the largest reading."""
STRIDE_DECAY = 0.97
"""Factor by which each stride reduces the largest reading, so that a wrong one is forgotten."""
FLATTENING_TIME = 0.25
"""Duration of clipping at which the estimate of the clipped peak is halved, s."""
LEAST_BULGE_RATIO = 3.0
"""Height of a smooth maximum above which equal readings show the end of a range, as a multiple of their scatter."""
PEAK_SIGMA_SHARE, MEASURED_SIGMA_SHARE = 1.0, 0.05
"""Parts of the standard deviation of m: as a share of m, and as a share of the integral that was measured meanwhile."""
LARGEST_PEAK = 1.0
"""Largest integral over a clipped peak, rad or m/s."""
LONGEST_CLIPPING = 0.5
"""Longest clipping, s; a reading that stays the same for longer is a fault or an even turn."""


@frozen
class SensorLimits:
    """The limits of a kind of sensor; integrals are in rad for a gyroscope, in m/s for an accelerometer."""

    least_end: float
    """Smallest reading that can be the end of a range, rad/s or m/s^2."""
    largest_slope: float
    """Largest slope of a foot's motion except at heel-strike, rad/s^2 or m/s^3."""
    negligible: float
    """Largest integral over a clipped peak that is ignored, rad or m/s; a smooth maximum gives as much."""


GYROSCOPE = SensorLimits(2.0, 400.0, 0.004)
ACCELEROMETER = SensorLimits(15.0, 4000.0, 0.03)


class ClippedPeak(NamedTuple):
    """The integral over the clipped peak of one axis."""

    axis: int
    """Index of the axis: 0, 1 or 2."""
    integral: float
    """Angle about the sensor's axis, rad; for an accelerometer the velocity along it, m/s."""
    sigma: float
    """Standard deviation of `integral`, rad or m/s."""
    duration: float
    """Time beyond the range, s."""
    age: float
    """Time from the return into the range to the last sample, s."""
    rise: float
    """Slope at which the axis left the range, rad/s^2 or m/s^3."""
    fall: float
    """Slope at which the axis came back into the range, rad/s^2 or m/s^3."""


ClippedPeaks = tuple[ClippedPeak, ...]
NO_PEAKS: ClippedPeaks = ()


@define
class ClippedAxis:
    """The clipping of one axis of a sensor."""

    ends: list[float]
    """Estimates of the upper and the lower end of the range from the largest readings, rad/s or m/s^2."""
    known: list[bool] = field(factory=lambda: [False, False])
    """Flags: the upper, and the lower end of the range is that of `ends`."""
    side: int = 0
    """Side of the range: 1 above it, -1 below it, 0 within."""
    duration: float = 0.0
    """Time from leaving the range to the last sample beyond it, s."""
    rise: float = 0.0
    """Slope at which the axis left the range, rad/s^2 or m/s^3."""
    first_inside: float | None = None
    """First reading within the range after clipping, rad/s or m/s^2; None before it. It has no meaning at side 0."""
    first_inside_dt: float = 0.0
    """Time from the last sample beyond the range to that of `first_inside`, s."""


@define
class Clipping:
    """Detects clipping of the three axes of a sensor.

    Latency: a clipped peak is known two samples after the return into the range."""

    limits: SensorLimits = GYROSCOPE
    axes: list[ClippedAxis] = field(init=False)
    largest: float = field(init=False)
    """Largest reading of any axis so far, which decays, rad/s or m/s^2."""
    near_end_square: float = field(init=False)
    """Square of the norm of a reading from which on an axis may be at the end of its range, (rad/s)^2 or (m/s^2)^2."""
    clipping: bool = field(default=False, init=False)
    """An axis is beyond its range, or was one sample ago."""

    def __attrs_post_init__(self) -> None:
        self.axes = [ClippedAxis([self.limits.least_end, -self.limits.least_end]) for _ in range(3)]
        self._set_largest(self.limits.least_end)

    def end_stride(self) -> None:
        """Let the largest readings decay at the end of a stride."""
        self._set_largest(STRIDE_DECAY * self.largest)
        for axis in self.axes:
            for side in (0, 1):
                if not axis.known[side]:
                    sign = 1 - 2 * side
                    axis.ends[side] = sign * max(self.limits.least_end, STRIDE_DECAY * (sign * axis.ends[side]))

    def reset(self) -> None:
        """Discard clipped peaks that a gap has interrupted."""
        self.clipping = False
        for axis in self.axes:
            axis.side = 0

    def update(
        self, dt: float, readings: Vec3, previous: Vec3, earlier: Vec3, earlier_dt: float, saturated: bool
    ) -> ClippedPeaks:
        """Return the clipped peaks that become known with this sample.

        `readings` comes `dt` s after `previous`, which came `earlier_dt` s after `earlier`; all in rad/s or m/s^2.
        `saturated` is True when the device reports that a sensor is at the end of its range."""
        peaks = NO_PEAKS
        clipping = False
        for i in (0, 1, 2):
            axis, reading = self.axes[i], readings[i]
            if axis.side == 0:
                if abs(reading) > NEAR_END_RATIO * self.largest and not axis.ends[1] * (
                    1.0 - SAME_READING_SHARE
                ) < reading < axis.ends[0] * (1.0 - SAME_READING_SHARE):
                    _enter_clipping(
                        axis, dt, reading, previous[i], earlier[i], earlier_dt, saturated, self.limits.largest_slope
                    )
                    if abs(reading) > self.largest:
                        self._set_largest(min(abs(reading), LARGEST_GROWTH * self.largest))
            else:
                peak = _follow_clipping(axis, i, dt, reading, self.limits.largest_slope)
                if peak is not None and abs(peak.integral) > self.limits.negligible:
                    peaks = (*peaks, peak)
            clipping = clipping or axis.side != 0
        self.clipping = clipping
        return peaks

    def _set_largest(self, rate: float) -> None:
        self.largest = max(self.limits.least_end, rate)
        self.near_end_square = NEAR_END_RATIO * NEAR_END_RATIO * self.largest * self.largest


def _enter_clipping(
    axis: ClippedAxis,
    dt: float,
    reading: float,
    previous: float,
    earlier: float,
    earlier_dt: float,
    saturated: bool,
    largest_slope: float,
) -> None:
    sign = 1 if reading > 0.0 else -1
    reading, previous, earlier = sign * reading, sign * previous, sign * earlier
    side = 0 if sign > 0 else 1
    end, end_known = sign * axis.ends[side], axis.known[side]
    unchanged = reading * (1.0 - SAME_READING_SHARE) <= previous <= reading * (1.0 + SAME_READING_SHARE)
    if reading > end * (1.0 + SAME_READING_SHARE):
        end_known = saturated  # the range is larger than estimated
    end = max(end, min(reading, LARGEST_GROWTH * end))
    end_known = end_known or saturated
    axis.ends[side], axis.known[side] = sign * end, end_known
    if not (end_known or unchanged):
        return
    axis.side, axis.first_inside, axis.first_inside_dt = sign, None, 0.0
    axis.rise = _slope(previous - earlier, earlier_dt, largest_slope)
    if unchanged:
        axis.duration = dt
    else:
        axis.rise = max(_slope(reading - previous, dt, largest_slope), axis.rise)
        axis.duration = max(0.0, dt - (reading - previous) / axis.rise)


def _follow_clipping(axis: ClippedAxis, i: int, dt: float, reading: float, largest_slope: float) -> ClippedPeak | None:
    sign = axis.side
    reading *= sign
    side = 0 if sign > 0 else 1
    end = sign * axis.ends[side]
    if reading > end * (1.0 + SAME_READING_SHARE):  # not the end of the range
        axis.ends[side], axis.known[side] = sign * min(reading, LARGEST_GROWTH * end), False
        axis.side = 0
        return None
    if reading >= end * (1.0 - SAME_READING_SHARE):
        axis.duration += dt + axis.first_inside_dt
        axis.first_inside, axis.first_inside_dt = None, 0.0
        if axis.duration > LONGEST_CLIPPING:
            axis.side = 0
        return None
    if axis.first_inside is None:
        axis.first_inside, axis.first_inside_dt = reading, dt
        return None
    fall = max(
        _slope(end - axis.first_inside, axis.first_inside_dt, largest_slope),
        _slope(axis.first_inside - reading, dt, largest_slope),
    )
    if not axis.known[side]:
        if axis.duration * sqrt(axis.rise * fall) < 4.0 * LEAST_BULGE_RATIO * SAME_READING_SHARE * end:
            axis.side = 0
            return None
        axis.known[side] = True
    tail = min((end - axis.first_inside) / fall, axis.first_inside_dt)
    duration = axis.duration + axis.first_inside_dt - tail
    integral = min(
        duration * duration * sqrt(axis.rise * fall) / (6.0 * (1.0 + duration / FLATTENING_TIME)), LARGEST_PEAK
    )
    axis.side = 0
    sigma = PEAK_SIGMA_SHARE * integral + MEASURED_SIGMA_SHARE * end * duration
    return ClippedPeak(i, sign * integral, sigma, duration, dt + tail, axis.rise, fall)


def _slope(change: float, dt: float, largest_slope: float) -> float:
    return min(max(change / dt, 1.0), largest_slope) if dt > 0.0 else 1.0


AXES: tuple[Vec3, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""Unit vectors of the axes."""
STANDARD_GRAVITY = (0.0, 0.0, GRAVITY)
"""Specific force at rest, navigation frame, m/s^2."""
MOST_ROWS = 64
"""Largest number of stored samples; when there are more, pairs are joined."""
INTEGRAL_STEP = 0.05
"""Change of m for the numerical derivative, rad."""

Row = tuple[float, Vec3, Vec3]
"""Duration (s), mean angular rate (rad/s) and mean specific force (m/s^2) of one or more samples, sensor frame."""


class IntegratedMotion(NamedTuple):
    """The end state of an integration that starts at rest at zero."""

    attitude: Quat
    """Attitude, sensor to navigation frame."""
    velocity: Vec3
    """Change of velocity, navigation frame, m/s."""
    position: Vec3
    """Change of position, navigation frame, m."""


@define
class SwingSamples:
    """The samples since the gyroscope came near the end of its range.

    A clipped turn of tenths of a radian gives a wrong tilt to all samples after it. Its axis is an axis of the sensor.
    So the samples are integrated a second time, with the rate raised by a cubic whose integral is m. A third
    integration with a slightly larger m gives the effect of an error of m on attitude, velocity and position. The error
    of m is one unknown number in a known direction b,

        P <- P + sigma^2 b b',  b = d(p, v, theta) / dm

    and the zero velocity of the next stance shows its size."""

    rows: list[Row] = field(factory=list)
    """Samples in order of time."""
    start_attitude: Quat = IDENTITY
    """Attitude before the first row, sensor to navigation frame."""

    def add_sample(self, dt: float, gyro: Vec3, previous_rate: Vec3, acc: Vec3, attitude: Quat) -> None:
        """Add one sample; `previous_rate` and `attitude` are the rate and the attitude before it."""
        if not self.rows:
            self.start_attitude = attitude
        elif len(self.rows) >= MOST_ROWS:
            self.rows = [_join(a, b) for a, b in zip(self.rows[::2], self.rows[1::2], strict=True)]
        self.rows.append((dt, add(ZERO, add(gyro, previous_rate), 0.5), acc))

    def reintegrate(self, peak: ClippedPeak, angle: float) -> IntegratedMotion:
        """Return the end state of the stored samples with `angle` rad more about the clipped axis."""
        end = fsum([row[0] for row in self.rows]) - peak.age
        t, extra_rates, total = peak.duration - end, [], 0.0
        for dt, _, _ in self.rows:
            relative_time = (t + 0.5 * dt) / peak.duration if peak.duration > 0.0 else 0.5
            t += dt
            extra_rate = 0.0
            if 0.0 < relative_time < 1.0:
                extra_rate = (
                    relative_time
                    * (1.0 - relative_time)
                    * (peak.rise * (1.0 - relative_time) + peak.fall * relative_time)
                )
            extra_rates.append(extra_rate)
            total += extra_rate * dt
        if not total > 0.0:
            extra_rates = [1.0] * len(self.rows)
            total = fsum([row[0] for row in self.rows])
        k = angle / total if total > 0.0 else 0.0
        q = self.start_attitude
        velocity = position = ZERO
        for (dt, rate, acc), extra_rate in zip(self.rows, extra_rates, strict=True):
            rate = add(rate, AXES[peak.axis], k * extra_rate)
            half_turn = from_rotation_vector(add(ZERO, rate, 0.5 * dt))
            q = multiply(q, half_turn)
            acceleration = sub(rotate(q, acc), STANDARD_GRAVITY)
            q = multiply(q, half_turn)
            position = add(position, add(velocity, acceleration, 0.5 * dt), dt)
            velocity = add(velocity, acceleration, dt)
        return IntegratedMotion(q, velocity, position)


def _join(a: Row, b: Row) -> Row:
    (t, rate, acc), (u, next_rate, next_acc) = a, b
    duration = t + u
    k = t / duration if duration > 0.0 else 0.5
    return duration, add(add(ZERO, rate, k), next_rate, 1.0 - k), add(add(ZERO, acc, k), next_acc, 1.0 - k)


def difference(a: IntegratedMotion, b: IntegratedMotion) -> tuple[Vec3, Vec3, Vec3]:
    """Return position (m), velocity (m/s) and turn (rad) by which `b` differs from `a`, navigation frame."""
    w, x, y, z = multiply(b.attitude, conjugate(a.attitude))
    k = 2.0 if w >= 0.0 else -2.0
    n = sqrt(x * x + y * y + z * z)
    if n > 1e-6:
        k *= asin(min(n, 1.0)) / n
    return sub(b.position, a.position), sub(b.velocity, a.velocity), scaled((x, y, z), k)


State = tuple[Quat, Vec3, Vec3, Covariance]
"""Attitude (sensor to navigation frame), velocity (m/s), position (m) and their covariance."""


@stateful
class Recovery:
    """Correction of the state of a filter for the clipped peaks of both sensors of one foot."""

    gyro_clipping: Clipping = state(factory=Clipping)
    """Clipping of the gyroscope."""
    acc_clipping: Clipping = state(factory=lambda: Clipping(ACCELEROMETER))
    """Clipping of the accelerometer."""
    last_acc: Vec3 = ZERO
    """Last acc, sensor frame, m/s^2."""
    earlier_acc: Vec3 = ZERO
    """Acc before the last one, sensor frame, m/s^2."""
    swing: SwingSamples = state(factory=SwingSamples)
    """Samples since the gyroscope came near the end of its range."""
    earlier_rate: Vec3 = ZERO
    """Rate before the last one, sensor frame, rad/s."""
    earlier_dt: float = 0.0
    """Time between the last two samples, s."""
    clipped: bool = False
    """Peaks of this stride were cut off at the end of a range."""
    watches: bool = False
    """The next sample is watched wherever it lies, because a sensor was near the end of its range in this one."""

    def watch(
        self, dt: float, acc: Vec3, gyro: Vec3, previous_rate: Vec3, attitude: Quat, saturated: bool
    ) -> tuple[ClippedPeaks, ClippedPeaks]:
        """Return the clipped peaks of gyroscope and accelerometer that become known with this sample.

        `acc` is in m/s^2, `gyro` in rad/s. `previous_rate` and `attitude` are those of the last sample. `saturated` is
        True when the device reports that a sensor is at the end of its range."""
        x, y, z = gyro
        gyro_clipping, gyro_peaks = self.gyro_clipping, NO_PEAKS
        if gyro_clipping.clipping or x * x + y * y + z * z > gyro_clipping.near_end_square:
            gyro_peaks = gyro_clipping.update(dt, gyro, previous_rate, self.earlier_rate, self.earlier_dt, saturated)
            self.swing.add_sample(dt, gyro, previous_rate, acc, attitude)
        elif self.swing.rows:
            self.swing.rows = []
        x, y, z = acc
        acc_clipping, acc_peaks = self.acc_clipping, NO_PEAKS
        if acc_clipping.clipping or x * x + y * y + z * z > acc_clipping.near_end_square:
            acc_peaks = acc_clipping.update(dt, acc, self.last_acc, self.earlier_acc, self.earlier_dt, saturated)
        if gyro_peaks or acc_peaks:
            self.clipped = True
        self.watches = gyro_clipping.clipping or acc_clipping.clipping or bool(self.swing.rows)
        return gyro_peaks, acc_peaks

    def reset(self) -> None:
        """Discard clipped peaks that are not complete, after a gap."""
        self.gyro_clipping.reset()
        self.acc_clipping.reset()
        self.swing.rows = []

    def end_stride(self) -> None:
        """Let the largest readings decay at the end of a stride."""
        self.clipped = False
        self.gyro_clipping.end_stride()
        self.acc_clipping.end_stride()

    def add_turns(self, gyro_peaks: ClippedPeaks, state: State) -> State:
        """Return the state corrected for clipped peaks of the gyroscope, with their uncertainty."""
        attitude, velocity, position, covariance = state
        for peak in gyro_peaks:
            measured, corrected, perturbed = (
                self.swing.reintegrate(peak, integral)
                for integral in (0.0, peak.integral, peak.integral + INTEGRAL_STEP)
            )
            p, v, turn = difference(measured, corrected)
            position, velocity = add(position, p), add(velocity, v)
            attitude = normalise(multiply(from_rotation_vector(turn), attitude))
            covariance = add_error(covariance, difference(corrected, perturbed), peak.sigma / INTEGRAL_STEP)
        return attitude, velocity, position, covariance

    @staticmethod
    def add_velocities(acc_peaks: ClippedPeaks, state: State) -> State:
        """Return the state corrected for clipped peaks of the accelerometer, with their uncertainty."""
        attitude, velocity, position, covariance = state
        for peak in acc_peaks:
            axis = rotate(attitude, AXES[peak.axis])
            v, elapsed = peak.integral, peak.age + 0.5 * peak.duration  # elapsed since the middle of the peak
            position, velocity = add(position, axis, v * elapsed), add(velocity, axis, v)
            covariance = add_error(covariance, (add(ZERO, axis, elapsed), axis, ZERO), peak.sigma)
        return attitude, velocity, position, covariance
