"""The recipe as printed beside ours: contours in kPa below 4 mm/s and nothing else, on heels whose pad gives way."""

from __future__ import annotations

from functools import cache
from math import inf

import numpy as np
import pytest
from attrs import evolve
from walks import of

from solepath import Limitation, Session
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.laps import square
from solepath.emulate.sensors.insoles import heel_array, layout
from solepath.emulate.walk import SampledWalk, sampled
from solepath.emulate.wearers.walker import Walker
from solepath.foot.stance.stance import Load
from solepath.lab.reproduce.contour.figures import bias_curves, stance_curves
from solepath.lab.reproduce.contour.runs import ContourRun, run_foot, sign_test, stance_velocities
from solepath.lab.reproduce.contour.variants import PRESSURE_PRINTED_ROW, SETUPS, TABLE, VARIANTS
from solepath.lab.reproduce.contour.walks import HALF_HOUR, ContourJob, route_of, walk
from solepath.lab.reproduce.published import LOOPS
from solepath.papers.pressure_contour.contour_stance import ContourVelocity
from solepath.papers.pressure_contour.printed import PrintedContour
from solepath.papers.pressure_contour.recipe import PRESSURE_CONTOUR, PRESSURE_CONTOUR_PRINTED
from solepath.papers.pressure_contour.square import SquareDrift
from solepath.recipes import by_name
from solepath.types import SITE_OF_FOOT, Foot, Phase, Sample, Site
from solepath.types.vector import GRAVITY

RIGHT = Foot.RIGHT
KNOWN = Calibration(insoles={RIGHT: InsoleCalibration(layout=heel_array(RIGHT))})


@cache
def lap() -> SampledWalk:
    """One lap of the square in the boot of the experiment, at 100 samples a second."""
    insoles = {SITE_OF_FOOT[RIGHT]: evolve(TABLE.device, rate=100.0)}
    return sampled(square(1), wearer=TABLE.wearer, insoles=insoles, seed=5)


@cache
def walked(name: str) -> ContourRun:
    return run_foot(by_name(name), RIGHT, lap().samples, KNOWN)


def cone(x: float, tip: float = 120e3, slope: float = 4e6) -> Load:
    """Return a load of the heel array with a cone of pressure around (x, 0), tip in Pa and slope in Pa/m."""
    cells = heel_array(RIGHT).cells
    values = tuple([cell.area * max(0.0, tip - slope * float(np.hypot(cell.x - x, cell.y))) for cell in cells])
    return Load(0.8, 0.8, 0.0, False, values)


@pytest.mark.parametrize(("speed", "stands"), [(0.0, True), (0.003, True), (0.012, False)])
def test_a_heel_whose_contours_move_slower_than_4_mm_a_second_stands(speed: float, stands: bool) -> None:
    detector = PrintedContour()
    detector.set_layout(heel_array(RIGHT))
    assert detector.lacking is None
    for k in range(31):
        stance = detector.update(0.01 * k, 0.01, (0.0, 0.0, GRAVITY), (0.0, 0.0, 0.0), cone(0.045 + 0.01 * k * speed))
        assert (stance.hint is Phase.STATIONARY) is (stands and k >= 5) and (stance.sigma < inf) is (stands and k >= 5)
    assert stance.statistic == pytest.approx(speed, abs=0.002)


def test_a_heel_without_20_kilopascal_has_no_contour_and_does_not_stand_however_still() -> None:
    detector = PrintedContour()
    detector.set_layout(heel_array(RIGHT))
    for k in range(20):
        light = cone(0.045, tip=15e3, slope=2e5)
        stance = detector.update(0.01 * k, 0.01, (0.0, 0.0, GRAVITY), (0.0, 0.0, 0.0), light)
        assert stance.sigma == inf and stance.statistic == 100.0


def test_cells_of_unknown_scale_are_reported_because_they_have_no_pressure_in_pascal() -> None:
    unscaled = evolve(layout(99, RIGHT), scale=None)
    calibration = Calibration(insoles={RIGHT: InsoleCalibration(layout=unscaled)})
    session = Session(PRESSURE_CONTOUR_PRINTED, calibration=calibration)
    still = [Sample(0.01 * k, Site.RIGHT_FOOT, (0.0, 0.0, GRAVITY), (0.0, 0.0, 0.0), (1.0,) * 99) for k in range(300)]
    found = [repr(one) for one in of(Limitation, session.feed(still) + session.finish())]
    assert any("20 to 70 kPa" in text and "gyroscope" in text for text in found), found
    detector = PrintedContour()
    detector.set_layout(unscaled)
    ours = ContourVelocity()
    ours.set_layout(unscaled)
    assert detector.lacking is not None and ours.lacking is None


def test_the_heel_is_slower_at_the_zero_velocities_of_pressure_than_at_those_of_the_gyroscope() -> None:
    gyroscope, ours, printed = (
        stance_velocities(walked(name), lap().truth, RIGHT)
        for name in ("gyroscope", "pressure-contour", "pressure-contour-printed")
    )
    assert ours.found_share == gyroscope.found_share == 1.0 and printed.found_share > 0.9
    assert ours.mean < 0.5e-3 < 1.0e-3 < gyroscope.mean
    assert sign_test(ours.bias, gyroscope.bias).probability < 1e-6
    assert np.nanmedian(printed.bias) < 0.004


