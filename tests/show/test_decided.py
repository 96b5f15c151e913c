"""A place is decided by one rule, wherever it is told: one candidate has 99.5 % of the weight."""

from __future__ import annotations

import re

import pytest
from attrs import evolve
from shown import frame, shown

from solepath import Placed
from solepath.events import Candidate
from solepath.floorplan.plan import FloorPlan, Level, Start, Wall
from solepath.show.tables.plan import WALL_COLOUR, PlanPicture
from solepath.show.tables.summary import end_line, place_line, place_lines
from solepath.walk import Walk

WALLS = (Wall((0.0, 0.0), (30.0, 0.0)), Wall((0.0, 10.0), (30.0, 10.0)))


def placed(weight: float, t: float) -> Placed:
    """Return a place whose heaviest candidate has this weight; the other one is on another level."""
    position = (4.0 + t, 5.0, 0.0)
    candidates = (
        Candidate("0", position, 0.0, weight, "stairs"),
        Candidate("1", (20.0, 5.0, 3.0), 0.0, 1.0 - weight, "lift"),
    )
    return Placed(t=t, known_at=t, level="0", position=position, spread=0.4, candidates=candidates)


@pytest.mark.parametrize("weight", [0.7, 0.99, 0.996])
def test_page_summary_and_picture_agree_whether_a_place_is_decided(weight: float) -> None:
    is_decided = weight > 0.995
    walk, events = Walk(), [placed(weight, float(t)) for t in range(3)]
    for event in events:
        walk.add(event)
    assert walk.places.decided_count == 3 * is_decided
    assert ("one of 2 candidates" in place_line(events[-1])) is not is_decided
    assert any("one place for 3 of 3 strides" in line for line in place_lines(walk.places)) is is_decided
    assert frame(shown(events))["place"]["decided"] is is_decided
    plan = FloorPlan("floors", (Level("0", "ground", 0, 0.0, WALLS), Level("1", "first", 1, 3.0, WALLS)))
    dots = [one for one in PlanPicture(plan, events).drawn("a walk").iter() if one.get("r") == "2.2"]
    assert (not dots) is is_decided


def test_the_summary_says_how_sure_a_place_is_that_is_not_decided() -> None:
    unsure = placed(0.7, 0.0)
    assert end_line(unsure).endswith(", (4.0, 5.0) m, not decided: 70 %, within 0.4 m; 2 candidates, on several levels")
    below = evolve(unsure, candidates=tuple([evolve(one, level="0") for one in unsure.candidates]))
    assert end_line(below).endswith("2 candidates, all on this level")
    assert "not decided: 0 %" in end_line(evolve(unsure, candidates=())), "whatever a program makes"


def marks(events: list[Placed], start: Start | None) -> dict[str, float]:
    """Return the words of the marks in a picture, each with its x on the plan, m, by the walls, which are 30 m long."""
    drawn = list(PlanPicture(FloorPlan("", (Level("0", "", 0, 0.0, WALLS),)), events, start=start).drawn("").iter())
    (walls,) = [one.get("d", "") for one in drawn if one.tag == "path" and one.get("stroke") == WALL_COLOUR]
    xs = [float(x) for x in re.findall(r"[ML]?(-?[0-9.]+)[ ,]-?[0-9.]+", walls)]
    groups = [one for one in drawn if one.tag == "g" and len(one) == 2 and one[0].get("r") == "6"]
    left, scale = min(xs), (max(xs) - min(xs)) / 30.0
    return {word.text or "": (float(dot.get("cx", "")) - left) / scale for dot, word in groups}


def test_a_start_that_was_given_is_marked_where_it_was_given() -> None:
    start = Start("0", (1.0, 5.0))
    sure, unsure = [placed(0.999, float(t)) for t in range(3)], [placed(0.7, 0.0), placed(0.999, 1.0)]
    for events, given, places in (
        (sure, None, {"start": 4.0, "end": 6.0}),
        (sure, start, {"start": 1.0, "end": 6.0}),
        (unsure, None, {"found": 5.0, "end": 5.0}),
        (unsure, start, {"start": 1.0, "found": 5.0, "end": 5.0}),
        (unsure, Start(heading=1.0), {"found": 5.0, "end": 5.0}),
    ):
        assert marks(events, given) == pytest.approx(places, abs=0.01)
