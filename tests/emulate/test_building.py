"""The emulated buildings are valid plans, and no walk in them crosses a wall."""

from functools import cache
from itertools import pairwise
from math import hypot

import numpy as np
import pytest
from here import EXAMPLES

from solepath.emulate.buildings.storeys import STOREY, Building
from solepath.emulate.routes.building import BUILDING, CABINS, EAST, FOUR_LOOPS, HALF_TURN, NORTH, ONE_SIDED
from solepath.emulate.routes.ways import BuildingWalk, case_study, corridor, wandering
from solepath.emulate.wearers.walker import Walker
from solepath.floorplan.checks import find_fault, find_warnings
from solepath.floorplan.importers.reading import read_floorplan
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import ConnectorKind
from solepath.types import Foot

LEVEL = {level.id: number for number, level in enumerate(BUILDING.levels)}
SEEDS = range(101, 113)
BUILDINGS = {"four loops": FOUR_LOOPS, "one-sided": ONE_SIDED, "half-turn": HALF_TURN}
OTHER_WAYS = {
    f"{name} {seed}": wandering(seed, BUILDINGS[name]) for name in ("one-sided", "half-turn") for seed in range(1, 7)
}
"""Walks through the other buildings by name."""


@pytest.fixture(scope="module")
def plan() -> IndexedPlan:
    return IndexedPlan(BUILDING)


@pytest.fixture(scope="module")
def plans() -> dict[str, IndexedPlan]:
    return {one.name: IndexedPlan(one.plan) for one in BUILDINGS.values()}


def test_the_building_has_two_floors_of_56_by_63_metres_with_four_elevators_and_two_staircases() -> None:
    assert find_fault(BUILDING) is None and find_warnings(BUILDING) == ()
    assert len(BUILDING.levels) == 2
    for level in BUILDING.levels:
        ends = [point for wall in level.walls for point in (wall.start, wall.end)]
        assert (min(x for x, _ in ends), max(x for x, _ in ends)) == (0.0, EAST) == (0.0, 56.0)
        assert (min(y for _, y in ends), max(y for _, y in ends)) == (0.0, NORTH) == (0.0, 63.0)
    kinds = [one.kind for one in BUILDING.connectors]
    assert kinds.count(ConnectorKind.LIFT) == 4 and kinds.count(ConnectorKind.STAIRS) == 2
    assert all(one.flights == 2 for one in BUILDING.connectors if one.kind is ConnectorKind.STAIRS)
    assert BUILDING.levels[1].elevation - BUILDING.levels[0].elevation == STOREY


def test_the_example_file_is_the_building() -> None:
    path = EXAMPLES / "building.geojson"
    assert read_floorplan(path) == BUILDING


def test_rooms_are_closed_but_for_their_doors(plan: IndexedPlan) -> None:
    for number, level in enumerate(BUILDING.levels):
        for door in level.doors:
            (x0, y0), (x1, y1) = door.start, door.end
            x, y, away = 0.5 * (x0 + x1), 0.5 * (y0 + y1), hypot(x1 - x0, y1 - y0)
            dx, dy = 0.2 * (y1 - y0) / away, 0.2 * (x0 - x1) / away
            assert not plan.crosses(number, x - dx, y - dy, x + dx, y + dy)
        assert plan.crosses(number, 9.0, 13.5, 12.0, 13.5) and plan.crosses(number, 5.0, 28.5, 5.0, 29.5)


@cache
def walked(way: BuildingWalk, seed: int = 7) -> tuple[Walker, np.ndarray, list[tuple[str, float, float]]]:
    walker = Walker(way.route, seed=seed)
    t = np.arange(0.0, walker.duration, 0.2)
    return walker, t, way.places(walker, t)


WAYS = {"case": case_study(), "corridor": corridor(), **{str(seed): wandering(seed) for seed in SEEDS}, **OTHER_WAYS}


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_no_walk_crosses_a_wall(plans: dict[str, IndexedPlan], way: BuildingWalk) -> None:
    _, _, places = walked(way)
    plan = plans[way.building.name]
    for (level, x0, y0), (_, x1, y1) in pairwise(places):
        assert not plan.crosses(LEVEL[level], x0, y0, x1, y1)
        assert plan.inside(LEVEL[level], x0, y0)
        for aside, up in ((0.4, 0.0), (-0.4, 0.0), (0.0, 0.4), (0.0, -0.4)):
            assert not plan.crosses(LEVEL[level], x0, y0, x0 + aside, y0 + up)  # nor with a shoulder


def wall_marks(building: Building) -> set[tuple[int, int]]:
    """Return a mark every decimetre along the walls and the doors of the upper floor, in decimetres."""
    level = building.plan.levels[1]
    marks: set[tuple[int, int]] = set()
    for (x0, y0), (x1, y1) in [(one.start, one.end) for one in (*level.walls, *level.doors)]:
        count = max(1, round(10.0 * hypot(x1 - x0, y1 - y0)))
        shares = [(k + 0.5) / count for k in range(count)]
        marks |= {(round(10.0 * (x0 + (x1 - x0) * s)), round(10.0 * (y0 + (y1 - y0) * s))) for s in shares}
    return marks


