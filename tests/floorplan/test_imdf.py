"""IMDF archives, feature by feature."""

from __future__ import annotations

import json
from typing import Any

import pytest
from floorplans import FILES, archive, degrees
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.floorplan.importers.reading import parse_floorplan, read_floorplan
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import ConnectorKind, FloorPlan

HOUSE = read_floorplan(FILES / "house.geojson")


def box(x0: float, y0: float, x1: float, y1: float) -> list[list[list[float]]]:
    return [[[*degrees(place)[::-1]] for place in ((x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0))]]


def feature(kind: str, own: str, geometry: str, coordinates: Any, **properties: Any) -> dict[str, Any]:
    return {"type": "Feature", "id": own, "feature_type": kind, "properties": properties,
            "geometry": {"type": geometry, "coordinates": coordinates}}  # fmt: skip


def level(own: str = "L0", ordinal: int = 0, **more: Any) -> dict[str, Any]:
    return feature("level", own, "Polygon", box(0, 0, 20, 10), ordinal=ordinal, **more)


def unit(own: str, category: str, coordinates: Any, at: str = "L0", geometry: str = "Polygon",
         **more: Any) -> dict[str, Any]:  # fmt: skip
    return feature("unit", own, geometry, coordinates, category=category, level_id=at, **more)


def plan_of(units: list[dict[str, Any]], levels: list[dict[str, Any]] | None = None, language: str = "en",
            **others: list[dict[str, Any]]) -> FloorPlan:  # fmt: skip
    files = {"level": levels or [level()], "unit": units, **others}
    collections = {f"{name}.geojson": {"type": "FeatureCollection", "features": some} for name, some in files.items()}
    return parse_floorplan(archive({"manifest.json": {"version": "1.0.0", "language": language}, **collections}))


def test_the_outline_of_a_level_is_a_wall_unless_it_is_outdoors() -> None:
    assert IndexedPlan(plan_of([])).crosses(0, 5.0, -0.5, 5.0, 0.5)
    room = [unit("u", "room", box(5, 5, 10, 8))]
    assert not IndexedPlan(plan_of(room, [level(outdoor=True)])).crosses(0, 5.0, -0.5, 5.0, 0.5)


@pytest.mark.parametrize(("category", "walled", "inside"), [
    ("room", True, True), ("unheard-of", True, True), ("structure", True, False), ("walkway", False, True),
    ("stairs", False, True), ("elevator", False, True),
])  # fmt: skip
def test_the_category_of_a_unit_decides_whether_a_walkway_is_open_to_it(
    category: str, walled: bool, inside: bool
) -> None:
    plan = IndexedPlan(plan_of([unit("w", "walkway", box(0, 0, 20, 5)), unit("u", category, box(4, 5, 8, 9))]))
    assert plan.crosses(0, 6.0, 4.0, 6.0, 6.0) == walled
    assert plan.inside(0, 6.0, 7.0) == inside
    assert plan.crosses(0, 12.0, 4.0, 12.0, 6.0)  # a walkway that borders on nothing ends at a wall


def test_lifts_are_joined_where_they_lie_over_each_other_and_stop_where_they_are_shown() -> None:
    levels = [level("L0", 0, short_name={"en": "G"}), level("L1", 1, short_name={"en": "1"}),
              level("L2", 2, short_name={"en": "2"})]  # fmt: skip
    shown = {"type": "Point", "coordinates": [*degrees((3.5, 2.5))[::-1]]}
    units = [unit(f"a{i}", "elevator", box(2, 2, 4, 4), f"L{i}", name={"en": "A"}, display_point=shown)
             for i in (2, 0, 1)]  # fmt: skip
    units += [unit(f"b{i}", "elevator", box(4, 2, 6, 4), f"L{i}", name={"en": "B"}) for i in (0, 1)]
    units += [unit("s", "stairs", box(2, 2, 4, 4), "L1")]
    found = plan_of(units, levels).connectors
    assert [(one.kind, one.name, [(stop.level, stop.place) for stop in one.stops]) for one in found] == [
        (ConnectorKind.LIFT, "A", [("G", (3.5, 2.5)), ("1", (3.5, 2.5)), ("2", (3.5, 2.5))]),
        (ConnectorKind.LIFT, "B", [("G", (5.0, 3.0)), ("1", (5.0, 3.0))]),
        (ConnectorKind.STAIRS, "", [("1", (3.0, 3.0))]),
    ]


