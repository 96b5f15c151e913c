"""Detection of a gyroscope that does not fit its accelerometer: other axes, another scale, or times that are wrong."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise, permutations, product
from math import dist, fsum, hypot, inf, log, pi, prod, sqrt
from typing import Final

from ...events import Defect
from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, IDENTITY, ZERO, add, dot, from_rotation_vector, multiply
from .stances import FORCE, NO_MOTION, TICK, TURN, Axes, ClosedStride, Finding

# Closure of the velocity of a stride, for each way in which the gyroscope's axes can be mounted.
#
# From stance to stance the velocity does not change. So the mean of the specific force, turned by the integrated
# angular rate into the frame of the stride's beginning, is gravity upwards: the integral of R(t) a(t) dt equals g T u,
# with u the direction of the specific force in stance. This fails when the axes of the gyroscope do not belong to those
# of the accelerometer. The 48 signed permutations P of the axes need two integrations only. With M_ijk the integral of
# R_ij a_k dt, a proper rotation P turns R into P R P^T, so that the integral becomes, in components, s_i * sum over k
# of s_k * M(p_i, p_k, k), with p_i the axis and s_i the sign of row i of P. An improper P is the negative of a proper
# one, and needs M of the negative angular rate. Gravity u_k, in the frame of an instant with the rotation R, is
# R_ij u_k in the same notation, so what is left without it is a residual of the same form.

Order = tuple[int, ...]
Signs = tuple[float, ...]
ORDERS: Final[tuple[Order, ...]] = tuple(permutations(range(3)))
"""Axis of the gyroscope, 0 to 2, that belongs to each axis of the accelerometer, in each permutation."""
ROTATIONS: Final = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
"""Those of ORDERS that are rotations; each of the others is one with a mirror."""
SIGNS: Final[tuple[Signs, ...]] = tuple(product((1.0, -1.0), repeat=3))
"""Signs of these axes."""
AXES: Final[tuple[Axes, ...]] = tuple(
    (int(a) * (i + 1), int(b) * (j + 1), int(c) * (k + 1)) for i, j, k in ORDERS for a, b, c in SIGNS
)
"""The signed permutations; the first one leaves the axes as they are."""
Turn = tuple[float, ...]
"""A rotation matrix, row by row."""
UNTURNED: Final[Turn] = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
WRONG_BY: Final = (1.5, 2.0, 4.0, 8.0)
"""Factors by which times or angular rates may be too large or too small: those between the ranges of a gyroscope (250,
500, 1000 and 2000 degrees/s), and one of a wrong rate."""
SCALES: Final = (*[1.0 / factor for factor in WRONG_BY], *WRONG_BY)
"""Factors of the turn that are tried too."""
NO_TURN = len(AXES) + len(SCALES)
"""Index of the residual of a gyroscope that reads nothing: what the turns have to explain. The others are measured by
it."""
NO_ENDS: Final = (inf,) * 6
"""Ends of the range of an accelerometer that cuts nothing off, m/s^2.

They are the upper and the lower end of x, then of y, then of z."""
CUT_SHARE, MOST_CUT = 0.9, 10.0
"""Share of an end from which on the mean of an interval is cut off, and the most that it may lack, m/s^2.

At ends of 2 g (hugadb) the median over the strides of a recording is 0 to 10; what is larger would explain wrong times
too."""
LEAST_RESIDUAL, LEAST_SHARE = 0.05, 0.1
"""Residual, m/s^2, and share of that without any turn, which are added to each residual.

