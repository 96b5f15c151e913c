"""Calibration of an inertial sensor at rest: first attitude, gyroscope bias and accelerometer scale.

`Levelling` finds the first attitude for any mounting. `Rest` keeps learning the gyroscope bias and the accelerometer
scale from spans in which the foot is as still as only a standing foot is."""

from __future__ import annotations

from math import inf, isfinite

from ..events import ScaleSuspect
from ..types import Quat, Site, Vec3
from ..types.attrs import define, field
from ..types.vector import GRAVITY, TIE, ZERO, levelling

COARSEST_COUNT = 0.7
"""Upper limit for the value of one accelerometer count, m/s^2; 8 bits for +-8 g give 0.61."""
SAME_READING = 1e-6
"""Readings that differ by less than this are the same count, m/s^2."""
TILT_AT_REST, TILT_IN_STANCE, TILT_AT_ANY_TIME = 0.02, 0.06, 0.2
"""Standard deviation of the first tilt at rest, in stance and at any time, rad; chosen by hand, not swept."""
ABOVE_ANY_MOTION = 1e12
"""Upper bound for the amount of motion of any span, (m/s^2)^2."""
REST_MEMORY = 20
"""Number of spans of rest that are averaged; this is ten seconds, because the bias wanders."""
LEAST_SCALE, LARGEST_SCALE = 0.8, 1.25
"""Limits of an accelerometer scale.

Beyond a fifth the range is wrong, not the scale. Cheap accelerometers do read 1.1 g."""
SCALE_KNOWN_AFTER, ELEVATOR_SHARE = 4, 0.02
"""Spans of rest after which the scale is known, and largest relative change of the scale from then on.

A larger change is an elevator that starts or stops."""
SUSPECT_SHARE = 0.15
"""Relative deviation from 1 g at rest above which an accelerometer is suspect."""
LEVEL_SPAN, REST_SPAN = 0.25, 0.5
"""Duration of a span for the first attitude and of a span of rest, s."""
LEVEL_ACC = 0.6
"""Largest standard deviation of acc for the first attitude, m/s^2; 8-bit accelerometers flicker by 0.3."""
LEVEL_GYRO = 0.1
"""Largest standard deviation of the angular rate for the first attitude, rad/s.

The mean rate is not used, because cheap gyroscopes are off by 0.3 at rest."""
SHORT_SPAN, LONGEST_STRIDE, LEVEL_PATIENCE = 0.06, 1.3, 3.0
"""Durations for a foot that already walks: a short span, the longest stride, and the longest wait, s.

After the longest wait any attitude is taken."""
MOTION_RATIO = 4.0
"""Largest ratio of the motion of a short span to that of the stillest one, both squared."""
RATE_PER_ACC = 0.3
"""Angular rate that counts as much motion as 1 m/s^2, rad/s."""
STILL_ACC = 0.35
"""Largest standard deviation of acc at rest without the flicker of its counts, m/s^2."""
STILL_GYRO = 0.02
"""Largest standard deviation of the rate at rest, rad/s: a standing foot, not one in mid-stance."""
LARGEST_BIAS = 0.8
"""Largest bias, rad/s.

A steady rate above it is a turn. Cheap gyroscopes start with 0.35 and more."""
LARGEST_CHANGE = 0.5
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
        ax, ay, az = acc
        gx, gy, gz = gyro
        x, y, z = self.acc
        self.acc = (x + ax, y + ay, z + az)
        x, y, z = self.gyro
        self.gyro = (x + gx, y + gy, z + gz)
        self.acc_squares += ax * ax + ay * ay + az * az
        self.gyro_squares += gx * gx + gy * gy + gz * gz
        self.count += 1

    def means(self) -> tuple[Vec3, Vec3]:
        """Return the mean acc, m/s^2, and the mean gyro, rad/s."""
        k = 1.0 / self.count
        (ax, ay, az), (gx, gy, gz) = self.acc, self.gyro
        return (ax * k, ay * k, az * k), (gx * k, gy * k, gz * k)

    def variances(self) -> tuple[float, float]:
        """Return the variances of acc, (m/s^2)^2, and of gyro, (rad/s)^2, each summed over the axes."""
        (ax, ay, az), (gx, gy, gz) = self.means()
        return (
            max(0.0, self.acc_squares / self.count - (ax * ax + ay * ay + az * az)),
            max(0.0, self.gyro_squares / self.count - (gx * gx + gy * gy + gz * gz)),
        )


