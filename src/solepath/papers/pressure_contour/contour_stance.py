"""Stance evidence of "Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans.
Instrum. Meas. 59, 2010): the heel's pressure contours stand still, or, as its baseline, the gyroscope does.
"""

from __future__ import annotations

from collections import deque
from math import hypot, inf, sqrt

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Layout, Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import IDENTITY, TIE, ZERO
from .contour import Contours

KEPT = 5
"""The threshold of the gyroscope comes from the median of so many stances."""
TARE_SAMPLES = 200
"""The tare is the mean of about so many samples in the air: some swings, since a swung shoe presses unevenly."""
RELEASE = 1.6
"""A foot that stands turns by less than this times its quietest moment."""
HEEL_RISES = 0.4
"""While the heel rises a foot still turns slowly: so long after its stance no quietest moment is sought, s."""
STANCE_DUE, LONGEST_MOTION = 1.0, 2.5
"""A motion that lasts longer than the first of these times, s, has gone through a stance that was not seen, since feet
that stroll move for up to 1 s; after the second, s, thresholds give way until it ends."""
LONGEST_STANCE = 1.0
"""A foot that stands, or a heel that is loaded, for longer does not walk, and says nothing of the next stance, s."""
LONGEST_GAP = 0.3
"""Samples farther apart do not tell what went on between, s."""
HOLD, BLIND, STALE = 0.03, 0.1, 0.05
"""A stance goes on while contours are fast for no longer than the first of these times, s. Once a heel has borne weight
for the second, s, without contours at rest the gyroscope is asked. What a load says holds for the third, s."""


@frozen
class GyroscopeSettings:
    """What `GyroscopeMagnitude` is set to."""

    below: float = 0.25
    """The threshold is never lower, rad/s."""
    first: float = 0.5
    """The threshold until stances of walking were seen, rad/s."""
    ceiling: float = 1.5
    """The threshold is never higher while stances are seen, rad/s."""
    margin: float = 1.8
    """The wearer's own threshold, as a multiple of how quiet stances are at their quietest."""
    lasting: float = 0.03
    """For so long the rate is below the threshold before the foot stands, s."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s."""


