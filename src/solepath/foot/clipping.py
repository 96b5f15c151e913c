"""What a gyroscope at the end of its range did not see, and what that makes unknown.

Many gyroscopes end at 250 or 500 degrees/s, which a foot exceeds as its heel rises and again as its leg swings. The
rate then stands at the end of the range, and the turn that is missed there, tenths of a radian, tilts all that follows.
Of that turn much is known. Its axis is the sensor's own, and the rate leaves the range and comes back to it as steeply
as it is seen to. Under the cubic through both ends with these slopes lie D^2 (rise + fall) / 12 rad for D seconds
beyond the range; the longer it lasts the flatter is what a foot really does, and so

    m = D^2 (rise + fall) / (12 (1 + D / FLAT))                                                                 (1)

is taken, and the samples since are integrated anew with the rate higher by that cubic. Once more with a little more of
it tells by how much attitude, velocity and position err when m does: one unknown of a known direction,

    P <- P + sigma^2 b b',  b = d(p, v, theta) / dm                                                             (2)

and how large it is the zero velocity of the next stance tells.

Where the range ends is learnt: an axis that stands at its largest rate is at its end. Smooth maxima that look like it
last so short that (1) is nothing.
"""

from __future__ import annotations

from math import asin, sqrt
from typing import NamedTuple

from attrs import define, field

from ..types import Quat, Vec3
from ..vector import GRAVITY, IDENTITY, conjugate, from_rotation_vector, multiply, rotate
from .covariance import Covariance

SAME = 0.025
"""Readings at the end of a range differ by less than this share of it: calibrations mix the axes, and a bias is off."""
NEAR = 0.85
"""The ends of the axes' ranges are alike: none is nearer than this share of the largest rate."""
LEAST = 2.0
"""No range ends below this, rad/s."""
SPIKE = 1.5
"""No reading is believed to be more than so many times the largest before it."""
FADES = 0.97
"""What is left, a step later, of the largest rate, so that what was broken is forgotten."""
FLAT = 0.3
"""s; as in (1)."""
SPREAD = 0.7
"""What (1) is wrong by, as a share of it; and as a share of what was seen meanwhile:"""
FLOOR = 0.05
MOST = 1.0
"""No end of a range hides more, rad."""
TRIFLE = 0.004
"""Less is nothing, rad: what a smooth maximum comes to."""
LONGEST = 0.5
"""A reading that stands for longer than this is broken, or turns evenly, s."""
STEEPEST = 400.0
"""No foot's rate changes faster, rad/s^2."""
ROWS = 64
"""So many samples are kept at the most; when there are more, pairs become one."""
NUDGE = 0.05
"""By how much more than m (2) is told, rad."""

Row = tuple[float, Vec3, Vec3]
"""How long, s, and the mean rate (rad/s) and specific force (m/s^2) meanwhile, sensor frame."""


class Missed(NamedTuple):
    """What one axis did not see."""

    axis: int
    angle: float
    """About the sensor's axis, rad."""
    sigma: float
    lasted: float
    """How long it was beyond the range, s;"""
    ago: float
    """and how long before the last sample it came back to it, s."""
    rise: float
    fall: float
    """How steeply it left the range and came back, rad/s^2."""


class Gone(NamedTuple):
    """Where an integration went."""

    attitude: Quat
    velocity: Vec3
    position: Vec3


@define
class Axis:
    """One axis of the gyroscope."""

    top: float = LEAST
    """The largest rate seen, and the least, rad/s."""
    bottom: float = -LEAST
    ends_above: bool = False
    """It cannot say more than `top`;"""
    ends_below: bool = False
    """nor less than `bottom`."""
    side: int = 0
    """1: above the range now, -1: below it, 0: within."""
    lasted: float = 0.0
    """From when it left the range to the last sample beyond it, s."""
    rise: float = 0.0
    """How steeply it left, rad/s^2."""
    after: float | None = None
    """The first sample within the range again, rad/s, and how long after the last one beyond it, s:"""
    after_dt: float = 0.0


