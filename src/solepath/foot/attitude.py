"""Calibration of an inertial sensor: first attitude, gyroscope bias and accelerometer scale.

`Levelling` finds the first attitude for any mounting. `Rest` learns the gyroscope bias and the accelerometer scale all
the time, from spans in which the foot is as still as only a standing foot is. Before the first of them, `WalkScale`
learns the scale from strides. The numbers were chosen by hand and not
swept."""

from __future__ import annotations

from ..types import Quat, Vec3
from ..types.attrs import define, field
from ..types.vector import GRAVITY, TIME_EPSILON, ZERO, dot, levelling, scaled, sub
from .navigate.bias import REST_SPAN, BiasFilter, RestSpan

COARSEST_COUNT = 0.7
"""Upper limit for the value of one accelerometer count, m/s^2; 8 bits for +-8 g give 0.61."""
LARGEST_SAME_COUNT = 1e-6
"""Largest difference between two readings of the same count, m/s^2."""
REST_TILT_SIGMA, STANCE_TILT_SIGMA, MOVING_TILT_SIGMA = 0.02, 0.06, 0.5
"""Standard deviation of the first tilt, rad: found at rest, the least in stance, and the largest of a moving foot."""
LARGEST_MOTION = 1e12
"""Upper bound for the amount of motion in any span, (m/s^2)^2."""
MOST_REST_SPANS = 20
"""Number of spans of rest over which the accelerometer scale is averaged: ten seconds."""
LEAST_SCALE, LARGEST_SCALE = 0.8, 1.25
"""Limits of an accelerometer scale.

Cheap accelerometers do read 1.1 g at rest. An error of more than a fifth means that the range is wrong."""
SPANS_OF_KNOWN_SCALE, LARGEST_SCALE_CHANGE = 4, 0.02
"""Number of spans of rest after which the scale is known, and largest relative change of the scale from then on.

A larger change comes from an elevator that starts or stops."""
LEVEL_SPAN = 0.25
"""Duration of a span for the first attitude, s."""
LEVEL_ACC_SIGMA = 0.6
"""Largest standard deviation of acc for the first attitude, m/s^2; 8-bit accelerometers flicker by 0.3."""
LEVEL_GYRO_SIGMA = 0.1
"""Largest standard deviation of the angular rate for the first attitude, rad/s; its mean is 0.3 in cheap gyroscopes."""
SHORT_SPAN, LONGEST_STRIDE = 0.06, 1.3
"""Durations for a foot that already walks, s: a short span, and a stride with its stance."""
RATE_PER_ACC = 0.3
"""Angular rate that counts as much motion as 1 m/s^2, rad/s."""
REST_ACC_SIGMA = 0.35
"""Largest standard deviation of acc at rest, without the flicker between neighbouring counts, m/s^2."""
REST_GYRO_SIGMA = 0.02
"""Largest standard deviation of the angular rate at rest, rad/s; a foot in mid-stance shows more."""
REST_BLOCK = 0.1
"""Duration of a block, s; the means of the blocks of a span show how much a standing foot turns in it."""
LARGEST_BIAS = 0.8
"""Largest bias, rad/s; a higher steady rate is a turn. Cheap gyroscopes start with a bias of 0.35 and more."""
LARGEST_BIAS_CHANGE = 0.5
"""Largest difference of a rate at rest from a known bias, rad/s."""


@define
class SampleSpan:
    """Running sums over one span of samples."""

    count: int = 0
    acc: Vec3 = ZERO
    gyro: Vec3 = ZERO
    acc_squares: float = 0.0
    gyro_squares: float = 0.0

    def add(self, acc: Vec3, gyro: Vec3) -> None:
        """Add one sample: acc in m/s^2, gyro in rad/s."""
        a, b, c = self.acc
        x, y, z = acc
        p, q, r = self.gyro
        u, v, w = gyro
        self.acc, self.gyro = (a + x, b + y, c + z), (p + u, q + v, r + w)
        self.acc_squares += x * x + y * y + z * z
        self.gyro_squares += u * u + v * v + w * w
        self.count += 1

    def means(self) -> tuple[Vec3, Vec3]:
        """Return the mean acc, m/s^2, and the mean gyro, rad/s."""
        k = 1.0 / self.count
        return scaled(self.acc, k), scaled(self.gyro, k)

    def variances(self) -> tuple[float, float]:
        """Return the variances of acc, (m/s^2)^2, and of gyro, (rad/s)^2, each summed over the axes."""
        acc, gyro = self.means()
        return (
            max(0.0, self.acc_squares / self.count - dot(acc, acc)),
            max(0.0, self.gyro_squares / self.count - dot(gyro, gyro)),
        )


