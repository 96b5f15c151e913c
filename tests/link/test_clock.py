"""Device ticks to host seconds, against emulated radios with a seeded generator."""

from __future__ import annotations

import json
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.link.clock import MAX_WINDOWS, Clock
from solepath.link.periodic import PeriodicClock, make_periodic_clock
from solepath.saving import codec as machine

RATE = 32768
INTERVAL = 328
STEP = INTERVAL / RATE


def arrivals(
    seconds: float,
    *,
    drift: float = 0.0,
    jitter: float = 0.05,
    loss: float = 0.05,
    seed: int = 1,
    in_order: bool = False,
) -> list[tuple[float, int, float]]:
    """(true time, ticks, arrival) of a device at 100 Hz, in order of arrival; overtaken packets are left out."""
    random, packets, newest = Random(seed), [], 0.0
    for k in range(int(seconds / STEP)):
        true = k * STEP / (1.0 + drift)
        if random.random() < loss:
            continue
        arrival = true + (random.expovariate(1.0 / jitter) if jitter else 0.0)
        newest = max(newest, arrival)
        packets.append((true, k * INTERVAL, newest if in_order else arrival))
    packets.sort(key=lambda packet: packet[2])
    kept: list[tuple[float, int, float]] = []
    for packet in packets:
        if not kept or packet[1] > kept[-1][1]:
            kept.append(packet)
    return kept


def assigned(packets: list[tuple[float, int, float]], clock: Clock) -> list[tuple[float, float]]:
    """(true time, time assigned) of each."""
    out = []
    for true, ticks, arrival in packets:
        assert not clock.contradicts(ticks, arrival)
        clock.observe(ticks, arrival)
        out.append((true, clock.assign_time(ticks)))
    return out


def error_at(times: list[tuple[float, float]], second: float) -> float:
    near = [abs(t - true) for true, t in times if abs(true - second) < 0.5]
    return sum(near) / len(near)


def worst_step(times: list[tuple[float, float]]) -> float:
    """Largest relative error of the time between two neighbouring samples."""
    return max(abs((b[1] - a[1]) / (b[0] - a[0]) - 1.0) for a, b in zip(times, times[1:], strict=False))


@pytest.mark.parametrize("seed", range(5))
def test_radio_jitter_of_50_ms_does_not_reach_sample_times(seed: int) -> None:
    times = assigned(arrivals(90.0, drift=40e-6, seed=seed), Clock(RATE))
    assert error_at(times, 20.0) < 0.025
    assert error_at(times, 60.0) < 0.001
    settled = [(true, t) for true, t in times if true > 30.0]
    assert worst_step(settled) < 1e-3
    assert worst_step(times) < 0.0075


def test_the_drift_of_a_crystal_is_learnt_over_an_hour() -> None:
    clock = Clock(RATE)
    times = assigned(arrivals(3600.0, drift=40e-6), clock)
    assert clock.drift == pytest.approx(-40e-6, abs=1e-6)
    assert error_at(times, 3599.0) < 0.0003


@pytest.mark.parametrize("drift", [-1e-3, 1e-3, 0.04, -0.04])
def test_a_sloppy_clock_is_learnt_within_seconds(drift: float) -> None:
    clock = Clock(RATE)
    times = assigned(arrivals(60.0, drift=drift), clock)
    assert clock.drift == pytest.approx(1.0 / (1.0 + drift) - 1.0, abs=2e-5)
    assert error_at(times, 55.0) < 0.001
    assert worst_step([(true, t) for true, t in times if true > 5.0]) < 0.01


def test_a_queue_that_keeps_order_only_makes_the_fit_slower() -> None:
    times = assigned(arrivals(120.0, in_order=True), Clock(RATE))
    assert error_at(times, 110.0) < 0.01
    assert worst_step(times) < 0.015


def test_without_jitter_times_are_ticks() -> None:
    times = assigned(arrivals(10.0, jitter=0.0), Clock(RATE))
    assert max(abs(t - true) for true, t in times) < 1e-6


def test_a_late_first_packet_is_slewed_away_at_half_a_percent() -> None:
    packets = arrivals(40.0, jitter=0.0, loss=0.0)
    packets[0] = (packets[0][0], packets[0][1], 0.0099)
    late = [(true, ticks, max(arrival, 0.05)) for true, ticks, arrival in packets[:6]] + packets[6:]
    times = assigned(late, Clock(RATE))
    assert times[0][1] == 0.05
    assert worst_step(times) <= 0.00501
    assert error_at(times, 30.0) < 1e-4


def test_a_packet_half_a_minute_late_is_of_another_clock_at_once() -> None:
    clock = Clock(RATE)
    for second in range(3):
        clock.observe(second * RATE, float(second))
    assert clock.contradicts(3 * RATE, 3.0 + 31.0)
    assert not clock.contradicts(3 * RATE, 3.0 + 29.0)


def test_a_packet_before_its_measurement_means_that_the_clock_jumped() -> None:
    clock = Clock(RATE)
    assigned(arrivals(10.0), clock)
    ticks = round(10.0 * RATE)
    assert not clock.contradicts(ticks, 10.0)
    assert clock.contradicts(ticks + 2 * RATE, 10.0)


def test_a_delay_is_not_a_jump_until_it_stays() -> None:
    clock = Clock(RATE)
    assigned(arrivals(10.0), clock)
    for second in range(10, 29):
        assert not clock.contradicts(second * RATE, second + 3.0)
        clock.observe(second * RATE, second + 3.0)
    assert any(clock.contradicts(second * RATE, second + 3.0) for second in range(29, 33))
    assert clock.contradicts(29 * RATE, 29 + 40.0)


