"""Correction of the state by a clipped peak of the gyroscope (clipping.py), with its covariance.

A clipped turn of tenths of a radian gives a wrong tilt to all samples after it. Its axis is an axis of the sensor. So
the samples are integrated a second time, with the rate raised by a cubic whose integral is m (clipping.py). A third
integration with a slightly larger m gives the effect of an error of m on attitude, velocity and position. The error of
m is one unknown number in a known direction b,

    P <- P + sigma^2 b b',  b = d(p, v, theta) / dm

and the zero velocity of the next stance shows its size."""

from __future__ import annotations

from math import asin, fsum, sqrt
from typing import NamedTuple

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, IDENTITY, conjugate, from_rotation_vector, multiply, rotate
from .clipping import ClippedPeak
from .covariance import Covariance

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
    """The samples since the gyroscope came near the end of its range."""

    rows: list[Row] = field(factory=list, init=False)
    """Samples in order of time."""
    start_attitude: Quat = field(default=IDENTITY, init=False)
    """Attitude before the first row, sensor to navigation frame."""

    def add_sample(self, dt: float, gyro: Vec3, previous_rate: Vec3, acc: Vec3, attitude: Quat) -> None:
        """Add one sample; `previous_rate` and `attitude` are the rate and the attitude before it."""
        if not self.rows:
            self.start_attitude = attitude
        elif len(self.rows) >= MOST_ROWS:
            self.rows = [_join(a, b) for a, b in zip(self.rows[::2], self.rows[1::2], strict=True)]
        (x, y, z), (u, v, w) = gyro, previous_rate
        self.rows.append((dt, (0.5 * (x + u), 0.5 * (y + v), 0.5 * (z + w)), acc))

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
        vx = vy = vz = x = y = z = 0.0
        for (dt, (gx, gy, gz), acc), extra_rate in zip(self.rows, extra_rates, strict=True):
            if peak.axis == 0:
                gx += k * extra_rate
            elif peak.axis == 1:
                gy += k * extra_rate
            else:
                gz += k * extra_rate
            half_turn = from_rotation_vector((0.5 * dt * gx, 0.5 * dt * gy, 0.5 * dt * gz))
            q = multiply(q, half_turn)
            ax, ay, az = rotate(q, acc)
            q = multiply(q, half_turn)
            az -= GRAVITY
            x, y, z = x + (vx + 0.5 * ax * dt) * dt, y + (vy + 0.5 * ay * dt) * dt, z + (vz + 0.5 * az * dt) * dt
            vx, vy, vz = vx + ax * dt, vy + ay * dt, vz + az * dt
        return IntegratedMotion(q, (vx, vy, vz), (x, y, z))


def _join(a: Row, b: Row) -> Row:
    (t, (gx, gy, gz), (ax, ay, az)), (u, (hx, hy, hz), (bx, by, bz)) = a, b
    duration = t + u
    k = t / duration if duration > 0.0 else 0.5
    m = 1.0 - k
    return (
        duration,
        (k * gx + m * hx, k * gy + m * hy, k * gz + m * hz),
        (k * ax + m * bx, k * ay + m * by, k * az + m * bz),
    )


def difference(a: IntegratedMotion, b: IntegratedMotion) -> tuple[Vec3, Vec3, Vec3]:
    """Return position (m), velocity (m/s) and turn (rad) by which `b` differs from `a`, navigation frame."""
    (ax, ay, az), (bx, by, bz) = a.position, b.position
    (ux, uy, uz), (vx, vy, vz) = a.velocity, b.velocity
    w, x, y, z = multiply(b.attitude, conjugate(a.attitude))
    k = 2.0 if w >= 0.0 else -2.0
    n = sqrt(x * x + y * y + z * z)
    if n > 1e-6:
        k *= asin(min(n, 1.0)) / n
    return (bx - ax, by - ay, bz - az), (vx - ux, vy - uy, vz - uz), (k * x, k * y, k * z)


def add_error(covariance: Covariance, p: Vec3, v: Vec3, turn: Vec3, sigma: float) -> Covariance:
    """Return P + sigma^2 b b' with b = (p, v, turn), for an error of standard deviation sigma in the direction b."""
    k = sigma * sigma
    enlarged: list[float] = []
    i = 0
    for a, b, symmetric in (
        (p, p, True), (p, v, False), (p, turn, False), (v, v, True), (v, turn, False), (turn, turn, True),
    ):  # fmt: skip
        for row in (0, 1, 2):
            for column in range(row if symmetric else 0, 3):
                enlarged.append(covariance[i] + k * a[row] * b[column])
                i += 1
    return tuple(enlarged)
