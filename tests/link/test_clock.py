"""Conversion of device ticks to host seconds, with emulated radios from a seeded generator."""

from __future__ import annotations

from random import Random

import pytest

from solepath.link.clock import Clock
from solepath.link.periodic import PeriodicClock

RATE = 32768
INTERVAL = 328
SAMPLE_INTERVAL = INTERVAL / RATE


def arrivals(
    seconds: float,
    *,
    drift: float = 0.0,
    jitter: float = 0.05,
    loss: float = 0.05,
    seed: int = 1,
    in_order: bool = False,
) -> list[tuple[float, int, float]]:
    """Return (true time, ticks, arrival) of a device at 100 Hz, in order of arrival without overtaken packets."""
    random, packets, newest = Random(seed), [], 0.0
    for k in range(int(seconds / SAMPLE_INTERVAL)):
        true = k * SAMPLE_INTERVAL / (1.0 + drift)
        if random.random() < loss:
            continue
        arrival = true + (random.expovariate(1.0 / jitter) if jitter else 0.0)
        newest = max(newest, arrival)
        packets.append((true, k * INTERVAL, newest if in_order else arrival))
    packets.sort(key=lambda packet: packet[2])
    packets_in_order: list[tuple[float, int, float]] = []
    for packet in packets:
        if not packets_in_order or packet[1] > packets_in_order[-1][1]:
            packets_in_order.append(packet)
    return packets_in_order


def assign_times(packets: list[tuple[float, int, float]], clock: Clock) -> list[tuple[float, float]]:
    """Return (true time, assigned time) of each packet."""
    out = []
    for true, ticks, arrival in packets:
        assert not clock.contradicts(ticks, arrival)
        clock.observe(ticks, arrival)
        out.append((true, clock.assign_time(ticks)))
    return out


def error_at(times: list[tuple[float, float]], second: float) -> float:
    errors = [abs(t - true) for true, t in times if abs(true - second) < 0.5]
    return sum(errors) / len(errors)


def worst_interval_error(times: list[tuple[float, float]]) -> float:
    """Return the largest relative error of the time between two neighbouring samples."""
    return max(abs((b[1] - a[1]) / (b[0] - a[0]) - 1.0) for a, b in zip(times, times[1:], strict=False))


@pytest.mark.parametrize("seed", range(2))
def test_radio_jitter_of_50_ms_does_not_reach_sample_times(seed: int) -> None:
    times = assign_times(arrivals(90.0, drift=40e-6, seed=seed), Clock(RATE))
    assert error_at(times, 20.0) < 0.025
    assert error_at(times, 60.0) < 0.001
    settled = [(true, t) for true, t in times if true > 30.0]
    assert worst_interval_error(settled) < 1e-3
    assert worst_interval_error(times) < 0.0075


def test_a_late_first_packet_is_slewed_away_at_half_a_percent() -> None:
    packets = arrivals(40.0, jitter=0.0, loss=0.0)
    packets[0] = (packets[0][0], packets[0][1], 0.0099)
    late = [(true, ticks, max(arrival, 0.05)) for true, ticks, arrival in packets[:6]] + packets[6:]
    times = assign_times(late, Clock(RATE))
    assert times[0][1] == 0.05
    assert worst_interval_error(times) <= 0.00501
    assert error_at(times, 30.0) < 1e-4


def test_a_packet_half_a_minute_late_is_of_another_clock_at_once() -> None:
    clock = Clock(RATE)
    for second in range(3):
        clock.observe(second * RATE, float(second))
    assert clock.contradicts(3 * RATE, 3.0 + 31.0)
    assert not clock.contradicts(3 * RATE, 3.0 + 29.0)


def test_a_packet_before_its_measurement_means_that_the_clock_jumped() -> None:
    clock = Clock(RATE)
    assign_times(arrivals(10.0), clock)
    ticks = round(10.0 * RATE)
    assert not clock.contradicts(ticks, 10.0)
    assert clock.contradicts(ticks + 2 * RATE, 10.0)


def test_a_delay_is_not_a_jump_until_it_stays() -> None:
    clock = Clock(RATE)
    assign_times(arrivals(10.0), clock)
    for second in range(10, 29):
        assert not clock.contradicts(second * RATE, second + 3.0)
        clock.observe(second * RATE, second + 3.0)
    assert any(clock.contradicts(second * RATE, second + 3.0) for second in range(29, 33))
    assert clock.contradicts(29 * RATE, 29 + 40.0)


