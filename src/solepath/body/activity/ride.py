"""A lift that is ridden, felt in the feet that stand in it.

A lift adds its own acceleration to the specific force of a foot at rest: a pulse of 0.3 to 1.2 m/s^2 as it sets off and
one the other way as it stops, each a second or more long, and nothing between them. The feet's accelerometers are
wrong by more than that and by another amount in every posture, so what counts is how the force differs from that of the
same foot at rest. That level is followed by a scalar Kalman filter for each foot, and each hypothesis has its own: who
holds that the lift has just set off takes another level for that of rest than who holds that it stands.
"""

from __future__ import annotations

from math import exp, log, pi, sqrt
from operator import is_

from ...types.attrs import define
from ...types.vector import GRAVITY

USUAL = 0.6
"""Acceleration of a lift that starts or stops, m/s^2, and"""
VARIES = 0.35
"""its deviation over a pulse and from lift to lift."""
HALT = 0.15
"""The same of one that has crept on to its floor, and stops, and"""
HALT_VARIES = 0.08
"""its deviation."""
LEVEL = 0.4
"""Deviation of |acc| of a sensor at rest from 1 g before anything is known of it, m/s^2."""
MOVED = 0.08
"""and after the foot has moved: another posture, another share of the axes' errors, m/s^2."""
WANDER = 1e-5
"""By which the variance of the level grows each half second, (m/s^2)^2."""
SWAY = 0.03
"""Deviation of the mean over half a second of somebody who stands, m/s^2."""
OUTLIER = 0.03
"""Share of blocks at rest that deviate by 1 m/s^2: weight is shifted, a heel is lifted."""
FEET = 0.2
"""Share of blocks of feet that move by themselves that deviate by"""
WIDE = 8.0
"""so much, m/s^2; the others by 1."""
DWELLS = 5.0
"""A lift opens and closes its doors before it sets off again: that takes longer, s,"""
HASTE = 6.0
"""or is so much less likely (natural logarithm)."""
LEAST = 1e-6
"""No density is less, s^2/m."""
PULSES = 0.1
"""A ride's height by its pulses is wrong by this share of it,"""
AIR = 0.3
"""and by the air pressure by so much: readings of a second or two at either end, m."""
SLOWEST = 0.4
"""No lift is slower, m/s."""


@define
class Felt:
    """Half a second of one foot: mean |acc|, m/s^2, the variance of that mean, and whether the foot moved."""

    force: float
    variance: float
    moved: bool


@define
class RestLevel:
    """|acc| of one foot at rest, m/s^2."""

    value: float = GRAVITY
    variance: float = LEVEL * LEVEL


Levels = tuple[RestLevel, ...]
"""Of the left foot and the right one."""


class Beside:
    """Half a second of both feet beside their levels at rest.

    Most courses hold the very same levels, and then what comes of them is worked out once. It lasts no longer than the
    half second, and is no state.
    """

    __slots__ = ("_acceleration", "_pulses", "_rests", "_walks", "felt")

    def __init__(self, felt: tuple[Felt | None, ...]) -> None:
        self.felt = felt
        # by the identity of levels, which somebody holds as long as this lasts
        self._acceleration: dict[int, tuple[float, float] | None] = {}
        self._rests: dict[int, tuple[Levels, float]] = {}
        self._walks: dict[int, tuple[Levels, float]] = {}
        self._pulses: dict[tuple[int, float], tuple[Levels, float, float]] = {}

    def rest(self, levels: Levels) -> tuple[Levels, float]:
        """Without acceleration: the levels after it, and the logarithm of how likely what was felt is."""
        known = self._rests.get(id(levels))
        if known is None:
            known = self._rests[id(levels)] = self._rest(levels)
        return known

    def _rest(self, levels: Levels) -> tuple[Levels, float]:
        seen = self.acceleration(levels)
        if seen is None:
            return levels, 0.0
        acceleration, variance = seen
        regular = (1.0 - OUTLIER) * _density(acceleration, variance)
        odd = OUTLIER * _density(acceleration, variance + 1.0)
        return self._learnt(levels, 0.0, 0.0 if regular > odd else 1e9), log(regular + odd + LEAST)

    def pulse(self, levels: Levels, usual: float, varies: float) -> tuple[Levels, float, float]:
        """Of an acceleration `usual` with the deviation `varies`, m/s^2: levels, what it was, logarithm as above."""
        known = self._pulses.get((id(levels), usual))
        if known is None:
            known = self._pulses[id(levels), usual] = self._pulse(levels, usual, varies)
        return known

    def _pulse(self, levels: Levels, usual: float, varies: float) -> tuple[Levels, float, float]:
        seen = self.acceleration(levels)
        if seen is None:
            return levels, usual, 0.0
        acceleration, variance = seen
        off = acceleration - usual
        likely = log(_density(off, variance + varies * varies) + LEAST)
        share = varies * varies / (varies * varies + variance)
        taken = usual + share * off
        return self._learnt(levels, taken, share * variance), taken, likely

    def walk(self, levels: Levels) -> tuple[Levels, float]:
        """Of feet that move by themselves: no lift is felt."""
        known = self._walks.get(id(levels))
        if known is None:
            known = self._walks[id(levels)] = self._walk(levels)
        return known

    def _walk(self, levels: Levels) -> tuple[Levels, float]:
        seen = self.acceleration(levels)
        walked = tuple(
            [
                level
                if one is None or not one.moved or level.variance >= MOVED * MOVED
                else RestLevel(level.value, MOVED * MOVED)
                for level, one in zip(levels, self.felt, strict=True)
            ]
        )
        if all(map(is_, walked, levels)):
            walked = levels
        if seen is None:
            return walked, 0.0
        near, far = _density(seen[0], seen[1] + 1.0), _density(seen[0], seen[1] + WIDE * WIDE)
        return walked, log((1.0 - FEET) * near + FEET * far + LEAST)

    def acceleration(self, levels: Levels) -> tuple[float, float] | None:
        """(m/s^2, its variance) of the feet that were heard, each beside its own level; None without any."""
        if id(levels) not in self._acceleration:
            self._acceleration[id(levels)] = self._accelerated(levels)
        return self._acceleration[id(levels)]

    def _accelerated(self, levels: Levels) -> tuple[float, float] | None:
        total = weights = 0.0
        offs = []
        for level, one in zip(levels, self.felt, strict=True):
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

    def _learnt(self, levels: Levels, acceleration: float, uncertain: float) -> Levels:
        """After half a second in which the lift accelerated by so much, with that variance."""
        learnt = []
        for level, one in zip(levels, self.felt, strict=True):
            if one is None:
                learnt.append(level)
                continue
            variance = level.variance + WANDER
            if one.moved:
                variance = max(variance, MOVED * MOVED)
            gain = variance / (variance + one.variance + uncertain)
            off = one.force - acceleration - level.value
            learnt.append(RestLevel(round(level.value + gain * off, 7), round((1.0 - gain) * variance, 9)))
        return tuple(learnt)


