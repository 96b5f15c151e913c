"""Strides that no person can take are degraded before any part uses them, and reported; a sprint is possible."""

from __future__ import annotations

from functools import cache
from typing import Any

import pytest
from attrs import evolve
from views import told
from walks import LEFT, RIGHT, of, samples

from solepath import Session
from solepath.body.checks.motion import PossibleMotion, impossible_motion
from solepath.body.part import Replacement
from solepath.emulate.routes.route import Route
from solepath.events import Defect, DefectFound, Flaw, StrideTaken
from solepath.types import Sample

WALK = Route().stand(2.0).walk(25.0, 1.3).stop(1.0)


@cache
def walk() -> tuple[Sample, ...]:
    return samples(WALK, cells=0, rate=50.0, seed=2)


@cache
def stride() -> StrideTaken:
    """Return a stride of a real pace: 1 s, of which the foot is in the air from 0.6 to 0.9 s."""
    (event, *_) = [one for one in of(StrideTaken, Session().feed(walk())) if one.foot is LEFT.foot]
    return evolve(event, t_start=0.0, t=1.0, t_end=1.0, known_at=1.0, t_toe_off=0.6, t_heel_strike=0.9, flaws=())


def changed(speed: float = 1.3, **features: Any) -> StrideTaken:
    return evolve(stride(), length=speed, features=evolve(stride().features, **features))


@pytest.mark.parametrize(
    "speed, in_air, possible",
    [(2.2, (0.6, 0.9), True), (4.0, (0.6, 0.9), False), (4.0, (0.3, 0.9), True), (11.0, (0.2, 0.95), True)]
    + [(13.0, (0.2, 0.95), False), (35.0, (0.6, 0.9), False)],
)
def test_a_stride_of_four_metres_a_second_is_a_run_with_flight_but_no_walk(
    speed: float, in_air: tuple[float, float], possible: bool
) -> None:
    toe_off, heel_strike = in_air
    event = evolve(
        changed(0.4 * speed), t_end=0.4, t=0.4, t_toe_off=0.4 * toe_off, t_heel_strike=0.4 * heel_strike
    )  # a sprinter's stride lasts 0.4 s
    assert (impossible_motion(event) is None) is possible


def test_a_stride_of_six_metres_is_impossible_and_reported_even_if_it_is_degraded() -> None:
    part, merged = PossibleMotion(), evolve(changed(6.0), t_end=4.0, t=4.0, known_at=4.0, flaws=(Flaw.TWO_STRIDES,))
    (found,) = told(part, merged)
    assert isinstance(found, DefectFound) and "a length of 6 m" in found.what and not found.spoils
    (found,) = told(part, merged)
    assert isinstance(found, DefectFound) and "several strides" in found.what and found.spoils
    assert not told(part, merged)


def test_one_impossible_stride_is_degraded_and_reported_and_the_others_stay_as_they_are() -> None:
    part = PossibleMotion()
    assert [told(part, changed()) for _ in range(6)] == [[]] * 6
    wrong = changed(rise=1.5)
    replacement, found = told(part, wrong)
    assert replacement == Replacement(wrong, evolve(wrong, flaws=(Flaw.IMPOSSIBLE,)))
    assert isinstance(found, DefectFound) and found.defect is Defect.IMPOSSIBLE_MOTION and not found.spoils
    assert told(part, changed()) == []
    assert [type(output) for output in told(part, wrong)] == [Replacement], "it is reported once"


def test_a_foot_with_mostly_impossible_strides_is_reported_as_spoilt_once() -> None:
    part = PossibleMotion()
    outputs = [output for _ in range(9) for output in told(part, changed(speed=20.0))]
    found = [output for output in outputs if isinstance(output, DefectFound)]
    assert [event.spoils for event in found] == [False, True]
    assert "20 m/s" in found[1].what and "Check the units" in found[1].what
    part.reset(LEFT)
    assert any(isinstance(output, DefectFound) for output in told(part, changed(speed=20.0)))


def test_a_walk_has_no_impossible_stride() -> None:
    assert not of(DefectFound, Session().feed(walk()))


def test_a_gyroscope_that_reads_twice_the_rate_ends_in_degraded_strides_of_that_foot_alone() -> None:
    def doubled(sample: Sample) -> Sample:
        assert sample.gyro is not None
        x, y, z = sample.gyro
        return evolve(sample, gyro=(2.0 * x, 2.0 * y, 2.0 * z)) if sample.site is RIGHT else sample

    session = Session()
    events = session.feed([doubled(sample) for sample in walk()]) + session.finish()
    found = [event for event in of(DefectFound, events) if event.defect is Defect.IMPOSSIBLE_MOTION]
    assert {event.site for event in found} == {RIGHT} and any(event.spoils for event in of(DefectFound, events))
    strides, spoilt_at = of(StrideTaken, events), min(event.t for event in of(DefectFound, events) if event.spoils)
    later = [stride.degraded for stride in strides if stride.foot is RIGHT.foot and stride.t > spoilt_at]
    assert len(later) >= 5 and all(later)
    left = [stride.degraded for stride in strides if stride.foot is LEFT.foot]
    assert len(left) >= 15 and not any(left)
