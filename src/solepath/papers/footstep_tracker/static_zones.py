"""Detection of strides by static zones (Liu et al. 2015, IEEE MASS, section IV.B and figure 7: step segmentation).

A static zone is six consecutive samples at 20 Hz that lie within 0.5 m/s^2 of rest on all axes. Between two zones lies
one stride. Its critical times (critical_times.py) are computed as soon as the second zone is detected. `PRINTED_ZONES`
has that rule. The following points are open in the paper, or are changed because the rule would find no zone:

- The paper's rest is "0, 0, -9.8", which fits one mounting. Here rest is the mean of the zone's own samples, if the
  length of that mean is about 1 g. So any mounting will do, and a ramp. An accelerometer with coarse counts (one count
  is 0.6 m/s^2 at 8 bits and +-8 g) flickers between two of them however still it lies, so half a count is added to 0.5.
- Six samples span five intervals: `length`. At higher rates the mean over `MEAN_TIME` takes the place of the paper's
  sample. Of the single samples of a foot that stands on a treadmill, at 128 Hz, a tenth is off by more than 0.5 m/s^2.
- Figure 7 has a static zone in every stride, but many feet do not lie still for six samples. Above some 1.3 m/s a foot
  is flat for less time, and on a hard floor or in a soft shoe it rolls all the time. So ours takes three samples within
  1 m/s^2 while the foot hardly turns (`low_rate`, not in the paper). With it all 343 strides of `openshoe_loops` are
  found, with the printed rule 160; emulated tags find 99.4 % of their strides with either.
- Feet of fast walkers do not rest even that long. After `LONGEST_WALKING_STRIDE` without a zone ours requires less
  (`relaxed_share`), until the foot lies still for a whole `WHOLE_ZONE` again. The first such stride is lost: it and the
  next one form one segment. The legs of `ipol_10m_uturn` err by 6.3 % (mean), without this rule by 7.0 %, and by as
  much if so little is always enough, when `gaitmap_examples` loses its strides.
- Such an accelerometer has an offset of up to 125 mg and a scale within 3 % (KXTJ9), so its error at rest is mostly
  offset. Ours removes an offset along the axis that is vertical at rest (`knows_offset`). Other recipes correct the
  error as a scale.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import fsum, hypot, inf

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen, state, stateful
from ...types.vector import GRAVITY, IDENTITY, ZERO, add, sub
from .critical_times import Row, critical_times
from .segment import FootAxes, StrideSegment, scale_to_offset, to_foot_axes

SIGMA = 0.01
"""Noise of the zero velocity in a zone, m/s."""
LONGEST_GAP = 0.25
"""Gap in the samples, s, that ends a zone because the foot may have moved in it."""
COARSEST_COUNT = 0.7
"""Largest size of one count of an accelerometer, m/s^2: 8 bits for +-8 g are 0.61."""
COARSE_COUNT = 0.1
"""Size of one count from which on an accelerometer's error at rest is its offset, not its scale, m/s^2."""
LONGEST_WALKING_STRIDE, WHOLE_ZONE = 1.3, 0.25
"""Longest stride from rest to rest at a usual or fast speed, s; slow walkers take longer, but rest long enough. And the
duration of a zone after which no less is required, s."""
TIME_TOLERANCE = 1e-3
"""Largest deviation of fitted sample times from even spacing, s."""
GRAVITY_TOLERANCE = 2.0
"""Largest difference of a zone's mean from 1 g, m/s^2: cheap chips err, and an elevator may start."""
MOST_AVERAGED = 64
"""Number of rows of a run from which on its mean is a moving one, in which each row has weight 1/64."""
LONGEST_SEGMENT = 4.0
"""Longest segment, s: the oldest rows of a longer one are dropped."""
ROW_SPACING, MEAN_TIME, MEAN_ROWS = 0.0149, 0.045, 4
"""Time between two rows, s; averaging time for the comparison with rest, s, and largest number of rows in it.

A row is the mean of two samples at 100 Hz and a single sample at 20 Hz."""
KEPT_ZONE_TIME = 0.25
"""Time at the end of a zone that also belongs to the next segment, s."""


