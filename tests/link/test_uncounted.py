"""Devices without counters: their rate is what arrives, copies are told by their content, and no loss is invented."""

from __future__ import annotations

import re
from math import ceil, hypot
from random import Random
from statistics import median

import pytest
from decoded import LEFT, cc2650_value
from hypothesis import given, settings
from hypothesis import strategies as st
from soak import longer, soaked
from uncounted import SITE, Radio, board, follow, sent
from walks import of

from solepath import DefectFound, Limitation, Packet, PacketRejected, SampleGap, Session, StreamStale, StrideTaken
from solepath.events import Defect
from solepath.link.periodic import PeriodicClock
from solepath.show.findings import findings

BURSTS = [1, 2, 3, 6]


def arrivals(true: float, seconds: float, radio: Radio, start: float = 0.0) -> list[tuple[float, bytes]]:
    """Return arrival and content of notifications that all differ, `true` a second."""
    return radio.deliver((start + k / true, b"%d %d" % (start, k)) for k in range(int(seconds * true)))


def connection(
    true: float, seconds: float, interval: float, chance: float = 0.0, delay: float = 0.0, seed: int = 1
) -> list[tuple[float, bytes]]:
    """Return what connection events deliver, one each `interval` s; by chance one is late by `delay`, s."""
    random, newest, event, out = Random(seed), 0.0, 0, []
    for k in range(int(seconds * true)):
        if (due := ceil((k / true + 0.005) / interval)) > event:
            event, newest = due, max(newest, due * interval + delay * (random.random() < chance))
        out.append((100.0 + newest, b"%d" % k))
    return out


def times_of(clock: PeriodicClock, packets: list[tuple[float, bytes]]) -> tuple[list[float], int]:
    times, lost = [], 0
    for arrival, data in packets:
        found = clock.add_packet(arrival, 1.0, data)
        times += found.times
        lost += found.lost_count
    return times, lost


@pytest.mark.parametrize("burst", BURSTS)
@pytest.mark.parametrize(
    ("true", "said"), [(50, 100), (100, 50), (67, 100), (80, 100), (66, 200), (30, 200), (200, 30), (119, 60)]
)
def test_the_rate_is_the_count_over_time_within_seconds_and_nothing_is_lost(
    true: float, said: float, burst: int
) -> None:
    clock = PeriodicClock(1.0 / said)
    packets = arrivals(true, 30.0, Radio(burst=burst))
    times, lost = times_of(clock, packets)
    assert lost == 0
    assert times == sorted(set(times))
    for start in (5.0, 10.0, 20.0):
        first = int(start * true)
        interval = (times[first + int(4 * true)] - times[first]) / int(4 * true)
        assert interval == pytest.approx(1.0 / true, rel=0.03)
    assert times[-1] - packets[-1][0] == pytest.approx(0.0, abs=0.1 + burst / true)


@pytest.mark.parametrize("burst", BURSTS)
@pytest.mark.parametrize("share", [0.9, 0.935, 1.065, 1.15, *longer(0.92, 0.93, 1.07, 1.08, 1.1)])
def test_a_rate_that_is_a_little_off_is_followed_within_five_seconds(share: float, burst: int) -> None:
    for true in (40.0, 50.0, 100.0, 180.0):
        clock = PeriodicClock(1.0 / (share * true))
        times, lost = times_of(clock, arrivals(true, 20.0, Radio(burst=burst)))
        assert lost == 0
        second = int(true)
        for start in range(5 * second, 19 * second, second):
            assert times[start + second] - times[start] == pytest.approx(second / true, rel=0.02)


@settings(max_examples=60, deadline=None)
@given(
    true=st.floats(51.0, 200.0),  # twice that period is below 40 ms: from there on a gap may show a loss at once
    share=st.floats(0.5, 2.0),
    interval=st.floats(0.03, 0.1),
    late=st.sampled_from([(0.0, 0), (0.05, 1), (0.03, 2), (0.1, 1)]),
    seed=st.integers(0, 99),
)
def test_connection_events_that_carry_bursts_and_are_late_lose_nothing_whatever_rate_was_said(
    true: float, share: float, interval: float, late: tuple[float, int], seed: int
) -> None:
    clock, (chance, events) = PeriodicClock(share / true), late
    times, lost = times_of(clock, connection(true, 30.0, interval, chance, events * interval, seed))
    assert lost == 0
    for start in (11.0, 20.0):
        first, last = int(start * true), int((start + 9.0) * true)
        assert (times[last] - times[first]) / (last - first) == pytest.approx(1.0 / true, rel=0.03)


