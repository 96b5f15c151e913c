"""Step segmentation by static zones (Liu et al. 2015, IEEE MASS, section IV.B and figure 7).

A static zone is six consecutive samples at 20 Hz that lie within 0.5 m/s^2 of rest on all axes. Between two of them
lies one step, whose critical times (critical_times.py) are found as soon as the second is. Open in the paper, or
changed because it finds no zone:

- "0, 0, -9.8" is the paper's mounting. Here rest is the mean of the zone's own samples, if its length is about that of
  gravity, so that any mounting will do, and a ramp. An accelerometer whose counts are coarse (0.6 m/s^2 at 8 bits and
  +-8 g) flickers between two of them however still it lies: half a count is added to the 0.5.
- Such an accelerometer has an offset of up to 125 mg and a scale within 3 % (KXTJ9), and the error at rest is the
  offset: it is removed along the axis that is vertical then, where the feet of other recipes take it for scale.
- By time the six samples are five intervals, `length`. At higher rates the paper's sample is the mean over `MEAN_TIME`:
  of the single samples at 128 Hz of a foot on a treadmill every tenth is further off than 0.5 m/s^2 while it stands.
- Figure 7 has a static zone in every step, and many a foot does not lie still for six samples: at a speed above some
  1.3 m/s it is flat for less, and on a hard floor or in a soft shoe it rolls all the time. So a zone is also found
  where samples lie within `loose_within` for `loose_length` while the foot hardly turns (`low_rate`, not in the paper).
- Fast walkers' feet have not even that. When no zone has come for `OVERDUE` less is required (`HURRIED_SHARE`), until
  the foot lies still for a whole `length` again. The first such stride is lost, with the next one in its segment."""

from __future__ import annotations

from math import inf

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import GRAVITY, IDENTITY, ZERO
from .critical_times import Row, critical_times
from .segment import FootAxes, StepSegment, scale_to_offset, to_foot_axes

LONGEST_GAP = 0.25
"""Gap after which the foot may have moved within a zone, s."""
COARSEST_COUNT = 0.7
"""Largest count of an accelerometer, m/s^2: 8 bits for +-8 g are 0.61."""
COARSE_COUNT = 0.1
"""Count above which an accelerometer's error at rest is its offset, not its scale, m/s^2."""
OVERDUE = 1.3
"""Longest stride from rest to rest, s, of all walkers but slow ones, whose feet rest well."""
HURRIED_SHARE = 0.4
"""Share of `loose_length` that is required after `OVERDUE`; `loose_within` grows by the rest."""
GRAVITY_TOLERANCE = 2.0
"""Difference of a zone's mean from 1 g, m/s^2: offset and scale of cheap parts, a lift that starts."""
TIME_TOLERANCE = 1e-3
"""Difference of a fitted clock's times from even ones, s."""
LONGEST_SEGMENT = 4.0
"""Longest segment, s: the oldest rows of a longer one are dropped."""
ROW_SPACING, MEAN_TIME, MOST_ROWS = 0.0149, 0.045, 72
"""Time between two kept rows, s, time of the means that are judged, s, and largest number of rows.

100 Hz give means of two samples, 20 Hz the samples themselves. When there are more rows, the older half of them becomes
twice as coarse."""
ZONE_BEFORE = 0.25
"""Time of the zone before it that belongs to a segment, s."""


@define
class StaticRun:
    """A run of rows, each within a bound of the mean of those before it."""

    since: float | None = None
    """Start of the run, s."""
    count: int = 0
    mean: Vec3 = ZERO
    """Mean specific force of the run, m/s^2."""

    def add(self, t: float, acc: Vec3, most: float) -> None:
        """Add one row; it starts another run where it is not within `most` on every axis."""
        ax, ay, az = acc
        x, y, z = self.mean
        if self.since is not None and abs(ax - x) <= most and abs(ay - y) <= most and abs(az - z) <= most:
            self.count = min(self.count + 1, 64)
            k = 1.0 / self.count
            self.mean = (x + k * (ax - x), y + k * (ay - y), z + k * (az - z))
        else:
            self.since, self.count, self.mean = t, 1, acc

    def duration(self, t: float) -> float:
        """Return the duration of the run, s; 0 with less than three rows, or when its mean is not like gravity."""
        if self.since is None or self.count < 3:
            return 0.0
        x, y, z = self.mean
        return t - self.since if abs((x * x + y * y + z * z) ** 0.5 - GRAVITY) < GRAVITY_TOLERANCE else 0.0


