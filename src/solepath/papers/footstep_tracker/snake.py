"""Snake game on the floor plan, after Liu et al. 2015 (IEEE MASS), section IV.E and figure 14.

The paper has traces of the wearer's path, which are rows here (place/rows.py). Rows start at all stairs and
elevators of the plan, in evenly spaced headings. Each row moves with every stride of the track, and those that run into
a wall are dropped. The last one left is the wearer's.

The paper has no more detail. As printed (`PrintedSnake`) each row moves as the track does, and a row that meets a
wall is dropped. A track errs by some per cent in length and by some degrees in each turn, so even the right row would
run into a wall before long. Therefore the heading and stretch of each row vary a little at random from
stride to stride (sway.py). A row that meets a wall is replaced by two that pass the wall on either side. They have less
weight, and keep the heading with which they passed. Rows that have become nearly equal are merged.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from math import atan2

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from ...place.placing import Placing
from ...place.rows.noise import next_random
from ...place.rows.rows import Row, resample_rows
from ...place.rows.sway import sway_rows
from ...types.attrs import define

CELL_SIZE = 0.25
"""Edge length of the square cells of one level, m: rows in one cell may be merged."""
HEADING_SECTOR = 0.03
"""Width of the sectors of heading, rad: rows in one sector may be merged."""
STRETCH_INTERVAL = 0.02
"""Width of the intervals of the stretch, which is about 1: rows in one interval may be merged."""
MERGED_SHARE = 0.8
"""Least share of the requested number of rows that must be left for the merged rows to be kept as they are."""


@define
class SnakeGame(Placing):
    """Keeps rows from all stairs and elevators, and drops those that find no way past a wall until one is left."""

    def extend(self, plan: IndexedPlan, rows: list[Row], move: Point, error_factor: float, turned: float) -> list[Row]:
        self.random = next_random(self.random)
        extended = sway_rows(plan, rows, move, error_factor, turned, self.random, both_sides=True)
        max_rows = self.settings.max_rows
        return extended if len(extended) <= max_rows else self.thin(extended, max_rows)

    def scatter(self, k: int, count: int) -> tuple[float, float, float, float]:
        return (0.0, 0.0, 0.0, float(k % 3 - 1))

    def thin(self, rows: list[Row], count: int) -> list[Row]:
        """Return about `count` rows: merge those that are nearly equal, then draw by weight, perhaps repeatedly."""
        merged = merge_rows(rows) if len(rows) > count else rows
        return merged if MERGED_SHARE * count < len(merged) <= count else resample_rows(merged, count, 0.5)


@define
class PrintedSnake(Placing):
    """Keeps rows from all stairs and elevators, and drops those that meet a wall, as printed."""

    def extend(self, plan: IndexedPlan, rows: list[Row], move: Point, error_factor: float, turned: float) -> list[Row]:
        return moved_rows(plan, rows, move)

    def scatter(self, k: int, count: int) -> tuple[float, float, float, float]:
        return (0.0, 0.0, 0.0, 0.0)

    def thin(self, rows: list[Row], count: int) -> list[Row]:
        """Return all rows; only those beyond the largest number are drawn by weight."""
        return rows if len(rows) <= self.settings.max_rows else resample_rows(rows, self.settings.max_rows, 0.5)


def moved_rows(plan: IndexedPlan, rows: list[Row], move: Point) -> list[Row]:
    """Return the rows after a move of the track, m, without those that cross a wall; the others keep their weights."""
    (dx, dy), (x0, y0) = move, plan.plan.origin
    kept = []
    for x, y, a, b, w, level, origin, _ in rows:
        nx, ny = x + a * dx - b * dy, y + b * dx + a * dy
        if not plan.crosses(level, x0 + x, y0 + y, x0 + nx, y0 + ny):
            kept.append((nx, ny, a, b, w, level, origin, 0))
    return kept


def merge_rows(rows: list[Row]) -> list[Row]:
    """Merge rows of equal cell, heading and stretch into the heaviest of them, which gets the sum of their weights."""
    heaviest: dict[tuple[int, int, int, int, int, int], Row] = {}
    for row in rows:
        x, y, a, b, w, level, origin, landing = row
        key = (
            level,
            landing,
            int(x // CELL_SIZE),
            int(y // CELL_SIZE),
            int(atan2(b, a) // HEADING_SECTOR),
            int((a * a + b * b) // (2.0 * STRETCH_INTERVAL)),  # the square varies twice as much as the stretch
        )
        known_row = heaviest.get(key)
        if known_row is None:
            heaviest[key] = row
        elif w > known_row[4]:
            heaviest[key] = (x, y, a, b, w + known_row[4], level, origin, landing)
        else:
            heaviest[key] = (*known_row[:4], known_row[4] + w, *known_row[5:])
    return list(heaviest.values())