@pytest.mark.parametrize("interval", [0.03, 0.06])
@pytest.mark.parametrize("true", [100.0, 200.0])
@pytest.mark.parametrize("missing", [0.3, 0.6])
def test_what_a_device_drops_while_the_radio_stalls_is_a_loss_in_bursts_too(
    true: float, interval: float, missing: float
) -> None:
    first = round(12.01 * true)
    count = round(missing * true)
    arrived = connection(true, 30.0, interval)
    times, lost = times_of(PeriodicClock(1.0 / true), arrived[:first] + arrived[first + count :])
    assert lost == pytest.approx(count, abs=interval * true)
    assert times[-1] == pytest.approx(arrived[-1][0], abs=interval)


@pytest.mark.parametrize("burst", BURSTS)
@pytest.mark.parametrize("rate", [30, 52, 100, 200])
def test_a_rate_that_is_right_stays(rate: float, burst: int) -> None:
    clock = PeriodicClock(1.0 / rate)
    _, lost = times_of(clock, arrivals(rate, 60.0, Radio(burst=burst)))
    assert (lost, clock.period) == (0, pytest.approx(1.0 / rate, rel=1e-9))
    assert clock.report_rate(1, SITE, 160.0) == []


@pytest.mark.parametrize(("before", "after"), [(100, 50), (50, 100), (100, 67), (104, 208), (40, 80), (200, 66)])
@pytest.mark.parametrize("burst", [1, 3])
def test_a_device_that_changes_its_rate_loses_nothing(before: float, after: float, burst: int) -> None:
    clock = PeriodicClock(1.0 / before)
    first, second = Radio(burst=burst), Radio(burst=burst, seed=2)
    packets = arrivals(before, 20.0, first) + arrivals(after, 20.0, second, start=20.0)
    times, lost = times_of(clock, packets)
    assert lost == 0 and times == sorted(set(times))
    last = int(10 * after)
    assert (times[-1] - times[-1 - last]) / last == pytest.approx(1.0 / after, rel=0.02)


@pytest.mark.parametrize(("true", "said"), [(5, 10), (7, 10), (20, 10), (1, 10), (10, 20), (25, 10)])
def test_a_slow_device_whose_period_was_not_written_loses_nothing(true: float, said: float) -> None:
    clock = PeriodicClock(1.0 / said)
    _, lost = times_of(clock, arrivals(true, 60.0, Radio(jitter=0.004)))
    assert (lost, clock.period * (1.0 + clock.clock.drift)) == (0, pytest.approx(1.0 / true, rel=0.03))


@pytest.mark.parametrize("share", [0.5, *soaked(0.2, 1.0)])
@pytest.mark.parametrize(
    ("true", "said", "burst"), [(100, 100, 1), (50, 100, 2), (100, 50, 3), (60, 60, 6), (30, 90, 1)]
)
def test_a_notification_that_comes_twice_is_one_value(true: float, said: float, burst: int, share: float) -> None:
    arrived = Radio(burst=burst, twice=share).deliver(sent(true, 12.0))
    _, walk, events = follow(board(said), arrived)
    copies = len(arrived) - len(sent(true, 12.0)) // burst * burst
    rejected = of(PacketRejected, events)
    assert {event.reason.value for event in rejected} == {"duplicate"}
    assert len(rejected) == pytest.approx(copies, rel=0.03, abs=3)
    assert walk.links[SITE].missing == 0


@pytest.mark.parametrize("rate", [10, 50, 100, 200])
@pytest.mark.parametrize("said", [0.5, 1.0, 2.0])
def test_a_sensor_at_rest_repeats_values_at_its_own_pace_and_none_is_a_copy(rate: float, said: float) -> None:
    clock = PeriodicClock(1.0 / (said * rate))
    packets = Radio(jitter=0.1 / rate).deliver((k / rate, b"the same") for k in range(int(20 * rate)))
    used = 0
    for arrival, data in packets:
        used += len(clock.add_packet(arrival, 1.0, data).times)
    assert used == len(packets)
    assert clock.period == pytest.approx(1.0 / rate, rel=0.05)


