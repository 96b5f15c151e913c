"""How readings of the track go on, whatever the method: a step at a time, across gaps, and on stairs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import cos, hypot, pi, sin

from ...floorplan.index import IndexedPlan
from ...floorplan.plan import Point
from ...types.attrs import define, field, frozen
from ..part import Part
from .crowd import Row, resampled, rounded
from .noise import NOISE, ROWS, following

JUMP = 4.0
"""A move of more than this between two steps is across a gap, m: which way it went is not known."""
OUT = 0.25
"""Who has left the plan counts so much less than those within, each time it is looked."""
ABOUT = 2.0
"""A turn by more than this, rad, may be told badly wrong: on the spot a foot turns faster than many gyroscopes tell."""
MISTOLD = 0.1
"""How often it is."""
WAYS, OF_THEM = 12, 8
"""So many headings are then possible, and so many readings take each."""


@frozen
class ReadingsSettings:
    """What `Readings` are set to, whatever the method."""

    most: int = 260
    """More readings of the track than this are never kept."""


@define
class Readings(Part, ABC):
    """How a method extends readings is its own; what is left is here."""

    settings: ReadingsSettings = ReadingsSettings()
    crowd: list[Row] = field(factory=list, init=False)
    random: int = field(default=1, init=False)

    @abstractmethod
    def extended(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """The rows a move (m, track) further; without those that cannot go there. `rough`: how much worse than usual
        the track is. `turned`: by how much the wearer has turned with it, rad, not negative."""

    @abstractmethod
    def scattered(self, k: int, count: int) -> tuple[float, float, float, float]:
        """For the k-th of `count` new rows, each from -1 to 1: x, y, heading, stretch."""

    @abstractmethod
    def thinned(self, rows: list[Row], wanted: int) -> list[Row]:
        """About so many rows that stand for all."""

    def keep(self, rows: list[Row]) -> None:
        """These from now on, or as many that stand for them."""
        most = self.settings.most
        self.crowd = rounded(rows if len(rows) <= most else self.thinned(rows, most))

    def stepped(self, plan: IndexedPlan, rows: list[Row], move: Point, rough: float, turned: float) -> list[Row]:
        """All rows a move (m, track) further."""
        dx, dy = move
        changing = [row for row in rows if row[7]]
        walking = [row for row in rows if not row[7]] if changing else rows
        if hypot(dx, dy) > JUMP:
            walking = self._jumped(plan, walking, move)
        elif walking:
            walking = self.extended(plan, walking, move, rough, turned)
        # on stairs one goes as the track says: the walls around them are those of one level or the other
        carried = [
            (x + a * dx - b * dy, y + b * dx + a * dy, a, b, w, level, origin, held)
            for x, y, a, b, w, level, origin, held in changing
        ]
        return carried + walking

    def _jumped(self, plan: IndexedPlan, rows: list[Row], move: Point) -> list[Row]:
        """Across a gap: walls on the straight way say nothing, but the end must be somewhere."""
        dx, dy = move
        off = 0.3 * hypot(dx, dy)
        x0, y0 = plan.plan.origin
        self.random = following(self.random)
        kept: list[Row] = []
        for k, (x, y, a, b, w, level, origin, held) in enumerate(rows):
            for j in (0, 1):
                ex, ey, _, _ = NOISE[(self.random + 2 * k + j) % ROWS]
                nx, ny = x + a * dx - b * dy + off * ex, y + b * dx + a * dy + off * ey
                if plan.inside(level, nx + x0, ny + y0):
                    kept.append((nx, ny, a, b, w, level, origin, held))
        most = self.settings.most
        return kept if len(kept) <= most else resampled(kept, most, 0.5)


def looked(plan: IndexedPlan, rows: list[Row]) -> list[Row]:
    """Who is where nobody can be counts less."""
    x0, y0 = plan.plan.origin
    seen: list[Row] = []
    for row in rows:
        x, y, a, b, w, level, came, held = row
        there = held or plan.inside(level, x0 + x, y0 + y)
        seen.append(row if there else (x, y, a, b, OUT * w, level, came, held))
    return seen


def mistold(plan: IndexedPlan, rows: list[Row], since: Point) -> list[Row]:
    """Rows of all headings for an about-turn that the track may have wrong: few and little believed, for the walls to
    decide. `since`: the way since the turn, m, track."""
    dx, dy = since
    x0, y0 = plan.plan.origin
    some = resampled([row for row in rows if not row[7]], OF_THEM, 0.5)
    total, drawn = sum([row[4] for row in rows]), sum([row[4] for row in some])
    added: list[Row] = []
    if not drawn > 0.0:
        return added
    share = MISTOLD * total / drawn / (WAYS - 1)
    for k in range(1, WAYS):
        c, s = cos(2.0 * pi * k / WAYS), sin(2.0 * pi * k / WAYS)
        for x, y, a, b, w, level, came, held in some:
            px, py = x - (a * dx - b * dy), y - (b * dx + a * dy)
            a1, b1 = a * c - b * s, b * c + a * s
            nx, ny = px + a1 * dx - b1 * dy, py + b1 * dx + a1 * dy
            if not plan.crosses(level, x0 + px, y0 + py, x0 + nx, y0 + ny):
                added.append((nx, ny, a1, b1, share * w, level, came, held))
    return added
