"""What is wrong with a recording is one list, wherever it is told: summary, run.json, report, page and check."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from hashlib import sha256
from html import unescape
from math import nan
from pathlib import Path
from typing import Any

import pytest
from attrs import evolve
from commands import run
from here import EXAMPLES
from recordings import recorded
from shown import frame, shown, walked
from soak import longer

from solepath import (
    CellFault,
    CellsFailed,
    Defect,
    DefectFound,
    FeetSwapped,
    Foot,
    FootSilent,
    Limitation,
    Packet,
    Session,
    Site,
)
from solepath.emulate import Walker
from solepath.emulate.routes.route import Route
from solepath.show.findings import finding_of, findings
from solepath.show.tables.summary import summary
from solepath.walk import Walk

LEFT = Site.LEFT_FOOT
SILENT_FROM, SILENT_UNTIL = 12.0, 24.0
"""Time in which the left insole sends nothing, s."""


@pytest.fixture(scope="module")
def packets() -> list[Packet]:
    """A walk whose left insole is switched off in its midst, and whose radio loses and damages some frames."""
    route = Route().stand(2.0).walk(45.0, speed=1.2).stop(2.0)
    kept = [one for one in walked(route, cells=8) if one.site is not LEFT or not SILENT_FROM < one.t < SILENT_UNTIL]
    kept = [one for number, one in enumerate(kept) if number % 97]
    return [Packet(one.t, one.site, one.channel, one.data[::-1]) if k % 151 == 0 else one for k, one in enumerate(kept)]


def test_the_findings_of_run_json_are_those_of_summary_report_and_check(packets: list[Packet], tmp_path: Path) -> None:
    path, out, report = recorded(tmp_path / "walk.jsonl", packets), tmp_path / "out", tmp_path / "walk.html"
    tracked, checked = run("track", path, "--out", out, "--report", report), run("check", path)
    found = json.loads((out / "run.json").read_text())["findings"]
    codes = {(one["code"], one["site"]) for one in found}
    assert all(one.keys() == {"code", "site", "text"} for one in found)
    assert {("foot_silent", "left_foot"), ("samples_missing", "left_foot"), ("packets_rejected", "right_foot")} <= codes
    page = unescape(re.sub("<[^>]*>", "", report.read_text())).replace("\N{NO-BREAK SPACE}", " ")
    for one in found:
        sentence = f"{one['site'].replace('_', ' ')}: {one['text']}".removeprefix(": ")
        assert sentence in tracked.stdout and sentence in checked.stdout
        assert f"{sentence[0].upper()}{sentence[1:].removesuffix('.')}." in page
    assert "left foot: nothing comes" in checked.stdout.partition("worth knowing")[0] and checked.returncode == 1


def test_the_page_says_what_the_summary_says() -> None:
    axes = DefectFound(t=1.0, known_at=1.0, site=LEFT, defect=Defect.AXES, what="an axis is mirrored. Mount it again")
    cells = CellsFailed(t=2.0, known_at=2.0, site=LEFT, fault=CellFault.STUCK, cells=(5,))
    events = [
        axes,
        cells,
        FootSilent(t=3.0, known_at=3.0, foot=Foot.RIGHT, silent_for=3.0),
        FeetSwapped(t=4, known_at=4),
    ]
    scene = shown(events)
    text = summary(scene.walk, title="walk", seconds=0.0)
    found = frame(scene)["findings"]
    assert {one["site"] for one in found} == {"left foot", "right foot", ""} and len(found) == len(events)
    for one in found:
        assert f"{one['site']}: {one['what']}".removeprefix(": ") in text


Change = Callable[[Any], Any]
REFUSED: dict[str, tuple[str, Change]] = {
    "packets are damaged": ("packets_rejected", lambda one: evolve(one, data=one.data[::-1])),
    "packets are of another channel": ("channel_unknown", lambda one: evolve(one, channel="other/motion")),
    "packets are empty": ("packets_rejected", lambda one: evolve(one, data=b"")),
    "samples are no numbers": ("samples_rejected", lambda one: evolve(one, acc=(nan, 0.0, 0.0))),
    "samples are of no sensor": ("samples_rejected", lambda one: evolve(one, acc=(1e9, 0.0, 0.0))),
    "samples are of the past": ("samples_rejected", lambda one: evolve(one, t=one.t - 30.0)),
}
"""What makes a foot's packets or samples useless, and the finding that says so."""


