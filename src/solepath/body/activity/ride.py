"""Lift rides, detected by the force on standing feet.

A lift adds its own acceleration to the specific force of a foot at rest: a pulse of 0.3 to 1.2 m/s^2 as it sets off and
one in the other direction as it stops, each a second or more long, and nothing between them. The errors of the feet's
accelerometers are larger than that and differ in every posture, so the evidence is the difference to the force of the
same foot at rest. A scalar Kalman filter follows that level for each foot, and each hypothesis has its own: a
hypothesis that the lift has just set off takes another level for that of rest than one that it stands."""

from __future__ import annotations

from math import exp, log, pi, sqrt
from operator import is_

from ...types.attrs import define
from ...types.vector import GRAVITY

PULSE = 0.6
"""Usual acceleration of a lift that starts or stops, m/s^2."""
PULSE_DEVIATION = 0.35
"""Standard deviation of that acceleration over a pulse and from lift to lift, m/s^2."""
HALT = 0.15
"""Usual acceleration of a lift that has crept on to its floor and stops, m/s^2."""
HALT_DEVIATION = 0.08
"""Standard deviation of that acceleration, m/s^2."""
FIRST_DEVIATION = 0.4
"""Standard deviation of |acc| of a sensor at rest from 1 g before anything is known of it, m/s^2."""
MOVED_DEVIATION = 0.08
"""Standard deviation of the level after the foot has moved, m/s^2: the posture and the axes' share of errors change."""
LEVEL_WANDER = 1e-5
"""Growth of the variance of the level in each half second, (m/s^2)^2."""
SWAY_DEVIATION = 0.03
"""Standard deviation of the mean force over half a second of a standing wearer, m/s^2."""
OUTLIER_SHARE = 0.03
"""Share of blocks at rest that deviate by 1 m/s^2: weight is shifted, a heel is lifted."""
MOVING_OUTLIER_SHARE = 0.2
"""Share of blocks of moving feet that deviate by `MOVING_OUTLIER`."""
MOVING_OUTLIER = 8.0
"""Standard deviation of these blocks, m/s^2; that of the other blocks of moving feet is 1."""
DWELL_TIME = 5.0
"""Least usual time between two rides, s: a lift opens and closes its doors before it sets off again."""
SHORT_DWELL_COST = 6.0
"""Minus log-likelihood of a shorter time between two rides."""
LEAST_DENSITY = 1e-6
"""Lowest probability density, s^2/m."""
PULSE_HEIGHT_ERROR = 0.1
"""Error of a ride's height by its pulses, as a share of it."""
AIR_HEIGHT_ERROR = 0.3
"""Error of a ride's height by the air pressure, m: readings of a second or two at either end."""
SLOWEST_LIFT = 0.4
"""Speed of the slowest lift, m/s."""


@define
class BlockForce:
    """The force on one foot in half a second: mean |acc|, m/s^2, its variance, and whether the foot moved."""

    force: float
    variance: float
    moved: bool


@define
class RestLevel:
    """The level of |acc| of one foot at rest, m/s^2, and its variance."""

    value: float = GRAVITY
    variance: float = FIRST_DEVIATION * FIRST_DEVIATION


Levels = tuple[RestLevel, ...]
"""Levels of the left foot and the right one."""


