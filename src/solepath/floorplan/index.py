"""A floor plan, indexed for thousands of queries during each stride.

`crosses` takes 1.5 us for a move of the length of a step (walls.py), `inside` 1 to 5 us (rooms.py, enclosure.py),
`room` and `door` 1 us. Construction takes about 0.1 ms for each wall, some seconds for the largest usable plans. The
index is not saved: the same plan gives the same index again."""

from __future__ import annotations

from math import isfinite

from ..types.attrs import frozen
from .checks import find_fault, scale_cells
from .enclosure import Enclosure
from .plan import ConnectorKind, FloorPlan, FloorPlanError, Point
from .rooms import Rooms
from .walls import Walls

MAX_WALLS_NEAR = 2000
"""Largest number of walls that one cell lists: a move is tested against all of them."""


@frozen
class Landing:
    """A landing: the stop of a connector (stairs or elevator) on one level, where it is entered and left."""

    index: int
    """Index among all landings of the plan, plus one."""
    connector: int
    """Index of the connector in the plan."""
    kind: ConnectorKind
    level: int
    """Index of the level in the plan."""
    ordinal: int
    """Ordinal of the level among the storeys."""
    elevation: float
    """Elevation of the level, m."""
    place: Point
    """Place, m, plan frame."""

    def distance(self, to: Landing) -> float:
        """Return the difference of the elevations, m."""
        return abs(to.elevation - self.elevation)


class IndexedPlan:
    """A floor plan with its walls, rooms and doors in cells; levels are numbered by their index in `plan.levels`.

    Raises FloorPlanError when the plan cannot be used."""

    __slots__ = ("_insides", "_numbers", "_rooms", "fingerprint", "landings", "plan", "stop_places", "walls")

    def __init__(self, plan: FloorPlan) -> None:
        fault = find_fault(plan)
        if fault is not None:
            raise FloorPlanError(fault)
        self.plan = plan
        self.fingerprint: int = plan.fingerprint
        self._numbers = {level.id: number for number, level in enumerate(plan.levels)}
        stops = [(c, one.kind, plan.level(stop.level), stop)
                 for c, one in enumerate(plan.connectors) for stop in one.stops]  # fmt: skip
        self.landings = [
            Landing(index, c, kind, self._numbers[level.id], level.ordinal, level.elevation, stop.place)
            for index, (c, kind, level, stop) in enumerate(stops, 1)
        ]
        """All landings, connector by connector, from the lowest up."""
        self.stop_places = [[one.place for one in self.landings if one.level == k] for k in range(len(plan.levels))]
        """Places at which stairs and elevators are entered and left, m, plan frame, of each level."""
        scale = scale_cells(plan)
        self.walls = [Walls([wall.line for wall in level.walls], scale) for level in plan.levels]
        for level, walls in zip(plan.levels, self.walls, strict=True):
            densest, x, y = walls.find_densest()
            if densest > MAX_WALLS_NEAR:
                raise FloorPlanError(f"level {level.id!r}: {densest} walls lie around ({x:.0f}, {y:.0f})")
        self._rooms = [
            Rooms(level, [stop.outline for *_, stop in stops if stop.level == level.id], scale) for level in plan.levels
        ]
        self._insides: list[Rooms | Enclosure] = [
            rooms if level.rooms else Enclosure(level, walls, len(plan.levels))
            for level, walls, rooms in zip(plan.levels, self.walls, self._rooms, strict=True)
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
        return self.walls[level].crosses(x0, y0, x1, y1)

    def inside(self, level: int, x: float, y: float) -> bool:
        """Return whether a person can be at (x, y), m, plan frame, on this level.

        On a level with rooms, a person can be in rooms, stairwells, elevator cabins and doorsteps; on any other level,
        in the area that walls and doors enclose, or in the hull of all walls if they do not close. False on a level
        without walls and rooms, and for NaN or infinity."""
        return isfinite(x) and isfinite(y) and self._insides[level].inside(x, y)

    def room(self, level: int, x: float, y: float) -> str | None:
        """Return the name of the room at (x, y), m, plan frame, on this level; None outside of all named rooms.

        The smallest of several named rooms counts. Accepts any floats."""
        return next(filter(None, self._rooms[level].find(x, y)), None)

    def door(self, level: int, x: float, y: float) -> str | None:
        """Return the name of the nearest door within 1.5 m of (x, y), m, plan frame, on this level; None without one.

        Doors without a name, and those behind a wall, do not count. Accepts any floats."""
        doors = self._rooms[level].find_doors(x, y)
        return next((name for _, name, place in doors if name and not self.crosses(level, x, y, *place)), None)
