"""Noise of the cells, equation (1), and the wearer's own shoe."""

from __future__ import annotations

from collections.abc import Sequence
from math import radians, sqrt, tan
from pathlib import Path

import numpy as np
import pytest
from attrs import evolve

from solepath.calibration import Calibration, CalibrationError, InsoleCalibration, Newtons, ShoeGeometry
from solepath.papers.kupt_dfpc.kinematics import forefoot_position
from solepath.papers.kupt_dfpc.noise import pressure_noise
from solepath.papers.kupt_dfpc.recipe import KUPT_DFPC, KUPT_DFPC_PRINTED, ZUPT
from solepath.papers.kupt_dfpc.shoe.fit import fit_shoe
from solepath.types import Cell, Foot, Layout, Sample, Site


def samples_of(rows: Sequence[tuple[float, ...]], site: Site = Site.LEFT_FOOT) -> list[Sample]:
    return [Sample(t=0.05 * k, site=site, pressure=row) for k, row in enumerate(rows)]


def test_noise_is_the_mean_of_the_least_loaded_samples_and_three_deviations() -> None:
    # 20 of 100 samples are in the air, half of them (1, 4), half (3, 4): means 2 and 4, deviations 1 and 0
    rows = [(1.0, 4.0), (3.0, 4.0)] * 10 + [(80.0, 90.0)] * 80
    noise = pressure_noise(samples_of(rows), share=0.20).insoles[Foot.LEFT].noise
    assert noise == pytest.approx((2.0 + 3.0, 4.0 + 0.0))


def test_only_the_requested_share_counts() -> None:
    # the 30 lowest totals: 20 in the air, and 10 with 10 on the first cell
    rows = [(1.0, 4.0), (3.0, 4.0)] * 10 + [(10.0, 4.0)] * 10 + [(80.0, 90.0)] * 70
    mean = (10 * 1.0 + 10 * 3.0 + 10 * 10.0) / 30
    deviation = sqrt((10 * (1 - mean) ** 2 + 10 * (3 - mean) ** 2 + 10 * (10 - mean) ** 2) / 30)
    noise = pressure_noise(samples_of(rows), share=0.30).insoles[Foot.LEFT].noise
    assert noise == pytest.approx((mean + 3.0 * deviation, 4.0))


def test_without_a_share_the_least_loaded_15_of_100_samples_count_as_in_the_paper() -> None:
    # 30 of 200: 29 with 1 on the first cell and one with 3; the 31st has 5
    rows = [(1.0, 4.0)] * 29 + [(3.0, 4.0)] + [(5.0, 4.0)] * 170
    noise = pressure_noise(samples_of(rows)).insoles[Foot.LEFT].noise
    assert noise == pytest.approx((32.0 / 30.0 + 3.0 * 2.0 * sqrt(29.0) / 30.0, 4.0))


def test_the_insoles_two_areas_meet_at_the_board_12_5_of_28_5_cm_from_the_heel() -> None:
    """Fig. 3: the circuit board, where the sensor is, divides the cells."""
    cells = tuple(Cell(0.01 * k, 0.0) for k in (2, 12, 13, 25))
    for recipe in (KUPT_DFPC, KUPT_DFPC_PRINTED, ZUPT):
        insole = evolve(recipe.insole)
        insole.set_layout(Layout(4, Foot.LEFT, cells, 0.285))
        assert (insole.heel_cells, insole.forefoot_cells) == ((0, 1), (2, 3))


def test_noise_is_in_newtons_where_the_calibration_makes_newtons() -> None:
    known = Calibration(insoles={Foot.LEFT: InsoleCalibration(newtons=Newtons((0.0, 2.0, 0.0, 0.0), threshold=1.0))})
    rows = [(1.0, 4.0)] * 20 + [(40.0, 45.0)] * 80
    assert pressure_noise(samples_of(rows), 0.20, known).insoles[Foot.LEFT].noise == pytest.approx((2.0, 8.0))