def test_memory_does_not_grow() -> None:
    clock = Clock(RATE)
    sizes = []
    for k in range(0, 100 * 3600, 7):
        clock.observe(k * INTERVAL, k * STEP + 0.001 * (k % 13))
        clock.assign_time(k * INTERVAL)
        sizes.append(len(clock.window_times))
    assert max(sizes) <= MAX_WINDOWS + 1
    assert len(json.dumps(machine.save(clock))) < 3000


@given(
    st.lists(st.tuples(st.integers(0, 200_000), st.floats(0.0, 30.0, allow_nan=False)), min_size=1, max_size=120),
    st.sampled_from([32768.0, 10.0, 1000.0]),
)
@settings(max_examples=60)
def test_times_strictly_increase_whatever_arrives_when(moves: list[tuple[int, float]], rate: float) -> None:
    clock, ticks, arrival, newest = Clock(rate), 0, 0.0, -1.0
    for step, pause in moves:
        ticks, arrival = ticks + step, arrival + pause
        clock.observe(ticks, arrival)
        foreseen = clock.preview_time(ticks)
        t = clock.assign_time(ticks)
        assert t > newest
        assert t == foreseen or t == pytest.approx(newest + 1e-6)
        newest = t


@pytest.mark.parametrize("jitter", [0.005, 0.02, 0.05])
@pytest.mark.parametrize("seed", range(1, 6))
def test_two_settled_clocks_agree_within_5_ms(seed: int, jitter: float) -> None:
    """Each arrival up to `jitter` late; the other device has a late first half second, as after a new connection."""
    random, apart = Random(seed), []
    feet = [(Clock(RATE), random.gauss(0.0, 30e-6), late) for late in (0.0, 0.1)]
    newest = [0.0, 0.0]
    for k in range(6000):
        errors: list[float] = []
        for n, (clock, drift, late) in enumerate(feet):
            true = k * STEP / (1.0 + drift)
            newest[n] = max(newest[n], true + jitter * random.random(), late if k < 10 else 0.0)
            clock.observe(k * INTERVAL, newest[n])
            t = clock.assign_time(k * INTERVAL)
            if clock.unsettled_until is not None and clock.unsettled_until < t:
                errors.append(t - true)
        if len(errors) == 2:
            apart.append(abs(errors[0] - errors[1]))
    assert len(apart) > 2000
    assert max(apart) < 0.005


def test_a_clock_is_unsettled_for_5_s_and_while_a_late_start_is_slewed_away() -> None:
    good, late = Clock(RATE), Clock(RATE)
    for k in range(4000):
        for clock, arrival in ((good, k * STEP), (late, max(k * STEP, 0.1))):
            clock.observe(k * INTERVAL, arrival)
            clock.assign_time(k * INTERVAL)
    assert good.unsettled_until == pytest.approx(5.0, abs=2 * STEP)
    assert late.unsettled_until is not None and 20.0 < late.unsettled_until < 30.0  # 95 ms at 5 ms a second, and 5 s


def slots(
    seconds: float, period: float, *, jitter: float = 0.005, loss: float = 0.05, drift: float = 0.0, seed: int = 1
) -> list[tuple[float, float]]:
    """(true time, arrival), in order."""
    random, out, newest = Random(seed), [], 0.0
    for k in range(int(seconds / period)):
        true = k * period * (1.0 + drift)
        if k and random.random() < loss:
            continue
        newest = max(newest, true + random.expovariate(1.0 / jitter))
        out.append((true, newest))
    return out


def timed(packets: list[tuple[float, float]], stream: PeriodicClock) -> tuple[list[float], int]:
    """Errors of the times, and losses counted."""
    errors, lost_count = [], 0
    for true, arrival in packets:
        found = stream.add_packet(arrival)
        errors.append(found.times[0] - true)
        lost_count += found.lost_count
    return errors, lost_count


@pytest.mark.parametrize("period", [0.1, 0.05])
@pytest.mark.parametrize("drift", [0.0, 0.001, 0.04, -0.04])
def test_losses_without_counters_are_counted_by_their_holes(period: float, drift: float) -> None:
    packets = slots(60.0, period, drift=drift)
    errors, lost_count = timed(packets, make_periodic_clock(period))
    assert lost_count == int(60.0 / period) - len(packets)
    assert max(abs(e) for e in errors[len(errors) // 2 :]) < 0.003


def test_lateness_of_less_than_a_period_is_no_loss() -> None:
    errors, lost_count = timed(slots(120.0, 0.1, jitter=0.01, loss=0.0), make_periodic_clock(0.1))
    assert lost_count == 0
    assert max(abs(e) for e in errors[600:]) < 0.003


@pytest.mark.parametrize(("true", "assumed"), [(0.05, 0.1), (0.17, 0.1), (1.0, 0.1), (0.1, 0.05)])
def test_a_period_that_was_never_written_is_found(true: float, assumed: float) -> None:
    stream = make_periodic_clock(assumed)
    timed(slots(60.0, true, loss=0.02), stream)
    assert stream.period == pytest.approx(true, rel=0.04)


@given(st.lists(st.floats(0.0, 20.0, allow_nan=False), max_size=150))
@settings(max_examples=60)
def test_times_without_counters_strictly_increase(pauses: list[float]) -> None:
    stream, arrival, newest = make_periodic_clock(0.1), 5.0, -1.0
    for pause in pauses:
        arrival += pause
        found = stream.add_packet(arrival)
        assert found.times[0] > newest
        assert found.lost_count >= 0
        newest = found.times[0]
