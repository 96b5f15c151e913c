"""Strides from the raw samples of one foot, for checks that must work when the tracker of the foot cannot.

The samples are summed to intervals of about 20 ms. A stance is found by the size of the angular rate and by the
steadiness of the specific force, which do not depend on the mounting, on mirrored axes, or on gravity."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import takewhile
from math import hypot, inf, sqrt
from typing import Final, NamedTuple

from ...events import Defect, DefectFound
from ...foot.stride import RESTING_RATE, RESTING_SHARE
from ...types import SITE_OF_FOOT, Floats, Foot, Vec3
from ...types.attrs import define, field
from ...types.vector import scaled

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
LONGEST_TIME = 2.5
"""Longest time of a stride of which the rest is a share, s; what is longer contains standing."""
LONGEST_SAMPLE = 0.15
"""Longest time between two samples that is integrated over, s; a stride with a longer one is discarded."""
HALF_WINDOW = 2
"""Number of intervals before and after an instant over which its motion is averaged: 0.1 s in all."""
WINDOW = 2 * HALF_WINDOW + 1
"""Number of all these intervals."""
STEADINESS_WEIGHT = 0.2
"""Motion for each unit of standard deviation of the specific force, (rad/s)/(m/s^2)."""
FORCE_WEIGHT = 0.5
"""Motion for each unit by which the size of the specific force differs from that of a still foot, (rad/s)/(m/s^2).

A foot in the middle of a slow swing, or of a jump, turns as little as one that stands, but has another force."""
SWING_SHARE, STANCE_SHARE = 0.35, 0.5
"""Angular rate above which a foot swings, as a part of the largest one of its recent swings, and motion below which it
stands, as a part of that.

Strides are the same in number, to 3 in 100, with (0.3, 0.5), (0.4, 0.5) and a weight of the force of 0.4 to 0.7."""
LEAST_SWING, MOST_SWING = 0.6, 2.0
"""Limits of the angular rate above which a foot swings, rad/s: of the slowest walkers, and of all who walk faster."""
MEMORY = 8.0
"""Time constant with which the largest angular rate and the force of a still foot are forgotten, s: some strides."""
STILLNESS = 0.1
"""Motion of a foot that is as still as a sensor can show, rad/s."""
TICK, TURN, FORCE = 2.0**-20, 2.0**-16, 2.0**-10
"""Units of an interval's duration, s, its turn, rad, and its specific force, m/s^2."""
MOST_PAUSE = 2.0
"""Longest time since the stride before, as a multiple of the duration: patients stand for 1.5 of it (felius)."""
LEAST_PEAK, LEAST_STRIKE, LEAST_REST = 1.5, 3.0, 0.12
"""Least peak of the angular rate, rad/s, range of the specific force, m/s^2, and share of the time at rest at both
ends, of the strides of a foot that carries its walker.

Peaks are those of the slowest walkers. Nine in ten strides of slow walkers have a range of 3.5 m/s^2, and nine in ten
of every data set of walks rest for 0.14 and more; legs that dangle for 0.03 to 0.1."""
HARD_STRIKE = 15.0
"""Range of the specific force, m/s^2, from which on a foot was struck, however slowly it seems to have swung: the range
of the gyroscope may be declared too small. Half of the strides at usual speed have more (15 to 36 in seven data sets),
and none that swings slowly in hugadb_daily and sevivi_hops."""
BEST_WITHIN = int(0.4 / TICK)
"""Time after the first and before the last instant of a stance in which its stillest one is searched, `TICK`."""
MOST_INTERVALS = 360
"""Largest number of intervals of a stride, 6.7 s; the start of a longer one is forgotten."""

