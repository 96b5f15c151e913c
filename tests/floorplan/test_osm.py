"""OpenStreetMap's Simple Indoor Tagging, tag by tag."""

from __future__ import annotations

import json
from collections.abc import Sequence
from xml.sax.saxutils import quoteattr

import pytest
from floorplans import degrees

from solepath.floorplan.findings import find_findings
from solepath.floorplan.importers.osm import parse_levels
from solepath.floorplan.importers.reading import parse_floorplan
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import ConnectorKind, Door, FloorPlan, FloorPlanError, Point


class Map:
    """A builder of an OSM file; places are in m east and north of a corner."""

    def __init__(self) -> None:
        self._nodes: dict[Point, tuple[int, dict[str, str]]] = {}
        self._rest: list[str] = []

    def node(self, place: Point, **tags: str) -> Map:
        number, known = self._nodes.setdefault(place, (len(self._nodes) + 1, {}))
        known.update({key.replace("__", ":"): value for key, value in tags.items()})
        return self

    def way(self, places: Sequence[Point], number: int = 0, **tags: str) -> Map:
        for place in places:
            self.node(place)
        refs = "".join(f'<nd ref="{self._nodes[place][0]}"/>' for place in places)
        self._rest.append(f'<way id="{number or 1000 + len(self._rest)}">{refs}{_tags(tags)}</way>')
        return self

    def relation(self, members: Sequence[tuple[int, str]], **tags: str) -> Map:
        inner = "".join(f'<member type="way" ref="{ref}" role="{role}"/>' for ref, role in members)
        self._rest.append(f'<relation id="{1000 + len(self._rest)}">{inner}{_tags(tags)}</relation>')
        return self

    def plan(self) -> FloorPlan:
        nodes = []
        for place, (number, tags) in self._nodes.items():
            latitude, longitude = degrees(place)
            nodes.append(f'<node id="{number}" lat="{latitude:.10f}" lon="{longitude:.10f}">{_tags(tags)}</node>')
        return parse_floorplan(f'<osm version="0.6">{"".join(nodes)}{"".join(self._rest)}</osm>'.encode())


def _tags(tags: dict[str, str]) -> str:
    return "".join(f"<tag k={quoteattr(key.replace('__', ':'))} v={quoteattr(value)}/>" for key, value in tags.items())


def box(x0: float, y0: float, x1: float, y1: float) -> list[Point]:
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)]


def house() -> Map:
    return Map().way(box(0, 0, 20, 10), indoor="room", level="0")


@pytest.mark.parametrize(("text", "found"), [
    ("0.5", [0.5]), ("-3--1", [-3.0, -2.0, -1.0]), ("-1;2-4", [-1.0, 2.0, 3.0, 4.0]), ("1 ; 1", [1.0]),
    ("3-1", [1.0, 2.0, 3.0]),
])  # fmt: skip
def test_levels_are_single_ones_lists_and_ranges(text: str, found: list[float]) -> None:
    assert parse_levels(text) == found


@pytest.mark.parametrize("text", ["", "EG", "1-", "0,1", "٣", "0-99999"])
def test_other_values_have_no_levels(text: str) -> None:
    with pytest.raises(FloorPlanError):
        parse_levels(text)


def test_a_room_has_walls_an_area_has_none_and_a_corridor_has_them_towards_neither() -> None:
    drawn = Map().way(box(0, 0, 10, 4), indoor="room", level="0").way(box(0, 4, 10, 8), indoor="corridor", level="0")
    drawn.way(box(10, 4, 20, 8), indoor="corridor", level="0").way(box(0, 8, 20, 12), indoor="area", level="0")
    plan = IndexedPlan(drawn.plan())
    assert plan.crosses(0, 5.0, 3.0, 5.0, 5.0)  # room to corridor
    assert not plan.crosses(0, 9.0, 6.0, 11.0, 6.0)  # corridor to corridor
    assert not plan.crosses(0, 5.0, 7.0, 5.0, 9.0)  # corridor to area
    assert plan.crosses(0, 15.0, 5.0, 15.0, 3.0)  # corridor to nothing
    assert not plan.crosses(0, 5.0, 11.0, 5.0, 13.0)  # area to nothing
    assert all(plan.inside(0, x, y) for x, y in ((5.0, 2.0), (5.0, 6.0), (15.0, 6.0), (5.0, 10.0)))


