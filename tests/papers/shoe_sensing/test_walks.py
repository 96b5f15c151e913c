"""Shoe sensing on emulated walks with an MPU-6050 on each instep: steps, heights, states and flights."""

from __future__ import annotations

from functools import cache
from math import radians

import pytest
from walks import both_feet, run_session

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import MPU6050
from solepath.emulate.wearers.shoe import ON_INSTEP
from solepath.emulate.wearers.truth import Truth
from solepath.emulate.wearers.walker import Walker
from solepath.events import ActivityChanged, Event, FlightClimbed, StrideTaken
from solepath.papers.shoe_sensing.recipe import SHOE_SENSING, SHOE_SENSING_PRINTED
from solepath.types import Activity, Foot, Sample

LEVEL = Route().stand(3.0).walk(30.0, 1.3).stop(2.0)
JOG = Route().stand(3.0).jog(40.0, 2.6).stop(2.0)
STAIRS = Route().stand(3.0).walk(5.0, 1.2).stairs(10).turn(radians(180), 0.7).stairs(10).walk(4.0).stop(2.0)
DOWN = Route().stand(3.0).walk(5.0, 1.2).stairs(9, up=False).walk(1.3).stairs(9, up=False).walk(4.0).stop(2.0)


@cache
def samples_and_truth(route: Route, seed: int, rate: float = 100.0) -> tuple[tuple[Sample, ...], Truth]:
    walker = Walker(route, seed=seed)
    return both_feet(walker, rate, MPU6050, mounting=ON_INSTEP), walker.truth(dict.fromkeys(Foot, ON_INSTEP))


@cache
def events_of(route: Route, seed: int, rate: float = 100.0) -> tuple[Event, ...]:
    return tuple(run_session(samples_and_truth(route, seed, rate)[0], SHOE_SENSING_PRINTED))


@cache
def ours_of(route: Route, seed: int, rate: float = 100.0) -> tuple[Event, ...]:
    return tuple(run_session(samples_and_truth(route, seed, rate)[0], SHOE_SENSING))


def strides_of(events: tuple[Event, ...], foot: Foot) -> list[StrideTaken]:
    return [event for event in events if isinstance(event, StrideTaken) and event.foot is foot]


@pytest.mark.parametrize(("route", "rate"), [(LEVEL, 40.0), (JOG, 100.0)], ids=["walk at 40 Hz", "jog"])
def test_every_level_step_is_found_and_ends_as_high_as_it_started(route: Route, rate: float) -> None:
    for foot in Foot:
        found, true = strides_of(ours_of(route, 1, rate), foot), samples_and_truth(route, 1, rate)[1].strides(foot)
        # the first two of a jog may be reported as one
        assert len(true) - (route is JOG) <= len(found) <= len(true)
        assert all(min(abs(step.t - other.t_end) for other in true) < 0.15 for step in found)
        assert abs(found[-1].position[2]) <= 0.1
        assert sum(step.length for step in found) == pytest.approx(sum(s.length for s in true), rel=0.06)


@pytest.mark.parametrize(("route", "up"), [(STAIRS, True), (DOWN, False)], ids=["up", "down"])
def test_flights_on_both_sides_of_a_landing_are_two(route: Route, up: bool) -> None:
    found = [event for event in events_of(route, 1) if isinstance(event, FlightClimbed)]
    true = samples_and_truth(route, 1)[1].flights
    assert [flight.up for flight in found] == [up, up]
    for flight, other in zip(found, true, strict=True):
        assert flight.height == pytest.approx(other.height, abs=0.35)
        assert other.start - 1.5 < flight.t_start < flight.t < other.end + 1.5


@pytest.mark.parametrize(
    ("route", "stairs"), [(STAIRS, Activity.STAIRS_UP), (DOWN, Activity.STAIRS_DOWN)], ids=["up", "down"]
)
def test_states_are_those_of_the_steps(route: Route, stairs: Activity) -> None:
    found = [event for event in events_of(route, 1) if isinstance(event, ActivityChanged)]
    assert [event.t for event in found] == sorted(event.t for event in found)
    assert all(event.final and event.probability is None and event.known_at >= event.t for event in found)
    kinds = [event.activity for event in found]
    assert kinds[0] is Activity.STANDING and kinds[1] is Activity.WALKING and kinds[-1] is Activity.STANDING
    assert set(kinds) == {Activity.STANDING, Activity.WALKING, stairs}
    truth = samples_and_truth(route, 1)[1]
    starts = [start for start, _, what in truth.activities if what is stairs]
    assert any(abs(event.t - starts[0]) < 1.5 for event in found if event.activity is stairs)