def turned_share(building: Building, *, turn_x: bool, turn_y: bool) -> float:
    """Return the share of walls that lie on walls when x, y or both are mirrored about the middle of the building."""
    marks = wall_marks(building)
    near = {(x + i, y + j) for x, y in marks for i in (-1, 0, 1) for j in (-1, 0, 1)}
    width, depth = (round(10.0 * one) for one in building.size)
    images = [(width - x if turn_x else x, depth - y if turn_y else y) for x, y in marks]
    return sum(image in near for image in images) / len(images)


def test_one_building_is_the_same_after_half_a_turn_and_the_others_are_not() -> None:
    assert turned_share(HALF_TURN, turn_x=True, turn_y=True) == 1.0
    for other in (FOUR_LOOPS, ONE_SIDED):
        assert turned_share(other, turn_x=True, turn_y=True) < 0.7


@pytest.mark.parametrize("name", BUILDINGS)
def test_no_building_is_its_own_mirror_image(name: str) -> None:
    for turn_x in (False, True):
        assert turned_share(BUILDINGS[name], turn_x=turn_x, turn_y=not turn_x) < 0.8


def test_lifts_and_stairs_of_the_one_sided_building_are_in_its_west() -> None:
    assert all(stop.place[0] < EAST / 3.0 for one in ONE_SIDED.plan.connectors for stop in one.stops)
    assert len(ONE_SIDED.cabins) == 2 and len(ONE_SIDED.wells) == 2


def test_whoever_is_turned_with_the_building_is_as_far_from_its_lifts_and_stairs() -> None:
    """The turn takes each lift to another lift, and the stairs to the other stairs."""
    for ours in (HALF_TURN.cabins, HALF_TURN.wells):
        middles = [(0.5 * (one.box[0] + one.box[2]), 0.5 * (one.box[1] + one.box[3])) for one in ours]
        images = sorted((EAST - x, NORTH - y) for x, y in middles)
        assert np.array(images) == pytest.approx(np.array(sorted(middles)))


@pytest.mark.parametrize("name", BUILDINGS)
def test_every_building_is_a_valid_plan_of_its_size(name: str) -> None:
    building = BUILDINGS[name]
    assert find_fault(building.plan) is None and find_warnings(building.plan) == ()
    for level in building.plan.levels:
        ends = np.array([point for wall in level.walls for point in (wall.start, wall.end)])
        assert tuple(ends.min(axis=0)) == (0.0, 0.0) and tuple(ends.max(axis=0)) == building.size


@pytest.mark.parametrize("way", OTHER_WAYS.values(), ids=OTHER_WAYS)
def test_a_walk_through_another_building_uses_its_lifts_and_stairs(way: BuildingWalk) -> None:
    assert way.entry != way.exit and {way.entry, way.exit} <= {one.name for one in way.building.plan.connectors}


@pytest.mark.parametrize("seed", SEEDS)
def test_a_wanderer_comes_by_one_connector_and_leaves_by_another(seed: int) -> None:
    way = WAYS[str(seed)]
    truth = walked(way)[0].truth()
    assert way.entry != way.exit and {way.entry, way.exit} <= {one.name for one in BUILDING.connectors}
    cabins = {cabin.name for cabin in CABINS}
    assert len(truth.rides) == (way.entry in cabins) + (way.exit in cabins)
    assert len(truth.flights) == 2 * ((way.entry not in cabins) + (way.exit not in cabins))
    climbed = sum(ride.height for ride in truth.rides) + sum(flight.height for flight in truth.flights)
    assert climbed == pytest.approx(0.0)  # to the other floor and back
    assert way.start.level != way.level


def test_the_case_study_goes_down_by_the_elevator_at_the_bottom_left_and_away_by_another() -> None:
    way = case_study()
    walker, t, places = walked(way, 3)
    truth = walker.truth()
    assert [ride.height for ride in truth.rides] == pytest.approx([-STOREY, STOREY])
    on_floor = (t > truth.rides[0].end) & (t < truth.rides[1].start)
    assert {place[0] for place, there in zip(places, on_floor, strict=True) if there} == {way.level}
    (ax, ay), (bx, by) = CABINS[0].middle, CABINS[1].middle
    first, last = np.array(places[0][1:]), np.array(places[-1][1:])
    assert np.hypot(*(first - (ax, ay))) < 0.1 and np.hypot(*(last - (bx, by))) < 0.1
    assert ax < 0.25 * EAST and ay < 0.25 * NORTH


def test_the_true_place_is_where_the_feet_are_on_the_plan() -> None:
    """The start's heading turns the walk's world into the plan's."""
    way = wandering(103)
    walker, t, places = walked(way, 5)
    truth = walker.truth()
    heading = way.start.heading or 0.0
    feet = [truth.pose(foot, t).position + np.array(truth.feet[foot].origin) for foot in Foot]
    middle = 0.5 * (feet[0] + feet[1])
    x = way.start.place[0] + np.cos(heading) * middle[:, 0] - np.sin(heading) * middle[:, 1]
    y = way.start.place[1] + np.sin(heading) * middle[:, 0] + np.cos(heading) * middle[:, 1]
    away = [hypot(a - p[1], b - p[2]) for a, b, p in zip(x.tolist(), y.tolist(), places, strict=True)]
    assert max(away) < 0.25  # the sensors are not at the ankles
