"""The table of docs/settings.md: each number of detector, filter and cues at half and at twice its value."""

from __future__ import annotations

from pathlib import Path

import pytest
from quoted import below

from solepath.calibration import Calibration
from solepath.foot.cues import inertial
from solepath.lab.evaluate.jobs import EvaluationJob
from solepath.lab.evaluate.run import Meta, RunSettings
from solepath.lab.evaluate.sensitivity import TABLE_COLUMNS, SensitivityJob, numbers, table
from solepath.lab.measures.score import Scored

NUMBERS = {number.name: number for number in numbers()}


def test_the_page_has_each_number_with_its_value_and_its_meaning() -> None:
    rows = [[cell.strip() for cell in line.split("|")[1:]] for line in below("settings")[3:]]
    assert [row[:3] for row in rows] == [[f"{n.part} `{n.name}`", f"{n.value:g}", n.meaning] for n in numbers()]
    assert {len(row) for row in rows} == {4 + len(TABLE_COLUMNS)}


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


def test_a_line_has_the_change_at_half_and_at_twice_the_value() -> None:
    number = NUMBERS["TOE_OFF_RATE_RATIO"]
    columns = [column for column in TABLE_COLUMNS if column.title in ("strides", "HS F1", "ipol HS")]
    default, half, double = [0.02, 0.98, 0.010], [0.021, 0.95, 0.0104], [0.02, 0.98, -0.020]
    lines = list(table(iter([(None, 1.0, default), (number, 0.5, half), (number, 2.0, double)]), columns))
    assert [cell.strip() for cell in lines[2].split("|")][4:-1] == ["2 %", "0.98", "10 ms"]
    assert [cell.strip() for cell in lines[3].split("|")][4:-1] == ["+5 % / 0", "-0.03 / 0", "0 / -30 ms"]
