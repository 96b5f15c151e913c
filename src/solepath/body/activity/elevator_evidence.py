"""Evidence of a moving elevator: the specific force ("force" in this file, m/s^2) on standing feet.

An elevator adds its own acceleration to the force on a foot at rest: a pulse of 0.3 to 1.2 m/s^2 when it sets off, and
a pulse in the other direction when it stops. Each pulse lasts a second or more; between them the acceleration is zero.
The errors of accelerometers are larger than that and differ in every posture. The evidence is therefore the difference
between the force and the rest level, which is the force on the same foot at rest. A scalar Kalman filter estimates the
rest level of each foot. Each hypothesis has its own filters, because "the elevator sets off" and "it stands" explain
the same force by different levels. Accelerations are positive upwards."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from math import exp, log, pi, sqrt
from operator import is_
from typing import Any, TypeVar, cast

from ...types.attrs import define
from ...types.vector import GRAVITY

PULSE_ACCELERATION, PULSE_DEVIATION = 0.6, 0.35
"""Mean and standard deviation of the acceleration of an elevator that starts or stops, m/s^2."""
HALT_ACCELERATION, HALT_DEVIATION = 0.25, 0.15
"""Mean and standard deviation of the acceleration of an elevator that has crept on to its floor and stops, m/s^2.

It creeps at 0.1 to 0.25 m/s and stops within half a second or a second; lifts of hugadb show 0.1 to 0.45."""
SWAY_DEVIATION = 0.03
"""Standard deviation of the mean force over half a second of a standing wearer, m/s^2."""
FIRST_LEVEL_DEVIATION = 0.4
"""Standard deviation of |acc| of a sensor at rest from 1 g, when nothing else is known of the sensor, m/s^2.

A count of the sensor is added to it: the offset of coarse ones may be two counts (Kionix KXTJ9: 125 mg at 8 bits)."""
UNKNOWN_VARIANCE = 1e4
"""Variance of a rest level of which nothing is known, (m/s^2)^2; with the first block, `first_variance` limits it."""
MOVED_LEVEL_DEVIATION = 0.08
"""Standard deviation of a rest level after the foot has moved, m/s^2; a new posture changes the error."""
LEVEL_WANDER = 1e-5
"""Growth of the variance of a rest level in each half second, (m/s^2)^2."""
OUTLIER_SHARE = 0.03
"""Share of blocks at rest with a standard deviation of 1 m/s^2, because the wearer shifts weight or lifts a heel."""
MOVING_OUTLIER_SHARE = 0.2
"""Share of blocks of moving feet that deviate by `MOVING_OUTLIER`."""
MOVING_OUTLIER = 8.0
"""Standard deviation of these blocks, m/s^2; it is 1 m/s^2 for other blocks of moving feet."""
LARGEST_LEAN = 0.25
"""Largest horizontal part of the force on a foot that rests in an elevator, m/s^2.

