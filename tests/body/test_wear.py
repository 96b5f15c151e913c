"""Wearing faults: a foot that falls silent, and left and right exchanged."""

from __future__ import annotations

from functools import cache
from math import hypot, radians, sqrt
from typing import Any

import pytest
from attrs import evolve
from soak import soaked
from spoiled import silent
from walks import LEFT, RIGHT, insoles, of, samples

from solepath import Recipe, Session, recipes
from solepath.body.fuse.position import MeanOfFeet
from solepath.body.part import TrackPart
from solepath.body.wear import RunningAverage
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.wearers.walker import Walker
from solepath.events import DefectFound, FeetSwapped, FootResumed, FootSilent, StrideTaken
from solepath.types import Foot, Sample, Site

WALK = Route().stand(1.5).walk(16.0, 1.2).turn(radians(90), radius=1.5).walk(6.0).stop(1.0)
OTHER = {LEFT: RIGHT, RIGHT: LEFT}
MEAN = recipes.DEFAULT.replace_part(TrackPart, MeanOfFeet())
"""The feet's own tracks, and their mean."""


def exchanged(walk: tuple[Sample, ...]) -> tuple[Sample, ...]:
    """Return the walk with the device of each foot taken for the other's."""
    return tuple(evolve(sample, site=OTHER[sample.site]) for sample in walk)


@cache
def walk(seed: int = 1) -> tuple[Sample, ...]:
    return samples(WALK, cells=0, rate=50.0, seed=seed)


def reported(kind: Any, items: tuple[Sample, ...], session: Session | None = None) -> list[Any]:
    return of(kind, (Session() if session is None else session).feed(items))


@pytest.mark.parametrize("foot", [LEFT, *soaked(RIGHT)])
@pytest.mark.parametrize("stuck", [{"acc": (0.03, -0.2, 9.8)}, {"gyro": (0.4, 0.1, -0.2)}])
def test_a_sensor_whose_samples_come_but_are_stuck_is_not_called_silent(foot: Site, stuck: Any) -> None:
    spoiled = tuple(evolve(one, **stuck) if one.site is foot and one.t > 6.0 else one for one in walk())
    assert reported(FootSilent, spoiled) == []
    assert {event.site for event in reported(DefectFound, spoiled)} == {foot}


def without(foot: Site, start: float, end: float) -> tuple[Sample, ...]:
    return tuple(s for s in walk() if s.site is not foot or not start <= s.t < end)


@pytest.mark.parametrize("foot", [LEFT, *soaked(RIGHT)])
def test_a_foot_that_gives_no_samples_while_the_other_walks_on_is_silent_until_it_gives_one(foot: Site) -> None:
    events = reported(FootSilent | FootResumed, without(foot, 6.0, 12.0))
    assert [type(event) for event in events] == [FootSilent, FootResumed]
    silent, resumed = events
    assert {event.foot for event in events} == {foot.foot}
    assert 8.9 < silent.t < 11.0
    assert silent.silent_for == pytest.approx(silent.t - 6.0, abs=0.05)
    assert resumed.t == pytest.approx(12.0, abs=0.05)
    assert resumed.silent_for == pytest.approx(6.0, abs=0.05)


def test_the_foot_that_is_left_takes_its_steps_as_before() -> None:
    left = without(RIGHT, 6.0, 1e9)

    def steps(items: tuple[Sample, ...], recipe: Recipe) -> list[StrideTaken]:
        return [step for step in reported(StrideTaken, items, Session(recipe)) if step.foot is Foot.LEFT]

    assert steps(left, MEAN) == steps(walk(), MEAN)
    # where feet hold each other's heading its steps are as long
    alone, both_feet = steps(left, recipes.DEFAULT), steps(walk(), recipes.DEFAULT)
    assert [step.t_end for step in alone] == [step.t_end for step in both_feet]
    lengths = [step.length for step in both_feet]
    assert [step.length for step in alone] == pytest.approx(lengths, abs=0.01)


def test_a_short_silence_and_a_foot_without_any_sample_are_not_reported() -> None:
    assert reported(FootSilent | FootResumed, without(RIGHT, 6.0, 8.0)) == []
    assert reported(FootSilent | FootResumed, tuple(s for s in walk() if s.site is LEFT)) == []


def test_no_foot_is_silent_while_the_wearer_stands() -> None:
    standing = samples(Route().stand(8.0), cells=0, rate=50.0)
    assert reported(FootSilent, tuple(s for s in standing if s.site is LEFT or s.t < 2.0)) == []


FAR = Route().stand(1.5).walk(40.0, 1.2).stop(1.5)
ROUND = Route().stand(1.5).walk(16.0, 1.2).turn(radians(90), radius=1.5).walk(22.0).stop(1.5)


