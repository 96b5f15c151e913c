"""Motions that take nobody anywhere on foot have no strides, no gait and no finding: wheels, seats, steps on the spot.

The motions are made, and what is idealised is said where they are made. Not asserted, because it fails: sensors that
are handled are said to be filtered, because a hand that moves them stops more softly than a step; and a bag that is
shaken hard is said to run for up to a tenth of the time, without strides."""

from __future__ import annotations

import pytest
from attrs import evolve
from soak import soaked
from walks import LEFT, of, samples

from solepath import Activity, ActivityChanged, DefectFound, FlightClimbed, Foot, FootFlat, Session, StrideTaken
from solepath.emulate.routes.route import Route
from solepath.walk.timeline import Timeline
from solepath_lab.emulated.other_motions import MOTIONS, samples_of

HANDLED, SHAKEN = "handled, on a table", "shaken, in a bag"
QUICK = [
    ("marching on the spot", 23), ("bicycling", 23), ("inline skating", 23), ("sitting, legs dangle", 23),
    (HANDLED, 23),
]  # fmt: skip
"""A march that is as even as a walk, a ride, skates on which a foot seems to rest, legs that are pendulums, and sensors
that a hand picks up and puts down."""
CASES = [(motion.name, seed) for motion in MOTIONS for seed in (23, 24)]
GAITS = {Activity.WALKING, Activity.RUNNING, Activity.STAIRS_UP, Activity.STAIRS_DOWN}
DURATION, RATE = 40.0, 50.0


@pytest.mark.parametrize("case", [*QUICK, *soaked(*[case for case in CASES if case not in QUICK])])
def test_who_walks_nowhere_takes_no_strides_and_mends_no_sensor(case: tuple[str, int]) -> None:
    name, seed = case
    motion = evolve(next(one for one in MOTIONS if one.name == name), duration=DURATION)
    session, timeline = Session(), Timeline()
    events = session.feed(samples_of(motion, seed, RATE)) + session.finish()
    for event in of(ActivityChanged, events):
        timeline.add(event)
    assert [event for event in of(StrideTaken, events) if event.final] == []
    assert name == HANDLED or of(DefectFound, events) == []
    activities = [timeline.at(0.1 * k) for k in range(100, int(10.0 * DURATION))]
    assert sum(one in GAITS for one in activities) <= (0.15 if name == SHAKEN else 0.03) * len(activities)


STANDING_AT_TIMES = pytest.param(
    28, marks=[pytest.mark.soak, pytest.mark.xfail(strict=True, reason="14 of 84 s of this one are called standing")]
)


@pytest.mark.parametrize("seed", [25, *soaked(26, 27), STANDING_AT_TIMES])
def test_a_sensor_that_is_put_down_elsewhere_takes_neither_strides_nor_flights_and_does_not_stand(seed: int) -> None:
    motion = next(one for one in MOTIONS if one.name == HANDLED)
    session, timeline = Session(), Timeline()
    events = session.feed(samples_of(motion, seed, 100.0)) + session.finish()
    for event in of(ActivityChanged, events):
        timeline.add(event)
    assert [event for event in of(StrideTaken, events) if event.final and not event.flaws] == []
    assert of(FlightClimbed, events) == []
    assert len(of(FootFlat, events)) > 100  # it comes to rest as often as a foot
    activities = [timeline.at(0.1 * k) for k in range(100, 940)]
    assert activities.count(Activity.UNKNOWN) > 0.95 * len(activities)


PEDALLERS, SITTERS = [8123, *soaked(8101, 8102, 8103)], [8124, *soaked(8133, 8136, 8156)]


@pytest.mark.parametrize("seed", PEDALLERS)
def test_pedals_on_which_a_foot_never_rests_are_no_stairs(seed: int) -> None:
    session = Session()
    events = session.feed(samples_of(MOTIONS[0], seed, 100.0)) + session.finish()
    assert of(StrideTaken, events) == []


@pytest.mark.parametrize("seed", SITTERS)
def test_feet_that_are_put_elsewhere_below_a_chair_take_no_strides(seed: int) -> None:
    motion = next(one for one in MOTIONS if one.name == "sitting, legs move")
    session = Session()
    events = session.feed(samples_of(motion, seed, 100.0)) + session.finish()
    assert [event for event in of(StrideTaken, events) if event.final] == []


def test_who_taps_for_longer_than_a_pause_does_not_stand() -> None:
    motion = next(one for one in MOTIONS if one.name == "sitting, feet tap")
    session, timeline = Session(), Timeline()
    for event in of(ActivityChanged, session.feed(samples_of(motion, 7001, RATE)) + session.finish()):
        timeline.add(event)
    tapping = [timeline.at(0.1 * k) for k in range(240, 480)]
    assert tapping.count(Activity.UNKNOWN) > 0.95 * len(tapping)


def test_a_foot_whose_gyroscope_is_mirrored_costs_the_other_foot_no_stride() -> None:
    walk = samples(Route().stand(2.0).walk(25.0, 1.3).stop(2.0), cells=0)
    wrong = [
        evolve(one, gyro=(-one.gyro[0], one.gyro[1], one.gyro[2])) if one.site is LEFT and one.gyro else one
        for one in walk
    ]
    counts = [
        len([one for one in of(StrideTaken, session.feed(fed) + session.finish()) if one.foot is Foot.RIGHT])
        for session, fed in ((Session(), walk), (Session(), wrong))
    ]
    assert counts[0] == counts[1] > 10
