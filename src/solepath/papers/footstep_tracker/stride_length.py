"""Stride length by projection onto the ground, and turn by the swing (Liu et al. 2015, IEEE MASS, IV.C and IV.D).

    theta(t) = integral of g_x from uplift to t                                   (3)
    a_f = a_y cos(theta) + a_z sin(theta)                                         (2)
    a_m = a_f cos(phi) + a_x sin(phi)                                             (1), (4)
    S   = integral of the integral of a_m from liftoff to landing                 (5)
    S_x, S_y, S_z: the parts of S that come from a_x, a_y and a_z                 (6)
    alpha = integral of g_z from liftoff to landing                               (7)

theta is the pitch of the sole, a_f the horizontal acceleration along the foot, a_m along the direction of walking. Axes
and signs are those of critical_times.py. The paper leaves these points open:

- phi is the toe-out angle, positive outwards from the direction of walking. The paper's x points to the right, so (1)
  as printed holds for a left foot whose toe points outwards: its direction of walking lies to the right of its long
  axis. For a right foot a_x changes its sign.
- (5) starts with zero velocity at liftoff, but a foot is fast by then: its heel has risen for 0.2 s and more. As
  printed, (5) gives half of a stride or less, on emulated and on recorded feet; the paper's figure 11 has 1.11 m of
  1.23 m. From uplift, where the foot really rests, the integral gives 75 to 95 %, like the figure. So the integrals
  start at uplift.
- At rest theta and the velocity are zero. What the integrals give there is an error that has grown evenly with time. It
  is removed (of theta before (2), of the velocity after it), so the integrals end at rest.
- The range of the paper's gyroscope ends at 250 degrees/s. A foot turns faster while the heel rises and again while the
  toe rises. Then clipping causes the error of theta. The clipped toe-up and toe-down angles are two unknowns; theta and
  the velocity at rest, which must be zero, are the two equations for them. The clipped part of a peak is taken for a
  parabola. On emulated feet without any other error than the clipped gyroscope (63 m, four wearers) lengths are then
  0.3 % off; they are 3.8 % too long if the angle is spread evenly over the clipped samples, in both feet alike.
- "When the users are turning they always take the gravity direction as the axis": the rate about it is g_z while the
  foot is flat, and g_z cos(theta) + g_y sin(theta) in general. On four walks with surveyed strides, whose turns were
  178, 175, 1082 and 239 degrees, this gives 183, 200, 1092 and 295 from uplift to rest; (7) as printed gives 333, 352,
  875 and 644.
- When the wearer turns back, a foot swings round at up to 570 degrees/s. The paper's gyroscope measures 105 degrees of
  such a turn of 160. Nothing at rest shows the clipped angle. It is estimated as the area between the range's end and a
  cubic that leaves and reenters the range with the slopes of g_z. The estimate is 40 to 100 % of the clipped angle.
- A foot that moves along the way with its long axis turned by phi has a_f = a_m cos(phi) and a_x = a_m sin(phi). Only
  then is (1) true. So the double integral of a_f is S cos(phi), and that of a_x is S sin(phi) (toe_out.py).
- The integrals use the trapezoidal rule. Between two samples, where the critical times lie, signals are straight lines.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, fsum, inf, sin

from ...types import Vec3
from ...types.vector import GRAVITY
from .critical_times import CriticalTimes, Row

LEAST_VELOCITY_CHANGE = 1.0
"""Change of the velocity at rest for 1 rad of clipped angle, m/s, below which the angle cannot be estimated from it."""
LARGEST_CLIPPED_ANGLE = 1.0
"""Largest clipped angle of a stride in either direction, rad."""


def stride_length(rows: Sequence[Row], times: CriticalTimes, toe_out: float = 0.0) -> Vec3:
    """Return S_x, S_y, S_z of (6) as printed, m; S of (5) is their sum. `toe_out` is phi of (1), rad."""
    theta = _angle(span(rows, times.uplift, times.liftoff), 4)
    return _lengths(span(rows, times.liftoff, times.landing), theta, toe_out)[0]


def closed_stride_length(rows: Sequence[Row], times: CriticalTimes, toe_out: float = 0.0, end: float = inf) -> Vec3:
    """Return S_x, S_y, S_z of (6), m, integrated from uplift to rest, where theta and the velocity are zero again.

    `end` is the end of the gyroscope's range, rad/s: larger absolute values of g_x may be clipped."""
    duration = times.rest - times.uplift
    if not duration > 0.0:
        return (0.0, 0.0, 0.0)
    (x, y, z), (vx, vy, vz) = _lengths(rows_closed_at_rest(rows, times, end), 0.0, toe_out)
    half = 0.5 * duration
    return (x - half * vx, y - half * vy, z - half * vz)


