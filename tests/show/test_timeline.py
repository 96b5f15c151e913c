"""Tests the activities over time, from the events that report them."""

from __future__ import annotations

from solepath import Activity, ActivityChanged
from solepath.walk.timeline import Timeline


def changed(t: float, activity: Activity, revises: float | None = None, final: bool = True) -> ActivityChanged:
    return ActivityChanged(t=t, known_at=t + 3.0, activity=activity, probability=None, revises=revises, final=final)


def timeline(*events: ActivityChanged) -> Timeline:
    line = Timeline()
    for event in events:
        line.add(event)
    return line


def test_an_activity_lasts_until_the_next_one_starts():
    line = timeline(changed(1.0, Activity.STANDING), changed(4.0, Activity.WALKING))
    assert [line.at(t) for t in (0.5, 1.0, 3.9, 4.0, 100.0)] == [
        Activity.UNKNOWN, Activity.STANDING, Activity.STANDING, Activity.WALKING, Activity.WALKING,
    ]  # fmt: skip
    assert line.spans(6.0) == [(1.0, 4.0, Activity.STANDING), (4.0, 6.0, Activity.WALKING)]


def test_standing_that_turns_out_to_be_a_lift_ride_was_never_standing():
    standing = changed(4.0, Activity.STANDING, final=False)
    line = timeline(changed(1.0, Activity.WALKING), standing, changed(5.0, Activity.ELEVATOR_UP, revises=4.0))
    assert line.at(4.5) is Activity.WALKING and line.at(5.0) is Activity.ELEVATOR_UP
    assert line.durations(9.0) == {Activity.WALKING: 4.0, Activity.ELEVATOR_UP: 4.0}


def test_an_event_dated_before_an_earlier_one_takes_its_place():
    line = timeline(changed(1.0, Activity.STANDING), changed(4.0, Activity.WALKING), changed(3.0, Activity.STAIRS_UP))
    assert line.spans(5.0) == [(1.0, 3.0, Activity.STANDING), (3.0, 5.0, Activity.STAIRS_UP)]
