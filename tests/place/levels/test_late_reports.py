"""A change of level is counted once, whether its flights and rides are known before it is decided or after it."""

from __future__ import annotations

from math import dist

import pytest
from attrs import evolve
from floors import (
    LEFT,
    LIFTS,
    LOW,
    STAIRS,
    STOREY,
    Method,
    Pedestrian,
    activity_changed,
    beside,
    follow,
    office,
    placed,
)
from soak import longer

from solepath import Activity, EscalatorRidden, Event, FlightClimbed, LiftRidden
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import ConnectorKind, ConnectorStop, Point

NAME = "stairs south"
CONNECTORS = ("spiral stairs", "turning stairs", "escalator", "lift")
WAYS = {"once": (1,), "two storeys in a row": (1, 1), "and back at once": (1, -1)}
"""Storeys of a way, one after the other, 1 up and -1 down."""


def tall_office(flights: int) -> IndexedPlan:
    """Return the office with three storeys, whose stairs have so many flights a storey."""
    plan = office()
    top = evolve(plan.levels[1], id="2", name="floor 2", ordinal=2, elevation=2.0 * STOREY)
    connectors = [
        evolve(one, stops=(*one.stops, ConnectorStop("2", one.stops[0].place, one.stops[0].outline)),
               flights=flights if one.kind is ConnectorKind.STAIRS else None)
        for one in plan.connectors
    ]  # fmt: skip
    return IndexedPlan(evolve(plan, levels=(*plan.levels, top), connectors=tuple(connectors)))


