"""What follows from what a sensor at the end of its range missed (clipping.py): the state with it, and the doubt.

A turn that is missed, tenths of a radian, tilts all that comes after it. Its axis is the sensor's own, so the samples
since are integrated anew with the rate higher by the cubic that holds m. Once more with a little more of it tells by
how much attitude, velocity and position err when m does: one unknown of a known direction b,

    P <- P + sigma^2 b b',  b = d(p, v, theta) / dm

and how large it is the zero velocity of the next stance tells.
"""

from __future__ import annotations

from math import asin, sqrt
from typing import NamedTuple

from ...types import Quat, Vec3
from ...types.attrs import define, field
from ...types.vector import GRAVITY, IDENTITY, conjugate, from_rotation_vector, multiply, rotate
from .clipping import ClippedPeak
from .covariance import Covariance

ROWS = 64
"""So many samples are kept at the most; when there are more, pairs become one."""
NUDGE = 0.05
"""By how much more than m that is told, rad."""

Row = tuple[float, Vec3, Vec3]
"""How long, s, and the mean rate (rad/s) and specific force (m/s^2) meanwhile, sensor frame."""


class IntegratedMotion(NamedTuple):
    """Where an integration went."""

    attitude: Quat
    velocity: Vec3
    position: Vec3


@define
class SwingSamples:
    """The samples since the gyroscope came near the end of its range."""

    rows: list[Row] = field(factory=list, init=False)
    start_attitude: Quat = field(default=IDENTITY, init=False)
    """Attitude before them."""

    def add_sample(self, dt: float, gyro: Vec3, before: Vec3, acc: Vec3, attitude: Quat) -> None:
        """A sample to integrate anew; `attitude`: before it."""
        if not self.rows:
            self.start_attitude = attitude
        elif len(self.rows) >= ROWS:
            self.rows = [_join(a, b) for a, b in zip(self.rows[::2], self.rows[1::2], strict=True)]
        (x, y, z), (u, v, w) = gyro, before
        self.rows.append((dt, (0.5 * (x + u), 0.5 * (y + v), 0.5 * (z + w)), acc))

    def reintegrate(self, peak: ClippedPeak, angle: float) -> IntegratedMotion:
        """The rows once more, from rest at zero, with `angle` more about the axis that missed it."""
        end = sum([row[0] for row in self.rows]) - peak.ago
        t, shape, total = peak.duration - end, [], 0.0
        for dt, _, _ in self.rows:
            share = (t + 0.5 * dt) / peak.duration if peak.duration > 0.0 else 0.5
            t += dt
            more = 0.0
            if 0.0 < share < 1.0:
                more = share * (1.0 - share) * (peak.rise * (1.0 - share) + peak.fall * share)
            shape.append(more)
            total += more * dt
        if not total > 0.0:
            shape = [1.0] * len(self.rows)
            total = sum([row[0] for row in self.rows])
        k = angle / total if total > 0.0 else 0.0
        q = self.start_attitude
        vx = vy = vz = x = y = z = 0.0
        for (dt, (gx, gy, gz), acc), more in zip(self.rows, shape, strict=True):
            if peak.axis == 0:
                gx += k * more
            elif peak.axis == 1:
                gy += k * more
            else:
                gz += k * more
            half = from_rotation_vector((0.5 * dt * gx, 0.5 * dt * gy, 0.5 * dt * gz))
            q = multiply(q, half)
            ax, ay, az = rotate(q, acc)
            q = multiply(q, half)
            az -= GRAVITY
            x, y, z = x + (vx + 0.5 * ax * dt) * dt, y + (vy + 0.5 * ay * dt) * dt, z + (vz + 0.5 * az * dt) * dt
            vx, vy, vz = vx + ax * dt, vy + ay * dt, vz + az * dt
        return IntegratedMotion(q, (vx, vy, vz), (x, y, z))


def _join(a: Row, b: Row) -> Row:
    (t, (gx, gy, gz), (ax, ay, az)), (u, (hx, hy, hz), (bx, by, bz)) = a, b
    both = t + u
    k = t / both if both > 0.0 else 0.5
    m = 1.0 - k
    return (
        both,
        (k * gx + m * hx, k * gy + m * hy, k * gz + m * hz),
        (k * ax + m * bx, k * ay + m * by, k * az + m * bz),
    )


def difference(a: IntegratedMotion, b: IntegratedMotion) -> tuple[Vec3, Vec3, Vec3]:
    """Position (m), velocity (m/s) and turn in the world frame (rad) by which `b` differs from `a`."""
    (ax, ay, az), (bx, by, bz) = a.position, b.position
    (ux, uy, uz), (vx, vy, vz) = a.velocity, b.velocity
    w, x, y, z = multiply(b.attitude, conjugate(a.attitude))
    k = 2.0 if w >= 0.0 else -2.0
    n = sqrt(x * x + y * y + z * z)
    if n > 1e-6:
        k *= asin(min(n, 1.0)) / n
    return (bx - ax, by - ay, bz - az), (vx - ux, vy - uy, vz - uz), (k * x, k * y, k * z)


def add_error(covariance: Covariance, p: Vec3, v: Vec3, turn: Vec3, sigma: float) -> Covariance:
    """P + sigma^2 b b' with b = (p, v, turn): an error of one unknown size and a known direction."""
    k = sigma * sigma
    grown: list[float] = []
    i = 0
    for a, b in ((p, p), (p, v), (p, turn), (v, v), (v, turn), (turn, turn)):
        for row in (0, 1, 2):
            for column in range(row, 3) if a is b else (0, 1, 2):
                grown.append(covariance[i] + k * a[row] * b[column])
                i += 1
    return tuple(grown)
