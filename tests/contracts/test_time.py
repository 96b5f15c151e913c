"""Contracts 2 and 8: time is data, and every interval is computed from the times of the samples."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from attrs import evolve
from soak import longer
from walks import DEVICE_NAMES, LEFT, RIGHT, insoles, machines, of, often, samples

from solepath import Activity, Foot, Limitation, Sample, Session, StreamResumed, StreamStale, StrideTaken, recipes
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker

WALKING = Activity.WALKING
TIMES = ("t", "known_at", "t_start", "t_end", "t_toe_off", "t_heel_strike")


@pytest.mark.parametrize("name", DEVICE_NAMES)
def test_silence_becomes_an_event_when_time_passes(name: str) -> None:
    machine = machines()[name]
    middle = len(machine.items) // 2
    session = machine.start()
    session.feed(machine.items[:middle])
    now = machine.items[middle - 1].t
    assert of(StreamStale, session.advance(now + 0.05)) == []
    emitted = session.advance(now + 30.0)
    stale = of(StreamStale, emitted)
    assert {event.site for event in stale} == {LEFT, RIGHT}
    assert all(now < event.t <= event.known_at == now + 30.0 and event.silent_for > 25.0 for event in stale)
    assert session.advance(now + 31.0) == []
    again = session.feed([evolve(item, t=item.t + 40.0) for item in machine.items[middle:]])
    assert {event.site for event in of(StreamResumed, again)} == {LEFT, RIGHT}


def test_the_other_foot_makes_time_pass_as_well() -> None:
    machine = machines()["session, whole frames"]
    session = machine.start()
    emitted = []
    for item in machine.items:
        if item.site is RIGHT or item.t < 3.0:
            emitted += session.feed(item)
    (stale,) = of(StreamStale, emitted)
    assert stale.site is LEFT and stale.t == pytest.approx(4.0, abs=0.1)


def test_what_a_wearer_does_is_unknown_while_every_foot_is_silent() -> None:
    packets = insoles().packets
    session = Session()
    walking = next(k for k, packet in enumerate(packets) if session.feed(packet) and session.activity is WALKING)
    now = packets[walking].t
    for packet in packets[walking + 1 :]:
        if packet.site is RIGHT and packet.t < now + 3.0:
            session.feed(packet)
    assert session.activity is WALKING, "the right foot still sends"
    session.advance(now + 6.0)
    assert session.activity is Activity.UNKNOWN
    assert Session.restore(session.snapshot()).activity is Activity.UNKNOWN
    session.advance(now + 600.0)
    assert session.activity is Activity.UNKNOWN
    session.feed([evolve(packet, t=packet.t + 600.0) for packet in packets if now + 3.0 < packet.t < now + 6.0])
    assert session.activity is not Activity.UNKNOWN


def test_nothing_happens_by_advancing_what_is_fed_by_samples_alone() -> None:
    session = Session()
    session.feed(samples())
    assert session.advance(1e6) == []


@pytest.mark.parametrize("name", [DEVICE_NAMES[0], *longer(*DEVICE_NAMES[1:3])])
@pytest.mark.parametrize(("offset", "silences"), [(1.7e9, 0), (86_400.0, 0), (90.0, 1), (20.0, 1)])
def test_a_leap_to_another_clock_is_taken_back_when_packets_contradict_it(
    name: str, offset: float, silences: int
) -> None:
    machine = machines()[name]
    session, emitted = machine.start(), []
    for number, item in enumerate(machine.items):
        emitted += session.feed(item)
        if number % 7 == 6:
            emitted += session.advance(item.t + offset)
    assert session.now == pytest.approx(machine.items[-1].t, abs=1.0)
    (limitation,) = [event for event in of(Limitation, emitted) if "another clock" in event.what]
    assert "Packet.t" in limitation.what
    sites = {item.site for item in machine.items}
    assert len(of(StreamStale, emitted)) <= silences * len(sites)
    plain = machine.start().feed(machine.items)
    assert of(StrideTaken, emitted) == of(StrideTaken, plain)


def test_an_hour_without_packets_passes_after_two_seconds_more() -> None:
    machine = machines()[DEVICE_NAMES[0]]
    session = machine.start()
    session.feed(machine.items)
    now = machine.items[-1].t + 5000.0
    assert session.advance(now) == session.advance(now + 1.9) == []
    assert len(of(StreamStale, session.advance(now + 2.1))) == 2
    assert session.now == now + 2.1


ROUTE = Route().stand(2.0).walk(16.0, 1.3).stop(2.0)


@cache
def walker() -> Walker:
    return Walker(ROUTE, seed=3)


@cache
def fine() -> list[Sample]:
    """Return samples of the left foot at 1000 Hz, filtered by means over 11 samples (a low pass of 10 ms)."""
    raw = walker().samples(Foot.LEFT, 1000.0, LSM6DSOX)

    def smooth(rows: list[Any]) -> list[Any]:
        box = np.ones(11) / 11
        columns = [np.convolve(column, box, mode="same") for column in np.array(rows).T]
        return [tuple(row) for row in np.array(columns).T.tolist()]

    acc, gyro = smooth([sample.acc for sample in raw]), smooth([sample.gyro for sample in raw])
    fed = [evolve(sample, acc=a, gyro=g) for sample, a, g in zip(raw, acc, gyro, strict=True)]
    return fed[10:-10]


def regular() -> list[Sample]:
    return fine()[5::10]


def jittered(seed: int) -> list[Sample]:
    """Return samples whose interval varies from 8 to 12 ms, 1 ms early or late; each has its true time."""
    rng = np.random.default_rng(seed)
    chosen, position = [], 5.0
    while position < len(fine()) - 5:
        chosen.append(fine()[round(position) + int(rng.integers(-1, 2))])
        position += 10.0 + 2.0 * np.sin(position / 500.0)
    return chosen


def steps_of(fed: list[Sample]) -> list[StrideTaken]:
    return of(StrideTaken, Session().feed(fed))


@pytest.mark.parametrize("seed", range(3))
def test_jitter_of_the_sample_times_does_not_bend_the_track(seed: int) -> None:
    regular_strides, jittered_strides = steps_of(regular()), steps_of(jittered(seed))
    assert len(regular_strides) == len(jittered_strides) == len(walker().truth().strides(Foot.LEFT))
    for a, b in zip(regular_strides, jittered_strides, strict=True):
        assert b.t_end == pytest.approx(a.t_end, abs=0.02)
        assert b.length == pytest.approx(a.length, abs=0.03)
    assert jittered_strides[-1].position == pytest.approx(regular_strides[-1].position, abs=0.2)
    assert not any(stride.degraded for stride in jittered_strides)


@pytest.mark.parametrize("name", often(recipes.NAMES))
def test_feet_whose_clocks_are_years_apart_have_no_event_that_was_known_before_it_happened(name: str) -> None:
    left, right = [[sample for sample in samples() if sample.site is site] for site in (LEFT, RIGHT)]
    later = evolve(left[0], t=1e8, known_at=1e8)
    events = Session(recipes.by_name(name)).feed([later, *right])
    assert all(event.known_at >= event.t for event in events)
