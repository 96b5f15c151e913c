"""Stance evidence of Bebek et al. 2010: the heel's pressure contours or, as baseline, the gyroscope.

"Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans. Instrum. Meas. 59,
2010). Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections import deque
from math import hypot, inf, sqrt

from ...foot.stance.stance import Detector, Load, Stance
from ...types import Layout, Phase, Quat, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import IDENTITY, TIME_EPSILON, ZERO
from .contour import Contours

KEPT_STANCES = 5
"""Number of stances whose median sets a wearer's own threshold."""
TARE_SAMPLES = 200
"""Number of samples in the air that the tare averages: several swings, because a swung shoe presses unevenly."""
RELEASE_RATIO = 1.6
"""Ratio of the rate to the lowest rate of the stance from which on the foot no longer stands."""
HEEL_RISE_TIME = 0.4
"""Time after a stance in which low rates are ignored, s, because the foot turns slowly while the heel rises."""
STANCE_OVERDUE, LONGEST_MOTION = 1.0, 2.5
"""Time after which a motion must contain an undetected stance, and after which its threshold rises until it ends, s.

The feet of strolling wearers move for up to 1 s."""
LONGEST_STANCE = 1.0
"""Longest stance of walking, s. A longer stance, or a heel that is loaded for longer, does not change thresholds."""
LONGEST_GAP = 0.3
"""Longest time between two samples of one stance or motion, s."""
HOLD_TIME, NO_CONTOUR_TIME, LOAD_VALID_TIME = 0.03, 0.1, 0.05
"""Longest times, s: of fast contours within a stance; of a loaded heel without slow contours; for which a load is used.

After the second time the gyroscope decides."""


@frozen
class GyroscopeSettings:
    """Settings of `GyroscopeMagnitude`."""

    below: float = 0.25
    """Lowest threshold, rad/s."""
    first: float = 0.5
    """Threshold until enough stances of walking are known, rad/s."""
    ceiling: float = 1.5
    """Highest threshold, except in a motion longer than `LONGEST_MOTION`, rad/s."""
    margin: float = 1.8
    """Ratio of the wearer's own threshold to the lowest rates of the wearer's stances."""
    lasting: float = 0.03
    """Time for which the rate must be below the threshold until the foot is taken to stand, s."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s."""


