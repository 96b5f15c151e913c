"""Detection of a gyroscope whose axes are mirrored or exchanged against those of the accelerometer."""

from __future__ import annotations

from itertools import permutations, product
from math import log, pi, sqrt
from typing import Final

from ...events import Defect
from ...types import Vec3
from ...types.attrs import define, field
from ...types.vector import IDENTITY, ZERO, multiply
from .stances import FORCE, TICK, TURN, Axes, ClosedStride, Finding, Interval

# Closure of the velocity of a stride, for each way in which the gyroscope's axes can be mounted.
#
# From stance to stance the velocity does not change. So the mean of the specific force, turned by the integrated
# angular rate into the frame of the stride's beginning, is gravity upwards: the integral of R(t) a(t) dt equals g T u,
# with u the direction of the specific force in stance. This fails when the axes of the gyroscope do not belong to those
# of the accelerometer. The 48 signed permutations P of the axes need two integrations only. With M_ijk the integral of
# R_ij a_k dt, a proper rotation P turns R into P R P^T, so that the integral becomes, in components, s_i * sum over k
# of s_k * M(p_i, p_k, k), with p_i the axis and s_i the sign of row i of P. An improper P is the negative of a proper
# one, and needs M of the negative angular rate.


def _row(axis: int) -> tuple[int, float]:
    return abs(axis) - 1, 1.0 if axis > 0 else -1.0


AXES: Final[tuple[Axes, ...]] = tuple(
    (a * i, b * j, c * k) for i, j, k in permutations((1, 2, 3)) for a, b, c in product((1, -1), repeat=3)
)
"""The signed permutations; the first one leaves the axes as they are."""
ARE_PROPER: Final[tuple[bool, ...]] = tuple(
    (a * b * c > 0) == ((abs(a), abs(b), abs(c)) in ((1, 2, 3), (2, 3, 1), (3, 1, 2))) for a, b, c in AXES
)
"""For each of AXES, whether it is a rotation; the others are rotations with a mirror."""
SignedAxis = tuple[int, float]
"""Axis of the gyroscope, 0 to 2, and sign, 1.0 or -1.0, that belong to an axis of the accelerometer."""
Rows = tuple[SignedAxis, SignedAxis, SignedAxis]
"""The rows of a signed permutation."""
ROWS: Final[tuple[Rows, ...]] = tuple((_row(a), _row(b), _row(c)) for a, b, c in AXES)
"""AXES in the form in which they are computed with."""
Step = tuple[float, float, float, float, float, float, float]
"""Rotation between the middles of two intervals, and the share of the latter in the mean specific force, m/s^2."""
NO_MOTION: Final[Interval] = (0, 0, 0, 0, 0, 0, 0)
"""An interval of no duration, which ends a stride."""
LEAST_RESIDUAL = 0.05
"""Residual, m/s^2, that is added to each one, so that a nearly perfect closure does not count without limit."""


def closure_residuals(stride: ClosedStride) -> list[float] | None:
    """Return the natural logarithm of the residual for each of AXES; None without any gravity.

    The residual is the worse one of the two ends of the stride, |S / T - g u|, m/s^2."""
    g = 0.5 * (_norm(stride.first) + _norm(stride.last))
    if g <= 0.0:
        return None
    steps = _steps(stride)
    up_first, up_last = _scaled(stride.first, g), _scaled(stride.last, g)
    proper, improper = _integrals(steps, 1.0, up_last), _integrals(steps, -1.0, up_last)
    return [
        log(_residual(rows, proper if is_proper else improper, up_first) + LEAST_RESIDUAL)
        for rows, is_proper in zip(ROWS, ARE_PROPER, strict=True)
    ]


