"""The picture of a floor plan with the track on it, and the commands that write it."""

from __future__ import annotations

import csv
import json
from math import degrees
from pathlib import Path
from xml.etree import ElementTree

import pytest
from commands import run, run_failing
from floorplans import FILES
from floors import Pedestrian, follow, indexed_office, office, tour
from plan_files import format_floorplan
from recordings import recorded
from views import told
from walks import insoles

from solepath import Placed, PlaceLost, read_floorplan
from solepath.body.part import StartGiven
from solepath.cli.common.failure import Failure
from solepath.cli.common.inputs import start_of
from solepath.floorplan.plan import Connector, ConnectorKind, ConnectorStop, FloorPlan, Level, Start, Wall, with_rooms
from solepath.place.placing import Particles
from solepath.show.tables.plan import PlanPicture
from solepath.show.tables.summary import place_lines
from solepath.walk.places import PlaceCounts

SVG = "{http://www.w3.org/2000/svg}"


def pictured(plan: FloorPlan, one: Pedestrian, start: Start | None = None) -> ElementTree.Element:
    part = Particles()
    if start is not None:
        told(part, StartGiven(start))
    events = [event for event in follow(part, one.received) if isinstance(event, Placed | PlaceLost)]
    picture = PlanPicture(plan, events)
    return ElementTree.fromstring(ElementTree.tostring(picture.drawn("a tour <of two> floors & a lift")))


def words(svg: ElementTree.Element) -> list[str]:
    return [text.text or "" for text in svg.iter() if text.tag.endswith("text")]


def test_the_picture_has_a_panel_for_every_level_a_scale_and_where_the_wearer_was_found_and_ended() -> None:
    svg = pictured(office(), tour(7))
    received = words(svg)
    assert "a tour <of two> floors & a lift" in received
    assert {"floor 0 (0), 0.0 m", "floor 1 (1), 3.6 m", "candidate", "stairs", "lift"} <= set(received)
    assert {"found", "end", "5 m"} <= set(received)
    assert "N" not in received, "without an anchor nobody knows where north is"
    tracks = [line for line in svg.iter() if line.tag.endswith("polyline")]
    assert len({line.get("stroke") for line in tracks}) > 5, "coloured by time"
    dots = [float(dot.get("fill-opacity", "1")) for dot in svg.iter() if dot.get("r") == "2.2"]
    assert len(dots) > 50 and min(dots) < 0.15 < max(dots), "candidates are the fainter the less likely"


def test_the_summary_has_the_time_at_which_the_wearer_was_found_and_the_levels() -> None:
    part, places = Particles(), PlaceCounts()
    for received in tour(7).received:
        for event in [*received.events, *part.follow(indexed_office(), received.events, received.here)]:
            places.add(event)
    assert places.last is not None and places.last.level == "1"
    lines = place_lines(places)
    assert lines[0].startswith("place: found after ") and " strides, at " in lines[0]
    assert lines[1].startswith("at the end: level 1, (") and "within" in lines[1]
    assert lines[2].startswith("decided levels: 0 from ") and ", 1 from " in lines[2]
    assert lines[3].endswith("no start was given, so the place is not known before the first stairs or lift")


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return recorded(tmp_path_factory.mktemp("walk") / "walk.jsonl", insoles(cells=12).packets)


@pytest.fixture(scope="module")
def hall(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("plan") / "hall.geojson"
    corners = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.0)]
    walls = tuple(Wall(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True))
    levels = tuple(
        with_rooms(Level(str(k), f"floor {k}", k, 3.0 * k, walls), [(tuple(corners), f"hall {k + 1}")]) for k in (0, 1)
    )
    stops = tuple(ConnectorStop(level.id, (28.0, 18.0)) for level in levels)
    path.write_text(format_floorplan(FloorPlan("hall", levels, (Connector(ConnectorKind.STAIRS, "stairs", stops),))))
    return path


