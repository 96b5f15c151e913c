"""Ramps: the feet lie on the slope, rise exactly as it rises, clear it in swing, and the wearer walks."""

import numpy as np
import pytest

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.shoe import IN_SOLE, Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.types import Activity, Foot, Phase

SLOPE = 1.0 / 12.0
BOTTOM, TOP, END = 5.0, 15.0, 18.0
"""Distance from the start to both ends of the ramp up and to the end of it, m."""


@pytest.fixture(scope="module")
def ramp() -> Walker:
    """Return a walker who walks up a ramp of 10 m, on the level, and down half of another one, and stands there."""
    route = Route().stand(1.0).walk(BOTTOM).walk(TOP - BOTTOM, slope=SLOPE).walk(END - TOP)
    return Walker(route.walk(5.0, slope=-SLOPE).stand(2.0), seed=4)


def ground(x: np.ndarray) -> np.ndarray:
    """Return the height of the ground at `x`, m."""
    return SLOPE * (np.clip(x, BOTTOM, TOP) - BOTTOM - np.maximum(x - END, 0.0))


def room(walker: Walker, foot: Foot, t: np.ndarray) -> np.ndarray:
    """Return the height of the sole above the ground, m: the least of that of both arcs."""
    found = np.full(len(t), np.inf)
    for arc in (walker.wearer.shoe.heel, walker.wearer.shoe.forefoot):
        centre = walker.motions[foot].at(t, Mounting((arc.x, 0.0, arc.radius))).position
        found = np.minimum(found, centre[:, 2] - arc.radius - ground(centre[:, 0]))
    return found


@pytest.mark.parametrize("foot", list(Foot))
def test_the_feet_rise_as_the_ramp_and_the_truth_knows_it(ramp: Walker, foot: Foot) -> None:
    truth = ramp.truth()
    for stride in ramp.plan.strides[foot]:
        assert stride.end.z == pytest.approx(float(ground(np.array(stride.end.x))), abs=2e-3)
    risen = [step.displacement[2] for step in truth.strides(foot)]
    assert sum(risen) == pytest.approx(SLOPE * 5.0, abs=0.01)
    assert truth.elevation(ramp.duration)[0] == pytest.approx(SLOPE * 5.0, abs=1e-9)
    assert truth.elevation(np.linspace(0.0, ramp.duration, 500)).max() == pytest.approx(SLOPE * 10.0, abs=1e-9)


@pytest.mark.parametrize("foot", list(Foot))
def test_a_foot_lies_on_the_slope(ramp: Walker, foot: Foot) -> None:
    for stride in ramp.plan.strides[foot]:
        pitch = float(ramp.motions[foot].pitch(np.array([stride.foot_flat + 1e-3]))[0])
        assert pitch == pytest.approx(np.arctan(stride.end.grade), abs=2e-3)
    assert ramp.plan.strides[foot][-1].end.grade == -SLOPE


@pytest.mark.parametrize("foot", list(Foot))
def test_the_sole_is_on_the_ground_in_stance_and_above_it_in_swing(ramp: Walker, foot: Foot) -> None:
    for before, stride in zip(ramp.plan.strides[foot], ramp.plan.strides[foot][1:], strict=False):
        t = np.linspace(before.foot_flat, stride.toe_off, 50)
        # where the ground is bent under a foot, the foot lies on one slope only
        bent = min(abs(before.end.x - x) for x in (BOTTOM, TOP, END)) < 0.3
        assert bent or np.abs(room(ramp, foot, t)).max() < 1.5e-3
        swing = stride.heel_strike - stride.toe_off
        t = np.linspace(stride.toe_off + 0.1 * swing, stride.heel_strike - 0.1 * swing, 100)
        bent = bent or min(abs(stride.end.x - x) for x in (BOTTOM, TOP, END)) < 0.3
        assert room(ramp, foot, t).min() > (-0.03 if bent else 0.0)
        assert room(ramp, foot, t).min() < 0.05


def test_position_velocity_and_acceleration_agree_on_the_ramp(ramp: Walker) -> None:
    h = 1e-5
    for foot in Foot:
        t = np.arange(1.0, ramp.duration, 0.0137)
        one, middle, two = (ramp.kinematics(foot, t + k * h, IN_SOLE) for k in (-1, 0, 1))
        assert np.abs((two.position - one.position) / (2.0 * h) - middle.velocity).max() < 1e-3
        assert np.abs((two.velocity - one.velocity) / (2.0 * h) - middle.acceleration).max() < 0.2


def test_a_foot_slides_along_the_ramp_in_no_stance(ramp: Walker) -> None:
    t = np.arange(0.0, ramp.duration, 0.01)
    for foot in Foot:
        still = np.array([phase is Phase.STATIONARY for phase in ramp.motions[foot].phases(t)])
        assert np.linalg.norm(ramp.kinematics(foot, t).velocity[still], axis=1).max() < 0.02


def test_a_ramp_is_walking(ramp: Walker) -> None:
    truth = ramp.truth()
    assert {activity for _, _, activity in truth.activities} == {Activity.STANDING, Activity.WALKING}
    assert not truth.flights


def test_who_turns_round_on_a_ramp_walks_down_again() -> None:
    walker = Walker(Route().stand(1.0).walk(5.0, slope=SLOPE).turn(np.pi).walk(5.0, slope=-SLOPE).stand(1.0), seed=2)
    assert walker.truth().elevation(walker.duration)[0] == pytest.approx(0.0, abs=1e-9)
    assert walker.route.end.grade == -SLOPE


def test_a_ramp_is_not_too_steep_and_has_a_landing_before_stairs() -> None:
    for slope in (0.3, -0.3, float("nan")):
        with pytest.raises(ValueError, match="slope"):
            Route().walk(5.0, slope=slope)
    with pytest.raises(ValueError, match="level"):
        Route().walk(5.0, slope=SLOPE).walk(1.0).stairs(5)
    with pytest.raises(ValueError, match="level"):
        Route().stairs(5).turn(np.pi, 0.3).walk(5.0, slope=SLOPE)
    route = Route().stairs(5).walk(1.5).walk(5.0, slope=SLOPE).turn(np.pi, 0.6).stairs(5).walk(2.0)
    walker = Walker(route, seed=3)
    assert len(walker.truth().flights) == 2
    assert walker.truth().elevation(walker.duration)[0] == pytest.approx(10 * 0.16 + 5.0 * SLOPE, abs=1e-9)
