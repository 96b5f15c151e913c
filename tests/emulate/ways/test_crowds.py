"""Halts, half steps and shuffling of wearers in a crowd: where they are, how long they last, and how they end."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from strides import in_order

from solepath.emulate.routes.actions import Stand, Walk
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.gait import SUBJECTS, Wearer
from solepath.emulate.wearers.shoe import Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.types import Activity, Foot

SEEDS = range(1, 7)


def test_a_wearer_halts_at_a_door_on_the_way_and_goes_on() -> None:
    route = Route().stand(1.0).walk(8.0, 1.2, stops=((3.0, 0.5), (5.5, 2.0))).stand(1.0)
    walker = Walker(route, seed=3)
    standing = [(a, b) for a, b, activity in walker.truth().activities if activity is Activity.STANDING]
    assert [b - a for a, b in standing] == pytest.approx([1.0, 0.5, 2.0, 1.0])
    for (start, end), place in zip(standing, (0.0, 3.0, 5.5, 8.0), strict=True):
        middle = np.array([0.5 * (start + end)])
        ankles = [walker.kinematics(foot, middle, Mounting((walker.wearer.shoe.ankle[0], 0.0, 0.0))) for foot in Foot]
        assert [one.position[0, 0] for one in ankles] == pytest.approx([place, place], abs=0.05)
    assert route.end.x == pytest.approx(8.0) and route.speed == 1.2


def test_a_halt_ends_with_a_half_step_that_brings_the_feet_together() -> None:
    walker = Walker(Route().stand(1.0).walk(8.0, 1.2, stops=((4.0, 1.0),)).stand(1.0), seed=3)
    start = next(t for t, _, activity in walker.truth().activities[1:] if activity is Activity.STANDING)
    (foot, last), (_, before) = sorted(
        ((foot, stride) for foot in Foot for stride in walker.plan.strides[foot] if stride.heel_strike < start),
        key=lambda one: -one[1].heel_strike,
    )[:2]
    assert foot in Foot and last.end.x - last.start.x < 0.65 * (before.end.x - before.start.x)


def test_halts_are_made_backwards_and_on_ramps_too() -> None:
    back = Route().walk(4.0, direction=pi, stops=((2.0, 1.0),))
    assert [type(action) for action in back.actions] == [Walk, Stand, Walk] and back.end.x == pytest.approx(-4.0)
    ramp = Route().walk(10.0, slope=0.08, stops=((5.0, 1.0),))
    assert ramp.end.z == pytest.approx(0.8)


@pytest.mark.parametrize("stops", [((0.0, 1.0),), ((3.0, 1.0), (2.0, 1.0)), ((5.0, 1.0),), ((2.0, 0.0),)])
def test_halts_are_in_order_on_the_way_and_last(stops: tuple[tuple[float, float], ...]) -> None:
    with pytest.raises(ValueError, match="stops|duration"):
        Route().walk(5.0, stops=stops)


def test_who_shuffles_makes_short_slow_steps_from_halt_to_halt() -> None:
    walker = Walker(Route().stand(1.0).walk(3.0, 1.2).shuffle(1.5).walk(3.0).stand(1.0), seed=3)
    steps = sorted(
        (stride.heel_strike, foot, stride)
        for foot in Foot
        for stride in walker.plan.strides[foot]
        if stride.start.x > 3.0
    )
    between = [stride for _, _, stride in steps if stride.end.x < 4.45 and stride.start.x > 3.1]
    assert len(between) >= 6
    for stride in between:
        assert stride.end.x - stride.start.x == pytest.approx(0.30, abs=0.08)
        assert stride.step_speed == pytest.approx(0.3, abs=0.08)
    for place in (3.0, 4.5):  # the feet are together there
        together = [sum(abs(one.end.x - place) < 0.05 for one in walker.plan.strides[foot]) for foot in Foot]
        assert together == [1, 1]
    assert walker.route.speed == 1.2


@pytest.mark.parametrize("seed", SEEDS)
def test_a_crowd_has_short_halts_and_slow_walks_and_nothing_else(seed: int) -> None:
    route = Route().stand(1.0).crowded(15.0, seed)
    assert route.end.x == pytest.approx(15.0) and route.speed == 1.3
    assert sum(action.distance for action in route.actions if isinstance(action, Walk)) == pytest.approx(15.0)
    halts = [action.duration for action in route.actions[1:] if isinstance(action, Stand)]
    assert len(halts) >= 4 and all(0.5 <= halt <= 3.0 for halt in halts)
    assert all(0.2 <= action.speed <= 1.2 for action in route.actions if isinstance(action, Walk))
    walker = Walker(route.stand(1.0), seed=seed)
    in_order(walker)
    assert {activity for _, _, activity in walker.truth().activities} == {Activity.STANDING, Activity.WALKING}


def test_the_same_seed_is_the_same_crowd_and_another_one_is_not() -> None:
    assert Route().crowded(20.0, 4) == Route().crowded(20.0, 4) != Route().crowded(20.0, 5)


@pytest.mark.parametrize("wearer", SUBJECTS)
def test_in_a_crowd_soles_stay_above_the_floor_and_nothing_jumps(wearer: Wearer) -> None:
    walker = Walker(Route().stand(1.0).crowded(10.0, 2).stand(1.0), wearer, seed=2)
    t = np.arange(0.0, walker.duration, 2e-3)
    for foot in Foot:
        for arc in (wearer.shoe.heel, wearer.shoe.forefoot):
            found = walker.motions[foot].at(t, Mounting((arc.x, 0.0, arc.radius)))
            assert (found.position[:, 2] - arc.radius).min() > -5e-4
            assert np.linalg.norm(np.diff(found.velocity, axis=0), axis=1).max() < 0.25
