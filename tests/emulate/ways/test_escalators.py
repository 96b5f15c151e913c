"""Escalators: the way of the steps, what they do to the wearer's feet and load, and what the truth calls it."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import cos, pi, radians, sin

import numpy as np
import pytest
from strides import in_order

from solepath.emulate.routes.escalator import Escalator, climbed_steps, ride_escalator, ride_time
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.sensortags import CC2650
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.shoe import ON_INSTEP, Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.types import Activity, Foot, Site
from solepath.types.vector import GRAVITY

HEIGHTS = (5.0, -5.0)
HEADING = 0.7
"""Heading in which the wearer gets on, rad."""


@cache
def walker(height: float, walking: bool) -> Walker:
    """Return a walker who rides on an escalator between two short ways."""
    route = Route().stand(1.0).walk(3.0, 1.3).turn(HEADING, 2.0).walk(2.0).escalator(height, walking=walking)
    return Walker(route.walk(3.0).stand(1.5), seed=4)


@pytest.mark.parametrize("height", [2.0, 5.0, -5.0, 12.0])
def test_steps_run_at_their_speed_on_an_incline_of_30_degrees_between_level_ends(height: float) -> None:
    escalator = Escalator(height)
    ride = ride_escalator(escalator, HEADING, 10.0, 10.0 + ride_time(escalator), np.random.default_rng(1))
    assert ride.escalator.speed == pytest.approx(0.5)
    t = np.linspace(ride.start, ride.end, 4001)
    position, velocity, _ = ride.at(t)
    run = position[:, :2] @ (cos(HEADING), sin(HEADING))
    assert position[-1] == pytest.approx((escalator.run * cos(HEADING), escalator.run * sin(HEADING), height), abs=1e-9)
    speed = np.linalg.norm(velocity, axis=1)
    assert speed[500:-500] == pytest.approx(0.5, abs=0.01)  # but for the vibration
    level = (run < 0.95) | (run > escalator.run - 0.95)
    assert np.abs(velocity[level, 2]).max() < 0.01
    middle = np.abs(run - 0.5 * escalator.run) < 0.2
    slope = np.arctan2(velocity[middle, 2], velocity[middle, :2] @ (cos(HEADING), sin(HEADING)))
    assert slope == pytest.approx(radians(30.0 if height > 0.0 else -30.0), abs=radians(1.5))


def test_in_a_bend_the_ground_accelerates_by_a_quarter_of_a_metre_per_second_squared() -> None:
    ride = ride_escalator(Escalator(5.0), 0.0, 0.0, ride_time(Escalator(5.0)), np.random.default_rng(1))
    t = np.linspace(0.0, ride.end, 8001)
    smooth = np.convolve(ride.at(t)[2][:, 2], np.full(200, 1.0 / 200.0), mode="same")
    assert smooth.max() == pytest.approx(0.25, abs=0.03) and smooth.min() == pytest.approx(-0.25, abs=0.03)
    assert t[int(np.argmax(smooth))] < 5.0 < ride.end - 5.0 < t[int(np.argmin(smooth))]


@pytest.mark.parametrize("walking", [False, True])
@pytest.mark.parametrize("height", HEIGHTS)
def test_the_wearer_comes_off_at_the_other_end_of_the_escalator(height: float, walking: bool) -> None:
    one = walker(height, walking)
    end = one.route.end
    assert end.z == pytest.approx(height)
    for foot in Foot:
        ankle = one.kinematics(foot, np.array([one.duration]), Mounting((one.wearer.shoe.ankle[0], 0.0, 0.0)))
        assert ankle.position[0, :2] == pytest.approx((end.x, end.y), abs=0.12)
        assert ankle.position[0, 2] == pytest.approx(height, abs=1e-6)
        assert np.linalg.norm(ankle.velocity[0]) < 1e-9
    assert one.truth().elevation(one.duration)[0] == pytest.approx(height)


@pytest.mark.parametrize("walking", [False, True])
@pytest.mark.parametrize("height", HEIGHTS)
def test_position_velocity_and_acceleration_agree_on_an_escalator(height: float, walking: bool) -> None:
    one, h = walker(height, walking), 1e-5
    t = np.arange(0.5, one.duration, 0.0137)
    for foot in Foot:
        before, now, after = (one.kinematics(foot, t + k * h, ON_INSTEP) for k in (-1, 0, 1))
        assert np.abs((after.position - before.position) / (2.0 * h) - now.velocity).max() < 1e-3
        # the way is bent at once where a bend starts, hence the quantile
        assert np.quantile(np.abs((after.velocity - before.velocity) / (2.0 * h) - now.acceleration), 0.99) < 0.2


@pytest.mark.parametrize("height", HEIGHTS)
def test_who_stands_on_an_escalator_makes_no_stride_and_stands(height: float) -> None:
    one = walker(height, False)
    (ride,) = one.truth().escalators
    assert ride.height == height and not one.truth().rides and not one.truth().flights
    assert all(
        stride.foot_flat < ride.start or stride.heel_off > ride.end
        for foot in Foot
        for stride in one.plan.strides[foot]
    )
    assert {one.truth().activity(t) for t in np.linspace(ride.start, ride.end, 50).tolist()} == {Activity.STANDING}
    t = np.linspace(ride.start + 1.0, ride.end - 1.0, 300)
    feet = [one.kinematics(foot, t).position for foot in Foot]
    assert np.ptp(feet[0] - feet[1], axis=0).max() < 1e-4


@pytest.mark.parametrize("height", HEIGHTS)
def test_who_walks_on_an_escalator_climbs_stairs_in_less_time(height: float) -> None:
    one = walker(height, True)
    (ride,), (flight,) = one.truth().escalators, one.truth().flights
    climbing = Activity.STAIRS_UP if height > 0.0 else Activity.STAIRS_DOWN
    assert one.truth().activity(0.5 * (ride.start + ride.end)) is climbing
    assert (flight.start, flight.end) == (ride.start, ride.end)
    assert flight.height + ride.height == pytest.approx(height) and flight.height * ride.height > 0.0
    assert ride.escalator.speed == pytest.approx(0.5, abs=0.1)
    assert ride.end - ride.start < 0.6 * ride_time(Escalator(height))
    in_order(one)


@pytest.mark.parametrize("height", HEIGHTS)
def test_feet_on_moving_steps_never_slide_on_them(height: float) -> None:
    one = walker(height, True)
    (ride,) = one.truth().escalators
    for foot in Foot:
        for before, after in pairwise(one.plan.strides[foot]):
            if before.foot_flat < ride.start or after.heel_off > ride.end:
                continue
            t = np.linspace(before.foot_flat, after.heel_off, 20)
            slid = one.kinematics(foot, t).velocity - ride.at(t)[1]
            assert np.linalg.norm(slid, axis=1).max() < 0.02


def test_the_load_goes_with_the_acceleration_of_the_steps() -> None:
    one = walker(5.0, False)
    (ride,) = one.truth().escalators
    t = np.linspace(ride.start, ride.end, 500)
    total = sum(one.loads.total(foot, t) for foot in Foot)
    assert total == pytest.approx(one.loads.weight * (1.0 + ride.at(t)[2][:, 2] / GRAVITY))


def test_the_body_stays_above_the_feet() -> None:
    one = walker(5.0, True)
    t = np.linspace(0.0, one.duration, 200)
    pelvis = one.body.at(Site.PELVIS, t, Mounting((0.0, 0.0, 0.0))).position
    feet = 0.5 * sum(one.kinematics(foot, t).position for foot in Foot)
    assert np.linalg.norm(pelvis[:, :2] - feet[:, :2], axis=1).max() < 0.4
    assert (pelvis[:, 2] - feet[:, 2]).min() > 0.5 and (pelvis[:, 2] - feet[:, 2]).max() < 1.2


def test_barometers_ride_too() -> None:
    devices = {Site.LEFT_FOOT: CC2650(rate=20.0)}
    walk = emulate(walker(5.0, False).route, devices=devices, seed=4)
    assert any("barometer" in packet.channel for packet in walk.packets)
    assert walk.truth.elevation(walk.truth.duration)[0] == pytest.approx(5.0)


def test_walking_faster_leaves_fewer_metres_to_the_steps() -> None:
    slow, fast = (climbed_steps(Escalator(8.0), pace) for pace in (1.2, 2.0))
    assert 0 < slow < fast


@pytest.mark.parametrize(("height", "walking"), [(0.5, False), (float("nan"), False), (1.5, True)])
def test_an_escalator_has_a_height(height: float, walking: bool) -> None:
    with pytest.raises(ValueError, match="escalator"):
        Route().walk(2.0).escalator(height, walking=walking)


def test_who_turns_back_below_comes_up_again_where_it_started() -> None:
    route = (
        Route().stand(1.0).walk(2.0).escalator(-4.0).walk(1.0).turn(pi).walk(1.0).escalator(4.0).walk(2.0).stand(1.0)
    )
    assert (route.end.x, route.end.y, route.end.z) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
