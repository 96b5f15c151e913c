"""A floor plan made ready for questions that are asked thousands of times a step.

`crosses` costs 2 us for a step's move (crossing.py), `inside` 1 to 3 us (rooms.py, enclosure.py). Making it costs about
0.13 ms a wall, and the first `inside` of a level up to 100 ms. It is no machine and is not saved: with the same plan it
is the same again.
"""

from __future__ import annotations

from math import hypot, isfinite

from .checks import unusable
from .crossing import Walls
from .enclosure import Enclosure
from .plan import Connector, FloorPlan, FloorPlanError, Kind, Stop
from .rooms import Rooms


class IndexedPlan:
    """`plan` with its walls in grids. Levels are told by their place in `plan.levels`. FloorPlanError when the plan
    cannot be used."""

    __slots__ = ("_insides", "_numbers", "_stops", "_walls", "fingerprint", "plan")

    def __init__(self, plan: FloorPlan) -> None:
        why_not = unusable(plan)
        if why_not is not None:
            raise FloorPlanError(why_not)
        self.plan = plan
        self.fingerprint: int = plan.fingerprint
        self._numbers = {level.id: number for number, level in enumerate(plan.levels)}
        self._walls = [Walls([(wall.start, wall.end) for wall in level.walls]) for level in plan.levels]
        self._stops: list[tuple[tuple[Connector, Stop], ...]] = [
            tuple((one, stop) for one in plan.connectors for stop in one.stops if stop.level == level.id)
            for level in plan.levels
        ]
        self._insides: list[Rooms | Enclosure | None] = [None] * len(plan.levels)

    def number(self, level: str) -> int:
        """The place of the level with this id in `plan.levels`. FloorPlanError when there is none."""
        found = self._numbers.get(level)
        if found is None:
            self.plan.level(level)  # raises, and says which there are
        return found or 0

    def crosses(self, level: int, x0: float, y0: float, x1: float, y1: float) -> bool:
        """Whether the straight move from (x0, y0) to (x1, y1), m, meets a solid wall of this level; to touch it, or a
        corner, is to meet it. Doors are free: they are gaps. Any floats will do; a move from or to what is no place
        (NaN, infinity) meets one."""
        return self._walls[level].crosses(x0, y0, x1, y1)

    def inside(self, level: int, x: float, y: float) -> bool:
        """Whether (x, y), m, is where one can be: in a room, a stairwell or a cabin, or on a doorstep, where the level
        has rooms; otherwise within what its walls and doors enclose, or within the hull of all walls where they do not
        close. False on a level without walls and rooms, and for what is no place."""
        if not (isfinite(x) and isfinite(y)):
            return False
        known = self._insides[level]
        if known is None:
            known = self._insides[level] = self._made(level)
        return known.inside(x, y)

    def _made(self, number: int) -> Rooms | Enclosure:
        level = self.plan.levels[number]
        if level.rooms:
            return Rooms(level, tuple(stop.outline for _, stop in self._stops[number]))
        return Enclosure(level)

    def stops(self, level: int, kind: Kind | None = None) -> tuple[tuple[Connector, Stop], ...]:
        """The connectors that stop at this level, of one kind or of all, each with that stop."""
        return tuple(pair for pair in self._stops[level] if kind is None or pair[0].kind is kind)

    def nearest(self, level: int, x: float, y: float, kind: Kind | None = None) -> tuple[Connector, Stop, float] | None:
        """The connector whose stop at this level is the nearest to (x, y), that stop, and how far off it is as the crow
        flies, m; None when none stops here. 0.3 us for each that does."""
        best, least = None, 0.0
        for pair in self._stops[level]:
            if kind is None or pair[0].kind is kind:
                away = hypot(pair[1].place[0] - x, pair[1].place[1] - y)
                if best is None or away < least:
                    best, least = pair, away
        return None if best is None else (*best, least)