@define
class Levelling:
    """Finds the first attitude from the direction of gravity.

    It averages over the first quarter of a second in which the foot is still. If the foot walks already, it uses the
    middle of a stance: a span of SHORT_SPAN that is about as still as the stillest one so far, once LONGEST_STRIDE has
    passed. After LEVEL_PATIENCE it uses any span. The heading stays as it is: the attitude is the smallest turn that
    takes the measured up to up."""

    span: SampleSpan = field(factory=SampleSpan, init=False)
    short_span: SampleSpan = field(factory=SampleSpan, init=False)
    """Sums over the current short span."""
    short_span_start: float = field(default=0.0, init=False)
    """Start of the current short span, s."""
    least_motion: float = field(default=ABOVE_ANY_MOTION, init=False)
    """Least amount of motion of any short span so far, (m/s^2)^2."""
    span_start: float = field(default=0.0, init=False)
    """Start of the current span, s."""
    started_at: float | None = field(default=None, init=False)
    """Time of the first sample, s; None before it."""

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> tuple[Quat, float] | None:
        """Return the attitude and the standard deviation of its tilt, rad, once they are known."""
        if self.started_at is None:
            self.started_at = self.span_start = self.short_span_start = t
        self.span.add(acc, gyro)
        walking = self._walking(t, acc, gyro, self.started_at)
        if walking is not None:
            return walking
        if t - self.span_start < LEVEL_SPAN - TIE or self.span.count < 3:
            return None
        mean_acc, _ = self.span.means()
        acc_variance, gyro_variance = self.span.variances()
        still = acc_variance < LEVEL_ACC**2 and gyro_variance < LEVEL_GYRO**2
        self.span = SampleSpan()
        self.span_start = t
        if still:
            return levelling(mean_acc), TILT_AT_REST
        if t - self.started_at >= LEVEL_PATIENCE - TIE:
            return levelling(mean_acc), TILT_AT_ANY_TIME
        return None

    def _walking(self, t: float, acc: Vec3, gyro: Vec3, started_at: float) -> tuple[Quat, float] | None:
        """Return the same as `update` for a foot that never stands for a quarter of a second."""
        short_span = self.short_span
        short_span.add(acc, gyro)
        if t - self.short_span_start < SHORT_SPAN - TIE or short_span.count < 2:
            return None
        (ax, ay, az), (gx, gy, gz) = short_span.means()
        acc_variance, gyro_variance = short_span.variances()
        off = (ax * ax + ay * ay + az * az) ** 0.5 - GRAVITY
        rate = gx * gx + gy * gy + gz * gz + gyro_variance
        motion = acc_variance + off * off + rate / (RATE_PER_ACC * RATE_PER_ACC)
        self.short_span = SampleSpan()
        self.short_span_start = t
        stands = t - started_at >= LONGEST_STRIDE - TIE and motion <= MOTION_RATIO * self.least_motion
        self.least_motion = min(self.least_motion, motion)
        return (levelling((ax, ay, az)), TILT_IN_STANCE) if stands else None


