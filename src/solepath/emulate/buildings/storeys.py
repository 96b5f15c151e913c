"""A building of two floors that are alike: its plan from a record of corridors, rooms, elevators and staircases.

Corridors are 2.4 m wide; rooms with doors lie along them. Elevators open to corridors. Staircases have two flights and
a landing per storey. The floors differ in the exits on the ground floor only. Plan frame: origin at the south-west
corner, x to the east, y to the north, m."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from math import cos, pi, sin

from attrs import frozen

from ...floorplan.doors import cut_doors
from ...floorplan.importers.drawing import merge_walls
from ...floorplan.importers.earth import to_mm
from ...floorplan.plan import Connector, ConnectorKind, ConnectorStop, Door, FloorPlan, Level, Point, Wall, with_rooms

HALF_WIDTH = 1.2
"""Half of a corridor's width, m."""
GROUND, UPPER = "0", "1"
"""Ids of the two levels."""
RISERS, RISE, GOING = 10, 0.16, 0.30
"""Number of risers of a flight, height of a riser, m, and depth of a tread, m."""
STOREY = 2 * RISERS * RISE
"""Height from floor to floor, m."""
CABIN_SIDE = 1.8
"""Width and depth of a cabin, m."""
WELL_DEPTH, LANE_OFFSET, EDGE_OFFSET = 7.8, 0.7, 2.4
"""Depth of a stairwell, distance from its middle line to that of a lane, and from its door to the first edge, m."""
SAME_PLACE = 1e-6
"""Distance below which two walls of the record are one, m."""
SIDES = {0.0: "e", 0.5 * pi: "n", pi: "w", -0.5 * pi: "s"}
"""Letter of the side of a box by the heading to it, rad."""

Box = tuple[float, float, float, float]
"""A rectangle: least x, least y, largest x, largest y, m."""


@frozen
class Cabin:
    """The cabin of an elevator."""

    name: str
    """Name of the elevator."""
    middle: Point
    """Centre of the cabin in the plan frame, m."""
    door_heading: float
    """Heading from the cabin to its door in the plan frame, rad: 0, pi/2, pi or -pi/2."""

    @property
    def box(self) -> Box:
        """Walls of the cabin."""
        (x, y), half = self.middle, 0.5 * CABIN_SIDE
        return (x - half, y - half, x + half, y + half)


@frozen
class Well:
    """A stairwell beside a corridor; upwards the wearer enters by the right lane and leaves by the left one."""

    name: str
    """Name of the staircase."""
    door: Point
    """Middle of the open side, on the corridor's wall, in the plan frame, m."""
    inward: float
    """Heading from the door into the stairwell in the plan frame, rad: 0, pi/2, pi or -pi/2."""

    @property
    def box(self) -> Box:
        """Walls of the stairwell."""
        (x0, y0), (x1, y1) = self.inside(0.0, 2.0 * LANE_OFFSET), self.inside(WELL_DEPTH, -2.0 * LANE_OFFSET)
        return (min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1))

    @property
    def door_heading(self) -> float:
        """Heading from the stairwell to its door in the plan frame, rad."""
        return self.inward - pi if self.inward > 0.0 else self.inward + pi

    @property
    def ends(self) -> tuple[Point, Point]:
        """Ends of the stairs on both floors, ground floor first: at the edge, in the middle of the lane, m."""
        return self.inside(EDGE_OFFSET, -LANE_OFFSET), self.inside(EDGE_OFFSET, LANE_OFFSET)

    def inside(self, inward: float, left: float) -> Point:
        """Return the point `inward` m inside the door and `left` m to the left of the middle line."""
        (x, y), (ux, uy) = self.door, unit(self.inward)
        return (x + inward * ux - left * uy, y + inward * uy + left * ux)


@frozen
class RoomRow:
    """A row of rooms with their doors to one side; what an elevator or a stairwell takes is not a room."""

    box: Box
    """Rectangle of the whole row."""
    side: str
    """Side of the doors of the rooms: "n", "e", "s" or "w"; "we": two rows back to back, west and east of `middle`."""
    cuts: tuple[float, ...] = ()
    """Places of the walls between the rooms, m: y where the doors are in the west or the east, else x."""
    middle: float = 0.0
    """Coordinate x of the wall between two rows back to back, m."""

    def cells(self) -> Iterator[tuple[Box, str]]:
        """Yield every cell with the side of its door, from the first cut to the last."""
        x0, y0, x1, y1 = self.box
        if self.side in "ns":
            for a, b in pairwise((x0, *self.cuts, x1)):
                yield (a, y0, b, y1), self.side
            return
        for a, b in pairwise((y0, *self.cuts, y1)):
            if self.side == "we":
                yield (x0, a, self.middle, b), "w"
                yield (self.middle, a, x1, b), "e"
            else:
                yield (x0, a, x1, b), self.side


