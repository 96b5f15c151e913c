"""Height of the wearer: the correction that lifts and air pressure add to the heights of the strides.

The tracks of the feet contain the height of stairs and slopes, level by level, but nothing of a lift, in which a foot
stands still. Therefore a correction is added to their height. A Kalman filter estimates it together with the offset of
each foot's barometer (weather, wind, doors, its own offset), from half a second or more of readings at a time:

    height by the air  -  height of the foot's track  =  correction + offset of that barometer + noise

    a stride of height h   the correction's variance grows by the variance of h; a level one changes nothing
    a lift                 the correction jumps by the ride's height, and its variance grows by that height's
    time                   each offset wanders by `OFFSET_DRIFT`^2 a second

On level ground, where no stride gains height, the air pressure cannot move the correction: weather and doors are
offsets. On stairs the strides give the height of each tread and the air the sum; in a lift only the air, where there is
a barometer, gives the height. A ride is reported after it has ended; the readings since it started are then used again
(`KEPT_TIME` s are kept). Later readings still correct its height, for as long as the offsets are known better than
their wander allows."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import log
from typing import ClassVar

from ...events import LiftRidden, StrideTaken
from ...foot.view import FootView
from ...types import Foot, Site
from ...types.attrs import define, evolve, field
from ..part import HeightShift, Part, PartInput, PartOutput, Replacement
from .recent_inputs import HeightInput, RecentInputs

SCALE_HEIGHT = 8578.0
"""Height over which the pressure of air of 20 degrees falls to 1/e, m: R T / (M g)."""
STANDARD_PRESSURE = 101325.0
"""Standard air pressure, Pa."""
READING_INTERVAL = 0.5
"""Shortest interval between readings that are used, s; all readings in between are averaged into one."""
KEPT_TIME = 90.0
"""Time for which inputs are kept, s."""
UNKNOWN_VARIANCE = 1e4
"""Variance of an unknown height, m^2."""
LARGEST_HEIGHT = 1e5
"""Largest height of a track that is used, m."""
LEFT, RIGHT, MOVE = 0, 1, 2
"""Sources of an input: the left barometer, the right one, or a move of the correction."""
RIDE_MARGIN = 0.7
"""Time before the start of a ride and after its end in which the wearer does not stand still, s."""
LEVEL_LIMIT = 0.02
"""Largest height change of a level stride, m."""
MOST_STRIDES = 64
"""Number of newest strides that are kept, to recognise rides that were none."""
SHORTEST_STRIDE = 0.3
"""Length of the shortest stride that is no shift of weight, m."""
OFFSET_DRIFT = 0.03
"""Wander of a barometer's offset, m in one second: 0.35 Pa, indoors. Weather alone makes less than that."""
STRIDE_ERROR, DEGRADED_FACTOR = 0.05, 3.0
"""Error of a stride's height as a share of it, and the factor of that error for a degraded stride.

The error adds to the stride's own variance."""
RIDE_ERROR = 0.1
"""Error of a ride's height as a share of it, without air pressure after its end."""
LOWEST_RIDE, SLOWEST_RIDE, FASTEST_RIDE = 1.8, 0.25, 4.0
"""Least height of a ride that is trusted without air pressure, m, and its least and largest mean speed, m/s."""