def _steps(stride: ClosedStride) -> list[Step]:
    """Return the rotation to the middle of each interval, and a last one to the end of the stride without a force."""
    steps: list[Step] = []
    before_x = before_y = before_z = 0.0
    unit, scale = 0.5 * TURN, FORCE * TICK / stride.duration
    for duration, tx, ty, tz, ax, ay, az in (*stride.intervals, NO_MOTION):
        half_x, half_y, half_z = unit * tx, unit * ty, unit * tz
        x, y, z = before_x + half_x, before_y + half_y, before_z + half_z
        square = 0.25 * (x * x + y * y + z * z)
        # sin(h) / (2 h) and cos(h), h half of the angle, to 1e-5 up to an angle of 1.7 rad: a fast swing at 10 Hz
        k = 0.5 - square * (1.0 / 12.0 - square * (1.0 / 240.0 - square / 10080.0))
        e = 1.0 - square * (0.5 - square * (1.0 / 24.0 - square / 720.0))
        share = scale * duration
        steps.append((e, k * x, k * y, k * z, share * ax, share * ay, share * az))
        before_x, before_y, before_z = half_x, half_y, half_z
    return steps


def _integrals(steps: list[Step], sign: float, up_last: Vec3) -> list[tuple[Vec3, Vec3]]:
    """Return the rows 3 i + j of M / T, each over k, m/s^2, and what is left of each without gravity at the end.

    `sign` is that of the rate, and `up_last` gravity at the stride's last end."""
    attitude, sums = IDENTITY, [ZERO] * 9
    for e, p, q, r, a, b, c in steps:
        w, x, y, z = attitude = multiply(attitude, (e, sign * p, sign * q, sign * r))
        twice_x, twice_y, twice_z = x + x, y + y, z + z
        xx, yy, zz, xy = twice_x * x, twice_y * y, twice_z * z, twice_x * y
        xz, yz, wx, wy, wz = twice_x * z, twice_y * z, twice_x * w, twice_y * w, twice_z * w
        turn = [1.0 - yy - zz, xy - wz, xz + wy, xy + wz, 1.0 - xx - zz, yz - wx, xz - wy, yz + wx, 1.0 - xx - yy]
        sums = [(x + r * a, y + r * b, z + r * c) for (x, y, z), r in zip(sums, turn, strict=True)]
    turn[::4] = 1.0 - (yy + zz), 1.0 - (xx + zz), 1.0 - (xx + yy)
    u, v, w = up_last
    return [((x, y, z), (x - r * u, y - r * v, z - r * w)) for (x, y, z), r in zip(sums, turn, strict=True)]


def _residual(rows: Rows, ends: list[tuple[Vec3, Vec3]], up_first: Vec3) -> float:
    """Return the worse of the residuals |S / T - g u| of the two ends, m/s^2."""
    (q0, r0), (q1, r1), (q2, r2) = rows
    from_first = from_last = 0.0
    for (p, s), up in zip(rows, up_first, strict=True):
        i = 3 * p
        (x, _, _), (last_x, _, _) = ends[i + q0]
        (_, y, _), (_, last_y, _) = ends[i + q1]
        (_, _, z), (_, _, last_z) = ends[i + q2]
        force = r0 * x + r1 * y + r2 * z - s * up  # in the gyroscope's frame; the size is the same
        rest = r0 * last_x + r1 * last_y + r2 * last_z
        from_first += force * force
        from_last += rest * rest
    return sqrt(max(from_first, from_last))


def _norm(v: Vec3) -> float:
    x, y, z = v
    return sqrt(x * x + y * y + z * z)


def _scaled(v: Vec3, size: float) -> Vec3:
    x, y, z = v
    n = _norm(v)
    k = size / n if n > 0.0 else 0.0
    return k * x, k * y, k * z


