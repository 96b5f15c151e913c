"""Stance evidence by the SHOE statistic, relative to each gait cycle: `Cycle`, the default detector.

No single threshold suits a stroll and a run: from stance to swing, the SHOE statistic goes from 10^3 to 10^7 in a
stroll, and from 10^5 to 10^8 in a run. So stillness is judged relative to the wearer's own last gait cycle. The
threshold lies between the lowest and the highest statistic of the last 1.2 to 1.6 s, at a fixed position in logarithms.

The noise of the evidence follows from the motion: a foot that turns at w rad/s about a point of the sole at distance
r m moves the sensor at r w. The known part of this velocity follows from the height of the sensor above the sole
(`SensorHeight`); it is the reference velocity. The unknown part is noise. It grows with w^2, so that the many samples
of early and late stance do not outweigh those of mid-stance.

The settings (settings.py) were chosen by hand on the recordings of docs/accuracy.md. `solepath-lab evaluate
--ablation` gives the accuracy without whole terms: one threshold for all, evidence of one noise, zero velocity for a
foot that rolls, no extra noise for a foot that brakes."""

from __future__ import annotations

from math import exp, inf, log, sqrt

from ...types import Quat, Vec2, Vec3
from ...types.attrs import NOT_SAVED, define, field, state, stateful
from ...types.vector import IDENTITY, TIME_EPSILON, ZERO
from ..phase import STATIONARY, SWING
from ..settings import CycleSettings
from .shoe import ACC_SQUARE, GYRO_SQUARE, ShoeDetector
from .stance import Detector, Load, Stance

make_stance = tuple.__new__
"""Constructor of a Stance from its five fields, which takes half the time of the class's own."""

NO_STATISTIC = 1e12
"""Upper bound of any statistic, which stands for the lowest one before any sample."""


Sums = tuple[float, ...]
"""State of a stance, 18 numbers, in the units of `SensorHeight`.

They are: number of samples, time; last acceleration x, y; u x, y; sums of t and t^2; sums of c^2 and u c over both
axes; sums of u, t u, c and t c, each on x and on y."""
EMPTY: Sums = (0.0,) * 18
"""State of a stance without samples."""

INITIAL_HEIGHT = 0.05
"""Height before any stance, m: between that of a sensor in the sole and that of one on the instep."""
INITIAL_WEIGHT = 0.005
"""Weight of the initial height as a sum of c^2 dt, (rad/s)^2 s: half of what a slow stance gives."""
STANCE_MEMORY = 0.95
"""Factor by which each stance reduces the weight of the earlier ones."""
SHORTEST_STANCE, LONGEST_STANCE = 0.06, 0.6
"""Shortest and longest stance that is used, s.

A longer stance is cut into pieces, because the integral of the acceleration drifts."""
LOWEST_HEIGHT, HIGHEST_HEIGHT = -0.03, 0.2
"""Limits of the estimated height, m."""


@define
class SensorHeight:
    """The height of a sensor above the point over which the foot rolls, learnt from the wearer's own stances.

    A foot on the ground is never quite still. It rolls over heel, sole and forefoot, and a sensor at distance r from
    the point of contact moves at v = w x r. On the instep of a brisk walker this is 5 cm/s at the stillest moment, so
    zero velocity makes every stride some per cent too short.

    The height h of the sensor need not be configured, because the accelerometer measures the same motion: within one
    stance, the change of velocity is the change of w x r. Let c = w x up, rad/s, and let u be the integral of the
    acceleration, m/s; both are horizontal. The tilt is not known exactly, so u has an error that grows evenly. The
    equation

        u(t) = h c(t) + a + b t

    is fitted by least squares to each stance. h is pooled over the stances, with less weight for older ones. The
    numbers were chosen by hand on the recordings of docs/accuracy.md and not swept."""

    height: float = INITIAL_HEIGHT
    """Current estimate of the height, m."""
    product: float = INITIAL_HEIGHT * INITIAL_WEIGHT
    """Weighted sum of u c dt over the stances, m (rad/s)^2 s."""
    square: float = INITIAL_WEIGHT
    """Weighted sum of c^2 dt over the stances, (rad/s)^2 s."""
    sums: Sums = EMPTY
    """State of the current stance."""

    def roll(self, dt: float, acc: Vec3, gyro: Vec3, attitude: Quat) -> Vec2:
        """Add one sample of a foot on the ground; return h w x up, the velocity x, y, m/s, navigation frame.

        `acc` is in m/s^2, `gyro` in rad/s, both in the sensor frame. `attitude` is sensor to navigation frame."""
        w, x, y, z = attitude
        # the first two rows of the rotation matrix
        xx, xy, xz = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)
        yx, yy, yz = 2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
        wx, wy, wz = gyro
        fx, fy, fz = acc
        cx, cy = yx * wx + yy * wy + yz * wz, -(xx * wx + xy * wy + xz * wz)
        ax, ay = xx * fx + xy * fy + xz * fz, yx * fx + yy * fy + yz * fz
        n, t, bx, by, ux, uy, st, stt, scc, suc, sux, suy, stux, stuy, scx, scy, stcx, stcy = self.sums
        if n:
            t += dt
            ux += 0.5 * dt * (ax + bx)
            uy += 0.5 * dt * (ay + by)
        self.sums = (
            n + 1.0, t, ax, ay, ux, uy, st + t, stt + t * t, scc + cx * cx + cy * cy, suc + ux * cx + uy * cy,
            sux + ux, suy + uy, stux + t * ux, stuy + t * uy, scx + cx, scy + cy, stcx + t * cx, stcy + t * cy,
        )  # fmt: skip
        if t > LONGEST_STANCE + TIME_EPSILON:
            self.end_stance()
        return self.height * cx, self.height * cy

    def end_stance(self) -> None:
        """End the stance and update the height from it."""
        n, t, _, _, _, _, st, stt, scc, suc, sux, suy, stux, stuy, scx, scy, stcx, stcy = self.sums
        self.sums = EMPTY
        d = n * stt - st * st
        if t < SHORTEST_STANCE - TIME_EPSILON or n < 5.0 or d <= 0.0:
            return
        # sums of u c and c^2 after the best a + b t was subtracted from u and c, axis by axis
        square = (
            scc
            - (stt * (scx * scx + scy * scy) - 2.0 * st * (scx * stcx + scy * stcy) + n * (stcx * stcx + stcy * stcy))
            / d
        )
        product = (
            suc
            - (
                stt * (sux * scx + suy * scy)
                - st * (sux * stcx + stux * scx + suy * stcy + stuy * scy)
                + n * (stux * stcx + stuy * stcy)
            )
            / d
        )
        if (
            square <= 0.0
            or not 2.0 * LOWEST_HEIGHT - HIGHEST_HEIGHT < product / square < 2.0 * HIGHEST_HEIGHT - LOWEST_HEIGHT
        ):
            return  # no sensor on a foot has this height, so it was no stance
        dt = t / n
        self.square = STANCE_MEMORY * self.square + square * dt
        self.product = STANCE_MEMORY * self.product + product * dt
        self.height = min(max(self.product / self.square, LOWEST_HEIGHT), HIGHEST_HEIGHT)


