"""Contradictory and extreme input: large intervals, extreme numbers, dead areas, gaps."""

from __future__ import annotations

import json
from functools import cache
from math import inf, isfinite, nan

import pytest
from attrs import evolve
from walks import samples

from solepath import Event, FootMoved, Sample, SampleGap, Session, Site, recipes

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


QUATS = [
    (0.0, 0.0, 0.0, 0.0),
    (1e-200, 0.0, 0.0, 0.0),
    (nan, 0.0, 0.0, 0.0),
    (inf, 0.0, 0.0, 0.0),
    (1e300, 1.0, 0.0, 0.0),
]


@pytest.mark.parametrize(
    ("recipe", "quat"),
    [("walking-modes", QUATS[0]), ("gyroscope", QUATS[1]), *(("default", quat) for quat in QUATS[2:])],
    ids=str,
)
def test_an_invalid_attitude_counts_as_none(recipe: str, quat: tuple[float, float, float, float]) -> None:
    changed = [evolve(sample, quat=quat) for sample in samples()]
    session = Session(recipes.by_name(recipe))
    assert session.feed(changed) == without_attitude(recipe)
    session.snapshot()


@cache
def without_attitude(recipe: str) -> list[Event]:
    return Session(recipes.by_name(recipe)).feed(samples())
