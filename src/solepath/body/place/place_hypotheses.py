"""Hypotheses of the wearer's place, for any method: moves at each stride, across gaps, and on stairs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import cos, hypot, pi, sin

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from ...types.attrs import define, field, frozen
from ..part import Part
from .noise import NOISE, ROWS, next_random
from .rows import Row, resampled, rounded

LONGEST_MOVE = 4.0
"""Longest move between two strides, m; a longer one is across a gap, and its path is not known."""
OUTSIDE_WEIGHT = 0.25
"""Factor of the weight of rows outside of the plan, at each check."""
ABOUT_TURN = 2.0
"""Least turn that may be badly wrong, rad: on the spot a foot turns faster than many gyroscopes can measure."""
WRONG_TURN_SHARE = 0.1
"""Share of such turns that are wrong."""
HEADINGS, ROWS_PER_HEADING = 12, 8
"""Number of headings that are then possible, and number of rows with each of them."""


@frozen
class PlaceSettings:
    """Settings of any method."""

    most: int = 260
    """Largest number of rows that are kept."""


@define
class PlaceHypotheses(Part, ABC):
    """The rows of one wearer; each method has its own way to extend them."""

    settings: PlaceSettings = PlaceSettings()
    rows: list[Row] = field(factory=list, init=False)
    """The rows, at most `PlaceSettings.most`."""
    random: int = field(default=1, init=False)
    """State of the random numbers (noise.py)."""

    @abstractmethod
    def extend(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """Return the rows after a move (m, track), without those that cannot go there.

        `rough`: factor of the track's usual errors. `turned`: turn of the wearer in the move, rad, not negative."""

    @abstractmethod
    def scatter(self, k: int, count: int) -> tuple[float, float, float, float]:
        """Return offsets for the k-th of `count` new rows, each from -1 to 1: x, y, heading, stretch."""

    @abstractmethod
    def thin(self, rows: list[Row], count: int) -> list[Row]:
        """Return about `count` rows that stand for all."""

    def set_rows(self, rows: list[Row]) -> None:
        """Set the rows, or as many as may be kept that stand for them."""
        most = self.settings.most
        self.rows = rounded(rows if len(rows) <= most else self.thin(rows, most))

    def move_rows(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """Return all rows after a move (m, track)."""
        dx, dy = move
        changing = [row for row in rows if row[7]]
        walking = [row for row in rows if not row[7]] if changing else rows
        if hypot(dx, dy) > LONGEST_MOVE:
            walking = self._jumped(plan, walking, move)
        elif walking:
            walking = self.extend(plan, walking, move, rough, turned)
        # on stairs a row follows the track: the walls around them are those of one level or the other
        moved = [
            (x + a * dx - b * dy, y + b * dx + a * dy, a, b, w, level, origin, held)
            for x, y, a, b, w, level, origin, held in changing
        ]
        return moved + walking

    def _jumped(self, plan: IndexedPlan, rows: list[Row], move: Point) -> list[Row]:
        """Return the rows after a gap: the straight path may cross walls, but its end must be within the plan."""
        dx, dy = move
        off = 0.3 * hypot(dx, dy)
        x0, y0 = plan.plan.origin
        self.random = next_random(self.random)
        kept: list[Row] = []
        for k, (x, y, a, b, w, level, origin, held) in enumerate(rows):
            for j in (0, 1):
                ex, ey, _, _ = NOISE[(self.random + 2 * k + j) % ROWS]
                nx, ny = x + a * dx - b * dy + off * ex, y + b * dx + a * dy + off * ey
                if plan.inside(level, nx + x0, ny + y0):
                    kept.append((nx, ny, a, b, w, level, origin, held))
        most = self.settings.most
        return kept if len(kept) <= most else resampled(kept, most, 0.5)


def penalise_outside(plan: IndexedPlan, rows: list[Row]) -> list[Row]:
    """Return the rows with less weight where they are outside of the plan."""
    x0, y0 = plan.plan.origin
    seen: list[Row] = []
    for row in rows:
        x, y, a, b, w, level, came, held = row
        there = held or plan.inside(level, x0 + x, y0 + y)
        seen.append(row if there else (x, y, a, b, OUTSIDE_WEIGHT * w, level, came, held))
    return seen


def wrong_turns(plan: IndexedPlan, rows: list[Row], since: Point) -> list[Row]:
    """Return rows of all headings for an about-turn that the track may have wrong, few and of low weight.

    The walls decide between them. `since`: displacement since the turn, m, track."""
    dx, dy = since
    x0, y0 = plan.plan.origin
    some = resampled([row for row in rows if not row[7]], ROWS_PER_HEADING, 0.5)
    total, drawn = sum([row[4] for row in rows]), sum([row[4] for row in some])
    added: list[Row] = []
    if not drawn > 0.0:
        return added
    share = WRONG_TURN_SHARE * total / drawn / (HEADINGS - 1)
    for k in range(1, HEADINGS):
        c, s = cos(2.0 * pi * k / HEADINGS), sin(2.0 * pi * k / HEADINGS)
        for x, y, a, b, w, level, came, held in some:
            px, py = x - (a * dx - b * dy), y - (b * dx + a * dy)
            a1, b1 = a * c - b * s, b * c + a * s
            nx, ny = px + a1 * dx - b1 * dy, py + b1 * dx + a1 * dy
            if not plan.crosses(level, x0 + px, y0 + py, x0 + nx, y0 + ny):
                added.append((nx, ny, a1, b1, share * w, level, came, held))
    return added
