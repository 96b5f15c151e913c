"""An elevator ride: the motion of the car from one floor to another.

Speed, acceleration and jerk are limited (Peters 1995, "Ideal lift kinematics", Elevator Technology 6). The acceleration
rises linearly, is constant and falls linearly. The car then runs at constant speed and slows down in the same way.
Elevators of few storeys run at 1.0 to 1.6 m/s with 0.6 to 1.2 m/s^2 and a jerk of about 1 m/s^3.

The car vibrates on its rails. VIBRATION_AMPLITUDE is of the order of measurements by ISO 18738-1 in
elevators in good order: 10 to 15 milli-g from peak to peak. The frequencies between 2 and 12 Hz are assumed."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from ..wearers.curves import Array, Rng

VIBRATION_AMPLITUDE = (0.012, 0.012, 0.018)
"""Amplitude of each of the SINES_PER_AXIS sines of the vibration along x, y and z, m/s^2."""
SINES_PER_AXIS = 3
"""Number of sines of the vibration along each axis."""
VIBRATION_BAND = (2.0, 12.0)
"""Frequency range of the vibration, Hz."""
FADE_TIME = 0.5
"""Time in which the vibration starts and ends, s."""
BISECTIONS = 60
"""Number of bisections that find the top speed of a short ride."""

_JerkPhase = tuple[float, float]
"""Duration of a phase of constant jerk, s, and the jerk, m/s^3."""


@frozen
class Elevator:
    """The parameters of an elevator ride; a short ride does not reach the largest values."""

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


@frozen(eq=False)
class CarRide:
    """The motion of the car in one elevator ride."""

    start: float
    """Time at which the car starts, s."""
    end: float
    """Time at which the car stops, s."""
    height: float
    """Height of the ride, m; negative downwards."""
    knots: Array
    """Times after `start` at which the jerk changes, s, (n)."""
    state: Array
    """Height, m, speed, m/s, acceleration, m/s^2, and jerk, m/s^3, from each knot on, (n, 4); positive upwards."""
    waves: Array
    """Amplitude, m/s^2, angular frequency, rad/s, and phase, rad, of the vibration, (3 axes, SINES_PER_AXIS, 3)."""

    def at(self, t: Array) -> tuple[Array, Array, Array]:
        """Return displacement, velocity and acceleration of the car at `t`, (N, 3) each, world frame, SI units."""
        elapsed = np.asarray(t, dtype=np.float64) - self.start
        inside = (elapsed > 0.0) & (elapsed < self.end - self.start)
        position, velocity, acceleration = (np.zeros((len(elapsed), 3)) for _ in range(3))
        k = np.clip(np.searchsorted(self.knots, elapsed, side="right") - 1, 0, len(self.knots) - 1)
        s = elapsed - self.knots[k]
        z, v, a, j = self.state[k].T
        position[:, 2] = np.where(inside, z + s * (v + s * (a / 2.0 + s * j / 6.0)), self.height * (elapsed > 0.0))
        velocity[:, 2] = np.where(inside, v + s * (a + s * j / 2.0), 0.0)
        acceleration[:, 2] = np.where(inside, a + s * j, 0.0)
        add_vibration(elapsed, inside, self.end - self.start, self.waves, (position, velocity, acceleration))
        return position, velocity, acceleration


def add_vibration(
    elapsed: Array, inside: NDArray[np.bool_], duration: float, waves: Array, motion: Sequence[Array]
) -> None:
    """Add the vibration of a ride of `duration` s to position, velocity and acceleration, (N, 3) each, where `inside`.

    `elapsed` (N) is the time since the start, s, and `waves` are those of `CarRide`."""
    position, velocity, acceleration = motion
    fade, slope, bend = _fade(elapsed[inside], duration)
    for axis in range(3):
        for size, w, phase in waves[axis]:
            # A sine of acceleration `size` has the position size / w^2; the product rule applies the fade.
            displacement = np.sin(w * elapsed[inside] + phase) * size / w**2
            turn = np.cos(w * elapsed[inside] + phase) * size / w
            position[inside, axis] += fade * displacement
            velocity[inside, axis] += slope * displacement + fade * turn
            acceleration[inside, axis] += bend * displacement + 2.0 * slope * turn - fade * w**2 * displacement


def draw_waves(rng: Rng) -> Array:
    """Return a random vibration: amplitude, angular frequency and phase as in `CarRide.waves`."""
    size = np.array(VIBRATION_AMPLITUDE)[:, None] * np.ones(SINES_PER_AXIS)
    turning = 2.0 * np.pi * np.asarray(rng.uniform(*VIBRATION_BAND, (3, SINES_PER_AXIS)))
    phase = np.asarray(rng.uniform(0.0, 2.0 * np.pi, (3, SINES_PER_AXIS)))
    return np.stack((size, turning, phase), axis=2)


def _fade(elapsed: Array, duration: float) -> tuple[Array, Array, Array]:
    """Return a factor that rises from 0 to 1 within FADE_TIME s and falls at the end, and its two derivatives."""
    margin = np.minimum(elapsed, duration - elapsed)
    sign = np.where(elapsed < duration - elapsed, 1.0, -1.0)
    u = np.minimum(margin / FADE_TIME, 1.0)
    return (
        u**3 * (10.0 - 15.0 * u + 6.0 * u**2),
        sign * 30.0 * u**2 * (1.0 - u) ** 2 / FADE_TIME,
        60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / FADE_TIME**2,
    )


def ride(elevator: Elevator, start: float, rng: Rng) -> CarRide:
    """Return the ride of an elevator whose car starts at `start`, s; `rng` draws the vibration."""
    up = 1.0 if elevator.height > 0.0 else -1.0
    knots, rows = [0.0], [(0.0, 0.0, 0.0, 0.0)]
    for duration, jerk in _jerk_phases(elevator):
        z, v, a, _ = rows[-1]
        rows[-1] = (z, v, a, jerk)
        z += duration * (v + duration * (a / 2.0 + duration * jerk / 6.0))
        v, a = v + duration * (a + duration * jerk / 2.0), a + duration * jerk
        knots.append(knots[-1] + duration)
        rows.append((z, v, a, 0.0))
    return CarRide(start, start + knots[-1], elevator.height, np.array(knots), up * np.array(rows), draw_waves(rng))


def _jerk_phases(elevator: Elevator) -> list[_JerkPhase]:
    """Return the phases of constant jerk of the whole ride, as if it went upwards, in order."""
    distance, top_speed = abs(elevator.height), elevator.speed
    if _least_distance(top_speed, elevator) > distance:
        low = 0.0
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + top_speed)
            low, top_speed = (low, middle) if _least_distance(middle, elevator) > distance else (middle, top_speed)
        top_speed = low
    change = _speed_change(top_speed, elevator)
    steady = (distance - _least_distance(top_speed, elevator)) / top_speed
    found = [*change, (steady, 0.0), *((duration, -jerk) for duration, jerk in change)]
    return [(duration, jerk) for duration, jerk in found if duration > 0.0]


def _least_distance(top_speed: float, elevator: Elevator) -> float:
    """Return the least distance, m, of a ride that reaches `top_speed`, m/s.

    A change of speed is symmetric about its middle: its mean speed is the mean of the speeds at its ends."""
    return top_speed * sum(duration for duration, _ in _speed_change(top_speed, elevator))


def _speed_change(difference: float, elevator: Elevator) -> list[_JerkPhase]:
    """Return the phases of constant jerk that change the speed by `difference` m/s."""
    peak = min(elevator.acceleration, sqrt(difference * elevator.jerk))
    return [
        (peak / elevator.jerk, elevator.jerk),
        (difference / peak - peak / elevator.jerk, 0.0),
        (peak / elevator.jerk, -elevator.jerk),
    ]