def climb(pedestrian: Pedestrian, up: bool, flights: int, late: bool) -> None:
    """Climb a storey; the report of each flight comes before the end of the stairs is known, or two steps after it."""
    reports = list[Event]()
    for flight in range(flights):
        start, count = pedestrian.t, 20 // flights
        for k in range(count):
            if k == 3:
                activity = Activity.STAIRS_UP if up else Activity.STAIRS_DOWN
                pedestrian.emit(activity_changed(start, pedestrian.t, activity))
            inwards = 1.0 if (flight if flights > 1 else k // 10) == 0 else -1.0
            pedestrian.step(0.0, 0.28 * inwards, (STOREY if up else -STOREY) / 20.0, counts=False)
        end, height = pedestrian.t, (STOREY if up else -STOREY) / flights
        flight_event = FlightClimbed(t=end + 0.2, known_at=end + 0.6, t_start=start, up=up, steps=count, height=height)
        reports = [activity_changed(end, end + 0.6, Activity.WALKING), flight_event]
        for report in reports if late else reports[::-1]:
            pedestrian.emit(report)
            pedestrian.step(0.1, 0.0, counts=False)
            pedestrian.step(-0.1, 0.0, counts=False)
    pedestrian.level = str(int(pedestrian.level) + (1 if up else -1))


def ride(pedestrian: Pedestrian, up: bool, late: bool) -> None:
    """Ride by a storey; the ride is reported before the activity that it ends, or after the steps out of the cabin."""
    start, activity = pedestrian.t + 2.0, Activity.ELEVATOR_UP if up else Activity.ELEVATOR_DOWN
    pedestrian.t += 9.0
    end, height = pedestrian.t - 1.0, STOREY if up else -STOREY
    x, y, z = pedestrian.track
    pedestrian.track = (x, y, z + height)
    event = LiftRidden(t=end, known_at=pedestrian.t, t_start=start, up=up, height=height)
    activities = [activity_changed(start, end, activity), activity_changed(end + 0.5, end + 1.0, Activity.STANDING)]
    for reports in (activities, [event]) if late else ([event], activities):
        pedestrian.emit(*reports)
        for _ in range(2):
            pedestrian.step(0.05, 0.0, counts=False)
            pedestrian.step(-0.05, 0.0, counts=False)
    pedestrian.level = str(int(pedestrian.level) + (1 if up else -1))


def stand_on_escalator(pedestrian: Pedestrian, up: bool, late: bool) -> None:
    """Stand on an escalator by a storey; the ride is reported before the steps away from it, or after them."""
    start = pedestrian.t + 2.0
    pedestrian.t += 16.0
    end, height = pedestrian.t - 2.0, STOREY if up else -STOREY
    if not late:
        pedestrian.emit(EscalatorRidden(t=end, known_at=pedestrian.t, t_start=start, up=up, height=height))
    for step in (0.05, -0.05, 0.05, -0.05):
        pedestrian.step(step, 0.0, counts=False)
    if late:
        pedestrian.emit(EscalatorRidden(t=end, known_at=pedestrian.t, t_start=start, up=up, height=height))
    x, y, z = pedestrian.track
    pedestrian.track = (x, y, z + height)
    pedestrian.level = str(int(pedestrian.level) + (1 if up else -1))


def go(pedestrian: Pedestrian, connector: str, storeys: tuple[int, ...], late: bool) -> Point:
    """Come to a connector, take it over these storeys, and walk away; return where it is."""
    place = LIFTS["lift south"] if connector == "lift" else STAIRS[NAME]
    pedestrian.walk(beside(place), place)
    for storey in storeys:
        if connector == "lift":
            ride(pedestrian, storey > 0, late)
        elif connector == "escalator":
            stand_on_escalator(pedestrian, storey > 0, late)
        else:
            climb(pedestrian, storey > 0, 2 if connector == "turning stairs" else 1, late)
    pedestrian.walk(beside(place), (LEFT, LOW), (LEFT, 15.0))
    return place


@pytest.mark.parametrize("late", [False, True], ids=["report before", "report after"])
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("connector", [*CONNECTORS[1::2], *longer(*CONNECTORS[::2])])
def test_a_storey_is_counted_once_whenever_its_flights_and_rides_are_reported(
    part: Method, connector: str, way: str, late: bool
) -> None:
    for up, method in ((True, part), (False, type(part)())):
        storeys = tuple([one if up else -one for one in WAYS[way]])
        pedestrian = Pedestrian(3, "0" if up else "2", (20.0, LOW)).known_to(method)
        go(pedestrian, connector, storeys, late)
        events = follow(method, pedestrian.received, tall_office(1 if connector == "spiral stairs" else 2))
        last = placed(events)[-1]
        assert last.level == pedestrian.level and dist(last.position[:2], pedestrian.place) < 1.5
        assert last.candidates[0].weight > 0.8


@pytest.mark.parametrize("late", [False, True], ids=["report before", "report after"])
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("connector", [*CONNECTORS[1::2], *longer(*CONNECTORS[::2])])
def test_without_a_start_the_true_place_is_among_the_candidates(
    part: Method, connector: str, way: str, late: bool
) -> None:
    pedestrian = Pedestrian(4, "0", (20.0, LOW))
    go(pedestrian, connector, WAYS[way], late)
    events = follow(part, pedestrian.received, tall_office(1 if connector == "spiral stairs" else 2))
    near = [
        one
        for one in placed(events)[-1].candidates
        if one.level == pedestrian.level and dist(one.position[:2], pedestrian.place) < 3.0
    ]
    assert sum([one.weight for one in near]) > 0.05


@pytest.mark.parametrize("withdrawn", [False, True])
def test_a_step_taken_for_stairs_on_the_way_out_of_a_lift_does_not_undo_the_ride(part: Method, withdrawn: bool) -> None:
    pedestrian, lift = Pedestrian(6, "1", (20.0, LOW)).known_to(part), LIFTS["lift south"]
    pedestrian.walk(beside(lift), lift)
    start = pedestrian.t + 2.0
    pedestrian.t += 11.0
    end, (x, y, z) = pedestrian.t - 2.0, pedestrian.track
    pedestrian.track = (x, y, z + STOREY)
    pedestrian.emit(
        activity_changed(start, end, Activity.ELEVATOR_UP),
        activity_changed(end + 0.5, end + 1.0, Activity.STANDING),
        activity_changed(end + 1.5, end + 2.0, Activity.STAIRS_UP),
    )
    pedestrian.step(0.0, -0.4, counts=False)
    if withdrawn:
        pedestrian.emit(activity_changed(end + 2.0, pedestrian.t, Activity.WALKING))
    pedestrian.step(0.0, -0.4, counts=False)
    pedestrian.emit(LiftRidden(t=end, known_at=pedestrian.t, t_start=start, up=True, height=STOREY))
    if not withdrawn:
        pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.WALKING))
    pedestrian.level = "2"
    pedestrian.walk(beside(lift), (LEFT, LOW), (LEFT, 15.0))
    plan = tall_office(2).plan
    near = [
        evolve(one, stops=tuple([evolve(stop, place=(16.5, 7.0)) for stop in one.stops[:2]]))
        if one.name == NAME
        else one
        for one in plan.connectors
    ]  # stairs beside the lift, which lead down only
    last = placed(follow(part, pedestrian.received, IndexedPlan(evolve(plan, connectors=tuple(near)))))[-1]
    assert last.level == "2" and dist(last.position[:2], pedestrian.place) < 1.5
