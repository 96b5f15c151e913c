"""Sample times, lost and late packets, restarts, and other values of declared devices."""

from __future__ import annotations

from itertools import pairwise
from random import Random

import pytest
from attrs import evolve
from toys import BASE, KIND, LAYOUT, LEFT, NUMBERED, PROFILE, TICKING, times, toy
from walks import of

from solepath import Sample
from solepath.events import BatteryLevel, ClockReset, KeysChanged, LayoutKnown, PacketRejected, Rejection, SampleGap
from solepath.link.driver import TimeAxis
from solepath.saving import codec


@pytest.mark.parametrize("count", [1, 4])
@pytest.mark.parametrize("name", KIND)
def test_samples_are_as_far_apart_as_they_were_taken_whatever_the_radio_does(name: str, count: int) -> None:
    device, random = toy(KIND[name]), Random(3)
    output, arrival = [], 0.0
    for k in range(2000 // count):
        t = 10.0 + k * count / 100
        arrival = max(arrival, t + 0.03 * random.random() ** 2)
        output += device.packet(k, arrival - t + 1e-9, count=count)
    assert not of(PacketRejected, output) and not of(SampleGap, output) and not of(ClockReset, output)
    sample_times = times(output)
    assert len(sample_times) == 2000 // count * count
    intervals = [b - a for a, b in zip(sample_times[500:], sample_times[501:], strict=False)]
    assert min(intervals) > 0.0099 and max(intervals) < 0.0101
    assert sample_times[-1] == pytest.approx(10.0 + (2000 // count - 1) * count / 100, abs=0.012)


@pytest.mark.parametrize("name", ["number", "ticks", "both", "coarse"])
def test_lost_late_or_repeated_packets_are_reported_and_the_others_keep_their_times(name: str) -> None:
    device = toy(KIND[name])
    output = [item for k in (*range(8), 10, 11) for item in device.packet(k)]
    (lost,) = of(SampleGap, output)
    assert lost.count == 2 and (lost.t, lost.duration) == pytest.approx((10.07, 0.03), abs=1e-3)
    assert times(output) == pytest.approx([10.0 + 0.01 * k for k in (*range(8), 10, 11)], abs=1e-3)
    before = codec.save(device.decoder)
    (again,), (late,) = device.packet(11, 0.001), device.packet(9, 0.021)
    assert (again.reason, late.reason) == (Rejection.DUPLICATE, Rejection.LATE)
    (before_last,) = device.packet(10, 0.021)
    assert before_last.reason is Rejection.DUPLICATE
    assert codec.save(device.decoder) == before


@pytest.mark.parametrize("name", ["number", "ticks", "both", "coarse"])
def test_a_device_that_restarts_gets_a_new_fit_and_times_go_on(name: str) -> None:
    device = toy(KIND[name])
    output = [item for k in range(400) for item in device.packet(k)]
    for k in range(300):
        output += device.send_data(17.0 + 0.01 * k, 5 + k, 77 + round((10_000 if name != "coarse" else 10) * k))
    (reset,) = of(ClockReset, output)
    assert reset.restarted and reset.t == pytest.approx(17.0, abs=0.02)
    (absence,) = of(SampleGap, output)
    assert (absence.count, absence.t, absence.duration) == pytest.approx((0, 13.99, 3.01), abs=0.02)
    assert not of(PacketRejected, output)
    sample_times = times(output)
    assert sample_times == sorted(sample_times) and len(set(sample_times)) == 700
    assert sample_times[-1] == pytest.approx(17.0 + 2.99, abs=0.02)


def test_a_pause_shows_in_a_coarse_clock_and_after_a_long_silence_without_one() -> None:
    for name, pause, resets in (("coarse", 0.8, 0), ("coarse", 40.0, 0), ("number", 6.0, 1)):
        device = toy(KIND[name])
        output = [item for k in range(300) for item in device.packet(k)]
        for k in range(300, 600):
            output += device.send_data(
                10.0 + 0.01 * k + pause, 65_530 + k, 86_400_000 - 2000 + 10 * k + round(1000 * pause)
            )
        (absence,) = of(SampleGap, output)
        assert len(of(ClockReset, output)) == resets
        assert (absence.count, absence.duration) == pytest.approx((0, 0.01 + pause), abs=0.02)
        sample_times = times(output)
        # a count that goes on may be of packets that were held back, until they come at their own pace
        steps = [after - before for before, after in pairwise(sample_times)]
        assert max(steps) == pytest.approx(0.01 + pause, abs=0.02)
        assert 299 <= steps.index(max(steps)) <= 299 + 5 * resets
        assert sample_times[-1] == pytest.approx(15.99 + pause, abs=0.02)


@pytest.mark.parametrize("true_rate", [50.0, 200.0])
def test_ticks_show_that_the_rate_is_another(true_rate: float) -> None:
    device = toy(TICKING)
    output = [device.packet(k, true_rate=true_rate) for k in range(60)]
    assert not [item for items in output for item in of(SampleGap, items)]
    assert device.decoder.link is not None and device.decoder.link.rate == pytest.approx(true_rate)
    assert times([item for items in output for item in items]) == pytest.approx(
        [10.0 + k / true_rate for k in range(60)], abs=1e-3
    )
    (lost,) = of(SampleGap, device.packet(63, true_rate=true_rate))
    assert lost.count == 3


MILLISECONDS = evolve(BASE, tick_rate=1000.0, tick_modulus=1 << 32)


@pytest.mark.parametrize("true_rate", [300.0, 380.0, 400.0, 420.0, 450.0, 500.0])
@pytest.mark.parametrize("count", [1, 4])
def test_a_clock_of_few_ticks_a_sample_reports_no_false_losses(true_rate: float, count: int) -> None:
    driver = evolve(MILLISECONDS, profile=evolve(PROFILE, nominal_rate=min(500.0, max(333.0, round(true_rate, -2)))))
    assert driver.axis is TimeAxis.TICKS
    device, output = toy(driver), []
    for k in range(1500):
        if 1400 <= k < 1403:
            continue
        t = 10.0 + k * count / true_rate
        output += device.send_data(t + 0.01, ticks=int(1000 * t), count=count)
        if k == 1300:
            assert {type(item) for item in output} == {Sample}
    (lost,) = [item for item in output if not isinstance(item, Sample)]
    assert isinstance(lost, SampleGap) and lost.count == 3 * count
    sample_times = times(output)
    assert sample_times == sorted(set(sample_times)) and sample_times[-1] == pytest.approx(
        10.01 + 1499 * count / true_rate, abs=0.012
    )


def test_losses_are_counted_at_the_rate_that_the_device_reported() -> None:
    for name in ("arrival", "ticks"):
        device = toy(KIND[name])
        output = device.send_more(9.9, 1, 20.0)
        output += [item for k in (*range(50), 52) for item in device.packet(k, true_rate=20.0)]
        (lost,) = of(SampleGap, output)
        assert lost.count == 2, name


def test_what_is_no_sample_becomes_an_event_or_is_remembered() -> None:
    device = toy(NUMBERED)
    (battery,) = device.send_more(1.0, 0, 0.5)
    assert battery == BatteryLevel(t=1.0, known_at=1.0, site=LEFT, level=0.5)
    assert device.send_more(1.0, 6, 1.0) == [KeysChanged(t=1.0, known_at=1.0, site=LEFT, down=("left",))]
    assert device.send_more(1.0, 7, 0.0) == [LayoutKnown(t=1.0, known_at=1.0, site=LEFT, layout=LAYOUT)]
    assert device.send_more(1.0, 7, 0.0) == [], "it is the same layout"
    assert [event.layout.id for event in device.send_more(1.0, 7, 1.0)] == [LAYOUT.id + 1]
    assert device.send_more(1.0, 5, 1.0) == device.send_more(1.0, 8, 4.0) == []
    (sample,) = of(Sample, device.send_data(1.1, 1))
    assert sample.acc == pytest.approx((0.0, 0.0, 2 * 9.80665)) and sample.quat == (1.0, 0.0, 0.0, 0.0)


def test_air_pressure_rides_on_the_next_sample_or_stands_alone() -> None:
    device = toy(NUMBERED)
    assert times(device.send_more(1.0, 3, 101_000.0)) == [1.0]
    device.send_data(1.5, 1)
    assert device.send_more(1.505, 3, 101_001.0) == device.send_more(1.506, 4, 2e-5) == []
    (sample,), (next_one,) = device.send_data(1.51, 2), device.send_data(1.52, 3)
    assert (sample.air_pressure, sample.mag) == (101_001.0, (2e-5, 0.0, 0.0))
    assert (next_one.air_pressure, next_one.mag) == (None, None)
