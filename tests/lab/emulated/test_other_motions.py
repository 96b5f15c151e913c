"""Motions that are not walking obey physics: what sensors on such feet measure, before any session sees it."""

from __future__ import annotations

import numpy as np
import pytest

from solepath.emulate.wearers.shoe import IN_SOLE
from solepath.emulate.wearers.turning import matrices
from solepath.types import Foot
from solepath.types.vector import GRAVITY
from solepath_lab.emulated.courses import Course, Vibration, Way
from solepath_lab.emulated.on_the_spot import JUMPS, jumping
from solepath_lab.emulated.on_wheels import quarter_car, road
from solepath_lab.emulated.other_motions import MOTIONS, OtherMotion, Posed, samples_of

NAMES = [motion.name for motion in MOTIONS]


def posed(motion: OtherMotion, duration: float = 40.0) -> Posed:
    return Posed(motion.make(np.random.default_rng(7), duration), duration, 7)


@pytest.mark.parametrize("motion", MOTIONS, ids=NAMES)
def test_specific_force_and_rate_are_those_of_the_pose(motion: OtherMotion) -> None:
    one, t = posed(motion), np.arange(12.0, 18.0, 0.0005)
    for foot in Foot:
        found = one.kinematics(foot, t, IN_SOLE)
        turn = matrices(found.attitude)
        felt = np.einsum("nij,nj->ni", turn, found.force) - (0.0, 0.0, GRAVITY)
        # integrated twice, what is felt leads from the first place to the last one
        speed = found.velocity[0] + np.cumsum(0.00025 * (felt[:-1] + felt[1:]), axis=0)
        went = found.position[1] + np.sum(0.00025 * (speed[:-1] + speed[1:]), axis=0)
        assert np.abs(went - found.position[-1]).max() < 0.02
        assert np.linalg.norm(found.rate, axis=1).max() < 15.0


def test_a_jumper_feels_no_weight_in_flight_and_takes_off_31_times() -> None:
    t = np.arange(0.0, 50.0, 0.002)
    found = Posed(jumping(np.random.default_rng(3), 50.0), 50.0, 3).kinematics(Foot.LEFT, t)
    heights = found.position[:, 2] > 0.06
    assert np.sum(~heights[:-1] & heights[1:]) >= JUMPS
    assert np.linalg.norm(found.force[t < 7.0], axis=1) == pytest.approx(GRAVITY, abs=1e-6)


def test_a_way_ends_where_its_speed_leads() -> None:
    speed = Course.through((0.0, 0.0), (2.0, 3.0), (8.0, 3.0), (10.0, 0.0))
    way = Way.along(speed, Course.through((0.0, 0.5 * np.pi), (1.0, 0.5 * np.pi)), 12.0)
    assert way.place(np.array([12.0]))[0] == pytest.approx([0.0, 24.0, 0.0], abs=1e-6)


def test_a_vibration_has_the_power_of_its_spectrum_and_a_car_swings_at_one_to_two_hertz() -> None:
    t = np.arange(0.0, 400.0, 0.01)
    spectrum = road(64e-6, quarter_car)
    found = Vibration.drawn(spectrum, 0.5, 20.0, np.random.default_rng(1)).at(t)
    f = np.geomspace(0.5, 20.0, 20_000)
    assert np.var(found) == pytest.approx(np.trapezoid(spectrum(f), f), rel=0.15)
    assert 1.0 < f[np.argmax(quarter_car(f))] < 2.0


def test_each_seed_is_another_wearer_and_the_same_seed_the_same_one() -> None:
    motion = OtherMotion(NAMES[6], MOTIONS[6].make, 30.0)
    first, again, other = (samples_of(motion, seed, 50.0) for seed in (4, 4, 5))
    assert first == again != other
    assert len(first) == 2 * (30 * 50 + 1)
