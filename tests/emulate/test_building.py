"""The emulated buildings are valid plans, and no walk in them crosses a wall."""

from functools import cache
from itertools import pairwise
from math import hypot, pi
from typing import Any

import numpy as np
import pytest
from here import EXAMPLES

from solepath.emulate import Course
from solepath.emulate.routes.building import BUILDING, FOUR_LOOPS, STOREY
from solepath.emulate.routes.ways import case_study, wandering
from solepath.emulate.wearers.walker import Walker
from solepath.floorplan.checks import find_fault
from solepath.floorplan.findings import find_warnings
from solepath.floorplan.geometry import distance
from solepath.floorplan.importers.reading import read_floorplan
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import ConnectorKind
from solepath.types import Foot
from solepath_lab.emulated.buildings import HALF_TURN

LEVEL = {level.id: number for number, level in enumerate(BUILDING.levels)}
BUILDINGS = {"four loops": FOUR_LOOPS, "half-turn": HALF_TURN}
WAYS = {"case": case_study(), "103": wandering(103), "half-turn": wandering(1, HALF_TURN)}


@cache
def walked(name: str) -> tuple[Walker, np.ndarray, list[tuple[str, float, float]]]:
    walker = Walker(WAYS[name].route, seed=7)
    t = np.arange(0.0, walker.duration, 0.2)
    return walker, t, WAYS[name].places(walker, t)


@pytest.mark.parametrize("name", BUILDINGS)
def test_every_building_is_a_valid_plan_of_its_size(name: str) -> None:
    building = BUILDINGS[name]
    assert find_fault(building.plan) is None and find_warnings(building.plan) == ()
    for level in building.plan.levels:
        ends = np.array([point for wall in level.walls for point in (wall.start, wall.end)])
        assert tuple(ends.min(axis=0)) == (0.0, 0.0) and tuple(ends.max(axis=0)) == (56.0, 63.0)


def test_the_building_has_two_floors_of_56_by_63_metres_and_is_the_example_file() -> None:
    assert read_floorplan(EXAMPLES / "building.geojson") == BUILDING == FOUR_LOOPS.plan
    kinds = [one.kind for one in BUILDING.connectors]
    assert kinds.count(ConnectorKind.LIFT) == 4 and kinds.count(ConnectorKind.STAIRS) == 2
    assert len(BUILDING.levels) == 2
    assert BUILDING.levels[1].elevation - BUILDING.levels[0].elevation == STOREY
    index = IndexedPlan(BUILDING)
    for number, level in enumerate(BUILDING.levels):
        for (x0, y0), (x1, y1) in ((door.start, door.end) for door in level.doors):
            x, y, away = 0.5 * (x0 + x1), 0.5 * (y0 + y1), hypot(x1 - x0, y1 - y0)
            dx, dy = 0.2 * (y1 - y0) / away, 0.2 * (x0 - x1) / away
            assert not index.crosses(number, x - dx, y - dy, x + dx, y + dy)
        assert index.crosses(number, 9.0, 13.5, 12.0, 13.5) and index.crosses(number, 5.0, 28.5, 5.0, 29.5)


@pytest.mark.parametrize("name", WAYS)
def test_no_walk_crosses_a_wall_and_each_comes_and_leaves_by_a_lift_or_stairs(name: str) -> None:
    way, (walker, _, places) = WAYS[name], walked(name)
    index = IndexedPlan(way.building.plan)
    for (level, x0, y0), (_, x1, y1) in pairwise(places):
        assert not index.crosses(LEVEL[level], x0, y0, x1, y1) and index.inside(LEVEL[level], x0, y0)
        for aside, up in ((0.4, 0.0), (-0.4, 0.0), (0.0, 0.4), (0.0, -0.4)):
            assert not index.crosses(LEVEL[level], x0, y0, x0 + aside, y0 + up)  # nor with a shoulder
    cabins, truth = {cabin.name for cabin in way.building.cabins}, walker.truth()
    assert way.entry != way.exit and {way.entry, way.exit} <= {one.name for one in way.building.plan.connectors}
    assert len(truth.rides) == (way.entry in cabins) + (way.exit in cabins)
    assert len(truth.flights) == 2 * ((way.entry not in cabins) + (way.exit not in cabins))
    assert sum(one.height for one in (*truth.rides, *truth.flights)) == pytest.approx(0.0)