def test_a_door_node_is_centred_in_its_wall_with_its_width() -> None:
    level = Map().node((5.0, 0.0), door="yes", width="90 cm", ref="D1").way(
        [(0.0, 0.0), (5.0, 0.0), (20.0, 0.0), (20.0, 10.0), (0.0, 10.0), (0.0, 0.0)], indoor="room", level="0"
    ).plan().levels[0]  # fmt: skip
    assert level.doors == (Door((4.55, 0.0), (5.45, 0.0), "D1"),)
    assert [wall.end for wall in level.walls if wall.start == (0.0, 0.0)] == [(0.0, 10.0), (4.55, 0.0)]


def test_a_door_on_a_corner_starts_there_along_the_longer_wall() -> None:
    level = house().node((20.0, 10.0), entrance="yes").plan().levels[0]
    assert level.doors == (Door((19.0, 10.0), (20.0, 10.0)),)


def test_repeat_on_puts_one_room_on_many_levels() -> None:
    plan = Map().way(box(0, 0, 20, 10), indoor="room", level="0", repeat_on="1;3-4").plan()
    assert [(level.id, level.ordinal, level.elevation) for level in plan.levels] == [
        ("0", 0, 0.0), ("1", 1, 3.0), ("3", 3, 9.0), ("4", 4, 12.0)]  # fmt: skip
    assert len({(level.walls, level.rooms) for level in plan.levels}) == 1
    assert not plan.heights_known


@pytest.mark.parametrize("kind", [{"indoor": "room"}, {"highway": "elevator"}, {"highway": "steps", "area": "yes"}])
def test_what_is_on_levels_by_either_tag_is_part_of_the_plan_and_what_has_neither_is_not(kind: dict[str, str]) -> None:
    both = house().way(box(2, 2, 4, 4), **kind, level="0;1").plan()
    assert both == house().way(box(2, 2, 4, 4), **kind, repeat_on="0;1").plan()
    assert both == house().way(box(2, 2, 4, 4), **kind, level="0", repeat_on="1").plan()
    assert house().way(box(2, 2, 4, 4), **kind).plan() == house().plan() != both


def test_stairs_and_lifts_stop_at_all_their_levels() -> None:
    drawn = Map().way(box(0, 0, 20, 10), indoor="room", level="0-2")
    drawn.way(box(2, 2, 4, 4), highway="elevator", level="0-2", ref="L1")
    drawn.way(box(6, 2, 9, 4), indoor="room", stairs="yes", level="0-1", repeat_on="2", step__height="0.17")
    found = drawn.node((15.0, 5.0), highway="elevator", level="0;2").plan().connectors
    assert [(one.kind, one.name, one.rise, [(stop.level, stop.place) for stop in one.stops]) for one in found] == [
        (ConnectorKind.LIFT, "", None, [("0", (15.0, 5.0)), ("2", (15.0, 5.0))]),
        (ConnectorKind.LIFT, "L1", None, [("0", (3.0, 3.0)), ("1", (3.0, 3.0)), ("2", (3.0, 3.0))]),
        (ConnectorKind.STAIRS, "", 0.17, [("0", (7.5, 3.0)), ("1", (7.5, 3.0)), ("2", (7.5, 3.0))]),
    ]


def test_a_flight_drawn_as_a_line_goes_from_its_lowest_end_to_its_highest() -> None:
    drawn = Map().way(box(0, 0, 20, 10), indoor="room", level="0-1")
    drawn.way([(3.0, 5.0), (8.0, 5.0)], highway="steps", level="0-1")
    drawn.way([(3.0, 7.0), (8.0, 7.0)], highway="steps", level="0;1", incline="down")
    found = drawn.plan().connectors
    assert [[stop.place for stop in one.stops] for one in found] == [
        [(3.0, 5.0), (8.0, 5.0)], [(8.0, 7.0), (3.0, 7.0)]]  # fmt: skip