In elevators 1 % of half seconds have more than 0.1 (hugadb); in a car half have more than 0.3."""
LEAST_DENSITY = 1e-6
"""Lowest probability density of an acceleration, s^2/m."""


@define
class BlockForce:
    """The force on one foot in half a second: mean |acc|, m/s^2, and its variance, (m/s^2)^2."""

    force: float
    variance: float
    moved: bool
    """Flag: the foot moved in the block."""
    resolution: float = 0.0
    """Resolution of the accelerometer, m/s^2 per count; 0 when it is not known."""
    lean: float = 0.0
    """Part of the force across its mean direction since the foot came to rest, m/s^2."""

    @property
    def first_variance(self) -> float:
        """Largest variance of a rest level, that of a foot of which nothing else is known, (m/s^2)^2."""
        return FIRST_LEVEL_DEVIATION * FIRST_LEVEL_DEVIATION + self.resolution * self.resolution

    @property
    def posture_variance(self) -> float:
        """Variance of the rest level after the foot has moved, (m/s^2)^2; rounding is another one in each posture."""
        return MOVED_LEVEL_DEVIATION * MOVED_LEVEL_DEVIATION + self.resolution * self.resolution / 12.0


@define
class RestLevel:
    """The estimated |acc| of one foot at rest, m/s^2, and its variance, (m/s^2)^2."""

    value: float = GRAVITY
    variance: float = UNKNOWN_VARIANCE


RestLevels = tuple[RestLevel, ...]
"""Rest levels of the left foot and of the right foot, in this order."""


Method = TypeVar("Method", bound=Callable[..., Any])


def _once(compute: Method) -> Method:
    """Return a method of `ElevatorEvidence` that computes its result for the same levels and prior once."""

    @wraps(compute)
    def find(self: ElevatorEvidence, levels: RestLevels, *prior: float) -> Any:
        key = (compute, id(levels), *prior)
        if key not in self.found:
            self.found[key] = compute(self, levels, *prior)
        return self.found[key]

    return cast(Method, find)


class ElevatorEvidence:
    """The forces on both feet in half a second, compared with their levels at rest.

    Most paths share the same `RestLevels` object, so each result is computed once and cached. An instance is used
    for one block only and is not part of the state."""

    __slots__ = ("forces", "found")

    def __init__(self, forces: tuple[BlockForce | None, ...]) -> None:
        self.forces = forces
        # keys are ids of levels; they stay valid because tokens hold the levels longer than this object exists
        self.found: dict[tuple[object, ...], Any] = {}

    @property
    def leans(self) -> bool | None:
        """Whether the force leans on all feet that rest, as no elevator makes it; None if none rests."""
        leans = [block.lean > LARGEST_LEAN for block in self.forces if block is not None and not block.moved]
        return all(leans) if leans else None

    @_once
    def add_rest(self, levels: RestLevels) -> tuple[RestLevels, float]:
        """Return the levels after a block without acceleration, and the log-likelihood of the forces."""
        excess = self.estimate_acceleration(levels)
        if excess is None:
            return levels, 0.0
        acceleration, variance = excess
        regular = (1.0 - OUTLIER_SHARE) * _density(acceleration, variance)
        stray = OUTLIER_SHARE * _density(acceleration, variance + 1.0)
        # the variance of 1e9 keeps a stray block from changing the levels
        return self._update_levels(levels, 0.0, 0.0 if regular > stray else 1e9), log(regular + stray + LEAST_DENSITY)

    @_once
    def add_pulse(self, levels: RestLevels, mean: float, deviation: float) -> tuple[RestLevels, float, float]:
        """Return the levels after a block of a pulse, its acceleration, m/s^2, and the log-likelihood of the forces.

        `mean` and `deviation` are the prior of the acceleration, m/s^2."""
        excess = self.estimate_acceleration(levels)
        if excess is None:
            return levels, mean, 0.0
        acceleration, variance = excess
        residual = acceleration - mean
        log_likelihood = log(_density(residual, variance + deviation * deviation) + LEAST_DENSITY)
        share = deviation * deviation / (deviation * deviation + variance)
        pulse_acceleration = mean + share * residual
        return self._update_levels(levels, pulse_acceleration, share * variance), pulse_acceleration, log_likelihood

    @_once
    def add_walking(self, levels: RestLevels) -> tuple[RestLevels, float]:
        """Return the levels after a block of moving feet, and the log-likelihood of the forces outside an elevator."""
        excess = self.estimate_acceleration(levels)
        walked = tuple(
            [
                level
                if block is None or not block.moved or level.variance >= block.posture_variance
                else RestLevel(level.value, block.posture_variance)
                for level, block in zip(levels, self.forces, strict=True)
            ]
        )
        if all(map(is_, walked, levels)):
            walked = levels
        if excess is None:
            return walked, 0.0
        near = _density(excess[0], excess[1] + 1.0)
        far = _density(excess[0], excess[1] + MOVING_OUTLIER * MOVING_OUTLIER)
        return walked, log((1.0 - MOVING_OUTLIER_SHARE) * near + MOVING_OUTLIER_SHARE * far + LEAST_DENSITY)

    @_once
    def estimate_acceleration(self, levels: RestLevels) -> tuple[float, float] | None:
        """Return the mean force above the rest levels, m/s^2, and its variance, (m/s^2)^2; None without samples."""
        total = weights = 0.0
        residuals = []
        for level, block in zip(levels, self.forces, strict=True):
            if block is not None:
                residual = block.force - level.value
                weight = 1.0 / (min(level.variance, block.first_variance) + block.variance)
                residuals.append((residual, 1.0 / weight))
                total += weight * residual
                weights += weight
        if weights == 0.0:
            return None
        variance = 1.0 / weights
        if len(residuals) == 2:  # an elevator moves both feet alike
            (a, va), (b, vb) = residuals
            variance += 0.25 * max(0.0, (a - b) * (a - b) - va - vb)
        return total / weights, variance

    def _update_levels(self, levels: RestLevels, acceleration: float, acceleration_variance: float) -> RestLevels:
        """Return the levels after half a second in which the elevator has this acceleration, m/s^2."""
        updated = []
        for level, block in zip(levels, self.forces, strict=True):
            if block is None:
                updated.append(level)
                continue
            variance = min(level.variance, block.first_variance) + LEVEL_WANDER
            if block.moved:
                variance = max(variance, block.posture_variance)
            gain = variance / (variance + block.variance + acceleration_variance)
            residual = block.force - acceleration - level.value
            updated.append(RestLevel(round(level.value + gain * residual, 7), round((1.0 - gain) * variance, 9)))
        return tuple(updated)


def _density(residual: float, variance: float) -> float:
    """Return the density of a normal distribution with mean 0."""
    return bell(residual, variance) / sqrt(2.0 * pi * variance)


def bell(residual: float, variance: float) -> float:
    """Return the density of a normal distribution with mean 0, relative to that of the mean."""
    return exp(-0.5 * min(residual * residual / variance, 1e3))
