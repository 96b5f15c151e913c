"""Samples of one stride, between two static zones, and the axes of the foot.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from ...types import Vec3
from ...types.attrs import frozen, stateful
from ...types.vector import GRAVITY, ZERO, across, add, cross, dot, sub
from .critical_times import CriticalTimes, Row

MOST_MISFITS = 3
"""Number of consecutive misfits (`FootAxes.misfits`) after which the newest axis replaces the learnt one."""
MISFIT_COSINE = 0.5
"""Cosine of the angle between a stride's axis and the learnt one from which on the stride is a misfit: 60 degrees."""
LEAST_RISE, RISE_END_SHARE = 0.25, 0.7
"""Least rotation in a heel's rise that shows the axis, rad, and share of its largest angle at which it has ended."""
AXIS_ANGLE_SHARE = 0.5
"""Share of the largest angle of the heel's rise at which the axis is read.

On its forefoot a shoe can only roll about its own lateral axis; from toe-off on, which is before the largest angle, it
also rolls and yaws. Angles of toe-out of emulated walks err by 1.0 degrees with 0.3 and 0.5, by 1.1 with 0.7 and by 2.1
at the largest angle."""
STRIDE_WEIGHT = 0.2
"""Weight of each stride in the learnt axis."""


@frozen
class StrideSegment:
    """The samples of one stride."""

    rows: tuple[Row, ...]
    """Samples in the paper's axes."""
    times: CriticalTimes | None
    """Critical times; None when the samples contain no swing."""
    forward: Vec3
    """Unit vector of the foot's y axis in the sensor frame."""
    longest_gap: float
    """Longest time between two samples of the stride, s."""


@stateful
class FootAxes:
    """Learns the foot's axes, x right and y forward, as unit vectors in the frame of a sensor in any mounting.

    Up is the direction of the specific force of a foot at rest. Right is the axis about which the heel's rise at the
    start of a stride is a negative rotation. Forward is the foot's long axis, the paper's d_f, which is turned from the
    direction of walking by the toe-out angle."""

    right: Vec3 | None = None
    """Learnt axis to the right, sensor frame; None before the first stride."""
    misfits: int = 0
    """Number of consecutive strides whose axis to the right is more than 60 degrees off the learnt one."""

    def add_segment(self, rows: Sequence[Row], up: Vec3) -> None:
        """Learn from the rows of one segment; `up` is the unit vector upwards at rest. All are in the sensor frame."""
        right = _rise(rows, up)
        if right is None:
            return
        if self.right is None:
            self.right = right
            return
        learnt = self.right
        if dot(right, learnt) < MISFIT_COSINE:
            self.misfits += 1
            if self.misfits < MOST_MISFITS:
                return
            learnt = right
        self.misfits = 0
        self.right = _unit(add(learnt, sub(right, learnt), STRIDE_WEIGHT))

    def axes(self, up: Vec3) -> tuple[Vec3, Vec3] | None:
        """Return the axes (right, forward) at rest, when `up` points upwards, sensor frame; None while unknown."""
        if self.right is None:
            return None
        right = _unit(across(self.right, up))
        return None if right is None else (right, cross(up, right))


def to_foot_axes(rows: Sequence[Row], right: Vec3, forward: Vec3, up: Vec3) -> tuple[Row, ...]:
    """Convert rows from the sensor frame, in which the axes are given, to the paper's axes with its sign of a_z."""
    vectors = [(row[0], row[1:4], row[4:7]) for row in rows]
    return tuple(
        [
            (t, dot(a, right), dot(a, forward), -dot(a, up), dot(g, right), dot(g, forward), dot(g, up))
            for t, a, g in vectors
        ]
    )


def scale_to_offset(rows: Sequence[Row], scale: float) -> tuple[Row, ...]:
    """Return the rows without the factor `scale` of their accelerations, and with an offset of a_z in its place.

    Either of them makes the specific force at rest 1 g. The rows are in the paper's axes."""
    k = 1.0 / scale
    offset = GRAVITY * (k - 1.0)
    return tuple([(t, k * ax, k * ay, k * az + offset, gx, gy, gz) for t, ax, ay, az, gx, gy, gz in rows])


def _rise(rows: Sequence[Row], up: Vec3) -> Vec3 | None:
    """Return the axis to the right, sensor frame, from the heel's rise: the first rotation about a level axis."""
    rotation, largest = ZERO, 0.0
    path: list[tuple[float, Vec3]] = []
    for before, row in zip(rows, rows[1:], strict=False):
        rotation = add(rotation, row[4:7], row[0] - before[0])
        level = across(rotation, up)
        angle = hypot(*level)
        path.append((angle, sub(ZERO, level)))  # the heel rises about the axis to the left
        if angle > largest:
            largest = angle
        elif largest > LEAST_RISE and angle < RISE_END_SHARE * largest:
            return _unit(next(axis for reached, axis in path if reached >= AXIS_ANGLE_SHARE * largest))
    return None


def _unit(v: Vec3) -> Vec3 | None:
    length = hypot(*v)
    return None if length < 1e-6 else add(ZERO, v, 1.0 / length)
