"""The way of a wearer as a file for maps, as readers of other people read it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import pairwise
from math import dist, hypot
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from commands import run, run_failing
from floorplans import FILES, degrees
from plan_files import format_floorplan
from recordings import recorded
from walks import insoles

from solepath import Candidate, Event, Placed, PlaceLost, WearerMoved, read_floorplan
from solepath.floorplan.findings import find_findings
from solepath.floorplan.importers.reading import parse_floorplan
from solepath.floorplan.plan import FloorPlan
from solepath.show.export import write_way
from solepath.walk import Walk

HOUSE = read_floorplan(FILES / "house.geojson")
"""A plan with an anchor at 48.15 N, 11.57 E."""
CENTIMETRE = 0.01

Line = list[tuple[float, float]]
"""Longitudes and latitudes, degrees."""


def placed(t: float, level: str, x: float, y: float, *weights: float) -> Placed:
    z = 3.0 * int(level)
    candidates = tuple([Candidate(level=level, position=(x, y, z), heading=0.0, weight=one, origin="")
                        for one in weights or (1.0,)])  # fmt: skip
    return Placed(t=t, known_at=t, level=level, position=(x, y, z), spread=0.3, candidates=candidates)


EVENTS: list[Event] = [
    placed(1.0, "0", 1.0, 5.0, 0.6, 0.4), placed(2.0, "0", 2.0, 5.0, 0.6, 0.4), placed(3.0, "0", 3.25, 5.125),
    placed(4.0, "0", 4.5, 5.25), PlaceLost(t=5.0, known_at=5.0, what="lost"), placed(6.0, "0", 14.0, 6.5),
    placed(7.0, "0", 14.0, 7.0), placed(9.0, "1", 14.0, 7.0), placed(10.0, "1", 19.0, -8.0),
    placed(11.0, "0", 7.0, 7.0),
]  # fmt: skip
STRETCHES = [[(1.0, 5.0), (2.0, 5.0)], [(3.25, 5.125), (4.5, 5.25)], [(14.0, 6.5), (14.0, 7.0)],
             [(14.0, 7.0), (19.0, -8.0)], [(7.0, 7.0)]]  # fmt: skip
NAMES = ["level 0, not decided", "level 0", "level 0", "level 1", "level 0"]


def from_json(path: Path) -> Iterator[tuple[str, Line]]:
    for one in json.loads(path.read_text())["features"]:
        places = one["geometry"]["coordinates"]
        decided = "" if one["properties"]["decided"] else ", not decided"
        line = places if one["geometry"]["type"] == "LineString" else [places]
        yield f"level {one['properties']['level']}{decided}", [(x, y) for x, y in line]


def from_gpx(path: Path) -> Iterator[tuple[str, Line]]:
    gpxpy = pytest.importorskip("gpxpy", reason="gpxpy reads GPX: it is in the extra test")
    for track in gpxpy.parse(path.read_text()).tracks:
        (segment,) = track.segments
        yield track.name, [(one.longitude, one.latitude) for one in segment.points]


def from_kml(path: Path) -> Iterator[tuple[str, Line]]:
    fastkml = pytest.importorskip("fastkml", reason="fastkml reads KML: it is in the extra test")
    (document,) = fastkml.kml.KML.parse(path).features
    for one in document.features:
        yield one.name, [(x, y) for x, y, _ in one.geometry.coords]


def moved(plan: FloorPlan, x: float, y: float) -> FloorPlan:
    """Return the plan, so far to the right and up."""

    def by(value: Any) -> Any:
        return [value[0] + x, value[1] + y] if isinstance(value[0], int | float) else [by(one) for one in value]

    content = json.loads(format_floorplan(plan))
    for one in content["features"]:
        if one["geometry"]:
            one["geometry"]["coordinates"] = by(one["geometry"]["coordinates"])
        if "place" in one["properties"]:
            one["properties"]["place"] = by(one["properties"]["place"])
    return parse_floorplan(json.dumps(content).encode())


@pytest.mark.parametrize(("ending", "read"), [(".geojson", from_json), (".gpx", from_gpx), (".kml", from_kml)])
def test_other_peoples_readers_find_the_same_points_to_a_centimetre(ending: str, read, tmp_path: Path) -> None:
    path = tmp_path / f"way{ending}"
    assert write_way(path, Walk.of(EVENTS), HOUSE) == 9
    found = list(read(path))
    assert [name for name, _ in found] == NAMES
    for (_, line), stretch in zip(found, STRETCHES, strict=True):
        for (longitude, latitude), place in zip(line, stretch, strict=True):
            expected = degrees(place)
            north, east = (latitude - expected[0]) * 111193.24, (longitude - expected[1]) * 74408.77
            assert hypot(north, east) < CENTIMETRE


def test_geojson_has_metres_and_says_so_where_the_plan_has_no_anchor(tmp_path: Path) -> None:
    from attrs import evolve

    local = evolve(HOUSE, anchor=None)
    path = tmp_path / "way.geojson"
    write_way(path, Walk.of(EVENTS), local, made_by={"solepath": "1"})
    content = json.loads(path.read_text())
    assert "metres, not longitude and latitude" in content["note"] and content["solepath"] == {"solepath": "1"}
    assert [line for _, line in from_json(path)] == STRETCHES
    assert content["features"][3]["properties"] == {
        "level": "1", "decided": True, "times_s": [9.0, 10.0], "z_m": [3.0, 3.0]}  # fmt: skip
    for ending in (".gpx", ".kml"):
        with pytest.raises(ValueError, match="needs longitude and latitude, so a floor plan with an anchor"):
            write_way(tmp_path / f"way{ending}", Walk.of(EVENTS), local)
    with pytest.raises(ValueError, match="must end in .geojson, .gpx, .kml"):
        write_way(tmp_path / "way.shp", Walk.of(EVENTS), HOUSE)


def test_every_file_says_how_it_came_about(tmp_path: Path) -> None:
    made = {"solepath": "1", "recipe": "default", "recipe_sha256": "ab", "inputs": [{"name": "é.csv", "sha256": "cd"}]}
    for ending in (".geojson", ".gpx", ".kml"):
        write_way(tmp_path / f"way{ending}", Walk.of(EVENTS), HOUSE, made_by=made)
    assert json.loads((tmp_path / "way.geojson").read_text())["solepath"] == made
    for ending, name in ((".gpx", "{*}metadata/{*}desc"), (".kml", "{*}Document/{*}description")):
        text = ElementTree.parse(tmp_path / f"way{ending}").findtext(name)
        assert text is not None and json.loads(text) == made


def test_a_plan_in_a_national_grid_has_metres_though_it_has_an_anchor(tmp_path: Path) -> None:
    far = moved(HOUSE, 691_000.0, 5_333_000.0)
    assert HOUSE.has_degrees and not far.has_degrees
    (finding,) = [one.text for one in find_findings(far) if "longitude" in one.text]
    assert finding.startswith("the plan has no longitude and latitude")
    write_way(tmp_path / "way.geojson", Walk.of(EVENTS), far)
    assert "metres" in json.loads((tmp_path / "way.geojson").read_text())["note"]
    walk, file = recorded(tmp_path / "walk.jsonl", insoles().packets[:400]), tmp_path / "far.geojson"
    file.write_text(format_floorplan(far))
    out = tmp_path / "out"
    done = run("track", walk, "--floorplan", file, "--out", out, "--export", tmp_path / "way.gpx")
    assert done.returncode == 2 and "needs longitude and latitude" in done.stderr.splitlines()[-1]
    assert not out.exists(), "it is said before the walk is computed"
    listed = run("plan", file, "--out", tmp_path / "far.svg").stdout
    assert (
        finding in listed
        and "no longitude and latitude, which .gpx and .kml need" in listed
        and "x 0, y 0 is at latitude" not in listed
    )


def test_without_a_plan_the_way_is_the_track_from_the_start(tmp_path: Path) -> None:
    moved = [WearerMoved(t=t, known_at=t, position=(1.2 * t, 0.5, 0.1), covariance=(0.0,) * 6) for t in (1.0, 2.0, 3.0)]
    write_way(tmp_path / "way.geojson", Walk.of(moved))
    (feature,) = json.loads((tmp_path / "way.geojson").read_text())["features"]
    assert feature["geometry"] == {"type": "LineString", "coordinates": [[1.2, 0.5], [2.4, 0.5], [3.6, 0.5]]}
    assert feature["properties"]["level"] is None
    assert write_way(tmp_path / "none.geojson", Walk.of([])) == 0


def test_track_writes_the_way_and_says_where(tmp_path: Path) -> None:
    walk = recorded(tmp_path / "walk.jsonl", insoles().packets)
    way = tmp_path / "way.geojson"
    done = run("track", walk, "--export", way)
    assert done.returncode == 0 and f"way in {way}; coordinates are x and y in metres" in done.stdout
    (feature,) = json.loads(way.read_text())["features"]
    times = feature["properties"]["times_s"]
    assert len(times) > 2 and times == sorted(times)
    assert max([dist(a, b) for a, b in pairwise(feature["geometry"]["coordinates"])]) < 2.0
    assert run("track", walk, "--export", way).returncode == 0, "its own file is replaced"
    way.write_text('{"type": "FeatureCollection", "features": []}')
    assert "--force replaces it" in run_failing("track", walk, "--export", way)
    gpx = tmp_path / "way.gpx"
    assert "needs longitude and latitude" in run_failing("track", walk, "--export", gpx)
    assert not gpx.exists()
    plan = FILES / "house.geojson"
    done = run("track", walk, "--floorplan", plan, "--start", "0,Corridor,0", "--export", gpx)
    assert done.returncode == 0 and f"way in {gpx}" in done.stdout
    assert '<trkpt lat="48.150' in gpx.read_text()
