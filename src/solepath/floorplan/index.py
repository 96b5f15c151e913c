"""A floor plan made ready for questions that are asked thousands of times a step.

`crosses` costs 2 us for a step's move (crossing.py), `inside` 1 to 5 us (rooms.py, enclosure.py). Making it takes about
0.1 ms a wall, some seconds for the largest plans that can be used; no later question has to wait for any of that. It is
no machine and is not saved: with the same plan it is the same again.
"""

from __future__ import annotations

from math import isfinite

from .checks import unusable
from .crossing import MOST_CELLS, Walls
from .enclosure import MOST_PLACES, Enclosure
from .grid import CELLS, PLACES, share
from .outlines import Ring
from .plan import FloorPlan, FloorPlanError
from .rooms import MOST_CELLS as MOST_ROOM_CELLS
from .rooms import Rooms

THICKEST = 2000
"""Walls around one place: a move is tried against all of them."""


class IndexedPlan:
    """`plan` with its walls in grids. Levels are told by their place in `plan.levels`. FloorPlanError when the plan
    cannot be used."""

    __slots__ = ("_insides", "_numbers", "_walls", "fingerprint", "plan")

    def __init__(self, plan: FloorPlan) -> None:
        why_not = unusable(plan)
        if why_not is not None:
            raise FloorPlanError(why_not)
        self.plan = plan
        self.fingerprint: int = plan.fingerprint
        self._numbers = {level.id: number for number, level in enumerate(plan.levels)}
        count = len(plan.levels)
        cells = share(MOST_CELLS, CELLS, count)
        self._walls = [Walls([(wall.start, wall.end) for wall in level.walls], cells) for level in plan.levels]
        for level, walls in zip(plan.levels, self._walls, strict=True):
            thickest, (x, y) = walls.thickest
            if thickest > THICKEST:
                raise FloorPlanError(f"level {level.id!r}: {thickest} walls lie around ({x:.0f}, {y:.0f})")
        outlines: list[list[Ring]] = [[] for _ in plan.levels]
        for stop in [stop for one in plan.connectors for stop in one.stops]:
            outlines[self._numbers[stop.level]].append(stop.outline)
        room_cells = share(MOST_ROOM_CELLS, CELLS, count)
        places = share(MOST_PLACES, PLACES, sum([not level.rooms for level in plan.levels]))
        self._insides: list[Rooms | Enclosure] = [
            Rooms(level, tuple(here), room_cells) if level.rooms else Enclosure(level, walls, places)
            for level, walls, here in zip(plan.levels, self._walls, outlines, strict=True)
        ]

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
        return self._insides[level].inside(x, y)
