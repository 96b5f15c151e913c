"""The emulated building: two floors of 56 m by 63 m, as large as that of Liu et al. 2015 (section V-B).

Six corridors, 2.4 m wide, make four loops of different sizes; rooms with doors lie along them. Four elevators, as many
as the candidates of the paper's fig. 15, open to four corridors; elevator `A` is at the bottom left. Two staircases
have two flights and a landing per storey. Both floors are alike, except the exits on the ground floor. Plan frame:
origin at the south-west corner, x to the east, y to the north, m."""

from __future__ import annotations

from itertools import pairwise
from math import pi

from attrs import frozen

from ...floorplan.doors import cut_doors
from ...floorplan.importers.drawing import merge_walls
from ...floorplan.importers.earth import to_mm
from ...floorplan.plan import Connector, ConnectorKind, ConnectorStop, Door, FloorPlan, Level, Point, Wall, with_rooms

EAST, NORTH = 56.0, 63.0
HALF_WIDTH = 1.2
"""Half of a corridor's width, m."""
COLUMNS, ROWS = (9.0, 25.0, 47.0), (9.0, 27.0, 54.0)
"""Middle lines of the corridors, plan frame, m: x of those that run north, y of those that run east.

The first and the last of COLUMNS run through the whole building."""
GROUND, UPPER = "0", "1"
"""Ids of the two levels."""
RISERS, RISE, GOING = 10, 0.16, 0.30
"""Number of risers of a flight, height of a riser, m, and depth of a tread, m."""
STOREY = 2 * RISERS * RISE
"""Height from floor to floor, m."""

_Box = tuple[float, float, float, float]
"""A rectangle: least x, least y, largest x, largest y, m."""


@frozen
class Cabin:
    """The cabin of an elevator."""

    name: str
    """Name of the elevator."""
    middle: Point
    """Centre of the cabin in the plan frame, m."""
    door_heading: float
    """Heading from the cabin to its door in the plan frame, rad."""


@frozen
class Well:
    """A stairwell beside a corridor; upwards the wearer enters by the right lane and leaves by the left one."""

    name: str
    """Name of the staircase."""
    door: Point
    """Middle of the open side, on the corridor's wall, in the plan frame, m."""
    inward: float
    """Heading from the door into the stairwell in the plan frame, rad."""


CABIN_SIDE = 1.8
"""Width and depth of a cabin, m."""
WELL_DEPTH, LANE_OFFSET, EDGE_OFFSET = 7.8, 0.7, 2.4
"""Depth of a stairwell, distance from its middle line to that of a lane, and from its door to the first edge, m."""
CABINS = (
    Cabin("A", (6.9, 4.9), 0.0),
    Cabin("B", (49.1, 57.9), pi),
    Cabin("C", (32.9, 29.1), -0.5 * pi),
    Cabin("D", (22.9, 45.9), 0.0),
)
WELLS = (Well("west stairs", (7.8, 20.9), pi), Well("north stairs", (31.4, 55.2), 0.5 * pi))


def _rooms() -> list[tuple[_Box, str]]:
    """Return every room with the side of its door ("n", "e", "s" or "w"), and every elevator shaft with ""."""
    w, e, s, n = COLUMNS[0] - HALF_WIDTH, COLUMNS[2] + HALF_WIDTH, ROWS[0] - HALF_WIDTH, ROWS[2] + HALF_WIDTH
    inner = [(COLUMNS[0] + HALF_WIDTH, COLUMNS[1] - HALF_WIDTH), (COLUMNS[1] + HALF_WIDTH, COLUMNS[2] - HALF_WIDTH)]
    low, high = (ROWS[0] + HALF_WIDTH, ROWS[1] - HALF_WIDTH), (ROWS[1] + HALF_WIDTH, ROWS[2] - HALF_WIDTH)
    rooms: list[tuple[_Box, str]] = []
    for a, b in pairwise((0.0, 4.0, 5.8, 13.0, 19.5, 22.3, 29.0, 36.0, 43.0, 50.0, 57.0, NORTH)):
        shaft, well = a == 4.0, a == 19.5
        rooms += [] if well else [((0.0, a, w - CABIN_SIDE if shaft else w, b), "" if shaft else "e")]
    for a, b in pairwise((0.0, 7.0, 14.0, 21.0, 28.0, 35.0, 42.0, 49.0, 57.0, 58.8, NORTH)):
        shaft = a == 57.0
        rooms += [((e + CABIN_SIDE if shaft else e, a, EAST, b), "" if shaft else "w")]
    for a, b in pairwise((inner[0][0], 17.0, 24.0, 31.0, 38.0, inner[1][1])):
        rooms.append(((a, 0.0, b, s), "n"))
    for a, b in pairwise((inner[0][0], 17.0, 24.0, 30.0, 32.8, 39.0, inner[1][1])):
        rooms += [] if a == 30.0 else [((a, n, b, NORTH), "s")]
    for (left, right), middle in zip(inner, (17.0, 36.0), strict=True):
        for a, b in pairwise((low[0], 18.0, low[1])):
            rooms += [((left, a, middle, b), "w"), ((middle, a, right, b), "e")]
    left, right = inner[0]
    for a, b in pairwise((high[0], 36.0, 44.0, high[1])):
        rooms.append(((left, a, 17.0, b), "w"))
    for a, b in pairwise((high[0], 37.0, 45.0, 46.8, high[1])):
        shaft = a == 45.0
        rooms.append(((17.0, a, right - CABIN_SIDE if shaft else right, b), "" if shaft else "e"))
    left, right = inner[1]
    rooms += [((left, high[0], 32.0, 36.0), "s"), ((32.0, high[0] + CABIN_SIDE, 33.8, 36.0), "")]
    rooms.append(((33.8, high[0], right, 36.0), "s"))
    for a, b in pairwise((36.0, 44.0, high[1])):
        rooms += [((left, a, 36.0, b), "w"), ((36.0, a, right, b), "e")]
    return rooms


