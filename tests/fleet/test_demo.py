"""The demonstration of a fleet detects what it is there to detect: states and events that differ.

pip install -e '.[test,spark]', then python -m pytest -m long tests/fleet/test_demo.py
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from here import HELPERS
from sparks import lacking

needs_spark = pytest.mark.skipif(lacking() is not None, reason=lacking() or "")


@needs_spark
@pytest.mark.long
def test_a_state_that_is_changed_between_two_batches_is_detected(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from solepath.fleet.demo.run import DemoStage
    from solepath.fleet.demo.wearers import DemoPlan

    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(HELPERS / "fleet"), os.environ.get("PYTHONPATH", "")]))
    stage = DemoStage(tmp_path, DemoPlan(4, 4.0))
    stage.prepare()
    stage.run_sessions()
    assert stage.uninterrupted() == []
    differences = stage.killed(0, (str(HELPERS / "fleet" / "mutating_job.py"),))
    assert differences and all(line.startswith(("w00000, ", "and ")) for line in differences)


def test_repeated_changed_or_missing_events_are_differences() -> None:
    compare = pytest.importorskip("solepath.fleet.demo.compare", reason="pyarrow is not installed (extra spark)")
    one = {"wearer": "anna", "number": 0, "event": "HeelStrike", "t": 1.0}
    other, later = {**one, "number": 1}, {**one, "number": 1, "t": 2.0}
    assert compare.differences([one, other], [other, one]) == []
    assert compare.differences([one, other], [one, one, other]) == [
        "anna, event 0 (HeelStrike at 1.0 s) is there too often"
    ]
    assert compare.differences([one, other], [later, one]) == [
        "anna, event 1 (HeelStrike at 1.0 s) is missing",
        "anna, event 1 (HeelStrike at 2.0 s) is there, and should not be",
    ]
    assert compare.compare_sessions([], {}, [{**one, "number": 2}]) == ["anna has event 2 where event 0 is due"]
