"""A fleet on bytewax in a process that is killed, or whose disk is full: its files hold each event once."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from here import HELPERS

pytest.importorskip("bytewax", reason="bytewax is not installed: it has no wheels for Python 3.13 and later")

from pyarrow import parquet
from sites import site

from solepath.fleet import NumberedEvent, event_row, sent_line

JOB = [sys.executable, str(HELPERS / "fleet" / "fleet_job.py")]
ENVIRONMENT = {**os.environ, "RUST_BACKTRACE": "0"}


@pytest.fixture
def sent(tmp_path: Path) -> Path:
    """Files of some hours."""
    lines = [sent_line(one) for _, one in site()[0]]
    (tmp_path / "sent").mkdir()
    for hour in range(4):
        part = lines[hour * len(lines) // 4 : (hour + 1) * len(lines) // 4]
        (tmp_path / "sent" / f"hour-{hour}.jsonl").write_bytes(b"".join(part))
    return tmp_path / "sent"


@cache
def expected() -> list[dict[str, Any]]:
    """Rows of a session fed by hand for every wearer."""
    each = sorted(site()[1].items())
    return [event_row(NumberedEvent(wearer, n, event)) for wearer, events in each for n, event in enumerate(events)]


def held(directory: Path) -> list[dict[str, Any]]:
    """Return the events that a reader finds."""
    table = parquet.read_table(directory)
    return list(table.sort_by([("wearer", "ascending"), ("number", "ascending")]).to_pylist())


@pytest.mark.soak
def test_killed_and_started_again_a_job_leaves_each_event_once(sent: Path, tmp_path: Path) -> None:
    lines = len(site()[0])
    job = [*JOB, sent, tmp_path / "events", tmp_path / "store"]
    assert subprocess.run([*job, "--die-at", str(lines * 5 // 9)], env=ENVIRONMENT).returncode == -9
    assert subprocess.run(job, env=ENVIRONMENT).returncode == 0
    assert held(tmp_path / "events") == expected()
