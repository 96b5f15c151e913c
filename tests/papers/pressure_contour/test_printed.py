"""The recipe as printed beside ours: contours in kPa below 4 mm/s and nothing else, on heels whose pad gives way."""

from __future__ import annotations

from functools import cache
from math import inf

import numpy as np
import pytest
from attrs import evolve

from solepath import Session
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.walk import SampledWalk, sampled
from solepath.events import DefectFound, Limitation, StrideTaken
from solepath.foot.stance.stance import Load
from solepath.papers.pressure_contour.contour_stance import PRINTED_LIMIT, PrintedContour
from solepath.recipes import by_name
from solepath.types import SITE_OF_FOOT, Foot, Phase
from solepath.types.vector import GRAVITY
from solepath_lab.emulated.boot import heel_array
from solepath_lab.emulated.laps import square, straight
from solepath_lab.reproduce.contour.variants import TABLE
from solepath_lab.reproduce.contour.walks import ContourRun, run_foot, stance_velocities

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
    assert detector.lacking == PRINTED_LIMIT
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
def test_ours_finds_every_stride_and_the_heel_hardly_moves_where_it_is_taken_to_be_at_rest() -> None:
    ours = stance_velocities(walked("pressure-contour"), lap().truth, RIGHT)
    assert not np.isnan(ours).any() and ours.mean() < 1e-3
    assert len(walked("pressure-contour").strides) >= len(lap().truth.strides(RIGHT))


@cache
def brisk() -> SampledWalk:
    insoles = {SITE_OF_FOOT[RIGHT]: TABLE.device}
    return sampled(straight(60.0, 1.3), wearer=TABLE.wearer, insoles=insoles, seed=5)


@pytest.mark.long
def test_as_printed_missed_stances_are_a_limit_of_the_recipe_and_not_a_fault_of_the_data() -> None:
    session = Session(by_name("pressure-contour-printed"), calibration=KNOWN)
    events = session.feed(brisk().samples) + session.finish()
    strides = [one for one in events if isinstance(one, StrideTaken)]
    assert len(strides) < 0.5 * len(brisk().truth.strides(RIGHT)), "what this test is about"
    assert not [one for one in events if isinstance(one, DefectFound)]
    said = [one.what for one in events if isinstance(one, Limitation)]
    assert PRINTED_LIMIT in said and f"a stride cannot be right: {PRINTED_LIMIT}" in said
    assert all(one.degraded for one in strides if one.length > 5.6)
