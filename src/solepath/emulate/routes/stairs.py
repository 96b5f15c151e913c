"""A flight of stairs: where its edges are, and how high a round sole must be above them."""

from __future__ import annotations

from math import cos, sin

import numpy as np
from attrs import frozen

from ..wearers.curves import Array

UP, DOWN = 0.25, 0.17
"""m from the ankle of who stands before a flight, and on every tread, to the next edge ahead. Upwards the heel is over
the edge behind by 4 cm on treads of 0.30 m, and the forefoot rocker ends 9 cm before the next riser; downwards the ball
of the foot is 6 cm behind the edge and the toes are over it."""
HEEL = 0.13
"""m from the ankle back to the riser behind it on the way down, at least; on shorter treads the toes are out more."""


def ahead(up: bool, going: float) -> float:
    """m from the ankle to the next edge on treads of this depth."""
    return UP if up else min(DOWN, going - HEEL)


@frozen
class Flight:
    """`steps` risers, `rise` m each (negative: down) and `going` m apart, the first one at (x, y).

    `z`: of the floor before it, m; `heading`: in which it is walked, rad. It is as wide as one likes.
    """

    x: float
    y: float
    z: float
    heading: float
    steps: int
    rise: float
    going: float

    @property
    def height(self) -> float:
        """m from floor to floor, negative when it leads down."""
        return self.steps * self.rise

    def along(self, x: Array, y: Array) -> Array:
        """How far points are beyond the first edge, m."""
        return np.asarray((x - self.x) * cos(self.heading) + (y - self.y) * sin(self.heading))

    def ground(self, x: Array, y: Array) -> Array:
        """Height of the tread or floor below points, m."""
        return self._tread(self.along(x, y))

    def above(self, x: Array, y: Array, radius: Array) -> Array:
        """How high the centre of a disc must be to rest on the treads or an edge below it, m.

        The disc stands upright along the flight with its centre above (x, y).
        """
        u = self.along(x, y)
        least = self._tread(u) + radius
        for k in range(self.steps):
            edge = self.z + self.rise * (k + 1 if self.rise > 0.0 else k)
            inside = radius**2 - (u - k * self.going) ** 2
            least = np.where(inside > 0.0, np.maximum(least, edge + np.sqrt(np.maximum(inside, 0.0))), least)
        return np.asarray(least)

    def _tread(self, u: Array) -> Array:
        return np.asarray(self.z + self.rise * np.clip(np.floor(u / self.going) + 1.0, 0.0, self.steps))
