"""A stride as a row of moments, and where between two of them a foot is."""

from __future__ import annotations

from math import hypot
from struct import Struct

from ...types import Quat, Vec3
from ...types.attrs import define, frozen
from ...types.vector import normalise, sub

MomentRow = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float, float
]  # fmt: skip
"""A moment as it is kept: all numbers of `StrideMoment` in their order, rounded to float32, which changes by less than
1e-6 of itself what is good for some per cent."""
SINGLES = Struct("<15f")


@frozen
class StrideMoment:
    """One moment of a stride, in the navigation frame; `rate` in the sensor's."""

    since: float
    """The heel's rise, s."""
    attitude: Quat
    velocity: Vec3
    position: Vec3
    """Only differences within a stride mean anything."""
    rate: Vec3
    force: float
    """How large the specific force was, m/s^2."""


@define
class RecordedStride:
    """A stride that was seen whole."""

    rows: list[MomentRow]
    """Moments from the heel's rise to just before foot-flat, in order; never none."""
    toe_off: float
    """s after the heel's rise."""
    heel_strike: float
    displacement: Vec3
    """From foot-flat to foot-flat, m; x along the mean of both headings."""

    @property
    def duration(self) -> float:
        """The last moment, s after the heel's rise."""
        return self.rows[-1][0]


def moments(rows: list[MomentRow]) -> list[StrideMoment]:
    """What was kept, in order."""
    return [
        StrideMoment(t, (qw, qx, qy, qz), (vx, vy, vz), (px, py, pz), (rx, ry, rz), force)
        for t, qw, qx, qy, qz, vx, vy, vz, px, py, pz, rx, ry, rz, force in rows
    ]


def at(moments: list[StrideMoment], since: float) -> StrideMoment:
    """The stride `since` s after the heel's rise, between the moments that were kept; within its first and last."""
    before = moments[0]
    for moment in moments:
        if moment.since >= since:
            if moment is before:
                return moment
            k = (since - before.since) / (moment.since - before.since)
            return StrideMoment(
                since,
                normalise(_mix_attitudes(before.attitude, moment.attitude, k)),
                _interpolate(before.velocity, moment.velocity, k),
                _interpolate(before.position, moment.position, k),
                _interpolate(before.rate, moment.rate, k),
                before.force + k * (moment.force - before.force),
            )
        before = moment
    return before


def correction_distance(rows: list[MomentRow]) -> float:
    """How far zero velocity moved the foot in a stride when it came down, m: what the velocities do not tell."""
    first, last = rows[0], rows[-1]
    before, ax, ay, az = first[0], *first[5:8]
    x, y, z = sub(last[8:11], first[8:11])
    for t, _, _, _, _, bx, by, bz, *_ in rows:
        k = 0.5 * (t - before)
        x, y, z = x - k * (ax + bx), y - k * (ay + by), z - k * (az + bz)
        before, ax, ay, az = t, bx, by, bz
    return hypot(x, y, z)


def length(v: Vec3) -> float:
    return hypot(v[0], v[1], v[2])


def limit_length(v: Vec3, most: float) -> Vec3:
    """In the same direction, no longer than `most`."""
    far = length(v)
    return v if far <= most else (v[0] * most / far, v[1] * most / far, v[2] * most / far)


def _interpolate(a: Vec3, b: Vec3, k: float) -> Vec3:
    return (a[0] + k * (b[0] - a[0]), a[1] + k * (b[1] - a[1]), a[2] + k * (b[2] - a[2]))


def _mix_attitudes(p: Quat, q: Quat, k: float) -> Quat:
    if p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3] < 0.0:
        q = (-q[0], -q[1], -q[2], -q[3])
    w, x, y, z = (a + k * (b - a) for a, b in zip(p, q, strict=True))
    return (w, x, y, z)
