"""`solepath plan`: what it prints and draws, and its exit status."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest
from attrs import evolve
from commands import run, run_failing
from floorplans import FILES
from plan_files import format_floorplan
from recordings import recorded
from walks import insoles

from solepath import read_floorplan

HOUSE = FILES / "house.geojson"


def test_a_plan_is_listed_with_its_ids_and_drawn_beside_where_the_command_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = run("plan", HOUSE)
    assert done.returncode == 0 and done.stderr == ""
    lines = [line.split() for line in done.stdout.splitlines()]
    assert ["room", "Corridor", "10.0", "5.0"] in lines
    assert ["stairs,", "lift", "Lift", "14.0", "7.0"] in lines
    assert ["door", "door", "1", "0.0", "5.0"] in lines
    assert "at latitude 48.1500000, longitude 11.5700000; +y points 0.0 degrees clockwise from north" in done.stdout
    assert "nothing needs fixing\ndrawn to house.svg" in done.stdout
    words = [one.text for one in ElementTree.parse(tmp_path / "house.svg").iter() if one.text]
    assert {"Corridor", "Lift", "door 1", "Ground floor (0), 0.0 m", "First floor (1), 3.0 m"} <= set(words)
    assert {"0", "2", "10", "18"} <= set(words), "the grid, m"


def test_levels_are_chosen_and_other_files_stay(tmp_path: Path) -> None:
    picture = tmp_path / "upper.svg"
    done = run("plan", HOUSE, "--levels", "1", "--out", picture)
    assert done.returncode == 0 and "level 1, First floor" in done.stdout and "level 0" not in done.stdout
    assert "Ground floor" not in picture.read_text()
    assert run("plan", HOUSE, "--out", picture).returncode == 0, "its own picture is replaced"
    picture.write_text("<svg/>")
    assert "--force replaces it" in run_failing("plan", HOUSE, "--out", picture)
    assert "there is no level '7'; there are: 0, 1" in run_failing("plan", HOUSE, "--levels", "0,7")
    assert "must end in .svg" in run_failing("plan", HOUSE, "--out", tmp_path / "x.png")
    assert "there is no such file" in run_failing("plan", tmp_path / "none.geojson")


def test_a_bearing_is_printed_in_degrees(tmp_path: Path) -> None:
    file, house = tmp_path / "turned.geojson", read_floorplan(HOUSE)
    assert house.anchor is not None
    file.write_text(format_floorplan(evolve(house, anchor=evolve(house.anchor, bearing=-0.3))))
    done = run("plan", file, "--out", tmp_path / "turned.svg")
    assert "; +y points -17.2 degrees clockwise from north" in done.stdout


def test_what_must_be_mended_comes_first_with_its_number_in_the_picture_and_status_1(tmp_path: Path) -> None:
    house = read_floorplan(HOUSE)
    lift, *others = house.connectors
    file, picture = tmp_path / "broken.geojson", tmp_path / "broken.svg"
    broken = evolve(house, connectors=(evolve(lift, stops=lift.stops[:1]), *others), heights_known=False)
    file.write_text(format_floorplan(broken))
    done = run("plan", file, "--out", picture)
    assert done.returncode == 1
    must, may = done.stdout.split("needs fixing:\n")[1].split("worth knowing:\n")
    first = must.splitlines()[0]
    assert first == "  1. lift 'Lift': stops at level '0' only, at (14.0, 7.0)"
    marks = [one for one in ElementTree.parse(picture).iter() if one.text and one.text == first[5:]]
    assert len(marks) == 1, "the mark says what is wrong when one points at it"
    assert "the plan does not say how high its levels lie" in may


def test_a_number_that_is_a_name_of_another_room_is_no_fault_in_plan_or_track(tmp_path: Path) -> None:
    house = read_floorplan(HOUSE)
    ground = evolve(house.levels[0], room_names=("WC", "Corridor", "WC", "WC 2", ""))
    file = tmp_path / "names.geojson"
    file.write_text(format_floorplan(evolve(house, levels=(ground, *house.levels[1:]))))
    done = run("plan", file, "--out", tmp_path / "names.svg")
    rooms = [line.split("  ")[2:] for line in done.stdout.splitlines() if line.startswith("  room")]
    assert done.stderr == "" and len(rooms) == sum([len(level.rooms) for level in house.levels])
    assert all(name in done.stdout for name in ("WC 1 ", "WC 2 ", "WC 3 ", "room 1 "))
    walk = recorded(tmp_path / "walk.jsonl", insoles().packets[:400])
    assert run("track", walk, "--floorplan", file, "--start", "WC 3").returncode == 0


def test_what_an_importer_found_is_shown_with_its_level_only(tmp_path: Path) -> None:
    content = json.loads(HOUSE.read_text())
    ring = next(one for one in content["features"] if one["properties"].get("name") == "AB")
    ring["geometry"]["coordinates"][0].pop()
    file, picture = tmp_path / "open.geojson", tmp_path / "open.svg"
    file.write_text(json.dumps(content))
    assert "its outline does not close" not in run("plan", file, "--levels", "0", "--out", picture).stdout
    done = run("plan", file, "--levels", "1", "--out", picture)
    assert done.returncode == 1 and "1. level '1': room 'AB' at (" in done.stdout
