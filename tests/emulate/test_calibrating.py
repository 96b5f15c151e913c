"""Measurements by hand for a calibration agree with the emulated shoe, within the accuracy of a ruler."""

from math import cos, radians, sin
from pathlib import Path

import numpy as np
import pytest

from solepath.emulate.routes.postures import PITCHES, REPETITIONS, posture, postures, write_postures
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.shoe import IN_SOLE, Mounting, Shoe
from solepath.emulate.wearers.walker import Walker
from solepath.papers.kupt_dfpc.shoe.fit import fit_shoe
from solepath.types import Foot


@pytest.mark.parametrize("mounting", [IN_SOLE, Mounting((0.10, 0.0, 0.04))])
def test_with_the_lengths_of_a_posture_the_paper_s_equations_give_the_way_of_the_sensor(mounting: Mounting) -> None:
    """(6) of Chen et al. 2019: P_h = L_r cos - H sin, P_z = L_r sin + H cos; the toe is P_h + L_p2t ahead."""
    walker = Walker(Route().stand(1.0).walk(6.0, 1.3).stop(1.0), seed=3)
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


def test_a_flat_shoe_has_the_distances_of_its_parts() -> None:
    flat, shoe = posture(0.0), Shoe()
    assert flat.sensor_to_ground == pytest.approx(shoe.forefoot.x - 0.125)
    assert flat.ground_to_tip == pytest.approx(shoe.length - shoe.forefoot.x)


def test_five_postures_are_measured_three_times_to_the_millimetre() -> None:
    found = postures(seed=3)
    assert len(found) == len(PITCHES) * REPETITIONS == 15
    assert found == postures(seed=3) != postures(seed=4)
    for k, one in enumerate(found):
        assert one.pitch == pytest.approx(PITCHES[k // REPETITIONS], abs=radians(5))
        assert one.sensor_to_ground == pytest.approx(posture(one.pitch).sensor_to_ground, abs=0.0025)
        assert one.ground_to_tip == pytest.approx(posture(one.pitch).ground_to_tip, abs=0.0025)
        assert round(1000 * one.sensor_to_ground, 6) % 1 == 0.0


def test_the_calibration_of_a_shoe_reads_the_postures_and_finds_the_shoe(tmp_path: Path) -> None:
    write_postures(tmp_path / "postures.csv", postures(seed=3))
    fitted = fit_shoe(tmp_path / "postures.csv")
    shoe = fitted.calibration.shoe
    assert shoe is not None and fitted.postures >= 5 and fitted.measurements == 15
    assert (shoe.heel_radius, shoe.height) == (0.125, 0.029)
    for pitch in np.linspace(0.2, 0.95, 5).tolist():
        radius, to_toe = (
            sum(c * pitch**k for k, c in enumerate(curve)) for curve in (shoe.forefoot_radius, shoe.pivot_to_toe)
        )
        assert radius == pytest.approx(posture(pitch).sensor_to_ground, abs=0.0015)
        assert to_toe == pytest.approx(posture(pitch).ground_to_tip, abs=0.0015)
