"""One definition of what is missing: page, report, summary, check and run.json agree to 0.1 percentage points."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path

import pytest
from commands import run
from recordings import recorded
from shown import frame, walked

from solepath import Packet, SampleGap, Session, Site
from solepath.emulate.routes.route import Route
from solepath.show.page.scene.scene import Scene

LEFT = Site.LEFT_FOOT
CUT, ABSENCE = 20.0, 25.0
"""Start, s, and duration, s, of a time without a connection."""


@cache
def frames() -> list[Packet]:
    """Return more than a minute of walking in a left insole, whose radio loses nothing."""
    route = Route().stand(2.0).walk(80.0, speed=1.2).stop(2.0)
    return [packet for packet in walked(route, cells=8) if packet.site is LEFT]


def without_one_of(every: int, absence: float) -> tuple[list[Packet], int, int]:
    """Return the walk without one frame of `every`, and without those of an absence; the numbers lost and taken."""
    connected = [one for one in frames() if not CUT < one.t <= CUT + absence]
    samples = [one for one in connected if one.channel == "insole/frame"]
    lost = {id(one) for one in samples[every // 2 : -1 : every]}
    return [one for one in connected if id(one) not in lost], len(lost), len(samples)


def shares(text: str) -> list[float]:
    """Return the shares of missing samples that a text states, in percent."""
    return [float(share) for share in re.findall(r"samples missing \(([\d.]+) %", text)]


@pytest.mark.parametrize("absence", [0.0, ABSENCE])
@pytest.mark.parametrize("every", [10, 50, 200])
def test_one_frame_of_so_many_is_missing_wherever_it_is_told(every: int, absence: float, tmp_path: Path) -> None:
    packets, lost, taken = without_one_of(every, absence)
    share = pytest.approx(100.0 * lost / taken, abs=0.1)
    path, out, report = recorded(tmp_path / "walk.jsonl", packets), tmp_path / "out", tmp_path / "walk.html"
    tracked, checked = run("track", path, "--out", out, "--report", report), run("check", path)
    figures = json.loads((out / "run.json").read_text())["sites"]["left_foot"]
    assert (figures["missing"], figures["samples"]) == (lost, taken - lost)
    assert 100.0 * figures["missing_share"] == share
    assert figures["missing_s"] == pytest.approx(0.01 * lost, rel=0.01)
    assert figures["absent_s"] == pytest.approx(absence, abs=0.1)
    page = re.sub("<[^>]*>", "", report.read_text())
    for text in (tracked.stdout, checked.stdout, page):
        assert shares(text) and all(one == share for one in shares(text)), text
        assert ("absent for 25.0 s" in text) is (absence > 0.0)
    session, scene = Session(poses=True), Scene("a walk", "default")
    gaps = []
    for packet in packets:
        events = session.feed(packet)
        gaps += [event for event in events if isinstance(event, SampleGap)]
        scene.take(packet, events)
    link = frame(scene)["links"]["left foot"]
    assert link["missing"] == lost and 100.0 * link["missing_share"] == share
    assert len(gaps) == lost + (absence > 0.0), "a loss is one event"
    assert sum(gap.count for gap in gaps) == lost


@pytest.mark.parametrize("every", [10, 50, 200])
def test_rows_that_a_table_lacks_are_counted_by_the_usual_interval(every: int, tmp_path: Path) -> None:
    connected = [k for k in range(4000) if not 2000 < k < 3510]
    rows = [f"{0.01 * k:.2f},0.1,0.2,9.8,0.01,0.02,0.03" for k in connected if k % every != every // 2]
    path = tmp_path / "foot.csv"
    path.write_text("\n".join(["t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z", *rows]) + "\n")
    assert run("track", path, "--foot", "left", "--out", tmp_path / "out").returncode == 0
    figures = json.loads((tmp_path / "out" / "run.json").read_text())["sites"]["left_foot"]
    assert (figures["missing"], figures["samples"]) == (len(connected) - len(rows), len(rows))
    assert figures["absent_s"] == pytest.approx(15.1, abs=0.1)


def test_what_made_the_files_is_written_beside_them(tmp_path: Path) -> None:
    path = recorded(tmp_path / "walk.jsonl", frames()[:800])
    for name in ("one", "two"):
        assert run("track", path, "--out", tmp_path / name, "--recipe", "kupt-dfpc").returncode == 0
    one, two = [json.loads((tmp_path / name / "run.json").read_text()) for name in ("one", "two")]
    assert one["recipe"] == "kupt-dfpc" and len(one["recipe_sha256"]) == 64
    assert one["inputs"][0]["name"] == "walk.jsonl" and one["options"]["recipe"]
    assert {**one, "options": None} == {**two, "options": None}
    run("track", path, "--out", tmp_path / "other", "--recipe", "default")
    assert json.loads((tmp_path / "other" / "run.json").read_text())["recipe_sha256"] != one["recipe_sha256"]
