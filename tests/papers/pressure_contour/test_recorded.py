"""The recipes of Bebek et al. on recorded insoles that wobble in their shoes: no truth, but a stride is a stride."""

from __future__ import annotations

from pathlib import Path

import pytest
from walks import of, run_session

from solepath import StrideTaken
from solepath.calibration import Calibration
from solepath.papers.pressure_contour.recipe import GYROSCOPE, PRESSURE_CONTOUR
from solepath.recipes import DEFAULT, Recipe
from solepath.recording.samples import load_samples
from solepath_lab.evaluate.insoles import smart_insole

LONGEST_STRIDE = 2.0
"""Length, m, that no stride of these walks has, but two strides taken for one would have."""


def strides_of(recipe: Recipe, file: Path, calibration: Calibration) -> list[StrideTaken]:
    return of(StrideTaken, run_session(load_samples(file), recipe, calibration=calibration))


@pytest.mark.long
@pytest.mark.parametrize("name", ["shape_C1", "both_20241113_105919"])
@pytest.mark.parametrize("recipe", [GYROSCOPE, PRESSURE_CONTOUR], ids=["gyroscope", "contours"])
@pytest.mark.parametrize("with_layout", [True], ids=["cells known"])
def test_hardly_a_stride_is_lost_in_feet_that_never_quite_rest(
    data_dir: Path, recipe: Recipe, name: str, with_layout: bool
) -> None:
    file = data_dir / "smart_insole_35" / f"{name}.npz"
    known = smart_insole(file) if with_layout else Calibration()
    usual, found = strides_of(DEFAULT, file, known), strides_of(recipe, file, known)
    # the default also finds the stride with which a recording starts, before contours are learnt
    assert abs(len(found) - len(usual)) <= max(1, len(usual) // 10)
    assert max(one.length for one in found) < LONGEST_STRIDE
