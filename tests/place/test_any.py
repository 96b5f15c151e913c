"""Contracts of a place on a floor plan for any track, and messages about plans of no use."""

from __future__ import annotations

import json
from math import inf, isfinite, nan

import pytest
from attrs import evolve
from floors import (
    HIGH,
    LIFTS,
    LOW,
    METHODS,
    RIGHT,
    Method,
    Pedestrian,
    activity_changed,
    beside,
    follow,
    indexed_office,
    lost,
    office,
    stepped,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from views import told
from walks import insoles

from solepath import (
    Activity,
    Event,
    FlightClimbed,
    Foot,
    LiftRidden,
    Placed,
    PlaceLost,
    PlanContradicted,
    Session,
    recipes,
)
from solepath.body.part import Position, StartGiven
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import FloorPlan, Level, Start, Wall
from solepath.saving import codec as machine
from solepath.saving.schema import record_of
from solepath.saving.streams import Lists, to_bytes

NUMBERS = st.one_of(
    st.floats(-60.0, 60.0), st.floats(allow_nan=True, allow_infinity=True), st.sampled_from([0.0, 1e-300, 1e300, -1e9])
)
TIMES = st.one_of(st.floats(0.0, 100.0), st.sampled_from([0.0, -1e9, 1e12]))
EVENTS = st.one_of(
    st.builds(
        lambda t, foot, degraded: stepped(t, foot, 1, (0.0, 0.0, 0.0), degraded),
        TIMES,
        st.sampled_from(Foot),
        st.booleans(),
    ),
    st.builds(lambda t, activity: activity_changed(t, t, activity), TIMES, st.sampled_from(Activity)),
    st.builds(
        lambda t, d, up, height: LiftRidden(t=t, known_at=t, t_start=t - d, up=up, height=height),
        TIMES,
        st.floats(-5.0, 50.0),
        st.booleans(),
        st.none() | NUMBERS,
    ),
    st.builds(
        lambda t, d, up, height: FlightClimbed(t=t, known_at=t, t_start=t - d, up=up, steps=8, height=height),
        TIMES,
        st.floats(-5.0, 50.0),
        st.booleans(),
        NUMBERS,
    ),
)
UPDATES = st.lists(
    st.tuples(st.lists(EVENTS, max_size=4), TIMES, st.tuples(NUMBERS, NUMBERS, NUMBERS)), min_size=1, max_size=25
)
STARTS = st.one_of(
    st.none(),
    st.builds(
        Start,
        st.sampled_from(["0", "1", "attic"]),
        st.tuples(st.floats(-5.0, 45.0), st.floats(-5.0, 35.0)),
        st.none() | st.floats(-1e6, 1e6),
        st.floats(-1e300, 1e300),
    ),
)


@pytest.mark.parametrize("method", METHODS)
@settings(max_examples=40)
@given(start=STARTS, updates=UPDATES)
def test_any_events_and_any_track_give_sound_events_and_no_exception(method, start, updates) -> None:  # type: ignore[no-untyped-def]
    part = method()
    if start is not None:
        told(part, StartGiven(start))
    for events, t, position in updates:
        here = Position(t, position, (0.0,) * 6)  # type: ignore[arg-type]
        received = part.follow(indexed_office(), events, here)
        assert not received or part.place == (received[-1] if isinstance(received[-1], Placed) else None)
        for event in received:
            assert isinstance(event, Placed | PlaceLost | PlanContradicted) and event.known_at >= event.t
            if isinstance(event, Placed):
                numbers = [*event.position, event.spread, *(c.weight for c in event.candidates)]
                assert all(isfinite(number) for number in numbers)
                assert {c.level for c in event.candidates} <= {"0", "1"}
                assert sum(c.weight for c in event.candidates) == pytest.approx(1.0)
            else:
                assert "\n" not in event.what
    assert machine.load(method, json.loads(json.dumps(machine.save(part)))) == part


def packed_size(part: object) -> int:
    lists = Lists([], [], [], [])
    record_of(type(part)).write(part, lists)
    return len(to_bytes(lists))


def test_the_state_is_small_and_does_not_grow(part: Method) -> None:
    sizes = []
    pedestrian = Pedestrian(21, "1", LIFTS["lift south"])
    pedestrian.ride("0")
    for _ in range(3):
        pedestrian.walk(
            beside(pedestrian.place), (RIGHT, LOW), (RIGHT, HIGH), (6.2, HIGH), (6.2, LOW), beside(pedestrian.place)
        )
    decided_sizes = []
    for received in pedestrian.received:
        part.follow(indexed_office(), received.events, received.here)
        sizes.append(packed_size(part))
        if part.place is not None and len(part.place.candidates) == 1:
            decided_sizes.append(sizes[-1])
    assert max(sizes) < 10_000, "while it is undecided"
    assert sum(decided_sizes) / len(decided_sizes) < 8_000 and max(decided_sizes[-100:]) < 10_000, "once it is decided"


@pytest.mark.parametrize(
    ("start", "reason"),
    [
        (Start("3", (10.0, LOW)), "start: the plan has no level '3', only 0, 1"),
        (Start("0", (-4.0, 3.0)), "start: (-4, 3) is nowhere on level 0"),
    ],
)
def test_a_start_outside_of_the_plan_is_reported_once_and_the_wearer_is_found_later(
    part: Method, start: Start, reason: str
) -> None:
    pedestrian = Pedestrian(22, "1", LIFTS["lift south"])
    pedestrian.step(0.1, 0.0)
    pedestrian.step(-0.1, 0.0)
    pedestrian.ride("0")
    pedestrian.walk(beside(pedestrian.place), (RIGHT, LOW), (RIGHT, HIGH))
    told(part, StartGiven(start))
    events = follow(part, pedestrian.received)
    assert len(lost(events)) == 1 and lost(events)[0].startswith(reason)
    assert part.place is not None and part.place.level == "0"


def test_a_track_through_walls_is_not_bent_to_the_plan_for_long_but_loses_the_place(part: Method) -> None:
    pedestrian = Pedestrian(23, "0", (12.0, LOW)).known_to(part)
    pedestrian.walk((20.0, LOW), (20.0, 40.0))  # across the block, where nobody can go, and out of the house
    events = follow(part, pedestrian.received)
    assert part.place is None
    assert len(lost(events)) == 1
    assert "the track goes where the plan has no way near (" in lost(events)[0]
    pedestrian.received, pedestrian.level, pedestrian.place = [], "1", LIFTS["lift south"]
    pedestrian.ride("0")
    pedestrian.walk(beside(pedestrian.place), (RIGHT, LOW), (RIGHT, HIGH))
    follow(part, pedestrian.received)
    assert part.place is not None, "the next lift finds the wearer again"


def test_a_wearer_who_leaves_by_the_door_is_no_longer_on_the_plan(part: Method) -> None:
    pedestrian = Pedestrian(24, "0", (20.0, LOW)).known_to(part)
    pedestrian.walk((60.0, LOW))
    events = follow(part, pedestrian.received)
    assert part.place is None and len(lost(events)) == 1
    assert "the track leaves the plan near (4" in lost(events)[0] and "on level 0" in lost(events)[0]


def test_a_track_that_jumps_loses_the_place(part: Method) -> None:
    pedestrian = Pedestrian(25, "0", (12.0, LOW)).known_to(part)
    pedestrian.walk((16.0, LOW))
    pedestrian.step(500.0, 0.0)
    assert lost(follow(part, pedestrian.received)) == ["the track leaps by more than 100 m"]


def test_without_start_stairs_and_lifts_the_place_is_reported_as_lost(part: Method) -> None:
    bare = IndexedPlan(evolve(office(), connectors=()))
    pedestrian = Pedestrian(26, "0", (12.0, LOW))
    pedestrian.walk((30.0, LOW))
    pedestrian.ride("1")
    what = "no start was given and the plan has neither stairs nor lifts: the place cannot be known"
    assert lost(follow(part, pedestrian.received, bare)) == [what] and part.place is None


@pytest.mark.soak
def test_the_position_is_never_bent_to_the_plan() -> None:
    bare = Session(recipes.DEFAULT)
    on_plan = Session(recipes.DEFAULT, floorplan=square(30.0), start=Start("0", (15.0, 15.0), 0.3))
    events: list[Event] = []
    for packet in insoles(cells=12).packets:
        bare.feed(packet)
        events += on_plan.feed(packet)
        assert bare.position == on_plan.position
    assert any(isinstance(event, Placed) for event in events)
    assert bare.place is None and on_plan.place is not None


def square(side: float) -> FloorPlan:
    corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
    walls = tuple(Wall(a, b) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True))
    return FloorPlan("hall", (Level("0", "hall", 0, 0.0, walls),))


def test_a_start_of_what_is_no_number_is_the_callers_mistake() -> None:
    for start in (Start("0", (10.0, LOW), nan), Start("0", (nan, LOW)), Start("0", (10.0, LOW), 0.0, inf)):
        with pytest.raises(ValueError, match="start: "):
            Session(floorplan=office(), start=start)
