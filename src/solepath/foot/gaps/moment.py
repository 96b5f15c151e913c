"""A stride as a list of moments, and interpolation between them."""

from __future__ import annotations

from math import hypot
from struct import Struct

from ...types import Quat, Vec3
from ...types.attrs import ROW_SIZE, define, field, frozen
from ...types.vector import normalise, sub

MOMENT = Struct("<15f")
"""Stored form of a moment: all numbers of `StrideMoment` in order, rounded to float32.

The relative rounding error is below 1e-6, whereas strides differ by some per cent. A stride of 40 moments takes 2.4 kB;
as tuples of floats it took 20 kB."""


@frozen
class StrideMoment:
    """One moment of a stride, in the navigation frame; `rate` is in the sensor frame."""

    since: float
    """Time since heel-off, s."""
    attitude: Quat
    """Attitude, sensor to navigation frame."""
    velocity: Vec3
    """Velocity, navigation frame, m/s."""
    position: Vec3
    """Position, navigation frame, m; only differences within a stride have a meaning."""
    rate: Vec3
    """Angular rate, sensor frame, rad/s."""
    force: float
    """Norm of the specific force, m/s^2."""


@define
class RecordedStride:
    """A stride without gaps."""

    moments: bytes = field(metadata={ROW_SIZE: MOMENT.size})
    """Moments from heel-off to just before foot-flat, in order, as `MOMENT` packs them; at least one."""
    toe_off: float
    """Time from heel-off to toe-off, s."""
    heel_strike: float
    """Time from heel-off to heel-strike, s."""
    displacement: Vec3
    """Displacement from foot-flat to foot-flat, m; x along the mean of both headings."""

    @property
    def duration(self) -> float:
        """Time from heel-off to the last moment, s."""
        since: float = MOMENT.unpack_from(self.moments, len(self.moments) - MOMENT.size)[0]
        return since


def unpack_moments(packed: bytes) -> list[StrideMoment]:
    """Return stored moments, in order."""
    return [
        StrideMoment(t, (qw, qx, qy, qz), (vx, vy, vz), (px, py, pz), (rx, ry, rz), force)
        for t, qw, qx, qy, qz, vx, vy, vz, px, py, pz, rx, ry, rz, force in MOMENT.iter_unpack(packed)
    ]


def interpolate_stride(moments: list[StrideMoment], since: float) -> StrideMoment:
    """Return the interpolated moment at `since` s after heel-off; outside the stride the first or the last moment."""
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


def correction_distance(packed: bytes) -> float:
    """Return the distance by which zero-velocity updates have moved the foot in a stride of these moments, m.

    It is the length of the difference between displacement and integral of the velocity."""
    rows = list(MOMENT.iter_unpack(packed))
    first, last = rows[0], rows[-1]
    before, ax, ay, az = first[0], *first[5:8]
    x, y, z = sub(last[8:11], first[8:11])
    for t, _, _, _, _, bx, by, bz, *_ in rows:
        k = 0.5 * (t - before)
        x, y, z = x - k * (ax + bx), y - k * (ay + by), z - k * (az + bz)
        before, ax, ay, az = t, bx, by, bz
    return hypot(x, y, z)


def vector_length(v: Vec3) -> float:
    """Return the length of a vector."""
    return hypot(v[0], v[1], v[2])


def limit_length(v: Vec3, longest: float) -> Vec3:
    """Return a vector of the same direction that is at most `longest` long."""
    v_length = vector_length(v)
    return (
        v if v_length <= longest else (v[0] * longest / v_length, v[1] * longest / v_length, v[2] * longest / v_length)
    )


def _interpolate(a: Vec3, b: Vec3, k: float) -> Vec3:
    return (a[0] + k * (b[0] - a[0]), a[1] + k * (b[1] - a[1]), a[2] + k * (b[2] - a[2]))


def _mix_attitudes(p: Quat, q: Quat, k: float) -> Quat:
    if p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3] < 0.0:
        q = (-q[0], -q[1], -q[2], -q[3])
    w, x, y, z = (a + k * (b - a) for a, b in zip(p, q, strict=True))
    return (w, x, y, z)
