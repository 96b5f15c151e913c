"""Contradictions to the plan are reported, and the places go on: a wrong first heading, rides that the plan lacks."""

from __future__ import annotations

from math import dist, pi

import pytest
from floors import LIFTS, LOW, RIGHT, STOREY, Method, Pedestrian, beside, follow, placed, round_to, tour
from soak import soaked
from views import told

from solepath import Event, LiftRidden, PlanContradicted, Start
from solepath.body.part import StartGiven

SEEDS = range(1, 5)
LIFT = LIFTS["lift south"]


def contradicted(events: list[Event]) -> list[PlanContradicted]:
    return [event for event in events if isinstance(event, PlanContradicted)]


def ride(pedestrian: Pedestrian, by: float, level: str | None = None) -> None:
    """Ride by so many metres, and to a level if the ride ends at one; the event comes 1 s after the end."""
    start = pedestrian.t + 3.0
    pedestrian.t += 12.0
    pedestrian.level = level or pedestrian.level
    pedestrian.emit(LiftRidden(t=pedestrian.t - 1.0, known_at=pedestrian.t, t_start=start, up=by > 0.0, height=by))


def weight_near(part: Method, level: str, place: tuple[float, float]) -> float:
    """Return the weight of all candidates on that level near the place."""
    here = [] if part.place is None else [one for one in part.place.candidates if one.level == level]
    return sum([one.weight for one in here if dist(one.position[:2], place) < 3.5])


def in_the_lift(part: Method, seed: int) -> Pedestrian:
    """Return a pedestrian who is known to the part, and has walked into the lift on the lowest level."""
    pedestrian = Pedestrian(seed, "0", (20.0, LOW)).known_to(part)
    pedestrian.walk(beside(LIFT), LIFT)
    return pedestrian


@pytest.mark.parametrize("off", [0.5 * pi, *soaked(-0.25 * pi)])
def test_a_first_heading_that_was_wrong_is_reported_once_with_the_angle_to_add(part: Method, off: float) -> None:
    new, found = type(part), []
    for seed in SEEDS:
        pedestrian, one = tour(seed), new()
        told(one, StartGiven(Start(heading=-pedestrian.turned + off)))
        events = contradicted(follow(one, pedestrian.received))
        assert len(events) <= 1
        found += [event for event in events if event.heading_off == pytest.approx(-off, abs=0.35)]
    assert len(found) >= 0.5 * len(SEEDS), "in a building with two ends, some wrong headings fit as well"
    assert "degrees" in found[0].what and found[0].height_off is None


def test_a_first_heading_that_was_right_is_not_reported(part: Method) -> None:
    for seed in SEEDS:
        pedestrian, one = tour(seed), type(part)()
        told(one, StartGiven(Start(heading=-pedestrian.turned + 0.1)))
        assert not contradicted(follow(one, pedestrian.received))


def test_rides_from_landing_to_landing_do_not_contradict_the_plan(part: Method) -> None:
    for seed, error in ((301, 0.5), (302, -0.5), (303, 0.0)):
        one = type(part)()
        pedestrian = in_the_lift(one, seed)
        ride(pedestrian, STOREY + error, "1")
        pedestrian.walk(beside(LIFT), (RIGHT, LOW))
        assert not contradicted(follow(one, pedestrian.received))


def test_a_lift_that_stops_between_two_floors_is_reported_at_once_and_the_next_landing_is_found(part: Method) -> None:
    pedestrian = in_the_lift(part, 311)
    ride(pedestrian, 1.7)
    (event,) = contradicted(follow(part, pedestrian.received))
    assert event.height_off == pytest.approx(1.7 - STOREY, abs=0.01) and event.heading_off is None
    assert event.known_at == pedestrian.t
    assert {one.level for one in placed_after(part, pedestrian)} == {"0", "1"}
    before = len(pedestrian.received)
    ride(pedestrian, 1.9, "1")
    pedestrian.walk(*round_to(beside(LIFT), (RIGHT, 14.0), forwards=True))
    follow(part, pedestrian.received[before:])
    assert weight_near(part, "1", pedestrian.place) > 0.0


def placed_after(part: Method, pedestrian: Pedestrian) -> list:
    assert part.place is not None
    return list(part.place.candidates)


@pytest.mark.parametrize("by", [-STOREY, 3.5 * STOREY])
def test_a_lift_to_a_landing_that_the_plan_lacks_is_reported_and_who_comes_back_is_found(
    part: Method, by: float
) -> None:
    pedestrian = in_the_lift(part, 321)
    ride(pedestrian, by)
    events = follow(part, pedestrian.received)
    assert len(contradicted(events)) == 1 and "lift" in contradicted(events)[0].what
    before = len(pedestrian.received)
    ride(pedestrian, -by)
    pedestrian.walk(beside(LIFT), (RIGHT, LOW))
    events = follow(part, pedestrian.received[before:])
    assert placed(events) and weight_near(part, "0", pedestrian.place) > 0.0