@define
class GyroscopeMagnitude(Detector):
    """Detector: the foot stands while the sensor hardly turns.

    A stance starts when the angular rate |w| has stayed below a threshold for `lasting`. It ends when |w| rises above
    `RELEASE_RATIO` times the lowest rate of the stance or `below`, whichever is higher. The statistic is |w|, rad/s.
    Latency: `lasting`.

    The paper says only that angular velocity was used. Published thresholds of |w| are 0.5 rad/s in code after Tunca et
    al. 2017 (Sensors 17, 825) and 0.6 rad/s in the code of Fischer et al. 2013 (IEEE Pervasive Computing 12). Shoes
    differ: in the recordings at hand the rate in the stillest 30 ms of a stance is 0.03 to 0.2 rad/s in a tied shoe and
    0.3 to 1.2 in loose insoles and shoes, while the rate in the swing of smooth walkers falls to 0.3 at moments. So
    each wearer has an own threshold: `margin` times the median of the lowest rates of the last `KEPT_STANCES` stances
    of walking, limited to `below` ... `ceiling`. Before there are enough stances, `first` counts as one more value. At
    `below` a sensor 12 cm from the heel's end moves at 3 cm/s.

    A motion longer than `STANCE_OVERDUE` contains an undetected stance. Then the threshold rises to `margin` times the
    lowest rate of that motion. After `LONGEST_MOTION` this is multiplied by the motion's duration over `LONGEST_MOTION`
    and has no ceiling, so every motion ends."""

    settings: GyroscopeSettings = GyroscopeSettings()
    t: float | None = field(default=None, init=False)
    """Time of the last sample, s."""
    recent_rates: deque[tuple[float, float]] = field(factory=deque, init=False)
    """Magnitude |w|, rad/s, and time, s, of the samples of the last `lasting` s."""
    t_start: float = field(default=0.0, init=False)
    """Start of the present stance or motion, s."""
    standing: bool = field(default=False, init=False)
    """Flag: the foot stands."""
    lowest_rate: float | None = field(default=None, init=False)
    """Least value in this stance or motion of the maximum of |w| over `lasting`, rad/s."""
    levels: tuple[float, ...] = field(default=(), init=False)
    """Lowest rates of the last stances of walking, rad/s."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        x, y, z = gyro
        rate = sqrt(x * x + y * y + z * z)
        if self.t is None or not self.t < t <= self.t + LONGEST_GAP:
            self.recent_rates.clear()
            self.t_start, self.standing, self.lowest_rate = t, False, None
        self.t = t
        highest_rate = self._highest(t, rate)
        if self.standing:
            self.lowest_rate = (
                rate
                if self.lowest_rate is None
                else min(self.lowest_rate, rate if highest_rate is None else highest_rate)
            )
            if rate >= RELEASE_RATIO * max(self.settings.below, self.lowest_rate):
                if t - self.t_start < LONGEST_STANCE:
                    self.levels = (*self.levels[1 - KEPT_STANCES :], self.lowest_rate)
                self.t_start, self.standing, self.lowest_rate = t, False, None
        elif highest_rate is not None:
            motion_time = t - self.t_start
            if motion_time > HEEL_RISE_TIME and (self.lowest_rate is None or highest_rate < self.lowest_rate):
                self.lowest_rate = highest_rate
            if highest_rate < self._threshold(motion_time):
                self.t_start, self.standing, self.lowest_rate = t, True, highest_rate
        if self.standing:
            return Stance(ZERO, self.settings.sigma, rate, Phase.STATIONARY)
        return Stance(ZERO, inf, rate, None)

    def _highest(self, t: float, rate: float) -> float | None:
        """Return the maximum of |w| over the last `lasting` s, rad/s; None before samples cover that time."""
        recent_rates = self.recent_rates
        recent_rates.append((rate, t))
        oldest = t - self.settings.lasting + TIME_EPSILON
        while len(recent_rates) > 1 and recent_rates[1][1] <= oldest:
            recent_rates.popleft()
        if recent_rates[0][1] > oldest:
            return None
        return max(recent_rates)[0]

    def _threshold(self, motion_time: float) -> float:
        """Return the threshold for a foot that has moved for `motion_time` s, rad/s."""
        settings = self.settings
        levels = [settings.margin * level for level in self.levels]
        if len(levels) < KEPT_STANCES:
            levels.append(settings.first)
        levels.sort()
        usual_threshold = min(max(settings.below, levels[len(levels) // 2]), settings.ceiling)
        if motion_time < STANCE_OVERDUE or self.lowest_rate is None:
            return usual_threshold
        motion_threshold = settings.margin * self.lowest_rate
        if motion_time < LONGEST_MOTION:
            return max(usual_threshold, min(motion_threshold, settings.ceiling))
        return max(usual_threshold, motion_threshold * motion_time / LONGEST_MOTION)


@frozen
class ContourVelocitySettings:
    """Settings of `ContourVelocity`."""

    threshold: float = 0.004
    """Threshold v_thrsh of (3), m/s: in the paper the bias of its sensors."""
    margin: float = 1.5
    """Ratio of the wearer's own threshold to the slowest contours in the wearer's stances."""
    leave: float = 0.020
    """Speed of the contours above which a stance ends, m/s."""
    loaded: float = 0.12
    """Load from which on the heel is loaded, as a share of the full load."""
    sigma: float = 0.01
    """Noise of the zero velocity of a stance, m/s."""


@define
class ContourVelocity(Detector):
    """Detector: the shoe stands while the contours of the loaded heel are slower than a threshold (3).

    The stance ends when they have been faster than `leave` for longer than `HOLD_TIME`, or when the heel is no longer
    loaded. The statistic is the speed of the contours, m/s. `leave` is higher than `threshold`, because contours are
    noisy with the small load near heel-off, and because a foot that has stood does not move while its heel bears
    weight. Latency: 50 ms, that of `Contours`.

    With loose insoles whose cells have no known scale the contours never stop. In the slowest moments of stances they
    move at 1 to 25 mm/s in the recordings at hand; the paper's threshold is the bias of its own sensors. So the
    wearer's own threshold is `margin` times the median of the slowest speeds in the last `KEPT_STANCES` stances of
    walking, limited to `threshold` ... `leave`. The contours of a rolling foot are ten times as fast.

    The gyroscope decides when there are no contours (no cells, unknown places, too few cells under the heel), and while
    the full load is not known. For a foot on the ground it also decides

    - when the heel has been loaded for `NO_CONTOUR_TIME` without slow contours: in a tight bend the heel stands on its
      edge, and the contours extend beyond the cells;
    - when contours have not been slow for `STANCE_OVERDUE`, as in feet that walk on their toes.

    After `LONGEST_MOTION` it decides for a foot in the air, too, so that no motion lasts longer than by the gyroscope.
    If loads are less frequent than inertial samples, the last evidence is used for up to `LOAD_VALID_TIME`."""

    settings: ContourVelocitySettings = ContourVelocitySettings()
    contours: Contours = field(factory=Contours)
    baseline: GyroscopeMagnitude = field(factory=GyroscopeMagnitude)
    lacking: str | None = field(default=None, init=False)
    """Reason, as a sentence, for which the gyroscope always decides; None if it does not."""
    cell_count: int = field(default=0, init=False)
    """Number of cells of the layout; 0 without a layout."""
    tare: list[float] = field(factory=list, init=False)
    """Mean values of the cells that contours use while the foot is in the air, unit of the samples."""
    tare_count: int = field(default=0, init=False)
    """Number of samples in the air, up to `TARE_SAMPLES`."""
    standing: bool = field(default=False, init=False)
    """Flag: the contours of the loaded heel are slow."""
    still_t: float | None = field(default=None, init=False)
    """Last time with slow contours since the heel was loaded, or the time of loading, s; None if it is not loaded."""
    landed_t: float = field(default=0.0, init=False)
    """Time from which the heel has been loaded, s."""
    rest_t: float | None = field(default=None, init=False)
    """Last time with slow contours, or the time of the first load, s."""
    slowest_speed: float | None = field(default=None, init=False)
    """Slowest speed of the contours since the heel was loaded, m/s."""
    levels: tuple[float, ...] = field(default=(), init=False)
    """Slowest speeds of the contours in the last stances of walking, m/s."""
    load_phase: Phase | None = field(default=None, init=False)
    """Hint of the last load."""
    evidence_t: float | None = field(default=None, init=False)
    """Time of the last load with evidence, s; None while the gyroscope decides."""
    speed: float = field(default=0.0, init=False)
    """Statistic of the last load, m/s."""

    def set_layout(self, layout: Layout) -> None:
        reason = self.contours.set_layout(layout)
        self.lacking = None if reason is None else f"{reason}; the gyroscope says when the foot stands"
        self.cell_count = len(layout.cells)
        self.tare = [0.0] * len(self.contours.cells)
        self.tare_count = 0
        self.standing = False
        self.still_t = self.rest_t = self.slowest_speed = self.evidence_t = None
        self.levels = ()

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        gyroscope_stance = self.baseline.update(t, dt, acc, gyro, load, attitude)
        if load is not None:
            self.evidence_t = None
            if load.heel is not None and self.contours.points and len(load.cells) == self.cell_count:
                self._add_load(t, load, load.heel)
        if self.evidence_t is None or not self.evidence_t <= t < self.evidence_t + LOAD_VALID_TIME:
            return gyroscope_stance
        sigma = self.settings.sigma if self.load_phase is Phase.STATIONARY else inf
        return Stance(ZERO, sigma, self.speed, self.load_phase)

    def _add_load(self, t: float, load: Load, heel: float) -> None:
        """Update the evidence by a load; leave it unset if the gyroscope decides."""
        if self.rest_t is None or self.rest_t > t:
            self.rest_t = t
        if heel < self.settings.loaded:
            self._end_landing(t)
            if load.airborne:
                self._update_tare(load.cells)
            time_since_rest = t - self.rest_t
            if time_since_rest < (LONGEST_MOTION if load.airborne else STANCE_OVERDUE):
                self._set_evidence(t, Phase.SWING if load.airborne else None, 0.0)
            return
        cells = load.cells
        loads = [cells[i] - zero for i, zero in zip(self.contours.cells, self.tare, strict=True)]
        velocity = self.contours.velocity(t, loads)
        if self.still_t is None or self.still_t > t:
            self.still_t = self.landed_t = t
        speed = hypot(*(velocity or ZERO))
        if velocity is not None:
            if self.slowest_speed is None or speed < self.slowest_speed:
                self.slowest_speed = speed
            if speed <= (self.settings.leave if self.standing else self._threshold()):
                self.standing = True
                self.still_t = self.rest_t = t
        self.standing = self.standing and t - self.still_t <= HOLD_TIME + TIME_EPSILON
        if self.standing:
            self._set_evidence(t, Phase.STATIONARY, speed)
        elif t - self.still_t < NO_CONTOUR_TIME - TIME_EPSILON and t - self.rest_t < STANCE_OVERDUE:
            self._set_evidence(t, None, speed)

    def _set_evidence(self, t: float, load_phase: Phase | None, speed: float) -> None:
        self.load_phase, self.evidence_t, self.speed = load_phase, t, speed

    def _end_landing(self, t: float) -> None:
        """End a contact of the heel: keep its slowest speed, and discard the contours."""
        if self.still_t is not None and self.slowest_speed is not None and t - self.landed_t < LONGEST_STANCE:
            self.levels = (*self.levels[1 - KEPT_STANCES :], self.slowest_speed)
        self.standing, self.still_t, self.slowest_speed = False, None, None
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
