"""No command writes over what it reads, another program's file or, without --force, a recording; pipes are files."""

from __future__ import annotations

import json
import os
import shutil
import threading
from pathlib import Path

import pytest
from commands import run, run_failing
from here import PROTOCOL
from recordings import PACKETS, into, recorded, written

from solepath.calibration import Calibration
from solepath.calibration.file import write_calibration
from solepath.cli.common import files
from solepath_lab.reproduce.command import FIGURE

READ = "is what this command reads; write to another file"
GAUGE = "counts,newtons\n" + "".join(f"{counts},{0.1 * counts:.1f}\n" for counts in (60, 100, 400, 800, 1200, 1900))


def name_of(how: str, path: Path) -> Path:
    """Return the same file under another name."""
    other = path.with_name(f"other-{path.name}")
    if how == "hard link":
        other.hardlink_to(path)
    return path if how == "itself" else other


@pytest.mark.parametrize("how", ["itself", "hard link"])
@pytest.mark.parametrize("option", ["FILE", "--calibration", "--floorplan", "--out"])
def test_track_writes_over_nothing_that_it_reads(recording: Path, tmp_path: Path, how: str, option: str) -> None:
    walk = Path(shutil.copy(recording, tmp_path / "events.jsonl"))
    known, plan = tmp_path / "me.json", Path(shutil.copy(PROTOCOL / "floorplans" / "house.geojson", tmp_path))
    write_calibration(known, Calibration(weight=700.0))
    if option == "--out":
        if how != "itself":
            name_of(how, walk).rename(tmp_path / "walk.jsonl")
        source = walk if how == "itself" else tmp_path / "walk.jsonl"
        target, arguments = walk, (source, "--out", tmp_path)
    else:
        target = name_of(how, {"FILE": walk, "--calibration": known, "--floorplan": plan}[option])
        arguments = (walk, "--calibration", known, "--floorplan", plan, "--report", target)
    before = written(tmp_path)
    for force in ((), ("--force",)):
        assert run_failing("track", *arguments, *force) == f"solepath: {target}: {READ}\n"
    assert written(tmp_path) == before


def test_other_commands_write_over_nothing_that_they_read(recording: Path, tmp_path: Path) -> None:
    walk, gauge = Path(shutil.copy(recording, tmp_path / "walk.mcap")), tmp_path / "gauge.csv"
    gauge.write_text(GAUGE)
    known = tmp_path / "me.json"
    write_calibration(known, Calibration())
    before = written(tmp_path)
    for arguments in (
        ("convert", walk, walk, "--force"),
        ("calibrate", "newton", gauge, "--out", gauge),
        ("calibrate", "modes", walk, gauge, "--out", gauge),
        ("live", "--via", "tcp:127.0.0.1:1", "--calibration", known, "--record", known, "--force"),
    ):
        assert run_failing(*arguments).endswith(f": {READ}\n"), arguments
    assert written(tmp_path) == before


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("notes.html", ["track", "WALK", "--report", "FILE"]),
        ("events.jsonl", ["track", "WALK", "--out", "FOLDER"]),
        ("strides.csv", ["live", "--via", "tcp:127.0.0.1:1", "--out", "FOLDER"]),
    ],
)
def test_a_file_of_another_program_is_replaced_with_force_only(
    recording: Path, tmp_path: Path, name: str, arguments: list[str]
) -> None:
    path = tmp_path / name
    path.write_text("t_s,foot,my own notes\n")
    words = {"WALK": recording, "FILE": path, "FOLDER": tmp_path}
    sentence = run_failing(*[words.get(argument, argument) for argument in arguments])
    assert sentence == f"solepath: {path}: exists and is no such file that solepath wrote; --force replaces it\n"
    assert path.read_text() == "t_s,foot,my own notes\n"
    if arguments[0] == "track":
        assert run("track", recording, *into(tmp_path)[2:], "--out", tmp_path, "--force").returncode == 0


