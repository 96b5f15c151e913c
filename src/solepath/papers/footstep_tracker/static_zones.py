"""Step segmentation by static zones (Liu et al. 2015, IEEE MASS, section IV.B and figure 7).

A static zone is six consecutive samples at 20 Hz that lie within 0.5 m/s^2 of rest on all axes. Between two of them
lies one step, whose critical times (critical_times.py) are found as soon as the second is. What the letter of this
does not settle, or where it finds nothing:

- "0, 0, -9.8" is the paper's mounting. Here rest is the mean of the zone's own samples, which feels like gravity, so
  that any mounting will do, and a ramp. An accelerometer whose counts are coarse (0.6 m/s^2 at 8 bits and +-8 g)
  flickers between two of them however still it lies: half a count is added to the 0.5.
- Such an accelerometer has an offset of up to 125 mg and a scale within 3 % (KXTJ9), and it is the offset that is seen
  at rest: it is taken off, along the axis that is vertical then, where the feet of other recipes take it for scale.
- By time the six samples are five intervals, `length`. At higher rates the paper's sample is the mean over `SMOOTH`:
  of the single samples at 128 Hz of a foot on a treadmill every tenth is further off than 0.5 m/s^2 while it stands.
- Figure 7 has a static zone in every step, and many a foot does not lie still for six samples: at a speed above some
  1.3 m/s it is flat for less, and on a hard floor or in a soft shoe it rolls on all the time. So a zone is also found
  where samples lie within `loosely` for `brief` while the foot hardly turns (`calm`, which the paper does not ask).
- Fast walkers' feet do not even do that. When no zone has come for `OVERDUE` less is asked for (`HURRIED`), until the
  foot lies still for a whole `length` again. The first such stride is lost, with the next one in its segment.
"""

from __future__ import annotations

from math import inf

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import GRAVITY, IDENTITY, ZERO
from .critical_times import Row, critical_times
from .segment import FootAxes, StepSegment, turned_to, with_offset

ABSENT = 0.25
"""After a gap longer than this nobody knows that the foot lay still all the time, s."""
COARSEST_COUNT = 0.7
"""Of an accelerometer, m/s^2: 8 bits for +-8 g are 0.61."""
COARSE_COUNT = 0.1
"""An accelerometer of larger counts than this reads other than 1 g at rest for its offset, not for its scale, m/s^2."""
OVERDUE = 1.3
"""No walker's stride is longer than this from rest to rest, but slow ones whose feet rest well, s."""
HURRIED = 0.4
"""So much of `brief` has to do then; of `loosely` it may be as much more."""
LIKE_GRAVITY = 2.0
"""What a zone's mean may differ from 1 g by, m/s^2: offset and scale of cheap parts, a lift that starts."""
UNEVEN = 1e-3
"""The times of a fitted clock differ by less than this from even ones, s."""
LONGEST = 4.0
"""Of a segment, s: the oldest rows of a longer one are given up."""
ROW_SPACING, SMOOTH, MOST_ROWS = 0.0149, 0.045, 72
"""Rows that are kept are so far apart, s: 100 Hz give means of two samples, 20 Hz the samples themselves; means over
`SMOOTH`, s, are judged. When there are more rows, the older half of them becomes twice as coarse."""
ZONE_BEFORE = 0.25
"""So much of the zone before it belongs to a segment, s."""


@define
class StaticRun:
    """Rows that lie together, each within a bound of the mean of those before it."""

    since: float | None = None
    """When they began, s."""
    count: int = 0
    mean: Vec3 = ZERO
    """m/s^2."""

    def add(self, t: float, acc: Vec3, most: float) -> None:
        """One more; it begins anew where it is not within `most` on every axis."""
        ax, ay, az = acc
        x, y, z = self.mean
        if self.since is not None and abs(ax - x) <= most and abs(ay - y) <= most and abs(az - z) <= most:
            self.count = min(self.count + 1, 64)
            k = 1.0 / self.count
            self.mean = (x + k * (ax - x), y + k * (ay - y), z + k * (az - z))
        else:
            self.since, self.count, self.mean = t, 1, acc

    def lasted(self, t: float) -> float:
        """For how long, s; 0 with less than three rows, and when it does not feel like gravity."""
        if self.since is None or self.count < 3:
            return 0.0
        x, y, z = self.mean
        return t - self.since if abs((x * x + y * y + z * z) ** 0.5 - GRAVITY) < LIKE_GRAVITY else 0.0


