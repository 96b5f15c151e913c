"""Strides from the raw samples of one foot, for checks that must work when the tracker of the foot cannot.

The samples are summed to intervals of about 20 ms. A stance is found by the size of the angular rate and by the
steadiness of the specific force, which do not depend on the mounting, on mirrored axes, or on gravity."""

from __future__ import annotations

from collections.abc import Iterable
from math import sqrt
from typing import NamedTuple

from ...events import Defect, DefectFound
from ...types import SITE_OF_FOOT, Foot, Vec3
from ...types.attrs import define, field

# The finding of a check of a foot's sensors.

Axes = tuple[int, int, int]
"""Gyroscope axis, 1 to 3, for each accelerometer axis; negative for the opposite direction."""


class Finding(NamedTuple):
    """A defect of a foot's samples; the fields are those of `DefectFound`."""

    defect: Defect
    what: str
    spoils: bool = True
    axes: Axes | None = None

    def event(self, foot: Foot, t: float, known_at: float) -> DefectFound:
        """Return the event of a foot by which the finding is reported."""
        site, (defect, what, spoils, axes) = SITE_OF_FOOT[foot], self
        return DefectFound(t=t, known_at=known_at, site=site, defect=defect, what=what, spoils=spoils, axes=axes)


INTERVAL = 0.0185
"""Shortest duration of an interval, s: two samples at 100 Hz, four at 200 Hz."""
LONGEST_SAMPLE = 0.15
"""Longest time between two samples that is integrated over, s; a stride with a longer one is discarded."""
HALF_WINDOW = 2
"""Number of intervals before and after an instant over which its motion is averaged: 0.1 s in all."""
STEADINESS_WEIGHT = 0.2
"""Motion for each unit of standard deviation of the specific force, (rad/s)/(m/s^2)."""
SWING_MOTION, STANCE_MOTION = 2.0, 1.0
"""Motion above which a foot swings, and below which it stands, rad/s."""
TICK, TURN, FORCE = 2.0**-20, 2.0**-16, 2.0**-10
"""Units of an interval's duration, s, its turn, rad, and its specific force, m/s^2."""
BEST_WITHIN = int(0.4 / TICK)
"""Time after the first and before the last instant of a stance in which its stillest one is searched, `TICK`."""
MOST_INTERVALS = 140
"""Largest number of intervals of a stride, 2.6 s; the start of a longer one is forgotten."""

Interval = tuple[int, int, int, int, int, int, int]
"""Duration, integral of the angular rate and mean specific force, sensor frame, as whole numbers: they are short in a
saved state. The units are `TICK`, `TURN` and `FORCE`."""

Row = tuple[float, Vec3, Vec3]
"""Time, s, specific force, m/s^2, and angular rate, rad/s, of a sample."""


class ClosedStride(NamedTuple):
    """The motion of a foot from the stillest instant of a stance to that of the next one."""

    intervals: tuple[Interval, ...]
    """Intervals after the first instant, up to the second one."""
    first: Vec3
    """Mean specific force around the first instant, sensor frame, m/s^2."""
    last: Vec3
    """Mean specific force around the second instant, sensor frame, m/s^2."""
    motion: float
    """Motion around the second instant, rad/s."""
    duration: float
    """Duration of the intervals, s."""