@define
class GyroscopeMagnitude(Detector):
    """The sensor hardly turns, so it stands still: |w| has stayed below a threshold for `lasting` s, and has not risen
    above `RELEASE` times the quietest moment of this stance since. The statistic is |w|, rad/s. Latency: `lasting`.

    The paper says that angular velocity was used and no more. Published thresholds of |w| are 0.5 rad/s in code after
    Tunca et al. 2017 (Sensors 17, 825) and 0.6 rad/s in the code of Fischer et al. 2013 (IEEE Pervasive Computing 12);
    shoes differ, though. In the recordings at hand a sensor in a tied shoe turns at 0.03 to 0.2 rad/s in the quietest
    30 ms of its stances, loose insoles and shoes at 0.3 to 1.2, and quiet walkers swing through moments of 0.3. So the
    threshold is the wearer's own: `margin` times the median quietest moment of the last `KEPT` stances of walking,
    within `below` and `ceiling`, and `first` before there is one. A sensor 12 cm from the heel's end moves at 3 cm/s at
    `below`.

    A motion that has lasted for `STANCE_DUE` s has gone through a stance that was not seen: then `margin` times the
    quietest moment of that motion serves, and after `LONGEST_MOTION` s in proportion to how long it has lasted, without
    a ceiling. So every motion ends.
    """

    settings: GyroscopeSettings = GyroscopeSettings()
    t: float | None = field(default=None, init=False)
    """The last sample, s."""
    recent: deque[tuple[float, float]] = field(factory=deque, init=False)
    """|w| and time of the last `lasting` s."""
    since: float = field(default=0.0, init=False)
    """When the present stance or motion began, s."""
    still: bool = field(default=False, init=False)
    quiet: float | None = field(default=None, init=False)
    """The quietest moment of it, rad/s: the least maximum over `lasting`."""
    levels: tuple[float, ...] = field(default=(), init=False)
    """The same of the last stances of walking."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        x, y, z = gyro
        rate = sqrt(x * x + y * y + z * z)
        if self.t is None or not self.t < t <= self.t + LONGEST_GAP:
            self.recent.clear()
            self.since, self.still, self.quiet = t, False, None
        self.t = t
        highest = self._highest(t, rate)
        if self.still:
            self.quiet = rate if self.quiet is None else min(self.quiet, rate if highest is None else highest)
            if rate >= RELEASE * max(self.settings.below, self.quiet):
                if t - self.since < LONGEST_STANCE:
                    self.levels = (*self.levels[1 - KEPT :], self.quiet)
                self.since, self.still, self.quiet = t, False, None
        elif highest is not None:
            moved = t - self.since
            if moved > HEEL_RISES and (self.quiet is None or highest < self.quiet):
                self.quiet = highest
            if highest < self._threshold(moved):
                self.since, self.still, self.quiet = t, True, highest
        if self.still:
            return Stance(ZERO, self.settings.sigma, rate, Phase.STATIONARY)
        return Stance(ZERO, inf, rate, None)

    def _highest(self, t: float, rate: float) -> float | None:
        """|w| has not been higher for `lasting`; None while it has not been heard for so long."""
        recent = self.recent
        recent.append((rate, t))
        oldest = t - self.settings.lasting + TIE
        while len(recent) > 1 and recent[1][1] <= oldest:
            recent.popleft()
        if recent[0][1] > oldest:
            return None
        return max(recent)[0]

    def _threshold(self, moved: float) -> float:
        """For a foot that has moved for so long, s."""
        settings = self.settings
        levels = [settings.margin * level for level in self.levels]
        if len(levels) < KEPT:
            levels.append(settings.first)
        levels.sort()
        usual = min(max(settings.below, levels[len(levels) // 2]), settings.ceiling)
        if moved < STANCE_DUE or self.quiet is None:
            return usual
        own = settings.margin * self.quiet
        if moved < LONGEST_MOTION:
            return max(usual, min(own, settings.ceiling))
        return max(usual, own * moved / LONGEST_MOTION)


@frozen
class ContourVelocitySettings:
    """What `ContourVelocity` is set to."""

    threshold: float = 0.004
    """v_thrsh of (3), m/s: the paper's sensing bias."""
    margin: float = 1.5
    """The wearer's own threshold, as a multiple of how slow the contours of stances are at their slowest."""
    leave: float = 0.020
    """A stance ends where the contours are faster than this, m/s."""
    loaded: float = 0.12
    """The heel is loaded when it carries at least this share of the wearer's full load."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s."""