@define
class HeightEstimate:
    """The filter's estimate: the correction and two offsets, m, and their covariance, row by row, m^2."""

    values: list[float] = field(factory=lambda: [0.0, 0.0, 0.0])
    """The correction and the offsets of the left and the right barometer, m."""
    covariance: list[float] = field(factory=lambda: [0.0] * 9)
    """Covariance of the three values, row by row, m^2."""
    read_at: list[float | None] = field(factory=lambda: [None, None])
    """Time of the newest reading of each barometer, s; None: never read."""

    def move(self, by: float, variance: float) -> None:
        """Change the correction by `by` m; `variance` is that of the change, m^2."""
        self.values[0] += by
        self.covariance[0] = min(self.covariance[0] + variance, UNKNOWN_VARIANCE)

    def read(self, source: int, t: float, height: float, noise: float, wander: float) -> None:
        """Correct the estimate with a barometer's height above its foot's track, m.

        `noise` is the variance of the reading, m^2, and `wander` the growth of the offset's variance, m^2/s."""
        x, p, i = self.values, self.covariance, 1 + source
        before = self.read_at[source]
        self.read_at[source] = t
        if before is None:
            # nothing is known of its offset: take the one that makes the reading right
            x[i] = height - x[0]
            for j in range(3):
                if j != i:
                    p[3 * i + j] = p[3 * j + i] = -p[j]
            p[4 * i] = p[0] + noise
            return
        p[4 * i] = min(p[4 * i] + wander * max(0.0, t - before), UNKNOWN_VARIANCE)
        off = height - x[0] - x[i]
        spread = p[0] + 2.0 * p[i] + p[4 * i] + noise
        if off * off > 25.0 * spread:  # a door, or another pressure at the same height: the offset has jumped
            p[4 * i] = min(p[4 * i] + off * off, UNKNOWN_VARIANCE)
            spread = p[0] + 2.0 * p[i] + p[4 * i] + noise
        held = [p[3 * j] + p[3 * j + i] for j in range(3)]
        for j in range(3):
            x[j] += held[j] / spread * off
        for j in range(3):
            for k in range(3):
                p[3 * j + k] -= held[j] * held[k] / spread
        for j in range(3):
            p[4 * j] = max(p[4 * j], 0.0)

    def copy(self) -> HeightEstimate:
        """Return a copy."""
        return HeightEstimate(list(self.values), list(self.covariance), list(self.read_at))


@define
class PendingReadings:
    """The readings of one barometer that are not used yet, and the newest that was used."""

    since: float | None = None
    """Time of the newest reading that was used, s."""
    total: float = 0.0
    """Sum of the pending heights, m."""
    count: int = 0
    """Number of pending heights."""
    last: float | None = None
    """Newest height that was used, m."""


