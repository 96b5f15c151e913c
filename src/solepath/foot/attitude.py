"""What a sensor at rest tells: which way is up, what its gyroscope adds, how long its metre is.

`Levelling` finds the first attitude, whatever the mounting. `Rest` goes on learning: the gyroscope's bias and the
accelerometer's scale, from spans in which the foot lies as still as only a standing foot does.
"""

from __future__ import annotations

from math import inf, isfinite

from ..events import ScaleSuspect
from ..types import Quat, Site, Vec3
from ..types.attrs import define, field
from ..types.vector import GRAVITY, TIE, ZERO, levelling

COARSEST_COUNT = 0.7
"""No accelerometer's count is worth more (8 bits for +-8 g are 0.61), m/s^2."""
SAME_READING = 1e-6
"""Readings that differ by less are the same count, m/s^2."""
TILT_AT_REST, TILT_IN_STANCE, TILT_AT_ANY_TIME = 0.02, 0.06, 0.2
"""Standard deviation of a tilt by how quiet the foot was that it was found on, rad; chosen by hand, not swept."""
ABOVE_ANY_MOTION = 1e12
"""Louder than any moment, (m/s^2)^2."""
REST_MEMORY = 20
"""So many spans of rest count, ten seconds of it: the bias wanders."""
LEAST_SCALE, LARGEST_SCALE = 0.8, 1.25
"""Beyond a fifth it is a wrong range, not a scale error: cheap accelerometers do read 1.1 g."""
SCALE_KNOWN_AFTER, ELEVATOR_SHARE = 4, 0.02
"""After so many spans of rest the scale is known, and a change by a larger share is a lift starting or stopping."""
SUSPECT_SHARE = 0.15
"""An accelerometer that is further from 1 g at rest than by this share is to be looked at."""
LEVEL_SPAN, REST_SPAN = 0.25, 0.5
"""Lengths of the spans in which a foot is looked at for its first attitude, and for what is learnt at rest, s."""
LEVEL_ACC = 0.6
"""Standard deviation of acc that still counts as quiet, m/s^2; eight-bit accelerometers flicker by 0.3."""
LEVEL_GYRO = 0.1
"""The same of the angular rate, rad/s; its mean says nothing yet, since cheap gyroscopes are off by 0.3 at rest."""
SHORT_SPAN, LONGEST_STRIDE, LEVEL_PATIENCE = 0.06, 1.3, 3.0
"""Of a foot that walks already: the length of a moment, that of any stride, and when any attitude will do, s."""
MOTION_RATIO = 4.0
"""How much louder than the quietest moment, in squares, another may be."""
RATE_PER_ACC = 0.3
"""What turns the foot at this rate, rad/s, is as loud as 1 m/s^2."""
STILL_ACC = 0.35
"""Largest standard deviation of acc at rest, m/s^2, that of its counts aside."""
STILL_GYRO = 0.02
"""Largest standard deviation of the rate at rest, rad/s: a standing foot, not one in mid-stance."""
LARGEST_BIAS = 0.8
"""A steadier rate than noise and yet larger than this is a turn, not a bias, rad/s; cheap gyroscopes start with
0.35 and more."""
LARGEST_CHANGE = 0.5
"""The same once a bias is known, for how far from that the rate is, rad/s."""


@define
class SampleSpan:
    """Running sums over one span of samples."""

    count: int = 0
    acc: Vec3 = ZERO
    gyro: Vec3 = ZERO
    acc_squares: float = 0.0
    gyro_squares: float = 0.0

    def add(self, acc: Vec3, gyro: Vec3) -> None:
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
        k = 1.0 / self.count
        (ax, ay, az), (gx, gy, gz) = self.acc, self.gyro
        return (ax * k, ay * k, az * k), (gx * k, gy * k, gz * k)

    def variances(self) -> tuple[float, float]:
        """Of acc, (m/s^2)^2, and of gyro, (rad/s)^2, summed over the axes."""
        (ax, ay, az), (gx, gy, gz) = self.means()
        return (
            max(0.0, self.acc_squares / self.count - (ax * ax + ay * ay + az * az)),
            max(0.0, self.gyro_squares / self.count - (gx * gx + gy * gy + gz * gz)),
        )