A nearly perfect closure does not count without limit then, and one that is good enough for this walker is none."""


Rows = list[list[float]]
"""Rows 3 i + j over k of M_ijk / T."""


def closure_residuals(stride: ClosedStride, ends: Sequence[float] = NO_ENDS, enough: float = 0.0) -> list[float]:
    """Return the residual for each of AXES, SCALES and for NO_TURN, m/s^2.

    It is the worse one of the two ends of the stride, |S / T - g u + m d|. Peaks that are cut off at `ends` lack an
    impulse of unknown size m in known directions at known instants, which are turned and integrated to d.

    If the axes as they are leave at most the share `enough` of NO_TURN, no others are tried: they get its residual."""
    first, last = hypot(*stride.first), hypot(*stride.last)
    g = 0.5 * (first + last)
    ups = [[g / first * x for x in stride.first], [g / last * x for x in stride.last]]
    turns, before = [], ZERO
    for _, x, y, z, *_ in (*stride.intervals, NO_MOTION):  # from the middle of an interval to that of the next one
        half = 0.5 * TURN * x, 0.5 * TURN * y, 0.5 * TURN * z
        turns.append(add(before, half))
        before = half
    durations, _, _, _, *forces = zip(*stride.intervals, strict=True)
    parts = [TICK * duration / stride.duration for duration in durations]
    shares = [[FORCE * part * force for part, force in zip(parts, axis, strict=True)] for axis in forces]
    cut = [
        [
            part * ((FORCE * force > CUT_SHARE * upper) - (-FORCE * force > CUT_SHARE * lower))
            for part, force in zip(parts, axis, strict=True)
        ]
        for axis, upper, lower in zip(forces, ends[::2], ends[1::2], strict=True)
        if min(ends) < inf
    ]
    proper = _close(_turned(turns, 1.0), shares, cut, ups)
    still = _close([UNTURNED] * len(turns), shares, cut, ups)
    own, unturned = [_residual(ORDERS[0], SIGNS[0], closed) for closed in (proper, still)]
    least = LEAST_RESIDUAL + LEAST_SHARE * unturned
    if own + least <= enough * (unturned + least):
        return [own] + [unturned] * NO_TURN
    improper, *scaled = [_close(_turned(turns, factor), shares, cut, ups) for factor in (-1.0, *SCALES)]
    residuals = [
        _residual(order, signs, proper if (order in ROTATIONS) == (prod(signs) > 0.0) else improper)
        for order in ORDERS
        for signs in SIGNS
    ]
    return residuals + [_residual(ORDERS[0], SIGNS[0], closed) for closed in scaled] + [unturned]


def _turned(vectors: list[Vec3], factor: float) -> list[Turn]:
    """Return the rotation after each of the vectors, rad, times `factor`."""
    attitude, turns = IDENTITY, []
    for vector in vectors:
        attitude = multiply(attitude, from_rotation_vector(add(ZERO, vector, factor)))
        turns.append(_turn(attitude))
    return turns


def _close(
    turns: list[Turn], shares: list[list[float]], cut: list[list[float]], ups: list[list[float]]
) -> tuple[Rows | None, Rows, Rows]:
    """Return M / T of what is cut off, None without it, and for each end of the stride M / T without gravity, m/s^2.

    `turns` are the rotations in the middle of each interval and at the end, `shares` the parts that the intervals have
    in each axis of the mean specific force, m/s^2, `cut` those of 1 m/s^2 more where it is cut off, and `ups` is
    gravity at both ends."""
    columns = [*zip(*turns[:-1], strict=True)]
    sums = _products(columns, shares)
    first, last = [
        [[x - r * u for x, u in zip(row, up, strict=True)] for row, r in zip(sums, turn, strict=True)]
        for turn, up in zip((UNTURNED, turns[-1]), ups, strict=True)
    ]
    return _products(columns, cut) if any(map(any, cut)) else None, first, last


def _products(columns: list[tuple[float, ...]], axes: list[list[float]]) -> Rows:
    """Return the products of each of `columns` with each of `axes`.

    They are computed by the distance of the vectors, because that loop runs in C: 2 c s = c c + s s - |c - s|^2."""
    squares = [hypot(*axis) ** 2 for axis in axes]
    return [
        [0.5 * (cc + ss - dist(column, axis) ** 2) for axis, ss in zip(axes, squares, strict=True)]
        for column in columns
        for cc in [hypot(*column) ** 2]
    ]


def _turn(attitude: Quat) -> Turn:
    """Return the rotation matrix of an attitude."""
    w, x, y, z = attitude
    twice_x, twice_y, twice_z = x + x, y + y, z + z
    xx, yy, zz, xy = twice_x * x, twice_y * y, twice_z * z, twice_x * y
    xz, yz, wx, wy, wz = twice_x * z, twice_y * z, twice_x * w, twice_y * w, twice_z * w
    return 1.0 - yy - zz, xy - wz, xz + wy, xy + wz, 1.0 - xx - zz, yz - wx, xz - wy, yz + wx, 1.0 - xx - yy


def _residual(order: Order, signs: Signs, closed: tuple[Rows | None, Rows, Rows]) -> float:
    """Return the worse of the residuals |S / T - g u + m d| of the two ends, m/s^2, in the gyroscope's frame."""
    cut, *ends = closed
    missing = ZERO if cut is None else _mounted(order, signs, cut)
    length = hypot(*missing)
    largest = 0.0
    for rows in ends:
        force = _mounted(order, signs, rows)
        if length > 0.0:
            force = add(force, missing, max(0.0, min(MOST_CUT, -dot(force, missing) / length**2)))
        largest = max(largest, hypot(*force))
    return largest


