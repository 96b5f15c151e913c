"""Contradictory and extreme input: large intervals, extreme numbers, dead areas, gaps."""

from __future__ import annotations

import json
from functools import cache
from math import hypot, inf, isfinite, nan, radians

import pytest
from attrs import evolve
from walks import samples

from solepath import Event, Foot, FootMoved, Sample, SampleGap, Session, Site, StrideTaken, recipes
from solepath.body.fuse.position import MeanOfFeet
from solepath.body.part import TrackPart
from solepath.emulate import Route, emulate

LEFT = Site.LEFT_FOOT


def still(t: float, rate: float = 0.0) -> Sample:
    return Sample(t, LEFT, (0.0, 0.0, 9.81), (0.0, rate, 0.0))


@pytest.mark.parametrize(("rate", "wait"), [(18.0, 0.5), (35.0, 0.2), (35.0, 0.3), (80.0, 0.1), (95.0, 0.24)])
def test_however_far_a_foot_turns_between_two_samples_its_position_is_a_number(rate: float, wait: float) -> None:
    session = Session(poses=True)
    events = session.feed([still(0.01 * k) for k in range(100)])
    events += session.feed([still(1.0 + 0.01 * k, rate) for k in range(5)])
    events += session.feed(still(1.04 + wait, rate))
    events += session.feed([still(1.05 + wait + 0.01 * k) for k in range(300)])
    moved = [event for event in events if isinstance(event, FootMoved)]
    assert all(isfinite(x) for event in moved for x in (*event.position, *event.velocity))
    json.dumps(session.snapshot(), allow_nan=False)


def test_a_first_wait_of_seconds_does_not_hide_the_gaps_after_it() -> None:
    session = Session()
    events = session.feed([still(0.0), *(still(2.0 + 0.01 * k) for k in range(60)), still(4.1)])
    assert [round(event.duration, 2) for event in events if isinstance(event, SampleGap)] == [2.0, 1.51]


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("first", [Route().stand(2).turn(radians(90)), Route().stand(2).turn(radians(90), radius=2.0)])
def test_final_strides_are_all_in_one_frame(first: Route, seed: int) -> None:
    walk = emulate(first.walk(6, 1.2).stop(2), seed=seed)
    session = Session(recipes.DEFAULT.exchanged(TrackPart, MeanOfFeet()))  # no foot is moved by the other
    strides_of = [event for event in session.feed(walk.packets) if isinstance(event, StrideTaken)]
    for foot in Foot:
        strides = [stride for stride in strides_of if stride.foot is foot]
        assert len(strides) >= 5
        for before, after in zip(strides, strides[1:], strict=False):
            (x, y, _), (u, v, _), (dx, dy, _) = after.position, before.position, after.displacement
            assert hypot(x - u - dx, y - v - dy) < 0.06  # shift of a standing foot


QUATS = [
    (0.0, 0.0, 0.0, 0.0),
    (1e-200, 0.0, 0.0, 0.0),
    (nan, 0.0, 0.0, 0.0),
    (inf, 0.0, 0.0, 0.0),
    (1e300, 1.0, 0.0, 0.0),
]


def strides_of(events: list[Event], foot: Foot) -> list[StrideTaken]:
    return [event for event in events if isinstance(event, StrideTaken) and event.foot is foot]


@pytest.mark.parametrize("quat", QUATS, ids=str)
@pytest.mark.parametrize("recipe", ["default", "gyroscope", "walking-modes"])
def test_an_invalid_attitude_counts_as_none(recipe: str, quat: tuple[float, float, float, float]) -> None:
    changed = [evolve(sample, quat=quat) for sample in samples()]
    session = Session(recipes.by_name(recipe))
    assert session.feed(changed) == without_attitude(recipe)
    session.snapshot()


@cache
def without_attitude(recipe: str) -> list[Event]:
    return Session(recipes.by_name(recipe)).feed(samples())


@pytest.mark.parametrize("cells", [(10**400,), (None, 10**400), (10**400, nan), (-(10**400), 1.0)])
def test_numbers_too_large_for_a_float_are_rejected_or_missing_and_raise_nothing(cells: tuple[int, ...]) -> None:
    session = Session()
    for k in range(50):
        session.feed(Sample(0.01 * k, Site.LEFT_FOOT, (0.0, 0.0, 9.8), (0.0, 0.0, 0.0), cells))  # type: ignore[arg-type]
    session.snapshot()
