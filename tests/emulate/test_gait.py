"""Routes become footfalls: in order, alternating, with double support, ending where the route ends."""

from itertools import pairwise
from math import cos, degrees, hypot, pi, radians, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strides import in_order

from solepath.emulate.routes.actions import TurnAction, stages
from solepath.emulate.routes.path import Pivot
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.gait import SUBJECTS, Wearer
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot

moves = st.one_of(
    st.tuples(st.just("walk"), st.floats(0.5, 8.0), st.floats(0.6, 1.8)),
    st.tuples(st.just("bend"), st.floats(-3.0, 3.0).filter(lambda a: abs(a) > 0.2), st.floats(0.8, 4.0)),
    st.tuples(st.just("pivot"), st.floats(-3.2, 3.2), st.just(0.0)),
    st.tuples(st.just("stand"), st.floats(0.05, 3.0), st.just(0.0)),
)


@st.composite
def routes(draw: st.DrawFn) -> Route:
    route = Route().stand(1.0)
    for kind, a, b in draw(st.lists(moves, min_size=1, max_size=5)):
        match kind:
            case "walk":
                route = route.walk(a, b)
            case "bend":
                route = route.turn(a, b)
            case "pivot":
                route = route.turn(a)
            case _:
                route = route.stand(a)
    return route.stop(1.0)


def all_steps(walker: Walker) -> list[tuple[float, Foot]]:
    return sorted((s.heel_strike, foot) for foot in Foot for s in walker.plan.strides[foot])


@settings(max_examples=25)
@given(routes(), st.integers(0, 2**16))
def test_feet_alternate_each_in_its_order_and_one_is_always_on_the_ground(route: Route, seed: int) -> None:
    walker = Walker(route, seed=seed)
    in_order(walker)
    steps = sorted(
        ((s, foot) for foot in Foot for s in walker.plan.strides[foot]), key=lambda step: step[0].heel_strike
    )
    for (one, foot), (two, other) in pairwise(steps):
        assert foot is not other
        assert two.toe_off > one.heel_strike  # double support between them


@settings(max_examples=25)
@given(routes(), st.integers(0, 2**16))
def test_a_walk_ends_with_the_feet_together_at_the_end_of_the_route(route: Route, seed: int) -> None:
    steady = Wearer(width_variation=0.0, angle_variation=0.0)
    walker = Walker(route, steady, seed=seed)
    end = route.end
    for foot, side in ((Foot.LEFT, 1.0), (Foot.RIGHT, -1.0)):
        strides = walker.plan.strides[foot]
        at = strides[-1].end if strides else walker.plan.starts[foot]
        out = side * 0.5 * steady.step_width
        assert (at.x, at.y) == pytest.approx((end.x - out * sin(end.heading), end.y + out * cos(end.heading)), abs=1e-9)
        assert at.heading == pytest.approx(end.heading + side * steady.toe_out)


def test_a_straight_walk_ends_after_its_distance() -> None:
    walker = Walker(Route().stand(1).walk(37.0, 1.3).stop(1), seed=5)
    for foot in Foot:
        moved = walker.truth().pose(foot, walker.duration).position[0]
        assert moved == pytest.approx([37.0, 0.0, 0.0], abs=0.06)


def test_a_turn_on_the_spot_is_made_in_small_steps_around_the_body() -> None:
    walker = Walker(Route().stand(1).turn(radians(180)).stop(1), seed=2)
    steps = [step for foot in Foot for step in walker.truth().strides(foot)]
    assert len(steps) == 6  # five of 36 degrees, and the other foot beside the last
    assert all(abs(degrees(step.heading_change)) < 90.0 for step in steps)
    assert all(step.length < 0.45 for step in steps)


def test_walks_start_and_end_with_half_steps() -> None:
    for foot_first in Foot:
        walker = Walker(Route().stand(1).walk(12.0, 1.3).stop(1), Wearer(first_foot=foot_first), seed=3)
        assert all_steps(walker)[0][1] is foot_first
        truth = walker.truth()
        steps = sorted((step.t_heel_strike, step.length) for foot in Foot for step in truth.strides(foot))
        lengths = [length for _, length in steps]
        middle = sum(lengths[2:-2]) / len(lengths[2:-2])
        assert lengths[0] == pytest.approx(0.5 * middle, rel=0.15)
        assert lengths[-1] == pytest.approx(0.5 * middle, rel=0.15)


def test_speed_is_step_length_times_cadence() -> None:
    for speed in (0.7, 1.0, 1.3, 1.7):
        cadence = Wearer().cadence(speed)
        assert Wearer().walk_ratio * cadence * cadence / 60.0 == pytest.approx(speed)
    assert 105 < Wearer().cadence(1.3) < 115
    walker = Walker(Route().stand(1).walk(60.0, 1.3).stop(1), seed=6)
    one, two = (walker.truth().strides(Foot.LEFT)[k] for k in (3, -3))
    positions = walker.truth().pose(Foot.LEFT, [one.t_end, two.t_end]).position[:, 0]
    assert (positions[1] - positions[0]) / (two.t_end - one.t_end) == pytest.approx(1.3, rel=0.02)


def test_a_route_knows_its_length_and_its_halts() -> None:
    route = Route().stand(1).walk(10, 1.3).turn(pi, 2.0).turn(pi / 2).walk(3).stop(1)
    assert route.length == pytest.approx(10 + 2 * pi + 3)
    assert [type(stage).__name__ for stage in stages(route.actions)] == [
        "Stand",
        "WalkPath",
        "Pivot",
        "WalkPath",
        "Stand",
    ]
    assert route.end.heading == pytest.approx(1.5 * pi)
    assert hypot(route.end.x - 10, route.end.y - 1) == pytest.approx(
        0.0, abs=1e-9
    )  # the pivot turned it down the y axis
    assert isinstance(stages(route.actions)[2], Pivot) and isinstance(route.actions[2], TurnAction)


@pytest.mark.parametrize("bad", [0.0, -1.0, float("nan"), float("inf")])
def test_invalid_values_in_a_route_are_rejected(bad: float) -> None:
    with pytest.raises(ValueError):
        Route().stand(bad)
    with pytest.raises(ValueError):
        Route().walk(bad)
    with pytest.raises(ValueError):
        Route().walk(1.0, bad)
    with pytest.raises(ValueError):
        Route().turn(1.0, bad if bad != 0.0 else -0.5)


def test_the_four_subjects_are_those_of_table_3() -> None:
    """Height, weight and shoe size in Gong et al. 2023. A thigh is 0.245 of the height, a shoe 285/275 of its size."""
    found = [(one.limbs.thigh / 0.245, one.mass, one.shoe.length * 275.0 / 285.0) for one in SUBJECTS]
    table_3 = [(1.72, 63.0, 0.245), (1.68, 52.5, 0.255), (1.60, 50.0, 0.235), (1.83, 81.0, 0.270)]
    assert [pytest.approx(one) for one in table_3] == found