def test_each_foot_has_its_own_noise_and_nothing_else_is_calibrated() -> None:
    rows = [(1.0, 4.0)] * 40 + [(80.0, 90.0)] * 110
    found = pressure_noise([*samples_of(rows), *samples_of([(2.0 * a, b) for a, b in rows], Site.RIGHT_FOOT)])
    assert {foot: insole.noise for foot, insole in found.insoles.items()} == {
        Foot.LEFT: pytest.approx((1.0, 4.0)),
        Foot.RIGHT: pytest.approx((2.0, 4.0)),
    }
    assert found.shoe is None and found.insoles[Foot.LEFT].layout is None


@pytest.mark.parametrize(
    ("rows", "complaint"),
    [
        ([], "no pressure cells"),
        ([(1.0, 2.0)] * 30, "too short a walk"),
        ([(1.0, 2.0)] * 150 + [(1.0, 2.0, 3.0)], "2 cells and then 3"),
    ],
)
def test_a_walk_that_shows_no_noise_is_rejected(rows: list[tuple[float, ...]], complaint: str) -> None:
    with pytest.raises(CalibrationError, match=complaint):
        pressure_noise(samples_of(rows))


HEADER = "pitch_deg,L_r_m,L_p2t_m\n"


def write_postures(path: Path, noise: float = 0.0) -> Path:
    """Five postures of the round sole, three times each, by rulers that are off by `noise` m."""
    rng = np.random.default_rng(7)
    lines = [HEADER]
    for degrees in (0, 15, 30, 45, 60):
        p = radians(degrees)
        for _ in range(3):
            radius = 0.070 + 0.050 * tan(p / 2) + noise * rng.standard_normal()
            to_toe = 0.090 - 0.050 * p + 0.050 * tan(p / 2) + noise * rng.standard_normal()
            lines.append(f"{degrees},{radius:.4f},{to_toe:.4f}\n")
    path.write_text("".join(lines))
    return path


def test_postures_of_a_shoe_give_its_curves(tmp_path: Path) -> None:
    fitted = fit_shoe(write_postures(tmp_path / "postures.csv"))
    shoe = fitted.calibration.shoe
    assert shoe is not None and fitted.calibration == Calibration(shoe=shoe)
    for p in (0.0, 0.3, 0.7, 1.0):
        assert forefoot_position(shoe, p) == pytest.approx(forefoot_position(ShoeGeometry(), p), abs=5e-4)
    assert shoe.steepest == pytest.approx(radians(60))
    assert (fitted.postures, fitted.measurements) == (5, 15)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "line 1: needs one column pitch_deg"),
        (HEADER, "holds no postures"),
        ("pitch_deg,L_r_m\n1,2\n", "line 1: needs one column L_p2t_m"),
        (HEADER + "0,0.07,0.09\n15,long,0.08\n", "line 3: L_r_m is 'long', not a number"),
        (HEADER + "0,0.07\n", "line 2: 2 values, and the header has 3"),
        (HEADER + "0,7.0,9.0\n", "line 2: L_r_m is 7.0, which is not between 0 and 0.5 m"),
        (HEADER + "0,nan,0.09\n", "line 2: L_r_m is 'nan', not a finite number"),
        (HEADER + "95,0.07,0.09\n", "line 2: pitch_deg is 95, which is not between -5 and 80 degrees"),
        (HEADER + "0,0.07,0.09\n0.5,0.07,0.09\n60,0.1,0.06\n", "2 postures; three different ones"),
        (HEADER + "0,0.07,0.09\n10,0.07,0.09\n20,0.1,0.06\n", "the steepest posture is 20 degrees"),
    ],
)
def test_a_bad_table_of_postures_is_rejected_in_one_line(tmp_path: Path, text: str, complaint: str) -> None:
    file = tmp_path / "postures.csv"
    file.write_text(text)
    with pytest.raises(ValueError, match=complaint) as caught:
        fit_shoe(file)
    assert str(caught.value).startswith(str(file)) and "\n" not in str(caught.value)
