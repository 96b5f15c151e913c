"""The table of separate clocks: recordings whose right foot is shifted, and what a session reports of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from walks import columns_of

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.events import Defect, DefectFound, HeelStrike
from solepath.recording import open_source, shift_clock
from solepath.session import Session
from solepath.types import Foot
from solepath_lab.damage.clock_walks import ClockJob, ClockWalk, error_between, read_walk
from solepath_lab.damage.clocks import ClockOutcome, find_outcome, row


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of recorded data with one emulated walk of 20 s."""
    walker = Walker(Route().stand(4.0).walk(26.0, 1.3).stop(1.0), seed=5)
    columns = {f"{key}_{foot.value}": value for foot in Foot for key, value in columns_of(walker, foot).items()}
    top = tmp_path_factory.mktemp("data")
    (top / "hugadb").mkdir()
    np.savez(top / "hugadb" / "walk.npz", **columns)
    return top


def reports(job: ClockJob, offset: float) -> list[DefectFound]:
    """Return what a session reports of the clocks of a recording whose right foot is shifted by `offset`, s."""
    events = Session().feed(shift_clock(open_source(job.path), offset))
    return [event for event in events if isinstance(event, DefectFound) and event.defect is Defect.CLOCKS]


def test_shifted_events_show_what_shifted_samples_show(folder: Path) -> None:
    job = ClockJob("hugadb", "walk", folder / "hugadb" / "walk.npz")
    walk = read_walk(job)
    assert isinstance(walk, ClockWalk)
    outcome = find_outcome(walk, 0.2)
    (defect,) = reports(job, 0.2)
    assert outcome.reported == defect.offset == pytest.approx(-0.2, abs=0.02)
    assert outcome.walked is not None and 6.0 < outcome.walked < outcome.walking < 22.0


def test_times_between_the_feet_err_by_what_remains_of_an_offset_except_for_whole_cycles(folder: Path) -> None:
    walk = read_walk(ClockJob("hugadb", "walk", folder / "hugadb" / "walk.npz"))
    assert isinstance(walk, ClockWalk)
    assert error_between(walk, 0.0) == 0.0
    assert error_between(walk, 0.03) == pytest.approx(0.03, abs=0.005)
    contacts = [event.t for event in walk.events if isinstance(event, HeelStrike) and event.foot is Foot.LEFT]
    cycle = (contacts[-1] - contacts[2]) / (len(contacts) - 3)
    assert error_between(walk, cycle) == pytest.approx(0.0, abs=0.01), "which is why they look right"


def test_a_report_after_the_limit_does_not_count() -> None:
    outcomes = [
        ClockOutcome(90.0, 20.0, -0.11, 0.1, 0.012), ClockOutcome(90.0, 70.0, -0.1, 0.1, 0.0),
        ClockOutcome(30.0, None, None, 0.1, None),
    ]  # fmt: skip
    cells = ["all", "100 ms", "1 of 3", "1", "20 s", "10 / 10 ms", "12 / 12 ms"]
    assert row("all", "100 ms", outcomes, 60.0) == cells
