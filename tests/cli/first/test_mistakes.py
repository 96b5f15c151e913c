"""Tests that mistakes of people who use the command line for the first time get one line and status 2."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from commands import one_line, run

RECIPES = "there is no recipe 'cake'; there are: default, kupt-dfpc, "

NAMES = [
    ("tracks walk.jsonl", "there is no command 'tracks': did you mean track?"),
    ("walk.jsonl", "there is no command 'walk.jsonl'; there are: scan, live, record, "),
    ("scan nearby", "too much on the command line: nearby"),
    ("--version scan nearby", "too much on the command line: nearby"),
    ("--recipe default track walk.jsonl", "there is no option --recipe here: options come after the command"),
    ("track walk.jsonl --recipie default", "there is no option --recipie: did you mean --recipe?"),
    ("track walk.jsonl --out=", "--out: nothing is given: is a variable empty?"),
    ("track walk.jsonl --xyzzy", "there is no option --xyzzy (solepath track --help)"),
    ("track walk.jsonl --recipe cake", RECIPES),
    ("track walk.jsonl --recipe default --recipe default", "--recipe default was given twice"),
    ("track walk.jsonl --foot 2", "--foot: '2': each foot is left or right"),
    ("calibrate nosie walk.jsonl --out me.json", "there is no kind 'nosie': did you mean noise?"),
    ("demo --distanc 5", "there is no option --distanc: did you mean --distance?"),
    ("live --left X --profile insoel", "there is no profile 'insoel': did you mean insole?"),
]
MISSING = [
    ("track", "FILE is missing, as in: solepath track walk.csv --report walk.html"),
    ("track walk.jsonl --recipe", "--recipe: needs a value"),
    ("track walk.jsonl --start -1,2,3", "--start is a place on a floor plan: give --floorplan, too"),
    ("track a.csv --compare b.csv c.csv", "too much on the command line: c.csv: give --compare again for the second"),
    ("scan --via tcp:127.0.0.1:1", "solepath: --via: nothing answers at tcp:127.0.0.1:1: start `solepath emulate`"),
    ("demo --distance far", "--distance: 'far' is not a positive number"),
    ("demo --loss 5", "--loss: '5' is not a number from 0 to 1"),
    ("track walk.jsonl --view 8765", "--view: '8765' is not HOST:PORT, as in 127.0.0.1:8765"),
    ("track walk.jsonl --speed 2", "--speed is for the page: it goes with --view"),
    ("track walk.jsonl --recipe default --recipe zupt --report r.html", "--report is for one walk: give one --recipe"),
]
FILES = [
    ("track wlak.jsonl", "wlak.jsonl: there is no such file: did you mean walk.jsonl?"),
    ("track folder", "folder: is a folder, not a recording"),
    ("track walk.jsonl/x", "walk.jsonl: is a file, not a folder"),
    ("track walk.jsonl --out walk.jsonl", "walk.jsonl: is a file; --out needs a folder"),
    ("track walk.jsonl --report nowhere/r.html", "nowhere/r.html: there is no folder nowhere: make it first"),
    ("track walk.jsonl --report walk.jsonl", "walk.jsonl: is what this command reads; write to another file"),
    ("track walk.jsonl --calibration em.json", "em.json: there is no such file: did you mean me.json?"),
    ("track link.jsonl", "link.jsonl: is a link to nothing"),
    ("track comma.csv", "comma.csv: "),
]


@pytest.fixture
def here(tmp_path: Path, recording: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "folder").mkdir()
    (tmp_path / "walk.jsonl").write_bytes(recording.read_bytes())
    (tmp_path / "me.json").write_text("{}")
    (tmp_path / "link.jsonl").symlink_to("away.jsonl")
    (tmp_path / "comma.csv").write_text("t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z\n0,01,0,1,0,2,9,8,0,1,0,1,0,1\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SOLEPATH_DATA", raising=False)
    return tmp_path


@pytest.mark.parametrize(("words", "answer"), [*NAMES, *MISSING, *FILES], ids=lambda text: text[:60])
def test_a_mistake_gets_one_line_with_its_repair(here: Path, words: str, answer: str) -> None:
    before = sorted(here.rglob("*"))
    done = run(*words.split())
    assert answer in one_line(done) and done.stdout == ""
    assert "Errno" not in done.stderr and "o such file or directory" not in done.stderr
    assert sorted(here.rglob("*")) == before


def test_a_file_without_permission_is_named_with_what_is_not_allowed(here: Path) -> None:
    if os.geteuid() == 0:
        pytest.skip("root may read and write everything")
    (here / "walk.jsonl").chmod(0)
    assert "walk.jsonl: you have no permission to read it" in one_line(run("track", "walk.jsonl"))
    (here / "walk.jsonl").chmod(0o600)
    (here / "folder").chmod(0o500)
    line = one_line(run("track", "walk.jsonl", "--report", "folder/r.html"))
    assert "folder/r.html: you have no permission for the folder folder" in line
