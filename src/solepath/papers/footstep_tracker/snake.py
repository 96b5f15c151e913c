"""Snake game on the floor plan, after Liu et al. 2015 (IEEE MASS), section IV.E and figure 14.

The paper has traces of the wearer's path, which are particles here (place/particles.py). They start at all stairs and
elevators of the plan, in evenly spaced headings. Each moves with every stride of the track, and those that run into a
wall are dropped. The last one left is the wearer's.

The paper has no more detail. As printed (`PrintedSnake`) each particle moves as the track does, and one that meets a
wall is dropped. A track errs by some per cent in length and by some degrees in each turn, so even the right particle
would run into a wall before long. Therefore the heading and stretch of each vary a little at random from stride to
stride (`sway`). A particle that meets a wall is replaced by two that pass the wall on either side. They have less
weight, and keep the heading with which they passed. Particles that have become nearly equal are merged.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import atan2

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from ...place.particles import Noise, Particle, moved_freely, next_random, resample, sway
from ...place.placing import MAX_PARTICLES, Particles
from ...types.attrs import define

CELL_SIZE = 0.25
"""Edge length of the square cells of one level, m: particles in one cell may be merged."""
HEADING_SECTOR = 0.03
"""Width of the sectors of heading, rad: particles in one sector may be merged."""
STRETCH_INTERVAL = 0.02
"""Width of the intervals of the stretch, which is about 1: particles in one interval may be merged."""
MERGED_SHARE = 0.8
"""Least share of the requested number of particles that must be left for the merged ones to be kept as they are."""


@define
class SnakeGame(Particles):
    """Keeps particles from all stairs and elevators, and drops those that find no way past a wall until one is left."""

    def extend(
        self, plan: IndexedPlan, particles: list[Particle], move: Point, error_factor: float, turn: float
    ) -> list[Particle]:
        self.random = next_random(self.random)
        extended = sway(plan, particles, move, error_factor, turn, self.random, both_sides=True)
        return extended if len(extended) <= MAX_PARTICLES else self.thin(extended, MAX_PARTICLES)

    def scatter(self, k: int, count: int) -> Noise:
        return (0.0, 0.0, 0.0, float(k % 3 - 1))

    def thin(self, particles: list[Particle], count: int) -> list[Particle]:
        """Return about `count` particles: merge those that are nearly equal, then draw by weight, perhaps often."""
        merged = merge(particles) if len(particles) > count else particles
        return merged if MERGED_SHARE * count < len(merged) <= count else resample(merged, count)


@define
class PrintedSnake(Particles):
    """Keeps particles from all stairs and elevators, and drops those that meet a wall, as printed."""

    def extend(
        self, plan: IndexedPlan, particles: list[Particle], move: Point, error_factor: float, turn: float
    ) -> list[Particle]:
        return moved_freely(plan, particles, move)

    def scatter(self, k: int, count: int) -> Noise:
        return (0.0, 0.0, 0.0, 0.0)

    def thin(self, particles: list[Particle], count: int) -> list[Particle]:
        """Return all particles; only those beyond the largest number are drawn by weight."""
        return particles if len(particles) <= MAX_PARTICLES else resample(particles, MAX_PARTICLES)


def merge(particles: list[Particle]) -> list[Particle]:
    """Merge particles of equal cell, heading and stretch into the heaviest of them, which gets the sum of weights."""
    heaviest: dict[tuple[int, int, int, int, int, int], Particle] = {}
    for particle in particles:
        x, y, a, b, weight, level, _, landing = particle
        key = (
            level,
            landing,
            int(x // CELL_SIZE),
            int(y // CELL_SIZE),
            int(atan2(b, a) // HEADING_SECTOR),
            int((a * a + b * b) // (2.0 * STRETCH_INTERVAL)),  # the square varies twice as much as the stretch
        )
        other = heaviest.get(key)
        if other is not None:
            particle = (particle if weight > other.weight else other).weighing(weight + other.weight)
        heaviest[key] = particle
    return list(heaviest.values())