@frozen(eq=False)
class Building:
    """A building of two floors that are alike."""

    name: str
    """Name of the building."""
    size: tuple[float, float]
    """Length from west to east and from south to north, m."""
    columns: tuple[float, ...]
    """Coordinates x of the middle lines of the corridors that run north, m; the first and the last one run through the
    whole building and end in ways out, those between them run from the first row to the last one."""
    rows: tuple[float, ...]
    """Coordinates y of the middle lines of the corridors that run east, from the first column to the last one, m."""
    cabins: tuple[Cabin, ...]
    """Cabins of the elevators."""
    wells: tuple[Well, ...]
    """Stairwells of the building."""
    room_rows: tuple[RoomRow, ...]
    """Rows of rooms; together with the corridors they fill a floor."""

    @cached_property
    def plan(self) -> FloorPlan:
        """Floor plan of the building."""
        levels = (self._level(GROUND, "ground floor", 0, True), self._level(UPPER, "upper floor", 1, False))
        return FloorPlan(name=self.name, levels=levels, connectors=tuple(self._connectors()))

    def _rooms(self) -> list[tuple[Box, str]]:
        """Return every room with the side of its door, and every shaft behind a cabin with ""."""
        wells = [well.box for well in self.wells]
        rooms: list[tuple[Box, str]] = []
        for box, side in [cell for row in self.room_rows for cell in row.cells()]:
            if any(_is_same(box, well) for well in wells):
                continue
            shaft = next((found for cabin in self.cabins if (found := _shaft(box, cabin)) is not None), None)
            rooms.append((box, side) if shaft is None else (shaft, ""))
        return rooms

    def _corridors(self) -> list[Box]:
        (_, north), first, last = self.size, self.columns[0], self.columns[-1]
        inner = (self.rows[0] + HALF_WIDTH, self.rows[-1] - HALF_WIDTH)
        spans = [(0.0, north) if x in (first, last) else inner for x in self.columns]
        columns = [(x - HALF_WIDTH, a, x + HALF_WIDTH, b) for x, (a, b) in zip(self.columns, spans, strict=True)]
        return columns + [(first + HALF_WIDTH, y - HALF_WIDTH, last - HALF_WIDTH, y + HALF_WIDTH) for y in self.rows]

    def _level(self, level_id: str, name: str, ordinal: int, has_exits: bool) -> Level:
        rooms, corridors = self._rooms(), self._corridors()
        doors = [_door(box, side, 0.9) for box, side in rooms if side]
        doors += [_door(cabin.box, SIDES[cabin.door_heading], 1.0, f"lift {cabin.name}") for cabin in self.cabins]
        doors += [_door(well.box, SIDES[well.door_heading], 2.4, well.name) for well in self.wells]
        if has_exits:
            ends = (corridors[0], corridors[len(self.columns) - 1])
            doors += [_door(box, side, 1.6, "way out") for box in ends for side in "sn"]
        boxes = [box for box, _ in rooms] + [one.box for one in self.cabins] + [one.box for one in self.wells]
        level = Level(
            id=level_id,
            name=name,
            ordinal=ordinal,
            elevation=ordinal * STOREY,
            walls=_walls([*boxes, (0.0, 0.0, *self.size)]),
            doors=tuple(doors),
        )
        named = [(_ring(box), f"corridor {k}") for k, box in enumerate(corridors, 1)]
        named += [(_ring(box), f"room {k}") for k, box in enumerate([box for box, side in rooms if side], 1)]
        return cut_doors(with_rooms(level, named))

    def _connectors(self) -> Iterator[Connector]:
        for cabin in self.cabins:
            stops = tuple(ConnectorStop(level, cabin.middle, _ring(cabin.box)) for level in (GROUND, UPPER))
            yield Connector(ConnectorKind.LIFT, cabin.name, stops)
        for well in self.wells:
            ends = zip((GROUND, UPPER), well.ends, strict=True)
            stops = tuple(ConnectorStop(level, end, _ring(well.box)) for level, end in ends)
            yield Connector(ConnectorKind.STAIRS, well.name, stops, flights=2, rise=RISE)


def unit(heading: float) -> tuple[int, int]:
    """Return the exact direction of a heading of 0, pi/2, pi or -pi/2 rad in the plan frame."""
    return round(cos(heading)), round(sin(heading))


def _is_same(one: Box, other: Box) -> bool:
    return all(abs(a - b) < SAME_PLACE for a, b in zip(one, other, strict=True))


def _shaft(cell: Box, cabin: Cabin) -> Box | None:
    """Return what is left of a cell behind a cabin that opens on one of its sides; None when it is a room."""
    x0, y0, x1, y1 = cell
    behind = {
        0.0: (x0, y0, x1 - CABIN_SIDE, y1),
        pi: (x0 + CABIN_SIDE, y0, x1, y1),
        0.5 * pi: (x0, y0, x1, y1 - CABIN_SIDE),
        -0.5 * pi: (x0, y0 + CABIN_SIDE, x1, y1),
    }[cabin.door_heading]
    a, b, c, d = cabin.box
    both = (min(a, behind[0]), min(b, behind[1]), max(c, behind[2]), max(d, behind[3]))
    return behind if _is_same(both, cell) else None


def _door(box: Box, side: str, width: float, name: str = "") -> Door:
    """Return a door of `width` m in the middle of one side of a box."""
    x0, y0, x1, y1 = box
    mx, my, half = 0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * width
    if side in "ns":
        y = y1 if side == "n" else y0
        return Door((mx - half, y), (mx + half, y), name)
    x = x1 if side == "e" else x0
    return Door((x, my - half), (x, my + half), name)


def _walls(boxes: list[Box]) -> tuple[Wall, ...]:
    """Return the sides of all boxes as walls; a side of two boxes is one wall."""
    rings = [[to_mm(corner) for corner in _ring(box)] for box in boxes]
    sides = [side for ring in rings for side in pairwise([*ring, ring[0]])]
    return tuple(merge_walls({Wall(min(side), max(side)) for side in sides}))


def _ring(box: Box) -> tuple[Point, ...]:
    x0, y0, x1, y1 = box
    return ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
