"""Slopes laid under a level walk: the same feet, higher and pitched by as much as the ground below them.

A walk is planned on the level. Laid over ground of height h(x), a sensor that was at (x, y, z) is at (x, y, z + h(x))
and pitched toe up by atan h'(x); velocity, acceleration, angular rate and specific force are those of that motion, so
what a sensor measures is consistent to the last digit. A foot that stands flat stands still on the slope as well. A
foot is not bent over the ends of a ramp: it turns with the ground below its sensor.
"""

from __future__ import annotations

import numpy as np
from attrs import frozen

from solepath.emulate.wearers.curves import Array
from solepath.emulate.wearers.motion import Kinematics
from solepath.types.vector import GRAVITY


@frozen
class Ramp:
    """Ground that rises by `grade` for each metre from `x` to `x + length`, m along the first heading.

    It is level before and after; its ends are rounded over `ease` m.
    """

    x: float
    length: float
    grade: float
    ease: float = 0.15

    @property
    def height(self) -> float:
        """Height difference of the two levels, m."""
        return self.grade * self.length

    def ground(self, x: Array) -> tuple[Array, Array, Array]:
        """Return the height h of the ground, m, and its derivatives h' and h'' in x, at `x` m."""
        # h' goes from 0 to the grade and back along tanh; the integral of that is a log cosh
        u, v = (x - self.x) / self.ease, (x - self.x - self.length) / self.ease
        half, tu, tv = 0.5 * self.grade, np.tanh(u), np.tanh(v)
        h = half * (self.ease * (_log_cosh(u) - _log_cosh(v)) + self.length)
        return h, half * (tu - tv), half / self.ease * (tv * tv - tu * tu)

    def under(self, level: Kinematics) -> Kinematics:
        """Return a sensor's motion over level ground with this ground below it."""
        h, first, second = self.ground(level.position[:, 0])
        vx, ax = level.velocity[:, 0], level.acceleration[:, 0]
        up = np.array([0.0, 0.0, 1.0])
        acceleration = level.acceleration + (first * ax + second * vx * vx)[:, None] * up
        # toe up is a turn by -angle about the world's y, before which the attitude was that of the level walk
        half = -0.5 * np.arctan(first)
        attitude = _about_y(np.cos(half), np.sin(half), level.attitude)
        turning = np.zeros_like(level.velocity)
        turning[:, 1] = -second * vx / (1.0 + first * first)
        return Kinematics(
            t=level.t,
            position=level.position + h[:, None] * up,
            velocity=level.velocity + (first * vx)[:, None] * up,
            acceleration=acceleration,
            attitude=attitude,
            rate=level.rate + _into(level.attitude, turning),
            force=_into(attitude, acceleration + GRAVITY * up),
        )


def _log_cosh(u: Array) -> Array:
    return np.asarray(np.abs(u) + np.log1p(np.exp(-2.0 * np.abs(u))) - np.log(2.0))


def _about_y(c: Array, s: Array, q: Array) -> Array:
    """Return the turns (c, 0, s, 0) after those of `q`, (N, 4)."""
    w, x, y, z = q.T
    return np.stack([c * w - s * y, c * x + s * z, c * y + s * w, c * z - s * x], axis=1)


def _into(q: Array, v: Array) -> Array:
    """Return world vectors (N, 3) in the axes of sensors with the attitudes `q` (N, 4)."""
    w, r = q[:, :1], -q[:, 1:]
    t = 2.0 * np.cross(r, v)
    return np.asarray(v + w * t + np.cross(r, t))
