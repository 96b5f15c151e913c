"""How readings of the track sway: heading, stretch and each step err a little, by a table of numbers (noise.py)."""

from __future__ import annotations

from math import hypot

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from .crowd import Row
from .landings import Landing, beside, landings
from .noise import NOISE, ROWS

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


def swayed(
    plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float, random: int, both: bool
) -> list[Row]:
    """The rows a move (m, track) further, without those that cannot go there. `rough`: how much worse than usual the
    track is; `turned`: by how much the wearer has turned, rad; `random`: where in the table to begin; `both`: one that
    meets a wall goes on to either side of it, not to the first that is free only."""
    turn = rough * (TURN + OF_TURN * turned)
    kept = _swayed(plan, rows, move, rough, turn, random % ROWS, both, BENDS)
    return kept or _swayed(plan, rows, move, 2.0 * rough, 2.0 * turn, (random + 499) % ROWS, both, SQUEEZE)


def _swayed(
    plan: IndexedPlan,
    rows: list[Row],
    move: Point,
    rough: float,
    turn: float,
    k: int,
    both: bool,
    bends: tuple[float, ...],
) -> list[Row]:
    dx, dy = move
    x0, y0 = plan.plan.origin
    way, stretch = rough * (STEP * hypot(dx, dy) + SHAKE), rough * STRETCH
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
        side, passed = (1.0 if eh > 0.0 else -1.0), False
        for bend in bends:
            w *= AGAIN
            # bent to one side, then to the other: the heading that was wrong stays corrected
            for h in (side * bend, -side * bend):
                h, s = h + turn * es, 1.0 - 0.5 * h * h
                a1, b1 = a * s - b * h, b * s + a * h
                nx, ny = x + a1 * dx - b1 * dy + 2.0 * way * ex, y + b1 * dx + a1 * dy + 2.0 * way * ey
                if not crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
                    kept.append((nx, ny, a1, b1, w, level, origin, 0))
                    passed = True
                    if not both:
                        break
            if passed:
                break
        if not passed:
            stops = landings(plan.plan) if stops is None else stops
            if beside(stops, level, x0 + x, y0 + y):
                kept.append((x, y, a, b, row[4] * STAYS, level, origin, 0))
    return kept
