"""Jogging: both feet are in the air between the steps; feet land harder, are faster and rise higher than in walking."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strides import in_order

from solepath.emulate.routes.route import Route
from solepath.emulate.routes.styles import StrideKind
from solepath.emulate.wearers.gait import PlannedStride
from solepath.emulate.wearers.shoe import IN_SOLE, ON_INSTEP
from solepath.emulate.wearers.walker import Walker
from solepath.types import Activity, Foot


@pytest.fixture(scope="module")
def jogger() -> Walker:
    return Walker(Route().stand(1.0).walk(5.0).jog(30.0).walk(5.0).stop(1.0), seed=6)


def full_speed_strides(walker: Walker, foot: Foot) -> list[PlannedStride]:
    """Return the strides of a foot at full running speed."""
    return [s for s in walker.plan.strides[foot] if s.kind is StrideKind.RUN and s.speed > 2.59]


def test_there_is_a_flight_between_the_steps_of_a_jogger(jogger: Walker) -> None:
    steps = sorted((s.heel_strike, s, foot) for foot in Foot for s in jogger.plan.strides[foot])
    flights = [
        one.heel_strike - two.toe_off
        for (_, one, _), (_, two, _) in pairwise(steps)
        if one.kind is StrideKind.RUN and one.speed > 2.59
    ]
    assert len(flights) > 20
    assert min(flights) > 0.03 and max(flights) < 0.16
    for (_, one, foot), (_, _, other) in pairwise(steps):
        assert foot is not other, one


@pytest.mark.parametrize("foot", list(Foot))
def test_a_jogger_stands_on_a_foot_for_under_two_fifths_of_the_stride(jogger: Walker, foot: Foot) -> None:
    """1.60 m a stride and more, some 160 steps a minute, stance 35 to 40 %."""
    strides = full_speed_strides(jogger, foot)
    for one, two in pairwise(strides):
        if two.number == one.number + 1:
            stride_time = two.heel_strike - one.heel_strike
            assert 0.33 < (two.toe_off - one.heel_strike) / stride_time < 0.43
            assert 140.0 < 120.0 / stride_time < 180.0
            assert 1.5 < np.hypot(two.end.x - two.start.x, two.end.y - two.start.y) < 2.3


@pytest.mark.parametrize("foot", list(Foot))
def test_a_jogger_lands_harder_and_turns_the_foot_further_than_a_walker(jogger: Walker, foot: Foot) -> None:
    walked = Walker(Route().stand(1.0).walk(20.0).stop(1.0), seed=6)
    figures = []
    for walker, strides in (
        (jogger, full_speed_strides(jogger, foot)),
        (walked, list(walked.plan.strides[foot][2:-2])),
    ):
        top: list[float] = []
        hard: list[float] = []
        turned: list[float] = []
        high: list[float] = []
        for s in strides:
            t = np.linspace(s.toe_off, s.foot_flat, 500)
            found = walker.kinematics(foot, t, ON_INSTEP)
            hard.append(float(np.linalg.norm(found.force, axis=1).max()))
            top.append(float(np.linalg.norm(found.velocity, axis=1).max()))
            turned.append(-float(walker.motions[foot].pitch(t).min()))
            high.append(float(found.position[:, 2].max()))
        figures.append([float(np.median(values)) for values in (hard, top, turned, high)])
    (impact, fast, far, up), (softer, slower, less, lower) = figures
    assert impact > 1.5 * softer and 70.0 < impact < 160.0
    assert 5.0 < fast < 8.0 and fast > 1.2 * slower
    assert far > less + 0.2 and up > lower + 0.05


def test_each_foot_of_a_jogger_bears_twice_the_weight_and_in_flight_none_does(jogger: Walker) -> None:
    strides = sorted((s.heel_strike, s, foot) for foot in Foot for s in full_speed_strides(jogger, foot))
    for (_, one, foot), (_, two, _) in pairwise(strides[2:-2]):
        flown = np.linspace(two.toe_off + 1e-3, one.heel_strike - 1e-3, 20)
        assert max(abs(jogger.loads.total(side, flown)).max() for side in Foot) < 1e-6
        stood = np.linspace(one.heel_strike, one.heel_strike + 0.25, 100)
        assert 1.7 < jogger.loads.total(foot, stood).max() / jogger.loads.weight < 2.9


def test_a_jogger_walks_runs_and_walks_without_a_halt(jogger: Walker) -> None:
    kinds = [what for _, _, what in jogger.truth().activities]
    walking, running, standing = Activity.WALKING, Activity.RUNNING, Activity.STANDING
    assert kinds == [standing, walking, running, walking, standing]
    assert jogger.truth().pose(Foot.LEFT, jogger.duration).position[0, 0] == pytest.approx(40.0, abs=0.06)


@settings(max_examples=25)
@given(st.floats(0.5, 20.0), st.floats(1.5, 4.5), st.booleans(), st.integers(0, 2**16))
def test_whatever_is_run_the_events_of_a_foot_keep_their_order_and_it_ends_there(
    distance: float, speed: float, on: bool, seed: int
) -> None:
    route = Route().stand(1.0).jog(distance, speed)
    walker = Walker((route.walk(2.0) if on else route).stop(1.0), seed=seed)
    in_order(walker)
    load = walker.loads.body(np.arange(0.0, walker.duration, 0.01)) / walker.loads.weight
    assert load.min() >= -1e-9 and load.max() < 3.6
    assert walker.kinematics(Foot.LEFT, np.array([walker.duration]), IN_SOLE).position[0, 0] == pytest.approx(
        distance + 2.0 * on + 0.04, abs=0.06
    )