def _mounted(order: Order, signs: Signs, rows: Rows) -> Vec3:
    """Return the sums over j and k with the gyroscope's axes in this order, with these signs."""
    (p, q, r), (a, b, c) = order, signs
    x, y, z = [a * rows[i + p][0] + b * rows[i + q][1] + c * rows[i + r][2] for i in (0, 3, 6)]
    return x, y, z


SHORTEST_STRIDE, LONGEST_STRIDE = 0.2, 6.5
"""Duration of strides that count, s: fast and slow walkers, by times that may be wrong by a factor of 3."""
LARGEST_DEVIATION = 0.3
"""Largest deviation from 1 g, as a part of it, with which strides count; with a larger one another unit is at fault."""
LEAST_STRIDES, SETTLED_STRIDES, MOST_STRIDES = 3, 6, 40
"""Number of strides before axes can be right or wrong, before a correction is known, and after which none is added."""
LEAST_EVIDENCE, EVIDENCE_PER_STRIDE = 1.5, 0.05
"""Evidence, the sum over strides of the logarithm of a ratio of residuals, that decides between two kinds of axes.

On 378 recordings of a foot, (1.5, 0.05), (1.0, 0.1) and (1.5, 0.1) find the same."""
LARGEST_LOG = 1.0
"""Limit of the evidence of one stride, which makes the sum robust."""
CLOSING = 0.75
"""Mean ratio of the residual to that without any turn up to which strides close.

It is the part of a stride's turn that the gyroscope leaves unexplained, so it does not depend on the pace: 0.04 to 0.3
in recordings, up to 0.45 where the specific force clips, about 0.55 with a gyroscope or a rate that is wrong by a
factor of 1.5, and 1 with one that is wrong by a factor of 2 and more."""
NEARLY_CLOSED = 0.24
"""The same ratio, least residuals included, up to which no other axes or scale can be the right ones.

A runner's stance is no rest, and whoever turns about one axis alone may close a little better with others. The axes of
75 recordings have 0.13 to 0.22 (median), mirrored and exchanged ones 0.25 and more, one in ten of them up to 0.45."""
CONTRADICTION = (
    "the gyroscope and the accelerometer do not describe the same motion: check the axes, units and ranges of both, the"
    " times, and that both are fixed to the same rigid part of the shoe"
)
"""Sentence on strides that close with no axes."""
WRONG_SCALES: Final = tuple(
    [
        f"by {one}, the foot turns about {factor:g} times as far as by {other}: the range of the gyroscope is declared"
        f" about {factor:g} times too {large}, or the times of the samples are too {long}, because the sensor measures"
        f" at a {higher} rate than is assumed"
        for one, other, large, long, higher in (
            ("the gyroscope", "gravity", "large", "far apart", "higher"),
            ("gravity", "the gyroscope", "small", "close", "lower"),
        )
        for factor in WRONG_BY
    ]
)
"""Sentence on strides that close with a turn by each of SCALES; times and rates cannot be told apart."""
DISTINCT_EVIDENCE = 0.5
"""Evidence by which the best axes must lead the second best before they are offered as a correction."""
LATEST_REPORT = 8.0
"""Time after the start of the first stride after which wrong axes are reported, with or without the right ones, s.

On 380 recordings of a foot, 8 and 16 s raise the same alarms; 6 s and 4 s raise one and three more."""
LARGEST_FACTOR = 2.0
"""Largest factor of the evidence that is needed when strides close badly for another reason, a rate below 40 Hz.

With one sample in four of 191 recordings, which leaves no filter before it, 12 raise alarms with a factor of 1, and 2
with 2; of damaged ones, 96 and 83 in 100 are found, and 96 if the four are averaged."""