def amount_of_motion(span: SampleSpan) -> float:
    """Return how much the foot moves in a span, apart from a steady specific force, (m/s^2)^2."""
    acc_variance, gyro_variance = span.variances()
    _, rate = span.means()
    return acc_variance + (dot(rate, rate) + gyro_variance) / (RATE_PER_ACC * RATE_PER_ACC)


@define
class Levelling:
    """Finds the first attitude from the direction of gravity.

    It averages over the first quarter of a second in which the foot is still. If the foot walks already, the stillest
    short span of the first stride is the middle of a stance: navigation starts after the first short span, and again
    after each stiller one, so that it has started in that stance when LONGEST_STRIDE has passed. The heading stays that
    of the sensor: the attitude is the smallest turn that takes the measured up to up."""

    span: SampleSpan = field(factory=SampleSpan)
    short_span: SampleSpan = field(factory=SampleSpan)
    """Sums over the current short span."""
    short_span_start: float = 0.0
    """Start of the current short span, s."""
    least_motion: float = LARGEST_MOTION
    """Least amount of motion of any short span so far, (m/s^2)^2."""
    span_start: float = 0.0
    """Start of the current span, s."""
    started_at: float | None = None
    """Time of the first sample, s; None before it."""
    final: bool = False
    """Flag: the newest attitude is the first one; no other follows."""
    walks: bool = True
    """Flag: the foot was not still."""

    @property
    def found(self) -> bool:
        """Flag: navigation has started with an attitude of a short span."""
        return self.least_motion < LARGEST_MOTION

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> tuple[Quat, float] | None:
        """Return the attitude and the standard deviation of its tilt, rad, with which navigation starts, or None."""
        if self.started_at is None:
            self.started_at = self.span_start = self.short_span_start = t
        self.span.add(acc, gyro)
        if t - self.span_start >= LEVEL_SPAN - TIME_EPSILON and self.span.count >= 3:
            mean_acc, _ = self.span.means()
            acc_variance, gyro_variance = self.span.variances()
            self.span = SampleSpan()
            self.span_start = t
            if acc_variance < LEVEL_ACC_SIGMA**2 and gyro_variance < LEVEL_GYRO_SIGMA**2:
                self.final, self.walks = True, False
                return levelling(mean_acc), REST_TILT_SIGMA
        attitude = self._level_in_stance(t, acc, gyro)
        self.final = t - self.started_at >= LONGEST_STRIDE - TIME_EPSILON and self.found
        return attitude

    def _level_in_stance(self, t: float, acc: Vec3, gyro: Vec3) -> tuple[Quat, float] | None:
        """Return the same as `update`, from a short span that is stiller than any before."""
        short_span = self.short_span
        short_span.add(acc, gyro)
        if t - self.short_span_start < SHORT_SPAN - TIME_EPSILON or short_span.count < 2:
            return None
        force, _ = short_span.means()
        gravity_difference = dot(force, force) ** 0.5 - GRAVITY
        motion = amount_of_motion(short_span) + gravity_difference * gravity_difference
        self.short_span = SampleSpan()
        self.short_span_start = t
        if motion >= self.least_motion:
            return None
        self.least_motion = motion
        return levelling(force), min(max(STANCE_TILT_SIGMA, motion**0.5 / GRAVITY), MOVING_TILT_SIGMA)


