"""Numbers of detector, filter and cues at half and at twice their values, of which docs/accuracy.md has some rows."""

from __future__ import annotations

from pathlib import Path

import pytest
from quoted import below

from solepath.calibration import Calibration
from solepath.foot.cues import inertial
from solepath_lab.evaluate.jobs import EvaluationJob
from solepath_lab.evaluate.run import Meta, RunSettings
from solepath_lab.evaluate.sensitivity import SensitivityJob, numbers
from solepath_lab.measures.score import Scored

NUMBERS = {number.name: number for number in numbers()}


def test_the_rows_of_the_page_are_numbers_with_their_values_and_their_meanings() -> None:
    rows = {tuple(cell.strip() for cell in line.split("|")[1:4]) for line in below("settings")[3:]}
    assert len(rows) == 5 and rows < {(f"{n.part} `{n.name}`", f"{n.value:g}", n.meaning) for n in numbers()}


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
