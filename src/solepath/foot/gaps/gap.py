"""What a foot did while nobody saw it: a gap in the samples is filled with the same part of the last whole stride.

Which part that is, is told by how long the foot had been moving before the gap and by what it does after it; what
turned otherwise than then, before and after, turned otherwise in between.
"""

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
"""Gaps shorter than this are bridged by a straight line, s."""
MOST_SHIFT = 0.12
"""So far ahead or behind of the last stride a later one may be, s; and how far it is as a rule:"""
SHIFT_SIGMA = 0.03
RATE_SIGMA = 1.0
"""What the same moment of two strides differs by, rad/s and m/s^2."""
FORCE_SIGMA = 4.0
TILT_SIGMA = 0.1
"""The same of where up is, as a unit vector in the sensor frame, and of the speed, m/s."""
SPEED_SIGMA = 0.3
PERSISTENCE = 0.5
"""How much of what the velocity was off before a gap it still is after it."""
MOST_VELOCITY_OFF = 1.0
"""What a velocity is off beyond this is not the wearer's doing, m/s."""
LEAST_LIKE = 60.0
"""When the foot, before or after a gap, is more unlike the last stride than this (a sum of squares of the standard
deviations above), a straight line is the better guess as long as there is one."""
LONGEST = 1.5
"""A gap longer than this is not filled: habit tells one stride, not how many, s."""
FASTEST = 4.0
"""No foot is faster than this on the mean of a stride, m/s."""
UP = (0.0, 0.0, 1.0)
"""Unit vector, navigation frame."""


class Infill(NamedTuple):
    """Where the foot is after a gap, and what it went through in it."""

    attitude: Quat
    velocity: Vec3
    position: Vec3
    duration: float
    """How much of the last stride stands in for the gap, s."""
    t_heel_off: float
    """When the heel rose, s."""
    t_toe_off: float | None
    """When the toe left the ground and when the heel struck it, if that had happened by now, s."""
    t_heel_strike: float | None
    t_foot_flat: float | None
    """When the foot was flat again, if it was, s."""


class NoInfill(Enum):
    """Why a foot is where it was before the gap, as far as is known."""

    STOOD = "it stood all the time"
    UNKNOWN = "there is nothing to go by"


def find_infill(
    template: StrideTemplate, corrector: Corrector, a: float, b: float, acc: Vec3, gyro: Vec3
) -> Infill | NoInfill:
    """What the foot did from `a` to `b`, s. The corrector is at `a`; `acc` and `gyro` are those at `b`, without bias.
    Changes nothing: `StrideTemplate.guess` and `Corrector.infill` take the answer."""
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
        # by cadence the heel rose then
        expected = b - a if template.flat_since is None else b - template.flat_since - template.stance
        if template.flat_since is not None and expected - (b - a) > 3.0 * usual:
            expected, usual = 0.0, b - a  # who has stood for longer than that has halted, and may go on at any time
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
        return NoInfill.UNKNOWN  # this is another kind of stride, such as a turn on the spot
    if end is None:
        return NoInfill.STOOD if template.t_heel_off is None and best < 20.0 else NoInfill.UNKNOWN
    return _build_infill(template, stride, last, corrector, start, end, a, b, gyro)


def _match_moment(last: list[StrideMoment], corrector: Corrector, since: float) -> tuple[float, float]:
    """The moment of the last stride, near `since` s after the heel's rise, at which the foot was most like this; and
    how much unlike it was then, as a sum of squares of standard deviations."""
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
    """From `start`, s after the heel's rise in the last stride, to this moment of it; `last`: all of them."""
    attitude, rate, moving = corrector.attitude, corrector.rate, template.t_heel_off is not None
    first = at(last, start)
    t_foot_flat = end is last[-1]
    dt = max(end.since - first.since, 1e-6)
    # tilt as it was then, for where the foot is on its way tells it better than what the last sample does; heading
    # as it is now
    yaw = heading_turned(first.attitude, attitude)
    now = multiply(from_yaw(yaw), end.attitude)
    if rate is not None:
        # what it turned otherwise than in the last stride before the gap and after it, it did in between
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
    # none of it before the gap: it would have been seen
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
    """When the heel rose, s."""
    if not t_foot_flat:
        return b - end.since
    if template.t_heel_off is not None:
        return min(a - start, b - end.since)
    by_cadence = b - end.since if template.flat_since is None else template.flat_since + template.stance
    return max(a, min(by_cadence, b - end.since))