@define
class Rest:
    """The gyroscope bias and the accelerometer scale, learnt from spans of rest."""

    span: SampleSpan = field(factory=SampleSpan)
    span_start: float | None = None
    """Start of the current span, s; None before the first sample."""
    bias_filter: BiasFilter = field(factory=BiasFilter)
    bias: Vec3 = ZERO
    """Gyroscope bias by the filter, sensor frame, rad/s."""
    block_end: float = 0.0
    """End of the current block, s."""
    blocks: list[tuple[int, Vec3]] = field(factory=list)
    """Number of samples, and sum of their rates, rad/s, of the span up to the end of each of its blocks."""
    scale: float = 1.0
    """Factor for acc that makes it read 1 g at rest."""
    count: int = 0
    """Number of spans of rest so far."""
    grain: float = COARSEST_COUNT
    """Value of one accelerometer count, m/s^2: the least difference of two readings so far."""
    last: Vec3 = ZERO
    """Last acc without calibration, m/s^2."""

    def reset(self) -> None:
        """Discard the current rest because times restart; bias and scale stay."""
        self._start_span(None)
        self.bias_filter.reset()

    def end_rest(self) -> None:
        """End the current rest because samples are missing."""
        self._start_span(None)
        self.bias_filter.end_rest()

    def calibrate(self, acc: Vec3, gyro: Vec3) -> tuple[Vec3, Vec3]:
        """Return acc, m/s^2, and gyro, rad/s, with scale and bias applied."""
        return scaled(acc, self.scale), sub(gyro, self.bias)

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> bool:
        """Add one sample without calibration; return whether a span of rest has just ended."""
        if self.span_start is None:
            self._start_span(t)
        span = self.span
        span.add(acc, gyro)
        # a steady reading flickers between two neighbouring counts on any axis, with a variance of up to 1/4 count^2
        x, y, z = acc
        lx, ly, lz = self.last
        self.last = acc
        x -= lx
        y -= ly
        z -= lz
        least_difference = self.grain
        if -least_difference < x < least_difference and not -LARGEST_SAME_COUNT <= x <= LARGEST_SAME_COUNT:
            self.grain = least_difference = x if x > 0.0 else -x
        if -least_difference < y < least_difference and not -LARGEST_SAME_COUNT <= y <= LARGEST_SAME_COUNT:
            self.grain = least_difference = y if y > 0.0 else -y
        if -least_difference < z < least_difference and not -LARGEST_SAME_COUNT <= z <= LARGEST_SAME_COUNT:
            self.grain = z if z > 0.0 else -z
        if t < self.block_end - TIME_EPSILON:
            return False
        self.blocks.append((span.count, span.gyro))
        self.block_end = t + REST_BLOCK
        if self.span_start is None or t - self.span_start < REST_SPAN - TIME_EPSILON or span.count < 4:
            return False
        return self._end_span(t)

    def _start_span(self, t: float | None) -> None:
        self.span, self.span_start, self.blocks = SampleSpan(), t, []
        if t is not None:
            self.block_end = t + REST_BLOCK

    def _end_span(self, t: float) -> bool:
        """Learn from a span if the foot was at rest, and start the next one; return whether it was at rest."""
        force, rate = self.span.means()
        acc_variance, gyro_variance = self.span.variances()
        blocks = self.blocks
        self._start_span(t)
        if acc_variance > REST_ACC_SIGMA**2 + 0.75 * self.grain * self.grain or gyro_variance > REST_GYRO_SIGMA**2:
            self.bias_filter.end_rest()
            return False
        limit = LARGEST_BIAS_CHANGE if self.count else LARGEST_BIAS
        if max([abs(value - bias) for value, bias in zip(rate, self.bias, strict=True)]) > limit:
            self.bias_filter.end_rest()
            return False
        magnitude = dot(force, force) ** 0.5
        scale = GRAVITY / magnitude if magnitude > 0.0 else 0.0
        spans = min(self.count + 1, MOST_REST_SPANS)
        if LEAST_SCALE < scale < LARGEST_SCALE and (
            self.count < SPANS_OF_KNOWN_SCALE or abs(scale / self.scale - 1.0) < LARGEST_SCALE_CHANGE
        ):
            self.scale += (scale - self.scale) / spans
        k = 1.0 / magnitude if magnitude > 0.0 else 0.0
        self.bias_filter.add(RestSpan(t, rate, _means_of(blocks), scaled(force, k)))
        self.bias = self.bias_filter.bias.value
        self.count += 1
        return True


