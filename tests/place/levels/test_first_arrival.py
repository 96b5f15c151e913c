"""The first lift or stairs of a wearer whose place was unknown: all exits and all headings are possible at first."""

from __future__ import annotations

from math import dist

import pytest
from floors import HIGH, LEFT, LIFTS, OFFICE, RIGHT, Method, Pedestrian, follow, placed

from solepath import Foot, Session, Site, recipes
from solepath.body.place.connectors.level_changes import LevelReached
from solepath.body.place.first_arrival import STRIDES, FirstArrival
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.ways import wandering
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2541
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.shoe import IN_SOLE
from solepath.events import PositionReported
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import ConnectorKind
from solepath.lab.emulated import place as emulated_place
from solepath.types import SITE_OF_FOOT

PLAN = IndexedPlan(BUILDING)


@pytest.mark.parametrize(
    ("recipe", "seed", "end"),
    [("default", 9, 75.0), ("footstep-tracker", 35, 75.0)],
    ids=["a lift, and a turn after 20 m", "stairs that were left before their end was reported"],
)
def test_the_true_place_is_still_possible_after_the_first_turns(recipe: str, seed: int, end: float) -> None:
    way = wandering(seed)
    tag = CC2541(rate=20.0, mounting=IN_SOLE)
    devices = {SITE_OF_FOOT[foot]: tag if recipe == "footstep-tracker" else Insole(cells=8) for foot in Foot}
    walk = emulate(way.route, devices=devices, seed=seed)
    session = Session(recipes.by_name(recipe), floorplan=PLAN)
    events = session.feed([packet for packet in walk.packets if packet.t < end])
    score = emulated_place.score(way, walk.walker, walk.truth, events)
    assert score.strides > 50 and score.dropped == 0


def test_rows_start_again_three_times_and_then_no_more() -> None:
    first = FirstArrival(LevelReached(ConnectorKind.LIFT, True, None, 1.0, 5.0))
    due = [k for k in range(1, 30) if first.count_stride()]
    assert tuple(due) == STRIDES and first.is_over


def undecided(part: Method) -> Pedestrian:
    """Let a pedestrian of unknown place ride a lift and leave it; return the pedestrian."""
    pedestrian = Pedestrian(8, "0", LIFTS["lift west"])
    pedestrian.ride("1")
    pedestrian.walk((LEFT + 0.5, 18.0))
    follow(part, pedestrian.received)
    pedestrian.received.clear()
    assert part.first_arrival is not None and len(part.rows) > 20
    return pedestrian


def test_the_first_arrival_is_over_after_some_strides(part: Method) -> None:
    pedestrian = undecided(part)
    pedestrian.walk((LEFT, HIGH), (RIGHT, HIGH))
    follow(part, pedestrian.received)
    assert part.first_arrival is None and part.rows


def test_rows_do_not_start_again_once_a_person_has_reported_the_place(part: Method) -> None:
    pedestrian = undecided(part)
    part.plan = OFFICE
    x, y = pedestrian.place
    assert not part.receive(
        PositionReported(
            t=pedestrian.t, known_at=pedestrian.t, site=Site.LEFT_FOOT, position=(x, y), level="1", sigma=0.5
        )
    )
    assert part.first_arrival is None
    pedestrian.walk((LEFT, HIGH), (12.0, HIGH))
    places = placed(follow(part, pedestrian.received))
    assert all(dist(one.position[:2], (x, y)) < 20.0 for one in places) and places[-1].spread < 1.5


def test_rows_do_not_start_again_on_another_clock(part: Method) -> None:
    pedestrian = undecided(part)
    pedestrian.t -= 100.0
    pedestrian.walk((LEFT, 20.0))
    follow(part, pedestrian.received)
    assert part.first_arrival is None


def test_stairs_that_turn_out_to_lead_the_other_way_start_again_the_other_way() -> None:
    first = FirstArrival(LevelReached(ConnectorKind.STAIRS, True, None, 1.0, 5.0))
    first.reverse()
    assert first.arrived.up is False and first.arrived.t == 5.0
