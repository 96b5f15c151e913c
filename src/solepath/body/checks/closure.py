"""Closure of the velocity of a stride, for each way in which the gyroscope's axes can be mounted.

From stance to stance the velocity does not change. So the mean of the specific force, turned by the integrated angular
rate into the frame of the stride's beginning, is gravity upwards: the integral of R(t) a(t) dt equals g T u, with u the
direction of the specific force in stance. This fails when the axes of the gyroscope do not belong to those of the
accelerometer. The 48 signed permutations P of the axes need two integrations only. With M_ijk the integral of R_ij a_k
dt, a proper rotation P turns R into P R P^T, so that the integral becomes, in components,
s_i * sum over k of s_k * M(p_i, p_k, k), with p_i the axis and s_i the sign of row i of P. An improper P is the
negative of a proper one, and needs M of the negative angular rate."""

from __future__ import annotations

from itertools import permutations, product
from math import log, sqrt
from typing import Final

from ...types import Vec3
from .stances import FORCE, TICK, TURN, ClosedStride, Interval

Axes = tuple[int, int, int]
"""Gyroscope axis, 1 to 3, for each accelerometer axis; negative for the opposite direction."""
Matrix = tuple[Vec3, Vec3, Vec3]
"""Matrix by rows."""


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
LEAST_RESIDUAL = 0.05
"""Residual, m/s^2, that is added to each one, so that a nearly perfect closure does not count without limit."""


def closure_residuals(stride: ClosedStride) -> list[float] | None:
    """Return the natural logarithm of the residual for each of AXES; None without any gravity.

    The residual is the worse one of the two ends of the stride, m/s^2."""
    g = 0.5 * (_norm(stride.first) + _norm(stride.last))
    if g <= 0.0:
        return None
    first, last = _unit(stride.first), _unit(stride.last)
    proper, improper = _integrals(stride.intervals, 1.0), _integrals(stride.intervals, -1.0)
    return [
        log(_residual(rows, proper if is_proper else improper, 1.0 / stride.duration, first, last, g) + LEAST_RESIDUAL)
        for rows, is_proper in zip(ROWS, ARE_PROPER, strict=True)
    ]


def _integrals(intervals: tuple[Interval, ...], sign: float) -> tuple[list[Vec3], Matrix]:
    """Return M as rows 3 i + j, each over k, m/s, and the rotation of the whole stride; `sign` is that of the rate."""
    w, x, y, z = 1.0, 0.0, 0.0, 0.0
    before_x = before_y = before_z = 0.0
    m000 = m001 = m002 = m010 = m011 = m012 = m020 = m021 = m022 = 0.0
    m100 = m101 = m102 = m110 = m111 = m112 = m120 = m121 = m122 = 0.0
    m200 = m201 = m202 = m210 = m211 = m212 = m220 = m221 = m222 = 0.0
    unit = 0.5 * sign * TURN
    for duration, tx, ty, tz, ax, ay, az in intervals:
        half_x, half_y, half_z = unit * tx, unit * ty, unit * tz
        # from the middle of the interval before to the middle of this one
        w, x, y, z = _turned(w, x, y, z, before_x + half_x, before_y + half_y, before_z + half_z)
        before_x, before_y, before_z = half_x, half_y, half_z
        scale = FORCE * TICK * duration
        a, b, c = scale * ax, scale * ay, scale * az
        xx, yy, zz = 2.0 * x * x, 2.0 * y * y, 2.0 * z * z
        xy, xz, yz, wx, wy, wz = 2.0 * x * y, 2.0 * x * z, 2.0 * y * z, 2.0 * w * x, 2.0 * w * y, 2.0 * w * z
        r = 1.0 - yy - zz
        m000, m001, m002 = m000 + r * a, m001 + r * b, m002 + r * c
        r = xy - wz
        m010, m011, m012 = m010 + r * a, m011 + r * b, m012 + r * c
        r = xz + wy
        m020, m021, m022 = m020 + r * a, m021 + r * b, m022 + r * c
        r = xy + wz
        m100, m101, m102 = m100 + r * a, m101 + r * b, m102 + r * c
        r = 1.0 - xx - zz
        m110, m111, m112 = m110 + r * a, m111 + r * b, m112 + r * c
        r = yz - wx
        m120, m121, m122 = m120 + r * a, m121 + r * b, m122 + r * c
        r = xz - wy
        m200, m201, m202 = m200 + r * a, m201 + r * b, m202 + r * c
        r = yz + wx
        m210, m211, m212 = m210 + r * a, m211 + r * b, m212 + r * c
        r = 1.0 - xx - yy
        m220, m221, m222 = m220 + r * a, m221 + r * b, m222 + r * c
    sums = [
        (m000, m001, m002), (m010, m011, m012), (m020, m021, m022),
        (m100, m101, m102), (m110, m111, m112), (m120, m121, m122),
        (m200, m201, m202), (m210, m211, m212), (m220, m221, m222),
    ]  # fmt: skip
    return sums, _matrix(*_turned(w, x, y, z, before_x, before_y, before_z))


def _turned(w: float, x: float, y: float, z: float, a: float, b: float, c: float) -> tuple[float, float, float, float]:
    """Return the quaternion (w, x, y, z) times that of the rotation vector (a, b, c), rad, normalised."""
    square = 0.25 * (a * a + b * b + c * c)
    k = 0.5 - square * (1.0 / 12.0 - square / 240.0)  # sin(h) / (2 h), h half of the angle
    e = 1.0 - square * (0.5 - square / 24.0)  # cos(h)
    a, b, c = k * a, k * b, k * c
    w, x, y, z = (
        w * e - x * a - y * b - z * c,
        w * a + x * e + y * c - z * b,
        w * b - x * c + y * e + z * a,
        w * c + x * b - y * a + z * e,
    )
    n = 1.0 / sqrt(w * w + x * x + y * y + z * z)
    return w * n, x * n, y * n, z * n


def _matrix(w: float, x: float, y: float, z: float) -> Matrix:
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


def _residual(
    rows: Rows, integrals: tuple[list[Vec3], Matrix], per_time: float, first: Vec3, last: Vec3, g: float
) -> float:
    """Return the worse of the residuals |S / T - g u| of the two ends, m/s^2, in the accelerometer's frame."""
    sums, turn = integrals
    (q0, r0), (q1, r1), (q2, r2) = rows
    last0, last1, last2 = r0 * last[0], r1 * last[1], r2 * last[2]
    from_first = from_last = 0.0
    for (p, s), up in zip(rows, first, strict=True):
        i, turned = 3 * p, turn[p]
        force = s * per_time * (r0 * sums[i + q0][0] + r1 * sums[i + q1][1] + r2 * sums[i + q2][2])
        from_first += (force - g * up) ** 2
        from_last += (force - g * s * (turned[q0] * last0 + turned[q1] * last1 + turned[q2] * last2)) ** 2
    return sqrt(max(from_first, from_last))


def _norm(v: Vec3) -> float:
    x, y, z = v
    return sqrt(x * x + y * y + z * z)


def _unit(v: Vec3) -> Vec3:
    x, y, z = v
    n = _norm(v)
    k = 1.0 / n if n > 0.0 else 0.0
    return k * x, k * y, k * z
