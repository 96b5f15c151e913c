"""Walking backwards and sideways: where the feet go, how they land, which foot leads, and that it is walking."""

from itertools import pairwise
from math import pi

import numpy as np
import pytest
from strides import in_order

from solepath.emulate.routes.route import Route
from solepath.emulate.routes.styles import StrideKind
from solepath.emulate.wearers.gait import SUBJECTS, Wearer
from solepath.emulate.wearers.shoe import ON_INSTEP, Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.types import Activity, Foot

WAYS = {"back": pi, "left": 0.5 * pi, "right": -0.5 * pi}
"""Direction of each way, rad, by name."""
DISTANCE = 4.0
"""Distance of each walk, m."""


def walker_of(way: str) -> Walker:
    """Return a walker who walks ahead, then this way without a halt, and ahead again."""
    route = Route().stand(1.0).walk(3.0).walk(DISTANCE, direction=WAYS[way]).walk(2.0).stand(1.0)
    return Walker(route, seed=4)


@pytest.mark.parametrize("way", WAYS)
def test_the_wearer_goes_one_way_and_the_feet_point_another(way: str) -> None:
    walker = walker_of(way)
    end = walker.route.end
    assert (end.x, end.y) == pytest.approx((5.0 + DISTANCE * np.cos(WAYS[way]), DISTANCE * np.sin(WAYS[way])))
    assert end.heading == 0.0
    for foot in Foot:
        last = walker.plan.strides[foot][-1].end
        assert (last.x, last.y) == pytest.approx((end.x, end.y), abs=0.13)
        assert all(abs(stride.end.heading) < 0.2 for stride in walker.plan.strides[foot])


@pytest.mark.parametrize("way", WAYS)
def test_feet_alternate_in_order_and_it_is_all_walking(way: str) -> None:
    walker = walker_of(way)
    in_order(walker)
    starts = [one for one, _ in walker.plan.bouts]
    steps = sorted((stride.heel_strike, foot) for foot in Foot for stride in walker.plan.strides[foot])
    for (t, foot), (later, other) in pairwise(steps):
        assert foot is not other or any(t < start < later for start in starts)
    truth = walker.truth()
    assert [activity for _, _, activity in truth.activities] == [Activity.STANDING, Activity.WALKING, Activity.STANDING]


def test_strides_backwards_are_short_and_slow_and_land_with_the_toes_down() -> None:
    walker = walker_of("back")
    for foot in Foot:
        strides = [stride for stride in walker.plan.strides[foot] if stride.kind is StrideKind.BACK]
        assert len(strides) > 5
        for stride in strides[1:-1]:
            assert stride.end.x - stride.start.x == pytest.approx(-0.57, abs=0.05)
            assert stride.step_speed == pytest.approx(0.5, abs=0.05)
            pitch = walker.motions[foot].pitch(np.linspace(stride.heel_off, stride.foot_flat, 200))
            assert pitch.min() > -0.35 and pitch.max() < 0.1
            assert pitch.min() < -0.15


@pytest.mark.parametrize(("way", "leader"), [("left", Foot.LEFT), ("right", Foot.RIGHT)])
def test_one_foot_leads_aside_the_other_closes_and_they_never_cross(way: str, leader: Foot) -> None:
    walker = walker_of(way)
    steps = [(stride, foot) for foot in Foot for stride in walker.plan.strides[foot] if stride.kind is StrideKind.SIDE]
    steps.sort(key=lambda step: step[0].heel_strike)
    assert [foot for _, foot in steps[::2]] == [leader] * (len(steps) // 2)
    for stride, _ in steps:
        assert abs(stride.end.y - stride.start.y) == pytest.approx(0.31, abs=0.06)
    t = np.arange(steps[0][0].heel_off, walker.duration, 0.01)
    left, right = (walker.kinematics(foot, t).position[:, 1] for foot in (Foot.LEFT, Foot.RIGHT))
    assert (left - right).min() > 0.08


@pytest.mark.parametrize("way", WAYS)
def test_the_sole_clears_the_ground_and_the_motion_never_jumps(way: str) -> None:
    walker = walker_of(way)
    t = np.arange(0.0, walker.duration, 1e-3)
    for foot in Foot:
        heights = [
            walker.motions[foot].at(t, Mounting((arc.x, 0.0, arc.radius))).position[:, 2] - arc.radius
            for arc in (walker.wearer.shoe.heel, walker.wearer.shoe.forefoot)
        ]
        assert np.min(heights, axis=0).min() > -5e-4
        found = walker.kinematics(foot, t, ON_INSTEP)
        assert np.linalg.norm(np.diff(found.velocity, axis=0), axis=1).max() < 0.25
        for stride in walker.plan.strides[foot]:
            if stride.kind in (StrideKind.BACK, StrideKind.SIDE):
                swing = walker.kinematics(foot, np.linspace(stride.toe_off, stride.heel_strike, 200))
                assert np.linalg.norm(swing.velocity, axis=1).max() < 3.0


def test_the_load_is_that_of_the_body() -> None:
    for way in WAYS:
        walker = walker_of(way)
        t = np.arange(0.0, walker.duration, 0.01)
        total = sum(walker.loads.total(foot, t) for foot in Foot)
        assert float(np.mean(total)) == pytest.approx(walker.loads.weight, rel=0.01)


def test_backwards_on_a_ramp_the_feet_lie_on_it() -> None:
    walker = Walker(Route().stand(1.0).walk(4.0, direction=-pi, slope=1.0 / 12.0).stand(1.0), seed=3)
    assert walker.truth().elevation(walker.duration)[0] == pytest.approx(4.0 / 12.0)
    assert walker.plan.strides[Foot.LEFT][-1].end.grade == pytest.approx(-1.0 / 12.0)


@pytest.mark.parametrize("wearer", SUBJECTS)
def test_other_wearers_and_longer_routes_keep_their_order(wearer: Wearer) -> None:
    route = Route().stand(1.0)
    for direction in (pi, 0.5 * pi, -0.5 * pi):
        route = route.jog(20.0).walk(2.0, direction=direction).turn(1.0).walk(0.2, 0.4, direction=direction)
    walker = Walker(route.stairs(4).walk(2.0, direction=pi).stand(1.0), wearer, seed=2)
    in_order(walker)
    assert np.isfinite(walker.kinematics(Foot.LEFT, np.arange(0.0, walker.duration, 0.01)).force).all()


def test_only_the_main_directions_are_walked_and_side_steps_are_level() -> None:
    for direction in (0.3, float("nan")):
        with pytest.raises(ValueError, match="direction"):
            Route().walk(2.0, direction=direction)
    with pytest.raises(ValueError, match="level"):
        Route().walk(2.0, direction=0.5 * pi, slope=0.05)
    assert Route().walk(2.0, direction=2.0 * pi) == Route().walk(2.0)
    assert Route(speed=1.1).walk(2.0, 0.4, direction=pi).speed == 1.1
