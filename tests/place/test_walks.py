"""Finding the wearer on a floor plan: tours through an office of two floors, with the errors of recorded tracks."""

from __future__ import annotations

from math import atan2, cos, degrees, dist, sin

import pytest
from attrs import define, field
from floors import (
    HIGH,
    LEFT,
    LIFTS,
    LOW,
    METHODS,
    RIGHT,
    STAIRS,
    STOREY,
    FloorEvents,
    Method,
    Pedestrian,
    activity_changed,
    beside,
    indexed_office,
    lost,
    placed,
    round_to,
    tour,
)
from views import told

from solepath import Activity, Event
from solepath.body.part import StartGiven
from solepath.floorplan.plan import Start
from solepath.place.placing import Particles

SURE = 0.99
"""Weight at which a candidate counts as found."""
NEAR_DISTANCE = 3.5
"""Largest distance of the true candidate from the wearer, m: candidates are means over some metres."""


@define
class Followed:
    """The result of a tour."""

    errors: list[float] = field(factory=list)
    """Distances while one candidate has nearly all of the weight, m; infinite on another level."""
    dropped: int = 0
    """Number of strides at which no candidate was near the wearer."""
    found: int | None = None
    events: list[Event] = field(factory=list)

    @property
    def mean(self) -> float:
        return sum(self.errors) / len(self.errors)


def follow_and_score(part: Method, received: list[FloorEvents]) -> Followed:
    result = Followed()
    for k, update in enumerate(received):
        result.events += part.follow(indexed_office(), update.events, update.here)
        place = part.place
        if update.place is None or update.level is None:
            continue
        if place is None:
            result.dropped += 1
            continue
        here = [candidate for candidate in place.candidates if candidate.level == update.level]
        off = [dist(candidate.position[:2], update.place) for candidate in here]
        result.dropped += min(off, default=99.0) > NEAR_DISTANCE
        sure = place.candidates[0].weight >= SURE
        if sure and result.found is None:
            result.found = k
        if sure:
            result.errors.append(
                dist(place.position[:2], update.place) if place.level == update.level else float("inf")
            )
    return result


@pytest.mark.parametrize("seed", [1, 2])
def test_a_wearer_who_comes_out_of_some_lift_is_found_and_followed_within_a_metre(part: Method, seed: int) -> None:
    result = follow_and_score(part, tour(seed).received)
    assert result.dropped == 0
    assert result.errors and result.mean <= 1.0
    assert len(lost(result.events)) == 1 and "no start" in lost(result.events)[0]


@pytest.mark.long
@pytest.mark.parametrize("method", METHODS)
def test_the_true_candidate_is_never_dropped_in_fifty_walks_and_the_mean_error_is_below_a_metre(method: Method) -> None:
    results = [follow_and_score(method(), tour(seed).received) for seed in range(1, 51)]
    assert [result.dropped for result in results] == [0] * 50
    found = [result for result in results if result.errors]
    assert len(found) >= 48
    assert sum(result.mean for result in found) / len(found) <= 1.0


def test_all_possible_places_are_reported_with_weights_that_add_up_to_one(part: Method) -> None:
    received = tour(4).received
    first = placed(follow_and_score(part, received[:3]).events)[-1]
    assert {candidate.origin for candidate in first.candidates} == set(LIFTS)
    weights = [candidate.weight for candidate in first.candidates]
    assert sum(weights) == pytest.approx(1.0) and weights == sorted(weights, reverse=True)
    assert first.position == first.candidates[0].position and first.spread > 5.0 and not first.final
    assert first.t <= first.known_at


@pytest.mark.parametrize("known", [True, False])
def test_a_known_start_finds_the_wearer_with_or_without_the_heading(part: Method, known: bool) -> None:
    pedestrian = Pedestrian(7, "0", (12.0, LOW))
    start = Start("0", pedestrian.place, -pedestrian.turned if known else None)
    pedestrian.walk((RIGHT, LOW), (RIGHT, HIGH), (20.0, HIGH))
    told(part, StartGiven(start))
    result = follow_and_score(part, pedestrian.received)
    assert result.dropped == 0 and lost(result.events) == []
    assert result.errors[-1] <= 1.0
    heading = placed(result.events)[-1].candidates[0].heading
    assert heading is not None
    off = heading + pedestrian.turned
    assert abs(degrees(atan2(sin(off), cos(off)))) < 5.0
    if known:
        assert result.found == 0 and result.mean <= 1.0


