"""Infill of a gap in the samples: the same part of the stride template stands in for it.

This part starts at the time for which the foot had moved before the gap, and ends where the template is most like the
motion after the gap. If the foot turned differently from the template before and after the gap, the same difference is
assumed in the gap. The likeness is a "mismatch": a sum of squared differences, each divided by its standard deviation.

The numbers were chosen by hand and not swept."""

from __future__ import annotations

from enum import Enum
from math import hypot
from typing import NamedTuple

from ..types import Quat, Vec3
from ..types.vector import (
    GRAVITY,
    UP,
    ZERO,
    add,
    dot,
    from_yaw,
    heading_turned,
    multiply,
    normalise,
    rotate,
    rotate_back,
    sub,
    turned,
)
from .navigate.corrector import LONGEST_BRIDGE, LONGEST_FILLED_GAP, Corrector
from .template import RecordedStride, StrideMoment, StrideTemplate, interpolate_stride, limit_length, unpack_moments

SHORTEST_FILLED_GAP = 0.06
"""Gap above which infill is used, s; shorter gaps are bridged by a straight line."""
LARGEST_TIME_SHIFT = 0.12
"""Largest time by which a stride is ahead of or behind the template, s."""
TIME_SHIFT_SIGMA = 0.03
"""Standard deviation of the time by which a stride is ahead of or behind the template, s."""
RATE_SIGMA = 1.0
"""Standard deviation of the difference in rate between two strides at the same moment, rad/s."""
FORCE_SIGMA = 4.0
"""Standard deviation of the difference in specific force between two strides at the same moment, m/s^2."""
TILT_SIGMA = 0.1
"""Standard deviation of the difference in the up direction (unit vector, sensor frame) between two strides."""
SPEED_SIGMA = 0.3
"""Standard deviation of the difference in speed between two strides at the same moment, m/s."""
VELOCITY_PERSISTENCE = 0.5
"""Share of the difference in velocity from the template that remains after a gap, 0 to 1."""
LARGEST_VELOCITY_DIFFERENCE = 1.0
"""Largest difference in velocity from the template that the wearer can cause, m/s."""
LARGEST_MISMATCH = 60.0
"""Largest mismatch between foot and template with which a short gap is filled; no unit.

With a larger mismatch before or after the gap, a straight line is the better estimate."""
FASTEST_FOOT = 4.0
"""Largest mean speed of a foot over a gap, m/s."""


class Infill(NamedTuple):
    """The state of the foot after a gap, and the gait events in the gap."""

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
    template: StrideTemplate, corrector: Corrector, t_before: float, t_after: float, acc: Vec3, gyro: Vec3
) -> Infill | NoInfill:
    """Return the infill of a gap from `t_before` to `t_after`, s, or the reason why there is none.

    The state of the corrector is that at `t_before`; `acc` (m/s^2) and `gyro` (rad/s) are those at `t_after`, without
    bias. The function changes nothing: `StrideTemplate.add_infill` and `Corrector.infill` apply the result."""
    force, duration, stood = hypot(*acc), t_after - t_before, template.t_heel_off is None
    still = dot(gyro, gyro) / 0.25 + (force - GRAVITY) ** 2 / 2.0
    stride = template.last_stride
    if stride is None or duration > LONGEST_FILLED_GAP:
        return NoInfill.STOOD if stood and still < 8.0 else NoInfill.UNKNOWN
    template_moments = unpack_moments(stride.moments)
    template_end = template_moments[-1].since
    if template.t_heel_off is None:
        mismatch = 0.0
        start, expected_sigma, latest = 0.0, 2.0 * LARGEST_TIME_SHIFT / 3.0, duration
        # time since the heel-off that the last stance lets expect
        expected = duration if template.t_flat is None else t_after - template.t_flat - template.stance_duration
        if expected - duration > 3.0 * expected_sigma:
            # after a longer stance the wearer has halted, and may go on at any time
            expected, expected_sigma = 0.0, duration
        least_mismatch = still + min(12.0, max(0.0, expected / expected_sigma) ** 2)
    else:
        start, mismatch = _match_moment(template_moments, corrector, t_before - template.t_heel_off)
        expected_sigma, expected, least_mismatch = TIME_SHIFT_SIGMA, start + t_after - t_before, 1e12
        latest = expected + LARGEST_TIME_SHIFT
    end: StrideMoment | None = None
    for moment in template_moments:
        if moment.since > latest:
            break
        if not stood and moment.since < expected - LARGEST_TIME_SHIFT:
            continue
        rate = sub(gyro, moment.rate)
        moment_mismatch = dot(rate, rate) / RATE_SIGMA**2 + ((force - moment.force) / FORCE_SIGMA) ** 2
        moment_mismatch += ((moment.since - expected) / expected_sigma) ** 2
        if moment_mismatch < least_mismatch:
            least_mismatch, end = moment_mismatch, moment
    if latest >= template_end:
        early = max(0.0, template_end - expected)
        if still + (early / expected_sigma) ** 2 < least_mismatch or (
            not stood and expected > template_end + LARGEST_TIME_SHIFT
        ):
            end = template_moments[-1]
    if end is not None and end is not template_moments[-1]:
        mismatch = max(mismatch, least_mismatch)
    if not stood and mismatch > LARGEST_MISMATCH and duration <= LONGEST_BRIDGE:
        return NoInfill.UNKNOWN  # another kind of stride, such as a turn on the spot
    if end is None:
        return NoInfill.STOOD if stood and least_mismatch < 20.0 else NoInfill.UNKNOWN
    return _build_infill(template, stride, template_moments, corrector, start, end, t_before, t_after, gyro)


