"""A particle filter on the floor plan.

Every particle is a reading of the track that sways by chance (sway.py). One that would go through a wall tries again,
erring more and counting less; when that fails, it is gone. Those that are left are the places where the wearer can be.
Chance is a table of numbers and a count, so it is the same everywhere.
"""

from __future__ import annotations

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from ...types.attrs import define
from .crowd import Row, resampled
from .noise import NOISE, ROWS, following
from .placing import Placing
from .sway import swayed


@define
class Particles(Placing):
    """The default for every recipe."""

    def extended(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """The rows a move further; without those that cannot go there."""
        self.random = following(self.random)
        return swayed(plan, rows, move, rough, turned, self.random, False)

    def scattered(self, k: int, count: int) -> tuple[float, float, float, float]:
        """For the k-th of `count` new rows, each from -1 to 1: x, y, heading, stretch."""
        return NOISE[k % ROWS]

    def thinned(self, rows: list[Row], wanted: int) -> list[Row]:
        """So many rows, each as often as it is believed."""
        self.random = following(self.random)
        return resampled(rows, wanted, (self.random % 4093) / 4093.0)
