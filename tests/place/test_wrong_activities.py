"""Wrong activities and turns: the true place stays among the candidates, and walls decide."""

from __future__ import annotations

from math import dist, radians

import pytest
from attrs import evolve
from floors import (
    HIGH,
    LEFT,
    LIFTS,
    LOW,
    RIGHT,
    STAIRS,
    FloorEvents,
    Method,
    Pedestrian,
    activity_changed,
    beside,
    follow,
    indexed_office,
    office,
    placed,
)

from solepath import Activity, LiftRidden, TurnMade
from solepath.floorplan.index import IndexedPlan

NEAR_DISTANCE = 3.5


def weight_near(part: Method, level: str, place: tuple[float, float]) -> float:
    """Return the weight of all candidates on that level near the place."""
    here = [] if part.place is None else [candidate for candidate in part.place.candidates if candidate.level == level]
    return sum([candidate.weight for candidate in here if dist(candidate.position[:2], place) < NEAR_DISTANCE])


def assert_truth_is_kept(part: Method, received: list[FloorEvents]) -> None:
    for update in received:
        part.follow(indexed_office(), update.events, update.here)
        assert update.level is None or update.place is None or weight_near(part, update.level, update.place) > 0.0


def test_a_wearer_who_walks_past_stairs_that_are_reported_as_climbed_stays_among_the_candidates(part: Method) -> None:
    pedestrian = Pedestrian(201, "0", (20.0, LOW)).known_to(part)
    pedestrian.walk(beside(STAIRS["stairs south"]))
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.STAIRS_UP))
    for k in range(20):  # to and fro before the stairs, as on two flights
        pedestrian.step(0.25 if k < 10 else -0.25, 0.0)
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.WALKING))
    pedestrian.walk((RIGHT, LOW))
    assert_truth_is_kept(part, pedestrian.received)
    assert part.place is not None and {candidate.level for candidate in part.place.candidates} >= {"0"}


@pytest.mark.parametrize("words", [("down", "down"), ("down", "up"), ("up", "down")])
def test_stairs_up_that_are_reported_as_stairs_down_lead_up_where_there_is_no_way_down(
    part: Method, words: tuple[str, str]
) -> None:
    pedestrian = Pedestrian(202, "0", (20.0, LOW)).known_to(part)
    pedestrian.walk(beside(STAIRS["stairs south"]), STAIRS["stairs south"])
    pedestrian.track = (pedestrian.track[0], pedestrian.track[1], 0.0)
    for flight, word in enumerate(words):
        pedestrian.emit(
            activity_changed(pedestrian.t, pedestrian.t, Activity.STAIRS_UP if word == "up" else Activity.STAIRS_DOWN)
        )
        for _ in range(10):
            pedestrian.step(0.0, 0.28 if flight == 0 else -0.28, counts=False)  # a track that knows no heights
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.WALKING))
    pedestrian.level = "1"
    pedestrian.walk(beside(STAIRS["stairs south"]), (RIGHT, LOW))
    follow(part, pedestrian.received)
    assert weight_near(part, "1", pedestrian.place) > 0.1


@pytest.mark.parametrize("wrong", [-110.0, 75.0, 165.0])
def test_an_about_turn_that_the_track_has_wrong_by_any_angle_is_put_right_by_the_walls(
    part: Method, wrong: float
) -> None:
    pedestrian = Pedestrian(204, "0", (12.0, LOW)).known_to(part)
    pedestrian.walk((20.0, LOW))
    pedestrian.turned += radians(wrong)
    t_start = pedestrian.t
    pedestrian.t += 3.0
    pedestrian.step(-0.5, 0.0)
    pedestrian.step(-0.6, 0.0)
    pedestrian.emit(
        TurnMade(t=t_start + 3.0, known_at=pedestrian.t, t_start=t_start, angle=radians(180.0 + wrong), turn=None)
    )
    pedestrian.received[-1] = evolve_angle(pedestrian.received[-1])
    pedestrian.walk((LEFT, LOW), (LEFT, HIGH))
    assert_truth_is_kept(part, pedestrian.received)
    assert weight_near(part, "0", pedestrian.place) > 0.9


def evolve_angle(received: FloorEvents) -> FloorEvents:
    """Return the events with the true angle of the turn, which feet measure better than tracks with clipped sensors."""
    return FloorEvents(
        [evolve(event, angle=3.2) for event in received.events if isinstance(event, TurnMade)], received.here
    )


def unknown_heights() -> IndexedPlan:
    """Return a plan that has only the order of its levels: 3 m between them are a guess."""
    plan = office()
    levels = tuple(evolve(level, elevation=3.0 * k) for k, level in enumerate(plan.levels))
    return IndexedPlan(evolve(plan, levels=levels, heights_known=False))


@pytest.mark.parametrize("rise", [0.14, 0.22])
def test_unknown_heights_neither_keep_a_wearer_from_another_level_nor_are_reported(part: Method, rise: float) -> None:
    plan = unknown_heights()
    pedestrian = Pedestrian(205, "0", (20.0, LOW)).known_to(part)
    pedestrian.walk(beside(STAIRS["stairs south"]), STAIRS["stairs south"])
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.STAIRS_UP))
    for k in range(20):
        pedestrian.step(0.0, 0.28 if k < 10 else -0.28, rise, counts=False)
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t, Activity.WALKING))
    pedestrian.level = "1"
    pedestrian.walk(beside(STAIRS["stairs south"]), (RIGHT, LOW), (RIGHT, 14.0))
    events = follow(part, pedestrian.received, plan)
    last = placed(events)[-1]
    assert last.level == "1" and weight_near(part, "1", pedestrian.place) > 0.9
    assert last.position[2] == pytest.approx(20.0 * rise, abs=1e-3), "the track's own height"
    assert {candidate.position[2] for candidate in last.candidates} == {last.position[2]}


def test_a_ride_over_a_storey_of_another_height_than_guessed_ends_on_the_next_level(part: Method) -> None:
    pedestrian = Pedestrian(206, "0", LIFTS["lift south"]).known_to(part)
    pedestrian.step(0.05, 0.0)
    pedestrian.emit(
        LiftRidden(t=pedestrian.t + 10.0, known_at=pedestrian.t + 11.0, t_start=pedestrian.t + 2.0, up=True, height=4.6)
    )
    pedestrian.t += 12.0
    pedestrian.level = "1"
    pedestrian.walk(beside(pedestrian.place), (24.0, LOW))
    follow(part, pedestrian.received, unknown_heights())
    assert weight_near(part, "1", pedestrian.place) > 0.9
