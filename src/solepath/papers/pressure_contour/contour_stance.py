"""Stance evidence of Bebek et al. 2010: the heel's pressure contours or, as baseline, the gyroscope.

"Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans. Instrum. Meas. 59,
2010)."""

from __future__ import annotations

from collections import deque
from math import hypot, inf, sqrt

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Layout, Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import IDENTITY, TIE, ZERO
from .contour import Contours

KEPT_STANCES = 5
"""Number of stances whose median sets a wearer's own threshold."""
TARE_SAMPLES = 200
"""Number of samples in the air that the tare is a mean of: some swings, since a swung shoe presses unevenly."""
RELEASE_RATIO = 1.6
"""Ratio of the rate to the lowest rate of the stance below which the foot still stands."""
HEEL_RISE_TIME = 0.4
"""Time after a stance in which no lowest rate is sought, s: while the heel rises the foot still turns slowly."""
STANCE_OVERDUE, LONGEST_MOTION = 1.0, 2.5
"""Duration of a motion that must contain a missed stance, and one after which thresholds rise until it ends, s.

Feet that stroll move for up to 1 s."""
LONGEST_STANCE = 1.0
"""Longest stance of walking, s: a longer one, or a heel loaded for longer, sets no threshold for the next stance."""
LONGEST_GAP = 0.3
"""Longest time between two samples of one stance or motion, s."""
HOLD_TIME, NO_CONTOUR_TIME, LOAD_VALID_TIME = 0.03, 0.1, 0.05
"""Times, s: fast contours that do not end a stance, a loaded heel without contours at rest, and validity of a load.

After the second the gyroscope decides."""


@frozen
class GyroscopeSettings:
    """Settings of `GyroscopeMagnitude`."""

    below: float = 0.25
    """Lowest threshold, rad/s."""
    first: float = 0.5
    """Threshold until enough stances of walking are known, rad/s."""
    ceiling: float = 1.5
    """Highest threshold while stances are found, rad/s."""
    margin: float = 1.8
    """Ratio of the wearer's own threshold to the lowest rates of the wearer's stances."""
    lasting: float = 0.03
    """Time for which the rate must be below the threshold before the foot stands, s."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s."""