def place(walk: tuple[Sample, ...], recipe: Recipe = recipes.DEFAULT) -> tuple[float, float, float, float]:
    """Return the position of the wearer at the end: x, y, and their standard deviations, m."""
    session = Session(recipe)
    session.feed(walk)
    where = session.position
    assert where is not None
    (x, y, _), (xx, _, _, yy, _, _) = where.position, where.covariance
    return x, y, sqrt(xx), sqrt(yy)


def both_feet(route: Route) -> tuple[Sample, ...]:
    return samples(route, cells=0, rate=50.0)


@pytest.mark.parametrize("foot", [LEFT, *soaked(RIGHT)])
@pytest.mark.soak
def test_a_silent_foot_does_not_hold_the_wearer_back(foot: Site) -> None:
    alone = tuple(silent(both_feet(FAR), foot, 12.0))
    for recipe, least in ((recipes.DEFAULT, 1.0), (MEAN, 1.2)):
        x, y, across, along = place(alone, recipe)
        whole = place(both_feet(FAR), recipe)
        assert x == pytest.approx(40.0, abs=0.8)
        assert abs(y) < 3.0 * along, "its heading is its own, but no worse than it says"
        assert across > least * whole[2] and along > least * whole[3], "one foot is known less well than two"


@pytest.mark.parametrize("foot", [LEFT, *soaked(RIGHT)])
@pytest.mark.soak
def test_a_foot_that_comes_back_is_set_beside_the_other(foot: Site) -> None:
    absent_samples = tuple(silent(both_feet(FAR), foot, 8.0, 20.0))
    for recipe, least in ((recipes.DEFAULT, 1.0), (MEAN, 1.2)):
        x, _, across, _ = place(absent_samples, recipe)
        assert x == pytest.approx(40.0, abs=0.8)
        assert across > least * place(both_feet(FAR), recipe)[2]


@pytest.mark.parametrize("foot", [LEFT, *soaked(RIGHT)])
@pytest.mark.soak
def test_a_foot_that_was_away_while_the_wearer_turned_is_turned_too(foot: Site) -> None:
    x, y, _, _ = place(tuple(silent(both_feet(ROUND), foot, 11.0, 20.0)))
    u, v, _, _ = place(both_feet(ROUND))
    assert hypot(x - u, y - v) < 1.6


def test_the_position_does_not_jump_when_a_foot_falls_silent_or_comes_back() -> None:
    session = Session()
    before = None
    for sample in silent(both_feet(FAR), LEFT, 8.0, 20.0):
        session.feed(sample)
        if session.position is not None:
            here = session.position.position
            assert before is None or hypot(here[0] - before[0], here[1] - before[1]) < 0.6
            before = here


def test_exchanged_feet_are_reported_once_within_ten_strides_of_each() -> None:
    session = Session()
    events = session.feed(exchanged(walk()))
    (swapped,) = of(FeetSwapped, events)
    before = [step.foot for step in of(StrideTaken, events) if step.t <= swapped.t]
    assert 8 <= before.count(Foot.LEFT) <= 12
    assert 8 <= before.count(Foot.RIGHT) <= 12


def test_feet_that_are_worn_as_they_should_be_are_not_taken_for_exchanged() -> None:
    assert reported(FeetSwapped, walk()) == []


def test_devices_that_report_the_right_feet_are_trusted() -> None:
    session = Session()
    events = session.feed(insoles(WALK, cells=96).packets)
    assert of(FeetSwapped, events) == []
    sides = session._state.find_attribute("sides")
    left, right = sides.feet.values()
    assert sides.declared == list(Foot)
    assert not left.turn_integral.instants and not right.turn_integral.instants, (
        "what their feet do need not be remembered"
    )
    left.roll = right.roll = RunningAverage(count=24, mean=0.2)
    assert not sides._both_look_swapped()


def pressure_alone(numbered_alike: bool) -> tuple[tuple[Sample, ...], Calibration]:
    """Return a walk of insoles without inertial sensors, and their calibration.

    Numbered alike: cell k of the left insole lies where cell k of the right one does, seen from above, and not where
    its mirror image does.
    """
    walker = Walker(WALK, seed=1)
    there = {foot: layout(24, Foot.LEFT if numbered_alike else foot) for foot in Foot}
    both_feet = [
        evolve(sample, acc=None, gyro=None)
        for foot in Foot
        for sample in walker.samples(foot, 50.0, layout=evolve(there[foot], foot=foot))
    ]
    known = {foot: InsoleCalibration(evolve(there[foot], foot=foot)) for foot in Foot}
    return tuple(sorted(both_feet, key=_time)), Calibration(known)


def _time(sample: Sample) -> float:
    return sample.t


def test_without_inertial_sensors_the_centre_of_pressure_shows_exchanged_feet() -> None:
    both_feet, known = pressure_alone(numbered_alike=True)
    assert reported(FeetSwapped, both_feet, Session(calibration=known)) == []
    assert len(reported(FeetSwapped, exchanged(both_feet), Session(calibration=known))) == 1
