"""The table of docs/accuracy.md: each number of detector, filter and cues at half and at twice its value."""

from __future__ import annotations

from pathlib import Path

import pytest
from quoted import below

from solepath.calibration import Calibration
from solepath.foot.cues import inertial
from solepath_lab.evaluate.ablation import SENSITIVITY_COLUMNS
from solepath_lab.evaluate.jobs import EvaluationJob
from solepath_lab.evaluate.run import Meta, RunSettings
from solepath_lab.evaluate.sensitivity import SensitivityJob, numbers
from solepath_lab.measures.score import Scored

NUMBERS = {number.name: number for number in numbers()}


def test_the_page_has_each_number_with_its_value_and_its_meaning() -> None:
    rows = [[cell.strip() for cell in line.split("|")[1:]] for line in below("settings")[3:]]
    assert [row[:3] for row in rows] == [[f"{n.part} `{n.name}`", f"{n.value:g}", n.meaning] for n in numbers()]
    assert {len(row) for row in rows} == {4 + len(SENSITIVITY_COLUMNS)}


def score(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """The value of the constant while a recording is scored."""
    return Scored(path.name, {"past_peak": inertial.TOE_OFF_RATE_RATIO})


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_constant_is_changed_while_a_recording_is_scored_and_then_as_before(factor: float) -> None:
    before = inertial.TOE_OFF_RATE_RATIO
    recipe, constants = NUMBERS["TOE_OFF_RATE_RATIO"].scale(factor)
    job = SensitivityJob(EvaluationJob(score, RunSettings(recipe, Calibration(), None), Path("walk"), {}), constants)
    scored = job.run()
    assert isinstance(scored, Scored) and scored.figures == {"past_peak": factor * before}
    restored = inertial.TOE_OFF_RATE_RATIO
    assert restored == before
