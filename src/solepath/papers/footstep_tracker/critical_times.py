"""Critical times of one stride: algorithm 1 of Liu et al. 2015 (IEEE MASS, section IV.C and figure 8).

Axes as in the paper's figure 3: x to the wearer's right, y forward, z up. g is the angular rate, right handed: g_x is
negative while the heel rises and positive while the toe rises. g_z is positive for a turn to the left. a_x and a_y are
specific force; a_z is minus the specific force, because the paper's accelerometer shows -9.8 m/s^2 at rest. Only with
these signs does equation (2) of the paper remove gravity exactly: a foot at rest that is tilted by theta shows
a_y = g sin(theta) and a_z = -g cos(theta), so that a_y cos(theta) + a_z sin(theta) = 0.

- Uplift: g_x turns negative. Liftoff: a_y goes from negative to positive. Landing: a_y goes from positive to negative.
  Rest: both are zero again.
- Algorithm 1 searches uplift and liftoff backward from the beginning of D_s, landing and rest forward from its end. D_s
  is what lies between two static zones, phases (2) to (4), so uplift and rest lie in the zones before and after it: the
  rows here have the ends of both. Uplift is searched backward from the heel's fastest rise, and rest backward from the
  last row, the first time from which both are zero; these are the times that the paper means. Liftoff cannot lie before
  D_s, where the foot stands, and landing not behind it. The text has "we extract among the segment" instead of lines 2
  and 3, and so it is here: liftoff forward in the segment, landing backward from its end.
- Values within a dead band, `RATE_DEAD_BAND` and `FORCE_DEAD_BAND`, count as zero. A crossing is where the straight
  line between two samples meets zero. For the uplift, which starts slowly, it is where the line meets the band's edge.
- a_y also crosses zero in mid-swing, where the foot starts to slow down, and by chance as the heel rises; on recorded
  feet it crosses several times as the shoe bounces. Figure 8 shows which crossing is meant: phase 3 starts when the toe
  starts to rise (g_x from negative to positive), and in phase 4 "the instep [moves] downward" (g_x negative again). So
  liftoff is the first crossing between the heel's fastest rise and the toe's fastest rise. Landing is the last crossing
  after the start of the toe's last rise. There g_x is at most `RATE_DEAD_BAND`, and the rise ended at most
  `LONGEST_LANDING_DELAY` earlier, since the shoe goes on shaking. If a_y has no such crossing (at 20 Hz a heel-strike
  falls between two samples; a sensor on the instep lags behind its shoe), liftoff is the start of the toe's first rise,
  and landing is the end of its last rise.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence

from ...types.attrs import frozen

Row = tuple[float, float, float, float, float, float, float]
"""Time t (s), a_x, a_y, a_z (m/s^2), g_x, g_y, g_z (rad/s), in the paper's axes unless another frame is named."""

RATE_DEAD_BAND = 0.2
"""Dead band of g_x about zero, rad/s."""
FORCE_DEAD_BAND = 0.5
"""Dead band of a_y about zero, m/s^2: the tolerance of the paper's static zone."""
LONGEST_LANDING_DELAY = 0.06
"""Longest time from the end of the toe's rise to landing, s."""
LEAST_TOE_RISE = 0.12
"""Least angle by which the toe rises in one swing, rad."""


@frozen
class CriticalTimes:
    """The critical times of a stride, s, in this order.

    At uplift the heel starts to rise, at liftoff the foot starts to move forward, at landing it touches the ground, and
    from rest on it lies still."""

    uplift: float
    liftoff: float
    landing: float
    rest: float


def critical_times(rows: Sequence[Row]) -> CriticalTimes | None:
    """Return the critical times of a segment that starts and ends in a static zone; None if the toe never rises."""
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
    """Return the row numbers [start, end) of each span of positive g_x in which the toe rises by `LEAST_TOE_RISE`.

    A span ends only when g_x falls below the dead band."""
    rises: list[tuple[int, int]] = []
    start, end, angle = None, 0, 0.0
    for i in range(1, len(rows)):
        rate = rows[i][4]
        if rate > 0.0:
            if start is None:
                start, angle = i, 0.0
            angle += rate * (rows[i][0] - rows[i - 1][0])
            end = i + 1
        elif rate < -RATE_DEAD_BAND and start is not None:
            if angle > LEAST_TOE_RISE:
                rises.append((start, end))
            start = None
    if start is not None and angle > LEAST_TOE_RISE:
        rises.append((start, end))
    return rises


def _uplift(rows: Sequence[Row], fastest_heel: int) -> float:
    """Return the uplift, s: the start of the heel's fastest rise, g_x(t - 1) = 0, g_x(t) < 0."""
    i = fastest_heel
    while i > 0 and rows[i - 1][4] < -RATE_DEAD_BAND:
        i -= 1
    return _crossing(rows, i, 4, -RATE_DEAD_BAND) if i > 0 else rows[0][0]


def _liftoff(rows: Sequence[Row], fastest_heel: int, start: int, fastest_toe: int) -> float:
    """Return the liftoff, s: a_y(t) < 0, a_y(t + 1) > 0."""
    for i in range(fastest_heel + 1, fastest_toe + 1):
        if rows[i - 1][2] < 0.0 < rows[i][2]:
            return _crossing(rows, i, 2, 0.0)
    return _crossing(rows, start, 4, 0.0)


def _landing(rows: Sequence[Row], start: int, end: int) -> float:
    """Return the landing, s, searched from the end: a_y(t - 1) > 0, a_y(t) < 0; `start`, `end`: the toe's last rise."""
    toe_rise_end = _crossing(rows, end, 4, 0.0) if end < len(rows) else rows[-1][0]
    for i in range(len(rows) - 1, start, -1):
        if rows[i - 1][2] > 0.0 > rows[i][2] and rows[i][4] <= RATE_DEAD_BAND:
            landing = _crossing(rows, i, 2, 0.0)
            if landing <= toe_rise_end + LONGEST_LANDING_DELAY:
                return landing
    return toe_rise_end


def _rest(rows: Sequence[Row], landing: float) -> float:
    """Return the rest, s: the first time from which g_x(t) and a_y(t) are zero up to the end."""
    i = len(rows) - 1
    while (
        i > 0
        and rows[i - 1][0] > landing
        and abs(rows[i - 1][4]) <= RATE_DEAD_BAND
        and abs(rows[i - 1][2]) <= FORCE_DEAD_BAND
    ):
        i -= 1
    return rows[i][0]


def _crossing(rows: Sequence[Row], i: int, column: int, level: float) -> float:
    """Return when the straight line from row i - 1 to row i met the level, s; the time of row i if it did not."""
    before, now = rows[i - 1][column], rows[i][column]
    if (before - level) * (now - level) >= 0.0:
        return rows[i][0]
    share = (level - before) / (now - before)
    return rows[i - 1][0] + share * (rows[i][0] - rows[i - 1][0])
