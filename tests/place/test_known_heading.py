"""A first heading without a place, as the compass of a phone gives it, settles which end of a building it is."""

from __future__ import annotations

import pytest
from floors import LOW, RIGHT, Method, Pedestrian, follow, lost, placed, tour
from views import told

from solepath import Session, Start, read_floorplan
from solepath.body.part import StartGiven
from solepath.floorplan.plan import FloorPlanError

SEEDS = range(1, 4)


def decided(part: Method, seed: int, off: float | None) -> int:
    """Return the number of places until one candidate was left, with a first heading that is `off` by so much, rad."""
    pedestrian = tour(seed)
    if off is not None:
        told(part, StartGiven(Start(heading=-pedestrian.turned + off)))
    places = placed(follow(part, pedestrian.received))
    return next((k for k, place in enumerate(places) if len(place.candidates) == 1), len(places))


def test_with_the_heading_fewer_strides_decide_where_the_wearer_is(part: Method) -> None:
    new = type(part)
    with_heading, without = [[decided(new(), seed, off) for seed in SEEDS] for off in (0.1, None)]
    assert sum(with_heading) < 0.7 * sum(without)


def test_a_heading_alone_is_no_place_before_the_first_stairs_or_lift(part: Method) -> None:
    told(part, StartGiven(Start(heading=1.0)))
    pedestrian = Pedestrian(7, "0", (12.0, LOW))
    pedestrian.walk((RIGHT, LOW))
    events = follow(part, pedestrian.received)
    assert len(lost(events)) == 1 and "no place of the start was given" in lost(events)[0]
    assert placed(events) == []


@pytest.mark.parametrize("start", [Start(), Start("0"), Start("0", heading=1.0), Start(spread=2.0)])
def test_a_start_needs_a_place_or_a_heading(start: Start) -> None:
    with pytest.raises(FloorPlanError, match="no place"):
        Session(floorplan=read_floorplan("examples/building.geojson"), start=start)
