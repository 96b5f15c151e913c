"""Flights, risers and storeys of different heights: what the plan says about its stairs counts."""

from __future__ import annotations

from math import dist

import pytest
from attrs import evolve
from floors import LOW, STAIRS, Method, Pedestrian, activity_changed, beside, indexed_office, office, placed

from solepath import Activity, FlightClimbed
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import ConnectorKind, ConnectorStop, FloorPlan

ELEVATIONS = (0.0, 2.6, 8.2)
"""Floors of a building with a low storey and a hall of 5.6 m above it, m."""
NAME = "stairs south"


def unequal(flights: int | None = 2, heights_known: bool = True) -> FloorPlan:
    """Return the office with a second upper floor, and a hall between both."""
    plan = office()
    top = evolve(plan.levels[1], id="2", name="floor 2", ordinal=2)
    levels = [evolve(level, elevation=z) for level, z in zip((*plan.levels, top), ELEVATIONS, strict=True)]
    connectors = [
        evolve(one, stops=(*one.stops, ConnectorStop("2", one.stops[0].place, one.stops[0].outline)),
               flights=flights if one.kind is ConnectorKind.STAIRS else None)
        for one in plan.connectors
    ]  # fmt: skip
    return evolve(plan, levels=tuple(levels), connectors=tuple(connectors), heights_known=heights_known)


def climb(pedestrian: Pedestrian, level: str, flights: tuple[float, ...], rest: float) -> None:
    """Climb flights of these heights, m, with a rest on each half-way landing, s; what is reported comes 2 s late."""
    direction = 1.0 if STAIRS[NAME][1] < 15.0 else -1.0
    for number, height in enumerate(flights):
        start, direction = pedestrian.t, -direction if number else direction
        up = Activity.STAIRS_UP if height > 0.0 else Activity.STAIRS_DOWN
        for k in range(10):
            if k == 4:
                pedestrian.emit(activity_changed(start, pedestrian.t, up))
            pedestrian.step(0.0, 0.28 * direction, 0.1 * height, counts=False)
        end = pedestrian.t
        is_last = number == len(flights) - 1
        pedestrian.t += 2.0 if is_last else rest
        pedestrian.emit(
            FlightClimbed(t=end, known_at=end + 1.0, t_start=start, up=height > 0.0, steps=10, height=height),
            activity_changed(end, end + 2.0, Activity.WALKING),
        )
        if not is_last:
            pedestrian.step(0.05, 0.0, counts=False)
    pedestrian.level = level


def climbed(part: Method, plan: FloorPlan, start: str, end: str, flights: tuple[float, ...], rest: float) -> list[str]:
    """Return the levels of the places of a wearer who comes to the stairs, climbs them and walks on."""
    pedestrian = Pedestrian(5, start, (20.0, LOW)).known_to(part)
    pedestrian.walk(beside(STAIRS[NAME]), STAIRS[NAME])
    before = len(pedestrian.received)
    climb(pedestrian, end, flights, rest)
    arrived = len(pedestrian.received)
    pedestrian.walk(beside(STAIRS[NAME]), (14.0, LOW))
    index = IndexedPlan(plan)
    events = [placed(part.follow(index, one.events, one.here)) for one in pedestrian.received]
    assert {place.level for places in events[:before] for place in places} == {start}
    last = placed([place for places in events[arrived:] for place in places])[-1]
    assert dist(last.position[:2], pedestrian.place) < 3.0
    return [place.level for places in events[arrived:] for place in places]


@pytest.mark.parametrize("rest", [2.0, 30.0])
@pytest.mark.parametrize(("start", "end", "flights"), [
    ("1", "2", (2.8, 2.8)),  # each flight is as high as the storey below
    ("2", "1", (-2.8, -2.8)),
    ("0", "1", (1.3, 1.3)),
    ("1", "0", (-1.3, -1.3)),
])  # fmt: skip
def test_a_wearer_climbs_from_floor_to_floor_with_a_rest_on_the_landing(
    part: Method, start: str, end: str, flights: tuple[float, ...], rest: float
) -> None:
    assert climbed(part, unequal(), start, end, flights, rest)[-1] == end


@pytest.mark.parametrize("up", [True, False])
def test_a_rest_half_way_is_no_arrival_and_the_second_half_is_one(part: Method, up: bool) -> None:
    start, end, height = ("0", "1", 1.8) if up else ("1", "0", -1.8)
    assert climbed(part, indexed_office().plan, start, end, (height, height), 30.0)[-1] == end


def test_a_wearer_who_turns_back_on_the_landing_is_on_the_floor_where_they_started(part: Method) -> None:
    assert climbed(part, unequal(), "1", "1", (2.8, -2.8), 30.0)[-1] == "1"