def closed_stride_across(rows: Sequence[Row], times: CriticalTimes) -> float:
    """Return the double integral of a_x, m, right positive, closed at rest like that of a_f."""
    duration = times.rest - times.uplift
    if not duration > 0.0:
        return 0.0
    stride = span(rows, times.uplift, times.rest)
    across, velocity = _integrals(stride, [row[1] for row in stride])
    return across - 0.5 * duration * velocity


def closed_stride_rise(rows: Sequence[Row], times: CriticalTimes, end: float = inf) -> float:
    """Return the change of height of a stride, m, integrated from uplift to rest like `closed_stride_length`.

    The force at right angles to a_f of (2) is a_y sin(theta) - a_z cos(theta), 1 g at rest; the paper does not use it.
    """
    duration = times.rest - times.uplift
    if not duration > 0.0:
        return 0.0
    stride = rows_closed_at_rest(rows, times, end)
    forces = [
        row[2] * sin(tilt) - row[3] * cos(tilt) - GRAVITY for row, tilt in zip(stride, _tilts(stride, 0.0), strict=True)
    ]
    height, velocity = _integrals(stride, forces)
    return height - 0.5 * duration * velocity


def rows_closed_at_rest(rows: Sequence[Row], times: CriticalTimes, end: float = inf) -> list[Row]:
    """Return the rows from uplift to a later rest, with g_x changed so that theta is zero at rest.

    If g_x exceeded `end`, rad/s, in both directions, it is changed so that the velocity of a_f is zero at rest, too."""
    stride = span(rows, times.uplift, times.rest)
    angle_at_rest = _angle(stride, 4)
    toe_up_clipped, toe_down_clipped = _clipped_peaks(stride, 1.0, end), _clipped_peaks(stride, -1.0, end)
    (_, toe_up_time), (_, toe_down_time) = _integrals(stride, toe_up_clipped), _integrals(stride, toe_down_clipped)
    if not (toe_up_time > 0.0 and toe_down_time > 0.0):
        drift = angle_at_rest / (times.rest - times.uplift)
        return [(t, ax, ay, az, gx - drift, gy, gz) for t, ax, ay, az, gx, gy, gz in stride]

    def with_clipped_angle(angle: float) -> list[Row]:
        more, less = angle / toe_up_time, (angle + angle_at_rest) / toe_down_time
        return [
            (t, ax, ay, az, gx + more * r - less * s, gy, gz)
            for (t, ax, ay, az, gx, gy, gz), r, s in zip(stride, toe_up_clipped, toe_down_clipped, strict=True)
        ]

    def speed(changed_rows: list[Row]) -> float:
        return fsum(_lengths(changed_rows, 0.0, 0.0)[1])

    # the toe rose `angle` more than was measured, and sank `angle` + `angle_at_rest` more
    least_angle = max(0.0, -angle_at_rest)
    angle, changed_rows = least_angle, with_clipped_angle(least_angle)
    speed_at_rest = speed(changed_rows)
    slope = (speed(with_clipped_angle(least_angle + 0.1)) - speed_at_rest) / 0.1
    if abs(slope) < LEAST_VELOCITY_CHANGE:
        return changed_rows
    for _ in range(2):
        angle = min(max(angle - speed_at_rest / slope, least_angle), least_angle + LARGEST_CLIPPED_ANGLE)
        changed_rows = with_clipped_angle(angle)
        speed_at_rest = speed(changed_rows)
    return changed_rows


def _clipped_peaks(stride: Sequence[Row], sign: float, end: float) -> list[float]:
    """Return the shape of what was clipped of `sign` times g_x at each row, in any unit: a parabola over each span.

    A smooth peak looks like that above the end of the range, rad/s. It leaves and reenters the range between two rows;
    the parabola is zero in the middle between them."""
    shape = [0.0] * len(stride)
    i, last = 0, len(stride) - 1
    while i <= last:
        if sign * stride[i][4] <= end:
            i += 1
            continue
        first = i
        while i <= last and sign * stride[i][4] > end:
            i += 1
        left = 0.5 * (stride[max(first - 1, 0)][0] + stride[first][0])
        right = 0.5 * (stride[i - 1][0] + stride[min(i, last)][0])
        for k in range(first, i):
            shape[k] = max(0.0, (stride[k][0] - left) * (right - stride[k][0]))
    return shape


def swing_turn(rows: Sequence[Row], times: CriticalTimes) -> float:
    """Return the turn alpha of (7) as printed, rad, positive to the left."""
    return _angle(span(rows, times.liftoff, times.landing), 6)