def test_the_true_place_is_where_the_feet_are_on_the_plan() -> None:
    """The start's heading turns the walk's world into the plan's."""
    way, (walker, t, places) = WAYS["103"], walked("103")
    truth, heading = walker.truth(), way.start.heading or 0.0
    middle = 0.5 * sum(truth.pose(foot, t).position + np.array(truth.feet[foot].origin) for foot in Foot)
    x = way.start.place[0] + np.cos(heading) * middle[:, 0] - np.sin(heading) * middle[:, 1]
    y = way.start.place[1] + np.sin(heading) * middle[:, 0] + np.cos(heading) * middle[:, 1]
    away = [hypot(a - p[1], b - p[2]) for a, b, p in zip(x.tolist(), y.tolist(), places, strict=True)]
    assert max(away) < 0.25  # the sensors are not at the ankles


@pytest.mark.parametrize("up", [True, False])
@pytest.mark.parametrize(("flights", "turn", "end"), [
    (1, 0.0, (6.2, 1.0)), (2, 0.0, (11.6, 1.0)), (2, pi, (2.0, 2.4)), (2, -pi / 2, (7.5, -4.5)),
])  # fmt: skip
def test_own_stairs_lead_as_high_and_as_far_as_their_risers_and_treads(
    up: bool, flights: int, turn: float, end: tuple[float, float]
) -> None:
    course = Course("0", (1.0, 1.0), 0.0)
    course.stand()
    course.walk(1.0)
    course.stairs("1" if up else "-1", 15, up, rise=0.175, going=0.28, flights=flights, turn=turn)
    course.stand()
    walker = Walker(course.route)
    climbed = float(walker.truth().elevation(np.array([walker.duration]))[0])
    assert climbed == pytest.approx(flights * 15 * 0.175 * (1.0 if up else -1.0), abs=1e-6)
    assert course.level == ("1" if up else "-1")
    assert course.position == pytest.approx(end, abs=1e-6)
    assert course.place(walker, walker.duration) == pytest.approx(end, abs=0.05)


@pytest.mark.parametrize("walking", [False, True])
@pytest.mark.parametrize("height", [2.8, -2.8])
def test_an_escalator_carries_as_far_as_its_incline_and_its_level_ends(height: float, walking: bool) -> None:
    course = Course("0", (1.0, 1.0), pi / 2)
    course.stand()
    course.walk(2.0)
    course.escalator("other", height, walking=walking)
    assert course.level == "other" and course.heading == pi / 2
    assert course.position == pytest.approx((1.0, 3.0 + 7.39), abs=0.005)
    course.walk_along([(1.0, 12.0), (6.0, 12.0)])
    course.stand()
    walker = Walker(course.route)
    risen = float(walker.truth().elevation(np.array([walker.duration]))[0])
    assert risen == pytest.approx(height, abs=1e-6)
    assert course.place(walker, walker.duration) == pytest.approx((6.0, 12.0), abs=0.05)


def test_an_escalator_that_cannot_be_changes_nothing() -> None:
    course = Course("0", (1.0, 1.0), 0.0)
    for height, walking in ((0.5, False), (1.5, True)):
        with pytest.raises(ValueError, match="escalator: it rises by a metre at least"):
            course.escalator("1", height, walking=walking)
    assert course == Course("0", (1.0, 1.0), 0.0)


@pytest.mark.parametrize("wrong", [0, -1, 1.5, "16", True, None])
def test_flights_and_risers_that_cannot_be_are_named_before_anything_is_walked(wrong: Any) -> None:
    course = Course("0", (1.0, 1.0), 0.0)
    before = course.route, course.position
    with pytest.raises(ValueError, match=r"stairs: flights: a whole number of 1 or more, got "):
        course.stairs("1", 16, flights=wrong)
    with pytest.raises(ValueError, match=r"stairs: risers: a whole number of 1 or more, got "):
        course.stairs("1", wrong)
    with pytest.raises(ValueError, match=r"stairs: steps: a whole number of 1 or more, got "):
        course.route.stairs(wrong)
    assert (course.route, course.position, course.level) == (*before, "0")


def test_corners_that_are_close_together_are_walked_too() -> None:
    course = Course("0", (1.0, 1.0), 0.0)
    ways = [(1.0 + step, 1.0) for step in (0.8, 2.0)] + [(3.0, 1.4), (3.6, 1.4), (3.6, 5.0)]
    course.walk_along(ways)
    assert course.position == pytest.approx(ways[-1])
    walker = Walker(course.route)
    t = np.arange(0.0, walker.duration, 0.1)
    track = np.array([course.place(walker, float(one)) for one in t])
    legs = [(1.0, 1.0), *ways]
    off = [min([distance(*a, *b, x, y) for a, b in pairwise(legs)]) for x, y in track.tolist()]
    assert max(off) < 0.5, "the wearer stays near the line through the points"
