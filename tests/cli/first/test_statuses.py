"""Tests the exit statuses of docs/commands.md, each by a command in a process of its own."""

from __future__ import annotations

import os
import signal
import subprocess
from pathlib import Path

import pytest
from commands import one_line, run
from programs import SOLEPATH, TAKES, started

TABLE = "t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z\n"


def test_0_also_when_the_reader_of_a_pipe_ends_first(recording: Path) -> None:
    with subprocess.Popen([*SOLEPATH, "track", recording], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None and process.stderr is not None
        process.stdout.close()
        assert (process.wait(TAKES), process.stderr.read()) == (0, b"")


def test_1_for_a_recording_in_another_unit_and_2_where_it_is_used(tmp_path: Path) -> None:
    table = tmp_path / "walk.csv"
    table.write_text(TABLE + "".join(f"{0.01 * k:.2f},0,0,1,0,0,0\n" for k in range(500)))
    checked = run("check", table)
    assert (checked.returncode, checked.stderr) == (1, "") and "needs fixing" in checked.stdout
    assert "g" in one_line(run("track", table))


def test_a_full_disk_below_what_is_printed_is_named(recording: Path) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [*SOLEPATH, "track", recording], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert (done.returncode, done.stderr) == (2, "solepath: the output cannot be written: the disk is full\n")


def test_130_when_ctrl_c_comes_before_all_input_was_used(recording: Path, tmp_path: Path) -> None:
    if not hasattr(os, "mkfifo"):
        pytest.skip("no named pipes here")
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with started("track", pipe, "--out", tmp_path / "out") as process, pipe.open("wb") as writer:
        writer.write(recording.read_bytes()[:200_000])  # more than a pipe holds: some of it was read
        writer.flush()
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=TAKES)
    assert (process.returncode, out, err) == (130, "", "")
    assert not list((tmp_path / "out").glob("*"))