def vertical_turn(rows: Sequence[Row], times: CriticalTimes, end: float = inf) -> float:
    """Return the turn about the vertical from uplift to the last row, rad, positive to the left.

    After rest a flat foot may still pivot. `end` is the end of the gyroscope's range, rad/s."""
    if not times.rest > times.uplift:
        return 0.0
    stride = rows_closed_at_rest(rows, times, end)
    rates = [row[6] * cos(theta) + row[5] * sin(theta) for row, theta in zip(stride, _tilts(stride, 0.0), strict=True)]
    angle = _integrals(stride, rates)[1] + _angle(span(rows, times.rest, max(times.rest, rows[-1][0])), 6)
    return angle + clipped_turn(rows, end)


def clipped_turn(rows: Sequence[Row], end: float) -> float:
    """Return the clipped turn, rad, left positive: areas of cubics over the spans of g_z beyond `end`, rad/s."""
    total = 0.0
    i, n = 2, len(rows)
    while i < n - 2:
        sign = 1.0 if rows[i][6] > 0.0 else -1.0
        if sign * rows[i][6] < end:
            i += 1
            continue
        first = i
        while i < n - 2 and sign * rows[i][6] >= end:
            i += 1
        # rows first - 1 and i are the neighbours of the clipped span
        highest_rate = max([sign * row[6] for row in rows[first:i]])
        before = [(row[0], sign * row[6]) for row in (rows[first - 2], rows[first - 1], rows[first])]
        after = [(-row[0], sign * row[6]) for row in (rows[i + 1], rows[i], rows[i - 1])]
        (start, rise), (end_negated, fall) = _edge(before, highest_rate), _edge(after, highest_rate)
        duration = max(0.0, -end_negated - start)
        total += sign * min(duration * duration * (rise + fall) / 12.0, LARGEST_CLIPPED_ANGLE)
    return total


def _edge(rows: Sequence[tuple[float, float]], highest_rate: float) -> tuple[float, float]:
    """Return the time, s, and slope, rad/s^2, with which a line through the rows reaches `highest_rate`, rad/s.

    A row is (s, rad/s). The first two rows lie below the end of the range, the third at it. The slope is that of the
    steeper of the two lines between neighbours."""
    (t0, a), (t1, b), (t2, _) = rows
    slope = max((b - a) / max(t1 - t0, 1e-3), (highest_rate - b) / max(t2 - t1, 1e-3), 1.0)
    return t1 + (highest_rate - b) / slope, slope


def _lengths(stride: Sequence[Row], theta: float, toe_out: float) -> tuple[Vec3, Vec3]:
    """Return S_x, S_y, S_z of (6), m, and the same three terms of the final velocity, m/s; `theta` is initial, rad."""
    along, across = cos(toe_out), sin(toe_out)
    tilts = _tilts(stride, theta)
    s_x, v_x = _integrals(stride, [row[1] * across for row in stride])  # (2), (4)
    s_y, v_y = _integrals(stride, [row[2] * cos(tilt) * along for row, tilt in zip(stride, tilts, strict=True)])
    s_z, v_z = _integrals(stride, [row[3] * sin(tilt) * along for row, tilt in zip(stride, tilts, strict=True)])
    return (s_x, s_y, s_z), (v_x, v_y, v_z)


def _tilts(stride: Sequence[Row], theta: float) -> list[float]:
    """Return the pitch (3) at every row, rad; at the first row it is `theta`."""
    tilts = [theta]
    for before, row in zip(stride, stride[1:], strict=False):
        tilts.append(tilts[-1] + 0.5 * (before[4] + row[4]) * (row[0] - before[0]))
    return tilts


def span(rows: Sequence[Row], start: float, end: float) -> list[Row]:
    """Return the rows from time `start` to `end`, s, with an interpolated row at either end."""
    inside = [row for row in rows if start < row[0] < end]
    return [_row_at(rows, start), *inside, _row_at(rows, end)]


def _row_at(rows: Sequence[Row], t: float) -> Row:
    """Return the row at `t` s, interpolated."""
    before = rows[0]
    for row in rows:
        if row[0] >= t:
            k = 1.0 if row[0] <= before[0] else (t - before[0]) / (row[0] - before[0])
            k = max(k, 0.0)
            x, y, z, u, v, w = (b + k * (n - b) for b, n in zip(before[1:], row[1:], strict=True))
            return (t, x, y, z, u, v, w)
        before = row
    return (t, *rows[-1][1:])


def _angle(rows: Sequence[Row], column: int) -> float:
    """Return the integral over time of the rate in `column`, rad."""
    return _integrals(rows, [row[column] for row in rows])[1]


def _integrals(rows: Sequence[Row], values: Sequence[float]) -> tuple[float, float]:
    """Return the double and the single integral over time of `values`, one for each row, both from zero."""
    double_integral = integral = previous = 0.0
    t = rows[0][0]
    for row, value in zip(rows, values, strict=True):  # the first adds nothing
        dt, t = row[0] - t, row[0]
        double_integral += (integral + (2.0 * previous + value) * dt / 6.0) * dt
        integral += 0.5 * (previous + value) * dt
        previous = value
    return double_integral, integral
