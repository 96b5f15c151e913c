"""The table of separate clocks: recordings whose right foot is shifted, and what a session reports of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from walks import columns_of

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.lab.evaluate.clocks import ClockJob, ClockOutcome, Row, run_job, table
from solepath.types import Foot


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of recorded data with one emulated walk of 20 s."""
    walker = Walker(Route().stand(1.5).walk(26.0, 1.3).stop(1.0), seed=5)
    columns = {f"{key}_{foot.value}": value for foot in Foot for key, value in columns_of(walker, foot).items()}
    top = tmp_path_factory.mktemp("data")
    (top / "hugadb").mkdir()
    np.savez(top / "hugadb" / "walk.npz", **columns)
    return top


def test_the_clock_of_the_right_foot_is_late_by_the_offset_of_the_job(folder: Path) -> None:
    outcome = run_job(ClockJob("hugadb", "walk", folder / "hugadb" / "walk.npz", offset=0.2))
    assert isinstance(outcome, ClockOutcome)
    assert outcome.offset == pytest.approx(-0.2, abs=0.02)
    assert outcome.walked is not None and 8.0 < outcome.walked < outcome.walking < 22.0


def test_a_recording_of_one_foot_cannot_be_used(tmp_path: Path) -> None:
    columns = columns_of(Walker(Route().stand(2.0)), Foot.LEFT)
    np.savez(tmp_path / "one.npz", **columns)
    assert run_job(ClockJob("hugadb", "one", tmp_path / "one.npz")) == "one foot"


def test_a_report_after_the_limit_does_not_count() -> None:
    job = ClockJob("hugadb", "walk", None, offset=0.1)
    runs = [
        (job, ClockOutcome(90.0, 20.0, -0.11)),
        (job, ClockOutcome(90.0, 70.0, -0.1)),
        (job, ClockOutcome(30.0, None, None)),
    ]
    assert Row("hugadb", "100 ms", runs, 60.0).line() == "| hugadb | 100 ms | 1 of 3 | 1 | 20 s | 10 / 10 ms |"


def test_the_table_has_each_damage_and_lists_every_alarm(folder: Path) -> None:
    lines = list(table(folder, ["hugadb"], 1))
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("| hugadb")]
    assert [row[2] for row in rows] == ["0 of 1", *["2 of 2"] * 5]
    assert "- none" in lines
