"""Critical times of one step: algorithm 1 of Liu et al. 2015 (IEEE MASS, section IV.C and figure 8).

Axes as in the paper's figure 3: x to the wearer's right, y forward, z up. g is the angular rate, right handed: g_x is
negative while the heel rises and positive while the toe does, g_z is positive for a turn to the left. a_x and a_y are
specific force; a_z is minus the specific force, for the paper's accelerometer shows -9.8 m/s^2 at rest. With these
signs its equation (2) takes gravity out exactly: a foot at rest that is tilted by theta shows a_y = g sin(theta) and
a_z = -g cos(theta), so that a_y cos(theta) + a_z sin(theta) = 0. No other choice does.

- Uplift: g_x turns negative. Liftoff: a_y goes from negative to positive. Landing: a_y goes from positive to negative.
  Rest: both are zero again.
- Algorithm 1 searches the first two from the start of the segment inwards, the others from its end.
- Equality with zero has a dead band, `FLAT_RATE` and `FLAT_FORCE`. A sign counts outside of it; a crossing is where
  the straight line between two samples meets zero, or the edge of the band for the uplift, which starts slowly.
- a_y also crosses zero in mid-swing, where the foot starts to slow down, and by chance as the heel rises; on recorded
  feet it crosses several times as the shoe bounces. Figure 8 shows which crossing is meant: phase 3 starts when the toe
  starts to rise (g_x from negative to positive), and in phase 4 "the instep [moves] downward" (g_x negative again). So
  liftoff is the first crossing between the heel's fastest rise and the toe's, landing the last one in or after the last
  rise of the toe that lies where g_x is no more than `FLAT_RATE` and not later than `LANDING_TIME` after that (the
  shoe goes on shaking). Where a_y does not cross there (the heel strikes at 20 Hz between two samples, a sensor on the
  instep is slower than its shoe), it is where g_x itself crosses."""

from __future__ import annotations

from collections.abc import Sequence

from ...types.attrs import frozen

Row = tuple[float, float, float, float, float, float, float]
"""Time t (s), a_x, a_y, a_z (m/s^2), g_x, g_y, g_z (rad/s), in the paper's axes."""

FLAT_RATE = 0.2
"""Dead band of g_x about zero, rad/s."""
FLAT_FORCE = 0.5
"""Dead band of a_y about zero, m/s^2: that of the paper's static zone."""
LANDING_TIME = 0.06
"""Longest time from the end of the toe's rise to landing, s."""
LEAST_SWING = 0.12
"""Least angle by which the toe rises in a swing, rad."""


@frozen
class CriticalTimes:
    """The critical times of a step, s, in this order.

    At liftoff the foot starts to move forward, at landing it touches the ground."""

    uplift: float
    liftoff: float
    landing: float
    rest: float


def critical_times(rows: Sequence[Row]) -> CriticalTimes | None:
    """Return the critical times of a segment between two static zones, with a little of both; None without a rise."""
    rises = _rises(rows)
    if not rises:
        return None
    (start, first_end), (last_start, end) = rises[0], rises[-1]
    fastest_heel = min(range(start), key=lambda i: rows[i][4], default=0)
    fastest_toe = max(range(start, first_end), key=lambda i: rows[i][4])
    uplift = _uplift(rows, fastest_heel)
    liftoff = _liftoff(rows, fastest_heel, start, fastest_toe)
    landing = _landing(rows, last_start, end)
    rest = _rest(rows, landing)
    liftoff = max(uplift, liftoff)
    landing = max(liftoff, landing)
    return CriticalTimes(uplift, liftoff, landing, max(landing, rest))


def _rises(rows: Sequence[Row]) -> list[tuple[int, int]]:
    """Return [start, end) of each span of positive g_x in which the toe rises by `LEAST_SWING`.

    A dip that does not reach the edge of the dead band ends no span."""
    found: list[tuple[int, int]] = []
    start, last, angle = None, 0, 0.0
    for i in range(1, len(rows)):
        rate = rows[i][4]
        if rate > 0.0:
            if start is None:
                start, angle = i, 0.0
            angle += rate * (rows[i][0] - rows[i - 1][0])
            last = i + 1
        elif rate < -FLAT_RATE and start is not None:
            if angle > LEAST_SWING:
                found.append((start, last))
            start = None
    if start is not None and angle > LEAST_SWING:
        found.append((start, last))
    return found


def _uplift(rows: Sequence[Row], fastest_heel: int) -> float:
    """Return the uplift, from the fastest rise of the heel back to its start: g_x(t - 1) = 0, g_x(t) < 0."""
    i = fastest_heel
    while i > 0 and rows[i - 1][4] < -FLAT_RATE:
        i -= 1
    return _crossing(rows, i, 4, -FLAT_RATE) if i > 0 else rows[0][0]


def _liftoff(rows: Sequence[Row], fastest_heel: int, start: int, fastest_toe: int) -> float:
    """Return the liftoff: a_y(t) < 0, a_y(t + 1) > 0."""
    for i in range(fastest_heel + 1, fastest_toe + 1):
        if rows[i - 1][2] < 0.0 < rows[i][2]:
            return _crossing(rows, i, 2, 0.0)
    return _crossing(rows, start, 4, 0.0)


def _landing(rows: Sequence[Row], start: int, end: int) -> float:
    """Return the landing: a_y(t - 1) > 0, a_y(t) < 0, searched from the end, but not after `LANDING_TIME`."""
    down = _crossing(rows, end, 4, 0.0) if end < len(rows) else rows[-1][0]
    for i in range(len(rows) - 1, start, -1):
        if rows[i - 1][2] > 0.0 > rows[i][2] and rows[i][4] <= FLAT_RATE:
            landing = _crossing(rows, i, 2, 0.0)
            if landing <= down + LANDING_TIME:
                return landing
    return down


def _rest(rows: Sequence[Row], landing: float) -> float:
    """Return the rest, the first time from which g_x(t) and a_y(t) are zero up to the end."""
    i = len(rows) - 1
    while i > 0 and rows[i - 1][0] > landing and abs(rows[i - 1][4]) <= FLAT_RATE and abs(rows[i - 1][2]) <= FLAT_FORCE:
        i -= 1
    return rows[i][0]


def _crossing(rows: Sequence[Row], i: int, column: int, level: float) -> float:
    """Return when the straight line from row i - 1 to row i met the level, s; the time of row i if it did not."""
    before, now = rows[i - 1][column], rows[i][column]
    if (before - level) * (now - level) >= 0.0:
        return rows[i][0]
    share = (level - before) / (now - before)
    return rows[i - 1][0] + share * (rows[i][0] - rows[i - 1][0])
