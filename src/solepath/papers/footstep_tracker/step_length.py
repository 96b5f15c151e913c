"""Step length by projection onto the ground, and turn by the swing (Liu et al. 2015, IEEE MASS, IV.C and IV.D).

    theta(t) = integral of g_x from uplift to t                                   (3)
    a_f = a_y cos(theta) + a_z sin(theta)                                         (2)
    a_m = a_f cos(phi) + a_x sin(phi)                                             (1), (4)
    S   = integral of the integral of a_m from liftoff to landing                 (5)
    S_x, S_y, S_z: the parts of S that come from a_x, a_y and a_z                 (6)
    alpha = integral of g_z from liftoff to landing                               (7)

Axes and signs are those of critical_times.py. Open in the paper, and settled here:

- phi is the toe-out angle, from the foot's direction outwards. The paper's x points to the right, so that (1) as
  printed holds for a left foot whose toe points outwards: its way lies to the right of its direction. For a right foot
  a_x changes its sign.
- (5) starts with no velocity, but at liftoff a foot is fast already: its heel has risen for 0.2 s and more. As printed
  it has half of a step or less, on emulated feet and on recorded ones; figure 11 has 1.11 m of 1.23 m. From uplift,
  where the foot really rests, the same integral has 75 to 95 %, as the figure does. So the integrals start at uplift.
- At rest theta and the velocity are zero. Their errors there have grown evenly, and are removed (theta before (2), the
  velocity after it), and the integrals end at rest.
- The paper's gyroscope ends at 250 degrees/s, which a foot exceeds as its heel rises and again as its toe does. Then
  the error of theta comes from there, with a part of either sign: two unknowns, which theta and the velocity at rest
  give.
- "When the users are turning they always take the gravity direction as the axis": the rate about it is g_z while the
  foot is flat, and g_z cos(theta) + g_y sin(theta) in general. Where strides were surveyed this comes to 183, 200, 1092
  and 295 degrees from uplift to rest, of 178, 175, 1082 and 239; (7) as printed to 333, 352, 875 and 644.
- A foot that turns about swings round at up to 570 degrees/s, of which that gyroscope has 105 degrees where 160 were
  turned. No rest shows the clipped part. It is estimated as the area between the end of the range and the curve that
  leaves it and comes back to it as steeply as g_z did (a cubic), which is 40 to 100 % of it.
- The integrals are trapezoidal. The critical times lie between two samples, where the signals are straight lines."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, inf, sin

from ...types import Vec3
from .critical_times import CriticalTimes, Row

LEAST_SLOPE = 1.0
"""Change of velocity for 1 rad of clipped angle, m/s, below which velocity does not show that angle."""
MOST_HIDDEN_TURN = 1.0
"""Largest clipped angle of a step to either side, rad."""


def step_length(rows: Sequence[Row], times: CriticalTimes, toe_out: float = 0.0) -> Vec3:
    """Return S_x, S_y, S_z of (6) in m, as printed; S of (5) is their sum. `toe_out`: phi of (1), rad."""
    theta = _angle(span(rows, times.uplift, times.liftoff), 4)
    return _lengths(span(rows, times.liftoff, times.landing), theta, toe_out)[0]


def closed_step_length(rows: Sequence[Row], times: CriticalTimes, toe_out: float = 0.0, end: float = inf) -> Vec3:
    """Return S_x, S_y, S_z of (6) in m from uplift to rest, where theta and the velocity are zero again.

    `end`: g_x beyond this, rad/s, may be clipped."""
    duration = times.rest - times.uplift
    if not duration > 0.0:
        return (0.0, 0.0, 0.0)
    (x, y, z), (vx, vy, vz) = _lengths(close_at_rest(rows, times, end), 0.0, toe_out)
    half = 0.5 * duration
    return (x - half * vx, y - half * vy, z - half * vz)


def close_at_rest(rows: Sequence[Row], times: CriticalTimes, end: float = inf) -> list[Row]:
    """Return the rows from uplift to rest (later than that), with g_x changed so that theta is zero at rest.

    Where some of g_x was beyond `end` to either side, the velocity of a_f is zero at rest, too."""
    step = span(rows, times.uplift, times.rest)
    left = _angle(step, 4)
    rises = [1.0 if row[4] > end else 0.0 for row in step]
    sinks = [1.0 if row[4] < -end else 0.0 for row in step]
    up = down = 0.0
    if 1.0 in rises and 1.0 in sinks:
        (_, up), (_, down) = _integrals(step, rises), _integrals(step, sinks)
    if not (up > 0.0 and down > 0.0):
        drift = left / (times.rest - times.uplift)
        return [(t, ax, ay, az, gx - drift, gy, gz) for t, ax, ay, az, gx, gy, gz in step]

    def with_hidden_turn(angle: float) -> list[Row]:
        more, less = angle / up, (angle + left) / down
        return [
            (t, ax, ay, az, gx + more * r - less * s, gy, gz)
            for (t, ax, ay, az, gx, gy, gz), r, s in zip(step, rises, sinks, strict=True)
        ]

    def speed(found: list[Row]) -> float:
        return sum(_lengths(found, 0.0, 0.0)[1])

    # the toe rose further by `angle` than was measured, and sank further by `angle` + `left`
    least = max(0.0, -left)
    angle, found = least, with_hidden_turn(least)
    now = speed(found)
    slope = (speed(with_hidden_turn(least + 0.1)) - now) / 0.1
    if abs(slope) < LEAST_SLOPE:
        return found
    for _ in range(2):
        angle = min(max(angle - now / slope, least), least + MOST_HIDDEN_TURN)
        found = with_hidden_turn(angle)
        now = speed(found)
    return found


def swing_turn(rows: Sequence[Row], times: CriticalTimes) -> float:
    """Return alpha of (7), as printed: positive to the left, rad."""
    return _angle(span(rows, times.liftoff, times.landing), 6)


def vertical_turn(rows: Sequence[Row], times: CriticalTimes, end: float = inf) -> float:
    """Return the turn about the vertical from uplift to the last row, rad: a flat foot may pivot yet.

    `end`: rates beyond this, rad/s, may be clipped."""
    if not times.rest > times.uplift:
        return 0.0
    step = close_at_rest(rows, times, end)
    rates = [row[6] * cos(theta) + row[5] * sin(theta) for row, theta in zip(step, _tilts(step, 0.0), strict=True)]
    angle = _integrals(step, rates)[1] + _angle(span(rows, times.rest, max(times.rest, rows[-1][0])), 6)
    return angle + hidden_turn(rows, end)


def hidden_turn(rows: Sequence[Row], end: float) -> float:
    """Return the clipped turn, rad: the area under the cubic over each span of g_z beyond `end`, rad/s."""
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
        # rows first - 1 and i are the last before it and the first after it
        most = max([sign * row[6] for row in rows[first:i]])
        before = [(row[0], sign * row[6]) for row in (rows[first - 2], rows[first - 1], rows[first])]
        after = [(-row[0], sign * row[6]) for row in (rows[i + 1], rows[i], rows[i - 1])]
        (start, rise), (back, fall) = _edge(before, most), _edge(after, most)
        duration = max(0.0, -back - start)
        total += sign * min(duration * duration * (rise + fall) / 12.0, MOST_HIDDEN_TURN)
    return total


def _edge(rows: Sequence[tuple[float, float]], most: float) -> tuple[float, float]:
    """Return when the line through two rows below the end of a range meets `most`, s, and its slope, rad/s^2.

    The third row is at the end of the range. The line to it is taken where that is steeper. Rows in (s, rad/s)."""
    (t0, a), (t1, b), (t2, _) = rows
    slope = max((b - a) / max(t1 - t0, 1e-3), (most - b) / max(t2 - t1, 1e-3), 1.0)
    return t1 + (most - b) / slope, slope


def _lengths(step: Sequence[Row], theta: float, toe_out: float) -> tuple[Vec3, Vec3]:
    """Return the parts of (6), m, and of the velocity at the end, m/s. `theta` at the start, rad."""
    along, across = cos(toe_out), sin(toe_out)
    tilts = _tilts(step, theta)
    s_x, v_x = _integrals(step, [row[1] * across for row in step])  # (2), (4)
    s_y, v_y = _integrals(step, [row[2] * cos(tilt) * along for row, tilt in zip(step, tilts, strict=True)])
    s_z, v_z = _integrals(step, [row[3] * sin(tilt) * along for row, tilt in zip(step, tilts, strict=True)])
    return (s_x, s_y, s_z), (v_x, v_y, v_z)


def _tilts(step: Sequence[Row], theta: float) -> list[float]:
    """Return (3) at every row, rad, `theta` at the first."""
    tilts = [theta]
    for before, row in zip(step, step[1:], strict=False):
        tilts.append(tilts[-1] + 0.5 * (before[4] + row[4]) * (row[0] - before[0]))
    return tilts


def span(rows: Sequence[Row], start: float, end: float) -> list[Row]:
    """Return the rows from `start` to `end`, s, with an interpolated row at either end."""
    inside = [row for row in rows if start < row[0] < end]
    return [_at(rows, start), *inside, _at(rows, end)]


def _at(rows: Sequence[Row], t: float) -> Row:
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
    """Return the integral of a rate of the rows, rad."""
    return _integrals(rows, [row[column] for row in rows])[1]


def _integrals(rows: Sequence[Row], values: Sequence[float]) -> tuple[float, float]:
    """Return the double integral of a value at each row, and the integral, both from zero."""
    twice = once = previous = 0.0
    t = rows[0][0]
    for row, now in zip(rows, values, strict=True):  # the first adds nothing
        dt, t = row[0] - t, row[0]
        twice += (once + (2.0 * previous + now) * dt / 6.0) * dt
        once += 0.5 * (previous + now) * dt
        previous = now
    return twice, once
