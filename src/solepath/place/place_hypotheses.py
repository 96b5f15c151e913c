"""Hypotheses of the wearer's place (rows), for any method: how they move at strides, across gaps and on stairs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import cos, fsum, hypot, pi, sin

from ..body.part import Part
from ..floorplan.index import IndexedPlan
from ..floorplan.plan import Point
from ..types.attrs import define, field, frozen
from .rows.noise import NOISE_ENTRIES, NOISE_TABLE, next_random
from .rows.rows import Row, resample_rows, round_rows

MAX_MOVE = 4.0
"""Longest move between two strides, m; a longer move is across a gap, in which the path is not known."""
OUTSIDE_WEIGHT = 0.25
"""Factor by which each check reduces the weight of rows outside of the plan."""
ABOUT_TURN_ANGLE = 2.0
"""Least turn whose angle may be very wrong, rad, because a turn on the spot exceeds the range of many gyroscopes."""
WRONG_TURN_SHARE = 0.1
"""Share of turns above `ABOUT_TURN_ANGLE` whose angle is wrong."""
HEADING_COUNT, ROWS_PER_HEADING = 12, 8
"""Number of headings that are tried after such a turn, and number of rows for each heading."""
GAP_ERROR = 0.3
"""Largest error of a move across a gap on each axis, as a share of its length."""


@frozen
class PlaceSettings:
    """The settings of every placing method."""

    max_rows: int = 260
    """Largest number of rows that are kept."""


@define
class PlaceHypotheses(Part, ABC):
    """The rows of one wearer; each method implements how they are extended."""

    settings: PlaceSettings = PlaceSettings()
    rows: list[Row] = field(factory=list, init=False)
    """The rows, at most `PlaceSettings.max_rows`."""
    random: int = field(default=1, init=False)
    """State of the random numbers (noise.py)."""

    @abstractmethod
    def extend(self, plan: IndexedPlan, rows: list[Row], move: Point, error_factor: float, turned: float) -> list[Row]:
        """Return the rows after a move of the track, m, without rows for which the plan forbids it.

        `error_factor` is a factor of the track's usual errors, `turned` the size of the wearer's turn, rad."""

    @abstractmethod
    def scatter(self, k: int, count: int) -> tuple[float, float, float, float]:
        """Return offsets for the k-th of `count` new rows, each from -1 to 1: x, y, heading, stretch."""

    @abstractmethod
    def thin(self, rows: list[Row], count: int) -> list[Row]:
        """Return about `count` rows that represent the distribution of all rows."""

    def set_rows(self, rows: list[Row]) -> None:
        """Set the rows, thinned to the largest number that may be kept."""
        max_rows = self.settings.max_rows
        self.rows = round_rows(rows if len(rows) <= max_rows else self.thin(rows, max_rows))

    def move_rows(
        self, plan: IndexedPlan, rows: list[Row], move: Point, error_factor: float, turned: float
    ) -> list[Row]:
        """Return all rows after a move of the track, m."""
        dx, dy = move
        changing = [row for row in rows if row[7]]
        walking = [row for row in rows if not row[7]] if changing else rows
        if hypot(dx, dy) > MAX_MOVE:
            walking = self._move_across_gap(plan, walking, move)
        elif walking:
            walking = self.extend(plan, walking, move, error_factor, turned)
        # on stairs a row follows the track, because the walls of neither level apply
        moved = [
            (x + a * dx - b * dy, y + b * dx + a * dy, a, b, w, level, origin, landing)
            for x, y, a, b, w, level, origin, landing in changing
        ]
        return moved + walking

    def _move_across_gap(self, plan: IndexedPlan, rows: list[Row], move: Point) -> list[Row]:
        """Return the rows after a gap that are within the plan; the straight line to them may cross walls."""
        dx, dy = move
        move_error = GAP_ERROR * hypot(dx, dy)
        x0, y0 = plan.plan.origin
        self.random = next_random(self.random)
        kept: list[Row] = []
        for k, (x, y, a, b, w, level, origin, landing) in enumerate(rows):
            for j in (0, 1):
                ex, ey, _, _ = NOISE_TABLE[(self.random + 2 * k + j) % NOISE_ENTRIES]
                nx, ny = x + a * dx - b * dy + move_error * ex, y + b * dx + a * dy + move_error * ey
                if plan.inside(level, nx + x0, ny + y0):
                    kept.append((nx, ny, a, b, w, level, origin, landing))
        max_rows = self.settings.max_rows
        return kept if len(kept) <= max_rows else resample_rows(kept, max_rows, 0.5)


def penalise_outside(plan: IndexedPlan, rows: list[Row]) -> list[Row]:
    """Return the rows, with less weight for rows outside of the plan."""
    x0, y0 = plan.plan.origin
    weighted: list[Row] = []
    for row in rows:
        x, y, a, b, w, level, origin, landing = row
        there = landing or plan.inside(level, x0 + x, y0 + y)
        weighted.append(row if there else (x, y, a, b, OUTSIDE_WEIGHT * w, level, origin, landing))
    return weighted


def rows_after_wrong_turn(plan: IndexedPlan, rows: list[Row], displacement: Point) -> list[Row]:
    """Return a few rows of low weight in all headings, because the track's angle of an about-turn may be wrong.

    The walls decide between them. `displacement` is the track's since the turn, m."""
    dx, dy = displacement
    x0, y0 = plan.plan.origin
    drawn_rows = resample_rows([row for row in rows if not row[7]], ROWS_PER_HEADING, 0.5)
    total, drawn = fsum([row[4] for row in rows]), fsum([row[4] for row in drawn_rows])
    added: list[Row] = []
    if not drawn > 0.0:
        return added
    share = WRONG_TURN_SHARE * total / drawn / (HEADING_COUNT - 1)
    for k in range(1, HEADING_COUNT):
        for j, (x, y, a, b, w, level, origin, landing) in enumerate(drawn_rows):
            # evenly spaced over the sector of each heading
            turn = 2.0 * pi * (k + (j + 0.5) / len(drawn_rows) - 0.5) / HEADING_COUNT
            c, s = cos(turn), sin(turn)
            px, py = x - (a * dx - b * dy), y - (b * dx + a * dy)
            a1, b1 = a * c - b * s, b * c + a * s
            nx, ny = px + a1 * dx - b1 * dy, py + b1 * dx + a1 * dy
            if not plan.crosses(level, x0 + px, y0 + py, x0 + nx, y0 + ny):
                added.append((nx, ny, a1, b1, share * w, level, origin, landing))
    return added
