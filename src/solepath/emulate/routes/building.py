"""The emulated buildings, all of two floors of 56 m by 63 m, as large as that of Liu et al. 2015 (section V-B).

FOUR_LOOPS is the usual one. Six corridors make four loops of different sizes. Four elevators, as many as the candidates
of the paper's fig. 15, open to four corridors; elevator `A` is at the bottom left. It has neither an axis nor a centre
of symmetry, but its elevators and stairs are spread over the whole floor.

ONE_SIDED has all elevators and stairs in the south-west and large halls in the east. HALF_TURN is the same after half a
turn about its middle, rooms and doors included: walls alone never tell one half from the other, and only the heading
does."""

from __future__ import annotations

from math import pi

from attrs import evolve

from ..buildings.storeys import HALF_WIDTH, Box, Building, Cabin, RoomRow, Well

EAST, NORTH = 56.0, 63.0
"""Length of every building from west to east and from south to north, m."""
COLUMNS, ROWS = (9.0, 25.0, 47.0), (9.0, 27.0, 54.0)
"""Middle lines of the corridors of FOUR_LOOPS, plan frame, m: x of those that run north, y of those that run east."""
CABINS = (
    Cabin("A", (6.9, 4.9), 0.0),
    Cabin("B", (49.1, 57.9), pi),
    Cabin("C", (32.9, 29.1), -0.5 * pi),
    Cabin("D", (22.9, 45.9), 0.0),
)
WELLS = (Well("west stairs", (7.8, 20.9), pi), Well("north stairs", (31.4, 55.2), 0.5 * pi))
WEST_WALL, EAST_WALL = COLUMNS[0] - HALF_WIDTH, COLUMNS[-1] + HALF_WIDTH
SOUTH_WALL, NORTH_WALL = ROWS[0] - HALF_WIDTH, ROWS[-1] + HALF_WIDTH
"""Inner walls of the outer rows of rooms, m, in every building."""
_INNER = (COLUMNS[0] + HALF_WIDTH, ROWS[0] + HALF_WIDTH, COLUMNS[-1] - HALF_WIDTH, ROWS[-1] - HALF_WIDTH)
"""Rectangle within the outer corridors, m, in every building."""


def blocks(columns: tuple[float, ...], rows: tuple[float, ...]) -> tuple[Box, Box, Box, Box]:
    """Return the rectangles between the corridors: south-west, south-east, north-west and north-east."""
    x0, y0, x1, y1 = _INNER
    (left, right), (low, high) = ((a[1] - HALF_WIDTH, a[1] + HALF_WIDTH) for a in (columns, rows))
    return (x0, y0, left, low), (right, y0, x1, low), (x0, high, left, y1), (right, high, x1, y1)


def _four_loops() -> Building:
    south_west, south_east, (x0, y0, x1, y1), (x2, _, x3, _) = blocks(COLUMNS, ROWS)
    rooms = (
        RoomRow((0.0, 0.0, WEST_WALL, NORTH), "e", (4.0, 5.8, 13.0, 19.5, 22.3, 29.0, 36.0, 43.0, 50.0, 57.0)),
        RoomRow((EAST_WALL, 0.0, EAST, NORTH), "w", (7.0, 14.0, 21.0, 28.0, 35.0, 42.0, 49.0, 57.0, 58.8)),
        RoomRow((x0, 0.0, x3, SOUTH_WALL), "n", (17.0, 24.0, 31.0, 38.0)),
        RoomRow((x0, NORTH_WALL, x3, NORTH), "s", (17.0, 24.0, 30.0, 32.8, 39.0)),
        RoomRow(south_west, "we", (18.0,), 17.0),
        RoomRow(south_east, "we", (18.0,), 36.0),
        RoomRow((x0, y0, 17.0, y1), "w", (36.0, 44.0)),
        RoomRow((17.0, y0, x1, y1), "e", (37.0, 45.0, 46.8)),
        RoomRow((x2, y0, x3, 36.0), "s", (32.0, 33.8)),
        RoomRow((x2, 36.0, x3, y1), "we", (44.0,), 36.0),
    )
    return Building("two floors of 56 m by 63 m", (EAST, NORTH), COLUMNS, ROWS, CABINS, WELLS, rooms)