def test_stairs_drawn_level_by_level_are_joined_where_they_overlap() -> None:
    drawn = Map().way(box(0, 0, 20, 10), indoor="room", level="0-2")
    for level in "012":
        drawn.way(box(2, 2, 4, 4), indoor="area", stairs="yes", level=level)
        drawn.way(box(4, 2, 6, 4), indoor="area", stairs="yes", level=level)  # beside them, not over them
    found = drawn.plan().connectors
    assert [[stop.level for stop in one.stops] for one in found] == [["0", "1", "2"]] * 2


def test_a_relation_has_a_hole_and_its_outline_may_be_of_several_ways() -> None:
    drawn = Map().way([(0.0, 0.0), (20.0, 0.0), (20.0, 10.0)], 1).way([(0.0, 0.0), (0.0, 10.0), (20.0, 10.0)], 2)
    drawn.way(box(8, 4, 12, 6), 3).relation([(1, "outer"), (2, "outer"), (3, "inner")], type="multipolygon",
                                            indoor="corridor", level="0")  # fmt: skip
    plan = IndexedPlan(drawn.plan())
    assert not plan.inside(0, 10.0, 5.0)
    assert plan.inside(0, 5.0, 5.0)
    assert plan.crosses(0, 7.5, 5.0, 8.5, 5.0)
    assert plan.crosses(0, 19.5, 5.0, 20.5, 5.0)


def test_a_gap_without_a_door_is_a_way_through_the_wall() -> None:
    plan = IndexedPlan(house().node((5.0, 0.0), door="no", level="0").way([(0, 0), (5, 0), (20, 0)]).plan())
    assert not plan.crosses(0, 5.0, -0.5, 5.0, 0.5)
    assert plan.crosses(0, 15.0, -0.5, 15.0, 0.5)


def shape(kind: str, coordinates: object, **tags: object) -> dict[str, object]:
    return {"type": "Feature", "properties": tags, "geometry": {"type": kind, "coordinates": coordinates}}


def test_a_map_exported_as_geojson_is_the_same_plan() -> None:
    def east_north(places: Sequence[Point]) -> list[list[float]]:
        return [[float(f"{value:.10f}") for value in degrees(place)[::-1]] for place in places]

    outer, hole, stairs = box(0, 0, 20, 10), box(8, 3, 12, 7), [(2, 2), (6, 2)]
    ring = [*outer[:1], (5, 0), *outer[1:]]
    drawn = Map().way(ring, number=1).way(hole, number=2).node((5, 0), door="yes", level="0", name="front")
    drawn.relation([(1, "outer"), (2, "inner")], type="multipolygon", indoor="room", level="0", name="ring")
    drawn.way(stairs, highway="steps", level="0;1").way(outer, indoor="room", level="1", ref="7")
    features = [
        shape("Polygon", [east_north(ring), east_north(hole)], indoor="room", level=0, name="ring", id="relation/1"),
        shape("Point", east_north([(5, 0)])[0], door="yes", level="0", name="front", seen=True),
        shape("LineString", east_north(stairs), highway="steps", level="0;1"),
        shape("Polygon", [east_north(outer)], indoor="room", level="1", ref=7),
    ]
    text = json.dumps({"type": "FeatureCollection", "generator": "overpass-turbo", "features": features})
    assert parse_floorplan(text.encode()) == drawn.plan()
    with pytest.raises(FloorPlanError, match="feature 'front': a coordinate is 'x'"):
        features[1]["geometry"] = {"type": "Point", "coordinates": ["x", 48.15]}
        parse_floorplan(json.dumps({"type": "FeatureCollection", "features": features}).encode())


def test_stairs_that_end_at_a_wall_are_entered_through_it() -> None:
    hall = [(0, 6), (5, 6), (20, 6), (20, 16), (0, 16), (0, 6)]
    drawn = Map().way(hall, indoor="corridor", level="0").way([(5, 6), (5, 1)], highway="steps", level="0;1")
    plan = drawn.way(box(0, 0, 20, 5), indoor="room", level="1").plan()
    index = IndexedPlan(plan)
    assert plan.connectors[0].stops[0].place == pytest.approx((5.0, 6.0), abs=2e-3)
    assert not index.crosses(0, 5.0, 6.0, 5.0, 7.0) and index.crosses(0, 8.0, 5.5, 8.0, 6.5)
    assert not [one.text for one in find_findings(plan) if "stand in a wall" in one.text]
