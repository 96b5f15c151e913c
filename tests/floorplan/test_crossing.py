"""Test of straight moves against walls: exact for every move and every wall."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from solepath.floorplan.geometry import touch
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Connector, ConnectorKind, ConnectorStop, Door, FloorPlan, Level, Wall
from solepath.floorplan.walls import Walls

Line = tuple[tuple[float, float], tuple[float, float]]


def exactly_touch(a: Line, b: Line) -> bool:
    """Return by fractions whether p + s u = q + t v with s and t from 0 to 1, or the lines overlap on one line."""
    (px, py), (ex, ey) = [(Fraction(x), Fraction(y)) for x, y in a]
    (qx, qy), (fx, fy) = [(Fraction(x), Fraction(y)) for x, y in b]
    ux, uy, vx, vy = ex - px, ey - py, fx - qx, fy - qy
    cross = ux * vy - uy * vx
    wx, wy = qx - px, qy - py
    if cross != 0:
        return 0 <= (wx * vy - wy * vx) / cross <= 1 and 0 <= (wx * uy - wy * ux) / cross <= 1
    if wx * uy - wy * ux != 0 or wx * vy - wy * vx != 0:
        return False
    return (max(min(px, ex), min(qx, fx)) <= min(max(px, ex), max(qx, fx))
            and max(min(py, ey), min(qy, fy)) <= min(max(py, ey), max(qy, fy)))  # fmt: skip


grid_places = st.tuples(st.integers(-12, 12), st.integers(-12, 12)).map(lambda p: (p[0] * 0.25, p[1] * 0.25))
places = st.tuples(st.floats(-8.0, 8.0), st.floats(-8.0, 8.0)) | grid_places
lines = st.tuples(places, places)
walls_of = st.lists(lines.filter(lambda line: line[0] != line[1]), min_size=1, max_size=12)
any_float = st.floats(allow_nan=True, allow_infinity=True)


@given(lines, lines)
def test_lines_touch_exactly_when_fractions_do(a: Line, b: Line) -> None:
    assert touch(*a[0], *a[1], *b[0], *b[1]) == exactly_touch(a, b)


@given(walls_of, st.lists(lines, min_size=1, max_size=8))
def test_a_move_crosses_when_it_touches_any_wall_exactly(walls: list[Line], moves: list[Line]) -> None:
    grid = Walls([(*a, *b) for a, b in walls])
    for start, end in moves:
        assert grid.crosses(*start, *end) == any(exactly_touch((start, end), wall) for wall in walls)


@given(st.tuples(any_float, any_float, any_float, any_float))
def test_any_floats_get_an_answer_and_no_place_is_behind_a_wall(move: tuple[float, float, float, float]) -> None:
    walls = [((0.0, 0.0), (5.0, 0.0)), ((5.0, 0.0), (5.0, 5.0))]
    crosses = Walls([(*a, *b) for a, b in walls]).crosses(*move)
    if all(map(math.isfinite, move)):
        assert crosses == any(exactly_touch((move[:2], move[2:]), wall) for wall in walls)
    else:
        assert crosses


def test_nobody_slips_through_a_corner_where_walls_meet() -> None:
    corner = (0.1 + 0.2, 1.0 / 3.0)
    walls = Walls([(0.0, 1.0 / 3.0, *corner), (*corner, 0.1 + 0.2, 0.0)])
    for k in range(1, 1000):
        heading = k * 0.5 * math.pi / 1000
        dx, dy = 0.2 * math.cos(heading), 0.2 * math.sin(heading)
        assert walls.crosses(corner[0] - dx, corner[1] - dy, corner[0] + dx, corner[1] + dy)


def level(level_id: str, elevation: float, **more: object) -> Level:
    walls = (Wall((0.0, 0.0), (4.0, 0.0)), Wall((5.0, 0.0), (10.0, 0.0)), Wall((10.0, 0.0), (10.0, 6.0)),
             Wall((10.0, 6.0), (0.0, 6.0)), Wall((0.0, 6.0), (0.0, 0.0)))  # fmt: skip
    return Level(level_id, level_id, round(elevation / 3.0), elevation, walls, (Door((4.0, 0.0), (5.0, 0.0)),), **more)  # type: ignore[arg-type]


LIFT = Connector(ConnectorKind.LIFT, "lift", (ConnectorStop("0", (9.0, 5.0)), ConnectorStop("1", (9.0, 5.0))))
STAIRS = Connector(ConnectorKind.STAIRS, "stairs", (ConnectorStop("0", (1.0, 5.0)), ConnectorStop("1", (2.0, 5.0))))
HOUSE = FloorPlan("house", (level("0", 0.0), level("1", 3.0)), (LIFT, STAIRS))


def test_without_rooms_one_is_inside_what_the_walls_and_doors_enclose() -> None:
    plan = IndexedPlan(HOUSE)
    for x, y in ((0.01, 0.01), (5.0, 3.0), (9.99, 5.99), (4.5, 0.01)):
        assert plan.inside(0, x, y)
    for x, y in ((-0.01, 3.0), (4.5, -0.01), (10.01, 3.0), (50.0, 3.0), (5.0, 6.01), (10.7, 6.7)):
        assert not plan.inside(0, x, y)


def test_where_walls_do_not_close_one_is_inside_the_hull_of_them_all() -> None:
    open_walls = FloorPlan("open", (Level("0", "", 0, 0.0, HOUSE.levels[0].walls[1:]),))
    plan = IndexedPlan(open_walls)
    assert plan.inside(0, 5.0, 3.0)
    assert plan.inside(0, 2.0, 0.5)
    assert not plan.inside(0, -0.1, 3.0)


def test_with_rooms_one_is_inside_them_and_on_doorsteps_and_in_stairwells() -> None:
    shaft = ((11.0, 2.0), (12.0, 2.0), (12.0, 3.0), (11.0, 3.0))
    lift = Connector(ConnectorKind.LIFT, "lift", (ConnectorStop("0", (11.5, 2.5), shaft),))
    room = ((0.0, 0.0), (10.0, 0.0), (10.0, 6.0), (6.0, 6.0), (6.0, 3.0), (0.0, 3.0))
    plan = IndexedPlan(FloorPlan("rooms", (level("0", 0.0, rooms=(room,)),), (lift,)))
    for x, y in ((1.0, 1.0), (9.0, 5.0), (5.99, 2.99), (4.5, -0.4), (11.5, 2.5)):
        assert plan.inside(0, x, y), (x, y)
    for x, y in ((1.0, 5.0), (5.9, 3.1), (4.5, -0.6), (10.5, 2.5), (12.1, 2.5)):
        assert not plan.inside(0, x, y), (x, y)


@given(st.lists(places, min_size=3, max_size=9, unique=True), st.lists(places, min_size=1, max_size=10))
def test_the_grid_of_rooms_agrees_with_counting_the_edges(
    ring: list[tuple[float, float]], points: list[tuple[float, float]]
) -> None:
    plan = IndexedPlan(FloorPlan("one", (Level("0", "", 0, 0.0, (Wall((-9.0, -9.0), (9.0, 9.0)),), (),
                                               (tuple(ring),)),)))  # fmt: skip
    for x, y in points:
        odd = False
        for (ax, ay), (bx, by) in pairwise([*ring, ring[0]]):
            if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
                odd = not odd
        assert plan.inside(0, x, y) == odd
