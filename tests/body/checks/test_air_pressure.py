"""Air pressure that is not that of the height: doors of pressurised rooms, barometers that drift or are stuck."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import exp, pi

import pytest
from attrs import evolve
from soak import soaked

from solepath import ActivityChanged, DefectFound, LiftRidden, Sample, Session, StrideTaken
from solepath.body.altitude import SCALE_HEIGHT, STANDARD_PRESSURE
from solepath.emulate import CC2541, Insole, Route, emulate, sampled
from solepath.emulate.walk import SampledWalk
from solepath.events import Defect, Event, FlightClimbed
from solepath.types import Activity, Foot, Site

FEET = {Site.LEFT_FOOT: Foot.LEFT, Site.RIGHT_FOOT: Foot.RIGHT}
RIDE = 6.8
LEVEL = Route(speed=1.2).stand(25.0).walk(30.0).stand(20.0).walk(10.0).stop(2.0)
LIFT = Route(speed=1.2).stand(2.0).walk(20.0).turn(pi).lift(RIDE, speed=1.4).walk(30.0).stop(2.0)
STAIRS = Route(speed=1.2).stand(2.0).walk(12.0).stairs(20, True, 0.17, 0.29).walk(20.0).stop(2.0)
Disturb = Callable[[float, float], float]
"""Function of the time, s, and of the true air pressure, Pa."""


@cache
def walked(route: Route) -> SampledWalk:
    return sampled(route, insoles={site: Insole(cells=24) for site in FEET}, seed=101)


def true(t: float, pascal: float) -> float:
    return pascal


def drifts(t: float, pascal: float) -> float:
    return pascal - 10.0 * t


def door(t: float, pascal: float) -> float:
    return pascal - (50.0 if t > 35.0 else 0.0)


def stuck(t: float, pascal: float) -> float:
    return STANDARD_PRESSURE


@cache
def session(route: Route, disturb: Disturb, late: float = 0.0) -> tuple[Session, list[Event]]:
    """Return a session, and its events, of a walk whose feet read a barometer once a second.

    The samples of the right foot come `late` s after those of the left one."""
    walk, read, samples = walked(route), dict[Site, float](), list[Sample]()
    for sample in walk.samples:
        if sample.t - read.get(sample.site, -9.0) >= 1.0:
            read[sample.site] = sample.t
            z = float(walk.truth.pose(FEET[sample.site], sample.t).position.flat[2])
            pascal = disturb(sample.t, STANDARD_PRESSURE * exp(-z / SCALE_HEIGHT))
            sample = evolve(sample, air_pressure=pascal)
        samples.append(sample)
    samples.sort(key=lambda sample: sample.t + (late if sample.site is Site.RIGHT_FOOT else 0.0))
    one = Session()
    return one, one.feed(samples) + one.finish()


def defects(events: list[Event]) -> list[DefectFound]:
    return [event for event in events if isinstance(event, DefectFound)]


def height(one: Session) -> float:
    assert one.position is not None
    return one.position.position[2]


@pytest.mark.parametrize("route", [LIFT, *soaked(LEVEL, STAIRS)])
@pytest.mark.soak
def test_a_barometer_that_shows_the_height_is_not_reported(route: Route) -> None:
    assert not defects(session(route, true)[1])


@pytest.mark.parametrize("disturb", soaked(drifts, door))
def test_pressure_alone_is_neither_a_ride_nor_stairs(disturb: Disturb) -> None:
    one, events = session(LEVEL, disturb)
    reported = {event.activity for event in events if isinstance(event, ActivityChanged)}
    assert reported <= {Activity.STANDING, Activity.WALKING, Activity.UNKNOWN}
    assert not [event for event in events if isinstance(event, LiftRidden | FlightClimbed)]
    assert abs(height(one)) < 0.3


@pytest.mark.parametrize(("route", "disturb"), [(LEVEL, drifts), (LEVEL, door), (STAIRS, stuck)])
@pytest.mark.soak
def test_it_is_reported_once_for_each_foot_and_no_stride_is_degraded_by_it(route: Route, disturb: Disturb) -> None:
    _, events = session(route, disturb)
    found = defects(events)
    assert {event.defect for event in found} == {Defect.AIR_PRESSURE} and not any(event.spoils for event in found)
    assert sorted(event.site.value for event in found) == ["left_foot", "right_foot"]
    assert all(" Pa " in event.what for event in found)
    assert not any(event.degraded for event in events if isinstance(event, StrideTaken))


@pytest.mark.soak
def test_a_lift_is_as_high_as_its_pulses_when_the_barometer_drifts() -> None:
    one, events = session(LIFT, drifts)
    (ride,) = [event for event in events if isinstance(event, LiftRidden)]
    assert ride.height == pytest.approx(RIDE, abs=0.1 * RIDE) and height(one) == pytest.approx(RIDE, abs=0.1 * RIDE)


@pytest.mark.soak
def test_stairs_are_climbed_with_a_barometer_that_is_stuck() -> None:
    one, events = session(STAIRS, stuck)
    (flight,) = [event for event in events if isinstance(event, FlightClimbed)]
    assert flight.up and height(one) == pytest.approx(3.4, abs=0.4)


def test_what_a_clipped_gyroscope_explains_is_no_fault_of_the_barometer() -> None:
    route = Route().stand(3.0).walk(45.0, 1.3).stop(2.0)
    sent = emulate(route, devices={Site.LEFT_FOOT: CC2541(), Site.RIGHT_FOOT: CC2541()}, seed=3).packets
    session = Session()
    found = [event for packet in sent for event in session.feed(packet) if isinstance(event, DefectFound)]
    assert Defect.CLIPPED in {one.defect for one in found}
    assert Defect.AIR_PRESSURE not in {one.defect for one in found}
