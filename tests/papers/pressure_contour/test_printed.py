"""The recipe as printed beside ours: contours in kPa below 4 mm/s and nothing else, on heels whose pad gives way."""

from __future__ import annotations

from functools import cache
from math import inf

import numpy as np
import pytest
from attrs import evolve

from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.walk import SampledWalk, sampled
from solepath.foot.stance.stance import Load
from solepath.papers.pressure_contour.printed import PrintedContour
from solepath.recipes import by_name
from solepath.types import SITE_OF_FOOT, Foot, Phase
from solepath.types.vector import GRAVITY
from solepath_lab.emulated.boot import heel_array
from solepath_lab.emulated.laps import square
from solepath_lab.reproduce.contour.runs import ContourRun, found_share, run_foot, sign_test, stance_velocities
from solepath_lab.reproduce.contour.variants import TABLE

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


@pytest.mark.long
def test_the_heel_is_slower_at_the_zero_velocities_of_pressure_than_at_those_of_the_gyroscope() -> None:
    gyroscope, ours, printed = (
        stance_velocities(walked(name), lap().truth, RIGHT)
        for name in ("gyroscope", "pressure-contour", "pressure-contour-printed")
    )
    assert found_share(ours) == found_share(gyroscope) == 1.0 and found_share(printed) > 0.9
    assert ours.mean() < 0.5e-3 < 1.0e-3 < gyroscope.mean()
    assert sign_test(ours, gyroscope).probability < 1e-6
    assert np.nanmedian(printed) < 0.004
