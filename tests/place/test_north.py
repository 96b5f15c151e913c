"""A compass in the feet, on a plan that knows its north, settles which end of a building it is."""

from __future__ import annotations

from functools import cache
from math import atan2, cos, dist, pi, sin

import pytest
from attrs import evolve
from floors import FloorEvents, Method, follow, office, placed, tour

from solepath import Event, PlanContradicted
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Anchor, FloorPlan
from solepath.place.headings import DECLINATION, heading_by_north

SEEDS = range(1, 5)
BEARING = 0.6
"""Bearing of the office in these tests, rad, clockwise from north."""
PROVEN_AFTER = 20
"""Number of events after which the compass knows where north is."""


@cache
def anchored() -> IndexedPlan:
    return IndexedPlan(office(Anchor(48.0, 11.0, BEARING)))


def with_north(received: list[FloorEvents], turned: float, sigma: float = 0.1) -> list[FloorEvents]:
    """Return what is received with a compass for which the track is turned by `turned`, rad, against the plan."""
    north = (0.5 * pi + BEARING + turned, sigma)
    return [
        evolve(one, here=evolve(one.here, north=north)) if number >= PROVEN_AFTER else one
        for number, one in enumerate(received)
    ]


@cache
def misled(method: type[Method], seed: int) -> tuple[Method, list[Event]]:
    """Return a part whose compass is wrong by a right angle, after a tour, and its events."""
    part, pedestrian = method(), tour(seed)
    return part, follow(part, with_north(pedestrian.received, pedestrian.turned + 0.5 * pi), anchored())


def decided(part: Method, received: list[FloorEvents], plan: IndexedPlan | None = None) -> int:
    """Return the number of places until one candidate had nine tenths of the weight."""
    places = placed(follow(part, received, plan or anchored()))
    return next((k for k, place in enumerate(places) if place.candidates[0].weight >= 0.9), len(places))


@pytest.mark.soak
def test_with_the_compass_fewer_strides_decide_where_the_wearer_is(part: Method) -> None:
    new, with_compass, without = type(part), 0, 0
    for seed in SEEDS:
        pedestrian = tour(seed)
        with_compass += decided(new(), with_north(pedestrian.received, pedestrian.turned))
        without += decided(new(), pedestrian.received)
    assert with_compass < 0.8 * without


@pytest.mark.soak
def test_a_north_that_is_wrong_leaves_the_true_place_among_the_candidates(part: Method) -> None:
    for seed in SEEDS:
        events = placed(misled(type(part), seed)[1])
        true = [one.place for one in tour(seed).received if one.place is not None][-1]
        assert any(dist(one.position[:2], true) < 4.0 for one in events[-1].candidates), seed


def test_walls_that_contradict_the_compass_are_reported_once_and_it_is_used_no_longer(part: Method) -> None:
    found = 0
    for seed in SEEDS:
        one, events = misled(type(part), seed)
        contradicted = [event for event in events if isinstance(event, PlanContradicted)]
        assert len(contradicted) <= 1
        if contradicted:
            found += 1
            assert contradicted[0].what.startswith("the heading by the compass in the feet does not fit the plan by")
    assert found > 0


@pytest.mark.soak
def test_a_compass_that_is_right_is_not_contradicted(part: Method) -> None:
    for seed in SEEDS:
        pedestrian = tour(seed)
        events = follow(type(part)(), with_north(pedestrian.received, pedestrian.turned + 0.15), anchored())
        assert not any(isinstance(event, PlanContradicted) for event in events)


@pytest.mark.parametrize(("bearing", "direction", "heading"), [
    (0.0, 0.5 * pi, 0.0),  # the plan's y axis and the first heading's left are north: the wearer set out to the east
    (0.0, 0.0, 0.5 * pi),  # the first heading is north, and so is the plan's y axis
    (0.5 * pi, 0.0, pi),  # the plan's y axis is east, so its x axis is south
])  # fmt: skip
def test_the_heading_follows_from_the_bearing_and_the_direction_of_north(
    bearing: float, direction: float, heading: float
) -> None:
    known = heading_by_north(FloorPlan("", (), (), Anchor(0.0, 0.0, bearing)), (direction, 0.1))
    assert known is not None
    assert atan2(sin(known[0] - heading), cos(known[0] - heading)) == pytest.approx(0.0, abs=1e-9)
    assert known[1] == pytest.approx(DECLINATION + 0.2)