def _one_sided() -> Building:
    columns, rows = (9.0, 21.0, 47.0), (9.0, 36.0, 54.0)
    south_west, south_east, north_west, north_east = blocks(columns, rows)
    x0, _, x3, _ = _INNER
    rooms = (
        RoomRow((0.0, 0.0, WEST_WALL, NORTH), "e", (4.0, 5.8, 13.0, 19.5, 22.3, 29.0, 36.0, 44.0, 45.8, 54.0)),
        RoomRow((EAST_WALL, 0.0, EAST, NORTH), "w", (20.0, 41.0)),
        RoomRow((x0, 0.0, x3, SOUTH_WALL), "n", (14.0, 16.8, 26.0, 36.0)),
        RoomRow((x0, NORTH_WALL, x3, NORTH), "s", (22.0,)),
        RoomRow(south_west, "we", (16.0, 22.0, 28.0), 15.0),
        RoomRow(south_east, "w", (22.0,)),
        RoomRow(north_west, "we", (45.0,), 15.0),
        RoomRow(north_east, "e"),
    )
    cabins = (Cabin("A", (6.9, 4.9), 0.0), Cabin("B", (6.9, 44.9), 0.0))
    wells = (Well("west stairs", (7.8, 20.9), pi), Well("south stairs", (15.4, 7.8), -0.5 * pi))
    return Building("one-sided building", (EAST, NORTH), columns, rows, cabins, wells, rooms)


def _half_turn() -> Building:
    columns, rows = (9.0, 28.0, 47.0), (9.0, 31.5, 54.0)
    south_west, _, (x0, y0, x1, y1), _ = blocks(columns, rows)
    half = (
        RoomRow((0.0, 0.0, WEST_WALL, NORTH), "e", (4.0, 5.8, 13.0, 19.5, 22.3, 29.0, 36.0, 43.0, 50.0, 57.0)),
        RoomRow((x0, 0.0, _INNER[2], SOUTH_WALL), "n", (17.0, 24.0, 31.0, 38.0)),
        RoomRow(south_west, "we", (20.0,), 18.0),
        RoomRow((x0, y0, 18.0, y1), "w", (40.0, 46.0)),
        RoomRow((18.0, y0, x1, y1), "e", (37.0, 45.0, 46.8)),
    )
    cabins = (Cabin("A", (6.9, 4.9), 0.0), Cabin("C", (25.9, 45.9), 0.0))
    far = tuple(Cabin(name, _turned_point(one.middle), pi) for name, one in zip("BD", cabins, strict=True))
    west = Well("west stairs", (7.8, 20.9), pi)
    wells = (west, Well("east stairs", _turned_point(west.door), 0.0))
    turned = tuple(_turned_row(row) for row in half)
    return Building("half-turn building", (EAST, NORTH), columns, rows, cabins + far, wells, half + turned)


def _turned_point(point: tuple[float, float]) -> tuple[float, float]:
    """Return a point after half a turn about the middle of the building."""
    return (EAST - point[0], NORTH - point[1])


def _turned_row(row: RoomRow) -> RoomRow:
    """Return a row of rooms after half a turn about the middle of the building."""
    x0, y0, x1, y1 = row.box
    length = EAST if row.side in "ns" else NORTH
    return evolve(
        row,
        box=(EAST - x1, NORTH - y1, EAST - x0, NORTH - y0),
        side={"n": "s", "s": "n", "e": "w", "w": "e"}.get(row.side, row.side),
        cuts=tuple(length - cut for cut in reversed(row.cuts)),
        middle=EAST - row.middle,
    )


FOUR_LOOPS = _four_loops()
"""The usual building."""
ONE_SIDED = _one_sided()
"""A building without symmetry, all of whose elevators and stairs are in one half."""
HALF_TURN = _half_turn()
"""A building whose halves differ in nothing but where they lie."""
BUILDING = FOUR_LOOPS.plan
"""Floor plan of the usual building."""