@define
class Rest:
    """The gyroscope bias and the accelerometer scale, learnt from spans of rest."""

    span: SampleSpan = field(factory=SampleSpan, init=False)
    span_start: float | None = field(default=None, init=False)
    """Start of the current span, s; None before the first sample."""
    bias: Vec3 = field(default=ZERO, init=False)
    """Gyroscope bias, sensor frame, rad/s."""
    scale: float = field(default=1.0, init=False)
    """Factor for acc that makes it read 1 g at rest."""
    count: int = field(default=0, init=False)
    """Number of spans of rest so far."""
    magnitude: float | None = field(default=None, init=False)
    """Norm of the mean acc of the last span of rest, m/s^2; None before any."""
    grain: float = field(default=COARSEST_COUNT, init=False)
    """Value of one accelerometer count, m/s^2: the least difference of two readings so far."""
    last: Vec3 = field(default=ZERO, init=False)
    """Last acc without calibration, m/s^2."""

    def reset(self) -> None:
        """Discard the current span because times restart; bias and scale stay."""
        self.span = SampleSpan()
        self.span_start = None

    def calibrate(self, acc: Vec3, gyro: Vec3) -> tuple[Vec3, Vec3]:
        """Return acc, m/s^2, and gyro, rad/s, with scale and bias applied."""
        k, (bx, by, bz) = self.scale, self.bias
        return (acc[0] * k, acc[1] * k, acc[2] * k), (gyro[0] - bx, gyro[1] - by, gyro[2] - bz)

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> bool:
        """Add one sample without calibration; return whether a span of rest has just ended."""
        if self.span_start is None:
            self.span_start = t
        # the same as SampleSpan.add without the cost of a call (tests/foot/test_alike.py checks that both are equal)
        span = self.span
        gx, gy, gz = gyro
        lx, ly, lz = span.gyro
        span.gyro = (lx + gx, ly + gy, lz + gz)
        span.gyro_squares += gx * gx + gy * gy + gz * gz
        x, y, z = acc
        lx, ly, lz = span.acc
        span.acc = (lx + x, ly + y, lz + z)
        span.acc_squares += x * x + y * y + z * z
        span.count += 1
        # a steady reading flickers between two neighbouring counts on any axis, with a variance of up to a quarter
        lx, ly, lz = self.last
        self.last = acc
        x -= lx
        y -= ly
        z -= lz
        finest = self.grain
        if -finest < x < finest and not -SAME_READING <= x <= SAME_READING:
            self.grain = finest = x if x > 0.0 else -x
        if -finest < y < finest and not -SAME_READING <= y <= SAME_READING:
            self.grain = finest = y if y > 0.0 else -y
        if -finest < z < finest and not -SAME_READING <= z <= SAME_READING:
            self.grain = z if z > 0.0 else -z
        if t - self.span_start < REST_SPAN - TIE or span.count < 4:
            return False
        (ax, ay, az), (gx, gy, gz) = self.span.means()
        acc_variance, gyro_variance = self.span.variances()
        self.span = SampleSpan()
        self.span_start = t
        if acc_variance > STILL_ACC**2 + 0.75 * self.grain * self.grain or gyro_variance > STILL_GYRO**2:
            return False
        x, y, z = self.bias
        limit = LARGEST_CHANGE if self.count else LARGEST_BIAS
        if max(abs(gx - x), abs(gy - y), abs(gz - z)) > limit:
            return False
        self.magnitude = (ax * ax + ay * ay + az * az) ** 0.5
        scale = GRAVITY / self.magnitude if self.magnitude > 0.0 else 0.0
        spans = min(self.count + 1, REST_MEMORY)
        if LEAST_SCALE < scale < LARGEST_SCALE and (
            self.count < SCALE_KNOWN_AFTER or abs(scale / self.scale - 1.0) < ELEVATOR_SHARE
        ):
            self.scale += (scale - self.scale) / spans
        weight = 1.0 / spans
        x, y, z = self.bias
        self.bias = (x + (gx - x) * weight, y + (gy - y) * weight, z + (gz - z) * weight)
        self.count += 1
        return True


def check_scale(t: float, known_at: float, site: Site, magnitude: float | None) -> ScaleSuspect | None:
    """Return a `ScaleSuspect` if `magnitude`, the norm of acc at rest in m/s^2, is not about 1 g."""
    if magnitude is None or 1.0 - SUSPECT_SHARE < magnitude / GRAVITY < 1.0 + SUSPECT_SHARE:
        return None
    ratio = GRAVITY / magnitude if magnitude > 0.0 else inf
    suggestion = f"multiply acc by {ratio:.3g}" if isfinite(ratio) else "acc reads nothing at all"
    return ScaleSuspect(t=t, known_at=known_at, site=site, magnitude=magnitude, suggestion=suggestion)
