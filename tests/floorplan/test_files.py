"""Files of floor plans: the house of protocol/floorplans in every format, files that are none, and any bytes."""

from __future__ import annotations

import json
import struct
import zipfile
from pathlib import Path
from typing import Any

import pytest
from floorplans import FILES, archive, plans
from hypothesis import given
from hypothesis import strategies as st
from plan_files import format_floorplan

from solepath.floorplan.findings import find_warnings
from solepath.floorplan.geometry import contains, edges
from solepath.floorplan.importers import reading
from solepath.floorplan.importers.reading import parse_floorplan, read_floorplan
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Anchor, ConnectorKind, FloorPlan, FloorPlanError, PlanFinding

HOUSE = read_floorplan(FILES / "house.geojson")
INVALID = json.loads((FILES / "invalid.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", ["house-wgs84.geojson", "house.osm", "house-imdf"])
def test_the_house_is_the_same_in_every_format(name: str) -> None:
    plan = read_floorplan(FILES / name)
    assert plan == HOUSE
    assert plan.fingerprint == HOUSE.fingerprint
    assert plan.remarks == ()


def test_the_house_is_what_it_looks_like() -> None:
    assert HOUSE.anchor == Anchor(48.15, 11.57, 0.0)
    assert [(level.id, level.name, level.ordinal) for level in HOUSE.levels] == [("0", "Ground floor", 0),
                                                                               ("1", "First floor", 1)]  # fmt: skip
    assert [(c.kind, c.name, [stop.level for stop in c.stops]) for c in HOUSE.connectors] == [
        (ConnectorKind.LIFT, "Lift", ["0", "1"]), (ConnectorKind.STAIRS, "Stairs", ["0", "1"])]  # fmt: skip
    assert not HOUSE.heights_known
    plan = IndexedPlan(HOUSE)
    assert not plan.crosses(0, -0.5, 5.0, 0.5, 5.0)  # in at the entrance,
    assert not plan.crosses(0, 0.5, 5.0, 11.5, 5.0)  # down the corridor
    assert not plan.crosses(0, 11.5, 5.0, 11.5, 8.0)  # and onto the stairs
    assert plan.crosses(0, 9.0, 5.0, 9.0, 7.0)
    assert plan.crosses(1, -0.5, 5.0, 0.5, 5.0)  # upstairs there is no entrance
    assert not plan.crosses(1, 7.0, 2.0, 9.0, 2.0)  # and one room where there were two
    assert plan.crosses(0, 7.0, 2.0, 9.0, 2.0)


@pytest.mark.parametrize("case", INVALID["cases"], ids=[one["id"] for one in INVALID["cases"]])
def test_a_file_that_does_not_fit_is_rejected_with_the_reason(case: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "plan"
    path.write_bytes(archive(case["files"]) if "files" in case else case["text"].encode())
    with pytest.raises(FloorPlanError) as caught:
        read_floorplan(path)
    assert str(caught.value) == f"{path}: {case['says']}"


@given(plans())
def test_a_plan_written_and_read_again_is_equal(plan: FloorPlan) -> None:
    again = parse_floorplan(format_floorplan(plan).encode())
    assert again == plan
    assert again.fingerprint == plan.fingerprint


def geojson(*more: dict[str, Any], **members: Any) -> bytes:
    level = {"type": "Feature", "id": "0", "properties": {"feature": "level", "ordinal": 0}, "geometry": None}
    head = {"type": "FeatureCollection", "format": "solepath-floorplan", "version": 1, "frame": "local", **members}
    return json.dumps({**head, "features": [level, *more]}).encode()


def feature(kind: str, geometry: str, coordinates: Any, **properties: Any) -> dict[str, Any]:
    return {"type": "Feature", "properties": {"feature": kind, "level": "0", **properties},
            "geometry": {"type": geometry, "coordinates": coordinates}}  # fmt: skip


SQUARE = [[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]]


def test_the_example_of_the_document_is_a_plan() -> None:
    text = (FILES.parent / "floorplan.md").read_text(encoding="utf-8").split("```json")[1].split("```")[0]
    plan = parse_floorplan(text.strip().encode())
    assert not IndexedPlan(plan).crosses(0, 3.5, -0.5, 3.5, 0.5)
    assert find_warnings(plan) == ("lift 'A': stops at level '0' only, at (7.0, 4.0)",)


SAME_IDS = [
    (
        [feature("room", "Polygon", [SQUARE]), feature("door", "LineString", [[4, 0], [5, 0]])],
        "two features have the id 'r1': room on level '0' at (0, 0), and door on level '0' at (4, 0)",
    ),
    (
        [{"type": "Feature", "properties": {"feature": "level", "ordinal": k}, "geometry": None} for k in (1, 2)],
        "two features have the id 'r1': level, feature 2 of the file, and level, feature 3 of the file",
    ),
]


@pytest.mark.parametrize(("both", "message"), SAME_IDS)
def test_two_features_with_one_id_are_named_with_what_and_where_they_are(
    both: list[dict[str, Any]], message: str
) -> None:
    with pytest.raises(FloorPlanError) as caught:
        parse_floorplan(geojson(*[one | {"id": "r1"} for one in both]))
    assert str(caught.value) == message


def test_a_bearing_that_cannot_be_may_be_in_degrees() -> None:
    with pytest.raises(FloorPlanError) as caught:
        parse_floorplan(geojson(anchor={"latitude": 48.0, "longitude": 11.0, "bearing": 17}))
    assert str(caught.value) == "its anchor's bearing is 17; it can be -10 to 10 rad; were degrees meant?"


STEPPED = [
    # what each stop says of flights and rise, and what is known of the connector; None where they disagree
    ([{"flights": 2, "rise": 0.17}, {"flights": 2, "rise": 0.17}], (2, 0.17)),
    ([{"flights": 2}, {"rise": 0.17}], (2, 0.17)),
    ([{"flights": 1}, {}], (1, None)),
    ([{}, {"rise": 0.17}], (None, 0.17)),
    ([{}, {}], (None, None)),
    ([{"flights": 1, "rise": 0.17}, {"flights": 2, "rise": 0.17}], None),
    ([{"flights": 2, "rise": 0.16}, {"flights": 2, "rise": 0.17}], None),
    ([{"flights": 2}, {"flights": 2}, {"flights": 1}], None),
    ([{"rise": 0.17}, {}, {"rise": 0.16}], None),
]
"""Stairs by their stops, one on each level."""


@pytest.mark.parametrize(("stops", "known"), STEPPED)
def test_the_stops_of_stairs_agree_on_flights_and_rise_and_one_that_says_nothing_agrees(
    stops: list[dict[str, float]], known: tuple[int | None, float | None] | None
) -> None:
    levels = [{"type": "Feature", "id": str(k), "properties": {"feature": "level", "ordinal": k}, "geometry": None}
              for k in range(1, len(stops))]  # fmt: skip
    stairs = [feature("stairs", "Point", [1, 1], level=str(k), name="A", **said) for k, said in enumerate(stops)]
    other = [feature("stairs", "Point", [5, 5], level=str(k), name="B", flights=3, rise=0.2) for k in range(2)]
    data = geojson(*levels, *stairs, *other)
    if known is None:
        with pytest.raises(FloorPlanError, match="its stops tell different flights or rises"):
            parse_floorplan(data)
        return
    found = [(one.flights, one.rise) for one in parse_floorplan(data).connectors]
    assert found == [known, (3, 0.2)], "stairs with another name say nothing about these"


@pytest.mark.parametrize(("value", "text"), [
    ("Hall", "Hall"), ("", ""), (None, ""), (7, "7"), (7.0, "7"), (0.5, "0.5"), (-7, "-7"), (999_999_999, "999999999"),
    (1_000_000_000, None), (-1_000_000_000, None), (1e300, None), (True, None), (["Hall"], None), ({}, None),
])  # fmt: skip
@pytest.mark.parametrize("kind", ["door", "lift"])
def test_a_name_is_a_text_or_a_number_that_can_be_one(kind: str, value: Any, text: str | None) -> None:
    named = {"door": feature("door", "LineString", [[2, 0], [3, 0]], name=value),
             "lift": feature("lift", "Point", [1, 1], name=value, connector="a")}[kind]  # fmt: skip
    data = geojson(feature("wall", "Polygon", [SQUARE]), named)
    if text is None:
        with pytest.raises(FloorPlanError, match=" at .*: its name is .*, not a text"):
            parse_floorplan(data)
        return
    plan = parse_floorplan(data)
    assert [one.name for one in (*plan.levels[0].doors, *plan.connectors)] == [text]


SHAPES = {
    # corners, and where one steps on: the middle of area, or beside it in the wider arm
    "a square": ([[0, 0], [4, 0], [4, 4], [0, 4]], (2.0, 2.0)),
    "a triangle": ([[0, 0], [6, 0], [0, 6]], (2.0, 2.0)),
    "a U with a wide right arm": ([[0, 0], [9, 0], [9, 9], [6, 9], [6, 1], [1, 1], [1, 9], [0, 9]], (7.5, None)),
    "a U with a wide left arm": ([[0, 0], [9, 0], [9, 9], [8, 9], [8, 1], [3, 1], [3, 9], [0, 9]], (1.5, None)),
}  # fmt: skip


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("clockwise", [False, True])
def test_one_steps_into_a_cabin_of_any_shape_within_it(shape: str, clockwise: bool) -> None:
    corners, (x, y) = SHAPES[shape]
    ring = [[a + 20.0, b - 7.0] for a, b in (corners[::-1] if clockwise else corners)]
    lift = feature("lift", "Polygon", [[*ring, ring[0]]], name="A")
    (stop,) = parse_floorplan(geojson(feature("wall", "Polygon", [SQUARE]), lift)).connectors[0].stops
    assert contains(edges(stop.outline), *stop.place)
    assert stop.place[0] == pytest.approx(x + 20.0) and (y is None or stop.place[1] == pytest.approx(y - 7.0))


def test_a_room_with_a_hole_does_not_hold_what_is_in_the_hole() -> None:
    hole = [[4, 4], [6, 4], [6, 6], [4, 6], [4, 4]]
    plan = IndexedPlan(parse_floorplan(geojson(feature("wall", "Polygon", [SQUARE]),
                                             feature("room", "Polygon", [SQUARE, hole]))))  # fmt: skip
    assert not plan.inside(0, 5.0, 5.0)
    for x, y in ((2.0, 2.0), (5.0, 2.0), (8.0, 8.0), (3.9, 5.0), (5.0, 6.1)):
        assert plan.inside(0, x, y)


def test_an_outline_that_does_not_close_is_a_room_and_remarked() -> None:
    room = [[0, 0], [10, 0], [10, 10], [0, 10], [0, 1]]
    plan = parse_floorplan(geojson(feature("wall", "Polygon", [SQUARE]), feature("room", "Polygon", [room])))
    remark = "level '0': room at (0, 0): its outline does not close, it ends at (0.0, 1.0), 1.00 m from where it begins"
    assert plan.remarks == (PlanFinding(remark, True, "0", (0.0, 1.0)),)
    assert remark in find_warnings(plan)
    assert IndexedPlan(plan).inside(0, 5.0, 5.0)


def test_levels_without_elevations_lie_a_storey_apart_and_nobody_may_rely_on_it() -> None:
    upper = {"type": "Feature", "id": 1, "properties": {"feature": "level", "ordinal": 1}, "geometry": None}
    data = geojson(upper, feature("wall", "LineString", SQUARE), feature("lift", "Point", [1, 1], connector="a"),
                   feature("lift", "Point", [1, 2], level=1, connector="a", name="A"))  # fmt: skip
    plan = parse_floorplan(data, storey=4.0)
    assert [level.elevation for level in plan.levels] == [0.0, 4.0]
    assert not plan.heights_known
    assert [stop.place for stop in plan.connectors[0].stops] == [(1.0, 1.0), (1.0, 2.0)]
    with pytest.raises(FloorPlanError, match="^a storey of 0.1 m cannot be$"):
        parse_floorplan(data, storey=0.1)


def imdf_files() -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted((FILES / "house-imdf").iterdir())}


@pytest.mark.parametrize("compression", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
@pytest.mark.parametrize("folder", ["", "house/"])
def test_an_archive_reads_as_its_folder_does(folder: str, compression: int) -> None:
    other = {"../outside.json": b"{}", "__MACOSX/manifest.txt": b"\x00"}
    packed = archive({**{f"{folder}{name}": data for name, data in imdf_files().items()}, **other}, "", compression)
    assert parse_floorplan(packed) == HOUSE


def test_a_bomb_is_not_unpacked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "MAX_FILE_SIZE", 100_000)
    bomb = archive({**imdf_files(), "unit.geojson": b" " * 10_000_000})
    assert len(bomb) < 100_000
    with pytest.raises(FloorPlanError, match="unpacked it is larger than"):
        parse_floorplan(bomb)


def test_a_damaged_or_strangely_packed_archive_is_rejected() -> None:
    packed = archive(imdf_files())
    for damaged in (packed[: len(packed) // 2], b"PK\x03\x04", packed[:200] + b"\xff" * 50 + packed[250:]):
        with pytest.raises(FloorPlanError):
            parse_floorplan(damaged)
    with pytest.raises(FloorPlanError, match="manifest.json: is packed in a way that IMDF does not know"):
        parse_floorplan(archive(imdf_files(), "", zipfile.ZIP_LZMA))
    locked = bytearray(packed)
    for at in (packed.find(b"PK\x03\x04") + 6, packed.find(b"PK\x01\x02") + 8):
        locked[at : at + 2] = struct.pack("<H", 1)  # says that it is encrypted
    with pytest.raises(FloorPlanError, match="damaged archive"):
        parse_floorplan(bytes(locked))


def test_unreadable_files_are_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(FloorPlanError, match="No such file or directory$"):
        read_floorplan(tmp_path / "none.json")
    with pytest.raises(FloorPlanError, match="has no manifest.json"):
        read_floorplan(tmp_path)
    with pytest.raises(FloorPlanError, match="/dev/zero: is larger than 32 MB, too large for a floor plan$"):
        read_floorplan("/dev/zero")
    monkeypatch.setattr(reading, "MAX_FILE_SIZE", 1000)
    with pytest.raises(FloorPlanError, match="too large for a floor plan$"):
        read_floorplan(FILES / "house.geojson")


def reads_or_rejects(data: bytes) -> None:
    try:
        plan = parse_floorplan(data)
    except FloorPlanError as error:
        assert "\n" not in str(error)
    else:
        IndexedPlan(plan)


@given(st.binary(max_size=200), st.sampled_from([b"", b"{", b"<osm>", b"PK\x03\x04", b"\xff\xfe", b"\xef\xbb\xbf{"]))
def test_any_bytes_are_a_plan_or_rejected(data: bytes, prefix: bytes) -> None:
    reads_or_rejects(prefix + data)
