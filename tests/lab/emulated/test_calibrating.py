"""Measurements by hand for a calibration agree with the emulated shoe, and the motion of a hand is one motion."""

from math import cos, radians, sin
from pathlib import Path

import numpy as np
import pytest

from solepath.emulate import Route
from solepath.emulate.routes.postures import PITCHES
from solepath.emulate.wearers.shoe import Mounting, Shoe
from solepath.emulate.wearers.turning import from_rotation_vectors, matrices, multiply_quaternions
from solepath.emulate.wearers.walker import Walker
from solepath.papers.kupt_dfpc.shoe.fit import fit_shoe
from solepath.types import Foot
from solepath.types.vector import GRAVITY
from solepath_lab.emulated.handling import Handling
from solepath_lab.emulated.postures import REPETITIONS, posture, postures, write_postures


def test_with_the_lengths_of_a_posture_the_paper_s_equations_give_the_way_of_the_sensor() -> None:
    """(6) of Chen et al. 2019: P_h = L_r cos - H sin, P_z = L_r sin + H cos; the toe is P_h + L_p2t ahead."""
    walker, mounting = Walker(Route().stand(1.0).walk(6.0, 1.3).stop(1.0), seed=3), Mounting((0.10, 0.0, 0.04))
    shoe, height = walker.wearer.shoe, mounting.position[2]
    stride = walker.plan.strides[Foot.LEFT][2]
    t = np.linspace(stride.heel_off + 1e-6, stride.toe_off - 1e-6, 30)
    true = walker.kinematics(Foot.LEFT, t, mounting).position
    yaw = np.array([cos(stride.start.heading), sin(stride.start.heading)])
    ahead = (true[:, :2] - (stride.start.x, stride.start.y)) @ yaw + shoe.ankle[0]
    for k, pitch in enumerate((-walker.motions[Foot.LEFT].pitch(t)).tolist()):
        at = posture(pitch, shoe, mounting)
        back = at.sensor_to_ground * cos(pitch) - height * sin(pitch) + at.ground_to_tip
        assert shoe.length - back == pytest.approx(ahead[k], abs=1e-9)
        assert at.sensor_to_ground * sin(pitch) + height * cos(pitch) == pytest.approx(true[k, 2], abs=1e-9)
    flat = posture(0.0)
    assert flat.sensor_to_ground == pytest.approx(Shoe().forefoot.x - 0.125)
    assert flat.ground_to_tip == pytest.approx(Shoe().length - Shoe().forefoot.x)


def test_five_postures_are_measured_three_times_to_the_millimetre_and_give_the_shoe(tmp_path: Path) -> None:
    found = postures(seed=3)
    assert len(found) == len(PITCHES) * REPETITIONS == 15 and found == postures(seed=3) != postures(seed=4)
    for k, one in enumerate(found):
        assert one.pitch == pytest.approx(PITCHES[k // REPETITIONS], abs=radians(5))
        assert one.sensor_to_ground == pytest.approx(posture(one.pitch).sensor_to_ground, abs=0.0025)
        assert round(1000 * one.sensor_to_ground, 6) % 1 == 0.0
    write_postures(tmp_path / "postures.csv", found)
    shoe = fit_shoe(tmp_path / "postures.csv").calibration.shoe
    assert shoe is not None and (shoe.heel_radius, shoe.height) == (0.125, 0.029)
    for pitch in np.linspace(0.2, 0.95, 5).tolist():
        radius, to_toe = (
            sum(c * pitch**k for k, c in enumerate(curve)) for curve in (shoe.forefoot_radius, shoe.pivot_to_toe)
        )
        assert radius == pytest.approx(posture(pitch).sensor_to_ground, abs=0.0015)
        assert to_toe == pytest.approx(posture(pitch).ground_to_tip, abs=0.0015)


def test_rates_and_forces_of_a_hand_are_those_of_its_motion() -> None:
    t = np.arange(0.0, 10.0, 0.0025)
    true = Handling(5).kinematics(Foot.LEFT, t)
    turns = from_rotation_vectors(0.5 * (true.rate[1:] + true.rate[:-1]) * 0.0025)
    turned = multiply_quaternions(true.attitude[:-1], turns)
    assert np.abs(np.sum(turned * true.attitude[1:], axis=1)) == pytest.approx(1.0, abs=1e-8)
    slope = np.gradient(true.velocity, t, axis=0)
    assert np.abs(slope - true.acceleration)[1:-1].max() < 0.5  # of up to 9 m/s^2, by the tremor of 12 Hz
    world = np.einsum("nij,nj->ni", matrices(true.attitude), true.force)
    assert np.allclose(world - true.acceleration, (0.0, 0.0, GRAVITY))
