"""Infill of a gap in the samples: the same part of the last whole stride stands in for it.

The time for which the foot had moved before the gap, and its motion after the gap, tell which part this is. If the foot
turned differently from the template before and after the gap, it is taken to have done so in the gap."""

from __future__ import annotations

from enum import Enum
from math import hypot
from typing import NamedTuple

from ...types import Quat, Vec3
from ...types.vector import (
    GRAVITY,
    ZERO,
    from_yaw,
    heading_turned,
    multiply,
    normalise,
    rotate,
    rotate_back,
    sub,
    turned,
)
from ..navigate.corrector import LONGEST_BRIDGE, Corrector
from .moment import RecordedStride, StrideMoment, at, length, limit_length, moments
from .template import StrideTemplate

SHORTEST = 0.06
"""Shortest gap that is filled, s; shorter ones are bridged by a straight line."""
MOST_SHIFT = 0.12
"""Largest time by which a stride is ahead of or behind the last one, s."""
SHIFT_SIGMA = 0.03
"""Standard deviation of the time by which a stride is ahead of or behind the last one, s."""
RATE_SIGMA = 1.0
"""Standard deviation of the difference in rate between two strides at the same moment, rad/s."""
FORCE_SIGMA = 4.0
"""Standard deviation of the difference in specific force between two strides at the same moment, m/s^2."""
TILT_SIGMA = 0.1
"""Standard deviation of the difference in the up direction (unit vector, sensor frame) between two strides."""
SPEED_SIGMA = 0.3
"""Standard deviation of the difference in speed between two strides at the same moment, m/s."""
PERSISTENCE = 0.5
"""Share of the velocity difference before a gap that remains after it."""
MOST_VELOCITY_OFF = 1.0
"""Largest velocity difference that the wearer can cause, m/s."""
LEAST_LIKE = 60.0
"""Largest mismatch between foot and template, as a sum of squares of the standard deviations above.

With a larger mismatch before or after a gap, a straight line is the better estimate if the gap is short enough."""
LONGEST = 1.5
"""Longest gap that is filled, s: the template tells one stride, not how many."""
FASTEST = 4.0
"""Largest mean speed of a foot in a stride, m/s."""
UP = (0.0, 0.0, 1.0)
"""Up as a unit vector, navigation frame."""


class Infill(NamedTuple):
    """The state of the foot after a gap, and the gait events in it."""

    attitude: Quat
    """Attitude after the gap, sensor to navigation frame."""
    velocity: Vec3
    """Velocity after the gap, navigation frame, m/s."""
    position: Vec3
    """Position after the gap, navigation frame, m."""
    duration: float
    """Duration of the part of the template that stands in for the gap, s."""
    t_heel_off: float
    """Time of heel-off, s."""
    t_toe_off: float | None
    """Time of toe-off, s; None if it is still to come."""
    t_heel_strike: float | None
    """Time of heel-strike, s; None if it is still to come."""
    t_foot_flat: float | None
    """Time of foot-flat, s; None if it is still to come."""


class NoInfill(Enum):
    """Reasons why a gap gets no infill."""

    STOOD = "it stood all the time"
    UNKNOWN = "there is nothing to go by"


def find_infill(
    template: StrideTemplate, corrector: Corrector, a: float, b: float, acc: Vec3, gyro: Vec3
) -> Infill | NoInfill:
    """Return the infill of a gap from `a` to `b`, s, or the reason why there is none.

    The state of the corrector is that at `a`; `acc` and `gyro` are those at `b`, without bias. The function changes
    nothing: `StrideTemplate.add_infill` and `Corrector.infill` apply the result."""
    x, y, z = acc
    force = hypot(x, y, z)
    x, y, z = gyro
    still = (x * x + y * y + z * z) / 0.25 + (force - GRAVITY) ** 2 / 2.0
    stride = template.last
    if stride is None or b - a > LONGEST:
        return NoInfill.STOOD if template.t_heel_off is None and still < 8.0 else NoInfill.UNKNOWN
    last = moments(stride.rows)
    whole = last[-1].since
    if template.t_heel_off is None:
        unlike = 0.0
        start, usual, most = 0.0, 2.0 * MOST_SHIFT / 3.0, b - a
        # duration since the heel-off that the cadence predicts
        expected = b - a if template.flat_since is None else b - template.flat_since - template.stance
        if template.flat_since is not None and expected - (b - a) > 3.0 * usual:
            expected, usual = 0.0, b - a  # after a longer stance the wearer has halted, and may go on at any time
        best = still + min(12.0, max(0.0, expected / usual) ** 2)
    else:
        start, unlike = _match_moment(last, corrector, a - template.t_heel_off)
        usual, expected, best = SHIFT_SIGMA, start + b - a, 1e12
        most = expected + MOST_SHIFT
    end: StrideMoment | None = None
    for moment in last:
        if moment.since > most:
            break
        if template.t_heel_off is not None and moment.since < expected - MOST_SHIFT:
            continue
        x, y, z = sub(gyro, moment.rate)
        far = (x * x + y * y + z * z) / RATE_SIGMA**2 + ((force - moment.force) / FORCE_SIGMA) ** 2
        far += ((moment.since - expected) / usual) ** 2
        if far < best:
            best, end = far, moment
    if most >= whole:
        early = max(0.0, whole - expected)
        if still + (early / usual) ** 2 < best or (template.t_heel_off is not None and expected > whole + MOST_SHIFT):
            end = last[-1]
    if end is not None and end is not last[-1]:
        unlike = max(unlike, best)
    if template.t_heel_off is not None and unlike > LEAST_LIKE and b - a <= LONGEST_BRIDGE:
        return NoInfill.UNKNOWN  # another kind of stride, such as a turn on the spot
    if end is None:
        return NoInfill.STOOD if template.t_heel_off is None and best < 20.0 else NoInfill.UNKNOWN
    return _build_infill(template, stride, last, corrector, start, end, a, b, gyro)


