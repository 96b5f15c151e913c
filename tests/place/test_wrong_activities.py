"""Wrong activities and turns: the true place stays among the candidates, and walls decide."""

from __future__ import annotations

from math import cos, dist, radians, sin

import pytest
from attrs import evolve
from floors import (
    HIGH,
    LEFT,
    LIFTS,
    LOW,
    OFFICE,
    RIGHT,
    STAIRS,
    FloorEvents,
    Method,
    Pedestrian,
    activity_changed,
    beside,
    follow,
    office,
    placed,
)

from solepath import Activity, LiftRidden, TurnMade
from solepath.body.place.rows import round_rows
from solepath.floorplan.index import IndexedPlan

NEAR = 3.5


def near(part: Method, level: str, place: tuple[float, float]) -> float:
    """Return the weight of all candidates on that level near the place."""
    here = [] if part.place is None else [one for one in part.place.candidates if one.level == level]
    return sum([one.weight for one in here if dist(one.position[:2], place) < NEAR])


def never_drops_the_truth(part: Method, received: list[FloorEvents]) -> None:
    for one in received:
        part.follow(OFFICE, one.events, one.here)
        assert one.level is None or one.place is None or near(part, one.level, one.place) > 0.0


def test_a_wearer_who_walks_past_stairs_that_are_reported_as_climbed_stays_among_the_candidates(part: Method) -> None:
    one = Pedestrian(201, "0", (20.0, LOW)).known_to(part)
    one.walk(beside(STAIRS["stairs south"]))
    one.emit(activity_changed(one.t, one.t, Activity.STAIRS_UP))
    for k in range(20):  # to and fro before the stairs, as on two flights
        one.step(0.25 if k < 10 else -0.25, 0.0)
    one.emit(activity_changed(one.t, one.t, Activity.WALKING))
    one.walk((RIGHT, LOW))
    never_drops_the_truth(part, one.received)
    assert part.place is not None and {found.level for found in part.place.candidates} >= {"0"}


@pytest.mark.parametrize("words", [("down", "down"), ("down", "up"), ("up", "down")])
def test_stairs_up_that_are_reported_as_stairs_down_lead_up_where_there_is_no_way_down(
    part: Method, words: tuple[str, str]
) -> None:
    one = Pedestrian(202, "0", (20.0, LOW)).known_to(part)
    one.walk(beside(STAIRS["stairs south"]), STAIRS["stairs south"])
    one.track = (one.track[0], one.track[1], 0.0)
    for flight, word in enumerate(words):
        one.emit(activity_changed(one.t, one.t, Activity.STAIRS_UP if word == "up" else Activity.STAIRS_DOWN))
        for _ in range(10):
            one.step(0.0, 0.28 if flight == 0 else -0.28, counts=False)  # a track that knows no heights
    one.emit(activity_changed(one.t, one.t, Activity.WALKING))
    one.level = "1"
    one.walk(beside(STAIRS["stairs south"]), (RIGHT, LOW))
    follow(part, one.received)
    assert near(part, "1", one.place) > 0.1


def test_a_wearer_whose_flights_are_reported_up_and_down_may_be_on_either_level(part: Method) -> None:
    one = Pedestrian(203, "1", STAIRS["stairs south"])
    one.step(0.1, 0.0, counts=False)
    for flight, word in enumerate((Activity.STAIRS_UP, Activity.STAIRS_DOWN)):
        one.emit(activity_changed(one.t, one.t, word))
        for _ in range(10):
            one.step(0.0, 0.28 if flight == 0 else -0.28, counts=False)
    one.emit(activity_changed(one.t, one.t, Activity.WALKING))
    one.level = "0"
    one.walk(beside(STAIRS["stairs south"]), (RIGHT, LOW))
    follow(part, one.received)
    assert part.place is not None
    assert near(part, "0", one.place) > 0.0
    assert {found.level for found in part.place.candidates} == {"0", "1"}


@pytest.mark.parametrize("wrong", [-110.0, 100.0])
def test_an_about_turn_that_the_track_has_wrong_by_a_hundred_degrees_is_put_right_by_the_walls(
    part: Method, wrong: float
) -> None:
    one = Pedestrian(204, "0", (12.0, LOW)).known_to(part)
    one.walk((20.0, LOW))
    one.turned += radians(wrong)
    t_start = one.t
    one.t += 3.0
    one.step(-0.5, 0.0)
    one.step(-0.6, 0.0)
    one.emit(TurnMade(t=t_start + 3.0, known_at=one.t, t_start=t_start, angle=radians(180.0 + wrong), turn=None))
    one.received[-1] = evolve_angle(one.received[-1])
    one.walk((LEFT, LOW), (LEFT, HIGH))
    never_drops_the_truth(part, one.received)
    assert near(part, "0", one.place) > 0.9


def evolve_angle(received: FloorEvents) -> FloorEvents:
    """The turn is told as the about-turn that it is: feet tell turns better than tracks that are led by saturated
    sensors."""
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
    one = Pedestrian(205, "0", (20.0, LOW)).known_to(part)
    one.walk(beside(STAIRS["stairs south"]), STAIRS["stairs south"])
    one.emit(activity_changed(one.t, one.t, Activity.STAIRS_UP))
    for k in range(20):
        one.step(0.0, 0.28 if k < 10 else -0.28, rise, counts=False)
    one.emit(activity_changed(one.t, one.t, Activity.WALKING))
    one.level = "1"
    one.walk(beside(STAIRS["stairs south"]), (RIGHT, LOW), (RIGHT, 14.0))
    events = follow(part, one.received, plan)
    last = placed(events)[-1]
    assert last.level == "1" and near(part, "1", one.place) > 0.9
    assert last.position[2] == pytest.approx(20.0 * rise, abs=1e-3), "the track's own height"
    assert {one.position[2] for one in last.candidates} == {last.position[2]}


def test_a_ride_over_a_storey_of_another_height_than_guessed_ends_on_the_next_level(part: Method) -> None:
    one = Pedestrian(206, "0", LIFTS["lift south"]).known_to(part)
    one.step(0.05, 0.0)
    one.emit(LiftRidden(t=one.t + 10.0, known_at=one.t + 11.0, t_start=one.t + 2.0, up=True, height=4.6))
    one.t += 12.0
    one.level = "1"
    one.walk(beside(one.place), (24.0, LOW))
    follow(part, one.received, unknown_heights())
    assert near(part, "1", one.place) > 0.9


def test_rows_are_kept_to_three_digits_and_no_less_when_they_are_kept_again() -> None:
    rows = [(10.0 + k, 2.0 * k, cos(0.1 * k), sin(0.1 * k), 1.0 / (1 + k), k % 3, k % 2, 0) for k in range(40)]
    again = round_rows(rows)
    for before, after in zip(rows, again, strict=True):
        assert after[:5] == pytest.approx(before[:5], rel=1e-3, abs=1e-3) and after[5:] == before[5:]
    assert round_rows(again) == again and round_rows([]) == []
