"""examples/app.py over the Bluetooth of `solepath emulate`: a lost link, a suspended phone and a kill cost no walk."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from here import EXAMPLES
from programs import TAKES, emulator


def strides(text: str) -> list[tuple[str, int]]:
    return [(foot, int(number)) for foot, number in re.findall(r"^(\w+): stride (\d+) of", text, re.MULTILINE)]


def wait(log: Path, number: int) -> None:
    """Wait until the app has printed that a foot has taken so many strides."""
    end = time.monotonic() + TAKES
    while max([of for _, of in strides(log.read_text())], default=0) < number:
        assert time.monotonic() < end, log.read_text()
        time.sleep(0.05)


@pytest.mark.soak
def test_an_app_goes_on_after_a_lost_link_a_suspension_and_a_kill(tmp_path: Path) -> None:
    faults = tmp_path / "faults.txt"
    faults.write_text("5 left_foot disconnect\n")
    with emulator("--distance", 30, "--faults", faults) as (_, where):
        command = [sys.executable, EXAMPLES / "app.py", tmp_path / "walk", "solepath L", "solepath R", where]
        logs = [tmp_path / f"{run}.log" for run in ("first", "second")]
        for log, number in zip(logs, (6, 10), strict=True):
            with log.open("w") as out, subprocess.Popen(command, stdout=out, stderr=out) as process:
                wait(log, number - 2)
                process.send_signal(signal.SIGSTOP)
                time.sleep(2.0)
                process.send_signal(signal.SIGCONT)
                wait(log, number)
                process.kill()
    first, second = [log.read_text() for log in logs]
    assert "left_foot: battery" in first and first.count("left_foot: Connected") == 2, first
    assert "left_foot: Disconnected" in first and "left_foot: Connected" in second
    for foot in ("left", "right"):
        numbers = [number for of, number in strides(first + second) if of == foot]
        assert numbers == [*range(1, len(numbers) + 1)], "each stride once, in one row over the kill"


@pytest.mark.parametrize("state", ["[]", "{}", "null", "{"])
def test_files_without_a_packet_or_a_state_do_not_stop_an_app_at_its_start(tmp_path: Path, state: str) -> None:
    walk = tmp_path / "walk"
    walk.mkdir()
    (walk / "state.json").write_text(state)
    for name, text in {"walk-0001.jsonl": "", "walk-0002.jsonl": '{"format": "solep'}.items():
        (walk / name).write_text(text)
    command = [sys.executable, EXAMPLES / "app.py", walk, "solepath L", "solepath R", "tcp:127.0.0.1:1"]
    lines = subprocess.run(command, capture_output=True, text=True, timeout=TAKES).stderr.splitlines()
    assert [line.partition(": ")[0].rpartition("/")[2] for line in lines[:2]] == ["walk-0001.jsonl", "walk-0002.jsonl"]
    assert lines[2:] == ["nothing answers at tcp:127.0.0.1:1: start `solepath emulate`"]