@define
class Levelling:
    """The first attitude: gravity over the first quiet quarter of a second; of a foot that walks already, over the
    middle of a stance.

    That is a span of MOMENT that is about as quiet as the quietest was so far, once LONGEST_STRIDE was seen; after
    LEVEL_PATIENCE it is any. Heading is left as it is (the smallest turn that takes the measured up to up).
    """

    span: SampleSpan = field(factory=SampleSpan, init=False)
    short_span: SampleSpan = field(factory=SampleSpan, init=False)
    short_span_start: float = field(default=0.0, init=False)
    least_motion: float = field(default=ABOVE_ANY_MOTION, init=False)
    """(m/s^2)^2."""
    span_start: float = field(default=0.0, init=False)
    started_at: float | None = field(default=None, init=False)

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> tuple[Quat, float] | None:
        """(attitude, standard deviation of its tilt in rad) once it is known."""
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
        """As `update`, of a foot that never stands for a quarter of a second."""
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
    """Gyroscope bias and accelerometer scale, learnt from spans of rest."""

    span: SampleSpan = field(factory=SampleSpan, init=False)
    span_start: float | None = field(default=None, init=False)
    bias: Vec3 = field(default=ZERO, init=False)
    """Of the gyroscope, rad/s."""
    scale: float = field(default=1.0, init=False)
    """What to multiply acc by so that it reads 1 g at rest."""
    count: int = field(default=0, init=False)
    magnitude: float | None = field(default=None, init=False)
    """|acc| of the last rest, m/s^2."""
    grain: float = field(default=COARSEST_COUNT, init=False)
    """What one count of the accelerometer is worth, m/s^2: the least by which two readings were seen to differ."""
    last: Vec3 = field(default=ZERO, init=False)
    """The last raw acc, m/s^2."""

    def reset(self) -> None:
        """Times begin anew: the span under way is given up, what was learnt stays."""
        self.span = SampleSpan()
        self.span_start = None

    def calibrate(self, acc: Vec3, gyro: Vec3) -> tuple[Vec3, Vec3]:
        """What the sensor said without its scale and bias, m/s^2 and rad/s."""
        k, (bx, by, bz) = self.scale, self.bias
        return (acc[0] * k, acc[1] * k, acc[2] * k), (gyro[0] - bx, gyro[1] - by, gyro[2] - bz)

    def update(self, t: float, acc: Vec3, gyro: Vec3) -> bool:
        """One raw sample; True when a span of rest was learnt from."""
        if self.span_start is None:
            self.span_start = t
        # as SampleSpan.add, which would be a call more (tests/foot/test_alike.py holds both equal)
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
        # between two neighbouring counts a steady reading flickers, on any axis, with a variance of up to a quarter
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
        if LEAST_SCALE < scale < LARGEST_SCALE and (self.count < SCALE_KNOWN_AFTER or abs(scale / self.scale - 1.0) < ELEVATOR_SHARE):
            self.scale += (scale - self.scale) / spans
        weight = 1.0 / spans
        x, y, z = self.bias
        self.bias = (x + (gx - x) * weight, y + (gy - y) * weight, z + (gz - z) * weight)
        self.count += 1
        return True


def check_scale(t: float, known_at: float, site: Site, magnitude: float | None) -> ScaleSuspect | None:
    """What to say of an accelerometer that reads `magnitude` at rest, m/s^2: nothing as long as that is about 1 g."""
    if magnitude is None or 1.0 - SUSPECT_SHARE < magnitude / GRAVITY < 1.0 + SUSPECT_SHARE:
        return None
    ratio = GRAVITY / magnitude if magnitude > 0.0 else inf
    suggestion = f"multiply acc by {ratio:.3g}" if isfinite(ratio) else "acc reads nothing at all"
    return ScaleSuspect(t=t, known_at=known_at, site=site, magnitude=magnitude, suggestion=suggestion)