def test_what_a_command_wrote_itself_and_what_is_empty_is_replaced(recording: Path, tmp_path: Path) -> None:
    plan = PROTOCOL / "floorplans" / "house.geojson"
    (tmp_path / "r.html").write_text("")
    for _ in range(2):
        assert run("track", recording, "--floorplan", plan, *into(tmp_path)).returncode == 0
    assert {kind.is_own(tmp_path / "out" / name) for name, kind in files.TRACK_KINDS.items()} == {True}


@pytest.mark.parametrize(
    ("kind", "content"),
    [
        (files.TRACK_KINDS["events.jsonl"], '{"event": "Login", "t": 12, "user": "ann"}\n'),
        (FIGURE, '<svg inkscape:export-filename="/home/ann/solepath/poster.png"/>\n'),
        (FIGURE, "%!PS-Adobe-3.0\n%%Title: solepath\n%%Creator: poster\n"),
    ],
)
def test_a_file_that_looks_like_one_of_solepath_is_of_another_program(
    kind: files.Kind, content: str, tmp_path: Path
) -> None:
    (tmp_path / "x").write_text(content)
    assert not kind.is_own(tmp_path / "x")


@pytest.mark.parametrize(
    "arguments",
    [
        ["record", "--via", "tcp:127.0.0.1:1", "--out", "FILE"],
        ["demo", "--terminal", "--distance", "1", "--record", "FILE"],
        ["convert", "WALK", "FILE"],
    ],
)
def test_a_recording_is_replaced_with_force_only_and_not_before_packets_come(
    recording: Path, tmp_path: Path, arguments: list[str]
) -> None:
    path = tmp_path / ("old.mcap" if arguments[0] == "convert" else "old.jsonl")
    recorded(path, PACKETS)
    before = path.read_bytes()
    words = [{"FILE": path, "WALK": recording}.get(argument, argument) for argument in arguments]
    assert run_failing(*words) == f"solepath: {path}: exists; --force replaces it\n"
    if arguments[0] in ("record", "live"):
        assert run(*words, "--force").returncode == 2
        assert path.read_bytes() == before
    else:
        assert run(*words, "--force").returncode == 0
        assert path.read_bytes() != before


def test_two_outputs_are_two_files(recording: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    sentence = run_failing("track", recording, "--out", out, "--report", out / "events.jsonl")
    assert sentence == f"solepath: {out / 'events.jsonl'}: two outputs cannot be one file\n"


def test_a_report_may_be_in_the_directory_that_is_made(recording: Path, tmp_path: Path) -> None:
    out = tmp_path / "new" / "walk"
    assert run("track", recording, "--out", out, "--report", out / "r.html").returncode == 0
    tables = {"events.jsonl", "track.csv", "strides.csv", "gait_cycles.csv", "run.json"}
    assert {"r.html", *tables} == {f.name for f in out.iterdir()}


@pytest.mark.soak
def test_a_recording_stays_if_no_sensor_sends_anything(insoles: str, tmp_path: Path) -> None:
    path = recorded(tmp_path / "walk.jsonl", PACKETS)
    before = written(tmp_path)
    done = run("record", "--via", insoles, "--left", "nobody", "--out", path, "--duration", 3, "--force")
    assert done.returncode == 2
    assert done.stderr.endswith(f"solepath: no sensor sent anything: {path} is unchanged\n")
    assert written(tmp_path) == before


def test_a_recording_comes_through_a_pipe_as_from_a_file(recording: Path, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    threading.Thread(target=pipe.write_bytes, args=(recording.read_bytes(),), daemon=True).start()
    for source, out in ((pipe, "piped"), (recording, "read")):
        done = run("track", source, "--out", tmp_path / out)
        assert (done.returncode, done.stderr) == (0, "")
    piped, read = written(tmp_path / "piped"), written(tmp_path / "read")
    runs = [json.loads(files.pop("run.json")) for files in (piped, read)]
    for run_file in runs:
        del run_file["inputs"], run_file["options"], run_file["command_line"]
    assert piped == read and runs[0] == runs[1], "only run.json names the file"


def test_a_pipe_that_becomes_no_recording_gets_the_reason(recording: Path, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    sentence = run_failing("convert", pipe, tmp_path / "x.jsonl")
    assert sentence == (f"solepath: {pipe}: is a pipe or a device; it is read more than once, so it has to be a file\n")
