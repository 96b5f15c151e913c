"""Tests errors of scan, live, record and emulate: each is reported in one line, and Ctrl-C ends the command."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import commands
import pytest
from commands import one_line
from programs import TAKES, run, started, wait_for

from solepath.recording import read_packets


def complaint(*arguments: object) -> str:
    """Return the one line with which a command fails in this process."""
    return one_line(commands.run(*arguments)).removeprefix("solepath: ")


def test_a_machine_without_bluetooth_is_named_as_such() -> None:
    if os.path.exists("/run/dbus/system_bus_socket"):
        pytest.skip("this machine may have Bluetooth")
    assert "no Bluetooth" in complaint("live")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--at", "knee=X"], "'knee=X' is not SITE=DEVICE"),
        (["--left", "X", "--at", "left_foot=Y"], "two devices cannot be at one site"),
    ],
)
def test_options_that_make_no_sense_are_named(options: list[str], message: str) -> None:
    assert message in complaint("live", *options)


def test_a_script_that_makes_no_sense_is_named_with_its_line(tmp_path: Path) -> None:
    script = tmp_path / "faults.txt"
    script.write_text("1 left_foot disconnect\n2 left_foot stumble\n")
    assert f"{script}: line 2: " in complaint("emulate", "--faults", script)


@pytest.mark.soak
def test_a_full_disk_ends_live_with_a_summary_and_a_line_that_names_the_directory(insoles: str, tmp_path: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    (tmp_path / "track.csv").symlink_to("/dev/full")
    result = run(
        "live", "--via", insoles, "--left", "solepath L", "--out", tmp_path, "--duration", 9, "--record",
        tmp_path / "walk.jsonl", expect=2,
    )  # fmt: skip
    assert result.stderr == f"solepath: {tmp_path}: the disk is full\n"
    assert "recipe default: " in result.stdout and "written to" not in result.stdout
    assert list(read_packets(tmp_path / "walk.jsonl"))


@pytest.mark.soak
def test_ctrl_c_during_the_search_ends_at_once_and_without_a_summary(insoles: str, tmp_path: Path) -> None:
    with started("record", "--via", insoles, "--out", tmp_path / "walk.jsonl", "--duration", 60) as process:
        assert process.stdout is not None
        while "looking for" not in process.stdout.readline():
            pass
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=TAKES)
    assert (process.returncode, out, err) == (130, "", "")
    assert not list(tmp_path.iterdir())


@pytest.mark.soak
def test_ctrl_c_again_and_again_does_not_kill_a_recording_that_is_ended(insoles: str, tmp_path: Path) -> None:
    file = tmp_path / "walk.jsonl"
    with started("record", "--via", insoles, "--left", "solepath L", "--out", file, "--duration", 60) as process:
        wait_for(file, "insole/frame")
        while process.poll() is None:
            process.send_signal(signal.SIGINT)
            time.sleep(0.02)
        out, err = process.communicate(timeout=TAKES)
    assert (process.returncode, err) == (0, "")
    assert f"recorded in {file}" in out and list(read_packets(file))