@frozen
class StaticZonesSettings:
    """What `StaticZones` is set to."""

    within: float = 0.5
    """Samples of a zone differ by no more than this on any axis, m/s^2."""
    length: float = 0.25
    """A zone lasts at least so long, s."""
    loosely: float = 1.0
    """As `within`, of a zone in which the foot hardly turns (`calm`), m/s^2."""
    brief: float = 0.075
    """As `length`, of such a zone, s."""
    calm: float = 1.4
    """A foot hardly turns below this rate on every axis, rad/s: one that rolls on without a rest is not below it for
    0.1 s, nor is any swing."""
    sigma: float = 0.01
    """Noise of the zero velocity in a zone, m/s."""


@define
class StaticZones(Detector):
    """Zero velocity in static zones, nothing to say of the rest. The first sample of a zone brings the segment that it
    ends, a `StepSegment` in `Stance.detail`.

    Latency: `brief` after the foot lies still and `SMOOTH` more at rates above 20 Hz, or `length` when the gyroscope is
    not quiet. At 10 Hz three samples take 0.2 s: the least for a zone.
    """

    settings: StaticZonesSettings = StaticZonesSettings()
    axes: FootAxes = field(factory=FootAxes)
    last: float | None = field(default=None, init=False)
    """The newest sample, s."""
    grain: float = field(default=0.0, init=False)
    """One count of the accelerometer, m/s^2: the least by which two readings were seen to differ."""
    raw: Vec3 = field(default=ZERO, init=False)
    """The newest acc, m/s^2."""
    sums: Row = field(default=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), init=False)
    """Of the row under way; the first is of times since `begun`."""
    count: int = field(default=0, init=False)
    begun: float = field(default=0.0, init=False)
    rows: list[Row] = field(factory=list, init=False)
    """Since the last zone, in the sensor frame."""
    longest_gap: float = field(default=0.0, init=False)
    """Between two samples since the last zone, s."""
    strict: StaticRun = field(factory=StaticRun, init=False)
    loose: StaticRun = field(factory=StaticRun, init=False)
    scale: float = field(default=1.0, init=False)
    """What acc was multiplied by so that it reads 1 g at rest."""
    calm_since: float | None = field(default=None, init=False)
    static: bool = field(default=False, init=False)
    stood: float | None = field(default=None, init=False)
    """When the zone began that is, or was last, s."""
    left: float | None = field(default=None, init=False)
    """When it ended, s; None in a zone."""
    hurried: bool = field(default=False, init=False)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        gap = ROW_SPACING if self.last is None else t - self.last
        self.last = t
        if gap > self.longest_gap:
            self.longest_gap = gap
        if gap > ABSENT:
            self.calm_since = self.strict.since = self.loose.since = None
            self.count = 0
            if self.static:
                self._leave(t)
            self.stood = self.left = None
        self._count(acc)
        segment = None
        if self._row(t, gap, acc, gyro):
            self._judge(self.rows[-1])
            if self.loose.count == 1:
                if self.static:
                    self._leave(t)
            elif not self.static and self._lies():
                self.static = True
                self.stood, self.left = t, None
                segment = self._segment()
            if self.static:
                self._forget(t)
            elif len(self.rows) >= MOST_ROWS:
                self._thin()
        if self.static:
            return Stance(ZERO, self.settings.sigma, 0.0, Phase.STATIONARY, segment)
        return Stance(ZERO, inf, 1.0, None)

    def scaled(self, scale: float) -> None:
        """From here on acc is multiplied by `scale`, so that it reads 1 g at rest."""
        self.scale = scale

    def _count(self, acc: Vec3) -> None:
        """Learn what one count is: where an axis repeats itself there are counts, and the others' steps are some."""
        ax, ay, az = acc
        x, y, z = self.raw
        self.raw = acc
        if ax == x != 0.0 or ay == y != 0.0 or az == z != 0.0:
            for step in (abs(ax - x), abs(ay - y), abs(az - z)):
                if step > 0.0 and (step < self.grain or self.grain == 0.0):
                    self.grain = min(step, COARSEST_COUNT)

    def _row(self, t: float, gap: float, acc: Vec3, gyro: Vec3) -> bool:
        """True when the sample completes a row."""
        if self.count == 0:
            self.begun = t
            self.sums = (0.0, *acc, *gyro)
        else:
            (s, ax, ay, az, gx, gy, gz), (x, y, z), (u, v, w) = self.sums, acc, gyro
            self.sums = (s + t - self.begun, ax + x, ay + y, az + z, gx + u, gy + v, gz + w)
        self.count += 1
        if t - self.begun + gap < ROW_SPACING:
            return False
        k = 1.0 / self.count
        self.count = 0
        # to a tenth of a thousandth: a row of a snapshot is then half as long
        ax, ay, az, gx, gy, gz = [round(k * value, 4) for value in self.sums[1:]]
        self.rows.append((self.begun + k * self.sums[0], ax, ay, az, gx, gy, gz))
        return True

    def _judge(self, row: Row) -> None:
        """Whether the foot lies as it did in the rows before."""
        settings = self.settings
        t, ax, ay, az, gx, gy, gz = row
        count = 1
        while count < len(self.rows):
            one = self.rows[-1 - count]
            if t - one[0] >= SMOOTH - ROW_SPACING:
                break
            ax, ay, az = ax + one[1], ay + one[2], az + one[3]
            count += 1
        k = 1.0 / count
        ax, ay, az = k * ax, k * ay, k * az
        flicker = 0.5 * self.grain
        self.strict.add(t, (ax, ay, az), settings.within + flicker)
        loosely = (2.0 - HURRIED) * settings.loosely if self.hurried else settings.loosely
        self.loose.add(t, (ax, ay, az), loosely + flicker)
        if max(abs(gx), abs(gy), abs(gz)) > settings.calm:
            self.calm_since = None
        elif self.calm_since is None:
            self.calm_since = t

    def _lies(self) -> bool:
        """Long enough, and as gravity has it."""
        t = self.rows[-1][0]
        if self.strict.lasted(t) >= self.settings.length - UNEVEN:
            return True
        if self.calm_since is None:
            return False
        if self.left is not None and t - self.left > OVERDUE:
            self.hurried = True
        brief = HURRIED * self.settings.brief if self.hurried else self.settings.brief
        return min(self.loose.lasted(t), t - self.calm_since) >= brief - UNEVEN

    def _leave(self, t: float) -> None:
        """A zone has ended."""
        self.static = False
        self.left = t
        if self.stood is not None and t - self.stood > self.settings.length:
            self.hurried = False

    def _forget(self, t: float) -> None:
        """In a zone no more is kept than what the next segment begins with."""
        rows = self.rows
        oldest = t - ZONE_BEFORE
        if self.loose.since is not None and self.loose.since > oldest:
            oldest = self.loose.since  # what lies before it was the last segment's
        while rows[0][0] < oldest and len(rows) > 1:
            del rows[0]
        self.longest_gap = 0.0

    def _thin(self) -> None:
        old, new = self.rows[: MOST_ROWS // 2], self.rows[MOST_ROWS // 2 :]
        if new[-1][0] - old[0][0] > LONGEST:
            self.rows = old[MOST_ROWS // 4 :] + new
        else:
            self.rows = [_mean(a, b) for a, b in zip(old[::2], old[1::2], strict=False)] + new

    def _segment(self) -> StepSegment | None:
        """A zone begins: what lies before it."""
        x, y, z = self.loose.mean
        k = 1.0 / (x * x + y * y + z * z) ** 0.5
        up = (x * k, y * k, z * k)
        self.axes.learn(self.rows, up)
        axes = self.axes.axes(up)
        if axes is None or len(self.rows) < 3:
            return None
        right, forward = axes
        rows = turned_to(self.rows, right, forward, up)
        if self.grain >= COARSE_COUNT:
            rows = with_offset(rows, self.scale)
        return StepSegment(rows, critical_times(rows), forward, self.longest_gap)


def _mean(a: Row, b: Row) -> Row:
    t, ax, ay, az, gx, gy, gz = (0.5 * (one + other) for one, other in zip(a, b, strict=True))
    return (t, ax, ay, az, gx, gy, gz)
