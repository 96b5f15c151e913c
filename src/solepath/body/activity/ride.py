"""A lift that is ridden, felt in the feet that stand in it.

A lift adds its own acceleration to the specific force of a foot at rest: a pulse of 0.3 to 1.2 m/s^2 as it sets off and
one the other way as it stops, each a second or more long, and nothing between them. The feet's accelerometers are
wrong by more than that and by another amount in every posture, so what counts is how the force differs from that of the
same foot at rest. That level is followed by a scalar Kalman filter for each foot, and each hypothesis has its own: who
holds that the lift has just set off takes another level for that of rest than who holds that it stands.
"""

from __future__ import annotations

from math import exp, log, pi, sqrt

from attrs import define, evolve, frozen

from ...vector import GRAVITY

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
SLOWEST = 0.4
"""No lift is slower, m/s."""


@frozen
class Felt:
    """Half a second of one foot: mean |acc|, m/s^2, the variance of that mean, and whether the foot moved."""

    force: float
    variance: float
    moved: bool


@define
class Level:
    """|acc| of one foot at rest, m/s^2."""

    value: float = GRAVITY
    variance: float = LEVEL * LEVEL


@define
class Ride:
    """What a hypothesis has of a lift: all upwards positive."""

    levels: tuple[Level, ...]
    """Of the left foot and the right one."""
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

    def rest(self, felt: tuple[Felt | None, ...]) -> tuple[Ride, float]:
        """Half a second without acceleration: the ride after it, and the logarithm of how likely what was felt is."""
        seen = self._acceleration(felt)
        if seen is None:
            return self, 0.0
        acceleration, variance = seen
        regular = (1.0 - OUTLIER) * _density(acceleration, variance)
        odd = OUTLIER * _density(acceleration, variance + 1.0)
        rested = self._learnt(felt, 0.0, 0.0 if regular > odd else 1e9)
        return rested, log(regular + odd + LEAST)

    def pulse(
        self, felt: tuple[Felt | None, ...], usual: float, varies: float, block: float
    ) -> tuple[Ride, float]:
        """`block` s of acceleration, `usual` with the deviation `varies`, m/s^2."""
        seen = self._acceleration(felt)
        if seen is None:
            return self._moved(usual, block, self.levels), 0.0
        acceleration, variance = seen
        off = acceleration - usual
        likely = log(_density(off, variance + varies * varies) + LEAST)
        share = varies * varies / (varies * varies + variance)
        taken = usual + share * off
        learnt = self._learnt(felt, taken, share * variance)
        return self._moved(taken, block, learnt.levels), likely

    def walk(self, felt: tuple[Felt | None, ...]) -> tuple[Ride, float]:
        """The feet move by themselves: no lift is felt."""
        seen = self._acceleration(felt)
        levels = tuple(
            [
                level
                if one is None or not one.moved
                else Level(level.value, max(level.variance, MOVED * MOVED))
                for level, one in zip(self.levels, felt, strict=True)
            ]
        )
        walked = Ride(levels, stood=self.stood)
        if seen is None:
            return walked, 0.0
        near, far = _density(seen[0], seen[1] + 1.0), _density(seen[0], seen[1] + WIDE * WIDE)
        return walked, log((1.0 - FEET) * near + FEET * far + LEAST)

    def begun(self, whole: bool, air: float | None) -> tuple[Ride, float]:
        """A ride begins, `whole` when with its first pulse, at the height `air` in m; the logarithm of how likely it is
        that it does so now."""
        return Ride(self.levels, whole=whole, air=air), -HASTE if self.stood < DWELLS else 0.0

    def over(self) -> Ride:
        """The same levels, no ride."""
        return Ride(self.levels, stood=0.0)

    def waited(self, block: float) -> Ride:
        """`block` s more without a ride."""
        return evolve(self, stood=self.stood + block) if self.stood < DWELLS else self

    def cruise(self, block: float) -> Ride:
        """`block` s more at the same speed."""
        return self._moved(0.0, block, self.levels)

    def stopped(self) -> float:
        """Logarithm of how likely it is that a lift that moved like this stands now."""
        odd = 0.0
        if self.fastest < SLOWEST:
            odd = 0.5 * ((SLOWEST - self.fastest) / 0.1) ** 2
        if self.whole:
            odd += min(4.0, 0.5 * (self.velocity / (0.3 * self.fastest + 0.1)) ** 2)
        return -min(odd, 8.0)

    def risen(self, air: float | None) -> float | None:
        """How far it went, m: by the air pressure, where there is one; else by the pulses, taking away the drift of a
        lift that must stand in the end; None when the first was not felt. `air`: how high it is now."""
        if air is not None and self.air is not None:
            return air - self.air
        return self.height - 0.5 * self.velocity * self.lasted if self.whole else None

    def _acceleration(self, felt: tuple[Felt | None, ...]) -> tuple[float, float] | None:
        """(m/s^2, its variance) of the feet that were heard, each beside its own level; None without any."""
        total = weights = 0.0
        offs = []
        for level, one in zip(self.levels, felt, strict=True):
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

    def _learnt(self, felt: tuple[Felt | None, ...], acceleration: float, uncertain: float) -> Ride:
        """The levels after half a second in which the lift accelerated by so much, with that variance."""
        levels = []
        for level, one in zip(self.levels, felt, strict=True):
            if one is None:
                levels.append(level)
                continue
            variance = level.variance + WANDER
            if one.moved:
                variance = max(variance, MOVED * MOVED)
            gain = variance / (variance + one.variance + uncertain)
            off = one.force - acceleration - level.value
            levels.append(Level(round(level.value + gain * off, 7), round((1.0 - gain) * variance, 9)))
        return evolve(self, levels=tuple(levels))

    def _moved(self, acceleration: float, block: float, levels: tuple[Level, ...]) -> Ride:
        velocity = round(self.velocity + acceleration * block, 6)
        return evolve(
            self,
            levels=levels,
            velocity=velocity,
            fastest=max(self.fastest, abs(velocity)),
            height=round(self.height + 0.5 * (self.velocity + velocity) * block, 6),
            lasted=self.lasted + block,
        )


def _density(off: float, variance: float) -> float:
    """Of a normal distribution."""
    return exp(-0.5 * min(off * off / variance, 1400.0)) / sqrt(2.0 * pi * variance)
