"""Tests the replacement of files: where they may be, and that a run that is ended leaves nothing behind."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
from pathlib import Path
from time import sleep

import pytest
from commands import run
from programs import TAKES, started
from recordings import into, written
from watchers import ANYWHERE, address


@pytest.fixture(scope="module")
def long_recording(recording: Path) -> Path:
    """Return a recording that repeats itself: some seconds of computing."""
    header, *packets = map(json.loads, recording.read_text().splitlines())
    length = packets[-1]["t"]
    file = recording.parent / "long.jsonl"
    again = [packet | {"t": packet["t"] + k * length} for k in range(60) for packet in packets]
    file.write_text("".join(f"{json.dumps(line)}\n" for line in [header, *again]))
    return file


@pytest.fixture
def earlier(tmp_path: Path) -> dict[str, bytes]:
    """Return the files of an earlier run."""
    (tmp_path / "out").mkdir()
    starts = {
        "r.html": '<!DOCTYPE html>\n<html lang="en"><head><meta name="generator" content="solepath">',
        "out/events.jsonl": '{"event": "HeelStrike", "t": 1.0, "known_at": 1.0, ',
        "out/track.csv": "t_s,foot,x_m,y_m,z_m,phase\n",
    }
    for name, start in starts.items():
        (tmp_path / name).write_text(f"{start}an earlier {name}")
    return written(tmp_path)


@pytest.mark.soak
def test_another_ctrl_c_gives_the_rest_up_and_what_an_earlier_run_wrote_stays(
    long_recording: Path, earlier: dict[str, bytes], tmp_path: Path
):
    pytest.importorskip("aiohttp")
    with started("track", long_recording, *ANYWHERE, *into(tmp_path)) as process:
        address(process)
        assert process.stdout is not None
        process.send_signal(signal.SIGINT)
        while "Ctrl-C again gives it up" not in process.stdout.readline():
            pass
        process.send_signal(signal.SIGINT)
        output, err = process.communicate(timeout=TAKES)
    assert process.returncode == 130 and output == ""
    assert re.fullmatch(r"solepath: given up after \d+\.\d of .* s: .* what was written before stays as it is\n", err)
    assert written(tmp_path) == earlier


def test_a_run_that_is_ended_leaves_what_an_earlier_one_wrote(
    long_recording: Path, earlier: dict[str, bytes], tmp_path: Path
):
    out = tmp_path / "out"
    with started("track", long_recording, *into(tmp_path)) as process:
        while len(list(out.iterdir())) < 6 and process.poll() is None:
            sleep(0.01)
        process.send_signal(signal.SIGHUP)
        assert process.wait(TAKES) == 130
    assert written(tmp_path) == earlier


def test_a_run_writes_through_links_and_into_pipes_and_leaves_who_may_read(recording: Path, tmp_path: Path):
    kept, link, pipe = tmp_path / "kept.html", tmp_path / "link.html", tmp_path / "pipe"
    kept.write_text("")
    kept.chmod(0o440)
    link.symlink_to(kept)
    os.mkfifo(pipe)
    assert run("track", recording, "--report", link).returncode == 0
    assert link.is_symlink() and kept.stat().st_mode & 0o777 == 0o440
    with subprocess.Popen(["cat", str(pipe)], stdout=subprocess.PIPE) as reader:
        assert run("track", recording, "--report", pipe).returncode == 0
        assert reader.communicate(timeout=TAKES)[0] == kept.read_bytes() != b""
    assert pipe.is_fifo()


def test_names_that_are_no_text_and_hold_control_codes_are_shown_without(recording: Path, tmp_path: Path):
    here = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff\x1b[31m"))
    here.mkdir()
    walk = here / recording.name.replace("walk", "\x1b]0;\udcff")
    walk.write_bytes(recording.read_bytes())
    result = run("track", walk, "--out", here / "out", "--report", here / "r.html")
    assert (result.returncode, result.stderr) == (0, "")
    assert "\x1b" not in result.stdout and result.stdout.encode("utf-8")
    assert "\x1b" not in (here / "r.html").read_text(encoding="utf-8")
