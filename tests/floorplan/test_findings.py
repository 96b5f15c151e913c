"""Plans that were broken on purpose: one sentence names what is wrong, and where."""

from __future__ import annotations

import json
from typing import Any

import pytest
from plan_files import format_floorplan

from solepath.floorplan.findings import find_findings
from solepath.floorplan.importers.reading import parse_floorplan
from solepath.floorplan.plan import FloorPlan, FloorPlanError

Drawn = dict[str, dict[str, Any]]


def line(*points: tuple[float, float]) -> dict[str, Any]:
    return {"type": "LineString", "coordinates": points}


def point(x: float, y: float) -> dict[str, Any]:
    return {"type": "Point", "coordinates": (x, y)}


def box(x0: float, y0: float, x1: float, y1: float, kind: str = "Polygon") -> dict[str, Any]:
    return {"type": kind, "coordinates": [[(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)]]}


def flat() -> Drawn:
    """An office and a hall with an entrance and stairs, and the same above without the entrance."""
    drawn: Drawn = {f"level {k}": {"feature": "level", "ordinal": k, "elevation": 3.0 * k, "geometry": None}
                    for k in (0, 1)}  # fmt: skip
    for level in ("0", "1"):
        drawn |= {
            f"outer wall {level}": {"feature": "wall", "level": level, "geometry": box(0, 0, 12, 8)},
            f"wall {level}": {"feature": "wall", "level": level, "geometry": line((0, 4), (12, 4))},
            f"door {level}": {"feature": "door", "level": level, "name": "office door",
                              "geometry": line((5, 4), (6, 4))},
            f"office {level}": {"feature": "room", "level": level, "name": "office", "geometry": box(0, 0, 12, 4)},
            f"hall {level}": {"feature": "room", "level": level, "name": "hall", "geometry": box(0, 4, 12, 8)},
            f"stairs {level}": {"feature": "stairs", "level": level, "name": "stairs",
                                "geometry": point(10, 6)},
        }  # fmt: skip
    drawn["entrance"] = {"feature": "door", "level": "0", "name": "entrance", "geometry": line((2, 8), (3, 8))}
    return drawn


def plan_of(drawn: Drawn) -> FloorPlan:
    features = [{"type": "Feature", "id": name.removeprefix("level "), "geometry": one["geometry"],
                 "properties": {key: value for key, value in one.items() if key != "geometry"}}
                for name, one in drawn.items()]  # fmt: skip
    head = {"type": "FeatureCollection", "format": "solepath-floorplan", "version": 1, "frame": "local"}
    return parse_floorplan(json.dumps(head | {"features": features}).encode())


def test_nothing_is_wrong_with_a_whole_plan_of_any_format() -> None:
    assert find_findings(plan_of(flat())) == ()
    assert find_findings(parse_floorplan(format_floorplan(plan_of(flat())).encode())) == ()


