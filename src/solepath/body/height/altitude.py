"""How high the wearer is: what lifts and the air pressure add to the heights of the steps.

The feet's tracks say how high stairs and slopes led and, level by level, nothing of a lift, in which a foot stands
still. So `correction` is added to their height. It is followed by a Kalman filter over it and over what each foot's
barometer is off by (weather, wind, doors, its own offset), with half a second or more of readings at a time:

    height by the air  -  height of the foot's track  =  correction + offset of that barometer + noise

    a step of height h     the correction is less sure by the variance of h; a level one changes nothing
    a lift                 it jumps by the ride's height, and is less sure by how well that is known
    time                   each offset wanders by `OFFSET_DRIFT`^2 a second

So on level ground, where no step gains height, the air can move nothing: weather and doors are offsets. On stairs the
steps say what each one gains and the air what they came to; in a lift the air alone says it, where there is one.
A ride is told after it has ended; what was read since it began is then gone through again (`KEPT` s are kept). What is
read after that still settles its height, for as long as the offsets are better known than the wander lets them be.
"""

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
from .received import Heard, Told

SCALE = 8578.0
"""Height over which the pressure of air of 20 degrees falls to 1/e, m: R T / (M g)."""
STANDARD = 101325.0
"""Pa."""
EVERY = 0.5
"""s, and no less, between readings that are used; all until then are one."""
KEPT = 90.0
"""s."""
UNKNOWN = 1e4
"""Variance of a height that nobody knows, m^2."""
FARTHEST = 1e5
"""Tracks that are higher, m, lead nowhere."""
LEFT, RIGHT, MOVE = 0, 1, 2
"""Of whom what is kept was told: the left barometer, the right one, or a move of the correction."""
AROUND = 0.7
"""So long before a ride was felt and after it, readings are not of standing still, s."""
LEVEL = 0.02
"""What rises by less is level, m."""
STRIDES = 64
"""The newest are remembered, for rides that were none."""
STRODE = 0.3
"""A longer one is no shift of weight, m."""
OFFSET_DRIFT = 0.03
"""Wander of a barometer's offset, m in one second: 0.35 Pa, indoors. Weather alone makes less than that."""
STEP_ERROR, DEGRADED = 0.05, 3.0
"""What a step's height is wrong by, as a share of it, beside what the filter expects; so many times as much where too
little was measured (a degraded step)."""
RIDE_ERROR = 0.1
"""What a ride's height is wrong by without more air than until its end, as a share of it."""
SHORTEST, SLOWEST, FASTEST = 1.8, 0.25, 4.0
"""What a lift rides at least, m, for its height to be believed without air, and between which mean speeds, m/s."""


@define
class Heights:
    """The filter's estimate: the correction and two offsets, m, and their covariance, row by row, m^2."""

    values: list[float] = field(factory=lambda: [0.0, 0.0, 0.0])
    covariance: list[float] = field(factory=lambda: [0.0] * 9)
    known: list[float | None] = field(factory=lambda: [None, None])
    """When each barometer was last read, s; None: never."""

    def move(self, by: float, variance: float) -> None:
        """The correction changes by `by` m, known that well."""
        self.values[0] += by
        self.covariance[0] = min(self.covariance[0] + variance, UNKNOWN)

    def read(self, which: int, t: float, height: float, noise: float, wander: float) -> None:
        """A barometer says `height` m above its foot's track; variances of that, m^2, and of its offset, m^2/s."""
        x, p, i = self.values, self.covariance, 1 + which
        before = self.known[which]
        self.known[which] = t
        if before is None:
            # nothing is known of its offset: it is what makes the reading right
            x[i] = height - x[0]
            for j in range(3):
                if j != i:
                    p[3 * i + j] = p[3 * j + i] = -p[j]
            p[4 * i] = p[0] + noise
            return
        p[4 * i] = min(p[4 * i] + wander * max(0.0, t - before), UNKNOWN)
        off = height - x[0] - x[i]
        spread = p[0] + 2.0 * p[i] + p[4 * i] + noise
        if off * off > 25.0 * spread:  # a door, another height of the same air: an offset has leapt
            p[4 * i] = min(p[4 * i] + off * off, UNKNOWN)
            spread = p[0] + 2.0 * p[i] + p[4 * i] + noise
        held = [p[3 * j] + p[3 * j + i] for j in range(3)]
        for j in range(3):
            x[j] += held[j] / spread * off
        for j in range(3):
            for k in range(3):
                p[3 * j + k] -= held[j] * held[k] / spread
        for j in range(3):
            p[4 * j] = max(p[4 * j], 0.0)

    def copy(self) -> Heights:
        return Heights(list(self.values), list(self.covariance), list(self.known))


@define
class PendingReadings:
    """Readings of one barometer that are not used yet, and how they scatter."""

    since: float | None = None
    total: float = 0.0
    count: int = 0
    last: float | None = None
    """The newest that was used, m."""


