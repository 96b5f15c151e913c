"""A fleet on bytewax in a process that is killed, or whose disk is full: its files hold each event once."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path
from random import Random
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


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.soak), pytest.param(3, marks=pytest.mark.soak)])
def test_killed_at_any_moments_and_started_again_a_job_leaves_each_event_once(
    seed: int, sent: Path, tmp_path: Path
) -> None:
    lines = len(site()[0])
    first, second = sorted(Random(seed).sample(range(lines), 2))
    job = [*JOB, sent, tmp_path / "events", tmp_path / "store"]
    for line in (first, second - first):
        assert subprocess.run([*job, "--die-at", str(line)], env=ENVIRONMENT).returncode == -9
    assert subprocess.run(job, env=ENVIRONMENT).returncode == 0
    assert held(tmp_path / "events") == expected()


FULL_DISK_SCRIPT = """
mount -t tmpfs -o size=16m none disk || exit 77
head -c $((16 * 1024 * 1024 - ROOM)) /dev/zero > disk/ballast
"$@" 2> said; echo $? > ended
cp -r "$EVENTS" events_then
rm disk/ballast
"$@" || exit 1
cp -r "$EVENTS" events_in_the_end
"""
"""A script in a separate mount name space: a small disk that is nearly full, the job, and the job after making room."""


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """Return a directory where a small disk can be mounted."""
    (tmp_path / "disk").mkdir()
    mount = ["unshare", "-rm", "mount", "-t", "tmpfs", "none", str(tmp_path / "disk")]
    if shutil.which("unshare") is None or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("a disk can be mounted neither by this user nor in a name space of their own")
    return tmp_path


def until_full(place: Path, sent: Path, parts_directory: str, store: str, room: int) -> str:
    """Return the message of the job that ends because the disk is full."""
    environment = {**ENVIRONMENT, "EVENTS": parts_directory, "ROOM": str(room)}
    apart = ["unshare", "-rm", "sh", "-c", FULL_DISK_SCRIPT, "sh", *JOB, sent, parts_directory, store]
    subprocess.run(apart, env=environment, cwd=place, check=True)
    assert (place / "ended").read_text() == "1\n"
    return (place / "said").read_text()


def test_a_full_disk_ends_the_job_with_the_name_of_the_file_and_with_room_it_goes_on_as_if_nothing_had_been(
    place: Path, sent: Path
) -> None:
    message = until_full(place, sent, "disk/events", "store", room=60_000)
    part = r"part-[01]-\d+-\d{8}\.parquet"
    assert re.fullmatch(f"error: .*No space left on device: 'disk/events/{part}'", message.splitlines()[-1])
    assert all(re.fullmatch(part, path.name) for path in (place / "events_then").iterdir())
    then = held(place / "events_then")
    assert then and all(row in expected() for row in then)
    assert held(place / "events_in_the_end") == expected()


def test_a_full_disk_of_the_recovery_store_ends_the_job_too_and_with_room_it_goes_on(place: Path, sent: Path) -> None:
    message = until_full(place, sent, "events", "disk/store", room=400_000)
    assert "database or disk is full" in message.splitlines()[-1]
    assert held(place / "events_in_the_end") == expected()