@frozen
class StaticZonesSettings:
    """Settings of `StaticZones`."""

    within: float = 1.0
    """Largest difference of a zone's samples from their mean on any axis, m/s^2."""
    length: float = 0.075
    """Shortest duration of a zone, s."""
    low_rate: float = 1.4
    """Largest rate on any axis in a zone, rad/s. Neither a swing nor a foot that rolls on without a rest stays below it
    for 0.1 s."""
    relaxed_share: float = 0.4
    """Share s of `length` required after `LONGEST_WALKING_STRIDE`; `within` is then multiplied by 2 - s."""
    knows_offset: bool = True
    """Flag: the error at rest of an accelerometer with coarse counts is an offset, not a scale."""


PRINTED_ZONES = StaticZonesSettings(within=0.5, length=0.25, low_rate=100.0, relaxed_share=1.0, knows_offset=False)
"""Six samples at 20 Hz, as printed, whatever the gyroscope shows: no foot turns at 100 rad/s."""


@define
class StaticRun:
    """Consecutive rows, each of which is near the mean of the earlier ones."""

    since: float | None = None
    """Start of the run, s."""
    count: int = 0
    """Number of rows, at most `MOST_AVERAGED`."""
    mean: Vec3 = ZERO
    """Mean specific force of the run, m/s^2."""

    def add(self, t: float, acc: Vec3, within: float) -> None:
        """Add one row with specific force `acc`; it starts another run unless all axes are near the mean, m/s^2."""
        off = sub(acc, self.mean)
        if self.since is None or max(map(abs, off)) > within:
            self.since, self.count, self.mean = t, 1, acc
            return
        self.count = min(self.count + 1, MOST_AVERAGED)
        self.mean = add(self.mean, off, 1.0 / self.count)

    def duration(self, t: float) -> float:
        """Return the duration of the run up to `t`, s; 0 with less than three rows or a mean far from 1 g."""
        if self.since is None or self.count < 3:
            return 0.0
        return t - self.since if abs(hypot(*self.mean) - GRAVITY) < GRAVITY_TOLERANCE else 0.0