@define
class ContourVelocity(Detector):
    """The contours of the loaded heel move by no more than `threshold` (3), so the shoe stands still; until they move
    by more than `leave` for longer than `HOLD`, or the heel is no longer loaded. The statistic is their speed, m/s.

    `leave` is higher because what is left of the load near heel-off makes noisy contours, and a foot that has stood
    does not move while its heel carries weight. Latency: that of `Contours`, 50 ms after the contours have stopped.

    The contours of loose insoles whose cells give counts of no known scale never stop: in the slowest moments of
    stances they crawl at 1 to 25 mm/s in the recordings at hand, where the paper's threshold was its own sensors' bias.
    So the wearer's own threshold is `margin` times the median of the slowest moments of the last `KEPT` stances of
    walking, no less than `threshold` and no more than `leave`; rolling feet have contours that move ten times as fast.

    Where no contour can be had (no cells, unknown places, too few under the heel), and as long as the wearer's full
    load is not known, the gyroscope stands in. So it does, unless the foot is in the air, once a heel has borne weight
    for `BLIND` s and its contours have not come to rest: in a tight bend it stands on its edge, and what contours lie
    over cells are cut off; and when contours have not come to rest for `STANCE_DUE` s, as in feet that walk on their
    toes. After `LONGEST_MOTION` s it does whatever the cells say, so that no motion lasts longer than the gyroscope's.

    Between loads, where cells come more slowly than inertial samples, what was said last holds for `STALE` s.
    """

    settings: ContourVelocitySettings = ContourVelocitySettings()
    contours: Contours = field(factory=Contours)
    baseline: GyroscopeMagnitude = field(factory=GyroscopeMagnitude)
    lacking: str | None = field(default=None, init=False)
    """Why the gyroscope stands in for good, as a sentence; None while it does not."""
    count: int = field(default=0, init=False)
    """How many cells the layout has; 0 as long as there is none."""
    tare: list[float] = field(factory=list, init=False)
    """What the used cells show in the air, unit of the samples."""
    tared: int = field(default=0, init=False)
    """Samples in the air so far, up to `TARE_SAMPLES`."""
    still: bool = field(default=False, init=False)
    seen: float | None = field(default=None, init=False)
    """When contours last were at rest, or else when the heel came down; None while it carries too little, s."""
    down: float = field(default=0.0, init=False)
    """When the heel came down, s."""
    rested: float | None = field(default=None, init=False)
    """When contours last were at rest, or else when the first load was heard of, s."""
    slowest: float | None = field(default=None, init=False)
    """Of the contours since the heel came down, m/s."""
    levels: tuple[float, ...] = field(default=(), init=False)
    """The same of the last stances of walking."""
    said: Phase | None = field(default=None, init=False)
    """What the last load said,"""
    said_at: float | None = field(default=None, init=False)
    """when, s; None while the gyroscope stands in,"""
    speed: float = field(default=0.0, init=False)
    """and the statistic."""

    def set_layout(self, layout: Layout) -> None:
        why = self.contours.set_layout(layout)
        self.lacking = None if why is None else f"{why}; the gyroscope says when the foot stands"
        self.count = len(layout.cells)
        self.tare = [0.0] * len(self.contours.cells)
        self.tared = 0
        self.still = False
        self.seen = self.rested = self.slowest = self.said_at = None
        self.levels = ()

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        otherwise = self.baseline.update(t, dt, acc, gyro, load, attitude)
        if load is not None:
            self.said_at = None
            if load.heel is not None and self.contours.points and len(load.cells) == self.count:
                self._hear(t, load, load.heel)
        if self.said_at is None or not self.said_at <= t < self.said_at + STALE:
            return otherwise
        sigma = self.settings.sigma if self.said is Phase.STATIONARY else inf
        return Stance(ZERO, sigma, self.speed, self.said)

    def _hear(self, t: float, load: Load, heel: float) -> None:
        """What a load says; nothing where the gyroscope is to be asked."""
        if self.rested is None or self.rested > t:
            self.rested = t
        if heel < self.settings.loaded:
            self._lifted(t)
            if load.airborne:
                self._tare(load.cells)
            waits = t - self.rested
            if waits < (LONGEST_MOTION if load.airborne else STANCE_DUE):
                self._say(t, Phase.SWING if load.airborne else None, 0.0)
            return
        cells = load.cells
        above = [cells[i] - zero for i, zero in zip(self.contours.cells, self.tare, strict=True)]
        velocity = self.contours.velocity(t, above)
        if self.seen is None or self.seen > t:
            self.seen = self.down = t
        speed = hypot(*(velocity or ZERO))
        if velocity is not None:
            if self.slowest is None or speed < self.slowest:
                self.slowest = speed
            if speed <= (self.settings.leave if self.still else self._threshold()):
                self.still = True
                self.seen = self.rested = t
        self.still = self.still and t - self.seen <= HOLD + TIE
        if self.still:
            self._say(t, Phase.STATIONARY, speed)
        elif t - self.seen < BLIND - TIE and t - self.rested < STANCE_DUE:
            self._say(t, None, speed)

    def _say(self, t: float, said: Phase | None, speed: float) -> None:
        self.said, self.said_at, self.speed = said, t, speed

    def _lifted(self, t: float) -> None:
        """The heel carries too little."""
        if self.seen is not None and self.slowest is not None and t - self.down < LONGEST_STANCE:
            self.levels = (*self.levels[1 - KEPT :], self.slowest)
        self.still, self.seen, self.slowest = False, None, None
        self.contours.reset()

    def _tare(self, cells: tuple[float, ...]) -> None:
        self.tared = min(self.tared + 1, TARE_SAMPLES)
        k = 1.0 / self.tared
        self.tare = [zero + k * (cells[i] - zero) for i, zero in zip(self.contours.cells, self.tare, strict=True)]

    def _threshold(self) -> float:
        settings = self.settings
        if not self.levels:
            return settings.threshold
        usual = settings.margin * sorted(self.levels)[len(self.levels) // 2]
        return min(max(settings.threshold, usual), settings.leave)
