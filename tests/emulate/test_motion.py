"""Every way of going obeys mechanics: one motion, soles that neither slip nor sink, and a truth that knows it.

The emulator is the truth of all other tests; its own truth is mechanics, so its inner motion and plan are read here."""

from __future__ import annotations

from functools import cache
from math import pi, radians

import numpy as np
import pytest
from attrs import evolve, frozen
from strides import in_order

from solepath.emulate import Route
from solepath.emulate.routes.escalator import Escalator, ride_time
from solepath.emulate.routes.styles import StrideKind
from solepath.emulate.wearers.contact import RIGID
from solepath.emulate.wearers.curves import Array
from solepath.emulate.wearers.gait import PlannedStride, Wearer
from solepath.emulate.wearers.shoe import IN_SOLE, ON_INSTEP, Mounting, Shoe
from solepath.emulate.wearers.turning import from_rotation_vectors, matrices, multiply_quaternions
from solepath.emulate.wearers.walker import Walker
from solepath.types import Activity, Foot, Phase
from solepath.types.vector import GRAVITY, from_rotation_vector
from solepath_lab.emulated.soles import WORN
from solepath_lab.emulated.unsteady import Swaying
from solepath_lab.emulated.wearers import SUBJECTS

START = Route().stand(1.0).walk(3.0)
TILTED = Mounting(position=(0.16, 0.01, 0.08), attitude=from_rotation_vector((0.5, -2.2, 0.9)))
WALK, STAND, RUN = Activity.WALKING, Activity.STANDING, Activity.RUNNING
UP, DOWN = Activity.STAIRS_UP, Activity.STAIRS_DOWN
LIFT_UP, LIFT_DOWN = Activity.ELEVATOR_UP, Activity.ELEVATOR_DOWN
SLOPE = 1.0 / 12.0


@frozen
class Way:
    """A way of going, and what the truth must say of it."""

    route: Route
    activities: tuple[Activity, ...] = (STAND, WALK, STAND)
    rise: float = 0.0
    """Height of the end over the start, m."""
    wearer: Wearer = Wearer()
    flat: bool = True
    """Flag: the ground is level and does not move."""


WAYS = {
    "winding": Way(START.turn(radians(90), 2.0).walk(2.0).turn(pi).walk(3.0, 0.8).stop(1.0)),
    "worn soles": Way(START.walk(3.0).stop(1.0), wearer=Wearer(shoe=Shoe(contact=evolve(WORN, pivot_shift=0.02)))),
    "swaying": Way(START.stop(3.0), wearer=Wearer(sway=Swaying(radians(0.1)), swerve=(2.0, 2.0))),
    "backwards": Way(START.walk(4.0, direction=pi).walk(2.0).stop(1.0)),
    "to the left": Way(START.walk(4.0, direction=0.5 * pi).walk(2.0).stop(1.0), wearer=SUBJECTS[2]),
    "to the right": Way(START.walk(4.0, direction=-0.5 * pi).walk(2.0).stop(1.0)),
    "jogging": Way(START.jog(20.0).walk(3.0).stop(1.0), (STAND, WALK, RUN, WALK, STAND)),
    "in a crowd": Way(
        Route().stand(1.0).walk(8.0, 1.2, stops=((3.0, 0.5), (5.5, 2.0))).shuffle(1.5).stand(1.0),
        (STAND, WALK, STAND, WALK, STAND, WALK, STAND),
    ),
    "ramps": Way(START.walk(8.0, slope=SLOPE).walk(3.0).walk(4.0, slope=-SLOPE).stop(1.0), rise=SLOPE * 4, flat=False),
    "stairs": Way(
        START.stairs(10).walk(1.0).turn(pi, 0.7).stairs(8, up=False).walk(2.0).stop(1.0),
        (STAND, WALK, UP, WALK, DOWN, WALK, STAND),
        0.32,
        SUBJECTS[3],
        False,
    ),
    "lift": Way(
        START.lift(7.0, 1.6, 1.0, 1.2).walk(2.0).lift(-3.5).walk(2.0).stop(1.0),
        (STAND, WALK, STAND, LIFT_UP, STAND, WALK, STAND, LIFT_DOWN, STAND, WALK, STAND),
        3.5,
        flat=False,
    ),
    "standing on an escalator": Way(
        START.turn(0.7, 2.0).escalator(3.0).walk(3.0).stop(1.0), (STAND, WALK, STAND, WALK, STAND), 3.0, flat=False
    ),
    "walking down an escalator": Way(
        START.escalator(-4.0, walking=True).walk(3.0).stop(1.0), (STAND, WALK, DOWN, WALK, STAND), -4.0, flat=False
    ),
}
ALL = pytest.mark.parametrize("name", WAYS)
ROLLING = ("jogging", "swaying")
"""Ways of which the last instant of a stance already rolls, within the arc of the sole."""
MOVING = ("lift", "standing on an escalator", "walking down an escalator")