@pytest.mark.parametrize("start", [12.0, *longer(36.0)])
@pytest.mark.parametrize("change", REFUSED)
def test_a_foot_of_which_all_that_comes_is_rejected_has_that_for_a_finding_and_is_not_called_silent(
    change: str, start: float
) -> None:
    code, changed = REFUSED[change]
    route, walk, session = Route().stand(2.0).walk(45.0, speed=1.2).stop(2.0), Walk(), Session(losses=True)
    samples = sorted([one for foot in Foot for one in Walker(route).samples(foot, 100.0)], key=lambda one: one.t)
    items = samples if code == "samples_rejected" else walked(route, cells=8)
    for one in items:
        item = changed(one) if one.site is LEFT and one.t > items[0].t + start else one
        walk.take(item, session.feed(item))
    assert [one.code for one in findings(walk) if one.act] == [code]


@pytest.mark.parametrize("damaged", [0, 1, 20])
def test_a_foot_that_falls_silent_after_some_damaged_packets_is_called_silent(damaged: int) -> None:
    walk, session, number = Walk(), Session(losses=True), 0
    for one in walked(Route().stand(2.0).walk(45.0, speed=1.2).stop(2.0), cells=8):
        if one.site is LEFT and one.t > SILENT_FROM:
            number += 1
            if number > damaged:
                continue
            one = evolve(one, data=one.data[::-1])
        walk.take(one, session.feed(one))
    assert [one.code for one in findings(walk) if one.act] == ["foot_silent"]


@pytest.mark.parametrize("count", [1, 2, 12])
def test_failed_cells_are_named_with_their_fault_and_what_to_do(count: int) -> None:
    cells = tuple(range(3, 3 + count))
    found = finding_of(CellsFailed(t=1.0, known_at=1.0, site=LEFT, fault=CellFault.DEAD, cells=cells))
    words = {1: "cell 3 shows no load", 2: "cells 3, 4 show no load", 12: "12 cells show no load"}
    assert found is not None and found.brief == f"left foot: {words[count]}"
    assert "have the insole repaired" in found.text and not found.act


def test_a_limitation_of_the_session_has_no_site() -> None:
    found = finding_of(Limitation(t=0.0, known_at=0.0, site=None, what="no floor plan"))
    assert found is not None and (found.code, found.site, found.text) == ("limitation", None, "no floor plan")


def test_every_file_that_was_read_is_an_input_with_its_hash(packets: list[Packet], tmp_path: Path) -> None:
    path = recorded(tmp_path / "walk.jsonl", packets[:3000])
    driver, plan = EXAMPLES / "own_device.py", EXAMPLES / "building.geojson"
    bands, me = tmp_path / "bands.csv", tmp_path / "me.json"
    bands.write_text("measure,low,high,source\nspeed_m_per_s,1,1.4,A laboratory\n")
    assert run("calibrate", "noise", path, "--out", me).returncode == 0
    words = ["--driver", driver, "--reference", bands, "--floorplan", plan, "--calibration", me, "--compare", path]
    done = run("track", path, *words, "--out", tmp_path / "out", "--report", tmp_path / "walk.html")
    assert done.returncode == 0, done.stderr
    inputs = json.loads((tmp_path / "out" / "run.json").read_text())["inputs"]
    read = {one.name: sha256(one.read_bytes()).hexdigest() for one in (path, driver, bands, plan, me)}
    assert {one["name"]: one["sha256"] for one in inputs} == read
    assert inputs[0]["name"] == "walk.jsonl" and len(inputs) == len(read)
