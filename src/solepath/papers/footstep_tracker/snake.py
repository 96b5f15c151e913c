"""Snake game on the floor plan, after Liu et al. 2015 (IEEE MASS), section IV.E and figure 14.

A trace can start at stairs and lifts. Every place that fits and every heading starts one; each is extended step by step
with the track, and those that run into a wall are dropped. The one that is left is the wearer's.

The paper has no more detail. Its traces err by some per cent in length and by degrees in each turn, so the right one
would run into a wall before long. Therefore each trace sways a little from step to step (sway.py), as a snake does, and
one that meets a wall continues to either side of it, in two traces that count less and keep the heading that let them
pass. Traces that have become the same are merged."""

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
"""Size of the cells of one level in which traces are the same, m."""
SECTOR = 0.03
"""Size of the sectors of heading in which traces are the same, rad."""
SHARE = 0.02
"""Share of length up to which traces are the same."""


@define
class SnakeGame(Placing):
    """Keeps traces from every reference, and drops those through walls until one is left."""

    def extend(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """Return the traces one move further, without those that cannot go there."""
        self.random = next_random(self.random)
        grown = sway_rows(plan, rows, move, rough, turned, self.random, True)
        most = self.settings.most
        return grown if len(grown) <= most else self.thin(grown, most)

    def scatter(self, k: int, count: int) -> tuple[float, float, float, float]:
        """Return x, y, heading and stretch, each from -1 to 1, for the k-th of `count` new rows."""
        return (0.0, 0.0, 0.0, float(k % 3 - 1))

    def thin(self, rows: list[Row], count: int) -> list[Row]:
        """Return about so many rows: merge those that are nearly the same, then select by weight."""
        one = merged(rows) if len(rows) > count else rows
        return one if 0.8 * count < len(one) <= count else resampled(one, count, 0.5)


def merged(rows: list[Row]) -> list[Row]:
    """Return one row for all in the same cell of place, heading and stretch: the heaviest, with the weight of all."""
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
