"""Activities of emulated wearers, as the part for activities reports them."""

from __future__ import annotations

from functools import cache
from math import pi, radians

import attrs
import pytest

from solepath import Session, recipes
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.sensors.sensortags import CC2541
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.emulate.wearers.walker import Walker
from solepath.events import ActivityChanged, Event, FlightClimbed, LiftRidden
from solepath.types import Activity, Foot, Packet, Sample, Site
from solepath.walk.timeline import Timeline

HOUSE = (
    Route().stand(3.0).walk(8.0, 1.3).stairs(11).walk(1.2).turn(pi, 0.6).stairs(11).walk(5.0).turn(pi)
    .lift(-6.8, speed=1.2).walk(7.0).stand(4.0).jog(30.0, 2.7).stand(3.0)
)  # fmt: skip
CELLAR = (
    Route().stand(3.0).walk(6.0, 1.2).stairs(12, up=False).walk(6.0).turn(radians(90)).lift(3.4).walk(5.0).stand(3.0)
)
CORRECT_SHARE = 0.9
"""Share of the time that must be right.

A ride is dated from its first jerk until its doors open, and a wearer who halts has one foot still while the other
closes.
"""


@cache
def walker(route: Route) -> Walker:
    return Walker(route, seed=5)


@cache
def samples(route: Route, rate: float) -> tuple[Sample, ...]:
    samples_found = [sample for foot in Foot for sample in walker(route).samples(foot, rate, LSM6DSOX)]
    return tuple(sorted(samples_found, key=lambda sample: sample.t))


@cache
def sensortag_walk() -> EmulatedWalk:
    """Return a walk with two of the older SensorTags, at 20 Hz, with barometers."""
    return emulate(HOUSE, devices={Site.LEFT_FOOT: CC2541(rate=20.0), Site.RIGHT_FOOT: CC2541(rate=20.0)}, seed=5)


def run(items: tuple[Sample, ...] | tuple[Packet, ...]) -> tuple[list[Event], Timeline]:
    session = Session(recipes.DEFAULT)
    events = [event for item in items for event in session.feed(item)] + session.finish()
    timeline = Timeline()
    for event in events:
        if isinstance(event, ActivityChanged):
            timeline.add(event)
    return events, timeline


def correct_share(timeline: Timeline, route: Route) -> float:
    """Return the share of the time for which the timeline has the truth, without the last two seconds."""
    truth = walker(route).truth()
    times = [0.1 * k for k in range(int(10.0 * (truth.duration - 2.0)))]
    return sum(timeline.at(t) is truth.activity(t) for t in times) / len(times)


@pytest.mark.parametrize(("route", "rate"), [(HOUSE, 20.0), (CELLAR, 50.0)])
def test_standing_walking_running_stairs_and_lifts_are_reported(route: Route, rate: float) -> None:
    _, timeline = run(samples(route, rate))
    assert correct_share(timeline, route) >= CORRECT_SHARE


def test_one_foot_is_enough() -> None:
    left = tuple(sample for sample in samples(HOUSE, 50.0) if sample.site is Site.LEFT_FOOT)
    _, timeline = run(left)
    assert correct_share(timeline, HOUSE) >= CORRECT_SHARE - 0.05


def test_feet_without_gyroscopes_still_show_standing_moving_and_lifts() -> None:
    events, timeline = run(tuple(attrs.evolve(sample, gyro=None) for sample in samples(HOUSE, 50.0)))
    truth = walker(HOUSE).truth()
    still = (Activity.STANDING, Activity.ELEVATOR_DOWN)
    times = [0.1 * k for k in range(int(10.0 * (truth.duration - 2.0)))]
    equal_share = sum((timeline.at(t) in still) == (truth.activity(t) in still) for t in times) / len(times)
    assert equal_share >= CORRECT_SHARE
    assert [event.up for event in events if isinstance(event, LiftRidden)] == [False]


@pytest.mark.soak
def test_a_ride_is_reported_with_its_times_and_its_height() -> None:
    events, _ = run(samples(HOUSE, 50.0))
    (ride,) = [event for event in events if isinstance(event, LiftRidden)]
    (true,) = walker(HOUSE).truth().rides
    assert not ride.up
    assert abs(ride.t_start - true.start) < 1.0 and abs(ride.t - true.end) < 1.0
    assert ride.height is not None and abs(ride.height - true.height) < 1.0


@pytest.mark.soak
def test_a_barometer_measures_the_ride() -> None:
    events, _ = run(sensortag_walk().packets)
    (ride,) = [event for event in events if isinstance(event, LiftRidden)]
    assert not ride.up
    assert ride.height is not None and abs(ride.height + 6.8) < 1.0


def test_flights_are_reported_with_their_direction() -> None:
    events, _ = run(samples(HOUSE, 50.0))
    assert [event.up for event in events if isinstance(event, FlightClimbed)] == [True, True]


@pytest.mark.soak
def test_everything_is_reported_within_a_few_seconds_of_its_start() -> None:
    first: dict[Activity, float] = {}
    for event in run(samples(HOUSE, 50.0))[0]:
        if isinstance(event, ActivityChanged):
            first.setdefault(event.activity, event.known_at - event.t)
    walked = {Activity.WALKING, Activity.STAIRS_UP, Activity.RUNNING}
    assert walked <= first.keys() and max(first[activity] for activity in walked) < 4.0


def test_a_runner_runs_at_every_stride() -> None:
    route = Route().stand(2.0).walk(6.0, 1.3).jog(30.0, 2.8).walk(4.0, 1.3).stand(2.0)
    running = [span for span in walker(route).truth().activities if span[2] is Activity.RUNNING][0]
    known = [
        event.activity
        for event in run(samples(route, 50.0))[0]
        if isinstance(event, ActivityChanged)
        and event.t > running[0] - 1.0  # what was done before may become final meanwhile
        and running[0] + 2.0 < event.known_at < running[1] - 1.0
    ]
    assert Activity.WALKING not in known, "a level stride is no walk: it may be run as well"
