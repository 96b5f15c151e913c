"""The table of separate clocks: recordings whose right foot is shifted, and what a session reports of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from walks import columns_of

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.events import DefectFound
from solepath.lab.damage.clocks import ClockJob, ClockOutcome, ClockWalk, find_outcome, read_walk, row, table
from solepath.recording import open_source, shift_clock
from solepath.session import Session
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


def test_shifted_events_show_what_shifted_samples_show(folder: Path) -> None:
    job = ClockJob("hugadb", "walk", folder / "hugadb" / "walk.npz")
    walk = read_walk(job)
    assert isinstance(walk, ClockWalk)
    outcome = find_outcome(walk, 0.2)
    session = Session()
    (defect,) = [
        event for event in session.feed(shift_clock(open_source(job.path), 0.2)) if isinstance(event, DefectFound)
    ]  # fmt: skip
    assert outcome.reported == defect.offset == pytest.approx(-0.2, abs=0.02)
    assert outcome.walked is not None and 6.0 < outcome.walked < outcome.walking < 22.0


def test_a_walk_is_repeated_to_its_duration_and_a_fast_clock_found_in_it(folder: Path) -> None:
    walk = read_walk(ClockJob("hugadb", "walk", folder / "hugadb" / "walk.npz"))
    assert isinstance(walk, ClockWalk)
    outcome = find_outcome(walk, rate=200e-6, duration=600.0)
    assert outcome.walking > 400.0 and outcome.reported is not None and outcome.reported < 0.0
    assert find_outcome(walk, duration=600.0).reported is None


def test_a_recording_of_one_foot_cannot_be_used(tmp_path: Path) -> None:
    columns = columns_of(Walker(Route().stand(2.0)), Foot.LEFT)
    np.savez(tmp_path / "one.npz", **columns)
    assert read_walk(ClockJob("hugadb", "one", tmp_path / "one.npz")) == "one foot"


def test_a_report_after_the_limit_does_not_count() -> None:
    outcomes = [
        ClockOutcome(90.0, 20.0, -0.11, 0.1), ClockOutcome(90.0, 70.0, -0.1, 0.1), ClockOutcome(30.0, None, None, 0.1)
    ]  # fmt: skip
    assert row("hugadb", "100 ms", outcomes, 60.0) == "| hugadb | 100 ms | 1 of 3 | 1 | 20 s | 10 / 10 ms |"


def test_the_table_has_each_damage_and_names_every_alarm(folder: Path) -> None:
    lines = list(table(folder, ["hugadb"], 1))
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if line.startswith("| hugadb")]
    assert [row[2] for row in rows] == ["0 of 1", *["2 of 2"] * 5]
    assert "\nReported although undamaged: none." in lines
