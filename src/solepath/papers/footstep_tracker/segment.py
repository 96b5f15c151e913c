"""Samples of one step, between two static zones, and the axes of the foot."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

from ...types import Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import GRAVITY, ZERO
from .critical_times import CriticalTimes, Row

MISFITS = 3
"""Number of steps in a row with another axis after which that one replaces the known one."""
LEAST_RISE = 0.25
"""Least rise of the heel that shows the axis, rad."""
STEP_WEIGHT = 0.2
"""Weight of each step in the learnt axis."""


@frozen
class StepSegment:
    """The samples of one step.

    `rows` in the paper's axes; `times` None where there is no swing in them. `forward`: the foot's y axis in the sensor
    frame, a unit vector. `longest_gap`: the longest time between two of its samples, s."""

    rows: tuple[Row, ...]
    times: CriticalTimes | None
    forward: Vec3
    longest_gap: float


@define
class FootAxes:
    """The mounting of the sensor: y forward and x to the right in the sensor frame, unit vectors.

    Up is the specific force of a foot at rest. Across is the axis about which the heel rises at the start of a step,
    for any mounting. Forward is the foot's own direction, the paper's d_f: between it and the way lies the toe-out
    angle."""

    right: Vec3 | None = field(default=None, init=False)
    """Learnt axis to the right, sensor frame; None before the first step."""
    misfits: int = field(default=0, init=False)
    """Number of steps in a row that rose about another axis."""

    def add_segment(self, rows: Sequence[Row], up: Vec3) -> None:
        """Add one segment, in the sensor frame, of a foot with the unit vector `up` at rest."""
        found = _rise(rows, up)
        if found is None:
            return
        if self.right is None:
            self.right = found
            return
        (x, y, z), (u, v, w) = found, self.right
        if u * x + v * y + w * z < 0.5:
            self.misfits += 1
            if self.misfits < MISFITS:
                return
            u, v, w = found
        self.misfits = 0
        k = STEP_WEIGHT
        self.right = _unit((u + k * (x - u), v + k * (y - v), w + k * (z - w)))

    def axes(self, up: Vec3) -> tuple[Vec3, Vec3] | None:
        """Return (x, y) of a foot with the unit vector `up` at rest; None while they are not known."""
        if self.right is None:
            return None
        right = _unit(_horizontal(self.right, up))
        return None if right is None else (right, _cross(up, right))


def to_foot_axes(rows: Sequence[Row], right: Vec3, forward: Vec3, up: Vec3) -> tuple[Row, ...]:
    """Return rows of the sensor frame in the paper's axes, a_z with the paper's sign."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = right, forward, up
    return tuple(
        [
            (
                t, ax * xx + ay * xy + az * xz, ax * yx + ay * yy + az * yz, -(ax * zx + ay * zy + az * zz),
                gx * xx + gy * xy + gz * xz, gx * yx + gy * yy + gz * yz, gx * zx + gy * zy + gz * zz,
            )
            for t, ax, ay, az, gx, gy, gz in rows
        ]
    )  # fmt: skip


def scale_to_offset(rows: Sequence[Row], scale: float) -> tuple[Row, ...]:
    """Return rows whose error at rest is corrected as an offset of the vertical axis instead of a scale.

    The accelerations were multiplied by `scale`, so that they read 1 g at rest."""
    k = 1.0 / scale
    offset = GRAVITY * (k - 1.0)
    return tuple([(t, k * ax, k * ay, k * az + offset, gx, gy, gz) for t, ax, ay, az, gx, gy, gz in rows])


def _rise(rows: Sequence[Row], up: Vec3) -> Vec3 | None:
    """Return x to the right from the first turn of a segment about a level axis: the heel rises, the toe goes down."""
    turned, largest, found = ZERO, 0.0, ZERO
    for before, row in zip(rows, rows[1:], strict=False):
        dt = row[0] - before[0]
        x, y, z = turned
        turned = (x + row[4] * dt, y + row[5] * dt, z + row[6] * dt)
        x, y, z = _horizontal(turned, up)
        angle = sqrt(x * x + y * y + z * z)
        if angle > largest:
            largest, found = angle, (-x, -y, -z)
        elif largest > LEAST_RISE and angle < 0.7 * largest:
            return _unit(found)
    return None


def _horizontal(v: Vec3, up: Vec3) -> Vec3:
    """Return the part of `v` at right angles to the unit vector `up`."""
    k = v[0] * up[0] + v[1] * up[1] + v[2] * up[2]
    return (v[0] - k * up[0], v[1] - k * up[1], v[2] - k * up[2])


def _cross(a: Vec3, b: Vec3) -> Vec3:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _unit(v: Vec3) -> Vec3 | None:
    x, y, z = v
    length = sqrt(x * x + y * y + z * z)
    return None if length < 1e-6 else (x / length, y / length, z / length)
