"""A place is decided by one rule, wherever it is told: one candidate has 99.5 % of the weight."""

from __future__ import annotations

import pytest
from shown import frame, shown

from solepath import Placed
from solepath.events import Candidate
from solepath.floorplan.plan import FloorPlan, Level, Wall
from solepath.show.tables.plan import PlanPicture
from solepath.show.tables.summary import place_line, place_lines
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