def _match_moment(last: list[StrideMoment], corrector: Corrector, since: float) -> tuple[float, float]:
    """Return the time after heel-off at which the template is most like the foot now, and the mismatch.

    Only moments near `since` s after heel-off count. The mismatch is a sum of squares of standard deviations."""
    rate = corrector.rate
    if rate is None:
        return since, 0.0
    best, found = 1e12, since
    up, fast = rotate_back(corrector.attitude, UP), length(corrector.velocity)
    for moment in last:
        if abs(moment.since - since) < MOST_SHIFT:
            x, y, z = sub(rate, moment.rate)
            far = (x * x + y * y + z * z) / RATE_SIGMA**2 + ((moment.since - since) / SHIFT_SIGMA) ** 2
            x, y, z = sub(up, rotate_back(moment.attitude, UP))
            far += (x * x + y * y + z * z) / TILT_SIGMA**2
            far += ((fast - length(moment.velocity)) / SPEED_SIGMA) ** 2
            if far < best:
                best, found = far, moment.since
    return found, best


def _build_infill(
    template: StrideTemplate,
    stride: RecordedStride,
    last: list[StrideMoment],
    corrector: Corrector,
    start: float,
    end: StrideMoment,
    a: float,
    b: float,
    gyro: Vec3,
) -> Infill:
    """Return the infill from `start`, s after heel-off in the template, to the moment `end`; `last` is all of it."""
    attitude, rate, moving = corrector.attitude, corrector.rate, template.t_heel_off is not None
    first = at(last, start)
    t_foot_flat = end is last[-1]
    dt = max(end.since - first.since, 1e-6)
    # tilt of the template, because the phase of the stride tells it better than the last sample; current heading
    yaw = heading_turned(first.attitude, attitude)
    now = multiply(from_yaw(yaw), end.attitude)
    if rate is not None:
        # the difference in rate from the template before and after the gap is taken to last through the gap
        before = rotate(attitude, sub(rate, first.rate))[2] if moving else 0.0
        after = 0.0 if t_foot_flat else rotate(now, sub(gyro, end.rate))[2]
        now = multiply(from_yaw(0.5 * min(dt, b - a) * (before + after)), now)
    now = normalise(now)
    ux, uy, uz = turned(end.velocity, yaw)
    ex, ey, ez = limit_length(sub(corrector.velocity, turned(first.velocity, yaw)), MOST_VELOCITY_OFF)
    k = PERSISTENCE
    speed = ZERO if t_foot_flat else (ux + k * ex, uy + k * ey, uz + k * ez)
    k *= 0.5 * dt
    px, py, pz = turned(sub(end.position, first.position), yaw)
    x, y, z = corrector.position
    wx, wy, wz = limit_length((px + k * ex, py + k * ey, pz + k * ez), FASTEST * (b - a))
    here = (x + wx, y + wy, z + wz)
    t_heel_off = _time_of_heel_off(template, t_foot_flat, start, end, a, b)
    # not before the gap, because samples would have shown it
    t_toe_off = max(a, t_heel_off + stride.toe_off) if end.since >= stride.toe_off else None
    t_heel_strike = max(a, t_heel_off + stride.heel_strike) if end.since >= stride.heel_strike else None
    return Infill(
        now,
        speed,
        here,
        dt,
        t_heel_off,
        t_toe_off,
        t_heel_strike,
        max(a, t_heel_off + end.since) if t_foot_flat else None,
    )


def _time_of_heel_off(
    template: StrideTemplate, t_foot_flat: bool, start: float, end: StrideMoment, a: float, b: float
) -> float:
    """Return the time of heel-off, s."""
    if not t_foot_flat:
        return b - end.since
    if template.t_heel_off is not None:
        return min(a - start, b - end.since)
    by_cadence = b - end.since if template.flat_since is None else template.flat_since + template.stance
    return max(a, min(by_cadence, b - end.since))