class LiftEvidence:
    """The forces on both feet in half a second, compared with their levels at rest.

    Most courses hold the very same levels, and then the result is computed once. The object lasts no longer than the
    half second, and is no state."""

    __slots__ = ("_acceleration", "_pulses", "_still", "_walks", "forces")

    def __init__(self, forces: tuple[BlockForce | None, ...]) -> None:
        self.forces = forces
        # keyed by the identity of levels, which a token holds as long as this object lasts
        self._acceleration: dict[int, tuple[float, float] | None] = {}
        self._still: dict[int, tuple[Levels, float]] = {}
        self._walks: dict[int, tuple[Levels, float]] = {}
        self._pulses: dict[tuple[int, float], tuple[Levels, float, float]] = {}

    def rest(self, levels: Levels) -> tuple[Levels, float]:
        """Return the levels after a block without acceleration, and the log-likelihood of the forces."""
        known = self._still.get(id(levels))
        if known is None:
            known = self._still[id(levels)] = self._rest(levels)
        return known

    def _rest(self, levels: Levels) -> tuple[Levels, float]:
        seen = self.acceleration(levels)
        if seen is None:
            return levels, 0.0
        acceleration, variance = seen
        regular = (1.0 - OUTLIER_SHARE) * _density(acceleration, variance)
        odd = OUTLIER_SHARE * _density(acceleration, variance + 1.0)
        return self._updated_levels(levels, 0.0, 0.0 if regular > odd else 1e9), log(regular + odd + LEAST_DENSITY)

    def pulse(self, levels: Levels, mean: float, deviation: float) -> tuple[Levels, float, float]:
        """Return the levels after a block of a pulse, its acceleration, m/s^2, and the log-likelihood of the forces.

        The acceleration of the pulse has this `mean` and `deviation`, m/s^2."""
        known = self._pulses.get((id(levels), mean))
        if known is None:
            known = self._pulses[id(levels), mean] = self._pulse(levels, mean, deviation)
        return known

    def _pulse(self, levels: Levels, mean: float, deviation: float) -> tuple[Levels, float, float]:
        seen = self.acceleration(levels)
        if seen is None:
            return levels, mean, 0.0
        acceleration, variance = seen
        off = acceleration - mean
        likely = log(_density(off, variance + deviation * deviation) + LEAST_DENSITY)
        share = deviation * deviation / (deviation * deviation + variance)
        taken = mean + share * off
        return self._updated_levels(levels, taken, share * variance), taken, likely

    def walk(self, levels: Levels) -> tuple[Levels, float]:
        """Return the levels after a block of moving feet, and the log-likelihood of the forces; no lift is detected."""
        known = self._walks.get(id(levels))
        if known is None:
            known = self._walks[id(levels)] = self._walk(levels)
        return known

    def _walk(self, levels: Levels) -> tuple[Levels, float]:
        seen = self.acceleration(levels)
        walked = tuple(
            [
                level
                if one is None or not one.moved or level.variance >= MOVED_DEVIATION * MOVED_DEVIATION
                else RestLevel(level.value, MOVED_DEVIATION * MOVED_DEVIATION)
                for level, one in zip(levels, self.forces, strict=True)
            ]
        )
        if all(map(is_, walked, levels)):
            walked = levels
        if seen is None:
            return walked, 0.0
        near, far = _density(seen[0], seen[1] + 1.0), _density(seen[0], seen[1] + MOVING_OUTLIER * MOVING_OUTLIER)
        return walked, log((1.0 - MOVING_OUTLIER_SHARE) * near + MOVING_OUTLIER_SHARE * far + LEAST_DENSITY)

    def acceleration(self, levels: Levels) -> tuple[float, float] | None:
        """Return the acceleration of the feet against their levels, m/s^2, and its variance; None without samples."""
        if id(levels) not in self._acceleration:
            self._acceleration[id(levels)] = self._accelerated(levels)
        return self._acceleration[id(levels)]

    def _accelerated(self, levels: Levels) -> tuple[float, float] | None:
        total = weights = 0.0
        offs = []
        for level, one in zip(levels, self.forces, strict=True):
            if one is not None:
                off = one.force - level.value
                weight = 1.0 / (level.variance + one.variance)
                offs.append((off, 1.0 / weight))
                total += weight * off
                weights += weight
        if weights == 0.0:
            return None
        variance = 1.0 / weights
        if len(offs) == 2:  # a lift moves both feet alike
            (a, va), (b, vb) = offs
            variance += 0.25 * max(0.0, (a - b) * (a - b) - va - vb)
        return total / weights, variance

    def _updated_levels(self, levels: Levels, acceleration: float, uncertain: float) -> Levels:
        """Return the levels after half a second with this acceleration of the lift, whose variance is `uncertain`."""
        updated = []
        for level, one in zip(levels, self.forces, strict=True):
            if one is None:
                updated.append(level)
                continue
            variance = level.variance + LEVEL_WANDER
            if one.moved:
                variance = max(variance, MOVED_DEVIATION * MOVED_DEVIATION)
            gain = variance / (variance + one.variance + uncertain)
            off = one.force - acceleration - level.value
            updated.append(RestLevel(round(level.value + gain * off, 7), round((1.0 - gain) * variance, 9)))
        return tuple(updated)


