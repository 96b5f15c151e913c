"""Where a walk ends is the same on the page, in the picture of the plan, in summary, report and run.json."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
from commands import run
from plan_files import format_floorplan
from recordings import recorded
from shown import frame, shown

from solepath import Session
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.types import SITE_OF_FOOT, Foot
from solepath_lab.emulated.floors import HOUSE, draw

WALKS = [("lift and back", 11, False), ("straight stairs", 12, True), ("turning stairs", 13, False), ("lift", 14, True)]
MORE = [(kind, seed, seed % 2 == 0) for kind, first, _ in WALKS for seed in range(first + 10, first + 14)]
"""Kind of a way through a house of three floors, seed, and whether the start is known."""


def end_in_picture(path: Path) -> tuple[str, str] | None:
    """Return the panel, a floor, that has the mark of the end, and its word; None when nothing was decided."""
    for panel in ElementTree.parse(path).getroot():
        words = [text.text or "" for text in panel.iter() if text.tag.endswith("text")]
        for word in ("end", "likely end", "last known"):
            if word in words:
                return words[0], word
    return None


@pytest.mark.parametrize(
    ("kind", "seed", "known"), [*WALKS, *[pytest.param(*one, marks=pytest.mark.soak) for one in MORE]]
)
def test_page_picture_summary_report_and_run_file_tell_the_same_end(
    kind: str, seed: int, known: bool, tmp_path: Path
) -> None:
    way, wearer = draw(kind, seed)
    devices = {SITE_OF_FOOT[foot]: Insole(cells=8) for foot in Foot}
    walk, start = emulate(way.course.route, wearer=wearer, devices=devices, seed=seed), way.course.start
    plan = tmp_path / "house.geojson"
    plan.write_text(format_floorplan(HOUSE))
    x, y = start.place or (0.0, 0.0)
    given = ("--start", f"{start.level},{x},{y}") if known else ()
    recording, out, report = recorded(tmp_path / "walk.jsonl", walk.packets), tmp_path / "out", tmp_path / "walk.html"
    done = run("track", recording, "--floorplan", plan, *given, "--out", out, "--report", report)
    assert done.returncode == 0

    events = [json.loads(line) for line in (out / "events.jsonl").read_text().splitlines()]
    last = [event for event in events if event["event"] in ("Placed", "PlaceLost")][-1]
    assert last["event"] == "Placed"
    decided = max([one["weight"] for one in last["candidates"]]) >= 0.995

    told = json.loads((out / "run.json").read_text())["place"]
    assert (told["level"], told["decided"]) == (last["level"], decided)
    assert [told["x_m"], told["y_m"]] == last["position"][:2]

    (line,) = [line for line in done.stdout.splitlines() if line.startswith("at the end:")]
    assert f"level {last['level']}, " in line and ("not decided: " in line) is not decided
    assert line.removeprefix("at the end") in report.read_text(encoding="utf-8").replace("\u00a0", " ")

    assert told["level_decided"] is (
        sum([one["weight"] for one in last["candidates"] if one["level"] == last["level"]]) >= 0.995
    )
    marked = end_in_picture(out / "plan.svg")
    if told["level_decided"]:
        assert marked is not None and f"({last['level']})" in marked[0]
        assert marked[1] == ("end" if decided else "likely end")
        floors = [line for line in done.stdout.splitlines() if line.startswith("decided levels: ")]
        assert f"{last['level']} from " in floors[0].rpartition(", ")[2].removeprefix("decided levels: ")
    else:
        assert marked is None or marked[1] == "last known"

    session = Session(floorplan=HOUSE, start=None if not known else type(start)(start.level, start.place), poses=True)
    seen = shown(session.feed(walk.packets) + session.finish())
    page = frame(seen)["place"]
    assert (page["level"], page["decided"]) == (last["level"], decided)
    if decided:
        assert seen.wearer.places.items[-1][1] == last["level"]
    if told["level_decided"]:
        assert seen.wearer.level == last["level"]


def test_the_height_of_a_ride_is_drawn_over_its_time() -> None:
    way, wearer = draw("lift", 3)
    devices = {SITE_OF_FOOT[foot]: Insole(cells=8) for foot in Foot}
    walk = emulate(way.course.route, wearer=wearer, devices=devices, seed=3)
    (ride,) = walk.truth.rides
    session = Session(floorplan=HOUSE, start=way.course.start, poses=True)
    scene = shown(session.feed(walk.packets) + session.finish())
    levels = {level.id: level.elevation for level in HOUSE.levels}
    low, high = levels[way.levels[0]], levels[way.levels[1]]
    for heights, before, after in (
        ([(point[0], point[3]) for point in scene.wearer.track.items], 0.0, high - low),
        ([(point[0], point[4]) for point in scene.wearer.places.items], low, high),
    ):
        assert all([abs(z - before) < 0.3 for t, z in heights if t < ride.start])
        assert all([abs(z - after) < 0.3 for t, z in heights if t > ride.end + 0.8])
        assert len([t for t, _ in heights if ride.start - 0.8 < t < ride.end + 0.8]) >= 2