@stateful
class StaticZones(Detector):
    """Detector: zero velocity in static zones, no evidence outside.

    At the first sample of a zone `Stance.detail` is the `StrideSegment` that has ended. Latency after the foot lies
    still: `length`; at rates above 20 Hz `MEAN_TIME` more. A zone has at least three samples, which take 0.2 s at
    10 Hz."""

    settings: StaticZonesSettings = field(default=StaticZonesSettings())
    axes: FootAxes = state(factory=FootAxes)
    last_t: float | None = None
    """Time of the newest sample, s."""
    resolution: float = 0.0
    """One count of the accelerometer, m/s^2: the least difference of two readings so far; 0 while unknown."""
    last_acc: Vec3 = ZERO
    """Specific force of the newest sample, m/s^2."""
    sums: Row = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    """Sums of the samples of the unfinished row; the first is of the times since `row_t_start`."""
    count: int = 0
    """Number of samples in the unfinished row."""
    row_t_start: float = 0.0
    """Start of the unfinished row, s."""
    rows: list[Row] = state(factory=list)
    """Rows since the last zone, in the sensor frame."""
    longest_gap: float = 0.0
    """Longest time between two samples since the last zone, s."""
    run: StaticRun = state(factory=StaticRun)
    """Run of rows within `within`."""
    scale: float = 1.0
    """Factor by which acc was multiplied so that it reads 1 g at rest."""
    low_rate_since: float | None = None
    """Time since which the foot hardly turns, s."""
    static: bool = False
    """Flag: the foot is in a static zone."""
    zone_start: float | None = None
    """Start of the present or last zone, s."""
    zone_end: float | None = None
    """End of the last zone, s; None in a zone."""
    share: float = 1.0
    """Share of `length` that is required of a zone now."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        gap = ROW_SPACING if self.last_t is None else t - self.last_t
        self.last_t = t
        self.longest_gap = max(self.longest_gap, gap)
        if gap > LONGEST_GAP:
            self.low_rate_since = self.run.since = None
            self.count = 0
            self.static = False
            self.zone_start = self.zone_end = None
        self._learn_resolution(acc)
        segment = None
        if self._add_to_row(t, gap, acc, gyro):
            self._add_to_run()
            if self.run.count == 1:
                if self.static:
                    self._end_zone(t)
            elif not self.static and self._is_static():
                self.static, self.zone_start, self.zone_end = True, t, None
                segment = self._segment()
            self._drop_old_rows(t)
        if self.static:
            return Stance(ZERO, SIGMA, 0.0, Phase.STATIONARY, segment)
        return Stance(ZERO, inf, 1.0, None)

    def scaled(self, scale: float) -> None:
        """Set the factor by which acc is multiplied from now on, so that it reads 1 g at rest."""
        self.scale = scale

    def _learn_resolution(self, acc: Vec3) -> None:
        """Learn the size of one count: if one axis repeats a value, the others differ by whole counts."""
        pairs = list(zip(acc, self.last_acc, strict=True))
        self.last_acc = acc
        if any([now == before != 0.0 for now, before in pairs]):
            counts = [abs(now - before) for now, before in pairs if now != before]
            self.resolution = min([self.resolution or COARSEST_COUNT, *counts]) if counts else self.resolution

    def _add_to_row(self, t: float, gap: float, acc: Vec3, gyro: Vec3) -> bool:
        """Add a sample to the unfinished row; return whether that ends it."""
        if self.count == 0:
            self.row_t_start, self.sums = t, (0.0, *acc, *gyro)
        else:
            sums = self.sums
            self.sums = (sums[0] + t - self.row_t_start, *add(sums[1:4], acc), *add(sums[4:], gyro))
        self.count += 1
        if t - self.row_t_start + gap < ROW_SPACING:
            return False
        k = 1.0 / self.count
        self.count = 0
        # four decimals halve the length of a row in a snapshot
        ax, ay, az, gx, gy, gz = [round(k * value, 4) for value in self.sums[1:]]
        self.rows.append((self.row_t_start + k * self.sums[0], ax, ay, az, gx, gy, gz))
        return True

    def _add_to_run(self) -> None:
        """Add the mean of the last rows to the run."""
        t = self.rows[-1][0]
        newest = [row for row in self.rows[-MEAN_ROWS:] if t - row[0] < MEAN_TIME - ROW_SPACING]
        k = 1.0 / len(newest)
        x, y, z = (k * fsum([row[axis] for row in newest]) for axis in (1, 2, 3))
        self.run.add(t, (x, y, z), (2.0 - self.share) * self.settings.within + 0.5 * self.resolution)
        if max(map(abs, self.rows[-1][4:])) > self.settings.low_rate:
            self.low_rate_since = None
        elif self.low_rate_since is None:
            self.low_rate_since = t

    def _is_static(self) -> bool:
        t = self.rows[-1][0]
        if self.low_rate_since is None:
            return False
        if self.zone_end is not None and t - self.zone_end > LONGEST_WALKING_STRIDE:
            self.share = self.settings.relaxed_share
        least = self.share * self.settings.length - TIME_TOLERANCE
        return min(self.run.duration(t), t - self.low_rate_since) >= least

    def _end_zone(self, t: float) -> None:
        self.static, self.zone_end = False, t
        if self.zone_start is not None and t - self.zone_start > WHOLE_ZONE:
            self.share = 1.0

    def _drop_old_rows(self, t: float) -> None:
        """Drop the rows of a zone that the next segment does not start with, and those of too long a segment."""
        oldest = t - LONGEST_SEGMENT
        if self.static and self.run.since is not None:
            self.longest_gap = 0.0
            oldest = max(t - KEPT_ZONE_TIME, self.run.since)  # rows before the zone belong to the previous segment
        while self.rows[0][0] < oldest and len(self.rows) > 1:
            del self.rows[0]

    def _segment(self) -> StrideSegment | None:
        """Return the segment that ends with the zone that starts now; None while the foot's axes are unknown."""
        up = add(ZERO, self.run.mean, 1.0 / hypot(*self.run.mean))
        self.axes.add_segment(self.rows, up)
        axes = self.axes.axes(up)
        if axes is None or len(self.rows) < 3:
            return None
        right, forward = axes
        rows = to_foot_axes(self.rows, right, forward, up)
        if self.settings.knows_offset and self.resolution >= COARSE_COUNT:
            rows = scale_to_offset(rows, self.scale)
        return StrideSegment(rows, critical_times(rows), forward, self.longest_gap)
