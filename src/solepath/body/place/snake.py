"""The Snake game on the floor plan, after Liu et al. 2015 (IEEE MASS), section IV.E and figure 14.

Stairs and lifts are where a trace can begin. Every place that fits and every heading begins one; each is extended step
by step as the track goes, and those that run into a wall are dropped. The one that is left is the wearer's.

The paper says no more. Its traces err by some per cent in length and by degrees in each turn, so the right one would
run into a wall before long; therefore one that meets a wall may bend to either side as long as it counts less, keeps
the heading that let it pass, and while few are left each has neighbours that lie a little to the side, turn or stretch
a little more. Traces that have come to the same are one. There is no chance in it.
"""

from __future__ import annotations

from math import atan2, cos, hypot, sin

from attrs import define

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from .crowd import Row, origin_of, resampled
from .landings import Landing, beside, landings
from .placing import Placing

BENDS = (0.06, 0.14, 0.24)
"""One that meets a wall turns by so much, rad, to either side ..."""
AGAIN = 0.65
"""... and counts so much less, each time."""
SQUEEZE = (0.4, 0.7)
"""When nobody is left, all turn by so much."""
STAYS = 0.6
"""One beside stairs or a lift may be on them already: it stays there, but counts less."""
CELL = 0.25
"""Traces on the same level within this, m, ..."""
SECTOR = 0.03
"""... and this, rad, ..."""
SHARE = 0.02
"""... and this share of length are the same."""
FEWEST = 40
"""With fewer traces than this each gets neighbours."""
ASIDE = 0.3
"""m"""
TURN = 0.04
"""rad"""
STRETCH = 0.025
BEND, OF_BEND = 0.3, (-0.24, -0.12, 0.12, 0.24)
"""Who turns by more than this, rad, may have turned by so much more or less, as shares of it."""
WORTH = 0.5
"""What a neighbour counts, at first."""
MOST = 1.15
LEAST = 0.85
"""A trace is stretched by no more and no less."""


@define
class SnakeGame(Placing):
    """Traces from every reference, those through walls dropped, until one is left."""

    def extended(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """The traces a move further; without those that cannot go there."""
        if turned > BEND:
            rows = rows + _turned(rows, turned)
        grown = self._grown(plan, rows, move, BENDS if rough < 2.0 else (*BENDS, *SQUEEZE))
        if not grown:
            grown = self._grown(plan, rows, move, SQUEEZE)
        grown = merged(grown, CELL)
        if len(grown) < FEWEST and hypot(*move) > 0.2:
            grown = merged(grown + self._neighbours(plan, grown, move), CELL)
        return grown if len(grown) <= self.most else self.thinned(grown, self.most)

    def _grown(self, plan: IndexedPlan, rows: list[Row], move: Point, bends: tuple[float, ...]) -> list[Row]:
        dx, dy = move
        x0, y0 = origin_of(plan.plan)
        crosses = plan.crosses
        kept: list[Row] = []
        stops: list[Landing] | None = None
        for x, y, a, b, w, level, origin, _ in rows:
            nx, ny = x + a * dx - b * dy, y + b * dx + a * dy
            if not crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
                kept.append((nx, ny, a, b, w, level, origin, 0))
                continue
            v, passed = w, False
            for bend in bends:
                v *= AGAIN
                for h in (bend, -bend):
                    s = 1.0 - 0.5 * h * h
                    a1, b1 = a * s - b * h, b * s + a * h
                    nx, ny = x + a1 * dx - b1 * dy, y + b1 * dx + a1 * dy
                    if not crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
                        kept.append((nx, ny, a1, b1, v, level, origin, 0))
                        passed = True
                if passed:
                    break
            if not passed:
                stops = landings(plan.plan) if stops is None else stops
                if beside(stops, level, x0 + x, y0 + y):
                    kept.append((x, y, a, b, w * STAYS, level, origin, 0))
        return kept

    def _neighbours(self, plan: IndexedPlan, rows: list[Row], move: Point) -> list[Row]:
        """Traces a little to the side, turned or stretched a little more."""
        long = hypot(*move)
        x0, y0 = origin_of(plan.plan)
        added: list[Row] = []
        for x, y, a, b, w, level, origin, held in rows:
            w *= WORTH
            for sign in (1.0, -1.0):
                h, s = sign * TURN, 1.0 + sign * STRETCH
                added.append((x, y, a - b * h, b + a * h, w, level, origin, held))
                if LEAST < hypot(a, b) * s < MOST:
                    added.append((x, y, a * s, b * s, w, level, origin, held))
                k = sign * ASIDE / long
                nx, ny = x - k * (b * move[0] + a * move[1]), y + k * (a * move[0] - b * move[1])
                if not plan.crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
                    added.append((nx, ny, a, b, w, level, origin, held))
                nx, ny = x + k * (a * move[0] - b * move[1]), y + k * (b * move[0] + a * move[1])
                if not plan.crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
                    added.append((nx, ny, a, b, w, level, origin, held))
        return added

    def scattered(self, k: int, count: int) -> tuple[float, float, float, float]:
        """For the k-th of `count` new rows, each from -1 to 1: x, y, heading, stretch."""
        return (0.0, 0.0, 0.0, float(k % 3 - 1))

    def thinned(self, rows: list[Row], wanted: int) -> list[Row]:
        """No more than about so many, by taking together those that are nearly the same, then by weight."""
        if len(rows) > wanted:
            rows = merged(rows, 2.0 * CELL)
        return rows if len(rows) <= wanted else merged(resampled(rows, wanted, 0.5), 0.01)


def _turned(rows: list[Row], turned: float) -> list[Row]:
    """Traces that have turned more, or less."""
    added: list[Row] = []
    for share in OF_BEND:
        c, s = cos(share * turned), sin(share * turned)
        for x, y, a, b, w, level, came, held in rows:
            added.append((x, y, a * c - b * s, b * c + a * s, WORTH * w, level, came, held))
    return added


def merged(rows: list[Row], cell: float) -> list[Row]:
    """One row for all that are in the same cell of place, heading and stretch: the heaviest, with the weight of all."""
    scale = CELL / cell
    found: dict[tuple[int, int, int, int, int, int], Row] = {}
    for row in rows:
        x, y, a, b, w, level, origin, held = row
        key = (
            level,
            held,
            int(x // cell),
            int(y // cell),
            int(atan2(b, a) * scale // SECTOR),
            int((a * a + b * b) * scale // (2.0 * SHARE)),
        )
        other = found.get(key)
        if other is None:
            found[key] = row
        elif w > other[4]:
            found[key] = (x, y, a, b, w + other[4], level, origin, held)
        else:
            found[key] = (*other[:4], other[4] + w, *other[5:])
    return list(found.values())
