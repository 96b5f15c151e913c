"""A sensor that freezes: named within a second, left out of the wearer's position, and no sensor that merely rests."""

from __future__ import annotations

from functools import cache
from math import dist, hypot

import pytest
from attrs import evolve
from walks import both_feet, of

from solepath import Defect, DefectFound, Event, Foot, Sample, Session, StrideTaken
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker

WALKER = Walker(Route().stand(2.0).walk(24.0, 1.3).stop(1.0), seed=4)
SWING, STANCE = 4.0, 0.3
"""Angular rates above which a foot swings, and below which it stands, rad/s."""


@cache
def walk(rate: float) -> tuple[Sample, ...]:
    return both_feet(WALKER, rate, LSM6DSOX)


@cache
def end_of_walk(rate: float) -> tuple[float, float, float]:
    session = Session()
    session.feed(walk(rate))
    assert session.position is not None
    return session.position.position


def freezing(samples: tuple[Sample, ...], feet: tuple[Foot, ...], swings: bool) -> tuple[float, list[Sample]]:
    """Return samples of sensors that freeze after 8 s, when the first of these feet swings or stands, and that time."""
    frozen: dict[Foot | None, Sample] = {}
    found, since = list[Sample](), 0.0
    for sample in samples:
        turn = hypot(*(sample.gyro or ()))
        if not since and sample.t > 8.0 and sample.site.foot is feet[0] and (turn > SWING if swings else turn < STANCE):
            since = sample.t
        if since and sample.site.foot in feet:
            first = frozen.setdefault(sample.site.foot, sample)
            sample = evolve(sample, acc=first.acc, gyro=first.gyro)
        found.append(sample)
    return since, found


def stuck(events: list[Event]) -> list[DefectFound]:
    return [event for event in of(DefectFound, events) if event.defect is Defect.REPEATED]


@pytest.mark.parametrize("swings", [True, False], ids=["in swing", "in stance"])
@pytest.mark.parametrize(
    "rate", [20.0, 100.0, *[pytest.param(rate, marks=pytest.mark.soak) for rate in (50.0, 200.0, 400.0)]]
)
def test_a_foot_whose_sensor_freezes_is_named_within_a_second_and_leaves_the_position(
    rate: float, swings: bool
) -> None:
    since, samples = freezing(walk(rate), (Foot.LEFT,), swings)
    session = Session()
    events = session.feed(samples)
    (event,) = stuck(events)
    assert event.site.foot is Foot.LEFT and event.spoils and event.known_at - since < 1.0
    assert event.what == "every value has been the same for 0.5 s: the sensor is stuck; restart it"
    assert not [stride for stride in of(StrideTaken, events) if stride.foot is Foot.LEFT and stride.t > since]
    assert session.position is not None and dist(session.position.position, end_of_walk(rate)) < 1.0


@pytest.mark.parametrize("swings", [True, False], ids=["in swing", "in stance"])
def test_when_both_sensors_freeze_nobody_walks_on(swings: bool) -> None:
    since, samples = freezing(walk(100.0), (Foot.RIGHT, Foot.LEFT), swings)
    session = Session()
    before = session.feed([sample for sample in samples if sample.t <= since])
    here = session.position
    events = session.feed([sample for sample in samples if sample.t > since])
    there = session.position
    assert {event.site.foot for event in stuck([*before, *events])} == set(Foot)
    assert not of(StrideTaken, events)
    assert here is not None and there is not None and dist(here.position, there.position) < 2.0


def test_a_sensor_that_holds_a_value_for_a_tenth_of_a_second_now_and_then_is_not_stuck() -> None:
    """A radio that repeats its last packet does so."""
    samples, held = list[Sample](), dict[Foot | None, Sample]()
    for sample in walk(100.0):
        if sample.t % 1.7 > 0.1:
            held[sample.site.foot] = sample
        samples.append(evolve(sample, acc=held[sample.site.foot].acc, gyro=held[sample.site.foot].gyro)
                       if held.get(sample.site.foot) else sample)  # fmt: skip
    events = Session().feed(samples)
    assert not [event for event in stuck(events) if event.spoils] and len(of(StrideTaken, events)) > 25


def test_a_wearer_who_stands_still_with_sensors_without_noise_is_no_fault() -> None:
    exact = Walker(Route().stand(20.0), seed=1).samples(Foot.LEFT, 100.0)
    assert of(DefectFound, Session().feed(exact)) == []


def test_a_sensor_that_wakes_again_is_followed_again() -> None:
    since, samples = freezing(walk(100.0), (Foot.LEFT,), True)
    awake = [now if now.t > since + 2.0 else sample for sample, now in zip(samples, walk(100.0), strict=True)]
    events = Session().feed(awake)
    strides = [one for one in of(StrideTaken, events) if one.foot is Foot.LEFT and one.t_start > since + 4.5]
    assert len(stuck(events)) == 1 and len(strides) > 4
    assert all(stride.degraded and 1.2 < stride.length < 1.7 for stride in strides[:-1])