@cache
def walker(name: str) -> Walker:
    return Walker(WAYS[name].route, WAYS[name].wearer, seed=4)


def times(one: Walker, step: float = 2e-3) -> Array:
    return np.arange(0.0, one.duration, step)


def lowest(one: Walker, foot: Foot, t: Array) -> Array:
    """Return the height of the lower end of the sole, m, that of the heel's or the forefoot's arc."""
    centres = [
        one.motions[foot].at(t, Mounting((arc.x, 0.0, arc.radius))).position[:, 2] - arc.radius
        for arc in (one.wearer.shoe.heel, one.wearer.shoe.forefoot)
    ]
    return np.asarray(np.min(centres, axis=0))


@ALL
def test_a_way_ends_with_both_feet_at_the_end_of_its_route_and_its_truth_says_how_it_was_gone(name: str) -> None:
    one, way = walker(name), WAYS[name]
    in_order(one)
    truth, end = one.truth(), one.route.end
    found = [what for _, _, what in truth.activities]
    assert tuple(what for what, before in zip(found, [None, *found], strict=False) if what != before) == way.activities
    assert end.z == pytest.approx(way.rise)
    assert truth.elevation(one.duration)[0] == pytest.approx(way.rise, abs=1e-9)
    for foot in Foot:
        ankle = one.kinematics(foot, np.array([one.duration]), Mounting((one.wearer.shoe.ankle[0], 0.0, 0.0)))
        assert ankle.position[0] == pytest.approx((end.x, end.y, end.z), abs=0.14)
        climbed = sum(step.displacement[2] for step in truth.strides(foot))
        assert name in MOVING or climbed == pytest.approx(way.rise, abs=0.01)


@ALL
@pytest.mark.parametrize("foot", Foot)
def test_positions_velocities_rates_and_forces_are_those_of_one_motion_without_a_jump(name: str, foot: Foot) -> None:
    one, h = walker(name), 1e-5
    t = np.arange(0.5, one.duration - 0.5, 0.0137)
    early, now, late = (one.kinematics(foot, t + d, TILTED) for d in (-h, 0.0, h))
    assert np.abs((late.position - early.position) / (2 * h) - now.velocity).max() < 1e-5
    change = np.abs((late.velocity - early.velocity) / (2 * h) - now.acceleration)
    assert change.max() < 5e-3 and np.median(change) < 1e-6  # the jerk jumps at joints
    predicted = multiply_quaternions(early.attitude, from_rotation_vectors(2 * h * now.rate))
    assert np.abs(np.sum(predicted * late.attitude, axis=1)) == pytest.approx(1.0, abs=1e-9)
    turned = multiply_quaternions(early.attitude * (1.0, -1.0, -1.0, -1.0), late.attitude)
    turned = turned * np.sign(turned[:, :1])
    assert np.median(np.abs(turned[:, 1:] / h - now.rate)) < 1e-3
    world = np.einsum("nij,nj->ni", matrices(now.attitude), now.force)
    assert world - now.acceleration == pytest.approx(np.tile((0.0, 0.0, GRAVITY), (len(t), 1)), abs=1e-6)
    found = one.kinematics(foot, times(one), ON_INSTEP)
    assert np.linalg.norm(np.diff(found.velocity, axis=0), axis=1).max() < (0.25 if name == "jogging" else 0.15)