@define
class Altitude(Part):
    """The filter, fed. Latency: none for the air; a ride is known after it."""

    needs_samples: ClassVar[bool] = True
    idle = True

    now: Heights = field(factory=Heights, init=False)
    base: Heights = field(factory=Heights, init=False)
    """As it was before what is kept."""
    kept: Heard = field(factory=Heard, init=False)
    """Of the left barometer, of the right one, or a move of the correction."""
    sides: list[PendingReadings] = field(factory=lambda: [PendingReadings(), PendingReadings()], init=False)
    noise: float = field(default=0.04, init=False)
    """Variance of a reading that is used, learnt, m^2."""
    doubt: float = field(default=0.0, init=False)
    """Variance of all rides, m^2."""
    strides: deque[tuple[float, float]] = field(factory=deque, init=False)
    """Begin and end of the newest, in whole hundredths of a second."""

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """A foot's barometer may have been read."""
        pressure = view.sample.air_pressure
        if pressure is None:
            return ()
        t, z = view.t, view.position[2]
        if not (2e4 < pressure < 2e5 and abs(z) < FARTHEST):
            return ()
        which = LEFT if view.foot is Foot.LEFT else RIGHT
        side = self.sides[which]
        side.total += SCALE * log(STANDARD / pressure) - z
        side.count += 1
        if side.since is not None and 0.0 <= t - side.since < EVERY:
            return ()
        height = side.total / side.count
        if side.last is not None:
            # of consecutive ones the difference varies by 2 noise + drift^2; a ride or a gust counts little
            square = 0.5 * (height - side.last) ** 2
            self.noise += 0.05 * (min(square, 3.0 * self.noise) - self.noise)
            self.noise = max(self.noise, 1e-4)
        side.since, side.total, side.count, side.last = t, 0.0, 0, height
        return self._keep((t, which, height, self.noise))

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """A stride makes the correction less sure; a ride's height is what is made of it here."""
        if isinstance(event, StrideTaken):
            return self._stepped(event)
        if isinstance(event, LiftRidden):
            ridden = self._ridden(event)
            return [Replacement(event, ridden), self._height()]
        return ()

    def _height(self) -> HeightShift:
        return HeightShift(self.now.values[0], self.doubt)

    def reset(self, site: Site) -> None:
        """The clock of a foot restarts, or it wears another barometer: its offset is not known any more."""
        if site.foot is None:
            return
        which = LEFT if site.foot is Foot.LEFT else RIGHT
        self.sides[which] = PendingReadings()
        self.now.known[which] = None
        self.base = self.now.copy()
        self.kept.clear()
        self.strides.clear()

    def _stepped(self, step: StrideTaken) -> Sequence[PartOutput]:
        self.strides.append((float(round(100.0 * step.t_start)), float(round(100.0 * step.t_end))))
        if step.length < STRODE:
            self.strides.pop()
        elif len(self.strides) > STRIDES:
            self.strides.popleft()
        if self.now.known[LEFT] is None and self.now.known[RIGHT] is None:
            return ()
        height, variance = abs(step.height_change), step.covariance[5]
        if not LEVEL < height < FARTHEST or not variance < FARTHEST:
            return ()
        wrong = (STEP_ERROR * height) ** 2 + max(0.0, variance)
        if step.degraded:
            wrong *= DEGRADED * DEGRADED
        # of the mean of both feet each step is a half
        return self._keep((step.t, MOVE, 0.0, 0.25 * wrong))

    def _ridden(self, ride: LiftRidden) -> LiftRidden:
        """The ride, at the height that it most likely had."""
        start, end = ride.t_start, ride.t
        told = self.kept.all()
        heard = [one for one in told if one[1] != MOVE and not start - AROUND < one[0] < end + AROUND]
        aired = any([one[0] < start for one in heard]) and any([one[0] > end for one in heard])
        if not aired and not self._sound(ride):
            return evolve(ride, height=None)
        by = 0.0 if ride.height is None or not abs(ride.height) < FARTHEST else ride.height
        variance = (RIDE_ERROR * by) ** 2 if by else UNKNOWN
        before = self.now.values[0]
        kept = [one for one in told if one[1] == MOVE or not start - AROUND < one[0] < end + AROUND]
        first = [one for one in kept if one[0] <= end]
        later = [one for one in kept if one[0] > end]
        self.kept.replace([*first, (end, MOVE, by, variance), *later])
        self.now = self.base.copy()
        for one in self.kept.all():
            self._use(self.now, one)
        risen = self.now.values[0] - before
        self.doubt = min(self.doubt + min(variance, self.now.covariance[0]), UNKNOWN)
        return evolve(ride, height=risen) if (risen > 0.0) is ride.up else ride

    def _sound(self, ride: LiftRidden) -> bool:
        """Whether a ride that only the feet have felt can have been one of that height."""
        height, lasted = ride.height, ride.t - ride.t_start
        if height is None or not lasted > 0.0 or (height > 0.0) is not ride.up:
            return False
        began, ended = 100.0 * ride.t_start, 100.0 * ride.t
        walked = sum([start > began and end < ended for start, end in self.strides])
        return walked < 2 and abs(height) >= SHORTEST and SLOWEST <= abs(height) / lasted <= FASTEST

    def _keep(self, one: Told) -> Sequence[PartOutput]:
        kept = self.kept
        while (oldest := kept.oldest) is not None and (one[0] - oldest > KEPT or kept.count >= 8.0 * KEPT):
            self._use(self.base, kept.pop())
        self._use(self.now, kept.add(one))
        return [self._height()]

    def _use(self, heights: Heights, one: Told) -> None:
        t, which, value, variance = one
        if which == MOVE:
            heights.move(value, variance)
        else:
            heights.read(which, t, value, variance, OFFSET_DRIFT * OFFSET_DRIFT)
