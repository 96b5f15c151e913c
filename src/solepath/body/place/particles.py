"""A particle filter on the floor plan.

Every particle is a reading of the track that wanders: its heading, its stretch and each step err a little, by chance.
One that would go through a wall tries again, erring more and counting less; when that fails, it is gone. Those that are
left are the places where the wearer can be. Chance is a table of numbers and a count, so it is the same everywhere.
"""

from __future__ import annotations

from math import hypot

from attrs import define

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from .crowd import Row, origin_of, resampled
from .landings import Landing, beside, landings
from .noise import NOISE, ROWS, following
from .placing import Placing

STEP = 0.06
"""A step errs by this share of its length, each way (half the width of an even distribution) ..."""
SHAKE = 0.03
"""... and by this, m."""
TURN = 0.02
"""The track turns by up to this in the plan with each step, rad."""
OF_TURN = 0.12
"""... and by up to this share of what the wearer turns."""
STRETCH = 0.008
"""Its stretch changes by up to this share ..."""
PULL = 0.01
"""... and is drawn back to 1 by this share."""
BENDS = (0.07, 0.16)
"""One that meets a wall turns by so much, rad, to either side ..."""
AGAIN = 0.65
"""... and counts so much less, each time."""
SQUEEZE = (0.1, 0.25, 0.45)
"""When nobody is left, all try once more and turn this much."""
STAYS = 0.6
"""One beside stairs or a lift may be on them already: it stays there, but counts less."""


@define
class Particles(Placing):
    """The default for every recipe."""

    def extended(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """The rows a move further; without those that cannot go there."""
        turn = rough * (TURN + OF_TURN * turned)
        kept = self._wandered(plan, rows, move, rough, turn, BENDS)
        return kept or self._wandered(plan, rows, move, 2.0 * rough, 2.0 * turn, SQUEEZE)

    def _wandered(
        self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turn: float, bends: tuple[float, ...]
    ) -> list[Row]:
        dx, dy = move
        x0, y0 = origin_of(plan.plan)
        long = hypot(dx, dy)
        way, stretch = rough * (STEP * long + SHAKE), rough * STRETCH
        self.random = k = following(self.random)
        k %= ROWS
        crosses = plan.crosses
        kept: list[Row] = []
        lost: list[Row] = []
        for row in rows:
            x, y, a, b, w, level, origin, _ = row
            k = k + 1 if k < ROWS - 1 else 0
            ex, ey, eh, es = NOISE[k]
            s = 1.0 + PULL * (1.0 - a * a - b * b) + stretch * es
            h = turn * eh
            a1, b1 = a * s - b * h, b * s + a * h
            nx, ny = x + a1 * dx - b1 * dy + way * ex, y + b1 * dx + a1 * dy + way * ey
            if crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
                lost.append(row)
            else:
                kept.append((nx, ny, a1, b1, w, level, origin, 0))
        if not lost:
            return kept
        stops: list[Landing] | None = None
        for row in lost:
            x, y, a, b, w, level, origin, _ = row
            k = (k + 367) % ROWS
            ex, ey, eh, es = NOISE[k]
            side = 1.0 if eh > 0.0 else -1.0
            for bend in bends:
                w *= AGAIN
                # bent to one side, then to the other: the heading that was wrong stays corrected
                for h in (side * bend, -side * bend):
                    h, s = h + turn * es, 1.0 - 0.5 * h * h
                    a1, b1 = a * s - b * h, b * s + a * h
                    nx, ny = x + a1 * dx - b1 * dy + 2.0 * way * ex, y + b1 * dx + a1 * dy + 2.0 * way * ey
                    if not crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
                        break
                else:
                    continue
                kept.append((nx, ny, a1, b1, w, level, origin, 0))
                break
            else:
                stops = landings(plan.plan) if stops is None else stops
                if beside(stops, level, x0 + x, y0 + y):
                    kept.append((x, y, a, b, row[4] * STAYS, level, origin, 0))
        return kept

    def scattered(self, k: int, count: int) -> tuple[float, float, float, float]:
        """For the k-th of `count` new rows, each from -1 to 1: x, y, heading, stretch."""
        return NOISE[k % ROWS]

    def thinned(self, rows: list[Row], wanted: int) -> list[Row]:
        """So many rows, each as often as it is believed."""
        self.random = following(self.random)
        return resampled(rows, wanted, (self.random % 4093) / 4093.0)