@define
class Clipping:
    """Three axes. Latency: what was missed is known two samples after the range is entered again."""

    axes: list[Axis] = field(factory=lambda: [Axis(), Axis(), Axis()], init=False)
    largest: float = field(default=LEAST, init=False)
    """The largest rate about any axis, rad/s."""
    watch: float = field(default=(NEAR * LEAST) ** 2, init=False)
    """Square of the rate, (rad/s)^2, from which on an axis may be at its end."""
    busy: bool = field(default=False, init=False)
    """An axis is beyond its range, or was a sample ago."""
    rows: list[Row] = field(factory=list, init=False)
    """The samples since before it was."""
    began: Quat = field(default=IDENTITY, init=False)
    """Attitude before them."""

    def stepped(self) -> None:
        """A step ended."""
        self._reach(FADES * self.largest)
        for axis in self.axes:
            if not axis.ends_above:
                axis.top = max(LEAST, FADES * axis.top)
            if not axis.ends_below:
                axis.bottom = min(-LEAST, FADES * axis.bottom)

    def interrupt(self) -> None:
        """There was a gap: what was missed before it is not known."""
        self.rows = []
        self.busy = False
        for axis in self.axes:
            axis.side = 0

    def update(
        self, dt: float, now: Vec3, before: Vec3, earlier: Vec3, earlier_dt: float, told: bool
    ) -> tuple[Missed, ...]:
        """One rate, rad/s, `dt` s after `before`, which was `earlier_dt` after `earlier`; `told`: the device says that
        a sensor is at its end. Returns what turned out to have been missed."""
        found: tuple[Missed, ...] = ()
        busy = False
        for i in (0, 1, 2):
            axis, a = self.axes[i], now[i]
            if axis.side == 0:
                if abs(a) > NEAR * self.largest and not axis.bottom * (1.0 - SAME) < a < axis.top * (1.0 - SAME):
                    _enter(axis, dt, a, before[i], earlier[i], earlier_dt, told)
                    if abs(a) > self.largest:
                        self._reach(min(abs(a), SPIKE * self.largest))
            else:
                missed = _follow(axis, i, dt, a)
                if missed is not None and abs(missed.angle) > TRIFLE:
                    found = (*found, missed)
            busy = busy or axis.side != 0
        self.busy = busy
        return found

    def _reach(self, rate: float) -> None:
        self.largest = max(LEAST, rate)
        self.watch = NEAR * NEAR * self.largest * self.largest

    def keep(self, dt: float, gyro: Vec3, before: Vec3, acc: Vec3, attitude: Quat) -> None:
        """A sample to integrate anew; `attitude`: before it."""
        if not self.rows:
            self.began = attitude
        elif len(self.rows) >= ROWS:
            self.rows = [_joined(a, b) for a, b in zip(self.rows[::2], self.rows[1::2], strict=True)]
        (x, y, z), (u, v, w) = gyro, before
        self.rows.append((dt, (0.5 * (x + u), 0.5 * (y + v), 0.5 * (z + w)), acc))

    def anew(self, missed: Missed, angle: float) -> Gone:
        """The rows once more, from rest at zero, with `angle` more about the axis that missed it."""
        end = sum([row[0] for row in self.rows]) - missed.ago
        t, shape, total = missed.lasted - end, [], 0.0
        for dt, _, _ in self.rows:
            share = (t + 0.5 * dt) / missed.lasted if missed.lasted > 0.0 else 0.5
            t += dt
            more = 0.0
            if 0.0 < share < 1.0:
                more = share * (1.0 - share) * (missed.rise * (1.0 - share) + missed.fall * share)
            shape.append(more)
            total += more * dt
        if not total > 0.0:
            shape = [1.0] * len(self.rows)
            total = sum([row[0] for row in self.rows])
        k = angle / total if total > 0.0 else 0.0
        q = self.began
        vx = vy = vz = x = y = z = 0.0
        for (dt, (gx, gy, gz), acc), more in zip(self.rows, shape, strict=True):
            if missed.axis == 0:
                gx += k * more
            elif missed.axis == 1:
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
        return Gone(q, (vx, vy, vz), (x, y, z))