@define
class GyroscopeMagnitude(Detector):
    """Detector: the foot stands while the sensor hardly turns.

    |w| has stayed below a threshold for `lasting` s, and has not risen above `RELEASE_RATIO` times the lowest rate of
    this stance since. The statistic is |w|, rad/s. Latency: `lasting`.

    The paper says only that angular velocity was used. Published thresholds of |w| are 0.5 rad/s in code after Tunca et
    al. 2017 (Sensors 17, 825) and 0.6 rad/s in the code of Fischer et al. 2013 (IEEE Pervasive Computing 12). Shoes
    differ: in the recordings at hand a sensor in a tied shoe turns at 0.03 to 0.2 rad/s in the stillest 30 ms of its
    stances, loose insoles and shoes at 0.3 to 1.2, and smooth walkers swing through moments of 0.3. So the threshold is
    the wearer's own: `margin` times the median lowest rate of the last `KEPT_STANCES` stances of walking, within
    `below` and `ceiling`, and `first` before there is one. A sensor 12 cm from the heel's end moves at 3 cm/s at
    `below`.

    A motion that has lasted for `STANCE_OVERDUE` s contains a missed stance: then `margin` times the lowest rate of
    that motion is the threshold, and after `LONGEST_MOTION` s in proportion to the motion's duration, without a
    ceiling. So every motion ends."""

    settings: GyroscopeSettings = GyroscopeSettings()
    t: float | None = field(default=None, init=False)
    """Time of the last sample, s."""
    recent: deque[tuple[float, float]] = field(factory=deque, init=False)
    """Magnitude |w|, rad/s, and time, s, of the samples of the last `lasting` s."""
    changed_at: float = field(default=0.0, init=False)
    """Start of the present stance or motion, s."""
    standing: bool = field(default=False, init=False)
    """Flag: the foot stands."""
    lowest_rate: float | None = field(default=None, init=False)
    """Least maximum of |w| over `lasting` in this stance or motion, rad/s."""
    levels: tuple[float, ...] = field(default=(), init=False)
    """Lowest rates of the last stances of walking, rad/s."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        x, y, z = gyro
        rate = sqrt(x * x + y * y + z * z)
        if self.t is None or not self.t < t <= self.t + LONGEST_GAP:
            self.recent.clear()
            self.changed_at, self.standing, self.lowest_rate = t, False, None
        self.t = t
        highest = self._highest(t, rate)
        if self.standing:
            self.lowest_rate = (
                rate if self.lowest_rate is None else min(self.lowest_rate, rate if highest is None else highest)
            )
            if rate >= RELEASE_RATIO * max(self.settings.below, self.lowest_rate):
                if t - self.changed_at < LONGEST_STANCE:
                    self.levels = (*self.levels[1 - KEPT_STANCES :], self.lowest_rate)
                self.changed_at, self.standing, self.lowest_rate = t, False, None
        elif highest is not None:
            moved = t - self.changed_at
            if moved > HEEL_RISE_TIME and (self.lowest_rate is None or highest < self.lowest_rate):
                self.lowest_rate = highest
            if highest < self._threshold(moved):
                self.changed_at, self.standing, self.lowest_rate = t, True, highest
        if self.standing:
            return Stance(ZERO, self.settings.sigma, rate, Phase.STATIONARY)
        return Stance(ZERO, inf, rate, None)

    def _highest(self, t: float, rate: float) -> float | None:
        """Return the maximum of |w| over the last `lasting` s, rad/s; None before samples cover that time."""
        recent = self.recent
        recent.append((rate, t))
        oldest = t - self.settings.lasting + TIE
        while len(recent) > 1 and recent[1][1] <= oldest:
            recent.popleft()
        if recent[0][1] > oldest:
            return None
        return max(recent)[0]

    def _threshold(self, moved: float) -> float:
        """Return the threshold for a foot that has moved for `moved` s, rad/s."""
        settings = self.settings
        levels = [settings.margin * level for level in self.levels]
        if len(levels) < KEPT_STANCES:
            levels.append(settings.first)
        levels.sort()
        usual = min(max(settings.below, levels[len(levels) // 2]), settings.ceiling)
        if moved < STANCE_OVERDUE or self.lowest_rate is None:
            return usual
        own = settings.margin * self.lowest_rate
        if moved < LONGEST_MOTION:
            return max(usual, min(own, settings.ceiling))
        return max(usual, own * moved / LONGEST_MOTION)


@frozen
class ContourVelocitySettings:
    """Settings of `ContourVelocity`."""

    threshold: float = 0.004
    """Threshold v_thrsh of (3), m/s: the paper's sensing bias."""
    margin: float = 1.5
    """Ratio of the wearer's own threshold to the slowest contours of the wearer's stances."""
    leave: float = 0.020
    """Speed of the contours above which a stance ends, m/s."""
    loaded: float = 0.12
    """Share of the wearer's full load from which on the heel is loaded."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s."""


