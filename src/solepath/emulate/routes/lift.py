"""The ride of a lift: the motion of its car from one floor to another.

Speed, acceleration and jerk are limited (Peters 1995, "Ideal lift kinematics", Elevator Technology 6): the acceleration
rises linearly, is constant and falls linearly; the car then runs at constant speed and slows down in the same way.
Lifts of few storeys run at 1.0 to 1.6 m/s with 0.6 to 1.2 m/s^2 and a jerk of about 1 m/s^3. Some approach the floor at
a very low speed over the last centimetres.

On its rails the car vibrates: SHAKE is of the order of the 10 to 15 milli-g from peak to peak that measurements by ISO
18738-1 find in lifts in good order. The frequencies between 2 and 12 Hz are assumed."""

from __future__ import annotations

from math import sqrt

import numpy as np
from attrs import frozen

from ..wearers.curves import Array, Rng

SHAKE = (0.012, 0.012, 0.018)
"""Amplitude of each of the WAVES sines of the vibration along x, y and z, m/s^2."""
WAVES = 3
"""Number of sines of the vibration along each axis."""
BAND = (2.0, 12.0)
"""Frequency range of the vibration, Hz."""
FADE_TIME = 0.5
"""Time in which the vibration starts and ends, s."""
CREEP_TIME = 1.0
"""Time for which a car runs at its creep speed, s."""
HALVINGS = 60
"""Number of bisections that find the top speed of a short ride."""

_Ramp = tuple[float, float]
"""A duration, s, with a constant jerk, m/s^3."""


@frozen
class Lift:
    """The parameters of a lift ride; a short ride does not reach the limits."""

    height: float
    """Height of the ride, m; negative downwards."""
    speed: float = 1.0
    """Largest speed, m/s."""
    acceleration: float = 0.8
    """Largest acceleration, m/s^2."""
    jerk: float = 1.0
    """Largest jerk, m/s^3."""
    doors: float = 2.5
    """Time that the doors take to close before the ride, and to open after it, s."""
    creep: float = 0.0
    """Speed of the approach to the floor, m/s; 0: none."""


@frozen(eq=False)
class CarRide:
    """The motion of a lift's car in one ride."""

    start: float
    """Time at which the car starts, s."""
    end: float
    """Time at which the car stops, s."""
    height: float
    """Height of the ride, m; negative downwards."""
    knots: Array
    """Times after `start` at which the jerk changes, s, (n)."""
    state: Array
    """Height, m, speed, m/s, acceleration, m/s^2, and jerk, m/s^3, at the knots, (n, 4)."""
    waves: Array
    """Amplitude, m/s^2, angular frequency, rad/s, and phase, rad, of the vibration along x, y, z, (3, WAVES, 3)."""

    def at(self, t: Array) -> tuple[Array, Array, Array]:
        """Return displacement, m, velocity, m/s, and acceleration, m/s^2, of the car at times `t`, s, (N, 3) each."""
        since = np.asarray(t, dtype=np.float64) - self.start
        inside = (since > 0.0) & (since < self.end - self.start)
        position, velocity, acceleration = (np.zeros((len(since), 3)) for _ in range(3))
        k = np.clip(np.searchsorted(self.knots, since, side="right") - 1, 0, len(self.knots) - 1)
        s = since - self.knots[k]
        z, v, a, j = self.state[k].T
        position[:, 2] = np.where(inside, z + s * (v + s * (a / 2.0 + s * j / 6.0)), self.height * (since > 0.0))
        velocity[:, 2] = np.where(inside, v + s * (a + s * j / 2.0), 0.0)
        acceleration[:, 2] = np.where(inside, a + s * j, 0.0)
        fade, slope, bend = self._fade(since[inside])
        for axis in range(3):
            for size, w, phase in self.waves[axis]:
                # A sine of acceleration `size` has the position size / w^2; the product rule applies the fade.
                swing = np.sin(w * since[inside] + phase) * size / w**2
                turn = np.cos(w * since[inside] + phase) * size / w
                position[inside, axis] += fade * swing
                velocity[inside, axis] += slope * swing + fade * turn
                acceleration[inside, axis] += bend * swing + 2.0 * slope * turn - fade * w**2 * swing
        return position, velocity, acceleration

    def _fade(self, since: Array) -> tuple[Array, Array, Array]:
        """Return a factor from 0 to 1 within FADE_TIME s and back to 0 at the end, with its first two derivatives."""
        away = np.minimum(since, self.end - self.start - since)
        sign = np.where(since < self.end - self.start - since, 1.0, -1.0)
        u = np.minimum(away / FADE_TIME, 1.0)
        return (
            u**3 * (10.0 - 15.0 * u + 6.0 * u**2),
            sign * 30.0 * u**2 * (1.0 - u) ** 2 / FADE_TIME,
            60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / FADE_TIME**2,
        )


