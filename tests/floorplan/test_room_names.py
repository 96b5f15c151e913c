"""Names of rooms: in the records, in files of all three formats, and at the place of a wearer."""

from __future__ import annotations

import json
import math

import pytest
from attrs import evolve
from floorplans import FILES, archive
from floors import METHODS, Method, Pedestrian, follow, placed
from plan_files import format_floorplan

from solepath.emulate.routes.building import BUILDING
from solepath.floorplan.checks import find_fault
from solepath.floorplan.importers.reading import parse_floorplan, read_floorplan
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.outlines import Ring
from solepath.floorplan.plan import Door, FloorPlan, Level, Wall, with_rooms

HOUSE = read_floorplan(FILES / "house.geojson")
STREET = Wall((-20.0, -20.0), (40.0, -20.0))


def box(x0: float, y0: float, x1: float, y1: float) -> Ring:
    return (x0, y0), (x1, y0), (x1, y1), (x0, y1)


def flat(*rooms: tuple[Ring, str]) -> FloorPlan:
    """Return a flat of one level with these rooms, and a door between x = 5.0 m and x = 5.2 m."""
    level = Level("0", "ground floor", 0, 0.0, (STREET,), (Door((5.1, 2.0), (5.1, 3.0)),))
    return FloorPlan("flat", (with_rooms(level, rooms),))


KITCHEN, BATH = (box(0.0, 0.0, 5.0, 5.0), "kitchen"), (box(5.2, 0.0, 9.0, 5.0), "bath")


def test_a_place_in_a_room_has_its_name_and_one_in_another_room_has_the_other() -> None:
    plan = IndexedPlan(flat(KITCHEN, BATH))
    assert [plan.room(0, x, 2.5) for x in (0.1, 2.5, 4.9, 5.3, 8.9)] == ["kitchen"] * 3 + ["bath"] * 2


def test_a_doorstep_between_two_rooms_is_inside_and_in_neither_room() -> None:
    plan = IndexedPlan(flat(KITCHEN, BATH))
    assert plan.inside(0, 5.1, 2.5) and plan.room(0, 5.1, 2.5) is None


def test_outside_of_every_room_and_in_a_room_without_a_name_there_is_no_name() -> None:
    plan = IndexedPlan(flat(KITCHEN, BATH, (box(0.0, 6.0, 9.0, 8.0), "")))
    places = ((-0.1, 2.5), (2.5, 5.5), (9.1, 2.5), (1e9, -1e300), (math.nan, 1.0), (1.0, math.inf))
    assert [plan.room(0, x, y) for x, y in places] == [None] * len(places)
    assert plan.inside(0, 4.0, 7.0) and plan.room(0, 4.0, 7.0) is None


@pytest.mark.parametrize("turned", [False, True])
def test_a_booth_in_a_hall_is_the_booth_in_whatever_order_and_direction_they_are_drawn(turned: bool) -> None:
    rooms = [(box(0.0, 0.0, 20.0, 20.0), "hall"), (box(8.0, 8.0, 10.0, 10.0), "booth")]
    drawn = [(ring[::-1], name) for ring, name in rooms[::-1]] if turned else rooms
    plan = IndexedPlan(flat(*drawn))
    assert plan.room(0, 9.0, 9.0) == "booth" and plan.room(0, 7.0, 9.0) == "hall"


@pytest.mark.parametrize(("names", "message"), [
    (("A",), "levels[0] has 1 names of rooms and 5 rooms"),
    (("A", "B", "C", "D", 5), "levels[0].room_names[4] is 5, not of type str"),
    (["A", "B", "C", "D", "E"], "levels[0].room_names is a list, not of type tuple"),
])  # fmt: skip
def test_names_that_are_no_texts_or_too_few_are_rejected_in_one_line(names: object, message: str) -> None:
    ground = evolve(HOUSE.levels[0], room_names=names)  # type: ignore[arg-type]
    assert find_fault(evolve(HOUSE, levels=(ground, *HOUSE.levels[1:]))) == message


@pytest.mark.parametrize("name", ["\x1b[2J\r\n", "</script>", "\u202e12", "\x00", "x" * 100_000, "\U0001f6bb", " "])
def test_a_hostile_name_is_a_name_like_any_other_and_survives_the_file(name: str) -> None:
    plan = flat(KITCHEN, (BATH[0], name))
    again = parse_floorplan(format_floorplan(plan).encode())
    assert again == plan and again.fingerprint == plan.fingerprint
    assert IndexedPlan(again).room(0, 8.0, 2.5) == name


@pytest.mark.parametrize("name", ["house.geojson", "house-wgs84.geojson", "house.osm", "house-imdf"])
def test_the_rooms_of_the_house_have_their_names_in_every_format(name: str) -> None:
    levels = read_floorplan(FILES / name).levels
    assert [level.room_names for level in levels] == [("A", "Corridor", "C", "B", "D"), ("AB", "Corridor", "C", "D")]


def test_a_unit_of_imdf_has_its_name_in_the_language_of_the_archive() -> None:
    files = {path.name: path.read_bytes() for path in (FILES / "house-imdf").iterdir()}
    text = files["unit.geojson"].decode().replace('{"en": "A"}', '{"de": "Küche", "en": "A"}')
    manifest = {**json.loads(files["manifest.json"]), "language": "de-AT"}
    plan = parse_floorplan(archive({**files, "unit.geojson": text.encode(), "manifest.json": manifest}))
    assert plan.levels[0].room_names[0] == "Küche"


@pytest.mark.parametrize("method", METHODS)
def test_a_wearer_who_goes_through_a_door_is_in_the_corridor_and_then_in_the_room(method: type[Method]) -> None:
    part = method()
    wearer = Pedestrian(3, "0", (9.0, 25.0)).known_to(part)
    wearer.walk((9.0, 32.5), (3.0, 32.5))
    rooms = [event.room for event in placed(follow(part, wearer.received, IndexedPlan(BUILDING)))]
    assert rooms[0] == "corridor 1" and rooms[-1] == "room 5"
    assert set(rooms) <= {"corridor 1", "room 5"}