@define
class LiftRide:
    """What a hypothesis has of a lift: all upwards positive."""

    levels: Levels
    velocity: float = 0.0
    """m/s."""
    fastest: float = 0.0
    """Largest so far, m/s."""
    height: float = 0.0
    """Since it set off, m."""
    lasted: float = 0.0
    """s."""
    whole: bool = False
    """The first pulse was felt."""
    air: float | None = None
    """How high it was when it set off, m above anything, by the air pressure."""
    stood: float = 1e3
    """Since the last ride ended, s."""

    @staticmethod
    def begins(whole: bool, air: float | None, levels: Levels, acceleration: float, block: float) -> LiftRide:
        """The first `block` s of a ride, `whole` when with its first pulse, at the height `air` in m; the others as in
        `goes`."""
        velocity = round(0.0 + acceleration * block, 6)
        return LiftRide(levels, velocity, abs(velocity), round(0.0 + 0.5 * velocity * block, 6), block, whole, air)

    def goes(self, levels: Levels, acceleration: float, block: float) -> LiftRide:
        """`block` s more with this acceleration, m/s^2, and the levels after it."""
        before = self.velocity
        velocity = round(before + acceleration * block, 6)
        fast = abs(velocity)
        return LiftRide(
            levels,
            velocity,
            fast if fast > self.fastest else self.fastest,
            round(self.height + 0.5 * (before + velocity) * block, 6),
            self.lasted + block,
            self.whole,
            self.air,
            self.stood,
        )

    def stands(self, levels: Levels, block: float) -> LiftRide:
        """`block` s more without a ride: the levels after it. What there was of one is kept."""
        stood = self.stood
        if stood < DWELLS:
            stood += block
        elif levels is self.levels:
            return self
        return LiftRide(levels, self.velocity, self.fastest, self.height, self.lasted, self.whole, self.air, stood)

    def over(self) -> LiftRide:
        """The same levels, no ride."""
        return LiftRide(self.levels, stood=0.0)

    def stopped(self) -> float:
        """Logarithm of how likely it is that a lift that moved like this stands now."""
        odd = 0.0
        if self.fastest < SLOWEST:
            odd = 0.5 * ((SLOWEST - self.fastest) / 0.1) ** 2
        if self.whole:
            odd += min(4.0, 0.5 * (self.velocity / (0.3 * self.fastest + 0.1)) ** 2)
        return -min(odd, 8.0)

    def risen(self, air: float | None) -> float | None:
        """How far it went, m: by the pulses, taking away the drift of a lift that must stand in the end, and by the air
        pressure, each as far as it is sure; None when there is no air and the first pulse was not felt. `air`: how high
        it is now."""
        by_air = None if air is None or self.air is None else air - self.air
        if not self.whole:
            return by_air
        felt = self.height - 0.5 * self.velocity * self.lasted
        if by_air is None:
            return felt
        share = AIR * AIR / (AIR * AIR + (PULSES * by_air) ** 2)
        return by_air + share * (felt - by_air)


def _density(off: float, variance: float) -> float:
    """Of a normal distribution."""
    return exp(-0.5 * min(off * off / variance, 1400.0)) / sqrt(2.0 * pi * variance)