@pytest.mark.parametrize("jitter", [0.005, 0.05])
@pytest.mark.parametrize("seed", [1, 2])
def test_two_settled_clocks_agree_within_5_ms(seed: int, jitter: float) -> None:
    """Arrivals are up to `jitter` late; one device starts late, as after a new connection."""
    random, differences = Random(seed), []
    feet = [(Clock(RATE), random.gauss(0.0, 30e-6), late) for late in (0.0, 0.1)]
    newest = [0.0, 0.0]
    for k in range(6000):
        errors: list[float] = []
        for n, (clock, drift, late) in enumerate(feet):
            true = k * SAMPLE_INTERVAL / (1.0 + drift)
            newest[n] = max(newest[n], true + jitter * random.random(), late if k < 10 else 0.0)
            clock.observe(k * INTERVAL, newest[n])
            t = clock.assign_time(k * INTERVAL)
            if clock.unsettled_until is not None and clock.unsettled_until < t:
                errors.append(t - true)
        if len(errors) == 2:
            differences.append(abs(errors[0] - errors[1]))
    assert len(differences) > 2000
    assert max(differences) < 0.005


def test_a_clock_is_unsettled_for_5_s_and_while_a_late_start_is_slewed_away() -> None:
    good, late = Clock(RATE), Clock(RATE)
    for k in range(4000):
        for clock, arrival in ((good, k * SAMPLE_INTERVAL), (late, max(k * SAMPLE_INTERVAL, 0.1))):
            clock.observe(k * INTERVAL, arrival)
            clock.assign_time(k * INTERVAL)
    assert good.unsettled_until == pytest.approx(5.0, abs=2 * SAMPLE_INTERVAL)
    assert late.unsettled_until is not None and 20.0 < late.unsettled_until < 30.0  # 95 ms at 5 ms a second, and 5 s


def make_slots(
    seconds: float, period: float, *, jitter: float = 0.005, loss: float = 0.05, drift: float = 0.0, seed: int = 1
) -> list[tuple[float, float]]:
    """Return (true time, arrival) of each packet, in order."""
    random, out, newest = Random(seed), [], 0.0
    for k in range(int(seconds / period)):
        true = k * period * (1.0 + drift)
        if k and random.random() < loss:
            continue
        newest = max(newest, true + random.expovariate(1.0 / jitter))
        out.append((true, newest))
    return out


def time_packets(packets: list[tuple[float, float]], stream: PeriodicClock) -> tuple[list[float], int]:
    """Return the errors of the assigned times, and the number of reported losses."""
    errors, lost_count = [], 0
    for true, arrival in packets:
        sample_times = stream.add_packet(arrival, 5.0)
        errors.append(sample_times.times[0] - true)
        lost_count += sample_times.lost_count
    return errors, lost_count


@pytest.mark.parametrize("period", [0.1, 0.05])
@pytest.mark.parametrize("drift", [0.0, -0.04])
def test_losses_without_counters_are_counted_by_their_holes(period: float, drift: float) -> None:
    packets = make_slots(60.0, period, drift=drift)
    errors, lost_count = time_packets(packets, PeriodicClock(period))
    assert lost_count == int(60.0 / period) - len(packets)
    assert max(abs(e) for e in errors[len(errors) // 2 :]) < 0.003


@pytest.mark.parametrize("drift", [0.0, 5e-5, -5e-5])
@pytest.mark.parametrize("loss", [0.005, 0.02, 0.05])
def test_losses_of_a_stream_that_is_faster_than_the_radio_are_counted_by_what_stays_behind(
    loss: float, drift: float
) -> None:
    packets = make_slots(120.0, 0.01, loss=loss, drift=drift)
    lost_count = time_packets(packets, PeriodicClock(0.01))[1]
    assert lost_count == pytest.approx(12_000 - len(packets), rel=0.06)


@pytest.mark.parametrize("drift", [0.0, 5e-5, 0.01, -0.02])
def test_a_slow_or_fast_clock_of_such_a_stream_is_no_loss(drift: float) -> None:
    assert time_packets(make_slots(120.0, 0.01, loss=0.0, drift=drift), PeriodicClock(0.01))[1] == 0


def test_of_one_packet_of_two_hundred_never_more_is_counted_than_was_lost() -> None:
    packets = [one for k, one in enumerate(make_slots(120.0, 0.01, loss=0.0)) if k % 200 != 100]
    lost_count = time_packets(packets, PeriodicClock(0.01))[1]
    assert lost_count <= 60


@pytest.mark.parametrize(("true", "assumed"), [(0.05, 0.1), (0.17, 0.1), (1.0, 0.1), (0.1, 0.05)])
def test_a_period_that_was_never_written_is_found(true: float, assumed: float) -> None:
    stream = PeriodicClock(assumed)
    time_packets(make_slots(60.0, true, loss=0.02), stream)
    assert stream.period == pytest.approx(true, rel=0.04)
