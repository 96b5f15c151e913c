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
}  # fmt: skip
"""What is drawn besides, or in place of, what has the same name in `flat`, and the sentence about it."""


@pytest.mark.parametrize("what", BROKEN)
def test_a_broken_plan_gets_a_sentence_that_names_the_place(what: str) -> None:
    changes, sentence = BROKEN[what]
    assert sentence in [one.text for one in find_findings(plan_of(flat() | changes))]


def test_a_door_whose_wall_is_in_another_file_needs_no_mending_and_all_else_does() -> None:
    for what, (changes, sentence) in BROKEN.items():
        found = {one.text: one for one in find_findings(plan_of(flat() | changes))}
        assert found[sentence].act == (what != "a door beside all walls"), what
        assert found[sentence].level in ("0", "1", "2")


def test_a_feature_on_a_level_that_is_not_drawn_is_named_with_its_id() -> None:
    with pytest.raises(FloorPlanError, match="room 'store': is on level '7', which the plan does not have"):
        plan_of(flat() | {"store": {"feature": "room", "level": "7", "geometry": box(0, 0, 3, 2)}})


def test_wings_without_a_way_between_them_are_reached_by_stairs_of_their_own() -> None:
    wings = flat()
    del wings["door 0"], wings["door 1"], wings["entrance"]
    for level in ("0", "1"):
        wings[f"south {level}"] = {"feature": "stairs", "level": level, "name": "south", "geometry": point(10, 2)}
    assert find_findings(plan_of(wings)) == ()
