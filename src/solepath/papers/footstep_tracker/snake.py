"""Snake game on the floor plan as printed (Liu et al. 2015, IEEE MASS, section IV.E and figure 14).

The paper has traces of the wearer's path, which are particles here (place/particles.py). They start at all stairs and
elevators of the plan, in evenly spaced headings. Each moves with every stride of the track, and those that run into a
wall are dropped. The last one left is the wearer's.

A track errs by some per cent in length and by some degrees in each turn, so even the right particle runs into a wall
before long. The particles of every other recipe sway and have weights (place/placing.py); so have those of
`footstep-tracker`."""

from __future__ import annotations

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from ...place.particles import Cloud, Noise, moved_freely, resample
from ...place.placing import MAX_PARTICLES, Particles
from ...types.attrs import define


@define
class PrintedSnake(Particles):
    """Keeps particles from all stairs and elevators, and drops those that meet a wall."""

    def extend(self, plan: IndexedPlan, particles: Cloud, move: Point, error_factor: float, turn: float) -> Cloud:
        return moved_freely(plan, particles, move)

    def scatter(self, k: int, count: int) -> Noise:
        return (0.0, 0.0, 0.0, 0.0)

    def thin(self, particles: Cloud, count: int) -> Cloud:
        """Return all particles; only those beyond the largest number are drawn by weight."""
        return particles if len(particles) <= MAX_PARTICLES else resample(particles, MAX_PARTICLES)