@pytest.mark.parametrize(("language", "name"), [("de", "Halle"), ("de-CH", "Halle"), ("en-US", "Hall"), ("fr", "Hall")])
def test_names_are_in_the_language_of_the_archive_or_in_english(language: str, name: str) -> None:
    found = plan_of([], [level(name={"de": "Halle", "en": "Hall", "aa": "?"})], language)
    assert found.levels[0].name == name


def test_levels_lie_a_storey_apart_by_their_ordinals_whatever_their_order() -> None:
    found = plan_of([], [level("up", 2), level("down", -1), level("ground", 0)])
    assert [(one.id, one.ordinal, one.elevation) for one in found.levels] == [
        ("down", -1, -3.0), ("ground", 0, 0.0), ("up", 2, 6.0)]  # fmt: skip


@settings(max_examples=25)
@given(st.data())
def test_the_order_and_the_sense_in_which_a_map_was_drawn_make_no_difference(data: st.DataObject) -> None:
    folder = sorted((FILES / "house-imdf").iterdir())
    files: dict[str, Any] = {path.name: json.loads(path.read_text()) for path in folder}
    for name in ("level.geojson", "unit.geojson", "opening.geojson"):
        drawn = files[name]["features"] = data.draw(st.permutations(files[name]["features"]))
        for one in drawn:
            shape = one["geometry"]
            if shape["type"] == "LineString":
                shape["coordinates"] = shape["coordinates"][:: data.draw(st.sampled_from([1, -1]))]
                continue
            ring = shape["coordinates"][0][:-1]
            first = data.draw(st.integers(0, len(ring) - 1))
            turned = (ring[first:] + ring[:first])[:: data.draw(st.sampled_from([1, -1]))]
            shape["coordinates"] = [[*turned, turned[0]]]
    assert parse_floorplan(archive(files)) == HOUSE


def named_level(own: str, short: str, building: str, ordinal: int) -> dict[str, Any]:
    return level(own, ordinal, short_name={"en": short}, name={"en": f"Floor {short}"}, building_ids=[building])


def test_levels_of_several_buildings_have_readable_ids_with_the_names_of_their_buildings() -> None:
    levels = [named_level("a2", "2", "A", 1), named_level("b1", "1", "B", 0), named_level("a1", "1", "A", 0)]
    buildings = [feature("building", one, "Point", [11.57, 48.15], name={"en": name})
                 for one, name in (("A", "Main"), ("B", "Annex"))]  # fmt: skip
    assert [one.id for one in plan_of([], levels, building=buildings).levels] == ["Annex 1", "Main 1", "2"]
    assert [one.id for one in plan_of([], levels).levels] == ["1 1", "1 2", "2"]


def test_a_unit_without_a_name_has_its_other_name() -> None:
    room = unit("u", "office", box(0, 0, 5, 5), alt_name={"en": "101"})
    assert plan_of([room]).level("L0").room_names == ("101",)


def test_stairs_whose_label_is_on_their_outline_or_beside_it_are_entered_in_their_middle() -> None:
    for x, y, place in ((3.0, 3.0, (3.0, 3.0)), (2.0, 3.0, (4.0, 4.0)), (2.2, 3.0, (4.0, 4.0)), (9.0, 9.0, (4.0, 4.0))):
        shown = {"type": "Point", "coordinates": [*degrees((x, y))[::-1]]}
        (stairs,) = plan_of([unit("a", "stairs", box(2, 2, 6, 6), display_point=shown)]).connectors
        assert stairs.stops[0].place == pytest.approx(place, abs=2e-3), (x, y)