BROKEN: dict[str, tuple[Drawn, str]] = {
    "a gap in the outer wall": (
        {"outer wall 0": {"feature": "wall", "level": "0",
                          "geometry": line((9, 0), (12, 0), (12, 8), (0, 8), (0, 0), (7, 0))}},
        "level '0': its walls do not close near (7.3, 0.3): room 'office' is open to the outside",
    ),
    "a room without a door": (
        {"closet": {"feature": "wall", "level": "0", "geometry": box(0, 0, 3, 2)},
         "store": {"feature": "room", "level": "0", "name": "store", "geometry": box(0, 0, 3, 2)}},
        "level '0': no way leads to room 'store' at (1.5, 1.0)",
    ),
    "a door that nobody drew": (
        {"door 1": {"feature": "room", "level": "1", "name": "hall", "geometry": box(0, 4, 12, 8)}},
        "level '1': no way leads to room 'office' at (6.0, 2.0)",
    ),
    "a wall through a door": (
        {"pillar": {"feature": "wall", "level": "0", "geometry": line((5.5, 3), (5.5, 5))}},
        "level '0': door 'office door' at (5.5, 4.0) has a wall across it, from (5.5, 3.0) to (5.5, 5.0)",
    ),
    "a door beside all walls": (
        {"gate": {"feature": "door", "level": "0", "name": "gate", "geometry": line((6, 5.5), (7, 5.5))}},
        "level '0': door 'gate' at (6.5, 5.5) is in no wall",
    ),
    "stairs with another name above": (
        {"stairs 1": {"feature": "stairs", "level": "1", "name": "stair", "geometry": point(10, 6)}},
        "stairs 'stairs': stops at level '0' only, at (10.0, 6.0)",
    ),
    "a lift that leads nowhere": (
        {"lift": {"feature": "lift", "level": "1", "name": "A", "geometry": point(8, 6)}},
        "lift 'A': stops at level '1' only, at (8.0, 6.0)",
    ),
    "stairs behind walls": (
        {"shaft": {"feature": "wall", "level": "1", "geometry": box(9, 5, 11, 7)},
         "west stairs 0": {"feature": "stairs", "level": "0", "name": "west", "geometry": point(2, 6)},
         "west stairs 1": {"feature": "stairs", "level": "1", "name": "west", "geometry": point(2, 6)}},
        "level '1': no way leads to stairs 'stairs' at (10.0, 6.0)",
    ),
    "stairs on a wall": (
        {"stairs 0": {"feature": "stairs", "level": "0", "name": "stairs", "geometry": point(10, 4)}},
        "stairs 'stairs': at level '0' one would stand in a wall, at (10.0, 4.0)",
    ),
    "a level without stairs": (
        {"2": {"feature": "level", "ordinal": 2, "elevation": 6.0, "geometry": None},
         "roof": {"feature": "wall", "level": "2", "geometry": box(0, 0, 12, 8)}},
        "level '2': neither stairs nor a lift lead there",
    ),
    "a lift that two plans do not agree on": (
        {"lift 0": {"feature": "lift", "level": "0", "name": "A", "geometry": point(1, 6)},
         "lift 1": {"feature": "lift", "level": "1", "name": "A", "geometry": point(11, 7)}},
        "lift 'A': from level '0' to '1' it goes 10.0 m aside, from (1.0, 6.0) to (11.0, 7.0)",
    ),
    "stairs in the garden": (
        {"stairs 1": {"feature": "stairs", "level": "1", "name": "stairs", "geometry": point(30, 6)}},
        "level '1': stairs 'stairs' at (30.0, 6.0) is outside of all walls and rooms",
    ),
    "stairs in the garden of a house without rooms": (
        {"2": {"feature": "level", "ordinal": 2, "elevation": 6.0, "geometry": None},
         "roof": {"feature": "wall", "level": "2", "geometry": box(0, 0, 12, 8)},
         "stairs 2": {"feature": "stairs", "level": "2", "name": "stairs", "geometry": point(10, -3)}},
        "level '2': stairs 'stairs' at (10.0, -3.0) is outside of all walls and rooms",
    ),
    "an outline without its last corner": (
        {"hall 0": {"feature": "room", "level": "0", "name": "hall",
                    "geometry": {"type": "Polygon", "coordinates": [[(0, 4), (12, 4), (12, 8)]]}}},
        "level '0': room 'hall 0': its outline does not close, it ends at (12.0, 8.0), 12.65 m from where it begins",
    ),
    "an outline that crosses itself": (
        {"hall 0": {"feature": "room", "level": "0", "name": "hall",
                    "geometry": {"type": "Polygon", "coordinates": [[(0, 4), (12, 8), (12, 4), (0, 8), (0, 4)]]}}},
        "level '0': room 'hall 0': its outline crosses itself at (6.0, 6.0)",
    ),
    "walls that cross in their outline": (
        {"outer wall 1": {"feature": "wall", "level": "1", "geometry": {
            "type": "Polygon", "coordinates": [[(0, 0), (12, 0), (0, 8), (12, 8), (0, 0)]]}}},
        "level '1': wall 'outer wall 1': its outline crosses itself at (6.0, 4.0)",
    ),
    "a slip in the outline of a stairwell": (
        {"stairs 0": {"feature": "stairs", "level": "0", "name": "stairs", "geometry": {
            "type": "Polygon",
            "coordinates": [[(9, 5), (11, 5), (11, 7), (10, 7), (10, 7.1), (10.1, 6.9), (9, 6.9), (9, 5)]]}}},
        "level '0': stairs 'stairs 0': its outline crosses itself at (10.1, 7.0)",
    ),
    "a room that is drawn twice": (
        {"copy": {"feature": "room", "level": "1", "name": "copy", "geometry": box(0, 0, 12, 4)}},
        "level '1': rooms 'office' and 'copy' lie over each other at (6.3, 0.3)",
    ),
    "two rooms over each other": (
        {"bay": {"feature": "room", "level": "0", "name": "bay", "geometry": box(4, 6, 8, 10)}},
        "level '0': rooms 'hall' and 'bay' lie over each other at (6.3, 6.3)",
    ),
    "rooms with a door between them and none to the hall": (
        {"door 0": {"feature": "wall", "level": "0", "geometry": line((3, 0), (3, 4))},
         "study door": {"feature": "door", "level": "0", "geometry": line((3, 1), (3, 2))},
         "office 0": {"feature": "room", "level": "0", "name": "office", "geometry": box(3, 0, 12, 4)},
         "study": {"feature": "room", "level": "0", "name": "study", "geometry": box(0, 0, 3, 4)},
         "pantry": {"feature": "room", "level": "0", "name": "pantry", "geometry": box(9, 0, 12, 2)}},
        "level '0': no way leads to room 'office' at (7.5, 2.0), nor to room 'study', room 'pantry'",
    ),
}  # fmt: skip
"""What is drawn besides, or in place of, what has the same name in `flat`, and the sentence about it."""