def _match_moment(template_moments: list[StrideMoment], corrector: Corrector, since: float) -> tuple[float, float]:
    """Return the time after heel-off, s, at which the template is most like the foot now, and the mismatch.

    Only moments near `since` s after heel-off count."""
    rate = corrector.rate
    if rate is None:
        return since, 0.0
    least_mismatch, best_since = 1e12, since
    up, speed = rotate_back(corrector.attitude, UP), hypot(*corrector.velocity)
    for moment in template_moments:
        if abs(moment.since - since) < LARGEST_TIME_SHIFT:
            d = sub(rate, moment.rate)
            moment_mismatch = dot(d, d) / RATE_SIGMA**2 + ((moment.since - since) / TIME_SHIFT_SIGMA) ** 2
            d = sub(up, rotate_back(moment.attitude, UP))
            moment_mismatch += dot(d, d) / TILT_SIGMA**2
            moment_mismatch += ((speed - hypot(*moment.velocity)) / SPEED_SIGMA) ** 2
            if moment_mismatch < least_mismatch:
                least_mismatch, best_since = moment_mismatch, moment.since
    return best_since, least_mismatch


def _build_infill(
    template: StrideTemplate,
    stride: RecordedStride,
    template_moments: list[StrideMoment],
    corrector: Corrector,
    start: float,
    end: StrideMoment,
    t_before: float,
    t_after: float,
    gyro: Vec3,
) -> Infill:
    """Return the infill from `start`, s after heel-off in the template, to the moment `end` of the template."""
    attitude, rate, moving = corrector.attitude, corrector.rate, template.t_heel_off is not None
    start_moment = interpolate_stride(template_moments, start)
    ends_flat = end is template_moments[-1]
    dt = max(end.since - start_moment.since, 1e-6)
    # the tilt comes from the template, because the phase of the stride gives it better than the last sample does; the
    # heading is the current one
    yaw = heading_turned(start_moment.attitude, attitude)
    end_attitude = multiply(from_yaw(yaw), end.attitude)
    if rate is not None:
        # the difference in turning rate from the template, before and after the gap, is assumed in the gap as well
        rate_before = rotate(attitude, sub(rate, start_moment.rate))[2] if moving else 0.0
        rate_after = 0.0 if ends_flat else rotate(end_attitude, sub(gyro, end.rate))[2]
        end_attitude = multiply(from_yaw(0.5 * min(dt, t_after - t_before) * (rate_before + rate_after)), end_attitude)
    end_attitude = normalise(end_attitude)
    excess = limit_length(sub(corrector.velocity, turned(start_moment.velocity, yaw)), LARGEST_VELOCITY_DIFFERENCE)
    end_velocity = ZERO if ends_flat else add(turned(end.velocity, yaw), excess, VELOCITY_PERSISTENCE)
    way = turned(sub(end.position, start_moment.position), yaw)
    way = add(way, excess, VELOCITY_PERSISTENCE * (0.5 * dt))
    end_position = add(corrector.position, limit_length(way, FASTEST_FOOT * (t_after - t_before)))
    t_heel_off = _time_of_heel_off(template, ends_flat, start, end, t_before, t_after)
    # events do not lie before the gap, because samples would have shown them
    t_toe_off = max(t_before, t_heel_off + stride.toe_off) if end.since >= stride.toe_off else None
    t_heel_strike = max(t_before, t_heel_off + stride.heel_strike) if end.since >= stride.heel_strike else None
    return Infill(
        end_attitude,
        end_velocity,
        end_position,
        dt,
        t_heel_off,
        t_toe_off,
        t_heel_strike,
        max(t_before, t_heel_off + end.since) if ends_flat else None,
    )


def _time_of_heel_off(
    template: StrideTemplate, ends_flat: bool, start: float, end: StrideMoment, t_before: float, t_after: float
) -> float:
    """Return the time of heel-off, s."""
    if not ends_flat:
        return t_after - end.since
    if template.t_heel_off is not None:
        return min(t_before - start, t_after - end.since)
    by_cadence = t_after - end.since if template.t_flat is None else template.t_flat + template.stance_duration
    return max(t_before, min(by_cadence, t_after - end.since))