@stateful
class Cycle(Detector):
    """Compares the SHOE statistic with a threshold from the last gait cycle; the noise follows from the motion.

    Latency: 25 ms. The statistic has no unit: SHOE divides each mean square by that of the sensor's noise (shoe.py).
    Time is divided into spans of equal duration. The extremes are those of the last three spans and the current one."""

    settings: CycleSettings = field(default=CycleSettings())
    sensor_height: SensorHeight = state(factory=SensorHeight)
    shoe: ShoeDetector = state(factory=ShoeDetector)
    span_end: float | None = None
    """End of the current span, s; None before any."""
    lows: tuple[float, float, float] = (NO_STATISTIC, NO_STATISTIC, NO_STATISTIC)
    """Lowest statistic of each of the last three spans."""
    highs: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Highest statistic of each of the last three spans."""
    lowest: float = NO_STATISTIC
    """Lowest statistic of the current span."""
    highest: float = 0.0
    """Highest statistic of the current span."""
    past_low: float = NO_STATISTIC
    """Lowest statistic of the last three spans together."""
    past_high: float = 0.0
    """Highest statistic of the last three spans together."""
    threshold: float | None = state(default=None, metadata=NOT_SAVED)
    """Threshold by the extremes of all four spans; None until it is asked for after one of them has changed."""

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, load: Load | None, attitude: Quat = IDENTITY
    ) -> Stance:
        force, rate = self.shoe.mean_squares(t, acc, gyro)
        statistic = force / ACC_SQUARE + rate / GYRO_SQUARE
        # lowest and highest statistic of the current span
        if self.span_end is None or t >= self.span_end - TIME_EPSILON:
            self._start_span(t, statistic)
        elif statistic < self.lowest:
            self.lowest = statistic
            if statistic < self.past_low:
                self.threshold = None
        elif statistic > self.highest:
            self.highest = statistic
            if statistic > self.past_high:
                self.threshold = None
        if load is not None and load.airborne:
            self.sensor_height.end_stance()
            return make_stance(Stance, (ZERO, inf, statistic, SWING, None))
        settings = self.settings
        if statistic < settings.least_threshold:
            hint = STATIONARY if statistic < settings.standing_statistic else None
        elif statistic > (self._find_threshold() if self.threshold is None else self.threshold):
            if self.sensor_height.sums[0]:
                self.sensor_height.end_stance()
            return make_stance(Stance, (ZERO, inf, statistic, None, None))
        else:
            hint = None
        variance = (
            settings.sigma * settings.sigma
            + settings.noise_per_rate_square * settings.noise_per_rate_square * rate * rate
            + (
                settings.noise_per_acceleration * settings.noise_per_acceleration
                + settings.noise_per_acceleration_square * settings.noise_per_acceleration_square * force
            )
            * force
        )
        if not settings.rolls:
            return make_stance(Stance, (ZERO, sqrt(variance), statistic, hint, None))
        vx, vy = self.sensor_height.roll(dt, acc, gyro, attitude)
        return make_stance(Stance, ((vx, vy, 0.0), sqrt(variance), statistic, hint, None))

    def _find_threshold(self) -> float:
        """Return the threshold between the extremes, and keep it until one of them changes."""
        lowest, highest, least_statistic = self.lowest, self.highest, self.settings.least_statistic
        if self.past_low < lowest:
            lowest = self.past_low
        if lowest < least_statistic:
            lowest = least_statistic
        if self.past_high > highest:
            highest = self.past_high
        threshold_position = self.settings.threshold_position
        self.threshold = exp((1.0 - threshold_position) * log(lowest) + threshold_position * log(highest))
        return self.threshold

    def _start_span(self, t: float, statistic: float) -> None:
        """Start the next span at `t`, s, with its first statistic."""
        if self.span_end is not None:
            self.lows = (self.lows[1], self.lows[2], self.lowest)
            self.highs = (self.highs[1], self.highs[2], self.highest)
            self.past_low = min(self.lows)
            self.past_high = max(self.highs)
        self.span_end = t + self.settings.span_duration
        self.lowest = self.highest = statistic
        self.threshold = None
