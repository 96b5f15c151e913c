"""A stride from one rest to the next, in which pitch and velocity are zero at both ends: ours beside (5) and (7).

Equations and axes are those of stride_length.py, integrated from uplift, where the foot really rests, to rest:

- At rest theta and the velocity are zero. What the integrals give there is an error that has grown evenly with time. It
  is removed, of theta before (2), of the velocity after it.
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

Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, inf, sin

from ...types import Vec3
from ...types.attrs import frozen
from ...types.vector import GRAVITY
from .critical_times import CriticalTimes, Row
from .stride_length import angle, integrals, pitches, span

LEAST_VELOCITY_CHANGE = 1.0
"""Change of the velocity at rest for 1 rad of clipped angle, m/s, below which the angle cannot be estimated from it."""
LARGEST_CLIPPED_ANGLE = 1.0
"""Largest clipped angle of a stride in either direction, rad."""


@frozen
class RestToRest:
    """The rows of a stride from uplift to rest, and the pitch that is zero at both."""

    rows: tuple[Row, ...]
    cosines: tuple[float, ...]
    """Cosine of the pitch at each row."""
    sines: tuple[float, ...]
    """Sine of the pitch at each row."""

    def length(self, toe_out: float = 0.0) -> Vec3:
        """Return S_x, S_y, S_z of (6), m, with zero velocity at rest. `toe_out` is phi of (1), rad."""
        along, across = cos(toe_out), sin(toe_out)
        return (
            self._closed([row[1] * across for row in self.rows]),  # (2), (4)
            self._closed([row[2] * c * along for row, c in zip(self.rows, self.cosines, strict=True)]),
            self._closed([row[3] * s * along for row, s in zip(self.rows, self.sines, strict=True)]),
        )

    def across(self) -> float:
        """Return the double integral of a_x, m, right positive, with zero velocity at rest."""
        return self._closed([row[1] for row in self.rows])

    def rise(self) -> float:
        """Return the change of height, m, with zero velocity at rest.

        The force at right angles to a_f of (2) is a_y sin(theta) - a_z cos(theta), 1 g at rest; the paper does not use
        it."""
        directions = zip(self.rows, self.cosines, self.sines, strict=True)
        return self._closed([row[2] * s - row[3] * c - GRAVITY for row, c, s in directions])

    def turn(self) -> float:
        """Return the turn about the vertical, rad, positive to the left, without what was clipped."""
        directions = zip(self.rows, self.cosines, self.sines, strict=True)
        return integrals(self.rows, [row[6] * c + row[5] * s for row, c, s in directions])[1]

    def _closed(self, forces: list[float]) -> float:
        distance, velocity = integrals(self.rows, forces)
        return distance - 0.5 * (self.rows[-1][0] - self.rows[0][0]) * velocity


def closed_stride(rows: Sequence[Row], times: CriticalTimes, end: float = inf) -> RestToRest:
    """Return the stride with g_x changed so that theta is zero at rest.

    If g_x exceeded `end`, rad/s, in both directions, it is changed so that the velocity of a_f is zero at rest, too."""
    stride = span(rows, times.uplift, times.rest)
    rates = _rates_closed_at_rest(stride, end)
    changed = [(t, ax, ay, az, rate, gy, gz) for (t, ax, ay, az, _, gy, gz), rate in zip(stride, rates, strict=True)]
    tilts = pitches(changed)
    return RestToRest(tuple(changed), tuple(map(cos, tilts)), tuple(map(sin, tilts)))


def vertical_turn(rows: Sequence[Row], times: CriticalTimes, stride: RestToRest, end: float = inf) -> float:
    """Return the turn about the vertical from uplift to the last row, rad, positive to the left.

    After rest a flat foot may still pivot. `end` is the end of the gyroscope's range, rad/s."""
    if not times.rest > times.uplift:
        return 0.0
    return stride.turn() + angle(span(rows, times.rest, max(times.rest, rows[-1][0])), 6) + clipped_turn(rows, end)


def _rates_closed_at_rest(stride: Sequence[Row], end: float) -> list[float]:
    """Return g_x of each row, rad/s, as `closed_stride` changes it."""
    duration = stride[-1][0] - stride[0][0]
    angle_at_rest = angle(stride, 4)
    toe_up_clipped, toe_down_clipped = _clipped_peaks(stride, 1.0, end), _clipped_peaks(stride, -1.0, end)
    toe_up_time = integrals(stride, toe_up_clipped)[1] if toe_up_clipped else 0.0
    toe_down_time = integrals(stride, toe_down_clipped)[1] if toe_down_clipped else 0.0
    if not (toe_up_time > 0.0 and toe_down_time > 0.0):
        drift = angle_at_rest / duration if duration > 0.0 else 0.0
        return [row[4] - drift for row in stride]

    def with_clipped_angle(clipped: float) -> list[float]:
        more, less = clipped / toe_up_time, (clipped + angle_at_rest) / toe_down_time
        return [
            row[4] + more * r - less * s for row, r, s in zip(stride, toe_up_clipped, toe_down_clipped, strict=True)
        ]

    # the toe rose `clipped` more than was measured, and sank `clipped` + `angle_at_rest` more
    least = max(0.0, -angle_at_rest)
    clipped, rates = least, with_clipped_angle(least)
    speed = _speed_at_rest(stride, rates)
    slope = (_speed_at_rest(stride, with_clipped_angle(least + 0.1)) - speed) / 0.1
    if abs(slope) < LEAST_VELOCITY_CHANGE:
        return rates
    for k in range(2):
        clipped = min(max(clipped - speed / slope, least), least + LARGEST_CLIPPED_ANGLE)
        rates = with_clipped_angle(clipped)
        if k == 0:
            speed = _speed_at_rest(stride, rates)
    return rates


def _speed_at_rest(stride: Sequence[Row], rates: Sequence[float]) -> float:
    """Return the velocity of a_f (2) at the last row, m/s, zero at the first; `rates` is g_x of each row, rad/s."""
    t, _, force_y, force_z, _, _, _ = stride[0]
    force_z = 0.0  # sin(theta) is 0
    rate, theta, speed_y, speed_z = rates[0], 0.0, 0.0, 0.0
    for (next_t, _, ay, az, _, _, _), next_rate in zip(stride[1:], rates[1:], strict=True):
        dt = next_t - t
        theta += 0.5 * (rate + next_rate) * dt  # (3)
        next_y, next_z = ay * cos(theta), az * sin(theta)
        speed_y += 0.5 * (force_y + next_y) * dt
        speed_z += 0.5 * (force_z + next_z) * dt
        t, rate, force_y, force_z = next_t, next_rate, next_y, next_z
    return speed_y + speed_z


def _clipped_peaks(stride: Sequence[Row], sign: float, end: float) -> list[float]:
    """Return the shape of what was clipped of `sign` times g_x at each row, in any unit; [] if nothing was clipped.

    It is a parabola over each span. A smooth peak looks like that above the end of the range, rad/s. It leaves and
    reenters the range between two rows; the parabola is zero in the middle between them."""
    if not any([sign * row[4] > end for row in stride]):
        return []
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
