"""fleet-demo: wearers through an engine that is killed, what it prints, and how it ends."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from random import Random
from time import sleep

import pytest

from commands import refused, run

pytest.importorskip("bytewax", reason="bytewax is not installed: it has no wheels for Python 3.13 and later")

from solepath.cli.fleet_demo import verdict
from solepath.events import HeelStrike
from solepath.fleet import Told
from solepath.fleet.demo.compare import Torn, differences, files, holes, of_sessions, read_told
from solepath.fleet.demo.kills import compared, draw
from solepath.fleet.parquet import Parts
from solepath.types import Foot

SMALL = ("--wearers", "12", "--seconds", "2", "--processes", "1")


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> tuple[subprocess.CompletedProcess[str], Path]:
    """What a whole demonstration printed, and where it left what it wrote."""
    out = tmp_path_factory.mktemp("fleet") / "out"
    return run("fleet-demo", *SMALL, "--kills", "1", "--out", out, "--json", out.with_suffix(".json"), "--keep"), out


def test_a_fleet_that_is_killed_tells_what_one_tells_that_is_not(
    kept: tuple[subprocess.CompletedProcess[str], Path],
) -> None:
    done, out = kept
    assert (done.returncode, done.stderr) == (0, "")
    assert "sessions alone: the same events" in done.stdout
    assert re.search(r"killed run 1: .* after \d+\.\d s, .*; the same events", done.stdout)
    rows = dict(re.findall(r"^(\S.*?)  +(\d+)$", done.stdout, re.MULTILINE))
    assert (rows["wearers"], rows["kills"], rows["of them with the same events"]) == ("12", "1", "1")
    figures = json.loads(out.with_suffix(".json").read_text())
    assert figures["ratio"] > 0.0 and len(figures["kills"]) == 1 and figures["runs"][0]["equal"]
    assert figures["engine"]["events"] == int(rows["events"]) == read_told(out / "told").num_rows > 100


def test_the_query_that_is_printed_counts_the_events(kept: tuple[subprocess.CompletedProcess[str], Path]) -> None:
    pytest.importorskip("duckdb")
    (line,) = (line for line in kept[0].stdout.splitlines() if line.startswith("python -c"))
    done = subprocess.run([sys.executable, *shlex.split(line)[1:]], capture_output=True, text=True, check=True)
    assert "HeelStrike" in done.stdout


def test_one_event_less_in_one_part_is_named_and_the_status_is_1(
    kept: tuple[subprocess.CompletedProcess[str], Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    runs = kept[1] / "runs"
    told = shutil.copytree(runs / "killed-1" / "told", tmp_path / "told")
    expected = read_told(runs / "uninterrupted" / "told")
    assert compared(expected, told) == []
    part = parquet.read_table(files(told)[0])
    lost = part.slice(0, 1).to_pylist()[0]
    parquet.write_table(part.slice(1), files(told)[0])
    (found,) = compared(expected, told)
    assert found.startswith(f"{lost['wearer']}, event {lost['number']} ({lost['event']} at ")
    assert found.endswith(" is missing")
    assert verdict([], [[found]]) == 1
    assert f"killed run 1: {found}" in capsys.readouterr().out


def test_a_part_that_is_damaged_is_named(
    kept: tuple[subprocess.CompletedProcess[str], Path], tmp_path: Path
) -> None:
    told = shutil.copytree(kept[1] / "told", tmp_path / "told")
    expected, part = read_told(told), files(told)[0]
    part.write_bytes(part.read_bytes()[:-40])
    (found,) = compared(expected, told)
    assert str(part) in found and "cannot be read" in found
    with pytest.raises(Torn):
        read_told(told)


def heel_strike(wearer: str, number: int, t: float = 1.0) -> Told:
    return Told(wearer, number, HeelStrike(t=t, known_at=t, foot=Foot.LEFT))


def write(directory: Path, *told: Told) -> Path:
    parts = Parts(directory)
    parts.write(told)
    parts.close()
    return directory


def test_events_that_are_told_twice_or_otherwise_or_are_not_numbered_on_are_differences(tmp_path: Path) -> None:
    one, other = heel_strike("anna", 0), heel_strike("anna", 1)
    expected = read_told(write(tmp_path / "expected", one, other))
    assert differences(expected, read_told(write(tmp_path / "order", other, one))) == []
    twice = read_told(write(tmp_path / "twice", one, one, other))
    assert differences(expected, twice) == ["anna, event 0 (HeelStrike at 1.0 s) is there twice"]
    later = read_told(write(tmp_path / "later", one, heel_strike("anna", 1, 2.0)))
    assert differences(expected, later) == [
        "anna, event 1 (HeelStrike at 1.0 s) is missing",
        "anna, event 1 (HeelStrike at 2.0 s) is there, and should not be",
    ]
    hole = read_told(write(tmp_path / "hole", one, heel_strike("anna", 2)))
    assert holes(expected) == [] and holes(hole) == ["anna has 2 events numbered from 0 to 2"]
    assert differences(expected, of_sessions(hole)) == []
    assert differences(expected, read_told(tmp_path / "nowhere"))[-1].endswith("is missing")


def test_kills_are_drawn_from_the_seed_and_are_as_many_as_asked_for() -> None:
    planned = draw(10, 20.0, 2, Random(5))
    assert planned == draw(10, 20.0, 2, Random(5)) != draw(10, 20.0, 2, Random(6))
    kills = [kill for run in planned for kill in run]
    assert len(kills) == 10 and {kill.which for kill in kills} >= {None}
    assert all(0.0 <= kill.after <= 20.0 for kill in kills)
    assert draw(0, 20.0, 2, Random(5)) == []


def test_whoever_interrupts_it_finds_nothing_left(tmp_path: Path) -> None:
    out = tmp_path / "out"
    command = [sys.executable, "-m", "solepath", "fleet-demo", *SMALL, "--out", str(out)]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (out / "runs" / "uninterrupted" / "log").exists():
        assert running.poll() is None
        sleep(0.02)
    running.send_signal(signal.SIGINT)
    _, said = running.communicate(timeout=30.0)
    assert (running.returncode, said) == (130, "")
    assert list(out.iterdir()) == []
    everything = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    assert str(out) not in everything


def test_what_cannot_be_is_said_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").touch()
    assert "no recipe 'best'" in refused("fleet-demo", "--recipe", "best")
    assert "there already" in refused("fleet-demo", "--out", tmp_path / "full")
    assert "only 1 wearers" in refused("fleet-demo", "--wearers", 1, "--processes", 2)
    assert "at least 1" in refused("fleet-demo", "--seconds", 0.5)
    assert "is the most" in refused("fleet-demo", "--seconds", 1e6)
    assert str(tmp_path / "no") in refused("fleet-demo", "--json", tmp_path / "no" / "figures.json")


def test_what_is_not_installed_is_named() -> None:
    program = "import sys; sys.modules['bytewax'] = None; from solepath.cli import main; sys.exit(main(['fleet-demo']))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert "pip install 'solepath[bytewax]'" in done.stderr