def ride(lift: Lift, start: float, rng: Rng) -> CarRide:
    """Return the ride of `lift` with the car's start at time `start`, s; `rng` draws the vibration."""
    up = 1.0 if lift.height > 0.0 else -1.0
    knots, rows = [0.0], [(0.0, 0.0, 0.0, 0.0)]
    for duration, jerk in _ramps(lift):
        z, v, a, _ = rows[-1]
        rows[-1] = (z, v, a, jerk)
        z += duration * (v + duration * (a / 2.0 + duration * jerk / 6.0))
        v, a = v + duration * (a + duration * jerk / 2.0), a + duration * jerk
        knots.append(knots[-1] + duration)
        rows.append((z, v, a, 0.0))
    size = np.array(SHAKE)[:, None] * np.ones(WAVES)
    turning = 2.0 * np.pi * np.asarray(rng.uniform(*BAND, (3, WAVES)))
    phase = np.asarray(rng.uniform(0.0, 2.0 * np.pi, (3, WAVES)))
    waves = np.stack((size, turning, phase), axis=2)
    return CarRide(start, start + knots[-1], lift.height, np.array(knots), up * np.array(rows), waves)


def _ramps(lift: Lift) -> list[_Ramp]:
    """Return the jerks of the whole ride upwards, in order."""
    way = abs(lift.height)
    creep = min(lift.creep, 0.1 * way)
    top = lift.speed
    if _covered(top, creep, lift) > way:
        low = creep
        for _ in range(HALVINGS):
            middle = 0.5 * (low + top)
            low, top = (low, middle) if _covered(middle, creep, lift) > way else (middle, top)
        top = low
    slow, stop = _change(top - creep, lift), _change(creep, lift)
    found = [*_change(top, lift), ((way - _covered(top, creep, lift)) / top, 0.0), *((d, -j) for d, j in slow)]
    found += [(CREEP_TIME if creep > 0.0 else 0.0, 0.0), *((d, -j) for d, j in stop)]
    return [ramp for ramp in found if ramp[0] > 0.0]


def _covered(top: float, creep: float, lift: Lift) -> float:
    """Return the least distance, m, of a ride that reaches `top` m/s."""
    lasts = [sum(duration for duration, _ in _change(by, lift)) for by in (top, top - creep, creep)]
    # A change of speed is symmetric about its middle: its mean speed is the mean of the speeds at its ends.
    return 0.5 * (top * lasts[0] + (top + creep) * lasts[1] + creep * lasts[2]) + creep * CREEP_TIME


def _change(by: float, lift: Lift) -> list[_Ramp]:
    """Return the jerks that change the speed by `by` m/s."""
    if by <= 0.0:
        return []
    top = min(lift.acceleration, sqrt(by * lift.jerk))
    return [(top / lift.jerk, lift.jerk), (by / top - top / lift.jerk, 0.0), (top / lift.jerk, -lift.jerk)]