SHORTEST_STRIDE, LONGEST_STRIDE = 0.8, 2.5
"""Duration of strides that count, s: those of a walk. A runner's foot is never still, so its strides do not close."""
LEAST_STRIDES, SETTLED_STRIDES, MOST_STRIDES = 3, 6, 40
"""Number of strides before axes can be right or wrong, before a correction is known, and after which none is added."""
LEAST_EVIDENCE, EVIDENCE_PER_STRIDE = 1.5, 0.05
"""Evidence, the sum over strides of the logarithm of a ratio of residuals, that decides between two kinds of axes.

On 378 recordings of a foot, (1.5, 0.05), (1.0, 0.1) and (1.5, 0.1) find the same: docs/checks.md."""
LARGEST_LOG = 1.0
"""Limit of the evidence of one stride, which makes the sum robust."""
LARGEST_RESIDUAL = 2.5
"""Geometric mean of the residuals above which two sensors contradict each other, m/s^2.

Of 253 recordings of a foot, the largest is 2.0; with a gyroscope that reads twice the rate, 5 in 6 are above 2.5."""
CONTRADICTION = (
    "the gyroscope and the accelerometer do not describe the same motion: check the axes, units and ranges of both, the"
    " times, and that both are fixed to the same rigid part of the shoe"
)
"""Sentence on strides that close with no axes."""
DISTINCT_EVIDENCE = 0.5
"""Evidence by which the best axes must lead the second best before they are offered as a correction."""
LATEST_REPORT = 8.0
"""Time after the start of the first stride after which wrong axes are reported, with or without the right ones, s.

On 380 recordings of a foot, 8 and 16 s raise the same alarms; 6 s and 4 s raise one and three more."""
UNCERTAIN_FACTOR = 2.0
"""Factor of the evidence that is needed when strides close badly for another reason, a rate below 40 Hz.

With one sample in four of 191 recordings, which leaves no filter before it, 12 raise alarms with a factor of 1, and 2
with 2; of damaged ones, 96 and 83 in 100 are found, and 96 if the four are averaged."""


@define
class AxesCheck:
    """Evidence of a foot's strides for each of the 48 ways in which the axes may be mounted."""

    residuals: list[float] = field(factory=list)
    """Sum of the logarithms of the residuals, m/s^2, in the order of AXES; empty before the first stride."""
    evidence: list[float] = field(factory=list)
    """Sum of the logarithms of each residual's ratio to that of the axes as they are; negative if it is smaller."""
    strides: int = 0
    """Number of strides in `evidence`."""
    started_at: float = 0.0
    """Time at which the first stride began, s."""
    settled: bool = False
    """Flag: no more strides are needed."""
    uncertain: bool = False
    """Flag: samples are few, so that also right axes close badly."""

    def add(self, t: float, stride: ClosedStride) -> Finding | None:
        """Add a stride that is known at `t`, s; return that the axes are wrong, once it is time to report this.

        It is returned again when a correction is known."""
        if not SHORTEST_STRIDE < stride.duration < LONGEST_STRIDE or (logs := closure_residuals(stride)) is None:
            return None
        if not self.strides:
            self.started_at = t - stride.duration
            self.residuals, self.evidence = [0.0] * len(AXES), [0.0] * len(AXES)
        self.strides += 1
        self.residuals = [a + b for a, b in zip(self.residuals, logs, strict=True)]
        ratios = [max(-LARGEST_LOG, min(LARGEST_LOG, value - logs[0])) for value in logs]
        self.evidence = [a + b for a, b in zip(self.evidence, ratios, strict=True)]
        enough = self.strides >= SETTLED_STRIDES
        if not self.wrong:
            closes = self.uncertain or self.residuals[0] <= self.strides * log(LARGEST_RESIDUAL)
            fits = self.strides >= LEAST_STRIDES and min(self.evidence[1:]) > self.needed
            self.settled = (fits and (closes or enough)) or self.strides >= MOST_STRIDES
            return Finding(Defect.CONTRADICTION, CONTRADICTION) if enough and not closes else None
        self.settled = (enough and self.correction is not None) or self.strides >= MOST_STRIDES
        return self.finding if self.settled or t - self.started_at > LATEST_REPORT else None

    @property
    def wrong(self) -> bool:
        """Return whether other axes fit clearly better than the axes as they are."""
        return self.strides >= LEAST_STRIDES and min(self.evidence) < -self.needed

    @property
    def needed(self) -> float:
        """The evidence that decides between two kinds of axes after this number of strides."""
        evidence = LEAST_EVIDENCE + EVIDENCE_PER_STRIDE * self.strides
        return UNCERTAIN_FACTOR * evidence if self.uncertain else evidence

    @property
    def finding(self) -> Finding:
        """The finding of axes that are `wrong`; other axes explain that only if the strides close with them."""
        best = self.residuals[self.evidence.index(min(self.evidence))]
        if best > self.strides * log(LARGEST_RESIDUAL):
            return Finding(Defect.CONTRADICTION, CONTRADICTION)
        return wrong_axes(self.correction)

    @property
    def correction(self) -> Axes | None:
        """The axes that fit best; None if others fit about as well."""
        best, second = sorted(self.evidence)[:2]
        return AXES[self.evidence.index(best)] if second - best > DISTINCT_EVIDENCE else None