def _means_of(blocks: list[tuple[int, Vec3]]) -> tuple[Vec3, ...]:
    """Return the mean rate of each block, rad/s."""
    means, before, last = [], 0, ZERO
    for count, gyro in blocks:
        means.append(scaled(sub(gyro, last), 1.0 / (count - before)))
        before, last = count, gyro
    return tuple(means)


SHORTEST_SWING, LONGEST_SWING = 0.25, 2.0
"""Limits of the time between two stances over which a drift is measured, s."""
MOST_STRIDES = 20
"""Number of strides that are averaged."""
LARGEST_DEVIATION = 0.25 * GRAVITY
"""Largest deviation from 1 g in one stride, m/s^2; a larger one counts as this."""


@define
class WalkScale:
    """Learns the accelerometer scale of a foot that has not stood still yet, from its strides.

    A scale error shows in two ways. In the stillest part of a stance the specific force is not 1 g; but a runner's foot
    is never still. From one stance to the next the vertical velocity drifts by the error times the duration; but an
    impact that was sampled too slowly or clipped makes it drift too. Nothing but the scale does both, so the smaller of
    the two is used if both have the same sign. A deviation is the difference between the reading of a standing foot and
    1 g, m/s^2."""

    span: SampleSpan = field(factory=SampleSpan)
    """Sums over the current short span."""
    span_start: float | None = None
    """Start of the current short span, s; None before any sample."""
    least_motion: float = LARGEST_MOTION
    """Least amount of motion of a short span since the last stride, (m/s^2)^2."""
    force: float = GRAVITY
    """Specific force in the short span of `least_motion`, m/s^2."""
    accepted_at: float | None = None
    """Time of the last accepted evidence, s; None before any."""
    strides: int = 0
    """Number of strides in the means, at most MOST_STRIDES."""
    stance_deviation: float = 0.0
    """Mean deviation in stance."""
    drift_deviation: float = 0.0
    """Mean deviation from the drift of the vertical velocity."""

    def add_sample(self, t: float, acc: Vec3, gyro: Vec3) -> None:
        """Add one sample without calibration."""
        if self.span_start is None:
            self.span_start = t
        span = self.span
        span.add(acc, gyro)
        if t - self.span_start < SHORT_SPAN - TIME_EPSILON or span.count < 2:
            return
        motion = amount_of_motion(span)
        if motion < self.least_motion:
            force, _ = span.means()
            self.least_motion, self.force = motion, dot(force, force) ** 0.5
        self.span = SampleSpan()
        self.span_start = t

    def add_evidence(self, t: float, drift: float, scale: float) -> float:
        """Return the scale after evidence that was accepted at `t`, s, and that corrected the velocity.

        `drift` is the vertical velocity that the correction removed, m/s, integrated with `scale`."""
        since = None if self.accepted_at is None else t - self.accepted_at
        self.accepted_at = t
        if since is None or not SHORTEST_SWING <= since <= LONGEST_SWING or self.least_motion == LARGEST_MOTION:
            return scale
        self.strides = min(self.strides + 1, MOST_STRIDES)
        stance, moving = self.force - GRAVITY, (GRAVITY + drift / since) / scale - GRAVITY
        self.stance_deviation += (_limited(stance) - self.stance_deviation) / self.strides
        self.drift_deviation += (_limited(moving) - self.drift_deviation) / self.strides
        self.least_motion = LARGEST_MOTION
        least, most = sorted((self.stance_deviation, self.drift_deviation), key=abs)
        deviation = least if least * most > 0.0 else 0.0
        return min(max(GRAVITY / (GRAVITY + deviation), LEAST_SCALE), LARGEST_SCALE)

    def reset(self) -> None:
        """Discard what depends on unbroken times."""
        self.span = SampleSpan()
        self.span_start = self.accepted_at = None
        self.least_motion = LARGEST_MOTION


def _limited(deviation: float) -> float:
    return min(max(deviation, -LARGEST_DEVIATION), LARGEST_DEVIATION)