@frozen
class StaticZonesSettings:
    """Settings of `StaticZones`."""

    within: float = 0.5
    """Largest difference of the samples of a zone on any axis, m/s^2."""
    length: float = 0.25
    """Shortest duration of a zone, s."""
    loose_within: float = 1.0
    """Largest difference of the samples of a zone in which the foot hardly turns (`low_rate`), m/s^2."""
    loose_length: float = 0.075
    """Shortest duration of a zone in which the foot hardly turns, s."""
    low_rate: float = 1.4
    """Rate on every axis below which a foot hardly turns, rad/s. A foot that rolls on without a rest is not below it
    for 0.1 s, nor is any swing."""
    sigma: float = 0.01
    """Noise of the zero velocity in a zone, m/s."""


@define
class StaticZones(Detector):
    """Detector: zero velocity in static zones, no evidence outside.

    The first sample of a zone brings the segment that it ends, a `StepSegment` in `Stance.detail`. Latency:
    `loose_length` after the foot lies still and `MEAN_TIME` more at rates above 20 Hz, or `length` when the gyroscope
    shows more than `low_rate`. At 10 Hz three samples take 0.2 s: the least for a zone."""

    settings: StaticZonesSettings = StaticZonesSettings()
    axes: FootAxes = field(factory=FootAxes)
    last_t: float | None = field(default=None, init=False)
    """Time of the newest sample, s."""
    resolution: float = field(default=0.0, init=False)
    """One count of the accelerometer, m/s^2: the least difference of two readings so far."""
    last_acc: Vec3 = field(default=ZERO, init=False)
    """Specific force of the newest sample, m/s^2."""
    sums: Row = field(default=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), init=False)
    """Sums of the unfinished row; the first is of times since `row_start`."""
    count: int = field(default=0, init=False)
    row_start: float = field(default=0.0, init=False)
    """Start of the unfinished row, s."""
    rows: list[Row] = field(factory=list, init=False)
    """Rows since the last zone, in the sensor frame."""
    longest_gap: float = field(default=0.0, init=False)
    """Longest time between two samples since the last zone, s."""
    strict: StaticRun = field(factory=StaticRun, init=False)
    loose: StaticRun = field(factory=StaticRun, init=False)
    scale: float = field(default=1.0, init=False)
    """Factor by which acc was multiplied so that it reads 1 g at rest."""
    low_rate_since: float | None = field(default=None, init=False)
    """Time since which the foot hardly turns, s."""
    static: bool = field(default=False, init=False)
    """Flag: the foot is in a static zone."""
    zone_start: float | None = field(default=None, init=False)
    """Start of the present or last zone, s."""
    zone_end: float | None = field(default=None, init=False)
    """End of the last zone, s; None in a zone."""
    hurried: bool = field(default=False, init=False)
    """Flag: less is required of a zone."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        gap = ROW_SPACING if self.last_t is None else t - self.last_t
        self.last_t = t
        if gap > self.longest_gap:
            self.longest_gap = gap
        if gap > LONGEST_GAP:
            self.low_rate_since = self.strict.since = self.loose.since = None
            self.count = 0
            if self.static:
                self._end_zone(t)
            self.zone_start = self.zone_end = None
        self._learn_resolution(acc)
        segment = None
        if self._add_to_row(t, gap, acc, gyro):
            self._add_to_runs(self.rows[-1])
            if self.loose.count == 1:
                if self.static:
                    self._end_zone(t)
            elif not self.static and self._is_static():
                self.static = True
                self.zone_start, self.zone_end = t, None
                segment = self._segment()
            if self.static:
                self._drop_old_rows(t)
            elif len(self.rows) >= MOST_ROWS:
                self._thin()
        if self.static:
            return Stance(ZERO, self.settings.sigma, 0.0, Phase.STATIONARY, segment)
        return Stance(ZERO, inf, 1.0, None)

    def scaled(self, scale: float) -> None:
        """Set the factor by which acc is multiplied from now on, so that it reads 1 g at rest."""
        self.scale = scale

    def _learn_resolution(self, acc: Vec3) -> None:
        """Learn the size of one count, from the axes' differences.

        An axis that repeats a value has counts, and the others' differences are multiples of one."""
        ax, ay, az = acc
        x, y, z = self.last_acc
        self.last_acc = acc
        if ax == x != 0.0 or ay == y != 0.0 or az == z != 0.0:
            for step in (abs(ax - x), abs(ay - y), abs(az - z)):
                if step > 0.0 and (step < self.resolution or self.resolution == 0.0):
                    self.resolution = min(step, COARSEST_COUNT)

    def _add_to_row(self, t: float, gap: float, acc: Vec3, gyro: Vec3) -> bool:
        """Add a sample to the unfinished row, and return whether it completes the row."""
        if self.count == 0:
            self.row_start = t
            self.sums = (0.0, *acc, *gyro)
        else:
            (s, ax, ay, az, gx, gy, gz), (x, y, z), (u, v, w) = self.sums, acc, gyro
            self.sums = (s + t - self.row_start, ax + x, ay + y, az + z, gx + u, gy + v, gz + w)
        self.count += 1
        if t - self.row_start + gap < ROW_SPACING:
            return False
        k = 1.0 / self.count
        self.count = 0
        # to a tenth of a thousandth: a row of a snapshot is then half as long
        ax, ay, az, gx, gy, gz = [round(k * value, 4) for value in self.sums[1:]]
        self.rows.append((self.row_start + k * self.sums[0], ax, ay, az, gx, gy, gz))
        return True

    def _add_to_runs(self, row: Row) -> None:
        """Add the mean of the last rows to both runs."""
        settings = self.settings
        t, ax, ay, az, gx, gy, gz = row
        count = 1
        while count < len(self.rows):
            one = self.rows[-1 - count]
            if t - one[0] >= MEAN_TIME - ROW_SPACING:
                break
            ax, ay, az = ax + one[1], ay + one[2], az + one[3]
            count += 1
        k = 1.0 / count
        ax, ay, az = k * ax, k * ay, k * az
        flicker = 0.5 * self.resolution
        self.strict.add(t, (ax, ay, az), settings.within + flicker)
        loose_within = (2.0 - HURRIED_SHARE) * settings.loose_within if self.hurried else settings.loose_within
        self.loose.add(t, (ax, ay, az), loose_within + flicker)
        if max(abs(gx), abs(gy), abs(gz)) > settings.low_rate:
            self.low_rate_since = None
        elif self.low_rate_since is None:
            self.low_rate_since = t

    def _is_static(self) -> bool:
        """Return whether the foot has been still for long enough, with a mean like gravity."""
        t = self.rows[-1][0]
        if self.strict.duration(t) >= self.settings.length - TIME_TOLERANCE:
            return True
        if self.low_rate_since is None:
            return False
        if self.zone_end is not None and t - self.zone_end > OVERDUE:
            self.hurried = True
        loose_length = HURRIED_SHARE * self.settings.loose_length if self.hurried else self.settings.loose_length
        return min(self.loose.duration(t), t - self.low_rate_since) >= loose_length - TIME_TOLERANCE

    def _end_zone(self, t: float) -> None:
        """End the zone."""
        self.static = False
        self.zone_end = t
        if self.zone_start is not None and t - self.zone_start > self.settings.length:
            self.hurried = False

    def _drop_old_rows(self, t: float) -> None:
        """Drop the rows of a zone that the next segment does not start with."""
        rows = self.rows
        oldest = t - ZONE_BEFORE
        if self.loose.since is not None and self.loose.since > oldest:
            oldest = self.loose.since  # earlier rows belong to the last segment
        while rows[0][0] < oldest and len(rows) > 1:
            del rows[0]
        self.longest_gap = 0.0

    def _thin(self) -> None:
        """Make the older half of the rows coarser, or drop the oldest."""
        old, new = self.rows[: MOST_ROWS // 2], self.rows[MOST_ROWS // 2 :]
        if new[-1][0] - old[0][0] > LONGEST_SEGMENT:
            self.rows = old[MOST_ROWS // 4 :] + new
        else:
            self.rows = [_mean(a, b) for a, b in zip(old[::2], old[1::2], strict=False)] + new

    def _segment(self) -> StepSegment | None:
        """Return the segment before the zone that starts."""
        x, y, z = self.loose.mean
        k = 1.0 / (x * x + y * y + z * z) ** 0.5
        up = (x * k, y * k, z * k)
        self.axes.add_segment(self.rows, up)
        axes = self.axes.axes(up)
        if axes is None or len(self.rows) < 3:
            return None
        right, forward = axes
        rows = to_foot_axes(self.rows, right, forward, up)
        if self.resolution >= COARSE_COUNT:
            rows = scale_to_offset(rows, self.scale)
        return StepSegment(rows, critical_times(rows), forward, self.longest_gap)


def _mean(a: Row, b: Row) -> Row:
    t, ax, ay, az, gx, gy, gz = (0.5 * (one + other) for one, other in zip(a, b, strict=True))
    return (t, ax, ay, az, gx, gy, gz)
