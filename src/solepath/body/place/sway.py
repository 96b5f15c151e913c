"""Motion model of the rows: heading, stretch and each move have small errors from a table of numbers (noise.py)."""

from __future__ import annotations

from math import hypot

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from .landings import Landing, is_near_landing, landings
from .noise import NOISE, ROWS
from .rows import Row

MOVE_ERROR = 0.06
"""Error of a move as a share of its length, each way: half the width of an even distribution."""
PLACE_ERROR = 0.03
"""Error of a move that adds to `MOVE_ERROR`, m, each way."""
HEADING_NOISE = 0.02
"""Largest turn of the track in the plan with each move, rad."""
TURN_NOISE = 0.12
"""Largest turn of the track as a share of the wearer's turn, which adds to `HEADING_NOISE`."""
STRETCH_NOISE = 0.008
"""Largest change of the stretch with each move, as a share."""
STRETCH_DECAY = 0.01
"""Share by which the stretch returns to 1 with each move."""
BENDS = (0.07, 0.16)
"""Turns to either side that a row tries at a wall, rad."""
BEND_WEIGHT = 0.65
"""Factor of the row's weight for each such try."""
WIDE_BENDS = (0.1, 0.25, 0.45)
"""Turns that all rows try once more when none is left, rad."""
STAY_WEIGHT = 0.6
"""Factor of the weight of a row that stays at stairs or a lift, since it may be on them already."""


def sway_rows(
    plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float, random: int, both: bool
) -> list[Row]:
    """Return the rows after a move (m, track), without those that cannot go there.

    `rough`: factor of the track's usual errors; `turned`: turn of the wearer, rad; `random`: first row of the table;
    `both`: a row that meets a wall continues on either side of it, not only on the first that is free."""
    turn = rough * (HEADING_NOISE + TURN_NOISE * turned)
    kept = _sway(plan, rows, move, rough, turn, random % ROWS, both, BENDS)
    return kept or _sway(plan, rows, move, 2.0 * rough, 2.0 * turn, (random + 499) % ROWS, both, WIDE_BENDS)


def _sway(
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
    way, stretch = rough * (MOVE_ERROR * hypot(dx, dy) + PLACE_ERROR), rough * STRETCH_NOISE
    crosses = plan.crosses
    kept: list[Row] = []
    blocked: list[Row] = []
    for row in rows:
        x, y, a, b, w, level, origin, _ = row
        k = k + 1 if k < ROWS - 1 else 0
        ex, ey, eh, es = NOISE[k]
        s = 1.0 + STRETCH_DECAY * (1.0 - a * a - b * b) + stretch * es
        h = turn * eh
        a1, b1 = a * s - b * h, b * s + a * h
        nx, ny = x + a1 * dx - b1 * dy + way * ex, y + b1 * dx + a1 * dy + way * ey
        if crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
            blocked.append(row)
        else:
            kept.append((nx, ny, a1, b1, w, level, origin, 0))
    if not blocked:
        return kept
    stops: list[Landing] | None = None
    for row in blocked:
        x, y, a, b, w, level, origin, _ = row
        k = (k + 367) % ROWS
        ex, ey, eh, es = NOISE[k]
        side, passed = (1.0 if eh > 0.0 else -1.0), False
        for bend in bends:
            w *= BEND_WEIGHT
            # bend to one side, then to the other: the heading stays corrected
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
            if is_near_landing(stops, level, x0 + x, y0 + y):
                kept.append((x, y, a, b, row[4] * STAY_WEIGHT, level, origin, 0))
    return kept
