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
  1.23 m. From uplift, where the foot really rests, the integral gives 75 to 95 %, like the figure. So ours start at
  uplift (closed_stride.py).
- A foot that moves along the way with its long axis turned by phi has a_f = a_m cos(phi) and a_x = a_m sin(phi). Only
  then is (1) true. So the double integral s_f of a_f is s cos(phi), which is shorter than the way s, and the printed
  calibration phi = arccos(s / s_f) (`printed_toe_out`) has no angle. Where it has one, it is the error of the length.
- The integrals use the trapezoidal rule. Between two samples, where the critical times lie, signals are straight lines.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence
from math import acos, cos, sin

from ...types import Vec3
from .critical_times import CriticalTimes, Row


def stride_length(rows: Sequence[Row], times: CriticalTimes, toe_out: float = 0.0) -> Vec3:
    """Return S_x, S_y, S_z of (6) as printed, m; S of (5) is their sum. `toe_out` is phi of (1), rad."""
    theta = angle(span(rows, times.uplift, times.liftoff), 4)
    stride = span(rows, times.liftoff, times.landing)
    x, y, z = (integrals(stride, part)[0] for part in along_the_way(stride, pitches(stride, theta), toe_out))
    return x, y, z


def along_the_way(
    rows: Sequence[Row], tilts: Sequence[float], toe_out: float
) -> tuple[list[float], list[float], list[float]]:
    """Return the parts of a_m (4) that come from a_x, a_y and a_z, m/s^2, at each row; `tilts` is theta of (2), rad."""
    along, across = cos(toe_out), sin(toe_out)
    return (
        [row[1] * across for row in rows],
        [row[2] * cos(tilt) * along for row, tilt in zip(rows, tilts, strict=True)],
        [row[3] * sin(tilt) * along for row, tilt in zip(rows, tilts, strict=True)],
    )


def swing_turn(rows: Sequence[Row], times: CriticalTimes) -> float:
    """Return the turn alpha of (7) as printed, rad, positive to the left."""
    return angle(span(rows, times.liftoff, times.landing), 6)


def printed_toe_out(along: float, distance: float) -> float | None:
    """Return phi = arccos(s / s_f), rad, as printed; None where s_f is shorter than s, so that no angle fits.

    `along` is s_f, the sum of the double integrals of a_f, m, and `distance` is s, the length of a straight walk, m."""
    return acos(distance / along) if along > distance else None


def pitches(stride: Sequence[Row], theta: float = 0.0) -> list[float]:
    """Return the pitch (3) at every row, rad; at the first row it is `theta`."""
    found = [theta]
    for before, row in zip(stride, stride[1:], strict=False):
        found.append(found[-1] + 0.5 * (before[4] + row[4]) * (row[0] - before[0]))
    return found


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


def angle(rows: Sequence[Row], column: int) -> float:
    """Return the integral over time of the rate in `column`, rad."""
    return integrals(rows, [row[column] for row in rows])[1]


def integrals(rows: Sequence[Row], values: Sequence[float]) -> tuple[float, float]:
    """Return the double and the single integral over time of `values`, one for each row, both from zero."""
    double_integral = integral = previous = 0.0
    t = rows[0][0]
    for row, value in zip(rows, values, strict=True):  # the first adds nothing
        dt, t = row[0] - t, row[0]
        double_integral += (integral + (2.0 * previous + value) * dt / 6.0) * dt
        integral += 0.5 * (previous + value) * dt
        previous = value
    return double_integral, integral