def _enter(axis: Axis, dt: float, a: float, before: float, earlier: float, earlier_dt: float, told: bool) -> None:
    sign = 1 if a > 0.0 else -1
    a, before, earlier = sign * a, sign * before, sign * earlier
    end = axis.top if sign > 0 else -axis.bottom
    known = axis.ends_above if sign > 0 else axis.ends_below
    stands = a * (1.0 - SAME) <= before <= a * (1.0 + SAME)
    if a > end * (1.0 + SAME):
        known = told  # it can say more than was thought
    end = max(end, min(a, SPIKE * end))
    known = known or stands or told
    if sign > 0:
        axis.top, axis.ends_above = end, known
    else:
        axis.bottom, axis.ends_below = -end, known
    if not known:
        return
    axis.side, axis.after, axis.after_dt = sign, None, 0.0
    axis.rise = _slope(before - earlier, earlier_dt)
    if stands:
        axis.lasted = dt
    else:
        axis.rise = max(_slope(a - before, dt), axis.rise)
        axis.lasted = max(0.0, dt - (a - before) / axis.rise)


def _follow(axis: Axis, i: int, dt: float, a: float) -> Missed | None:
    sign = axis.side
    a *= sign
    end = axis.top if sign > 0 else -axis.bottom
    if a > end * (1.0 + SAME):  # it was not the end
        if sign > 0:
            axis.top, axis.ends_above = min(a, SPIKE * end), False
        else:
            axis.bottom, axis.ends_below = -min(a, SPIKE * end), False
        axis.side = 0
        return None
    if a >= end * (1.0 - SAME):
        axis.lasted += dt + axis.after_dt
        axis.after, axis.after_dt = None, 0.0
        if axis.lasted > LONGEST:
            axis.side = 0
        return None
    if axis.after is None:
        axis.after, axis.after_dt = a, dt
        return None
    fall = max(_slope(end - axis.after, axis.after_dt), _slope(axis.after - a, dt))
    tail = min((end - axis.after) / fall, axis.after_dt)
    lasted = axis.lasted + axis.after_dt - tail
    angle = min(lasted * lasted * (axis.rise + fall) / (12.0 * (1.0 + lasted / FLAT)), MOST)  # (1)
    axis.side, axis.after, axis.after_dt = 0, None, 0.0
    return Missed(i, sign * angle, SPREAD * angle + FLOOR * end * lasted, lasted, dt + tail, axis.rise, fall)


def _slope(more: float, dt: float) -> float:
    return min(max(more / dt, 1.0), STEEPEST) if dt > 0.0 else 1.0


def _joined(a: Row, b: Row) -> Row:
    (t, (gx, gy, gz), (ax, ay, az)), (u, (hx, hy, hz), (bx, by, bz)) = a, b
    both = t + u
    k = t / both if both > 0.0 else 0.5
    m = 1.0 - k
    return (
        both,
        (k * gx + m * hx, k * gy + m * hy, k * gz + m * hz),
        (k * ax + m * bx, k * ay + m * by, k * az + m * bz),
    )


def apart(a: Gone, b: Gone) -> tuple[Vec3, Vec3, Vec3]:
    """Position (m), velocity (m/s) and turn in the world frame (rad) by which `b` differs from `a`."""
    (ax, ay, az), (bx, by, bz) = a.position, b.position
    (ux, uy, uz), (vx, vy, vz) = a.velocity, b.velocity
    w, x, y, z = multiply(b.attitude, conjugate(a.attitude))
    k = 2.0 if w >= 0.0 else -2.0
    n = sqrt(x * x + y * y + z * z)
    if n > 1e-6:
        k *= asin(min(n, 1.0)) / n
    return (bx - ax, by - ay, bz - az), (vx - ux, vy - uy, vz - uz), (k * x, k * y, k * z)


def spread(covariance: Covariance, p: Vec3, v: Vec3, turn: Vec3, sigma: float) -> Covariance:
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
