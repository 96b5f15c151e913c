"""Detection of strides by static zones (Liu et al. 2015, IEEE MASS, section IV.B and figure 7: step segmentation).

A static zone is six consecutive samples at 20 Hz that lie within 0.5 m/s^2 of rest on all axes. Between two zones lies
one stride. Its critical times (critical_times.py) are computed as soon as the second zone is detected. The following
points are open in the paper, or are changed because the paper's rule would find no zone:

- The paper's rest is "0, 0, -9.8", which fits one mounting. Here rest is the mean of the zone's own samples, if the
  length of that mean is about 1 g. So any mounting will do, and a ramp. An accelerometer with coarse counts (one count
  is 0.6 m/s^2 at 8 bits and +-8 g) flickers between two of them however still it lies, so half a count is added to 0.5.
- Such an accelerometer has an offset of up to 125 mg and a scale within 3 % (KXTJ9), so its error at rest is mostly
  offset. The offset is removed along the axis that is vertical at rest. Other recipes correct the error as a scale.
- Six samples span five intervals: `length`. At higher rates the mean over `MEAN_TIME` takes the place of the paper's
  sample. Of the single samples of a foot that stands on a treadmill, at 128 Hz, a tenth is off by more than 0.5 m/s^2.
- Figure 7 has a static zone in every stride, but many feet do not lie still for six samples. Above some 1.3 m/s a foot
  is flat for less time, and on a hard floor or in a soft shoe it rolls all the time. So a zone is also detected when
  samples lie within `loose_within` for `loose_length` while the foot hardly turns (`low_rate`, not in the paper).
- Feet of fast walkers do not rest even that long. After `LONGEST_WALKING_STRIDE` without a zone less is required
  (`RELAXED_SHARE`), until the foot lies still for a whole `length` again. The first such stride is lost: it and the
  next one form one segment.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import inf

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import IDENTITY, ZERO
from .critical_times import Row, critical_times
from .segment import FootAxes, StrideSegment, scale_to_offset, to_foot_axes
from .static_run import StaticRun

LONGEST_GAP = 0.25
"""Gap in the samples, s, that ends a zone because the foot may have moved in it."""
COARSEST_COUNT = 0.7
"""Largest size of one count of an accelerometer, m/s^2: 8 bits for +-8 g are 0.61."""
COARSE_COUNT = 0.1
"""Size of one count from which on an accelerometer's error at rest is its offset, not its scale, m/s^2."""
LONGEST_WALKING_STRIDE = 1.3
"""Longest stride from rest to rest at a usual or fast speed, s. Slow walkers take longer, but rest long enough."""
RELAXED_SHARE = 0.4
"""Share s of `loose_length` required after `LONGEST_WALKING_STRIDE`; `loose_within` is then multiplied by 2 - s."""
TIME_TOLERANCE = 1e-3
"""Largest deviation of fitted sample times from even spacing, s."""
LONGEST_SEGMENT = 4.0
"""Longest segment, s: the oldest rows of a longer one are dropped."""
ROW_SPACING, MEAN_TIME, MOST_ROWS = 0.0149, 0.045, 72
"""Time between two rows, s; averaging time for the comparison with rest, s; largest number of rows.

A row is the mean of two samples at 100 Hz and a single sample at 20 Hz. When the number of rows is reached, pairs of
the older half are averaged."""
KEPT_ZONE_TIME = 0.25
"""Time at the end of a zone that also belongs to the next segment, s."""