@define
class Altitude(Part):
    """Estimates the correction of the wearer's height from air pressure, strides and lift rides.

    Latency: none for the air pressure; a ride is known after it."""

    needs_samples: ClassVar[bool] = True
    idle = True

    now: HeightEstimate = field(factory=HeightEstimate, init=False)
    base: HeightEstimate = field(factory=HeightEstimate, init=False)
    """Estimate before the oldest input that is kept."""
    kept: RecentInputs = field(factory=RecentInputs, init=False)
    """Recent inputs: readings of both barometers and moves of the correction."""
    sides: list[PendingReadings] = field(factory=lambda: [PendingReadings(), PendingReadings()], init=False)
    """Pending readings of the left and the right barometer."""
    noise: float = field(default=0.04, init=False)
    """Variance of a reading that is used, learnt, m^2."""
    ride_variance: float = field(default=0.0, init=False)
    """Variance of the height of all rides together, m^2."""
    strides: deque[tuple[float, float]] = field(factory=deque, init=False)
    """Start and end of the newest strides, in whole hundredths of a second."""

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """Add the reading of a foot's barometer, if the sample has one."""
        pressure = view.sample.air_pressure
        if pressure is None:
            return ()
        t, z = view.t, view.position[2]
        if not (2e4 < pressure < 2e5 and abs(z) < LARGEST_HEIGHT):
            return ()
        source = LEFT if view.foot is Foot.LEFT else RIGHT
        side = self.sides[source]
        side.total += SCALE_HEIGHT * log(STANDARD_PRESSURE / pressure) - z
        side.count += 1
        if side.since is not None and 0.0 <= t - side.since < READING_INTERVAL:
            return ()
        height = side.total / side.count
        if side.last is not None:
            # the variance of consecutive differences is 2 noise + drift^2; a ride or a gust counts little
            square = 0.5 * (height - side.last) ** 2
            self.noise += 0.05 * (min(square, 3.0 * self.noise) - self.noise)
            self.noise = max(self.noise, 1e-4)
        side.since, side.total, side.count, side.last = t, 0.0, 0, height
        return self._add_input((t, source, height, self.noise))

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """Add the variance of a stride to the correction, or replace a ride by one with its likeliest height."""
        if isinstance(event, StrideTaken):
            return self._add_stride(event)
        if isinstance(event, LiftRidden):
            ridden = self._corrected_ride(event)
            return [Replacement(event, ridden), self._height()]
        return ()

    def _height(self) -> HeightShift:
        return HeightShift(self.now.values[0], self.ride_variance)

    def reset(self, site: Site) -> None:
        """Reset the offset of a foot's barometer: its clock restarts, or the foot wears another barometer."""
        if site.foot is None:
            return
        source = LEFT if site.foot is Foot.LEFT else RIGHT
        self.sides[source] = PendingReadings()
        self.now.read_at[source] = None
        self.base = self.now.copy()
        self.kept.clear()
        self.strides.clear()

    def _add_stride(self, stride: StrideTaken) -> Sequence[PartOutput]:
        self.strides.append((float(round(100.0 * stride.t_start)), float(round(100.0 * stride.t_end))))
        if stride.length < SHORTEST_STRIDE:
            self.strides.pop()
        elif len(self.strides) > MOST_STRIDES:
            self.strides.popleft()
        if self.now.read_at[LEFT] is None and self.now.read_at[RIGHT] is None:
            return ()
        height, variance = abs(stride.height_change), stride.covariance[5]
        if not LEVEL_LIMIT < height < LARGEST_HEIGHT or not variance < LARGEST_HEIGHT:
            return ()
        wrong = (STRIDE_ERROR * height) ** 2 + max(0.0, variance)
        if stride.degraded:
            wrong *= DEGRADED_FACTOR * DEGRADED_FACTOR
        # each stride moves the mean of both feet by a half
        return self._add_input((stride.t, MOVE, 0.0, 0.25 * wrong))

    def _corrected_ride(self, ride: LiftRidden) -> LiftRidden:
        """Return the ride with its likeliest height."""
        start, end = ride.t_start, ride.t
        inputs = self.kept.all()
        readings = [one for one in inputs if one[1] != MOVE and not start - RIDE_MARGIN < one[0] < end + RIDE_MARGIN]
        enclosed = any([one[0] < start for one in readings]) and any([one[0] > end for one in readings])
        if not enclosed and not self._is_plausible(ride):
            return evolve(ride, height=None)
        by = 0.0 if ride.height is None or not abs(ride.height) < LARGEST_HEIGHT else ride.height
        variance = (RIDE_ERROR * by) ** 2 if by else UNKNOWN_VARIANCE
        before = self.now.values[0]
        kept = [one for one in inputs if one[1] == MOVE or not start - RIDE_MARGIN < one[0] < end + RIDE_MARGIN]
        first = [one for one in kept if one[0] <= end]
        later = [one for one in kept if one[0] > end]
        self.kept.replace([*first, (end, MOVE, by, variance), *later])
        self.now = self.base.copy()
        for one in self.kept.all():
            self._apply(self.now, one)
        risen = self.now.values[0] - before
        self.ride_variance = min(self.ride_variance + min(variance, self.now.covariance[0]), UNKNOWN_VARIANCE)
        return evolve(ride, height=risen) if (risen > 0.0) is ride.up else ride

    def _is_plausible(self, ride: LiftRidden) -> bool:
        """Return whether a ride that only the feet have measured can have had its height."""
        height, lasted = ride.height, ride.t - ride.t_start
        if height is None or not lasted > 0.0 or (height > 0.0) is not ride.up:
            return False
        t_start, t_end = 100.0 * ride.t_start, 100.0 * ride.t
        walked = sum([start > t_start and end < t_end for start, end in self.strides])
        return walked < 2 and abs(height) >= LOWEST_RIDE and SLOWEST_RIDE <= abs(height) / lasted <= FASTEST_RIDE

    def _add_input(self, one: HeightInput) -> Sequence[PartOutput]:
        kept = self.kept
        while (oldest := kept.oldest) is not None and (one[0] - oldest > KEPT_TIME or kept.count >= 8.0 * KEPT_TIME):
            self._apply(self.base, kept.pop())
        self._apply(self.now, kept.add(one))
        return [self._height()]

    def _apply(self, estimate: HeightEstimate, one: HeightInput) -> None:
        t, source, value, variance = one
        if source == MOVE:
            estimate.move(value, variance)
        else:
            estimate.read(source, t, value, variance, OFFSET_DRIFT * OFFSET_DRIFT)
