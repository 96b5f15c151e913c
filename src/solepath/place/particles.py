"""Particle filter on the floor plan.

Every particle is a row (rows.py) that moves with random errors (sway.py). A particle that would go through a wall tries
again with larger errors and less weight; when that fails, it is removed. The remaining particles are possible places of
the wearer. Random numbers come from a table (noise.py), so they are equal on every platform."""

from __future__ import annotations

from ..floorplan.index import IndexedPlan
from ..floorplan.plan import Point
from ..types.attrs import define
from .placing import Placing
from .rows.noise import NOISE_ENTRIES, NOISE_TABLE, next_random
from .rows.rows import Row, resample_rows
from .rows.sway import sway_rows


@define
class Particles(Placing):
    """The particle filter, the default method of every recipe."""

    def extend(self, plan: IndexedPlan, rows: list[Row], move: Point, error_factor: float, turned: float) -> list[Row]:
        """Return the rows after a move, without those that cannot go there."""
        self.random = next_random(self.random)
        return sway_rows(plan, rows, move, error_factor, turned, self.random, False)

    def scatter(self, k: int, count: int) -> tuple[float, float, float, float]:
        """Return offsets for the k-th of `count` new rows, each from -1 to 1: x, y, heading, stretch."""
        return NOISE_TABLE[k % NOISE_ENTRIES]

    def thin(self, rows: list[Row], count: int) -> list[Row]:
        """Return `count` rows, drawn according to their weights."""
        self.random = next_random(self.random)
        return resample_rows(rows, count, (self.random % 4093) / 4093.0)
