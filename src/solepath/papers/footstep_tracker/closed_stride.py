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

from collections.abc import Iterator, Sequence
from itertools import groupby
from math import cos, inf, sin

from ...types import Floats
from ...types.attrs import frozen
from ...types.vector import GRAVITY
from .critical_times import CriticalTimes, Row
from .stride_length import along_the_way, angle, integrals, pitches, span

LEAST_VELOCITY_CHANGE = 1.0
"""Change of the velocity at rest for 1 rad of clipped angle, m/s, below which the angle cannot be estimated from it."""
LARGEST_CLIPPED_ANGLE = 1.0
"""Largest clipped angle of a stride in either direction, rad."""


@frozen
class RestToRest:
    """The rows of a stride from uplift to rest, and their pitch theta, rad."""

    rows: tuple[Row, ...]
    tilts: Floats

    def length(self, toe_out: float = 0.0) -> float:
        """Return S of (5), m, from uplift, with zero velocity at rest. `toe_out` is phi of (1), rad."""
        return self._closed(self._along(toe_out))

    def speed_at_rest(self) -> float:
        """Return the velocity at rest by the integral of a_f (2), m/s: an error."""
        return integrals(self.rows, self._along(0.0))[1]

    def rise(self) -> float:
        """Return the change of height, m, with zero velocity at rest.

        The force at right angles to a_f of (2) is a_y sin(theta) - a_z cos(theta), 1 g at rest; the paper does not use
        it."""
        tilted = zip(self.rows, self.tilts, strict=True)
        return self._closed([row[2] * sin(tilt) - row[3] * cos(tilt) - GRAVITY for row, tilt in tilted])

    def turn(self) -> float:
        """Return the turn about the vertical, rad, positive to the left, without what was clipped."""
        tilted = zip(self.rows, self.tilts, strict=True)
        return integrals(self.rows, [row[6] * cos(tilt) + row[5] * sin(tilt) for row, tilt in tilted])[1]

    def _along(self, toe_out: float) -> list[float]:
        return [x + y + z for x, y, z in zip(*along_the_way(self.rows, self.tilts, toe_out), strict=True)]

    def _closed(self, forces: Sequence[float]) -> float:
        distance, velocity = integrals(self.rows, forces)
        return distance - 0.5 * (self.rows[-1][0] - self.rows[0][0]) * velocity


def closed_stride(rows: Sequence[Row], times: CriticalTimes, end: float = inf) -> RestToRest:
    """Return the stride with g_x changed so that theta is zero at rest.

    If g_x exceeded `end`, rad/s, in both directions, it is changed so that the velocity of a_f is zero at rest, too."""
    stride = span(rows, times.uplift, times.rest)
    angle_at_rest = angle(stride, 4)
    toe_up, toe_down = _clipped_shape(stride, 1.0, end), _clipped_shape(stride, -1.0, end)
    if not (toe_up and toe_down):
        duration = stride[-1][0] - stride[0][0]
        drift = angle_at_rest / duration if duration > 0.0 else 0.0
        return _with_rates(stride, [row[4] - drift for row in stride])

    def with_clipped(clipped: float) -> RestToRest:
        """Return the stride whose toe rose by `clipped` rad more than was measured, and sank by what closes it."""
        sunk = clipped + angle_at_rest
        rates = [row[4] + clipped * up - sunk * down for row, up, down in zip(stride, toe_up, toe_down, strict=True)]
        return _with_rates(stride, rates)

    least = clipped = max(0.0, -angle_at_rest)
    found = with_clipped(least)
    slope = (with_clipped(least + 0.1).speed_at_rest() - found.speed_at_rest()) / 0.1
    if abs(slope) >= LEAST_VELOCITY_CHANGE:
        for _ in range(2):
            clipped = min(max(clipped - found.speed_at_rest() / slope, least), least + LARGEST_CLIPPED_ANGLE)
            found = with_clipped(clipped)
    return found


def vertical_turn(rows: Sequence[Row], times: CriticalTimes, stride: RestToRest, end: float = inf) -> float:
    """Return the turn about the vertical from uplift to the last row, rad, positive to the left.

    After rest a flat foot may still pivot. `end` is the end of the gyroscope's range, rad/s."""
    if not times.rest > times.uplift:
        return 0.0
    return stride.turn() + angle(span(rows, times.rest, max(times.rest, rows[-1][0])), 6) + _clipped_turn(rows, end)


def _with_rates(stride: Sequence[Row], rates: Sequence[float]) -> RestToRest:
    """Return the stride with these rates about x, rad/s."""
    rows = [(*row[:4], rate, *row[5:]) for row, rate in zip(stride, rates, strict=True)]
    return RestToRest(tuple(rows), tuple(pitches(rows)))


def _clipped_spans(rates: Sequence[float], end: float) -> Iterator[tuple[int, int]]:
    """Yield the numbers [first, after) of each span of rates beyond `end`, rad/s."""
    first = 0
    for beyond, span_of in groupby([rate > end for rate in rates]):
        after = first + len(list(span_of))
        if beyond:
            yield first, after
        first = after


def _clipped_shape(stride: Sequence[Row], sign: float, end: float) -> list[float]:
    """Return the shape of what was clipped of `sign` times g_x at each row, 1/s, with an integral of 1; [] for nothing.

    It is a parabola over each span. A smooth peak looks like that above the end of the range, rad/s. It leaves and
    reenters the range between two rows; the parabola is zero in the middle between them."""
    shape, last = [0.0] * len(stride), len(stride) - 1
    for first, after in _clipped_spans([sign * row[4] for row in stride], end):
        left = 0.5 * (stride[max(first - 1, 0)][0] + stride[first][0])
        right = 0.5 * (stride[after - 1][0] + stride[min(after, last)][0])
        for k in range(first, after):
            shape[k] = max(0.0, (stride[k][0] - left) * (right - stride[k][0]))
    whole = integrals(stride, shape)[1]
    return [value / whole for value in shape] if whole > 0.0 else []


def _clipped_turn(rows: Sequence[Row], end: float) -> float:
    """Return the clipped turn, rad, left positive: areas of cubics over the spans of g_z beyond `end`, rad/s."""
    total = 0.0
    for sign in (1.0, -1.0):
        rates = [sign * row[6] for row in rows]
        for first, after in _clipped_spans(rates, end):
            if first >= 2 and after <= len(rows) - 2:
                highest_rate = max(rates[first:after])
                points = [(row[0], rate) for row, rate in zip(rows, rates, strict=True)]
                start, rise = _edge(points[first - 2 : first + 1], highest_rate)
                back, fall = _edge([(-t, rate) for t, rate in points[after + 1 : after - 2 : -1]], highest_rate)
                duration = max(0.0, -back - start)
                total += sign * min(duration * duration * (rise + fall) / 12.0, LARGEST_CLIPPED_ANGLE)
    return total


def _edge(rows: Sequence[tuple[float, float]], highest_rate: float) -> tuple[float, float]:
    """Return the time, s, and slope, rad/s^2, with which a line through the rows reaches `highest_rate`, rad/s.

    A row is (s, rad/s). The first two rows lie below the end of the range, the third at it. The slope is that of the
    steeper of the two lines between neighbours."""
    (t0, a), (t1, b), (t2, _) = rows
    slope = max((b - a) / max(t1 - t0, 1e-3), (highest_rate - b) / max(t2 - t1, 1e-3), 1.0)
    return t1 + (highest_rate - b) / slope, slope