@ALL
def test_the_soles_bear_the_body_and_what_accelerates_it(name: str) -> None:
    one = walker(name)
    t = times(one, 0.01)
    loads = [one.loads.total(foot, t) for foot in Foot]
    assert min(load.min() for load in loads) > -1e-6
    assert sum(loads) == pytest.approx(one.loads.body(t), abs=1e-6)
    assert np.mean(sum(loads)) == pytest.approx(one.loads.weight, rel=0.03)
    truth = one.truth()
    for ride in [*one.plan.rides, *(truth.escalators if name.startswith("standing") else ())]:
        t = np.linspace(ride.start, ride.end, 300)
        carried = one.loads.weight * (1.0 + ride.at(t)[2][:, 2] / GRAVITY)
        assert sum(one.loads.total(foot, t) for foot in Foot) == pytest.approx(carried)
        assert np.ptp(carried) > 0.04 * one.loads.weight


@ALL
def test_a_foot_in_stationary_neither_slides_nor_turns_on_what_it_stands_on(name: str) -> None:
    one = walker(name)
    t = times(one)
    for foot in Foot:
        still = t[[phase is Phase.STATIONARY for phase in one.motions[foot].phases(t)]]
        found = one.kinematics(foot, still)
        carried = np.zeros((len(still), 3))
        truth = one.truth()
        for ride in (*one.plan.rides, *truth.escalators):
            inside = (still >= ride.start) & (still <= ride.end)
            carried[inside] = ride.at(still[inside])[1]
        assert len(still) > 500
        slides, turns = (4e-3, 0.04) if name in ROLLING else (1e-3, 6e-3)
        assert np.linalg.norm(found.velocity - carried, axis=1).max() < slides
        assert np.abs(found.rate).max() < turns


@pytest.mark.parametrize("name", [name for name, way in WAYS.items() if way.flat])
def test_a_sole_never_sinks_into_the_floor_and_clears_it_in_swing(name: str) -> None:
    one = walker(name)
    t = times(one)
    for foot in Foot:
        height = lowest(one, foot, t)
        assert height.min() > -4e-4
        for stride in one.plan.strides[foot]:
            swing = stride.heel_strike - stride.toe_off
            middle = (t > stride.toe_off + 0.4 * swing) & (t < stride.toe_off + 0.6 * swing)
            assert 0.004 < height[middle].min() < 0.2


@pytest.mark.parametrize("foot", Foot)
def test_a_foot_on_stairs_skips_every_other_tread_clears_the_edges_and_stands_on_its_tread(foot: Foot) -> None:
    """A step is 0.3 m wide and 0.16 m high: each foot goes 0.60 m and 0.32 m (Sensors 2016, 16, 1809)."""
    one = walker("stairs")
    shoe, motion = one.wearer.shoe, one.motions[foot]
    strides = [stride for stride in one.plan.strides[foot] if stride.flight is not None]
    inside = [stride for stride in strides if abs(stride.end.z - stride.start.z) > 0.2]
    assert len(inside) >= 7
    for stride in inside:
        assert abs(stride.end.z - stride.start.z) == pytest.approx(0.32)
        assert np.hypot(stride.end.x - stride.start.x, stride.end.y - stride.start.y) == pytest.approx(0.60, abs=0.09)
    for stride in strides:
        assert stride.flight is not None
        t = np.linspace(stride.heel_off + 1e-6, stride.foot_flat - 1e-6, 200)
        for share in np.linspace(0.0, 1.0, 5):  # the sole is the hull of its arcs
            radius = shoe.heel.radius + (shoe.forefoot.radius - shoe.heel.radius) * share
            at = Mounting((shoe.heel.x + (shoe.forefoot.x - shoe.heel.x) * share, 0.0, radius))
            x, y, z = motion.at(t, at).position.T
            assert (z - stride.flight.clear_height(x, y, np.full(len(t), radius))).min() > -2e-3
        stood = one.kinematics(foot, np.array([stride.foot_flat + 0.01]), IN_SOLE).position[0, 2] - IN_SOLE.position[2]
        tread = stride.flight.clear_height(np.array([stride.end.x]), np.array([stride.end.y]), np.zeros(1))[0]
        assert stood == pytest.approx(float(tread), abs=2e-4)