@frozen
class StaticZonesSettings:
    """Settings of `StaticZones`."""

    within: float = 0.5
    """Largest difference of a zone's samples from their mean on any axis, m/s^2."""
    length: float = 0.25
    """Shortest duration of a zone, s."""
    loose_within: float = 1.0
    """Largest difference from the mean in a zone in which the foot hardly turns (`low_rate`), m/s^2."""
    loose_length: float = 0.075
    """Shortest duration of a zone in which the foot hardly turns, s."""
    low_rate: float = 1.4
    """Rate on every axis below which a foot hardly turns, rad/s. Neither a swing nor a foot that rolls on without a
    rest stays below it for 0.1 s."""
    sigma: float = 0.01
    """Noise of the zero velocity in a zone, m/s."""
    has_loose_rule: bool = True
    """Flag: a zone is also detected by `loose_within` and `low_rate`; otherwise by six samples, as in the paper."""
    knows_offset: bool = True
    """Flag: the error at rest of an accelerometer with coarse counts is an offset, not a scale."""


@define
class StaticZones(Detector):
    """Detector: zero velocity in static zones, no evidence outside.

    At the first sample of a zone `Stance.detail` is the `StrideSegment` that has ended. Latency after the foot lies
    still: `loose_length`, or `length` when the gyroscope shows more than `low_rate`; at rates above 20 Hz `MEAN_TIME`
    more. A zone has at least three samples, which take 0.2 s at 10 Hz."""

    settings: StaticZonesSettings = StaticZonesSettings()
    axes: FootAxes = field(factory=FootAxes)
    last_t: float | None = field(default=None, init=False)
    """Time of the newest sample, s."""
    resolution: float = field(default=0.0, init=False)
    """One count of the accelerometer, m/s^2: the least difference of two readings so far; 0 while unknown."""
    last_acc: Vec3 = field(default=ZERO, init=False)
    """Specific force of the newest sample, m/s^2."""
    sums: Row = field(default=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), init=False)
    """Sums of the samples of the unfinished row; the first is of the times since `row_t_start`."""
    count: int = field(default=0, init=False)
    """Number of samples in the unfinished row."""
    row_t_start: float = field(default=0.0, init=False)
    """Start of the unfinished row, s."""
    rows: list[Row] = field(factory=list, init=False)
    """Rows since the last zone, in the sensor frame."""
    longest_gap: float = field(default=0.0, init=False)
    """Longest time between two samples since the last zone, s."""
    strict: StaticRun = field(factory=StaticRun, init=False)
    """Run of rows within `within`."""
    loose: StaticRun = field(factory=StaticRun, init=False)
    """Run of rows within `loose_within`."""
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
    relaxed: bool = field(default=False, init=False)
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
            if self._run().count == 1:
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
        """Learn the size of one count: if one axis repeats a value, the others differ by whole counts."""
        ax, ay, az = acc
        x, y, z = self.last_acc
        self.last_acc = acc
        if ax == x != 0.0 or ay == y != 0.0 or az == z != 0.0:
            for difference in (abs(ax - x), abs(ay - y), abs(az - z)):
                if difference > 0.0 and (difference < self.resolution or self.resolution == 0.0):
                    self.resolution = min(difference, COARSEST_COUNT)

    def _add_to_row(self, t: float, gap: float, acc: Vec3, gyro: Vec3) -> bool:
        if self.count == 0:
            if gap >= ROW_SPACING:
                (ax, ay, az), (gx, gy, gz) = acc, gyro
                self.rows.append(
                    (t, round(ax, 4), round(ay, 4), round(az, 4), round(gx, 4), round(gy, 4), round(gz, 4))
                )
                return True
            self.row_t_start = t
            self.sums = (0.0, *acc, *gyro)
        else:
            (s, ax, ay, az, gx, gy, gz), (x, y, z), (u, v, w) = self.sums, acc, gyro
            self.sums = (s + t - self.row_t_start, ax + x, ay + y, az + z, gx + u, gy + v, gz + w)
        self.count += 1
        if t - self.row_t_start + gap < ROW_SPACING:
            return False
        k = 1.0 / self.count
        self.count = 0
        # four decimals halve the length of a row in a snapshot
        ax, ay, az, gx, gy, gz = [round(k * value, 4) for value in self.sums[1:]]
        self.rows.append((self.row_t_start + k * self.sums[0], ax, ay, az, gx, gy, gz))
        return True

    def _add_to_runs(self, row: Row) -> None:
        """Add the mean of the last rows to both runs."""
        settings = self.settings
        t, ax, ay, az, gx, gy, gz = row
        count = 1
        while count < len(self.rows):
            earlier_row = self.rows[-1 - count]
            if t - earlier_row[0] >= MEAN_TIME - ROW_SPACING:
                break
            ax, ay, az = ax + earlier_row[1], ay + earlier_row[2], az + earlier_row[3]
            count += 1
        k = 1.0 / count
        ax, ay, az = k * ax, k * ay, k * az
        flicker = 0.5 * self.resolution
        self.strict.add(t, (ax, ay, az), settings.within + flicker)
        loose_within = (2.0 - RELAXED_SHARE) * settings.loose_within if self.relaxed else settings.loose_within
        self.loose.add(t, (ax, ay, az), loose_within + flicker)
        if max(abs(gx), abs(gy), abs(gz)) > settings.low_rate:
            self.low_rate_since = None
        elif self.low_rate_since is None:
            self.low_rate_since = t

    def _run(self) -> StaticRun:
        """Return the run whose end ends a zone."""
        return self.loose if self.settings.has_loose_rule else self.strict

    def _is_static(self) -> bool:
        t = self.rows[-1][0]
        if self.strict.duration(t) >= self.settings.length - TIME_TOLERANCE:
            return True
        if self.low_rate_since is None or not self.settings.has_loose_rule:
            return False
        if self.zone_end is not None and t - self.zone_end > LONGEST_WALKING_STRIDE:
            self.relaxed = True
        loose_length = RELAXED_SHARE * self.settings.loose_length if self.relaxed else self.settings.loose_length
        return min(self.loose.duration(t), t - self.low_rate_since) >= loose_length - TIME_TOLERANCE

    def _end_zone(self, t: float) -> None:
        self.static = False
        self.zone_end = t
        if self.zone_start is not None and t - self.zone_start > self.settings.length:
            self.relaxed = False

    def _drop_old_rows(self, t: float) -> None:
        """Drop the rows of a zone that the next segment does not start with."""
        rows = self.rows
        oldest = t - KEPT_ZONE_TIME
        since = self._run().since
        if since is not None and since > oldest:
            oldest = since  # earlier rows belong to the previous segment
        while rows[0][0] < oldest and len(rows) > 1:
            del rows[0]
        self.longest_gap = 0.0

    def _thin(self) -> None:
        """Average pairs of rows of the older half, or drop the oldest rows of a segment that is too long."""
        old, new = self.rows[: MOST_ROWS // 2], self.rows[MOST_ROWS // 2 :]
        if new[-1][0] - old[0][0] > LONGEST_SEGMENT:
            self.rows = old[MOST_ROWS // 4 :] + new
        else:
            self.rows = [_mean(a, b) for a, b in zip(old[::2], old[1::2], strict=False)] + new

    def _segment(self) -> StrideSegment | None:
        """Return the segment that ends with the zone that starts now; None while the foot's axes are unknown."""
        x, y, z = self._run().mean
        k = 1.0 / (x * x + y * y + z * z) ** 0.5
        up = (x * k, y * k, z * k)
        self.axes.add_segment(self.rows, up)
        axes = self.axes.axes(up)
        if axes is None or len(self.rows) < 3:
            return None
        right, forward = axes
        rows = to_foot_axes(self.rows, right, forward, up)
        if self.settings.knows_offset and self.resolution >= COARSE_COUNT:
            rows = scale_to_offset(rows, self.scale)
        return StrideSegment(rows, critical_times(rows), forward, self.longest_gap)


def _mean(a: Row, b: Row) -> Row:
    t, ax, ay, az, gx, gy, gz = (0.5 * (x + y) for x, y in zip(a, b, strict=True))
    return (t, ax, ay, az, gx, gy, gz)