@pytest.mark.parametrize("what", BROKEN)
def test_a_broken_plan_gets_a_sentence_that_names_the_place(what: str) -> None:
    changes, sentence = BROKEN[what]
    assert sentence in [one.text for one in find_findings(plan_of(flat() | changes))]


NEEDS_NO_MENDING = {
    "a slip in the outline of a stairwell",
    "a door beside all walls",
    "a room that is drawn twice",
    "two rooms over each other",
}


def test_what_places_may_be_wrong_by_must_be_mended_and_a_name_of_two_rooms_need_not() -> None:
    for what, (changes, sentence) in BROKEN.items():
        found = {one.text: one for one in find_findings(plan_of(flat() | changes))}
        assert found[sentence].act == (what not in NEEDS_NO_MENDING), what
        assert found[sentence].level in ("0", "1", "2")


def scaled(drawn: Drawn, size: float) -> FloorPlan:
    """Return the plan of what is drawn in units of `size` m."""

    def times(value: Any) -> Any:
        return value / size if isinstance(value, int | float) else [times(one) for one in value]

    shapes = {name: one["geometry"] and one["geometry"] | {"coordinates": times(one["geometry"]["coordinates"])}
              for name, one in drawn.items()}  # fmt: skip
    return plan_of({name: one | {"geometry": shapes[name]} for name, one in drawn.items()})


@pytest.mark.parametrize(("size", "width"), [(0.01, 100), (0.0254, 39.4)])
def test_a_plan_in_another_unit_is_known_by_its_doors(size: float, width: float) -> None:
    (first, *_) = find_findings(scaled(flat(), size))
    assert first.act and first.place is not None
    x, y = first.place
    doors = [f"level '{level}': door '{name}' at ({x:.1f}, {y:.1f}) "
             for level in "01" for name in ("office door", "entrance")]  # fmt: skip
    assert first.text.startswith(tuple(doors))
    assert f"is {width} m wide, as most are; a plan must be in metres" in first.text


def test_one_wide_door_among_others_is_a_gate() -> None:
    gate = {"gate": {"feature": "door", "level": "0", "name": "gate", "geometry": line((0, 0), (0, 4))}}
    assert find_findings(scaled(flat() | gate, 0.17)) == ()


def test_a_booth_in_a_hall_and_rooms_on_both_faces_of_a_wall_do_not_lie_over_each_other() -> None:
    booth = {
        "booth": {"feature": "room", "level": "0", "name": "booth", "geometry": box(4, 5, 6, 7)},
        "office 0": {"feature": "room", "level": "0", "name": "office", "geometry": box(0, 0, 12, 4.2)},
    }
    assert find_findings(plan_of(flat() | booth)) == ()


def test_many_stops_outside_are_one_sentence() -> None:
    outside = {f"{name} {level}": {"feature": "lift", "level": level, "name": name, "geometry": point(20 + k, 3)}
               for k, name in enumerate("ABCDEF") for level in ("0", "1")}  # fmt: skip
    found = [one.text for one in find_findings(plan_of(flat() | outside)) if one.level == "1"]
    ending = "outside of all walls and rooms, and so are lift 'B', lift 'C', lift 'D' and 2 more"
    assert found == [f"level '1': lift 'A' at (20.0, 3.0) is {ending}"]


def test_a_hall_without_a_door_is_not_reached_however_many_rooms_it_has() -> None:
    drawn = flat()
    del drawn["door 0"]
    offices = {f"bay {k}": {"feature": "room", "level": "0", "name": f"bay {k}", "geometry": box(k, 1, k + 1, 3)}
               for k in range(6)}  # fmt: skip
    (found,) = find_findings(plan_of(drawn | offices))
    assert found.text.startswith("level '0': no way leads to room 'office' at (6.0, 2.0), nor to room 'bay 0'")


def test_a_feature_on_a_level_that_is_not_drawn_is_named_with_its_id() -> None:
    with pytest.raises(FloorPlanError, match="room 'store': is on level '7', which the plan does not have"):
        plan_of(flat() | {"store": {"feature": "room", "level": "7", "geometry": box(0, 0, 3, 2)}})


def test_wings_without_a_way_between_them_are_reached_by_stairs_of_their_own() -> None:
    wings = flat()
    del wings["door 0"], wings["door 1"], wings["entrance"]
    for level in ("0", "1"):
        wings[f"south {level}"] = {"feature": "stairs", "level": level, "name": "south", "geometry": point(10, 2)}
    assert find_findings(plan_of(wings)) == ()