@pytest.mark.parametrize("flights", [True, False])
def test_stairs_lead_to_the_other_level_and_the_height_is_the_plans_not_the_tracks(part: Method, flights: bool) -> None:
    pedestrian = Pedestrian(8, "0", (LEFT, 12.0)).known_to(part)
    pedestrian.walk((LEFT, LOW), beside(STAIRS["stairs south"]), STAIRS["stairs south"])
    pedestrian.climb("1", "stairs south", flights)
    x, y, z = pedestrian.track
    pedestrian.track = (x, y, z + 0.4)  # as a track's height drifts
    pedestrian.walk(beside(STAIRS["stairs south"]), (RIGHT, LOW), (RIGHT, 15.0))
    result = follow_and_score(part, pedestrian.received)
    assert result.dropped == 0 and result.mean <= 1.0
    last = placed(result.events)[-1]
    assert last.level == "1" and last.position[2] == STOREY
    heights = [event.position[2] for event in placed(result.events)]
    assert min(heights) == 0.0 and max(heights) == STOREY
    assert any(0.5 < height < 3.0 for height in heights), "on the stairs one is between the levels"


def test_a_landing_half_way_up_is_no_level(part: Method) -> None:
    pedestrian = Pedestrian(9, "0", (20.0, LOW)).known_to(part)
    pedestrian.walk(beside(STAIRS["stairs south"]), STAIRS["stairs south"])
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.STAIRS_UP))
    for _ in range(10):
        pedestrian.step(0.0, 0.28, 0.18)
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.WALKING))
    for _ in range(2):
        pedestrian.step(0.4, 0.0)
    assert placed(follow_and_score(part, pedestrian.received).events)[-1].level == "0"
    pedestrian.received = []
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.STAIRS_UP))
    for _ in range(10):
        pedestrian.step(0.0, -0.28, 0.18)
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.WALKING))
    pedestrian.step(0.0, -0.5)
    assert placed(follow_and_score(part, pedestrian.received).events)[-1].level == "1"


def test_a_few_steps_that_look_like_stairs_on_level_ground_change_nothing(part: Method) -> None:
    pedestrian = Pedestrian(10, "0", (9.0, LOW)).known_to(part)
    pedestrian.walk((24.0, LOW))
    pedestrian.emit(activity_changed(pedestrian.t - 1.0, pedestrian.t, Activity.STAIRS_UP))
    pedestrian.walk((26.0, LOW))
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.WALKING))
    pedestrian.walk((RIGHT, LOW), (RIGHT, HIGH))
    result = follow_and_score(part, pedestrian.received)
    assert result.dropped == 0 and result.mean <= 1.0
    assert {event.level for event in placed(result.events)} == {"0"}


def test_a_ride_far_from_the_estimated_place_restarts_the_search(part: Method) -> None:
    pedestrian = Pedestrian(12, "0", (14.0, HIGH))
    told(part, StartGiven(Start("0", (20.0, HIGH), None)))  # wrong by 6 m, and far from every lift
    pedestrian.walk((18.0, HIGH))
    pedestrian.place, pedestrian.level = LIFTS["lift east"], "1"
    pedestrian.ride("0")
    pedestrian.walk(*round_to(beside(LIFTS["lift east"]), (14.0, LOW), False), (LEFT, LOW), (LEFT, 14.0))
    result = follow_and_score(part, pedestrian.received)
    last = placed(result.events)[-1]
    true = [c for c in last.candidates if c.level == "0" and dist(c.position[:2], pedestrian.place) <= 1.5]
    assert len(last.candidates) <= 3, "the office looks nearly the same from the other side"
    assert true and true[0].weight > 0.1 and true[0].origin == "lift east"


def test_a_wearer_whose_kept_track_begins_after_the_lift_is_not_sought_from_there_again() -> None:
    """Other events than strides move the wearer too, so that the track that is kept may be that of six strides."""
    lift = LIFTS["lift west"]
    for seed in range(5):
        part, pedestrian, events = Particles(), Pedestrian(seed, "0", lift), list[Event]()
        part.plan = indexed_office()
        pedestrian.walk(lift)
        pedestrian.ride("1")
        pedestrian.walk(beside(lift), (LEFT, HIGH), (20.0, HIGH))
        for one in pedestrian.received:
            for seen in (one, *[FloorEvents([], one.here)] * 3):
                events += part.follow(indexed_office(), seen.events, seen.here)
        assert part.place is not None and part.place.level == "1"
        assert dist(part.place.position[:2], pedestrian.place) < 2.0
