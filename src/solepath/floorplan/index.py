"""A floor plan, indexed for thousands of queries during each stride.

`crosses` takes 1.5 us for a move of the length of a step (crossing.py), `inside` 1 to 5 us (rooms.py, enclosure.py),
`room` 1 us (room_names.py), and `door` 1 us where no named door is near (door_names.py).
Construction takes about 0.1 ms for each wall, some seconds for the largest usable plans. The index is not saved: the
same plan gives the same index again."""

from __future__ import annotations

from math import isfinite

from .checks import find_fault
from .crossing import MAX_CELLS, Walls
from .door_names import DoorNames
from .enclosure import MAX_LATTICE_POINTS, Enclosure
from .grid import MAX_CELLS_PER_PLAN, MAX_LATTICE_POINTS_PER_PLAN, share_limit
from .outlines import Ring
from .plan import FloorPlan, FloorPlanError, Point
from .room_names import MAX_CELLS as MAX_NAME_CELLS
from .room_names import RoomNames
from .rooms import MAX_CELLS as MAX_ROOM_CELLS
from .rooms import Rooms

MAX_WALLS_NEAR = 2000
"""Largest number of walls that one cell of the grid lists: a move is tested against all of them."""


class IndexedPlan:
    """A floor plan with its walls in grids; levels are numbered by their index in `plan.levels`.

    Raises FloorPlanError when the plan cannot be used."""

    __slots__ = ("_door_names", "_insides", "_numbers", "_room_names", "_walls", "fingerprint", "plan", "stop_places")

    def __init__(self, plan: FloorPlan) -> None:
        fault = find_fault(plan)
        if fault is not None:
            raise FloorPlanError(fault)
        self.plan = plan
        self.fingerprint: int = plan.fingerprint
        self._numbers = {level.id: number for number, level in enumerate(plan.levels)}
        count = len(plan.levels)
        cells = share_limit(MAX_CELLS, MAX_CELLS_PER_PLAN, count)
        self._walls = [Walls([(wall.start, wall.end) for wall in level.walls], cells) for level in plan.levels]
        for level, walls in zip(plan.levels, self._walls, strict=True):
            densest, (x, y) = walls.densest_cell
            if densest > MAX_WALLS_NEAR:
                raise FloorPlanError(f"level {level.id!r}: {densest} walls lie around ({x:.0f}, {y:.0f})")
        outlines: list[list[Ring]] = [[] for _ in plan.levels]
        self.stop_places: list[list[Point]] = [[] for _ in plan.levels]
        """Places at which stairs and elevators are entered and left, m, plan frame, of each level."""
        for stop in [stop for connector in plan.connectors for stop in connector.stops]:
            self.stop_places[self._numbers[stop.level]].append(stop.place)
            outlines[self._numbers[stop.level]].append(stop.outline)
        room_cells = share_limit(MAX_ROOM_CELLS, MAX_CELLS_PER_PLAN, count)
        n_enclosures = sum([not level.rooms for level in plan.levels])
        points = share_limit(MAX_LATTICE_POINTS, MAX_LATTICE_POINTS_PER_PLAN, n_enclosures)
        self._insides: list[Rooms | Enclosure] = [
            Rooms(level, tuple(level_outlines), room_cells) if level.rooms else Enclosure(level, walls, points)
            for level, walls, level_outlines in zip(plan.levels, self._walls, outlines, strict=True)
        ]
        name_cells = share_limit(MAX_NAME_CELLS, MAX_CELLS_PER_PLAN, count)
        self._room_names = [RoomNames(level, name_cells) if any(level.room_names) else None for level in plan.levels]

        self._door_names = [
            DoorNames(level, name_cells) if any([door.name for door in level.doors]) else None for level in plan.levels
        ]

    def number(self, level: str) -> int:
        """Return the index in `plan.levels` of the level with this id; raise FloorPlanError when there is none."""
        if level not in self._numbers:
            self.plan.level(level)  # raises, and names the levels that exist
        return self._numbers[level]

    def crosses(self, level: int, x0: float, y0: float, x1: float, y1: float) -> bool:
        """Return whether the straight move from (x0, y0) to (x1, y1), m, meets a solid wall of this level.

        Touching a wall or a corner counts. Doors are gaps. Accepts any floats; True for a move with an end that is NaN
        or infinite."""
        return self._walls[level].crosses(x0, y0, x1, y1)

    def inside(self, level: int, x: float, y: float) -> bool:
        """Return whether a person can be at (x, y), m, plan frame, on this level.

        On a level with rooms, a person can be in rooms, stairwells, elevator cabins and doorsteps; on any other level,
        in the area that walls and doors enclose, or in the hull of all walls if they do not close. False on a level
        without walls and rooms, and for NaN or infinity."""
        if not (isfinite(x) and isfinite(y)):
            return False
        return self._insides[level].inside(x, y)

    def room(self, level: int, x: float, y: float) -> str | None:
        """Return the name of the room at (x, y), m, plan frame, on this level; None outside of all named rooms.

        The smallest of several named rooms counts. Accepts any floats."""
        room_names = self._room_names[level]
        return None if room_names is None else room_names.find(x, y)

    def door(self, level: int, x: float, y: float) -> str | None:
        """Return the name of the nearest door within 1.5 m of (x, y), m, plan frame, on this level; None without one.

        Doors without a name, and those behind a wall, do not count. Accepts any floats."""
        door_names = self._door_names[level]
        if door_names is not None:
            for door, at_x, at_y in door_names.near(x, y):
                if not self.crosses(level, x, y, at_x, at_y):
                    return door.name
        return None