def wrong_axes(axes: Axes | None) -> Finding:
    """Return the finding of wrong axes, with the axes that fit, if they are known."""
    text = "the axes of the gyroscope do not fit those of the accelerometer: one of them is mirrored or exchanged"
    if axes is None:
        return Finding(Defect.AXES, f"{text}; compare both with the data sheet of the sensor")
    words = " ".join(f"{'-' if axis < 0 else '+'}{'xyz'[abs(axis) - 1]}" for axis in axes)
    return Finding(Defect.AXES, f"{text}; the gyroscope's axes {words} fit the accelerometer's +x +y +z", axes=axes)


# Detection of a sensor that is filtered so much that it does not follow the impacts and the swing of a foot.

LEAST_ACC, LEAST_GYRO = 2.6, 2.0
"""Usual number of cycles a stride of specific force and of angular rate below which they are filtered.

It is a number for each stride, because all that a slow walker does is slow. Of 375 recordings of a foot, the smallest
are 3.2 and 2.5, of emulated walks at 0.3 m/s 3.7 and 2.1. Averaged over 0.33 s, with which a tracker loses stances, 95
in 100 are below 2.2 and 1.9."""
STRIDES = 6
"""Number of strides whose median is judged."""


@define
class BandwidthCheck:
    """Looks at how fast the specific force and the angular rate change over a stride."""

    acc: list[float] = field(factory=list)
    """Number of cycles of the specific force in each stride."""
    gyro: list[float] = field(factory=list)
    """Number of cycles of the angular rate in each stride."""

    def add(self, stride: ClosedStride) -> Finding | None:
        """Add a stride; return which sensor is filtered, once there are enough strides; they are judged once."""
        if self.judged or not SHORTEST_STRIDE < stride.duration < LONGEST_STRIDE:
            return None
        rates, forces = [], []
        for duration, tx, ty, tz, ax, ay, az in stride.intervals:
            k = TURN / (TICK * duration)
            rates.append((k * tx, k * ty, k * tz))
            forces.append((FORCE * ax, FORCE * ay, FORCE * az))
        self.acc.append(_cycles(forces))
        self.gyro.append(_cycles(rates))
        if not self.judged:
            return None
        acc_is_filtered = sorted(self.acc)[STRIDES // 2] < LEAST_ACC
        gyro_is_filtered = sorted(self.gyro)[STRIDES // 2] < LEAST_GYRO
        if not (acc_is_filtered or gyro_is_filtered):
            return None
        name = "the accelerometer is" if acc_is_filtered else "the gyroscope is"
        name = "both sensors are" if acc_is_filtered and gyro_is_filtered else name
        text = f"{name} filtered or averaged so much that a step is smoothed away: choose a bandwidth of 20 Hz or more"
        return Finding(Defect.BANDWIDTH, text)

    @property
    def judged(self) -> bool:
        """Return whether there were enough strides."""
        return len(self.acc) >= STRIDES


def _cycles(values: list[Vec3]) -> float:
    """Return the number of cycles of a signal in the duration of its values, by its root mean square frequency.

    A signal of n cycles changes by 2 pi n of its own size in that duration."""
    n = len(values)
    x = y = z = 0.0
    for a, b, c in values:
        x, y, z = x + a, y + b, z + c
    x, y, z = x / n, y / n, z / n
    power = change = 0.0
    last_a, last_b, last_c = values[0]
    for a, b, c in values:
        power += (a - x) ** 2 + (b - y) ** 2 + (c - z) ** 2
        change += (a - last_a) ** 2 + (b - last_b) ** 2 + (c - last_c) ** 2
        last_a, last_b, last_c = a, b, c
    return n * sqrt(change / power) / (2.0 * pi) if power > 0.0 else 0.0