@define
class AxesCheck:
    """Evidence of a foot's strides for each of the 48 ways in which the axes may be mounted."""

    residuals: list[float] = field(factory=list)
    """Sum of the logarithms of the residuals, m/s^2, in the order of AXES, SCALES and NO_TURN; empty before the first
    stride. Axes that were not tried with a stride have the residual of NO_TURN."""
    evidence: list[float] = field(factory=list)
    """Sum of the logarithms of each residual's ratio to that of the axes as they are; negative if it is smaller.

    While none is negative, strides that nearly close with the axes as they are add nothing."""
    strides: int = 0
    """Number of strides in `evidence`."""
    started_at: float = 0.0
    """Time at which the first stride began, s."""
    settled: bool = False
    """Flag: no more strides are needed."""
    factor: float = 1.0
    """Factor of the evidence that is needed: more than 1 if samples are few, or repeat values, so that also right axes
    close badly."""

    def add(self, t: float, stride: ClosedStride, ends: Sequence[float] = NO_ENDS) -> Finding | None:
        """Add a stride that is known at `t`, s; return that the axes are wrong, once it is time to report this.

        Peaks of the specific force are cut off at `ends`. It is returned again when a correction is known."""
        deviation = max([abs(hypot(*force) / GRAVITY - 1.0) for force in (stride.first, stride.last)])
        if not SHORTEST_STRIDE < stride.duration < LONGEST_STRIDE or deviation > LARGEST_DEVIATION:
            return None
        leads = min(self.evidence, default=0.0) < 0.0  # other axes, or another scale
        residuals = closure_residuals(stride, ends, 0.0 if leads else NEARLY_CLOSED)
        least = LEAST_RESIDUAL + LEAST_SHARE * residuals[NO_TURN]
        logs = [log(residual + least) for residual in residuals]
        if not self.strides:
            self.started_at = t - stride.duration
            self.residuals, self.evidence = [0.0] * len(logs), [0.0] * len(logs)
        self.strides += 1
        self.residuals = [a + b for a, b in zip(self.residuals, logs, strict=True)]
        if leads or logs[0] - logs[NO_TURN] > log(NEARLY_CLOSED):  # others were tried
            ratios = [max(-LARGEST_LOG, min(LARGEST_LOG, value - logs[0])) for value in logs]
            self.evidence = [a + b for a, b in zip(self.evidence, ratios, strict=True)]
        enough = self.strides >= SETTLED_STRIDES
        if not self.wrong:
            closes = self.factor > 1.0 or self._closes(0)
            fits = self.strides >= LEAST_STRIDES and min(self.evidence[1:]) > self.needed
            fits = fits or (enough and self._closes(0, NEARLY_CLOSED))
            self.settled = (fits and (closes or enough)) or self.strides >= MOST_STRIDES
            return Finding(Defect.CONTRADICTION, CONTRADICTION) if enough and not closes else None
        self.settled = (enough and self._best is not None) or self.strides >= MOST_STRIDES
        return self.finding if self.settled or t - self.started_at > LATEST_REPORT else None

    def _closes(self, best: int, limit: float = CLOSING) -> bool:
        """Return whether the strides close with one of the axes or scales."""
        return self.residuals[best] - self.residuals[NO_TURN] <= self.strides * log(limit)

    @property
    def wrong(self) -> bool:
        """Return whether other axes, or another scale, fit clearly better than the axes as they are."""
        is_better = self.strides >= LEAST_STRIDES and min(self.evidence) < -self.needed
        return is_better and not self._closes(0, NEARLY_CLOSED)

    @property
    def needed(self) -> float:
        """The evidence that decides between two kinds of axes after this number of strides."""
        return self.factor * (LEAST_EVIDENCE + EVIDENCE_PER_STRIDE * self.strides)

    @property
    def finding(self) -> Finding:
        """The finding of axes that are `wrong`; other axes explain that only if the strides close with them."""
        best = self.evidence.index(min(self.evidence))
        if not self._closes(best):
            return Finding(Defect.CONTRADICTION, CONTRADICTION)
        if best < len(AXES):
            return wrong_axes(self.correction)
        return Finding(Defect.CONTRADICTION, WRONG_SCALES[best - len(AXES)])

    @property
    def correction(self) -> Axes | None:
        """The axes that fit best; None if others fit about as well, or if it is the scale that is wrong."""
        return AXES[self._best] if self._best is not None and self._best < len(AXES) else None

    @property
    def _best(self) -> int | None:
        """The number of the axes or the scale that fits best; None if others fit about as well."""
        best, second = sorted(self.evidence)[:2]
        return self.evidence.index(best) if second - best > DISTINCT_EVIDENCE else None