@define
class LiftRide:
    """The state of a lift in one hypothesis, upwards positive."""

    levels: Levels
    velocity: float = 0.0
    """Velocity of the lift, m/s."""
    fastest: float = 0.0
    """Largest speed so far, m/s."""
    height: float = 0.0
    """Height since the lift set off, m."""
    duration: float = 0.0
    """Duration of the ride so far, s."""
    whole: bool = False
    """Flag: the first pulse was measured."""
    air: float | None = None
    """Height when the lift set off, by the air pressure, m above any reference."""
    standing_time: float = 1e3
    """Time since the last ride ended, s."""

    @staticmethod
    def start(whole: bool, air: float | None, levels: Levels, acceleration: float, block: float) -> LiftRide:
        """Return a ride after its first `block` s; `whole`: with its first pulse.

        `air` is the height at the start, m; for the others see `move`."""
        velocity = round(0.0 + acceleration * block, 6)
        return LiftRide(levels, velocity, abs(velocity), round(0.0 + 0.5 * velocity * block, 6), block, whole, air)

    def move(self, levels: Levels, acceleration: float, block: float) -> LiftRide:
        """Return the ride after `block` s more with this acceleration, m/s^2, and the levels after it."""
        before = self.velocity
        velocity = round(before + acceleration * block, 6)
        fast = abs(velocity)
        return LiftRide(
            levels,
            velocity,
            fast if fast > self.fastest else self.fastest,
            round(self.height + 0.5 * (before + velocity) * block, 6),
            self.duration + block,
            self.whole,
            self.air,
            self.standing_time,
        )

    def wait(self, levels: Levels, block: float) -> LiftRide:
        """Return the ride after `block` s without one and the levels after it; the last ride's values are kept."""
        standing_time = self.standing_time
        if standing_time < DWELL_TIME:
            standing_time += block
        elif levels is self.levels:
            return self
        return LiftRide(
            levels, self.velocity, self.fastest, self.height, self.duration, self.whole, self.air, standing_time
        )

    def end(self) -> LiftRide:
        """Return the state after the end of the ride, with the same levels."""
        return LiftRide(self.levels, standing_time=0.0)

    def stop_score(self) -> float:
        """Return the log-likelihood that a lift that moved like this stands now."""
        odd = 0.0
        if self.fastest < SLOWEST_LIFT:
            odd = 0.5 * ((SLOWEST_LIFT - self.fastest) / 0.1) ** 2
        if self.whole:
            odd += min(4.0, 0.5 * (self.velocity / (0.3 * self.fastest + 0.1)) ** 2)
        return -min(odd, 8.0)

    def height_gain(self, air: float | None) -> float | None:
        """Return the height of the ride, m; None without air pressure and first pulse. `air`: height now, m.

        The height by the pulses, without the drift of a lift that must stand in the end, and the height by the air
        pressure are weighted by their variances."""
        by_air = None if air is None or self.air is None else air - self.air
        if not self.whole:
            return by_air
        by_pulses = self.height - 0.5 * self.velocity * self.duration
        if by_air is None:
            return by_pulses
        share = (
            AIR_HEIGHT_ERROR
            * AIR_HEIGHT_ERROR
            / (AIR_HEIGHT_ERROR * AIR_HEIGHT_ERROR + (PULSE_HEIGHT_ERROR * by_air) ** 2)
        )
        return by_air + share * (by_pulses - by_air)


def _density(off: float, variance: float) -> float:
    """Return the density of a normal distribution."""
    return exp(-0.5 * min(off * off / variance, 1400.0)) / sqrt(2.0 * pi * variance)
