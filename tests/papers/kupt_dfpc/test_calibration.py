"""Noise of the cells, equation (1), and the wearer's own shoe."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, degrees, pi, radians, sin, sqrt
from pathlib import Path

import pytest

from solepath import Session
from solepath.calibration import Calibration, CalibrationError, InsoleCalibration, Newtons, ShoeGeometry
from solepath.calibration.records import merged
from solepath.events import FootPressed
from solepath.foot.pressure.insole import InsoleLoads
from solepath.papers.kupt_dfpc.noise import pressure_noise
from solepath.papers.kupt_dfpc.recipe import KUPT_DFPC, KUPT_DFPC_PRINTED, ZUPT
from solepath.papers.kupt_dfpc.shoe.fit import MeasuredPosture, fit_shoe, write_measurements
from solepath.papers.kupt_dfpc.shoe.gauge import PitchGauge
from solepath.types import Cell, Foot, Layout, Sample, Site, Vec3
from solepath.types.checking import find_fault
from solepath.types.vector import GRAVITY, from_rotation_vector, rotate


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
        insole = InsoleLoads(recipe.insole)
        insole.set_layout(Layout(4, Foot.LEFT, cells, 0.285))
        assert (insole.heel_cells, insole.forefoot_cells) == ((0, 1), (2, 3))


NEWTONS = InsoleCalibration(newtons=Newtons((0.0, 2.0, 0.0, 0.0), threshold=1.0))


def test_noise_and_newtons_make_the_same_forces_whichever_was_calibrated_first() -> None:
    rows = [(1.0, 4.0)] * 20 + [(40.0, 45.0)] * 80
    noise, newtons = pressure_noise(samples_of(rows), 0.20), Calibration(insoles={Foot.LEFT: NEWTONS})
    both = merged(noise, newtons)
    assert both == merged(newtons, noise)
    session = Session(calibration=both, pressures=True)
    pressed = [event for sample in samples_of(rows) for event in session.feed(sample) if isinstance(event, FootPressed)]
    assert pressed[0].values == (0.0, 0.0) and pressed[-1].values == (78.0, 82.0)


def test_noise_may_be_below_zero_as_that_of_cells_that_were_set_to_zero_under_the_wearer() -> None:
    noise = pressure_noise(samples_of([(-50.0, -20.0)] * 40 + [(10.0, 20.0)] * 110))
    assert find_fault(noise, Calibration) is None


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
        ([(1.0, 2.0)] * 129, "129 samples of the left insole, 19 of them in swing; 20 are needed"),
        ([(1.0, 2.0)] * 150 + [(1.0, 2.0, 3.0)], "2 cells and then 3"),
    ],
)
def test_a_walk_that_shows_no_noise_is_rejected(rows: list[tuple[float, ...]], complaint: str) -> None:
    with pytest.raises(CalibrationError, match=complaint):
        pressure_noise(samples_of(rows))


def test_of_samples_with_the_same_total_the_earlier_ones_count_and_twenty_are_enough() -> None:
    noise = pressure_noise(samples_of([(1.0, 4.0)] * 20 + [(4.0, 1.0)] * 110)).insoles[Foot.LEFT].noise
    assert noise == pytest.approx((1.0, 4.0))
    assert pressure_noise(samples_of([(1.0, 4.0)] * 20), share=1.0).insoles[Foot.LEFT].noise == (1.0, 4.0)
    for share in (0.0, 1.1):
        with pytest.raises(ValueError, match="share is"):
            pressure_noise([], share)


HEADER = "pitch_deg,L_r_m,L_p2t_m,H_imu_m,heel_L_r_m\n"
RADIUS, TO_TOE = (0.07, 0.02, 0.01), (0.09, -0.03, 0.005)
"""Coefficients of the lengths over the pitch, m per power of rad."""


def write_postures(path: Path, pitches: Sequence[float], ends: str = "0.031,0.12") -> Path:
    """Write a shoe of RADIUS and TO_TOE; the lengths are off by a millimetre and two from one posture to the next, as
    -1, 5, -10, 10, -5, 1 are, which no polynomial of a degree below five follows over six equal steps."""
    lines = []
    for k, pitch in enumerate(pitches):
        p, off = radians(pitch), (-1e-4, 5e-4, -1e-3, 1e-3, -5e-4, 1e-4)[k] if len(pitches) == 6 else 0.0
        radius, to_toe = (a + b * p + c * p * p for a, b, c in (RADIUS, TO_TOE))
        lines.append(f"{pitch},{radius + off},{to_toe + 2.0 * off},{ends}\n")
    path.write_text(HEADER + "".join(lines))
    return path


def test_postures_of_a_shoe_give_its_curves_and_how_far_the_rulers_were_off(tmp_path: Path) -> None:
    fitted = fit_shoe(write_postures(tmp_path / "postures.csv", (0.0, 12.0, 24.0, 36.0, 48.0, 60.0)))
    shoe = fitted.calibration.shoe
    assert shoe is not None and fitted.calibration == Calibration(shoe=shoe)
    assert shoe.forefoot_radius == pytest.approx(RADIUS) and shoe.pivot_to_toe == pytest.approx(TO_TOE)
    assert (shoe.heel_radius, shoe.height, shoe.steepest) == (0.12, 0.031, pytest.approx(radians(60.0)))
    assert (fitted.postures, fitted.measurements) == (6, 6)
    assert fitted.residual_radius == pytest.approx(1e-4 * sqrt(42.0))
    assert fitted.residual_to_toe == pytest.approx(2e-4 * sqrt(42.0)) and fitted.worst == pytest.approx(2e-3)


def test_three_postures_give_straight_lines_and_two_degrees_make_no_other_posture(tmp_path: Path) -> None:
    file = tmp_path / "postures.csv"
    file.write_text("L_p2t_m,pitch_deg,L_r_m\n0.09,0,0.07\n0.08,20,0.08\n0.07,40,0.09\n0.07,42,0.09\n")
    fitted = fit_shoe(file)
    shoe, usual = fitted.calibration.shoe, ShoeGeometry()
    assert shoe is not None and len(shoe.forefoot_radius) == len(shoe.pivot_to_toe) == 2
    assert (fitted.postures, fitted.measurements) == (3, 4)
    assert (shoe.heel_radius, shoe.height) == (usual.heel_radius, usual.height)


def test_measurements_that_are_written_are_read_again(tmp_path: Path) -> None:
    file = tmp_path / "postures.csv"
    made = [MeasuredPosture(radians(pitch), 0.07 + 0.001 * pitch, 0.09 - 0.0005 * pitch) for pitch in (0, 15, 30)]
    write_measurements(file, made, {"heel_L_r_m": 0.118})
    assert file.read_text() == (
        "pitch_deg,L_r_m,L_p2t_m,heel_L_r_m\n0.00,0.0700,0.0900,0.1180\n15.00,0.0850,0.0825,0.1180\n"
        "30.00,0.1000,0.0750,0.1180\n"
    )
    shoe = fit_shoe(file).calibration.shoe
    assert shoe is not None and shoe.heel_radius == 0.118
    assert shoe.forefoot_radius == pytest.approx((0.07, 0.18 / pi)), "0.03 m over 30 degrees"


@pytest.mark.parametrize(
    ("lines", "complaint"),
    [
        ("", "holds no postures"),
        ("0,0.07,0.09,0,0\n15,long,0.08,0,0\n", "line 3: L_r_m is 'long', not a number"),
        ("0,0.51,0.09,0,0\n", "line 2: L_r_m is 0.51, which is not between 0 and 0.5 m"),
        ("80.1,0.07,0.09,0,0\n", "line 2: pitch_deg is 80.1, which is not between -5 and 80 degrees"),
        ("0,0.07,0.09,0,0.6\n", "line 2: heel_L_r_m is 0.6, which is not between 0 and 0.5 m"),
        ("0,0.07,0.09,0.03,0\n9,0.07,0.09,0.04,0\n", "line 3: H_imu_m is 0.04 here and 0.03 before"),
        ("0,0.07,0.09,0,0\n1.9,0.07,0.09,0,0\n60,0.1,0.06,0,0\n", "2 postures; three different ones"),
        ("0,0.07,0.09,0,0\n10,0.07,0.09,0,0\n29.9,0.1,0.06,0,0\n", "the steepest posture is 29.9 degrees"),
    ],
)
def test_a_bad_table_of_postures_is_rejected_in_one_line(tmp_path: Path, lines: str, complaint: str) -> None:
    file = tmp_path / "postures.csv"
    file.write_text(HEADER + lines)
    with pytest.raises(ValueError, match=complaint) as caught:
        fit_shoe(file)
    assert str(caught.value).startswith(str(file)) and "\n" not in str(caught.value)


# --- the pitch of a shoe that is held in a posture --------------------------------------------------------------------

MOUNTED = from_rotation_vector((0.4, -1.1, 2.0))
"""Any mounting: foot to sensor."""


def tilted(pitch: float, lean: float = 0.0, size: float = GRAVITY) -> Vec3:
    """Return the specific force of a shoe with its heel up by `pitch`, whose sole leans by `lean` degrees to a side."""
    p, s = radians(pitch), radians(lean)
    return rotate(MOUNTED, (size * sin(p) * cos(s), size * sin(s), size * cos(p) * cos(s)))


def hold(gauge: PitchGauge, start: float, force: Vec3, seconds: float = 1.2, other: Vec3 | None = None) -> None:
    """Hold a posture, at 50 Hz; every other sample is `other`."""
    for k in range(round(seconds / 0.02)):
        gauge.add_sample(start + 0.02 * k, force if other is None or k % 2 else other)


def taken(*postures: tuple[float, float]) -> tuple[PitchGauge, list[float | None]]:
    """Return the gauge after these postures, pitch and lean in degrees, and the pitches that it took, in degrees."""
    gauge, found = PitchGauge(), list[float | None]()
    for k, posture in enumerate(postures):
        hold(gauge, 2.0 * k, tilted(*posture))
        pitch = gauge.take()
        found.append(None if pitch is None else degrees(pitch))
    return gauge, found


def test_each_posture_is_taken_with_its_pitch_and_a_lean_sideways_is_none() -> None:
    # 5 degrees, of which nobody knows yet which way they go, count as a tilt; then 50 show the way of the heel
    gauge, found = taken((0.0, 0.0), (5.0, 0.0), (50.0, 0.0), (30.0, 8.0), (-3.0, 0.0), (60.0, -4.0))
    assert found == pytest.approx([0.0, 5.0, 50.0, 30.0, -3.0, 60.0], abs=0.2)
    for lean in (8.0, -8.0):
        hold(gauge, 20.0 + lean, tilted(20.0, lean))
        reading = gauge.read()
        assert reading is not None and reading.is_still
        # the way of the heel is that of the last and steepest posture, which leant by -4
        assert degrees(reading.sideways) == pytest.approx(lean + 20.0 / 60.0 * 4.0, abs=1.5)


def test_before_the_way_of_the_heel_is_known_every_tilt_is_a_pitch() -> None:
    gauge, found = taken((0.0, 0.0), (5.0, 0.0), (-4.0, 0.0), (0.0, 3.0))
    assert found == pytest.approx([0.0, 5.0, 4.0, 3.0])
    reading = gauge.read()
    assert reading is not None and degrees(reading.pitch) == pytest.approx(3.0) and reading.sideways == 0.0
    fresh = PitchGauge()
    hold(fresh, 0.0, tilted(25.0))
    reading = fresh.read()
    assert reading is not None and reading.pitch == 0.0, "it has not stood flat yet"


def test_the_steepest_posture_shows_the_way_of_the_heel() -> None:
    _, found = taken((0.0, 0.0), (0.0, 6.0), (40.0, 0.0), (0.0, 20.0))
    # 6 degrees to the side were the way at first; then 40 to the front are, and 20 to the side are no pitch
    assert found == pytest.approx([0.0, 6.0, 40.0, 0.0], abs=1e-6)
    _, found = taken((0.0, 0.0), (40.0, 0.0), (0.0, 20.0), (30.0, 0.0))
    assert found == pytest.approx([0.0, 40.0, 0.0, 30.0], abs=1e-6)


def test_the_pitch_that_is_shown_is_the_mean_over_a_quarter_of_a_second() -> None:
    gauge, _ = taken((0.0, 0.0), (50.0, 0.0))
    for k, count in enumerate((6, 12, 13)):
        hold(gauge, 10.0 * k + 10.0, tilted(20.0))
        hold(gauge, 10.0 * k + 11.2, tilted(10.0), 0.02 * count)
        reading = gauge.read()
        assert reading is not None and not reading.is_still
        # of the last 13 samples (0.24 s) so many are at 10 degrees, and the others at 20
        assert degrees(reading.pitch) == pytest.approx(20.0 - 10.0 * count / 13.0, abs=0.05)


@pytest.mark.parametrize(
    ("force", "other", "seconds", "still"),
    [
        (tilted(0.0), None, 1.02, True),
        (tilted(0.0), None, 1.0, False),  # from the first to the last sample 0.98 s
        (tilted(0.0, size=GRAVITY + 0.95), None, 1.2, True),
        (tilted(0.0, size=GRAVITY + 1.05), None, 1.2, False),
        (tilted(0.0, size=GRAVITY - 1.05), None, 1.2, False),
        (tilted(0.0, size=GRAVITY + 0.14), tilted(0.0, size=GRAVITY - 0.14), 1.2, True),
        (tilted(0.0, size=GRAVITY + 0.16), tilted(0.0, size=GRAVITY - 0.16), 1.2, False),
    ],
)
def test_a_posture_is_taken_once_the_shoe_was_still_for_a_second(
    force: Vec3, other: Vec3 | None, seconds: float, still: bool
) -> None:
    gauge = PitchGauge()
    hold(gauge, 5.0, force, seconds, other)
    reading = gauge.read()
    assert reading is not None and reading.is_still is still
    assert (gauge.take() == 0.0) is still and (gauge.flat is not None) is still


def test_what_was_before_the_second_a_restart_or_a_clock_set_back_does_not_count() -> None:
    for start in (-3.0, 0.5):
        gauge = PitchGauge()
        hold(gauge, start, tilted(30.0), 1.0)
        if start > 0.0:
            gauge.restart()
        hold(gauge, 0.0, tilted(0.0), 1.04)
        assert gauge.take() == 0.0
    gauge = PitchGauge()
    hold(gauge, 10.0, tilted(0.0), 0.98)
    hold(gauge, 9.0, tilted(0.0), 0.98)
    assert gauge.take() is None
    sparse = PitchGauge()
    for t in (0.0, 0.4, 0.6, 0.8, 1.0):
        sparse.add_sample(t, tilted(0.0))
        assert sparse.take() is None  # six samples, the first a second before the last, are the fewest
    sparse.add_sample(1.2, tilted(0.0))
    assert sparse.take() == 0.0


def test_a_sensor_that_measures_nothing_shows_no_pitch() -> None:
    gauge = PitchGauge()
    assert gauge.read() is None and gauge.take() is None
    hold(gauge, 0.0, (0.0, 0.0, 0.0))
    assert gauge.read() is None and gauge.take() is None