@define
class StanceFinder:
    """Divides the samples of one foot into strides, each from the stillest instant of a stance to the next one's."""

    t: float | None = None
    """Time of the last sample, s; None before any."""
    duration: float = 0.0
    """Duration of the interval under way, s."""
    turn: Vec3 = (0.0, 0.0, 0.0)
    """Integral of what the gyroscope reads, its bias included, over the interval under way, rad."""
    force: Vec3 = (0.0, 0.0, 0.0)
    """Integral of the specific force over the interval under way, m/s."""
    intervals: list[Interval] = field(factory=list)
    """Newest intervals: those of the stride under way and `HALF_WINDOW` before it."""
    rates: tuple[float, ...] = ()
    """Mean angular rates of the newest intervals, rad/s: at most 2 HALF_WINDOW + 1 of them."""
    start: int | None = None
    """Index of the instant at which the stride under way began; None when it is unknown."""
    best: int | None = None
    """Index of the stillest instant at the beginning of the current stance; None in a swing."""
    latest: int | None = None
    """Index of the stillest recent instant of the current stance, where the next stride begins; None in a swing."""
    since_best: int = 0
    """Time since `best`, in units of `TICK`."""
    since_latest: int = 0
    """Time since `latest`, in units of `TICK`."""
    best_motion: float = 0.0
    """Motion at `best`, rad/s."""
    latest_motion: float = 0.0
    """Motion at `latest`, rad/s."""

    def add(self, rows: Iterable[Row], bias: Vec3 = (0.0, 0.0, 0.0)) -> list[tuple[float, ClosedStride]]:
        """Add samples of a gyroscope with a `bias`, rad/s; return the strides that end, and when each is known, s."""
        bx, by, bz = bias
        t_last, duration, (a, b, c), (p, q, r) = self.t, self.duration, self.turn, self.force
        found: list[tuple[float, ClosedStride]] = []
        for t, (ax, ay, az), (x, y, z) in rows:
            dt = 0.0 if t_last is None else t - t_last
            t_last = t
            if not 0.0 < dt < LONGEST_SAMPLE:
                duration = a = b = c = p = q = r = 0.0
                self._restart()
                continue
            duration += dt
            a, b, c = a + x * dt, b + y * dt, c + z * dt
            p, q, r = p + ax * dt, q + ay * dt, r + az * dt
            if duration < INTERVAL:
                continue
            a, b, c = a - bx * duration, b - by * duration, c - bz * duration
            k = 1.0 / (duration * FORCE)
            turn, force = (int(a / TURN), int(b / TURN), int(c / TURN)), (int(k * p), int(k * q), int(k * r))
            self.intervals.append((int(duration / TICK), *turn, *force))
            self.rates = (*self.rates[-2 * HALF_WINDOW :], sqrt(a * a + b * b + c * c) / duration)
            duration = a = b = c = p = q = r = 0.0
            stride = self._add_instant(len(self.intervals) - 1 - HALF_WINDOW)
            if stride is not None:
                found.append((t, stride))
        self.t, self.duration, self.turn, self.force = t_last, duration, (a, b, c), (p, q, r)
        return found

    def _restart(self) -> None:
        self.intervals, self.rates = [], ()
        self.start = self.best = self.latest = None

    def _add_instant(self, i: int) -> ClosedStride | None:
        """Use the motion at interval number `i`, which has `HALF_WINDOW` intervals after it."""
        if i < HALF_WINDOW:
            return None
        motion = self._motion(i)
        stride, ticks = None, self.intervals[i][0]
        self.since_best += ticks
        self.since_latest += ticks
        if motion > SWING_MOTION:
            if self.best is not None and self.latest is not None:
                stride = self._close(self.best)
                self._forget_before(self.latest)
            self.best = self.latest = None
        elif motion < STANCE_MOTION:
            stride = self._add_still(i, motion)
        if len(self.intervals) > MOST_INTERVALS:
            self._restart()
        return stride

    def _add_still(self, i: int, motion: float) -> ClosedStride | None:
        """Use an instant of a stance; the stride before it is finished once a stiller instant is not expected."""
        stride = None
        if self.best is None or self.latest is None:
            self.best = self.latest = i
            self.since_best = self.since_latest = 0
            self.best_motion = self.latest_motion = motion
            return None
        if self.since_best >= BEST_WITHIN and self.start is not None:
            stride = self._close(self.best)
        elif motion < self.best_motion:
            self.best, self.best_motion, self.since_best = i, motion, 0
        if motion < self.latest_motion or self.since_latest >= BEST_WITHIN:
            self.latest, self.latest_motion, self.since_latest = i, motion, 0
            if self.start is None:
                self.best, self.since_best = i, 0
                self._forget_before(self.latest, opens_stride=False)
        return stride

    def _motion(self, i: int) -> float:
        """Return the mean rate around interval `i`, plus the weighted standard deviation of the specific force."""
        a, b, c, d, e = self.rates  # 2 HALF_WINDOW + 1 of them
        rate = 0.2 * (a + b + c + d + e)
        if rate > SWING_MOTION:
            return rate
        around = self.intervals[i - HALF_WINDOW : i + HALF_WINDOW + 1]
        (_, _, _, _, ax, ay, az), (_, _, _, _, bx, by, bz) = around[:2]
        (_, _, _, _, cx, cy, cz), (_, _, _, _, dx, dy, dz), (_, _, _, _, ex, ey, ez) = around[2:]
        x, y, z = ax + bx + cx + dx + ex, ay + by + cy + dy + ey, az + bz + cz + dz + ez
        squares = (
            (ax * ax + bx * bx + cx * cx + dx * dx + ex * ex)
            + (ay * ay + by * by + cy * cy + dy * dy + ey * ey)
            + (az * az + bz * bz + cz * cz + dz * dz + ez * ez)
        )  # in a loop a sample takes 2 us more, until the axes are known
        variance = 5 * squares - (x * x + y * y + z * z)  # 25 times it, exact, because these are whole numbers
        return rate + STEADINESS_WEIGHT * FORCE * 0.2 * sqrt(variance)

    def _time_between(self, first: int, last: int) -> float:
        """Return the time between two instants, s."""
        return TICK * sum(interval[0] for interval in self.intervals[first + 1 : last + 1])  # whole numbers

    def _close(self, end: int) -> ClosedStride | None:
        """Return the stride that ends at interval `end`; after it, none is under way."""
        start, self.start = self.start, None
        if start is None or end <= start:
            return None
        around_start = self.intervals[start - HALF_WINDOW : start + HALF_WINDOW + 1]
        around_end = self.intervals[end - HALF_WINDOW : end + HALF_WINDOW + 1]
        return ClosedStride(
            tuple(self.intervals[start + 1 : end + 1]),
            _mean_acc(around_start),
            _mean_acc(around_end),
            self.best_motion,
            self._time_between(start, end),
        )

    def _forget_before(self, i: int, *, opens_stride: bool = True) -> None:
        """Discard what comes before the instant `i`, where a stride begins if `opens_stride`."""
        dropped = i - HALF_WINDOW
        del self.intervals[:dropped]
        if opens_stride:
            self.start = HALF_WINDOW
        if self.best is not None:
            self.best = max(HALF_WINDOW, self.best - dropped)
        if self.latest is not None:
            self.latest -= dropped


def _mean_acc(intervals: list[Interval]) -> Vec3:
    """Return the mean specific force of some intervals, m/s^2."""
    _, _, _, _, x, y, z = [sum(values) for values in zip(*intervals, strict=True)]  # whole numbers
    k = FORCE / len(intervals)
    return k * x, k * y, k * z