def _corridors() -> list[_Box]:
    spans = ((0.0, NORTH), (ROWS[0] + HALF_WIDTH, ROWS[2] - HALF_WIDTH), (0.0, NORTH))
    columns = [(x - HALF_WIDTH, a, x + HALF_WIDTH, b) for x, (a, b) in zip(COLUMNS, spans, strict=True)]
    return columns + [(COLUMNS[0] + HALF_WIDTH, y - HALF_WIDTH, COLUMNS[2] - HALF_WIDTH, y + HALF_WIDTH) for y in ROWS]


def _cabin(cabin: Cabin) -> _Box:
    (x, y), half = cabin.middle, 0.5 * CABIN_SIDE
    return (x - half, y - half, x + half, y + half)


def _well(well: Well) -> _Box:
    x, y = well.door
    if well.inward == pi:
        return (x - WELL_DEPTH, y - 2.0 * LANE_OFFSET, x, y + 2.0 * LANE_OFFSET)
    return (x - 2.0 * LANE_OFFSET, y, x + 2.0 * LANE_OFFSET, y + WELL_DEPTH)


def _door(box: _Box, side: str, width: float, name: str = "") -> Door:
    """Return a door of `width` m in the middle of one side of a box."""
    x0, y0, x1, y1 = box
    mx, my, half = 0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * width
    if side in "ns":
        y = y1 if side == "n" else y0
        return Door((mx - half, y), (mx + half, y), name)
    x = x1 if side == "e" else x0
    return Door((x, my - half), (x, my + half), name)


def _walls(boxes: list[_Box]) -> tuple[Wall, ...]:
    """Return the sides of all boxes as walls; a side of two boxes is one wall."""
    rings = [[to_mm(corner) for corner in _ring(box)] for box in boxes]
    sides = [side for ring in rings for side in pairwise([*ring, ring[0]])]
    return tuple(merge_walls({Wall(min(side), max(side)) for side in sides}))


def _ring(box: _Box) -> tuple[Point, ...]:
    x0, y0, x1, y1 = box
    return ((x0, y0), (x1, y0), (x1, y1), (x0, y1))


def _level(level_id: str, name: str, ordinal: int, has_exits: bool) -> Level:
    rooms, corridors = _rooms(), _corridors()
    doors = [_door(box, side, 0.9) for box, side in rooms if side]
    doors += [
        _door(_cabin(cabin), {0.0: "e", pi: "w"}.get(cabin.door_heading, "s"), 1.0, f"lift {cabin.name}")
        for cabin in CABINS
    ]
    doors += [_door(_well(well), "e" if well.inward == pi else "s", 2.4, well.name) for well in WELLS]
    if has_exits:
        doors += [_door(corridors[k], side, 1.6, "way out") for k in (0, 2) for side in "sn"]
    boxes = [box for box, _ in rooms] + [_cabin(cabin) for cabin in CABINS] + [_well(well) for well in WELLS]
    level = Level(
        id=level_id,
        name=name,
        ordinal=ordinal,
        elevation=ordinal * STOREY,
        walls=_walls([*boxes, (0.0, 0.0, EAST, NORTH)]),
        doors=tuple(doors),
    )
    named = [(_ring(box), f"corridor {k}") for k, box in enumerate(corridors, 1)]
    named += [(_ring(box), f"room {k}") for k, box in enumerate([box for box, side in rooms if side], 1)]
    return cut_doors(with_rooms(level, named))


def _connectors() -> tuple[Connector, ...]:
    connectors = []
    for cabin in CABINS:
        stops = tuple(ConnectorStop(level, cabin.middle, _ring(_cabin(cabin))) for level in (GROUND, UPPER))
        connectors.append(Connector(ConnectorKind.LIFT, cabin.name, stops))
    for well in WELLS:
        below, above = stair_ends(well)
        stops = tuple(ConnectorStop(level, end, _ring(_well(well))) for level, end in ((GROUND, below), (UPPER, above)))
        connectors.append(Connector(ConnectorKind.STAIRS, well.name, stops, flights=2, rise=RISE))
    return tuple(connectors)


def stair_ends(well: Well) -> tuple[Point, Point]:
    """Return the ends of the stairs on both floors, ground floor first: at the edge, in the middle of the lane."""
    return in_well(well, EDGE_OFFSET, -LANE_OFFSET), in_well(well, EDGE_OFFSET, LANE_OFFSET)


def in_well(well: Well, inward: float, left: float) -> Point:
    """Return the point `inward` m inside a stairwell's door and `left` m to the left of its middle line."""
    x, y = well.door
    if well.inward == pi:
        return (x - inward, y - left)
    return (x - left, y + inward)


BUILDING = FloorPlan(
    name="two floors of 56 m by 63 m",
    levels=(_level(GROUND, "ground floor", 0, True), _level(UPPER, "upper floor", 1, False)),
    connectors=_connectors(),
)
"""Floor plan of the emulated building."""
