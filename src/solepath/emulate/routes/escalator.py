"""An escalator: steps that move at constant speed along level ends, two bends and an incline of 30 degrees.

Measures are those of EN 115-1: an incline of 30 degrees, 0.5 m/s, steps 0.38 m deep and at most 0.24 m high, which are
level at both ends over 0.8 m or more, and bends of 1 m radius or more. In a bend the vertical acceleration is v^2 / r,
0.25 m/s^2 for a second: a weak pulse like that of an elevator.

What is idealised: the ground under both feet starts and stops within BOARDING_TIME, as if both stepped on and off at
once. A wearer who walks on the escalator climbs all steps in one flight from its first end to the last, at a pace of
stairs; the speed of the steps is fitted to the time that this takes."""

from __future__ import annotations

from math import cos, radians, sin, tan

import numpy as np
from attrs import frozen

from ..wearers.curves import Array, Rng
from .elevator import add_vibration, draw_waves

INCLINE = radians(30.0)
"""Angle of the incline, rad."""
LEVEL_LENGTH = 1.0
"""Length over which the steps are level at either end, m."""
BEND_RADIUS = 1.0
"""Radius of the bends between the level ends and the incline, m."""
STEP_DEPTH = 0.38
"""Depth of a step, m."""
STEP_HEIGHT = STEP_DEPTH * tan(INCLINE)
"""Height of a step on the incline, m."""
BOARDING_TIME = 0.6
"""Time in which the wearer gets the speed of the steps, or loses it, s: that of a step (assumed)."""
PAUSE = 0.3
"""Time of standing before and after the ride, s (assumed)."""
LEAST_HEIGHT = 1.0
"""Least height of an escalator, m (assumed): its bends alone rise by 0.27 m."""


@frozen
class Escalator:
    """An action: stand on an escalator; also the escalator on which a flight of stairs is walked."""

    height: float
    """Height by which the steps rise with the wearer, m; negative downwards."""
    speed: float = 0.5
    """Speed of the steps, m/s."""

    @property
    def track_length(self) -> float:
        """Length of the way of a step, m."""
        bends = 2.0 * BEND_RADIUS * INCLINE
        return 2.0 * LEVEL_LENGTH + bends + self.incline_length

    @property
    def incline_length(self) -> float:
        """Length of the straight incline, m."""
        return (abs(self.height) - 2.0 * BEND_RADIUS * (1.0 - cos(INCLINE))) / sin(INCLINE)

    @property
    def run(self) -> float:
        """Horizontal distance from end to end, m."""
        return 2.0 * (LEVEL_LENGTH + BEND_RADIUS * sin(INCLINE)) + self.incline_length * cos(INCLINE)


