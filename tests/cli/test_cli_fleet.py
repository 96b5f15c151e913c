"""Tests fleet-demo: wearers through an engine that is killed, what it prints, and how it ends."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from pathlib import Path
from time import sleep

import pytest
from commands import run, run_failing

pytest.importorskip("bytewax", reason="bytewax is not installed: it has no wheels for Python 3.13 and later")


from solepath.events import HeelStrike
from solepath.fleet import NumberedEvent
from solepath.fleet.demo.compare import differences, find_number_gaps, read_events
from solepath.fleet.parquet import PartFiles
from solepath.types import Foot
from solepath.types.extras import install_hint

Kept = tuple[subprocess.CompletedProcess[str], Path]
SMALL = ("--wearers", "12", "--seconds", "4", "--processes", "1")


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Kept:
    """Return what a whole demonstration printed, and where it left its files."""
    out = tmp_path_factory.mktemp("fleet") / "out"
    return run("fleet-demo", *SMALL, "--kills", "2", "--out", out, "--json", out.with_suffix(".json"), "--keep"), out


@pytest.mark.long
def test_a_killed_fleet_emits_the_same_events_as_one_that_is_not(kept: Kept) -> None:
    result, out = kept
    assert (result.returncode, result.stderr) == (0, "")
    assert "sessions without an engine: the same events" in result.stdout
    assert "1 loses some rows for ever, 1 sends random bytes" in result.stdout
    assert re.search(r"killed run 1: .*, with \d+ % read; .* s replayed, .*; the same events", result.stdout)
    rows = dict(re.findall(r"^(\S.*?)  +(\d+)$", result.stdout, re.MULTILINE))
    assert (rows["wearers"], rows["kills"], rows["of them with the same events"]) == ("12", "2", "2")
    figures = json.loads(out.with_suffix(".json").read_text())
    assert figures["ratio"] > 0.0 and len(figures["kills"]) == 2 and figures["runs"][0]["equal"]
    assert figures["engine"]["events"] == int(rows["events"]) == read_events(out / "events").num_rows > 100


def heel_strike(wearer: str, number: int, t: float = 1.0) -> NumberedEvent:
    return NumberedEvent(wearer, number, HeelStrike(t=t, known_at=t, foot=Foot.LEFT))


def write(directory: Path, *numbered_events: NumberedEvent) -> Path:
    parts = PartFiles(directory)
    parts.write(numbered_events)
    parts.close()
    return directory


def test_repeated_changed_or_misnumbered_events_are_differences(tmp_path: Path) -> None:
    one, other = heel_strike("anna", 0), heel_strike("anna", 1)
    expected = read_events(write(tmp_path / "expected", one, other))
    twice = read_events(write(tmp_path / "twice", one, one, other))
    assert differences(expected, twice) == ["anna, event 0 (HeelStrike at 1.0 s) is there too often"]
    later = read_events(write(tmp_path / "later", heel_strike("anna", 1, 2.0), one))
    assert differences(expected, later) == [
        "anna, event 1 (HeelStrike at 1.0 s) is missing",
        "anna, event 1 (HeelStrike at 2.0 s) is there, and should not be",
    ]
    hole = read_events(write(tmp_path / "hole", one, heel_strike("anna", 2)))
    assert find_number_gaps(hole) == ["anna has 2 different event numbers from 0 to 2"]


@pytest.mark.soak
def test_ctrl_c_leaves_no_files(tmp_path: Path) -> None:
    out = tmp_path / "out"
    command = [sys.executable, "-m", "solepath", "fleet-demo", *SMALL, "--out", str(out), "--json", str(out / "f.json")]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (out / "runs" / "sessions" / "log").exists():
        assert running.poll() is None
        sleep(0.02)
    running.send_signal(signal.SIGINT)
    _, output = running.communicate(timeout=30.0)
    assert (running.returncode, output) == (130, "")
    assert not out.exists()
    everything = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    assert str(out) not in everything


def test_impossible_options_are_reported_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").touch()
    assert "there already" in run_failing("fleet-demo", "--out", tmp_path / "full")
    assert "more than there are wearers, 1" in run_failing("fleet-demo", "--wearers", 1, "--processes", 2)
    assert str(tmp_path / "no") in run_failing("fleet-demo", "--json", tmp_path / "no" / "figures.json")


def test_what_is_not_installed_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "bytewax", None)
    assert install_hint("bytewax") in run_failing("fleet-demo")