def test_a_foot_lies_on_the_slope_of_its_ramp() -> None:
    one = walker("ramps")
    grades = []
    for stride in one.plan.strides[Foot.LEFT]:
        pitch = float(one.motions[Foot.LEFT].pitch(np.array([stride.foot_flat + 1e-3]))[0])
        assert pitch == pytest.approx(np.arctan(stride.end.grade), abs=2e-3)
        grades.append(round(stride.end.grade, 6))
    assert list(dict.fromkeys(grades)) == [0.0, round(SLOPE, 6), round(-SLOPE, 6)]


def test_the_shoe_rolls_without_slip_over_heel_and_forefoot() -> None:
    """The point of the sole that touches the ground stands still."""
    one = walker("winding")
    motion, shoe = one.motions[Foot.LEFT], one.wearer.shoe
    for stride in one.plan.strides[Foot.LEFT][1:5]:
        spans = ((stride.heel_off, stride.toe_off), (stride.heel_strike + RIGID.impact_time, stride.foot_flat))
        for arc, (start, end) in zip((shoe.forefoot, shoe.heel), spans, strict=True):
            for t in np.linspace(start + 1e-6, end - 1e-6, 5)[:, None]:
                pitch = float(motion.pitch(t)[0])
                touched = (arc.x - arc.radius * np.sin(pitch), 0.0, arc.radius * (1.0 - np.cos(pitch)))
                point = motion.at(t, Mounting(touched))
                assert point.position[0, 2] == pytest.approx(0.0, abs=1e-9)
                assert np.linalg.norm(point.velocity[0]) < 1e-9


def fastest(one: Walker, kind: StrideKind) -> list[tuple[PlannedStride, float, float, float]]:
    """Return strides of the left foot with their top speed, m/s, hardest force, g, and fastest turn, degrees/s."""
    found = []
    for stride in [s for s in one.plan.strides[Foot.LEFT] if s.kind is kind][2:-2]:
        moved = one.kinematics(Foot.LEFT, np.linspace(stride.heel_off, stride.foot_flat, 600), ON_INSTEP)
        speed, force = (np.linalg.norm(vectors, axis=1).max() for vectors in (moved.velocity, moved.force))
        found.append((stride, float(speed), float(force / GRAVITY), float(np.degrees(moved.rate[:, 1].max()))))
    return found


def test_the_speeds_forces_and_rates_of_a_foot_are_those_of_walking_and_of_running() -> None:
    """At 1.3 m/s: feet at 4 to 5 m/s, 2 to 6 g, hundreds of degrees a second at push-off; a runner's are larger."""
    walks = fastest(Walker(Route().stand(1.0).walk(12.0, 1.3).stop(1.0), seed=3), StrideKind.WALK)
    runs = fastest(walker("jogging"), StrideKind.RUN)
    assert len(walks) >= 3 and len(runs) >= 3
    for _, speed, force, turn in walks:
        assert 3.8 < speed < 5.2 and 2.0 < force < 6.0 and 300.0 < turn < 600.0
    for stride, speed, force, _ in runs:
        assert 5.0 < speed < 8.0 and 7.0 < force < 16.0
        assert 1.4 < np.hypot(stride.end.x - stride.start.x, stride.end.y - stride.start.y) < 2.3