@frozen(eq=False)
class EscalatorRide:
    """The motion of the ground under the feet of a wearer on an escalator, who stays displaced after it."""

    start: float
    """Time at which the wearer gets on, s."""
    end: float
    """Time at which the wearer is off, s."""
    heading: float
    """Heading of the escalator in the world frame, rad."""
    escalator: Escalator
    """Measures of the escalator; here its speed is the one that fits the time."""
    waves: Array
    """Amplitude, m/s^2, angular frequency, rad/s, and phase, rad, of the vibration, (3 axes, waves, 3)."""

    @property
    def height(self) -> float:
        """Height by which the ground moves, m; negative downwards."""
        return self.escalator.height

    def at(self, t: Array) -> tuple[Array, Array, Array]:
        """Return displacement, velocity and acceleration of the ground at `t`, (N, 3) each, world frame, SI units."""
        elapsed = np.clip(np.asarray(t, dtype=np.float64) - self.start, 0.0, self.end - self.start)
        s, v, a = self._along(elapsed)
        angle, bend, x, z = self._track(s)
        up = 1.0 if self.height > 0.0 else -1.0
        c, n = np.cos(angle), np.sin(angle)
        flat = (x, v * c, a * c - v * v * bend * n)
        steep = (up * z, up * v * n, up * (a * n + v * v * bend * c))
        moved = [
            np.stack((cos(self.heading) * one, sin(self.heading) * one, other), axis=1)
            for one, other in zip(flat, steep, strict=True)
        ]
        inside = (elapsed > 0.0) & (elapsed < self.end - self.start)
        add_vibration(elapsed, inside, self.end - self.start, self.waves, moved)
        return moved[0], moved[1], moved[2]

    def _along(self, elapsed: Array) -> tuple[Array, Array, Array]:
        """Return the way, m, speed, m/s, and acceleration, m/s^2, along the track."""
        duration, speed = self.end - self.start, self.escalator.speed
        is_early = elapsed < 0.5 * duration
        margin = np.where(is_early, elapsed, duration - elapsed)
        u = np.minimum(margin / BOARDING_TIME, 1.0)
        way = speed * (BOARDING_TIME * (u**3 - 0.5 * u**4) + np.maximum(margin - BOARDING_TIME, 0.0))
        whole = speed * (duration - BOARDING_TIME)
        a = speed * 6.0 * u * (1.0 - u) / BOARDING_TIME
        return np.where(is_early, way, whole - way), speed * u * u * (3.0 - 2.0 * u), np.where(is_early, a, -a)

    def _track(self, s: Array) -> tuple[Array, Array, Array, Array]:
        """Return slope, rad, its change per metre, rad/m, horizontal way and rise, m, of a track that goes up."""
        radius, arc, straight = BEND_RADIUS, BEND_RADIUS * INCLINE, self.escalator.incline_length
        knots = np.cumsum((LEVEL_LENGTH, arc, straight, arc))
        angle = np.interp(s, knots, (0.0, INCLINE, INCLINE, 0.0))
        in_first, in_second = (s > knots[0]) & (s < knots[1]), (s > knots[2]) & (s < knots[3])
        bend = (in_first * 1.0 - in_second * 1.0) / radius
        middle = np.clip(s - knots[1], 0.0, straight)
        first = np.clip(s - knots[0], 0.0, arc) / radius
        second = np.clip(s - knots[2], 0.0, arc) / radius
        level = np.minimum(s, LEVEL_LENGTH) + np.maximum(s - knots[3], 0.0)
        x = level + radius * np.sin(first) + middle * cos(INCLINE) + radius * (sin(INCLINE) - np.sin(INCLINE - second))
        z = radius * (1.0 - np.cos(first)) + middle * sin(INCLINE)
        return angle, bend, x, z + radius * (np.cos(INCLINE - second) - cos(INCLINE))


def ride_time(escalator: Escalator) -> float:
    """Return the time of a ride at the escalator's speed, s."""
    return escalator.track_length / escalator.speed + BOARDING_TIME


def ride_escalator(escalator: Escalator, heading: float, start: float, end: float, rng: Rng) -> EscalatorRide:
    """Return the ride from `start` to `end`, s, at the speed that fits; `rng` draws the vibration."""
    fitted = Escalator(escalator.height, escalator.track_length / (end - start - BOARDING_TIME))
    return EscalatorRide(start, end, heading, fitted, draw_waves(rng))


def climbed_steps(escalator: Escalator, pace: float) -> int:
    """Return the number of steps that a wearer climbs on an escalator who would walk `pace` steps/s on stairs.

    It is the number with which the speed of the steps, fitted to the time of walking, is nearest to the escalator's."""
    most = int((abs(escalator.height) - LEAST_HEIGHT / 2.0) / STEP_HEIGHT)

    def misfit(count: int) -> float:
        rest = Escalator(abs(escalator.height) - count * STEP_HEIGHT)
        return abs(rest.track_length / (count / pace - BOARDING_TIME) - escalator.speed)

    return min([count for count in range(1, most + 1) if count / pace > 2.0 * BOARDING_TIME], key=misfit)
