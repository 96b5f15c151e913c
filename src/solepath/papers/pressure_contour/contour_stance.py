"""Stance evidence of Bebek et al. 2010: the heel's pressure contours or, as baseline, the gyroscope.

"Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans. Instrum. Meas. 59,
2010). `PrintedContour` is (3) with the levels of fig. 4 and nothing else; `ContourVelocity` has our additions. Numbers
without a source were chosen by hand."""

from __future__ import annotations

from math import inf

from ...foot.settings import CycleSettings
from ...foot.stance.cycle import Cycle
from ...foot.stance.shoe import ShoeDetector
from ...foot.stance.stance import Detector, Load, Stance
from ...types import Layout, Phase, Quat, Vec3
from ...types.attrs import field, state, stateful
from ...types.vector import IDENTITY, TIME_EPSILON, ZERO
from .contour import PAPER_LEVELS, Contours, ContourSettings

THRESHOLD = 0.004
"""Threshold v_thrsh of (3), m/s: the "velocity sensing bias" of 4 mm/s of figure 7 and table II."""
LEAVE = 0.020
"""Speed of the contours above which a stance of `ContourVelocity` ends, m/s."""
SIGMA = 0.01
"""Noise of the zero velocity of a stance, m/s; the recipes' corrector sets the velocity to zero whatever it is."""
HEEL_LOADED = 0.12
"""Load from which on the heel is loaded, as a share of the full load."""
HOLD_TIME, NO_CONTOUR_TIME, LOAD_VALID_TIME = 0.03, 0.1, 0.05
"""Longest times, s: of fast contours within a stance; of a loaded heel without slow contours; for which a load is used.

After the second time the gyroscope decides."""
STANCE_OVERDUE = 1.0
"""Time after which a motion must contain an undetected stance, s: the feet of strolling wearers move for up to 1 s."""
TARE_SAMPLES = 200
"""Number of samples in the air that the tare averages: several swings, because a swung shoe presses unevenly."""
PRINTED_LIMIT = (
    "as printed, stances are missed and strides joined: contours of 20 to 70 kPa move under a heel at rest "
    "(pressure-contour has other levels)"
)
"""What `PrintedContour` cannot do, as a sentence."""
RATE_POSITION = 0.3
"""Position of the threshold of the gyroscope between the lowest and the highest mean square of the last gait cycle (0
to 1, in logarithms).

From 0.1 to 0.3 emulated heels at rest move at 1.2 to 1.9 mm/s, at 0.45 at 4 mm/s."""


@stateful
class AngularRate(ShoeDetector):
    """The statistic of `ShoeDetector` without its acceleration: the mean square of the angular rate."""

    def mean_squares(self, t: float, acc: Vec3, gyro: Vec3) -> tuple[float, float]:
        return 0.0, ShoeDetector.mean_squares(self, t, acc, gyro)[1]


@stateful
class GyroscopeMagnitude(Cycle):
    """Detector: the foot stands while the sensor hardly turns, compared with the wearer's last gait cycle.

    The paper says only that angular velocity was used. Published thresholds of |w| are 0.5 rad/s in code after Tunca et
    al. 2017 (Sensors 17, 825) and 0.6 rad/s in the code of Fischer et al. 2013 (IEEE Pervasive Computing 12). Shoes
    differ: in the recordings at hand the rate in the stillest 30 ms of a stance is 0.03 to 0.2 rad/s in a tied shoe and
    0.3 to 1.2 in loose insoles and shoes. So the threshold is that of `Cycle`. Latency: 25 ms."""

    settings: CycleSettings = field(
        default=CycleSettings(threshold_position=RATE_POSITION, noise_per_rate_square=0.0, rolls=False)
    )
    shoe: AngularRate = state(factory=AngularRate)

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        return Cycle.update(self, t, dt, acc, gyro, None, attitude)


@stateful
class PrintedContour(Detector):
    """Detector as printed: the shoe stands while the contours of 20 to 70 kPa are slower than 4 mm/s (3).

    The statistic is the speed of the contours, m/s; `NO_CONTOUR` without a contour. Latency: 50 ms, that of `Contours`.

    Levels in kPa need cells of known places and a known scale. Without them nothing of (3) can be computed, a
    Limitation says so, and the gyroscope decides. It also decides for samples with fewer cells than the layout, and
    before the first step, because cells are reported from then on (pressure/insole.py). With them a Limitation says
    that (3) misses stances."""

    settings: ContourSettings = field(default=ContourSettings(pascals=PAPER_LEVELS))
    contours: Contours = field(init=False)
    gyroscope: GyroscopeMagnitude = state(factory=GyroscopeMagnitude)
    lacking: str | None = None
    """Sentence about what this detector cannot do; None if nothing is known."""

    def __attrs_post_init__(self) -> None:
        self.contours = Contours(self.settings)

    def set_layout(self, layout: Layout) -> None:
        reason = self.contours.set_layout(layout)
        self.lacking = PRINTED_LIMIT if reason is None else f"{reason}; the gyroscope says when the foot stands"

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        by_rate = self.gyroscope.update(t, dt, acc, gyro, None, attitude)
        if load is None or not self.contours.points or max(self.contours.cells) >= len(load.cells):
            return by_rate
        speed = self.contours.speed(t, [load.cells[i] for i in self.contours.cells])
        return Stance(ZERO, SIGMA, speed, Phase.STATIONARY) if speed <= THRESHOLD else Stance(ZERO, inf, speed, None)


