"""Levels whose walls are alike where the wearer is: walls cannot decide between them.

Each level has few rows, and which of them bend at a wall or end there is chance. Without a remedy the weights of two
equal floors walk at random in the course of a walk, until the true one is gone. Therefore the rows of alike levels at
one place keep the ratio of their weights in each move, unless their walls differ there. Stairs, lifts and reported
places still change it, and so does the fading of light levels (`FADE_FACTOR` in placing.py): this module keeps an open
choice open, and fading ends one that is nearly made."""

from __future__ import annotations

from math import fsum, hypot

from ...events import Placed
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from ..place_hypotheses import MAX_MOVE
from .rows import CANDIDATE_RADIUS, MIN_CANDIDATE_WEIGHT, Row, resample_rows

PLACE_RADIUS = 2.0 * CANDIDATE_RADIUS
"""Largest distance on each axis of rows that are at one place, m: twice that of a candidate, as they move apart."""
EVERY = 5
"""One of so many rows is moved on both levels to see whether their walls are alike (saves time)."""
TWINS = 30
"""Number of rows that an alike level gets when it has none left: as many as are kept for a light candidate."""


def hold_alike_levels(plan: IndexedPlan, before: list[Row], after: list[Row], move: Point, placed: Placed) -> list[Row]:
    """Return the rows `after` a move of the track, m, with the ratios that alike levels at one place had `before`.

    The place is that which was reported before the move, and its level the one to which others are compared. If an
    alike level has no row left there, it gets those of this level. A move across a gap of the track passes walls, so it
    changes nothing here."""
    first, length = before[0][5], hypot(*move)
    if length > MAX_MOVE or all([row[5] == first for row in before]):
        return after
    level, (x0, y0) = plan.number(placed.level), plan.plan.origin
    x, y = placed.position[0] - x0, placed.position[1] - y0
    old = _near(before, x, y)
    if len(old) < 2 or level not in old:
        return after
    # the place moves with its rows, otherwise those at its edge would leave it and seem to be gone
    total = _weight(old[level])
    x += fsum([w * (a * move[0] - b * move[1]) for _, _, a, b, w, _, _, _ in old[level]]) / total
    y += fsum([w * (b * move[0] + a * move[1]) for _, _, a, b, w, _, _, _ in old[level]]) / total
    new, around = _near(after, x, y), _near(after, x, y, PLACE_RADIUS + length)
    if level not in new:
        return after
    factors: dict[int, float] = {}
    twins: list[Row] = []
    old_weight, new_weight = _weight(old[level]), _weight(new[level])
    for other, rows in old.items():
        share = _weight(rows) / old_weight
        if other == level or share < MIN_CANDIDATE_WEIGHT or not _are_alike(plan, old, move, level, other):
            continue
        left = new.get(other)
        if left:
            factors[other] = share * new_weight / _weight(left)
        elif other not in around:
            drawn = resample_rows(new[level], TWINS, 0.5)
            k = share * new_weight / _weight(drawn)
            twins += [(*row[:4], k * row[4], other, *row[6:]) for row in drawn]
    if factors:
        after = [
            (*row[:4], factors[row[5]] * row[4], *row[5:]) if row[5] in factors and _is_near(row, x, y) else row
            for row in after
        ]
    return after + twins


def _near(rows: list[Row], x: float, y: float, radius: float = PLACE_RADIUS) -> dict[int, list[Row]]:
    """Return the rows near (x, y) that do not change level, by level."""
    near: dict[int, list[Row]] = {}
    for row in rows:
        if _is_near(row, x, y, radius):
            near.setdefault(row[5], []).append(row)
    return near


def _is_near(row: Row, x: float, y: float, radius: float = PLACE_RADIUS) -> bool:
    return not row[7] and -radius < row[0] - x < radius and -radius < row[1] - y < radius


def _weight(rows: list[Row]) -> float:
    return fsum([row[4] for row in rows])


def _are_alike(plan: IndexedPlan, near: dict[int, list[Row]], move: Point, level: int, other: int) -> bool:
    """Return whether the walls of two levels allow and stop the same moves of the rows on both."""
    (dx, dy), (x0, y0) = move, plan.plan.origin
    for x, y, a, b, _, _, _, _ in (near[level] + near[other])[::EVERY]:
        x, y = x0 + x, y0 + y
        end = (x + a * dx - b * dy, y + b * dx + a * dy)
        if plan.crosses(level, x, y, *end) is not plan.crosses(other, x, y, *end):
            return False
    return True
