"""Paths of readers (docs/app.md, researcher.md, indoor.md, device.md): each is short, its programs and commands run."""

from __future__ import annotations

import json
import runpy
import shlex
import sys
from math import hypot
from pathlib import Path

import pytest
from commands import run
from here import EXAMPLES
from quoted import PAGES, blocks, run_page
from walks import of

from solepath import LinkEvent, StreamStale
from solepath.emulate import Route, Walker
from solepath.types import Foot


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def typed(page: str, start: str) -> None:
    """Run the commands `solepath start ...` of the blocks of a page that need no browser and no network."""
    for line in filter(None, "\n".join(blocks(PAGES[page], "sh")).splitlines()):
        program, *words = shlex.split(line, comments=True)
        if program.endswith("solepath") and words[0] == start and "--view" not in words:
            assert run(*words).returncode == 0


@pytest.mark.soak
def test_an_app_counts_saves_and_goes_on(here: Path) -> None:
    typed("docs/app.md", "demo")
    (loop, answers, links, channels, live, _), names = run_page("docs/app.md", programs=slice(6))
    assert "the left foot touches the floor" in loop and "the right foot has gone" in loop
    assert names["strides"] == loop.count("has gone") > 20
    assert "m ahead" in answers and "steps a minute" in answers
    assert "insole/frame notify" in channels and "insole/control" in channels and "then write: (Write(" in channels
    assert "'event': 'PacketRejected'" in live
    assert "left foot: " in links and "% missing, " in links
    assert all(event.final and not isinstance(event, LinkEvent) for event in names["wearer"]) and names["wearer"]
    names["every_second"]()
    assert names["session"].position == names["session"].restore(names["saved"]["session"]).position
    assert of(StreamStale, names["session"].advance(names["session"].now + 3.0)), "the restored session goes on"


@pytest.mark.long
def test_tables_of_a_lab_become_frames_and_a_report(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "argv", ["researcher.py", "lab"])
    runpy.run_path(str(EXAMPLES / "researcher.py"), run_name="__main__")
    typed("docs/researcher.md", "track")
    typed("docs/researcher.md", "check")
    typed("docs/researcher.md", "validate")
    typed("docs/researcher.md", "batch")
    assert (here / "lab" / "agreement" / "agreement.html").exists() and (here / "lab/results/outcomes.csv").exists()
    (*_, agreement), names = run_page("docs/researcher.md")
    assert agreement.splitlines()[1].split()[:2] == ["stride_time_s", "37"]
    assert set(names["steady"].foot) == {"left", "right"} and len(names["steady"]) > 20
    first = names["strides"].groupby("foot").t_start.min()
    assert (first < 1.0).all(), "the first stride contains the standing, as the page says"


def test_a_plan_of_ones_own_is_walked_on_and_gives_the_room(here: Path) -> None:
    (_, walked, places, _, _, degrees), names = run_page("docs/indoor.md")
    assert "packets" in walked
    rooms = [line.split()[2] for line in places.splitlines()[:-1]]
    assert rooms[0] == "office" and "hall" in rooms and rooms[-1] == "attic" and "door: hall door" in places
    assert places.splitlines()[-1] == "at the end: level 1 attic"
    walk, session = names["walk"], names["session"]
    x, y = names["course"].place(walk.walker, walk.truth.duration)
    assert (x, y) == pytest.approx((11.0, 2.0), abs=0.1)
    assert hypot(session.place.position[0] - x, session.place.position[1] - y) < 1.0
    typed("docs/indoor.md", "plan")
    typed("docs/indoor.md", "track")
    assert (here / "house.svg").exists() and (here / "out" / "plan.svg").exists()
    assert "<name>level 1" in (here / "way.kml").read_text() and "<trkpt" in (here / "way.gpx").read_text()
    longitude, latitude = map(float, degrees.strip("()\n").split(", "))
    assert (longitude, latitude) == pytest.approx((11.57 + 11.0 / 74408.77, 48.15 + 2.0 / 111193.24), abs=1e-8)


def test_a_sole_of_ones_own_is_declared_proven_and_walked_with(here: Path) -> None:
    (*_, vectors, walked), _ = run_page("docs/device.md", "__main__", slice(3, None))
    assert vectors == "the vectors agree\n"
    true = len(Walker(Route().stand(2).walk(12).stop(2)).truth().strides(Foot.LEFT))
    assert sum(line.startswith("StrideTaken(") for line in walked.splitlines()) == true
    (lost,) = [line for line in walked.splitlines() if line.startswith("SampleGap(")]
    assert "count=1" in lost
    (here / "sole.py").write_text("\n".join(blocks(PAGES["docs/device.md"], "python")[3:]), encoding="utf-8")
    check = run("check", "walk.jsonl", "--driver", "sole.py")
    assert check.returncode == 0 and "1 of 1436 samples missing" in check.stdout
    track = run("track", "walk.jsonl", "--driver", "sole.py")
    assert track.returncode == 0 and f"1435  100.0{true:9}" in track.stdout
    noise = run("calibrate", "noise", "walk.jsonl", "--driver", "sole.py", "--out", "me.json")
    assert noise.returncode == 0 and "200.00" in noise.stdout
    assert json.loads((EXAMPLES / "own_device.json").read_text())["channel"] == "shoe/motion"
