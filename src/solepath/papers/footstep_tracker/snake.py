"""The Snake game on the floor plan, after Liu et al. 2015 (IEEE MASS), section IV.E and figure 14.

Stairs and lifts are where a trace can begin. Every place that fits and every heading begins one; each is extended step
by step as the track goes, and those that run into a wall are dropped. The one that is left is the wearer's.

The paper says no more. Its traces err by some per cent in length and by degrees in each turn, so the right one would
run into a wall before long. Therefore each sways a little from step to step (sway.py), as a snake does, and one that
meets a wall goes on to either side of it, in two traces that count less and keep the heading that let them pass. Traces
that have come to the same are one.
"""

from __future__ import annotations

from math import atan2

from ...body.place.noise import next_random
from ...body.place.placing import Placing
from ...body.place.rows import Row, resampled
from ...body.place.sway import sway_rows
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from ...types.attrs import define

CELL = 0.25
"""Traces on the same level within this, m, ..."""
SECTOR = 0.03
"""... and this, rad, ..."""
SHARE = 0.02
"""... and this share of length are the same."""


@define
class SnakeGame(Placing):
    """Traces from every reference, those through walls dropped, until one is left."""

    def extend(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """The traces a move further; without those that cannot go there."""
        self.random = next_random(self.random)
        grown = sway_rows(plan, rows, move, rough, turned, self.random, True)
        most = self.settings.most
        return grown if len(grown) <= most else self.thin(grown, most)

    def scatter(self, k: int, count: int) -> tuple[float, float, float, float]:
        """For the k-th of `count` new rows, each from -1 to 1: x, y, heading, stretch."""
        return (0.0, 0.0, 0.0, float(k % 3 - 1))

    def thin(self, rows: list[Row], count: int) -> list[Row]:
        """About so many, by taking together those that are nearly the same, then by weight."""
        one = merged(rows) if len(rows) > count else rows
        return one if 0.8 * count < len(one) <= count else resampled(one, count, 0.5)


def merged(rows: list[Row]) -> list[Row]:
    """One row for all that are in the same cell of place, heading and stretch: the heaviest, with the weight of all."""
    found: dict[tuple[int, int, int, int, int, int], Row] = {}
    for row in rows:
        x, y, a, b, w, level, origin, held = row
        key = (
            level,
            held,
            int(x // CELL),
            int(y // CELL),
            int(atan2(b, a) // SECTOR),
            int((a * a + b * b) // (2.0 * SHARE)),
        )
        other = found.get(key)
        if other is None:
            found[key] = row
        elif w > other[4]:
            found[key] = (x, y, a, b, w + other[4], level, origin, held)
        else:
            found[key] = (*other[:4], other[4] + w, *other[5:])
    return list(found.values())