def test_track_writes_places_and_the_picture_and_prints_where_the_wearer_is(
    walk: Path, hall: Path, tmp_path: Path
) -> None:
    done = run("track", walk, "--floorplan", hall, "--start", "0,10,10,30", "--out", tmp_path)
    assert done.returncode == 0
    assert "place: found after" in done.stdout and "at the end: level 0, hall 1, (1" in done.stdout
    with (tmp_path / "places.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) >= 4 and {(row["level"], row["room"]) for row in rows} == {("0", "hall 1")}
    assert all(0.0 < float(row["x_m"]) < 30.0 and row["candidates"] == "1" for row in rows)
    assert abs(float(rows[-1]["frame_heading_deg"]) - 30.0) < 12.0
    events = [json.loads(line) for line in (tmp_path / "events.jsonl").read_text().splitlines()]
    assert [event["room"] for event in events if event["event"] == "Placed"] == [row["room"] for row in rows]
    svg = ElementTree.parse(tmp_path / "plan.svg").getroot()
    assert svg.tag == f"{SVG}svg" and "walk.jsonl, recipe default" in words(svg)


def test_a_floor_plan_or_a_start_that_cannot_be_used_is_rejected_in_one_line(
    walk: Path, hall: Path, tmp_path: Path
) -> None:
    assert "give --floorplan, too" in run_failing("track", walk, "--start", "0,1,2")
    nonsense = tmp_path / "plan.geojson"
    nonsense.write_text("[1, 2")
    assert "plan.geojson" in run_failing("track", walk, "--floorplan", nonsense)
    assert "there is no such file" in run_failing("track", walk, "--floorplan", tmp_path / "none.geojson")
    assert "the plan has no level '7', only 0, 1" in run_failing("track", walk, "--floorplan", hall, "--start", "7,1,2")
    assert "(99, 2) is nowhere on level 0" in run_failing("track", walk, "--floorplan", hall, "--start", "0,99,2")
    assert "is not LEVEL,X,Y" in run_failing("track", walk, "--floorplan", hall, "--start", "0,one,2")
    assert "did you mean stairs" in run_failing("track", walk, "--floorplan", hall, "--start", "stair")
    assert "'stairs' is on several levels" in run_failing("track", walk, "--floorplan", hall, "--start", "stairs")


def test_the_first_things_that_are_wrong_with_a_plan_are_printed_and_the_number_of_the_others(
    walk: Path, hall: Path, tmp_path: Path
) -> None:
    plan = read_floorplan(hall)
    lone = [Connector(ConnectorKind.LIFT, f"lift {k}", (ConnectorStop("0", (3.0 * k, 5.0)),)) for k in range(1, 6)]
    many = tmp_path / "many.geojson"
    many.write_text(format_floorplan(FloorPlan("hall", plan.levels, (*plan.connectors, *lone))))
    done = run("track", walk, "--floorplan", many, "--start", "0,10,10,30")
    assert done.returncode == 0
    *first, more = [line.partition(f"{many}: ")[2] for line in done.stderr.splitlines()]
    assert first == [f"lift 'lift {k}': stops at level '0' only, at ({3 * k:.1f}, 5.0)" for k in (1, 2, 3)]
    assert more == f"2 more: solepath plan {many}"


BUILDING = read_floorplan(FILES / "house.geojson")


def test_a_start_is_read_with_and_without_heading_and_commas_in_the_name_of_a_level() -> None:
    assert start_of("0,12.5,-3", BUILDING) == Start("0", (12.5, -3.0))
    turned = start_of("ground floor, 1, 2, 90", BUILDING)
    assert turned.level == "ground floor" and degrees(turned.heading or 0.0) == pytest.approx(90.0)
    assert start_of("wing B, east,1,2", BUILDING) == Start("wing B, east", (1.0, 2.0))
    assert degrees(start_of("heading=-90", BUILDING).heading or 0.0) == pytest.approx(-90.0)


def test_a_start_may_be_a_place_of_the_plan_with_its_level_where_several_have_it() -> None:
    walls = BUILDING.levels[0].walls
    ring = ((1.0, 1.0), (4.0, 1.0), (4.0, 3.0), (1.0, 3.0))
    ground = with_rooms(Level("0", "", 0, 0.0, walls), [(ring, "office"), (ring, "101"), (ring, "WC, east")])
    upper = with_rooms(Level("wing B, up", "", 1, 3.0, walls), [(ring, "office"), (ring, "attic")])
    plan = FloorPlan("", (ground, upper))
    for text, level, heading in (
        ("attic", "wing B, up", None), ("attic,90", "wing B, up", 90.0), ("0,office", "0", None),
        ("0, office, -45", "0", -45.0), ("wing B, up,office,10", "wing B, up", 10.0), ("101", "0", None),
        ("0,101", "0", None), ("101,30", "0", 30.0), ("WC, east", "0", None), ("0,WC, east,5", "0", 5.0),
    ):  # fmt: skip
        start = start_of(text, plan)
        assert (start.level, start.place) == (level, (2.5, 2.0)), text
        assert (start.heading is None) == (heading is None)
        assert heading is None or degrees(start.heading or 0.0) == pytest.approx(heading)
    with pytest.raises(Failure, match="'office' is on several levels: '0', 'wing B, up'; put the level before it"):
        start_of("office", plan)
    with pytest.raises(Failure, match="there is no place 'atic': did you mean attic"):
        start_of("atic", plan)
    with pytest.raises(Failure, match="there is no place 'attic'; there are: office, 101, WC, east"):
        start_of("0,attic", plan)
