"""Requirements on a floor plan, warnings about one, and doors cut out of walls."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import pytest
from attrs import evolve
from floorplans import FILES, doors, walls
from hypothesis import given
from hypothesis import strategies as st

from solepath.floorplan.checks import find_fault
from solepath.floorplan.doors import cut_doors
from solepath.floorplan.findings import find_warnings
from solepath.floorplan.importers.reading import read_floorplan
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import (
    Anchor,
    Connector,
    ConnectorKind,
    ConnectorStop,
    Door,
    FloorPlan,
    FloorPlanError,
    Level,
    Point,
    Start,
    Wall,
)
from solepath.session import Session

HOUSE = read_floorplan(FILES / "house.geojson")
GROUND = HOUSE.levels[0]


def with_level(**changes: object) -> FloorPlan:
    nameless = evolve(GROUND, room_names=()) if "rooms" in changes else GROUND
    return evolve(HOUSE, levels=(evolve(nameless, **changes), *HOUSE.levels[1:]))  # type: ignore[arg-type]


def stairs(*stops: ConnectorStop, **more: object) -> FloorPlan:
    return evolve(HOUSE, connectors=(Connector(ConnectorKind.STAIRS, "A", stops, **more),))  # type: ignore[arg-type]


def box(x0: float, y0: float, x1: float, y1: float) -> tuple[Wall, ...]:
    a, b, c, d = (x0, y0), (x1, y0), (x1, y1), (x0, y1)
    return Wall(a, b), Wall(b, c), Wall(c, d), Wall(d, a)


UNUSABLE = [
    (evolve(HOUSE, levels=()), "the plan has no levels"),
    (with_level(elevation=4.0), "level '1' comes after level '0' and lies below it"),
    (with_level(walls=(Wall((1.0, 2.0), (math.nan, 2.0)),)), "level '0': wall 1 is at (nan, 2)"),
    (stairs(ConnectorStop("2", (1.0, 1.0))), "stairs 'A': stops at level '2', which the plan does not have"),
    (
        stairs(ConnectorStop("1", (1.0, 1.0)), ConnectorStop("0", (1.0, 1.0))),
        "stairs 'A': its stops are not from the lowest to the highest",
    ),
    (evolve(HOUSE, anchor=Anchor(91.0, 0.0)), "anchor.latitude is 91; it can be -89 to 89 degrees"),
]


@pytest.mark.parametrize(("plan", "message"), UNUSABLE, ids=[message[:40] for _, message in UNUSABLE])
def test_a_plan_that_cannot_be_used_is_rejected_in_one_line(plan: FloorPlan, message: str) -> None:
    assert find_fault(plan) == message
    assert find_warnings(plan) == ()
    with pytest.raises(FloorPlanError):
        IndexedPlan(plan)


RING = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
WIDE, DOOR, STOP = Wall((0.0, 0.0), (5000.0, 0.0)), Door((1.0, 0.0), (2.0, 0.0)), ConnectorStop("0", (1.0, 1.0))


def storeys(count: int, height: float = 3.0) -> FloorPlan:
    return FloorPlan("", tuple(Level(str(k), "", k, height * k, ()) for k in range(count)))


def walled(*drawn: Wall, **more: object) -> FloorPlan:
    return FloorPlan("", (Level("0", "", 0, 0.0, drawn, **more),))  # type: ignore[arg-type]


def anchored(latitude: float, longitude: float = 0.0, bearing: float = 0.0) -> FloorPlan:
    return evolve(HOUSE, anchor=Anchor(latitude, longitude, bearing))


LIMITS: dict[str, tuple[Callable[[Any], FloorPlan], Sequence[float], Sequence[float], str]] = {
    "levels": (storeys, (1, 1000), (0, 1001), "levels"),
    "walls": (lambda count: walled(*box(0.0, 0.0, 1.0, 1.0)[:1] * count), (1, 100_000), (100_001,), "100000 walls"),
    "doors": (
        lambda count: walled(WIDE, doors=(Door((1.0, 0.0), (2.0, 0.0)),) * count),
        (0, 100_000),
        (100_001,),
        "doors",
    ),
    "corners": (lambda count: walled(WIDE, rooms=(RING,) * (count // 4)), (0, 100_000), (100_004,), "corners"),
    "stops": (
        lambda count: evolve(HOUSE, connectors=stairs(STOP).connectors * count),
        (0, 1, 2000),
        (2001,),
        "2000 stops",
    ),
    "stops of one": (lambda count: stairs(*[STOP] * count), (1,), (0, 2), "stops"),
    "length, 5 km": (lambda count: walled(*[WIDE] * count), (1, 100), (101,), "505 km"),
    "ordinal": (lambda number: with_level(ordinal=number), (-100_000, 100_000), (-100_001, 100_001), "ordinal"),
    "elevation": (
        lambda z: evolve(storeys(1), levels=(Level("0", "", 0, z, ()),)),
        (-1e7, 1e7),
        (-1.1e7, 1.1e7),
        "elevation",
    ),
    "x": (lambda x: walled(Wall((x, 0.0), (x, 5.0))), (-1e7, 1e7), (-1.1e7, 1.1e7, math.inf), " is at "),
    "y": (lambda y: walled(Wall((0.0, y), (5.0, y))), (-1e7, 1e7), (-1.1e7, 1.1e7, math.inf), " is at "),
    "width": (lambda x: walled(Wall((0.0, 0.0), (x, 0.1))), (1.0, 5000.0), (0.99, 5000.1), "wide"),
    "depth": (lambda y: walled(Wall((0.0, 0.0), (0.1, y))), (1.0, 5000.0), (0.99, 5000.1), "wide"),
    "storey": (lambda height: storeys(2, height), (0.0, 50.0), (-0.1, 50.1), "level"),
    "corners of a room": (lambda count: walled(WIDE, rooms=(RING[:count],)), (3, 4), (0, 1, 2), "corners"),
    "corners of an outline": (lambda count: stairs(evolve(STOP, outline=RING[:count])), (0, 3, 4), (1, 2), "corners"),
    "flights": (lambda count: stairs(STOP, flights=count), (1, 100), (0, -1, 101), "flights"),
    "rise": (lambda rise: stairs(STOP, rise=rise), (0.02, 0.6), (0.0199, 0.0, -0.2, 0.601), "rise"),
    "latitude": (anchored, (-89.0, 89.0), (-89.1, 89.1), "latitude"),
    "longitude": (
        lambda angle: evolve(HOUSE, anchor=Anchor(0.0, angle)),
        (-180.0, 180.0),
        (-180.1, 180.1),
        "longitude",
    ),
    "bearing": (lambda angle: anchored(0.0, 0.0, angle), (-10.0, 10.0), (-10.1, 10.1), "bearing"),
}
"""Each row of the limits in protocol/floorplan.md: a plan with it, values within, values beyond, and why not."""


@pytest.mark.parametrize("what", LIMITS)
def test_a_plan_is_usable_up_to_each_limit_and_not_beyond(what: str) -> None:
    plan_with, within, beyond, why = LIMITS[what]
    for number in within:
        assert find_fault(plan_with(number)) is None, number
    for number in beyond:
        assert why in (find_fault(plan_with(number)) or ""), number


def test_assumed_heights_are_a_warning() -> None:
    assert find_warnings(HOUSE) == ("the plan does not say how high its levels lie",)


def test_a_gap_in_the_outer_wall_is_a_warning_and_a_door_in_it_is_not() -> None:
    gap = (Wall((0.0, 0.0), (10.0, 0.0)), Wall((11.0, 0.0), (20.0, 0.0)), *box(0.0, 0.0, 20.0, 10.0)[1:])
    known = evolve(HOUSE, heights_known=True)
    for rooms in ((), (((0.0, 0.0), (20.0, 0.0), (20.0, 10.0), (0.0, 10.0)),)):
        open_level = Level("0", "", 0, 0.0, gap, (), rooms)
        found = find_warnings(evolve(known, levels=(open_level, *HOUSE.levels[1:])))
        assert len(found) == 1
        assert found[0].startswith("level '0': its walls do not close near (1")
        with_door = evolve(open_level, doors=(Door((10.0, 0.0), (11.0, 0.0)),))
        assert find_warnings(evolve(known, levels=(with_door, *HOUSE.levels[1:]))) == ()


def test_a_door_drawn_on_the_other_face_of_a_wall_is_no_gap() -> None:
    for off in (0.05, 0.13, 0.2, 0.29):
        outer, inner = box(0.0, 0.0, 20.0, 10.0), box(off, off, 20.0 - off, 10.0 - off)
        for drawn in (outer, (*outer, *inner)):
            level = cut_doors(Level("0", "", 0, 0.0, drawn, (Door((10.0, off), (11.5, off)),)))
            assert len(level.walls) > len(drawn)
            assert not [line for line in find_warnings(FloorPlan("", (level,))) if "close" in line]
            assert IndexedPlan(FloorPlan("", (level,))).inside(0, 5.0, 5.0)


def cut(drawn: tuple[Wall, ...], *through: Door) -> tuple[Wall, ...]:
    return cut_doors(Level("0", "", 0, 0.0, drawn, through)).walls


LONG_WALLS = (Wall((0.0, 0.0), (10.0, 0.0)),)


def test_a_door_leaves_a_gap_of_its_width() -> None:
    assert cut(LONG_WALLS, Door((4.0, 0.0), (5.0, 0.0))) == (
        Wall((0.0, 0.0), (4.0, 0.0)),
        Wall((5.0, 0.0), (10.0, 0.0)),
    )
    assert cut(LONG_WALLS, Door((5.0, 0.1), (4.0, -0.1))) == (
        Wall((0.0, 0.0), (4.0, 0.0)),
        Wall((5.0, 0.0), (10.0, 0.0)),
    )


def test_a_door_cuts_both_faces_of_a_wall_and_no_wall_across_it() -> None:
    faces = (Wall((0.0, 0.0), (10.0, 0.0)), Wall((0.0, 0.2), (10.0, 0.2)), Wall((4.0, 0.2), (4.0, 5.0)),
             Wall((0.0, 1.0), (10.0, 1.0)))  # fmt: skip
    found = cut(faces, Door((4.0, 0.0), (5.0, 0.0)))
    assert found == (Wall((0.0, 0.0), (4.0, 0.0)), Wall((5.0, 0.0), (10.0, 0.0)), Wall((0.0, 0.2), (4.0, 0.2)),
                     Wall((5.0, 0.2), (10.0, 0.2)), *faces[2:])  # fmt: skip


@given(st.lists(walls, max_size=6).map(tuple), st.lists(doors, max_size=4))
def test_cut_once_more_the_walls_stay_as_they_are(drawn: tuple[Wall, ...], through: list[Door]) -> None:
    once = cut(drawn, *through)
    assert cut(once, *through) == once


@given(st.floats(0.0, math.tau), st.floats(0.5, 8.0), st.floats(0.6, 1.5))
def test_one_walks_through_the_middle_of_a_door_in_a_wall_of_any_direction(turn: float, at: float, wide: float) -> None:
    def along(x: float, y: float) -> Point:
        return x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)

    door = Door(along(at, 0.0), along(at + wide, 0.0))
    plan = IndexedPlan(FloorPlan("", (cut_doors(Level("0", "", 0, 0.0, (Wall(along(0.0, 0.0), along(10.0, 0.0)),),
                                                           (door,))),)))  # fmt: skip
    for x, free in ((at + 0.5 * wide, True), (at + 0.01, True), (at - 0.01, False), (at + wide - 0.01, True),
                    (at + wide + 0.01, at + wide > 10.0 - 0.01)):  # fmt: skip
        assert plan.crosses(0, *along(x, -0.4), *along(x, 0.4)) != free


HUGE_NUMBER = 10**400

MISSHAPEN = [
    (evolve(HOUSE, levels=None), "levels is None, not of type tuple"),
    (with_level(id=0), "levels[0].id is 0, not of type str"),
    (with_level(walls=(Wall((0, 0), (1,)),)), "levels[0].walls[0].end has 1 values, not 2"),
    (with_level(rooms=(((0, 0), (1, 0), (1, None)),)), "levels[0].rooms[0][2][1] is None, not of type float"),
]


@pytest.mark.parametrize(("plan", "message"), MISSHAPEN, ids=[message[:40] for _, message in MISSHAPEN])
def test_a_plan_of_something_else_than_records_is_rejected_by_the_session_in_one_line(
    plan: FloorPlan, message: str
) -> None:
    assert find_fault(plan) == message
    with pytest.raises(FloorPlanError) as error:
        Session(floorplan=plan)
    assert str(error.value) == message


INVALID_STARTS = [
    (Start("0", (HUGE_NUMBER, 1)), "place[0] is a huge number; it can be -1e+07 to 1e+07 m"),
    (Start("0", (math.nan, 1.0)), "place[0] is nan; it can be -1e+07 to 1e+07 m"),
    (Start("0", (1.0, 2.0), 1e308), "heading is 1e+308; it can be -1000 to 1000 rad"),
    (Start("0", (1.0, 2.0), spread=-1.0), "spread is -1; it can be 0 to 5000 m"),
]


@pytest.mark.parametrize(("start", "message"), INVALID_STARTS, ids=[message[:40] for _, message in INVALID_STARTS])
def test_a_start_that_cannot_be_is_rejected_by_the_session_in_one_line(start: Start, message: str) -> None:
    with pytest.raises(FloorPlanError) as error:
        Session(floorplan=HOUSE, start=start)
    assert str(error.value) == f"start: {message}"


def test_more_walls_around_one_place_than_a_step_can_be_tried_against_are_rejected() -> None:
    comb = tuple(Wall((0.001 * k, 0.0), (0.001 * k, 1.0)) for k in range(2500))
    with pytest.raises(FloorPlanError, match=r"^level '0': \d+ walls lie around \(-?\d+, -?\d+\)$"):
        IndexedPlan(with_level(walls=comb))


def named(level: str, *rooms: str, doors: Sequence[str] = ()) -> Level:
    """A level whose rooms stand in a row, 4 m wide and 3 m deep."""
    rings = tuple(tuple(wall.start for wall in box(4.0 * k, 0.0, 4.0 * k + 4.0, 3.0)) for k in range(len(rooms)))
    placed = tuple(Door((4.0 * k + 1.0, 0.0), (4.0 * k + 2.0, 0.0), name) for k, name in enumerate(doors))
    return Level(level, level, int(level), 3.0 * int(level), (), placed, rings, rooms)


NAMED = FloorPlan(
    "",
    (named("0", "office", "WC", "WC", "", doors=("entrance", "")), named("1", "attic", "office", "lift")),
    (Connector(ConnectorKind.LIFT, "lift", (ConnectorStop("0", (1.0, 1.0)), ConnectorStop("1", (1.0, 1.0)))),
     Connector(ConnectorKind.STAIRS, "", (ConnectorStop("0", (2.0, 1.0)),))),
)  # fmt: skip


def test_everything_on_a_level_has_an_id_of_its_own_which_is_its_name_where_no_other_has_it() -> None:
    places = NAMED.places("0")
    assert {kind: list(found) for kind, found in places.items()} == {
        "connector": ["lift", "stairs 1"],
        "room": ["office", "WC 1", "WC 2", "room 1"],
        "door": ["entrance", "door 1"],
    }
    assert NAMED.landmark("WC 2", "0") == (10.0, 1.5)
    assert NAMED.landmark("entrance", "0") == (1.5, 0.0)
    assert NAMED.landmark("lift", "1") == (1.0, 1.0), "the lift, not the room of this name"
    with pytest.raises(FloorPlanError, match="level '0' has no stairs, lift, room or door 'WC'; it has 'lift', 'st"):
        NAMED.landmark("WC", "0")


few_names = st.sampled_from(
    ["", " ", "WC", "WC 1", "WC 2", "WC  2", "lift", "lift 1", "room", "room 1", "door 1", "stairs"]
)
any_names = st.lists(few_names | st.text(max_size=6), max_size=8)


@given(any_names, any_names, any_names)
def test_nothing_is_dropped_and_no_two_things_on_a_level_have_one_id_whatever_their_names_are(
    rooms: list[str], doors: list[str], lifts: list[str]
) -> None:
    stops = (ConnectorStop("0", (1.0, 1.0)), ConnectorStop("1", (1.0, 1.0)))
    joined = tuple([Connector(ConnectorKind.LIFT, name, stops) for name in lifts])
    plan = FloorPlan("", (named("0", *rooms, doors=doors), named("1", *rooms)), joined)
    places = plan.places("0")
    assert [len(places[kind]) for kind in ("room", "door", "connector")] == [len(rooms), len(doors), len(lifts)]
    ids = [name for found in places.values() for name in found]
    assert len(set(ids)) == len(ids)
    assert all(" ".join(name.split()) == name != "" for name in ids)
    assert list(plan.places("1")["connector"]) == list(places["connector"]), "a lift has one id on all its levels"
    for found in places.values():
        for name, place in found.items():
            assert plan.landmark(name, "0") == place == plan.start(name, "0").place


def test_a_name_that_a_room_and_a_door_have_is_the_id_of_neither_and_white_space_is_one_space() -> None:
    places = FloorPlan("", (named("0", "hall door", "Classroom \n 8", doors=("hall door",)),)).places("0")
    assert list(places["room"]) == ["hall door 1", "Classroom 8"] and list(places["door"]) == ["hall door 2"]


def test_a_start_may_be_a_room_which_is_as_uncertain_as_the_room_is_large() -> None:
    assert NAMED.start("attic", heading=1.0) == Start("1", (2.0, 1.5), 1.0, math.sqrt(25.0 / 12.0))
    assert NAMED.start("office", "1").place == (6.0, 1.5)
    assert NAMED.start("stairs 1") == Start("0", (2.0, 1.0))
    for name, level, why in (
        ("office", None, "'office' is on several levels: '0', '1'"),
        ("cellar", None, "no level of the plan has stairs, a lift, a room or a door 'cellar'"),
        ("attic", "0", "level '0' has no stairs, lift, room or door 'attic'"),
        ("attic", "2", "the plan has no level '2', only 0, 1"),
    ):
        with pytest.raises(FloorPlanError, match=why):
            NAMED.start(name, level)