@define
class ContourVelocity(Detector):
    """Detector: the shoe stands while the contours of the loaded heel move by no more than a threshold (3).

    The stance ends when they move by more than `leave` for longer than `HOLD_TIME`, or the heel is no longer loaded.
    The statistic is their speed, m/s. `leave` is higher than `threshold` because the load that is left near heel-off
    makes noisy contours, and a foot that has stood does not move while its heel bears weight. Latency: that of
    `Contours`, 50 ms after the contours have stopped.

    The contours of loose insoles whose cells give counts of no known scale never stop: in the slowest moments of
    stances they move at 1 to 25 mm/s in the recordings at hand, where the paper's threshold was its own sensors' bias.
    So the wearer's own threshold is `margin` times the median slowest speed of the last `KEPT_STANCES` stances of
    walking, no less than `threshold` and no more than `leave`; rolling feet have contours that move ten times as fast.

    The gyroscope decides where there are no contours (no cells, unknown places, too few cells under the heel), and as
    long as the wearer's full load is not known. Unless the foot is in the air, it also decides once a heel has borne
    weight for `NO_CONTOUR_TIME` s without contours at rest: in a tight bend the heel stands on its edge, and contours
    that leave the cells are cut off. It decides too when contours have not come to rest for `STANCE_OVERDUE` s, as in
    feet that walk on their toes, and after `LONGEST_MOTION` s whatever the cells show, so that no motion lasts longer
    than the gyroscope's.

    Between loads, where cells come more slowly than inertial samples, the last evidence holds for `LOAD_VALID_TIME` s.
    """

    settings: ContourVelocitySettings = ContourVelocitySettings()
    contours: Contours = field(factory=Contours)
    baseline: GyroscopeMagnitude = field(factory=GyroscopeMagnitude)
    lacking: str | None = field(default=None, init=False)
    """Reason why the gyroscope always decides, as a sentence; None while there is none."""
    cell_count: int = field(default=0, init=False)
    """Number of cells of the layout; 0 without a layout."""
    tare: list[float] = field(factory=list, init=False)
    """Values of the used cells in the air, unit of the samples."""
    tare_count: int = field(default=0, init=False)
    """Number of samples in the air, up to `TARE_SAMPLES`."""
    standing: bool = field(default=False, init=False)
    """Flag: the contours of the loaded heel are at rest."""
    still_at: float | None = field(default=None, init=False)
    """Time when contours last were at rest, or the heel came down, s; None while the heel bears too little."""
    landed_at: float = field(default=0.0, init=False)
    """Time when the heel came down, s."""
    rested_at: float | None = field(default=None, init=False)
    """Time when contours last were at rest, or the first load came, s."""
    slowest_speed: float | None = field(default=None, init=False)
    """Slowest speed of the contours since the heel came down, m/s."""
    levels: tuple[float, ...] = field(default=(), init=False)
    """Slowest speeds of the contours in the last stances of walking, m/s."""
    load_phase: Phase | None = field(default=None, init=False)
    """Hint of the last load."""
    judged_at: float | None = field(default=None, init=False)
    """Time of the last load with evidence, s; None while the gyroscope decides."""
    speed: float = field(default=0.0, init=False)
    """Statistic of the last load, m/s."""

    def set_layout(self, layout: Layout) -> None:
        why = self.contours.set_layout(layout)
        self.lacking = None if why is None else f"{why}; the gyroscope says when the foot stands"
        self.cell_count = len(layout.cells)
        self.tare = [0.0] * len(self.contours.cells)
        self.tare_count = 0
        self.standing = False
        self.still_at = self.rested_at = self.slowest_speed = self.judged_at = None
        self.levels = ()

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        gyroscope_stance = self.baseline.update(t, dt, acc, gyro, load, attitude)
        if load is not None:
            self.judged_at = None
            if load.heel is not None and self.contours.points and len(load.cells) == self.cell_count:
                self._add_load(t, load, load.heel)
        if self.judged_at is None or not self.judged_at <= t < self.judged_at + LOAD_VALID_TIME:
            return gyroscope_stance
        sigma = self.settings.sigma if self.load_phase is Phase.STATIONARY else inf
        return Stance(ZERO, sigma, self.speed, self.load_phase)

    def _add_load(self, t: float, load: Load, heel: float) -> None:
        """Update the evidence by a load, and leave it unset where the gyroscope decides."""
        if self.rested_at is None or self.rested_at > t:
            self.rested_at = t
        if heel < self.settings.loaded:
            self._end_landing(t)
            if load.airborne:
                self._update_tare(load.cells)
            waits = t - self.rested_at
            if waits < (LONGEST_MOTION if load.airborne else STANCE_OVERDUE):
                self._set_evidence(t, Phase.SWING if load.airborne else None, 0.0)
            return
        cells = load.cells
        above = [cells[i] - zero for i, zero in zip(self.contours.cells, self.tare, strict=True)]
        velocity = self.contours.velocity(t, above)
        if self.still_at is None or self.still_at > t:
            self.still_at = self.landed_at = t
        speed = hypot(*(velocity or ZERO))
        if velocity is not None:
            if self.slowest_speed is None or speed < self.slowest_speed:
                self.slowest_speed = speed
            if speed <= (self.settings.leave if self.standing else self._threshold()):
                self.standing = True
                self.still_at = self.rested_at = t
        self.standing = self.standing and t - self.still_at <= HOLD_TIME + TIE
        if self.standing:
            self._set_evidence(t, Phase.STATIONARY, speed)
        elif t - self.still_at < NO_CONTOUR_TIME - TIE and t - self.rested_at < STANCE_OVERDUE:
            self._set_evidence(t, None, speed)

    def _set_evidence(self, t: float, load_phase: Phase | None, speed: float) -> None:
        self.load_phase, self.judged_at, self.speed = load_phase, t, speed

    def _end_landing(self, t: float) -> None:
        """Reset the contours when the heel bears too little."""
        if self.still_at is not None and self.slowest_speed is not None and t - self.landed_at < LONGEST_STANCE:
            self.levels = (*self.levels[1 - KEPT_STANCES :], self.slowest_speed)
        self.standing, self.still_at, self.slowest_speed = False, None, None
        self.contours.reset()

    def _update_tare(self, cells: tuple[float, ...]) -> None:
        self.tare_count = min(self.tare_count + 1, TARE_SAMPLES)
        k = 1.0 / self.tare_count
        self.tare = [zero + k * (cells[i] - zero) for i, zero in zip(self.contours.cells, self.tare, strict=True)]

    def _threshold(self) -> float:
        settings = self.settings
        if not self.levels:
            return settings.threshold
        usual = settings.margin * sorted(self.levels)[len(self.levels) // 2]
        return min(max(settings.threshold, usual), settings.leave)
