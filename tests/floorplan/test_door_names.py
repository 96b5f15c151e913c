"""Names of doors: in files of all three formats, and at the place of a wearer."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from attrs import evolve
from floors import METHODS, Method, Pedestrian, follow, placed

from solepath import Placed
from solepath.emulate.routes.building import BUILDING
from solepath.events import Candidate
from solepath.floorplan.doors import cut_doors
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Door, FloorPlan, Level, Wall
from solepath.show.output import TrackFiles
from solepath.show.tables.summary import place_line


def flat(*doors: Door) -> FloorPlan:
    """Return a flat of two rooms of 6 m, side by side along a corridor, with a wall between any two of them."""
    walls = (Wall((0.0, 0.0), (12.0, 0.0)), Wall((6.0, 0.0), (6.0, 5.0)), Wall((0.0, 5.0), (12.0, 5.0)))
    return FloorPlan("flat", (cut_doors(Level("0", "ground floor", 0, 0.0, walls, doors)),))


LEFT, RIGHT = Door((4.6, 0.0), (5.6, 0.0), "west door"), Door((6.4, 0.0), (7.4, 0.0), "east door")


def test_a_place_close_to_a_door_is_at_the_nearest_one_and_further_away_at_none() -> None:
    plan = IndexedPlan(flat(LEFT, RIGHT))
    assert [plan.door(0, x, -0.5) for x in (3.4, 5.0, 5.9, 6.1, 8.5)] == ["west door"] * 3 + ["east door"] * 2
    assert [plan.door(0, x, y) for x, y in ((5.0, -1.6), (3.0, -0.5), (9.0, 0.5))] == [None] * 3


def test_a_door_of_the_next_room_does_not_count_through_the_wall() -> None:
    plan = IndexedPlan(flat(RIGHT))
    assert plan.door(0, 5.7, 0.3) is None, "the wall is between"
    assert plan.door(0, 6.3, 0.3) == "east door" and plan.door(0, 5.7, -0.3) == "east door"


def test_a_wearer_on_the_doorstep_is_at_the_door_from_post_to_post() -> None:
    plan = IndexedPlan(flat(LEFT))
    assert {plan.door(0, 4.6 + 0.05 * k, 0.0) for k in range(1, 20)} == {"west door"}


def named_building() -> FloorPlan:
    """Return the emulated building with a name for the door of the room at (3, 32.5) m on the ground floor."""
    ground, *others = BUILDING.levels
    doors = tuple(
        evolve(door, name="door 5") if abs(door.start[0] - 7.8) < 0.1 and 29.0 < door.start[1] < 36.0 else door
        for door in ground.doors
    )
    assert [door.name for door in doors].count("door 5") == 1
    return evolve(BUILDING, levels=(evolve(ground, doors=doors), *others))


@pytest.mark.parametrize("method", METHODS)
def test_a_wearer_who_goes_into_a_room_is_at_its_door_on_the_way(method: type[Method]) -> None:
    part = method()
    wearer = Pedestrian(3, "0", (9.0, 25.0)).known_to(part)
    wearer.walk((9.0, 32.5), (3.0, 32.5))
    events = placed(follow(part, wearer.received, IndexedPlan(named_building())))
    doors = [event.door for event in events]
    first, last = doors.index("door 5"), len(doors) - doors[::-1].index("door 5")
    assert doors[0] is None is doors[-1] and set(doors[first:last]) == {"door 5"} and last - first >= 2
    rooms = [event.room for event in events[first:last]]
    assert rooms[0] == "corridor 1" and rooms[-1] == "room 5"


def test_the_table_of_places_and_the_line_for_people_have_the_door(tmp_path: Path) -> None:
    candidates = (Candidate("0", (1.0, 2.0, 0.0), 0.0, 1.0, "start"),)
    place = Placed(
        t=1.0, known_at=1.0, level="0", position=(1.0, 2.0, 0.0), room="room 12", door="X", spread=0.5,
        candidates=candidates,
    )  # fmt: skip
    assert place_line(place).startswith("place: level 0, room 12, at door X, (1.0, 2.0) m")
    assert place_line(evolve(place, room=None, door=None)).startswith("place: level 0, (1.0, 2.0) m")
    files = TrackFiles(tmp_path, places=True)
    for event in (place, evolve(place, t=2.0, door=None)):
        files.write(event)
    files.close()
    rows = list(csv.DictReader((tmp_path / "places.csv").open(encoding="utf-8")))
    assert [row["door"] for row in rows] == ["X", ""]
