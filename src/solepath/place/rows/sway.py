"""Motion model of the rows: heading, stretch and moves get small errors from the table in noise.py."""

from __future__ import annotations

from itertools import chain, cycle
from math import hypot

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from ..connectors.landings import is_near_landing
from .noise import NOISE_ENTRIES, NOISE_TABLE
from .rows import Row

MOVE_ERROR = 0.06
"""Largest error of a move on each axis, as a share of its length; errors are evenly distributed."""
PLACE_ERROR = 0.03
"""Largest additional error of a move on each axis, m."""
HEADING_NOISE = 0.02
"""Largest error of the heading with each move, rad."""
TURN_NOISE = 0.12
"""Largest additional error of the heading, as a share of the wearer's turn."""
STRETCH_NOISE = 0.008
"""Largest change of the stretch with each move, as a share."""
STRETCH_DECAY = 0.01
"""Share by which the stretch returns to 1 with each move."""
BEND_ANGLES = (0.07, 0.16)
"""Changes of heading that a row tries at a wall, to either side, rad."""
BEND_WEIGHT = 0.65
"""Factor of the row's weight for each angle of these that is tried."""
WIDE_BEND_ANGLES = (0.1, 0.25, 0.45)
"""Changes of heading that all rows try when no row is left, rad."""
STAY_WEIGHT = 0.6
"""Factor of the weight of a row that stays near stairs or an elevator, because it may be on them already."""


def sway_rows(
    plan: IndexedPlan, rows: list[Row], move: Point, error_factor: float, turned: float, random: int, both_sides: bool
) -> list[Row]:
    """Return the rows after a move of the track, m, without rows for which the plan forbids it.

    `error_factor` multiplies the track's usual errors, `turned` is the size of the wearer's turn, rad, and `random` the
    first index in the table. With `both_sides`, a row at a wall continues on both sides, not only the free one."""
    turn = error_factor * (HEADING_NOISE + TURN_NOISE * turned)
    kept = _sway(plan, rows, move, error_factor, turn, random % NOISE_ENTRIES, both_sides, BEND_ANGLES)
    return kept or _sway(
        plan, rows, move, 2.0 * error_factor, 2.0 * turn, (random + 499) % NOISE_ENTRIES, both_sides, WIDE_BEND_ANGLES
    )


def _sway(
    plan: IndexedPlan,
    rows: list[Row],
    move: Point,
    error_factor: float,
    turn: float,
    k: int,
    both_sides: bool,
    bends: tuple[float, ...],
) -> list[Row]:
    dx, dy = move
    x0, y0 = plan.plan.origin
    move_error, stretch = error_factor * (MOVE_ERROR * hypot(dx, dy) + PLACE_ERROR), error_factor * STRETCH_NOISE
    crosses = plan.crosses
    kept: list[Row] = []
    blocked: list[Row] = []
    noise = chain(NOISE_TABLE[k + 1 :], cycle(NOISE_TABLE))
    for row, (ex, ey, eh, es) in zip(rows, noise, strict=False):
        x, y, a, b, w, level, origin, _ = row
        s = 1.0 + STRETCH_DECAY * (1.0 - a * a - b * b) + stretch * es
        h = turn * eh
        a1, b1 = a * s - b * h, b * s + a * h
        nx, ny = x + a1 * dx - b1 * dy + move_error * ex, y + b1 * dx + a1 * dy + move_error * ey
        if crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
            blocked.append(row)
        else:
            kept.append((nx, ny, a1, b1, w, level, origin, 0))
    k += len(rows)
    for row in blocked:
        x, y, a, b, w, level, origin, _ = row
        k = (k + 367) % NOISE_ENTRIES
        ex, ey, eh, es = NOISE_TABLE[k]
        side, passed = (1.0 if eh > 0.0 else -1.0), False
        px, py = x0 + x, y0 + y
        error_x, error_y = 2.0 * move_error * ex, 2.0 * move_error * ey
        for bend in bends:
            w *= BEND_WEIGHT
            # bend to one side, then to the other; the row keeps the changed heading
            for h in (side * bend, -side * bend):
                h, s = h + turn * es, 1.0 - 0.5 * h * h
                a1, b1 = a * s - b * h, b * s + a * h
                nx, ny = x + a1 * dx - b1 * dy + error_x, y + b1 * dx + a1 * dy + error_y
                if not crosses(level, px, py, x0 + nx, y0 + ny):
                    kept.append((nx, ny, a1, b1, w, level, origin, 0))
                    passed = True
                    if not both_sides:
                        break
            if passed:
                break
        if not passed and is_near_landing(plan, level, px, py):
            kept.append((x, y, a, b, row[4] * STAY_WEIGHT, level, origin, 0))
    return kept