Interval = tuple[int, int, int, int, int, int, int]
"""Duration, integral of the angular rate and mean specific force, sensor frame, as whole numbers: they are short in a
saved state. The units are `TICK`, `TURN` and `FORCE`."""
NO_MOTION: Final[Interval] = (0, 0, 0, 0, 0, 0, 0)
"""An interval of no duration."""

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
    pause: float
    """Time since the end of the stride before, s; infinite if none ended in the same stance."""

    @property
    def in_a_row(self) -> bool:
        """Return whether it follows a stride as in a walk, of any pace: the foot stood no longer than it swung."""
        return self.pause < self.duration

    @property
    def walked(self) -> bool:
        """Return whether the foot swung, was struck and rested as one that carries its walker, at any mounting.

        Legs that dangle hardly rest, feet that tap or steer hardly swing, and a sensor on the trunk does neither."""
        rates = [(x * x + y * y + z * z) * (TURN / (TICK * ticks)) ** 2 for ticks, x, y, z, *_ in self.intervals]
        forces = [FORCE * hypot(*force) for _, _, _, _, *force in self.intervals]
        fastest = max(rates)
        strike = max(forces) - min(forces)
        is_still = [rate < RESTING_RATE or rate < RESTING_SHARE * fastest for rate in rates]
        ends = [*takewhile(bool, is_still), *takewhile(bool, reversed(is_still))]
        return (
            self.pause < MOST_PAUSE * self.duration
            and (fastest > LEAST_PEAK * LEAST_PEAK or strike > HARD_STRIKE)
            and strike > LEAST_STRIKE
            and len(ends) * self.duration > LEAST_REST * len(is_still) * min(self.duration, LONGEST_TIME)
        )