WALKS = [  # true rate, rate that was said, burst, share of copies, share of losses
    (50.0, 100.0, 1, 0.0, 0.0), (67.0, 100.0, 2, 0.0, 0.0), (66.0, 200.0, 2, 0.0, 0.02), (80.0, 100.0, 1, 0.0, 0.0),
    (52.0, 104.0, 4, 0.5, 0.03),
    *soaked((100.0, 50.0, 3, 1.0, 0.0), (150.0, 60.0, 6, 0.3, 0.05), (40.0, 160.0, 1, 1.0, 0.01)),
]  # fmt: skip


@pytest.mark.parametrize("walk", WALKS, ids=str)
def test_a_walk_has_its_length_whatever_rate_was_said(walk: tuple[float, float, int, float, float]) -> None:
    true, said, burst, twice, loss = walk
    lengths = []
    for seed in (1, 2, 3):
        session, found, _ = follow(board(said), Radio(burst, twice, loss, seed=seed).deliver(sent(true, 30.0)))
        assert session.position is not None
        lengths.append(hypot(*session.position.position[:2]))
        (rate,) = re.findall(r"([\d.]+) samples a second arrive", " ".join([one.what for one in findings(found)]))
        assert float(rate) == pytest.approx(true * (1.0 - loss), rel=0.04)
    assert median(lengths) == pytest.approx(30.0, rel=0.04)


@pytest.mark.long
def test_of_200_walks_over_devices_without_counters_95_in_100_have_their_length_or_the_true_rate_is_said() -> None:
    random, good, plain_findings = Random(11), 0, 0
    for number in range(200):
        true, said = round(random.uniform(30.0, 200.0), 1), float(round(random.uniform(30.0, 200.0)))
        twice, loss = random.choice((0.0, random.random(), 1.0)), random.uniform(0.0, 0.05)
        radio = Radio(random.randint(1, 6), twice, loss, seed=number)
        session, walk, events = follow(board(said), radio.deliver(sent(true, 24.0, seed=number % 7)))
        position = session.position
        length = 0.0 if position is None else hypot(*position.position[:2])
        words = " ".join([event.what for event in of(Limitation, events)])
        rates = re.findall(r"([\d.]+) samples a second arrive", words)
        is_said = any(abs(float(rate) / true - 1.0) < 0.08 for rate in rates)
        good += abs(length - 24.0) <= 0.03 * 24.0 or is_said
        if number % 2 == 0:
            plain = follow(board(round(true)), Radio(seed=number).deliver(sent(float(round(true)), 12.0)))[1]
            plain_findings += any(one.act for one in findings(plain)) or bool(plain.links[SITE].missing)
        sent.cache_clear()
    assert good >= 190
    assert plain_findings <= 1


@pytest.mark.parametrize(
    ("period", "words"), [(1.0, "one sample a second"), (2.0, "one sample in 2 s"), (0.5, "2 samples a")]
)
@pytest.mark.parametrize("written", [True, False])
def test_a_sensortag_at_its_default_period_is_told_to_set_it_and_nothing_else(
    period: float, words: str, written: bool
) -> None:
    session, events, random = Session(), [], Random(1)
    if written:
        events += session.feed(Packet(99.0, LEFT, "cc2650/movement-period", bytes([round(period * 100)])))
    for k in range(40):
        value = cc2650_value("movement", gyro=(k % 3, 0, 9), acc=(0, k % 5, 4096), mag=(100, 200, 300))
        events += session.feed(Packet(100.0 + k * period + 0.01 * random.random(), LEFT, "cc2650/movement", value))
    (defect,) = of(DefectFound, events)
    assert defect.defect is Defect.LOW_RATE and defect.what.startswith(words) and "set the period" in defect.what
    assert sum(gap.count for gap in of(SampleGap, events)) == 0
    assert len(of(StreamStale, events)) <= (0 if written or period < 2.0 else 2)
    assert not of(StrideTaken, events)