def test_figure_7_has_the_contours_of_20_to_70_kilopascal_beside_ours_and_both_rest_in_the_stance() -> None:
    curves = stance_curves(lap(), heel_array(RIGHT), RIGHT, 0.0)
    speeds = {curve.name: np.array(curve.points)[:, 1] for curve in curves if curve.name.startswith("speed")}
    assert list(speeds) == ["speed of the contours, ours, mm/s", "speed of the contours, 20 to 70 kPa, mm/s"]
    assert all(speed.min() < 4.0 < speed.max() for speed in speeds.values())


def test_as_printed_the_drift_of_a_swing_stays_in_the_position_and_every_slope_is_used() -> None:
    printed, ours = PRESSURE_CONTOUR_PRINTED.corrector.settings, PRESSURE_CONTOUR.corrector.settings  # type: ignore[attr-defined]
    assert (printed.remove_swing_drift, printed.gate_drift) == (False, False)
    assert (ours.remove_swing_drift, ours.gate_drift) == (True, True)
    uncertain = SquareDrift(RIGHT, (0.01, 0.0), 0.02, agreed=False, marks=40, visits=200)
    assert uncertain.kept == (0.0, 0.0) and evolve(uncertain, gated=False).kept == (0.01, 0.0)


def test_without_the_filter_no_bias_is_learnt() -> None:
    name = "Pressure as printed, no bias filter"
    assert not run_foot(VARIANTS[name], RIGHT, lap().samples[:1500], KNOWN).bias.any()
    assert walked("pressure-contour-printed").bias[-1].any()


def test_figure_9_is_the_bias_of_each_axis_in_mg_over_minutes() -> None:
    t = np.array([10.0, 40.0, 70.0])
    bias = GRAVITY * 1e-3 * np.array([[1.0, 0.0, -2.0], [2.0, 0.0, -4.0], [3.0, 5.0, -6.0]])
    x, y, z = bias_curves(ContourRun((), t, np.array([True] * 3), bias))
    assert [name.name for name in (x, y, z)] == ["bias of x", "bias of y", "bias of z"]
    assert np.array(x.points) == pytest.approx(np.array([(0.0, 1.0), (0.5, 2.0), (1.0, 3.0)]))
    assert np.array(z.points)[:, 1] == pytest.approx([-2.0, -4.0, -6.0]) and y.points[-1][1] == pytest.approx(5.0)


@pytest.mark.parametrize("number", [3, 4])
def test_as_in_figure_13_laps_and_a_halt_come_before_half_an_hour_that_ends_where_it_started(number: int) -> None:
    job = ContourJob(1, number, HALF_HOUR, 5, TABLE, ())
    laps, whole = route_of(job)
    assert laps.end.x == pytest.approx(0.0, abs=1e-6) and laps.end.y == pytest.approx(0.0, abs=1e-6)
    assert np.hypot(whole.end.x, whole.end.y) < 0.1
    assert whole.length - laps.length == pytest.approx(LOOPS[number].distance, rel=0.05)
    walked_for = Walker(whole, TABLE.wearer).duration - Walker(laps, TABLE.wearer).duration
    assert walked_for == pytest.approx(HALF_HOUR, rel=0.05)


def test_a_track_without_calibration_is_drawn_beside_the_calibrated_ones() -> None:
    job = ContourJob(1, 3, 30.0, 2, TABLE, (PRESSURE_PRINTED_ROW,), uncalibrated=True)
    result = walk(job)
    tracks = {track.name: np.array(track.points) for track in result.tracks}
    assert list(tracks) == ["true path", "pressure as printed", "pressure as printed, uncalibrated"]
    assert job.key != evolve(job, uncalibrated=False).key
    assert np.linalg.norm(tracks["pressure as printed"][-1] - tracks["pressure as printed, uncalibrated"][-1]) > 0.001


def test_every_variant_is_another_recipe_and_every_setup_another_walk() -> None:
    texts = [repr((one.detector, one.corrector)) for one in VARIANTS.values()]
    assert len(set(texts)) == len(texts) == len(VARIANTS)
    assert len({repr((one.wearer, one.device, one.speed)) for one in SETUPS}) == len(SETUPS)


def made_run(at_rest: list[bool], t: np.ndarray) -> ContourRun:
    return ContourRun((), t, np.array(at_rest), np.zeros((len(t), 3)))


def test_rest_that_is_reported_in_a_swing_counts_as_the_velocity_of_the_swing() -> None:
    truth = lap().truth
    one, two = truth.strides(RIGHT)[3:5]
    t = np.arange(0.0, two.t_heel_strike + 1.0, 0.01)
    flat = [bool(one.t_end + 0.05 < moment < two.t_heel_off - 0.05) for moment in t]
    late = [bool(0.0 <= moment - two.t_toe_off < 0.05) for moment in t]
    right, wrong = (stance_velocities(made_run(rest, t), truth, RIGHT) for rest in (flat, late))
    assert right.found_share == wrong.found_share == pytest.approx(1.0 / len(right.bias))
    assert right.mean < 0.001 and wrong.mean > 0.5


@pytest.mark.parametrize(
    ("first", "second", "smaller", "pairs", "p"),
    [([1.0] * 20, [2.0] * 20, 20, 20, 2e-5), ([1.0, 3.0] * 10, [2.0] * 20, 10, 20, 1.0), ([np.nan], [1.0], 0, 0, 1.0)],
)
def test_a_sign_test_counts_pairs_and_gives_their_probability(
    first: list[float], second: list[float], smaller: int, pairs: int, p: float
) -> None:
    found = sign_test(np.array(first), np.array(second))
    assert (found.smaller, found.pairs) == (smaller, pairs)
    assert found.probability == pytest.approx(p, rel=0.5)
