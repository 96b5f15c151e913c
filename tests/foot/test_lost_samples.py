"""Strides with samples cut out: what is missing is counted, short gaps are no flaw, and long ones are."""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import cache

import pytest
from walks import of, samples

from solepath import Event, Flaw, Foot, GaitCycleMeasured, Sample, Session, Site, StrideTaken
from solepath.emulate import Route

ROUTE = Route().stand(3.0).walk(60.0, speed=1.3).stop(2.0)
INTERVAL = 0.01


@cache
def walked() -> tuple[Sample, ...]:
    """Return the samples of the left foot of an emulated walk."""
    return tuple([one for one in samples(ROUTE, rate=1.0 / INTERVAL, seed=5) if one.site is Site.LEFT_FOOT])


def reported(keeps: Callable[[int, Sample], bool]) -> list[Event]:
    session = Session()
    events = [event for k, one in enumerate(walked()) if keeps(k, one) for event in session.feed(one)]
    return events + session.finish()


def strides(keeps: Callable[[int, Sample], bool]) -> list[StrideTaken]:
    return [stride for stride in of(StrideTaken, reported(keeps)) if stride.final]


def test_nothing_is_missing_of_a_whole_walk() -> None:
    whole = strides(lambda k, one: True)
    assert len(whole) > 30
    assert {(one.missing, one.longest_gap, one.flaws, one.degraded) for one in whole} == {(0.0, 0.0, (), False)}
    assert all(0.0 < one.length_sigma < 0.1 for one in whole)


@pytest.mark.parametrize("of_samples", [10, 50, 200])
def test_one_sample_of_n_is_missing_and_no_stride_has_a_flaw(of_samples: int) -> None:
    events = reported(lambda k, one: k % of_samples != 7)
    found, cycles = of(StrideTaken, events), of(GaitCycleMeasured, events)
    assert len(cycles) > 25 and not any(one.degraded for one in cycles), "a cycle has no flaw that its stride has not"
    time = sum(one.t_end - one.t_start for one in found)
    missing = sum(one.missing * (one.t_end - one.t_start) for one in found)
    assert missing / time == pytest.approx(1.0 / of_samples, rel=0.1)
    assert all(0.0 < one.longest_gap < 2.0 * INTERVAL + 1e-3 for one in found if one.missing)
    assert [one.flaws for one in found if one.flaws] == []


def test_a_radio_that_loses_three_percent_gives_the_lengths_of_a_whole_walk_without_flaws() -> None:
    drawn = random.Random(20)
    lost = {k for k in range(len(walked())) if drawn.random() < 0.03}
    whole, damaged = strides(lambda k, one: True), strides(lambda k, one: k not in lost)
    assert len(damaged) == len(whole)
    assert sum(bool(one.flaws) for one in damaged) < 0.05 * len(damaged)
    sure = [abs(a.length - b.length) < 2.0 * b.length_sigma for a, b in zip(whole, damaged, strict=True)]
    assert sum(sure) >= 0.95 * len(sure)


@pytest.mark.parametrize("every", [1, 2, 4])
def test_a_radio_that_loses_three_percent_leaves_nearly_all_strides_without_flaws_at_every_rate(every: int) -> None:
    drawn = random.Random(20)
    found = [one for _ in range(3) for one in strides(lambda k, _: k % every == 0 and drawn.random() >= 0.03)]
    assert len(found) > 90 and sum(bool(one.flaws) for one in found) < 0.05 * len(found)


@pytest.mark.parametrize("rate", [25, 50])
@pytest.mark.parametrize("lost", [1, 2, 3])
def test_up_to_two_lost_samples_are_no_flaw_at_a_low_rate_and_three_are(rate: int, lost: int) -> None:
    every = round(1.0 / INTERVAL / rate)
    whole = strides(lambda k, _: k % every == 0)
    toe_off = whole[15].t_toe_off
    assert toe_off is not None
    first = round(toe_off / INTERVAL / every) + 2
    damaged = strides(lambda k, _: k % every == 0 and not first <= k // every < first + lost)
    (touched,) = [one for one in damaged if one.longest_gap]
    assert touched.flaws == (() if lost < 3 else (Flaw.GAP,)) and touched.missing > 0.0
    assert touched.length_sigma > whole[15].length_sigma


def test_a_gap_of_a_swing_is_a_flaw_of_that_stride_and_makes_its_length_less_sure() -> None:
    whole = strides(lambda k, one: True)
    stride = whole[15]
    assert stride.t_toe_off is not None
    start, end = stride.t_toe_off + 0.05, stride.t_toe_off + 0.25
    damaged = strides(lambda k, one: not start < one.t < end)
    (flawed,) = [one for one in damaged if one.flaws]
    assert flawed.foot is Foot.LEFT and flawed.t_start < start < end < flawed.t_end and flawed.degraded
    assert flawed.flaws == (Flaw.GAP,) and flawed.longest_gap == pytest.approx(0.2, abs=2.1 * INTERVAL)
    assert flawed.length_sigma > 4.0 * stride.length_sigma
    assert abs(flawed.length - stride.length) < 3.0 * flawed.length_sigma
    assert flawed.to_dict()["flaws"] == ["gap"]


@pytest.mark.parametrize("start", [4.0, 4.3, 4.6, 4.9])
def test_a_long_gap_is_shared_by_the_strides_that_it_lies_in_and_none_is_sure_of_its_length(start: float) -> None:
    found = strides(lambda k, one: not start < one.t < start + 1.3)
    touched = [one for one in found if one.longest_gap]
    assert touched and all(one.longest_gap <= one.t_end - one.t_start + 1e-9 for one in touched)
    assert sum(one.longest_gap for one in touched) <= 1.3 + 2.1 * INTERVAL
    assert all(one.length_sigma > 0.5 * one.longest_gap for one in touched if one.longest_gap > 0.3)
