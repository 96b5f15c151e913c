"""The emulated foot obeys mechanics: its sensor signals integrate to its track, and its sole rolls without slip."""

from math import radians, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.curves import BUMP, DEGREE, LEVELLING, constant, evaluate, join, subcurve
from solepath.emulate.wearers.shoe import IN_SOLE, ON_INSTEP, Mounting
from solepath.emulate.wearers.soles.contact import RIGID
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, Phase
from solepath.types.vector import GRAVITY, from_rotation_vector, multiply, normalise, rotate

TILTED = Mounting(position=(0.16, 0.01, 0.08), attitude=from_rotation_vector((0.5, -2.2, 0.9)))


@pytest.fixture(scope="module")
def straight() -> Walker:
    return Walker(Route().stand(1.0).walk(20.0, 1.3).stop(1.0), seed=3)


@pytest.fixture(scope="module")
def winding() -> Walker:
    route = (
        Route().stand(1.0).walk(6.0, 1.2).turn(radians(90), 2.0).walk(4.0).turn(radians(-180)).walk(3.0, 0.8).stop(1.0)
    )
    return Walker(route, seed=4)


EARLY, LATE = 0.5 - sqrt(3.0) / 6.0, 0.5 + sqrt(3.0) / 6.0


def strapdown(walker: Walker, foot: Foot, mounting: Mounting, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times and positions integrated from specific force and angular rate, from the true pose at t = 0.

    The integration is of fourth order (Magnus). It has two Gauss points w1, w2 in each interval h, and the turn
    h/2 (w1 + w2) + sqrt(3)/12 h^2 w1 x w2."""
    h = 1.0 / rate
    t = np.arange(0.0, walker.duration, h)
    one, two = (walker.kinematics(foot, t[:-1] + c * h, mounting) for c in (EARLY, LATE))
    start = walker.kinematics(foot, t[:1], mounting)
    slope = (two.rate - one.rate) / (LATE - EARLY)
    partly = [h * (c * one.rate + slope * (0.5 * c * c - EARLY * c)) for c in (EARLY, LATE)]
    whole = 0.5 * h * (one.rate + two.rate) + sqrt(3.0) / 12.0 * h * h * np.cross(one.rate, two.rate)
    q = tuple(float(v) for v in start.attitude[0])
    v, p = np.zeros(3), start.position[0]
    down = np.array([0.0, 0.0, -GRAVITY])
    path = [p]
    rows = zip(
        partly[0].tolist(), partly[1].tolist(), whole.tolist(), one.force.tolist(), two.force.tolist(), strict=True
    )
    for a, b, turn, f, g in rows:
        a1 = np.array(rotate(multiply(q, from_rotation_vector(tuple(a))), tuple(f))) + down
        a2 = np.array(rotate(multiply(q, from_rotation_vector(tuple(b))), tuple(g))) + down
        p = p + h * v + 0.5 * h * h * ((1.0 - EARLY) * a1 + (1.0 - LATE) * a2)
        v = v + 0.5 * h * (a1 + a2)
        q = normalise(multiply(q, from_rotation_vector(tuple(turn))))
        path.append(p)
    return t, np.array(path)


@pytest.mark.parametrize("mounting", [IN_SOLE, ON_INSTEP, TILTED])
@pytest.mark.parametrize("foot", list(Foot))
def test_the_measured_motion_integrates_to_the_true_track(winding: Walker, foot: Foot, mounting: Mounting) -> None:
    t, found = strapdown(winding, foot, mounting, 1000.0)
    true = winding.kinematics(foot, t, mounting).position
    steps = winding.truth({foot: mounting}).strides(foot)
    for step in steps:
        ends = np.searchsorted(t, [step.t_start, step.t_end])
        moved, truly = np.diff(found[ends], axis=0)[0], np.diff(true[ends], axis=0)[0]
        assert np.linalg.norm(moved - truly) < 1e-3
    assert np.linalg.norm(found - true, axis=1).max() < 0.01


def test_velocity_and_acceleration_are_the_derivatives_of_position(winding: Walker) -> None:
    h = 1e-5
    t = np.linspace(0.5, winding.duration - 0.5, 4001)
    early, now, late = (winding.kinematics(Foot.LEFT, t + d, TILTED) for d in (-h, 0.0, h))
    speed = (late.position - early.position) / (2 * h)
    change = (late.velocity - early.velocity) / (2 * h)
    assert np.abs(speed - now.velocity).max() < 1e-3
    assert np.abs(change - now.acceleration).max() < 0.5  # the jerk jumps at joints; elsewhere it is far below
    assert np.median(np.abs(change - now.acceleration)) < 1e-4


ROUTES: dict[str, tuple[Route, float, float]] = {
    "winding": (
        Route().stand(1.0).walk(6.0, 1.2).turn(radians(90), 2.0).walk(4.0).turn(radians(-180)).stop(1.0),
        8.0,
        3.0,
    ),
    "jogging": (Route().stand(1.0).walk(5.0).jog(20.0).walk(5.0).stop(1.0), 10.0, 6.0),
    "stairs": (Route().stand(1.0).walk(3.0).stairs(10).walk(3.0).stairs(6, up=False).walk(1.0).stop(1.0), 6.0, 3.0),
    "elevators": (Route().stand(2.0).walk(3.0).lift(7.0, 1.6, 1.0, 1.2).walk(3.0).stop(2.0), 8.0, 3.0),
}
"""Route, largest speed, m/s, and largest change of acceleration in 0.1 ms, m/s^2, by name."""


@pytest.mark.parametrize("name", ROUTES)
def test_position_and_velocity_never_jump_and_the_same_seed_goes_the_same_way(name: str) -> None:
    route, max_speed, max_acceleration_change = ROUTES[name]
    walker = Walker(route, seed=6)
    t = np.arange(0.0, walker.duration, 1e-4)
    found = walker.kinematics(Foot.LEFT, t, ON_INSTEP)
    assert np.linalg.norm(np.diff(found.position, axis=0), axis=1).max() < max_speed * 1e-4
    assert np.linalg.norm(np.diff(found.velocity, axis=0), axis=1).max() < 250.0 * 1e-4
    assert np.linalg.norm(np.diff(found.acceleration, axis=0), axis=1).max() < max_acceleration_change
    same, other = (Walker(route, seed=seed).truth().strides(Foot.LEFT) for seed in (6, 7))
    assert walker.truth().strides(Foot.LEFT) == same != other


def test_the_shoe_rolls_without_slip_over_heel_and_forefoot(straight: Walker) -> None:
    """The velocity of the sensor is omega x (sensor - contact), the contact being below the arc's centre."""
    motion = straight.motions[Foot.LEFT]
    for stride in straight.plan.strides[Foot.LEFT]:
        spans = ((stride.heel_off, stride.toe_off), (stride.heel_strike + RIGID.impact_time, stride.foot_flat))
        for start, end in spans:
            t = np.linspace(start + 1e-6, end - 1e-6, 25)
            sensor = motion.at(t, IN_SOLE)
            touched = motion.contact(t)
            pitch = motion.pitch(t)
            # The same material point of the sole that touches the ground now, as if a sensor sat there.
            for k in range(len(t)):
                arc = straight.wearer.shoe.heel if start == spans[1][0] else straight.wearer.shoe.forefoot
                height = arc.radius * (1.0 - np.cos(pitch[k]))
                point = motion.at(t[k : k + 1], Mounting((float(touched[k]), 0.0, float(height))))
                assert point.position[0, 2] == pytest.approx(0.0, abs=1e-9)
                assert np.linalg.norm(point.velocity[0]) < 1e-9
                w = np.array(rotate(tuple(sensor.attitude[k]), tuple(sensor.rate[k])))
                rolled = np.cross(w, sensor.position[k] - point.position[0])
                assert np.linalg.norm(rolled - sensor.velocity[k]) < 1e-9


@pytest.mark.parametrize("foot", list(Foot))
def test_a_foot_in_stationary_is_still_and_flat(winding: Walker, foot: Foot) -> None:
    t = np.arange(0.0, winding.duration, 1e-3)
    found = winding.kinematics(foot, t, IN_SOLE)
    still = np.array([phase is Phase.STATIONARY for phase in winding.motions[foot].phases(t)])
    assert np.linalg.norm(found.velocity[still], axis=1).max() < 1e-3
    assert np.abs(np.linalg.norm(found.force[still], axis=1) - GRAVITY).max() < 0.05
    assert found.position[still][:, 2] == pytest.approx(IN_SOLE.position[2], abs=2e-4)


def test_the_sole_never_goes_into_the_ground_and_clears_it_in_swing(winding: Walker) -> None:
    shoe = winding.wearer.shoe
    t = np.arange(0.0, winding.duration, 2e-3)
    for foot in Foot:
        motion = winding.motions[foot]
        heights = [
            motion.at(t, Mounting((arc.x, 0.0, arc.radius))).position[:, 2] - arc.radius
            for arc in (shoe.heel, shoe.forefoot)
        ]
        lowest = np.min(heights, axis=0)
        assert lowest.min() > -2e-4
        for stride in winding.plan.strides[foot]:
            span = stride.heel_strike - stride.toe_off
            middle = (t > stride.toe_off + 0.35 * span) & (t < stride.toe_off + 0.65 * span)
            assert 0.008 < lowest[middle].min() < 0.08


def test_the_rates_and_forces_of_a_foot_are_those_of_walking(straight: Walker) -> None:
    """At 1.3 m/s: several hundred degrees a second at push-off and swing, peaks of 2 to 6 g, feet at 4 to 5 m/s."""
    for stride in straight.plan.strides[Foot.LEFT][3:8]:
        push = straight.kinematics(Foot.LEFT, np.linspace(stride.heel_off, stride.toe_off, 200), ON_INSTEP)
        swing = straight.kinematics(Foot.LEFT, np.linspace(stride.toe_off, stride.foot_flat, 800), ON_INSTEP)
        assert 300.0 < np.degrees(push.rate[:, 1].max()) < 600.0
        assert 300.0 < np.degrees(-swing.rate[:, 1].min()) < 550.0
        assert 2.0 < np.linalg.norm(swing.force, axis=1).max() / GRAVITY < 6.0
        assert 3.8 < np.linalg.norm(swing.velocity, axis=1).max() < 5.2
        stride_time = stride.heel_strike - straight.plan.strides[Foot.LEFT][stride.number - 2].heel_strike
        assert 0.36 < (stride.heel_strike - stride.toe_off) / stride_time < 0.42


def test_heel_strike_brings_a_short_impact(straight: Walker) -> None:
    stride = straight.plan.strides[Foot.RIGHT][4]
    t = np.linspace(stride.heel_strike, stride.heel_strike + RIGID.impact_time, 200)
    found = straight.kinematics(Foot.RIGHT, t)
    assert -found.acceleration[:, 0].min() > 2.0 * GRAVITY
    before = straight.kinematics(Foot.RIGHT, t[:1] - 1e-6).velocity[0]
    assert before[0] > 0.3 and before[2] < -0.1


values = st.floats(-10.0, 10.0)
ends = st.tuples(values, values, values)


@given(ends, ends, st.floats(0.05, 2.0))
def test_a_join_has_the_given_value_velocity_and_acceleration_at_both_ends(
    start: tuple[float, float, float], end: tuple[float, float, float], duration: float
) -> None:
    curve = join(start, end, duration)
    for s, expected in ((0.0, start), (1.0, end)):
        found = [float(evaluate(curve, s, order)) / duration**order for order in range(3)]
        assert found == pytest.approx(expected, abs=1e-6, rel=1e-6)


@given(st.lists(values, min_size=DEGREE + 1, max_size=DEGREE + 1), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_a_part_of_a_curve_is_the_curve(factors: list[float], start: float, end: float) -> None:
    curve, s = np.array(factors), np.linspace(0.0, 1.0, 7)
    assert evaluate(subcurve(curve, start, end), s) == pytest.approx(
        evaluate(curve, start + (end - start) * s), abs=1e-6
    )


@pytest.mark.parametrize("shape", [BUMP, LEVELLING])
def test_added_shapes_change_nothing_at_the_ends(shape: np.ndarray) -> None:
    for s in (0.0, 1.0):
        assert [float(evaluate(shape, s, order)) for order in range(3)] == pytest.approx([0.0] * 3, abs=1e-9)
    assert float(evaluate(BUMP, 0.5)) == pytest.approx(1.0)
    assert evaluate(constant(3.5), np.array([0.1, 0.9])).tolist() == [3.5, 3.5]