def test_both_feet_of_a_jogger_fly_between_the_steps_and_each_bears_twice_the_weight() -> None:
    one = walker("jogging")
    steps = sorted((s.heel_strike, s, foot) for foot in Foot for s in one.plan.strides[foot] if s.speed > 2.59)
    for (strike, _, foot), (_, after, other) in zip(steps[1:-2], steps[2:-1], strict=True):
        assert foot is not other and 0.03 < strike - after.toe_off < 0.16
        flown, stood = np.linspace(after.toe_off + 1e-3, strike - 1e-3, 20), np.linspace(strike, strike + 0.25, 100)
        assert max(abs(one.loads.total(side, flown)).max() for side in Foot) < 1e-6
        assert 1.7 < one.loads.total(foot, stood).max() / one.loads.weight < 2.9


def test_strides_backwards_land_with_the_toes_down_and_aside_one_foot_leads_and_never_crosses() -> None:
    back = walker("backwards")
    for stride in [one for one in back.plan.strides[Foot.LEFT] if one.kind is StrideKind.BACK][1:-1]:
        assert stride.end.x - stride.start.x == pytest.approx(-0.57, abs=0.05)
        pitch = back.motions[Foot.LEFT].pitch(np.linspace(stride.heel_off, stride.foot_flat, 200))
        assert -0.35 < pitch.min() < -0.15 and pitch.max() < 0.1
    for name, leader in (("to the left", Foot.LEFT), ("to the right", Foot.RIGHT)):
        one = walker(name)
        steps = sorted(
            (s.heel_strike, foot) for foot in Foot for s in one.plan.strides[foot] if s.kind is StrideKind.SIDE
        )
        assert {foot for _, foot in steps[::2]} == {leader} and len(steps) > 10
        left, right = (one.kinematics(foot, times(one)).position[:, 1] for foot in Foot)
        assert (left - right).min() > 0.08


def test_an_escalator_runs_at_half_a_metre_a_second_and_who_walks_on_it_is_sooner_up() -> None:
    (ride,) = walker("standing on an escalator").truth().escalators
    moved, velocity, _ = ride.at(np.linspace(ride.start, ride.end, 4001))
    assert moved[-1] == pytest.approx((ride.escalator.run * np.cos(0.7), ride.escalator.run * np.sin(0.7), 3.0))
    assert np.linalg.norm(velocity, axis=1)[500:-500] == pytest.approx(0.5, abs=0.01)
    middle = velocity[1900:2100]
    assert np.degrees(np.arctan2(middle[:, 2], np.hypot(middle[:, 0], middle[:, 1]))) == pytest.approx(30.0, abs=1.5)
    truth = walker("walking down an escalator").truth()
    (ride,), (flight,) = truth.escalators, truth.flights
    assert flight.height + ride.height == pytest.approx(-4.0) and flight.height < 0.0 > ride.height
    assert (flight.start, flight.end) == (ride.start, ride.end)
    assert ride.end - ride.start < 0.6 * ride_time(Escalator(-4.0))


def test_a_lift_keeps_its_limits_and_stops_at_its_floor() -> None:
    first, second = walker("lift").plan.rides
    for ride, height, speed, acceleration in ((first, 7.0, 1.6, 1.0), (second, -3.5, 1.0, 0.8)):
        t = np.linspace(ride.start - 0.5, ride.end + 0.5, 2000)
        position, velocity, accelerated = (one[:, 2] for one in ride.at(t))
        assert (position[0], position[-1]) == (0.0, height) and ride.height == height
        assert np.abs(velocity).max() < speed + 0.02 and np.abs(accelerated).max() < acceleration + 0.2
        heaviest, lightest = np.argmax(accelerated), np.argmin(accelerated)
        assert bool(heaviest < lightest) is (height > 0.0)