@define
class Instant:
    """The stillest instant of a part of a stance."""

    i: int
    """Index of its interval."""
    motion: float
    """Motion, rad/s."""
    since: int = 0
    """Time since it, in units of `TICK`."""


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
    rates: Floats = ()
    """Mean angular rates of the newest intervals, rad/s: at most `WINDOW` of them."""
    peak: float = 0.0
    """Largest angular rate of the recent swings, rad/s."""
    weight: float = 0.0
    """Size of the specific force of the still foot, m/s^2: that of the stillest of the recent intervals."""
    counted: float = 0.0
    """Sum of the weights of that mean, s/(rad/s)^2."""
    sums: tuple[int, int, int, int] = (0, 0, 0, 0)
    """Sums of the specific forces of these intervals, `FORCE`, and of their squares."""
    start: int | None = None
    """Index of the instant at which the stride under way began; None when it is unknown."""
    since_end: int | None = None
    """Time since the end of the newest stride, in units of `TICK`; None when there was none in the same stance."""
    pause: int | None = None
    """Time between the stride before and the one under way, in units of `TICK`; None when there was none."""
    best: Instant | None = None
    """Stillest instant at the beginning of the current stance; None in a swing."""
    latest: Instant | None = None
    """Stillest recent instant of the current stance, where the next stride begins; None in a swing."""

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
            self._add_interval((int(duration / TICK), *turn, *force), sqrt(a * a + b * b + c * c) / duration)
            duration = a = b = c = p = q = r = 0.0
            stride = self._add_instant(len(self.intervals) - 1 - HALF_WINDOW)
            if stride is not None:
                found.append((t, stride))
        self.t, self.duration, self.turn, self.force = t_last, duration, (a, b, c), (p, q, r)
        return found

    def _add_interval(self, interval: Interval, rate: float) -> None:
        """Add an interval with its mean angular rate, rad/s."""
        self.intervals.append(interval)
        self.rates = (*self.rates[1 - WINDOW :], rate)
        x, y, z, squares = self.sums
        _, _, _, _, a, b, c = interval
        _, _, _, _, p, q, r = self.intervals[-1 - WINDOW] if len(self.intervals) > WINDOW else NO_MOTION
        squares += a * a + b * b + c * c - p * p - q * q - r * r
        self.sums = x + a - p, y + b - q, z + c - r, squares

    def _restart(self) -> None:
        self.intervals, self.rates, self.sums = [], (), (0, 0, 0, 0)
        self.start = self.best = self.latest = self.since_end = self.pause = None

    def _add_instant(self, i: int) -> ClosedStride | None:
        """Use the motion at interval number `i`, which has `HALF_WINDOW` intervals after it."""
        if i < HALF_WINDOW:
            return None
        ticks = self.intervals[i][0]
        rate, motion = self._motion(TICK * ticks)
        swing = min(max(SWING_SHARE * self.peak, LEAST_SWING), MOST_SWING)
        stance = STANCE_SHARE * swing
        if motion > stance:  # a peak fades while the foot moves, however long the wearer stands
            self.peak *= 1.0 - TICK * ticks / MEMORY
        self.peak = max(self.peak, rate)
        if self.since_end is not None:
            self.since_end += ticks
        stride, best, latest = None, self.best, self.latest
        if best is None or latest is None:
            if motion < stance:
                self.best, self.latest = Instant(i, motion), Instant(i, motion)
        else:
            best.since += ticks
            latest.since += ticks
            if rate > swing:
                stride = self._close(best)
                self.pause = None if self.since_end is None else self.since_end - latest.since
                del self.intervals[: latest.i - HALF_WINDOW]
                self.start, self.best, self.latest = HALF_WINDOW, None, None
            elif motion < stance:
                stride = self._add_still(best, latest, i, motion)
        if len(self.intervals) > MOST_INTERVALS:
            self._restart()
        return stride

    def _add_still(self, best: Instant, latest: Instant, i: int, motion: float) -> ClosedStride | None:
        """Use an instant of a stance; the stride before it is finished once a stiller instant is not expected."""
        stride = None
        if best.since >= BEST_WITHIN and self.start is not None:
            stride = self._close(best)
        elif motion < best.motion:
            self.best = Instant(i, motion)
        if motion < latest.motion or latest.since >= BEST_WITHIN:
            self.latest = Instant(i, motion)
            if self.start is None:
                del self.intervals[: i - HALF_WINDOW]
                self.best, self.latest = Instant(HALF_WINDOW, motion), Instant(HALF_WINDOW, motion)
        return stride

    def _motion(self, duration: float) -> tuple[float, float]:
        """Return the mean angular rate over the newest intervals, and the motion, rad/s.

        The newest of them has a `duration`, s."""
        a, b, c, d, e = self.rates  # `WINDOW` of them
        rate = 0.2 * (a + b + c + d + e)
        if rate > MOST_SWING:
            return rate, rate
        x, y, z, squares = self.sums
        square = x * x + y * y + z * z
        variance = WINDOW * squares - square  # times the square of their number, exact
        force, motion = FORCE / WINDOW * sqrt(square), rate + STEADINESS_WEIGHT * FORCE / WINDOW * sqrt(variance)
        share = duration / (STILLNESS + motion) ** 2
        self.counted = self.counted * (1.0 - duration / MEMORY) + share
        self.weight += share / self.counted * (force - self.weight)
        return rate, motion + FORCE_WEIGHT * abs(force - self.weight)

    def _around(self, i: int) -> list[Interval]:
        """Return the intervals around an instant."""
        return self.intervals[i - HALF_WINDOW : i + HALF_WINDOW + 1]

    def _close(self, end: Instant) -> ClosedStride | None:
        """Return the stride that ends at an instant; after it, none is under way."""
        start, self.start = self.start, None
        if start is None or end.i <= start:
            return None
        intervals = tuple(self.intervals[start + 1 : end.i + 1])
        first, last = _mean_acc(self._around(start)), _mean_acc(self._around(end.i))
        duration = TICK * sum([interval[0] for interval in intervals])  # whole numbers
        pause = inf if self.pause is None else TICK * self.pause
        self.since_end = end.since
        return ClosedStride(intervals, first, last, end.motion, duration, pause)


def _mean_acc(intervals: list[Interval]) -> Vec3:
    """Return the mean specific force of some intervals, m/s^2."""
    _, _, _, _, x, y, z = [sum(values) for values in zip(*intervals, strict=True)]  # whole numbers
    return scaled((x, y, z), FORCE / len(intervals))
