"""Contracts 2 and 8: time is data, and every step of time is the sample's own."""

from __future__ import annotations

from functools import cache
from typing import Any

import attrs
import numpy as np
import pytest
from attrs import evolve
from walks import LEFT, NAMES, PACKET_NAMES, RIGHT, machines, of, samples

from solepath import Foot, FootMoved, PacketsLost, Sample, SampleGap, Session, StreamResumed, StreamStale, StrideTaken
from solepath.emulate.radio import CLEAN
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.walker import Walker


def moved(item: Any, by: float) -> Any:
    """Return the items `by` s later."""
    if isinstance(item, Sample) and item.known_at is not None:
        return evolve(item, t=item.t + by, known_at=item.known_at + by)
    return evolve(item, t=item.t + by)


EARLIER = ("decoder", "session, whole frames", "session, cc2541", "session, samples")
"""Time shifts that separate clocks and sessions; a recipe's parts work the same before zero as after it."""
TIMES = ("t", "known_at", "t_start", "t_end", "t_toe_off", "t_heel_strike")


def split(event: Any) -> tuple[list[float], dict[str, Any]]:
    """The times of an event, and the rest of it."""
    values = {f.name: getattr(event, f.name) for f in attrs.fields(type(event))}
    times = [values.pop(name) for name in TIMES if values.get(name) is not None]
    return times, values


@pytest.mark.parametrize(
    ("name", "by"), [(name, 1e6) for name in NAMES] + [(name, -3600.0) for name in NAMES if name.startswith(EARLIER)]
)
def test_the_same_walk_at_another_time_gives_the_same_events_at_that_time(name: str, by: float) -> None:
    machine = machines()[name]
    here = machine.events()
    there = machine.events(tuple(moved(item, by) for item in machine.items))
    assert [type(event) for event in there] == [type(event) for event in here]
    for before, after in zip(here, there, strict=True):
        (times, values), (shifted, others) = split(before), split(after)
        assert shifted == pytest.approx([t + by for t in times], rel=0, abs=1e-6)
        if isinstance(before, StrideTaken | FootMoved):
            name_of = "displacement" if isinstance(before, StrideTaken) else "position"
            assert others[name_of] == pytest.approx(values[name_of], abs=1e-4)


@pytest.mark.parametrize("name", [name for name in PACKET_NAMES if name.startswith("session")])
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


def test_nothing_happens_by_advancing_what_is_fed_by_samples_alone() -> None:
    session = Session()
    session.feed(samples())
    assert session.advance(1e6) == []


ROUTE = Route().stand(2.0).walk(16.0, 1.3).stop(2.0)


@cache
def walker() -> Walker:
    return Walker(ROUTE, seed=3)


@cache
def fine() -> list[Sample]:
    """The left foot every millisecond, as a sensor with a low pass of 10 ms sees it: means over 11 samples."""
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
    kept, at = [], 5.0
    while at < len(fine()) - 5:
        kept.append(fine()[round(at) + int(rng.integers(-1, 2))])
        at += 10.0 + 2.0 * np.sin(at / 500.0)
    return kept


def steps_of(fed: list[Sample]) -> list[StrideTaken]:
    return of(StrideTaken, Session().feed(fed))


@pytest.mark.parametrize("seed", range(3))
def test_jitter_of_the_sample_times_does_not_bend_the_track(seed: int) -> None:
    one, other = steps_of(regular()), steps_of(jittered(seed))
    assert len(one) == len(other) == len(walker().truth().steps(Foot.LEFT))
    for a, b in zip(one, other, strict=True):
        assert b.t_end == pytest.approx(a.t_end, abs=0.02)
        assert b.length == pytest.approx(a.length, abs=0.03)
    assert other[-1].position == pytest.approx(one[-1].position, abs=0.2)
    assert not any(step.degraded for step in other)


def test_the_same_samples_with_regular_times_on_them_are_another_walk() -> None:
    fed = jittered(1)
    dt = (fed[-1].t - fed[0].t) / (len(fed) - 1)
    untold = [evolve(sample, t=fed[0].t + k * dt) for k, sample in enumerate(fed)]
    lengths = [[step.length for step in steps_of(one)] for one in (regular(), fed, untold)]
    assert max(abs(b - a) for a, b in zip(lengths[0], lengths[1], strict=True)) < 0.03
    assert max(abs(b - a) for a, b in zip(lengths[0], lengths[2], strict=False)) > 0.15


def test_lost_packets_are_counted_and_their_gap_degrades_the_step() -> None:
    walk = emulate(ROUTE, devices={LEFT: Insole(cells=24)}, radio=CLEAN, seed=3)
    kept = [packet for packet in walk.packets if not 6.0 < packet.t < 6.1]
    emitted = Session().feed(kept)
    (lost,) = of(PacketsLost, emitted)
    (gap,) = of(SampleGap, emitted)
    assert lost.count == len(walk.packets) - len(kept) == round(gap.duration * 100) - 1
    assert lost.t == pytest.approx(gap.t + 0.01, abs=1e-3)
    assert [step.degraded for step in of(StrideTaken, emitted)].count(True) == 1
    assert len(of(StrideTaken, emitted)) == len(walk.truth.steps(Foot.LEFT))