@stateful
class ContourVelocity(PrintedContour):
    """Detector: the shoe stands while the contours of the loaded heel are slower than a threshold (3).

    The stance ends when they have been faster than `LEAVE` for longer than `HOLD_TIME`, or when the heel is no longer
    loaded: contours are noisy with the small load near heel-off, and a foot that has stood does not move while its heel
    bears weight. Levels are shares of the heel's mean pressure, so the cells need no scale. Latency: 50 ms, that of
    `Contours`.

    The gyroscope decides when there are no contours (no cells, unknown places, too few cells under the heel), and while
    the full load is not known. It also decides

    - when the heel has been loaded for `NO_CONTOUR_TIME` without slow contours: in a tight bend the heel stands on its
      edge, and the contours extend beyond the cells;
    - when contours have not been slow for `STANCE_OVERDUE`, as in feet that walk on their toes.

    If loads are less frequent than inertial samples, the last evidence is used for up to `LOAD_VALID_TIME`."""

    settings: ContourSettings = field(default=ContourSettings())
    tare: list[float] = state(factory=list)
    """Mean values of the cells that contours use while the foot is in the air, unit of the samples."""
    tare_count: int = 0
    """Number of samples in the air, up to `TARE_SAMPLES`."""
    standing: bool = False
    """Flag: the contours of the loaded heel are slow."""
    landed_t: float | None = None
    """Time from which the heel has been loaded, s; None if it is not."""
    slow_t: float | None = None
    """Last time with slow contours, or the time of the first load, s."""
    decides: bool = False
    """Flag: the last load decides; if False, the gyroscope does."""
    speed: float = 0.0
    """Speed of the contours by the last load, m/s; 0 without load on the heel."""
    airborne: bool = False
    """Flag: the foot is in the air by the last load."""
    load_t: float = 0.0
    """Time of the last load, s."""

    def set_layout(self, layout: Layout) -> None:
        PrintedContour.set_layout(self, layout)
        self.lacking = None if self.lacking == PRINTED_LIMIT else self.lacking
        self.tare, self.tare_count = [0.0] * len(self.contours.cells), 0
        self.standing = self.decides = False
        self.landed_t = self.slow_t = None

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        by_rate = self.gyroscope.update(t, dt, acc, gyro, None, attitude)
        if load is not None:
            used = bool(self.contours.points) and max(self.contours.cells) < len(load.cells)
            self.load_t, self.airborne = t, load.airborne
            self.decides = load.heel is not None and used and self._judge(t, load, load.heel)
        if not self.decides or not self.load_t <= t < self.load_t + LOAD_VALID_TIME:
            return by_rate
        if self.standing:
            return Stance(ZERO, SIGMA, self.speed, Phase.STATIONARY)
        return Stance(ZERO, inf, self.speed, Phase.SWING if self.airborne else None)

    def _judge(self, t: float, load: Load, heel: float) -> bool:
        """Add a load and return whether it decides; if not, the gyroscope does."""
        if self.slow_t is None or self.slow_t > t:
            self.slow_t = t
        cells, self.speed = [load.cells[i] for i in self.contours.cells], 0.0
        if heel < HEEL_LOADED:
            self.standing, self.landed_t = False, None
            self.contours.reset()
            if load.airborne:
                self.tare_count = min(self.tare_count + 1, TARE_SAMPLES)
                k = 1.0 / self.tare_count
                self.tare = [zero + k * (value - zero) for value, zero in zip(cells, self.tare, strict=True)]
        else:
            self.speed = self.contours.speed(t, [value - zero for value, zero in zip(cells, self.tare, strict=True)])
            if self.landed_t is None or self.landed_t > t:
                self.landed_t = t
            if self.speed <= (LEAVE if self.standing else THRESHOLD):
                self.standing, self.slow_t = True, t
            self.standing = self.standing and t - self.slow_t <= HOLD_TIME + TIME_EPSILON
            if not self.standing and t - max(self.slow_t, self.landed_t) >= NO_CONTOUR_TIME - TIME_EPSILON:
                return False
        return t - self.slow_t < STANCE_OVERDUE
