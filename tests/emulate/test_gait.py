"""Feet alternate, walks have half steps at both ends, and routes that nobody can go are rejected."""

from itertools import pairwise
from math import cos, inf, nan, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strides import in_order

from solepath.emulate import Route
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot
from solepath_lab.emulated.wearers import SUBJECTS

moves = st.one_of(
    st.tuples(st.just("walk"), st.floats(0.5, 8.0), st.floats(0.6, 1.8)),
    st.tuples(st.just("turn"), st.floats(-3.0, 3.0).filter(lambda a: abs(a) > 0.2), st.floats(0.8, 4.0)),
    st.tuples(st.just("turn"), st.floats(-3.2, 3.2)),
    st.tuples(st.just("stand"), st.floats(0.05, 3.0)),
    st.tuples(st.just("jog"), st.floats(0.5, 20.0), st.floats(1.5, 4.5)),
)


@settings(max_examples=20)
@given(st.lists(moves, min_size=1, max_size=5), st.integers(0, 2**16))
def test_feet_alternate_one_is_on_the_ground_and_any_walk_ends_with_them_together(
    chosen: list[tuple[str, float]], seed: int
) -> None:
    route = Route().stand(1.0)
    for what, *numbers in chosen:
        route = getattr(route, what)(*numbers)
    steady = Wearer(width_variation=0.0, angle_variation=0.0)
    walker = Walker(route.stop(1.0), steady, seed=seed)
    in_order(walker)
    steps = sorted((s.heel_strike, s.toe_off, foot) for foot in Foot for s in walker.plan.strides[foot])
    runs = any(what == "jog" for what, *_ in chosen)
    for (strike, _, foot), (_, toe_off, other) in pairwise(steps):
        assert foot is not other and (runs or toe_off > strike)  # double support between them
    end = walker.route.end
    for foot, side in ((Foot.LEFT, 1.0), (Foot.RIGHT, -1.0)):
        strides = walker.plan.strides[foot]
        at = strides[-1].end if strides else walker.plan.starts[foot]
        out = side * 0.5 * steady.step_width
        assert (at.x, at.y) == pytest.approx((end.x - out * sin(end.heading), end.y + out * cos(end.heading)), abs=1e-9)
        assert at.heading == pytest.approx(end.heading + side * steady.toe_out)


@pytest.mark.parametrize("first", Foot)
def test_a_walk_starts_with_its_foot_goes_its_distance_and_has_half_steps_at_both_ends(first: Foot) -> None:
    walker = Walker(Route().stand(1).walk(36.0, 1.3).stop(1), Wearer(first_foot=first), seed=3)
    truth = walker.truth()
    steps = sorted((step.t_heel_strike, step.length, foot) for foot in Foot for step in truth.strides(foot))
    lengths = [length for _, length, _ in steps]
    middle = sum(lengths[2:-2]) / len(lengths[2:-2])
    assert steps[0][2] is first
    assert (lengths[0], lengths[-1]) == pytest.approx((0.5 * middle, 0.5 * middle), rel=0.15)
    for foot in Foot:
        assert truth.pose(foot, walker.duration).position[0] == pytest.approx([36.0, 0.0, 0.0], abs=0.06)
    one, two = (truth.strides(Foot.LEFT)[k].t_end for k in (3, -3))
    x = truth.pose(Foot.LEFT, [one, two]).position[:, 0]
    assert (x[1] - x[0]) / (two - one) == pytest.approx(1.3, rel=0.02)
    assert 105 < Wearer().cadence(1.3) < 115


@pytest.mark.parametrize("bad", [0.0, -1.0, nan, inf])
def test_invalid_values_in_a_route_are_rejected(bad: float) -> None:
    for what, numbers in (("stand", (bad,)), ("walk", (bad,)), ("walk", (1.0, bad)), ("turn", (1.0, bad or -0.5))):
        with pytest.raises(ValueError):
            getattr(Route(), what)(*numbers)


@pytest.mark.parametrize(
    ("what", "given", "word"),
    [
        ("walk", {"distance": 2.0, "direction": 0.3}, "direction"),
        ("walk", {"distance": 2.0, "direction": 0.5 * pi, "slope": 0.05}, "level"),
        ("walk", {"distance": 2.0, "slope": 0.3}, "slope"),
        ("walk", {"distance": 5.0, "stops": ((3.0, 1.0), (2.0, 1.0))}, "stops"),
        ("stairs", {"steps": 0}, "stairs"),
        ("stairs", {"steps": 4, "rise": 0.4}, "stairs"),
        ("stairs", {"steps": 4, "going": 0.2}, "stairs"),
        ("lift", {"height": 0.1}, "lift"),
        ("escalator", {"height": 0.5}, "escalator"),
        ("escalator", {"height": nan}, "escalator"),
    ],
)
def test_a_way_that_nobody_can_go_is_rejected(what: str, given: dict[str, object], word: str) -> None:
    with pytest.raises(ValueError, match=word):
        getattr(Route(), what)(**given)


def test_two_flights_need_a_landing_and_stairs_a_level_start() -> None:
    with pytest.raises(ValueError, match="landing"):
        Route().stairs(4).stairs(4)
    with pytest.raises(ValueError, match="level"):
        Route().walk(5.0, slope=0.08).walk(1.0).stairs(5)


def test_the_four_subjects_are_those_of_table_3() -> None:
    """Height, weight and shoe size in Gong et al. 2023. A thigh is 0.245 of the height, a shoe 285/275 of its size."""
    found = [(one.limbs.thigh / 0.245, one.mass, one.shoe.length * 275.0 / 285.0) for one in SUBJECTS]
    table_3 = [(1.72, 63.0, 0.245), (1.68, 52.5, 0.255), (1.60, 50.0, 0.235), (1.83, 81.0, 0.270)]
    assert [pytest.approx(one) for one in table_3] == found
