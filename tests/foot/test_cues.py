"""Inertial cues: times of heel-strike, foot-flat and toe-off, and the middle of an impact."""

from __future__ import annotations

import json
from statistics import median

import pytest
from attrs import evolve
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from walks import SHORT, insoles, of

from solepath import Foot, Sample, Session, ToeOff
from solepath.emulate import Route, Walker
from solepath.events import HeelStrike
from solepath.types.vector import GRAVITY
from solepath.walk import Walk


def walked(speed: float, rate: float = 100.0, far: float = 15.0) -> tuple[Walker, list[Sample]]:
    walker = Walker(Route().stand(2).walk(far, speed).stop(2), seed=5)
    return walker, [Sample(s.t, s.site, s.acc, s.gyro) for s in walker.samples(Foot.LEFT, rate)]


@pytest.mark.parametrize("speed", [0.9, 1.7])
def test_without_cells_toe_off_and_heel_strike_are_seen_by_how_the_foot_turns(speed: float) -> None:
    walker, samples = walked(speed)
    events = Session().feed(samples)
    truth = walker.truth().feet[Foot.LEFT]
    for kind, true_times in ((ToeOff, truth.toe_offs), (HeelStrike, truth.heel_strikes)):
        detected = [event.t for event in events if isinstance(event, kind)]
        assert len(detected) == len(true_times)
        offsets = [a - b for a, b in zip(detected, true_times, strict=True)]
        assert abs(median(offsets)) < 0.045, kind.__name__
        assert max(offsets) - min(offsets[1:]) < 0.2, kind.__name__


@pytest.mark.parametrize("rate", [20.0, 200.0])
def test_heel_strike_is_where_the_ground_stops_the_foot_at_any_rate(rate: float) -> None:
    walker, samples = walked(1.2, rate, 8.0)
    detected = [event.t for event in of(HeelStrike, Session().feed(samples))]
    true_times = walker.truth().feet[Foot.LEFT].heel_strikes
    assert len(detected) == len(true_times)
    # the time between two samples is the limit
    assert abs(median(a - b for a, b in zip(detected, true_times, strict=True))) < 0.015 + 0.5 / rate


@pytest.mark.parametrize("speed", [0.7, 1.8])
def test_heel_strike_and_toe_off_are_known_within_60_ms(speed: float) -> None:
    _, samples = walked(speed)
    events = Session().feed(samples)
    latencies = [event.known_at - event.t for kind in (HeelStrike, ToeOff) for event in of(kind, events)[1:-1]]
    assert len(latencies) > 10 and max(latencies) < 0.0605


@pytest.mark.parametrize("rate", [100.0, 200.0])
@pytest.mark.parametrize("speed", [0.7, 1.3, 1.8])
def test_an_impact_is_reported_by_the_sample_that_shows_it_and_the_final_heel_strike_names_it(
    speed: float, rate: float
) -> None:
    walker, samples = walked(speed, rate)
    strikes = of(HeelStrike, Session(impacts=True).feed(samples))
    seen, final = [one for one in strikes if not one.final], [one for one in strikes if one.final]
    contacts = walker.truth().feet[Foot.LEFT].heel_strikes
    assert len(final) == len(contacts) and len(seen) >= len(contacts) - 1
    assert [one.revises for one in final if one.revises is not None] == [one.t for one in seen]
    revised = {one.revises: one for one in final}
    for one in seen:
        after = revised[one.t]
        assert one.known_at < after.known_at < one.known_at + 0.11 and -0.01 < after.t - one.t < 0.06
        assert one.t <= one.known_at <= one.t + 0.025 + 1.0 / rate
    late = [one.known_at - min(contacts, key=lambda t: abs(t - one.t)) for one in seen]
    assert median(late) < 0.03 and min(late) > -0.02 and max(late) < 0.06


def test_what_is_reported_before_it_is_final_changes_nothing_else() -> None:
    _, samples = walked(1.3)
    plain, early = Session(), Session(impacts=True)
    expected = plain.feed(samples) + plain.finish()
    events = early.feed(samples) + early.finish()
    kept = [
        evolve(event, revises=None) if isinstance(event, HeelStrike) else event
        for event in events
        if event.final or not isinstance(event, HeelStrike)
    ]
    assert len(events) > len(kept) and kept == expected and early.position == plain.position
    assert Walk.of(events).feet[Foot.LEFT].events == Walk.of(expected).feet[Foot.LEFT].events


def test_a_foot_with_cells_needs_no_event_before_the_final_one() -> None:
    packets = insoles(SHORT).packets
    assert Session(impacts=True).feed(packets) == Session().feed(packets)


@given(st.integers(0, 1500))
@settings(max_examples=10, phases=[Phase.generate])
def test_saved_between_an_impact_and_its_heel_strike_a_session_still_knows_what_it_revises(moment: int) -> None:
    samples = walked(1.3)[1]
    whole = Session(impacts=True).feed(samples)
    session = Session(impacts=True)
    events = session.feed(samples[:moment])
    for again in (Session.restore(json.loads(json.dumps(session.snapshot()))), Session.unpack(session.pack())):
        assert events + again.feed(samples[moment:]) == whole


def test_a_loss_in_the_impact_leaves_no_heel_strike_that_is_revised_twice_or_by_one_of_another_stride() -> None:
    _, samples = walked(1.3)
    seen = [one for one in of(HeelStrike, Session(impacts=True).feed(samples)) if not one.final]
    for lost in (0.03, 0.2, 0.6, 3.0):
        start = seen[5].known_at
        left = [one for one in samples if not start < one.t < start + lost]
        strikes = of(HeelStrike, Session(impacts=True).feed(left))
        named = [one.revises for one in strikes if one.revises is not None]
        assert len(set(named)) == len(named) and {one.t for one in strikes if not one.final} >= {*named}
        assert all([one.t - one.revises < 0.11 for one in strikes if one.revises is not None])


def test_heel_strike_stays_where_it_is_when_the_accelerometer_clips_at_2_g() -> None:
    _, samples = walked(1.4)
    limit = 2.0 * GRAVITY

    def clipped(sample: Sample) -> Sample:
        assert sample.acc is not None
        x, y, z = (max(-limit, min(limit, value)) for value in sample.acc)
        return Sample(sample.t, sample.site, (x, y, z), sample.gyro)

    whole, cut = (of(HeelStrike, Session().feed(fed)) for fed in (samples, [clipped(sample) for sample in samples]))
    assert len(cut) == len(whole)
    assert abs(median(a.t - b.t for a, b in zip(cut, whole, strict=True))) < 0.02