def wrong_axes(axes: Axes | None) -> Finding:
    """Return the finding of wrong axes, with the axes that fit, if they are known."""
    text = "the axes of the gyroscope do not fit those of the accelerometer: one of them is mirrored or exchanged"
    if axes is None:
        return Finding(Defect.AXES, f"{text}; compare both with the data sheet of the sensor")
    words = " ".join(f"{'-' if axis < 0 else '+'}{'xyz'[abs(axis) - 1]}" for axis in axes)
    return Finding(Defect.AXES, f"{text}; the gyroscope's axes {words} fit the accelerometer's +x +y +z", axes=axes)


# Detection of a sensor that is filtered so much that it does not follow the impacts and the swing of a foot.

LEAST_ACC, LEAST_GYRO = 2.6, 1.8
"""Usual number of cycles a stride of specific force and of angular rate below which they are filtered.

It is a number for each stride, because all that a slow walker does is slow. Of 375 recordings of a foot, the smallest
are 3.2 and 2.5, of emulated walks at 0.3 m/s 3.7 and 2.1. Averaged over 0.33 s, with which a tracker loses stances, 95
in 100 are below 2.2 and 1.9."""
USUAL_TIME = 1.1
"""Usual duration of a stride, s: a runner's is shorter and has no more cycles, but quicker ones (assumed)."""
STRIDES = 6
"""Number of strides whose median is judged."""


@define
class BandwidthCheck:
    """Looks at how fast the specific force and the angular rate change over a stride."""

    cycles: list[tuple[float, float]] = field(factory=list)
    """Number of cycles of the specific force, and of the angular rate, in each stride or, if that is shorter, in
    `USUAL_TIME`."""

    def add(self, stride: ClosedStride) -> Finding | None:
        """Add a stride; return which sensor is filtered, once there are enough strides; they are judged once."""
        if self.judged or not SHORTEST_STRIDE < stride.duration < LONGEST_STRIDE:
            return None
        forces = [(x, y, z) for _, _, _, _, x, y, z in stride.intervals]
        rates = [(x / duration, y / duration, z / duration) for duration, x, y, z, _, _, _ in stride.intervals]
        strides = max(1.0, USUAL_TIME / stride.duration)
        self.cycles.append((strides * _cycles(forces), strides * _cycles(rates)))
        if not self.judged:
            return None
        acc, gyro = [sorted(cycles)[STRIDES // 2] for cycles in zip(*self.cycles, strict=True)]
        if acc >= LEAST_ACC and gyro >= LEAST_GYRO:
            return None
        name = "the accelerometer is" if gyro >= LEAST_GYRO else "the gyroscope is"
        name = "both sensors are" if acc < LEAST_ACC and gyro < LEAST_GYRO else name
        text = f"{name} filtered or averaged so much that a step is smoothed away: choose a bandwidth of 20 Hz or more"
        return Finding(Defect.BANDWIDTH, text)

    @property
    def judged(self) -> bool:
        """Return whether there were enough strides."""
        return len(self.cycles) >= STRIDES


def _cycles(values: Sequence[Vec3]) -> float:
    """Return the number of cycles of a signal in the duration of its values, by its root mean square frequency.

    A signal of n cycles changes by 2 pi n of its own size in that duration; the unit does not matter."""
    n = len(values)
    mean = [fsum(axis) / n for axis in zip(*values, strict=True)]
    power = fsum([dist(value, mean) ** 2 for value in values])
    change = fsum([dist(a, b) ** 2 for a, b in pairwise(values)])
    return n * sqrt(change / power) / (2.0 * pi) if power > 0.0 else 0.0
