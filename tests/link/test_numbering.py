"""Devices whose numbers count something else than notifications: nothing is lost, and the right declaration is said."""

from __future__ import annotations

from itertools import product
from random import Random
from typing import Any

import pytest
from attrs import evolve
from toys import KIND, Toy, times, toy
from walks import of

from solepath import Sample
from solepath.events import ClockReset, Limitation, PacketRejected, SampleGap

RATE = 100.0
WITH_NUMBERS = pytest.mark.parametrize("name", ["number", "both", "coarse"])


def send(device: Toy, name: str, number: int, k: int, count: int, random: Random) -> list[Any]:
    """Send packet k of `count` samples with this number, some milliseconds late."""
    t, unit = k * count / RATE, 1000 if name == "coarse" else 1_000_000
    return device.send_data(10.0 + t + count / RATE + 0.01 * random.random(), 65_530 + number, round(unit * t), count)


def said(output: list[Any]) -> list[Limitation]:
    """Return what is said of the numbers, and not that a driver has no use for its ticks."""
    return [event for event in of(Limitation, output) if "ticks" not in event.what]


@WITH_NUMBERS
@pytest.mark.parametrize("count", [2, 4])
def test_numbers_that_count_samples_lose_none_and_are_named(name: str, count: int) -> None:
    device, random, output = toy(KIND[name]), Random(1), list[Any]()
    for k in range(400):
        if k not in (200, 201):
            output += send(device, name, k * count, k, count, random)
    (limitation,) = said(output)
    assert f"up by {count} with each notification of {count} samples, so it counts samples" in limitation.what
    assert f"sequence=number // {count} in the reader and sequence={65536 // count} in the Driver" in limitation.what
    (gap,) = of(SampleGap, output)
    assert gap.count == 2 * count and of(PacketRejected, output) == []
    found = times(output)
    assert len(found) == 398 * count
    assert found[-1] - found[300] == pytest.approx((400 * count - 1 - 300) / RATE, abs=0.02)


@WITH_NUMBERS
@pytest.mark.parametrize("step", [2, 10])
def test_numbers_that_go_up_by_a_constant_step_lose_none_and_are_named(name: str, step: int) -> None:
    for count in (1, 3):
        device, random, output = toy(KIND[name]), Random(1), list[Any]()
        for k in range(400):
            if k not in (200, 201):
                t = 10.0 + (k + 1) * count / RATE + 0.003 * random.random()
                unit = 1000 if name == "coarse" else 1_000_000
                output += device.send_data(t, 65_530 + k * step, round(unit * k * count / RATE), count)
        (limitation,) = said(output)
        assert f"the number goes up by {step} with each notification, so nothing is lost" in limitation.what
        (gap,) = of(SampleGap, output)
        assert gap.count == 2 * count and of(PacketRejected, output) == [] and len(times(output)) == 398 * count


@WITH_NUMBERS
@pytest.mark.parametrize("copies", [2, 3])
def test_numbers_that_come_several_times_cost_no_samples_and_are_named(name: str, copies: int) -> None:
    device, random, output = toy(KIND[name]), Random(1), list[Any]()
    for k in range(400):
        output += send(device, name, k // copies, k, 1, random)
    (limitation,) = said(output)
    assert "the same number comes with several notifications, whose values differ" in limitation.what
    assert of(SampleGap, output) == of(PacketRejected, output) == []
    found = times(output)
    assert len(found) == 400 and found[-1] - found[100] == pytest.approx(2.99, abs=0.02)


@WITH_NUMBERS
def test_of_a_device_that_counts_notifications_nothing_is_said_whatever_gets_lost(name: str) -> None:
    for seed in range(5):
        device, random, output, sent = toy(KIND[name]), Random(seed), list[Any](), list[int]()
        for k in range(300):
            if random.random() > 0.3:
                sent.append(k)
                output += send(device, name, k, k, 2, random)
        assert said(output) == of(PacketRejected, output) == []
        first_step = next(b for a, b in zip(sent, sent[1:], strict=False) if b - a == 1)
        unsaid = 2 * (first_step - sent[0] + 1 - sent.index(first_step) - 1)
        lost = sum(gap.count for gap in of(SampleGap, output))
        assert 2 * (sent[-1] - sent[0] + 1 - len(sent)) - unsaid <= lost <= 2 * (sent[-1] - sent[0] + 1 - len(sent))


@pytest.mark.parametrize("numbers", [2, 3, 4, 16, 65536])
def test_no_number_and_no_count_of_samples_is_an_error(numbers: int) -> None:
    for name, seed in product(("number", "both"), range(20)):
        device, random, steady = toy(evolve(KIND[name], sequence=numbers)), Random(seed), seed % 2 == 0
        for k in range(60):
            count = 2 if steady and k < 40 else random.choice((1, 2, 3, 4, 9, 200))
            number = 2 * k if steady and k < 40 else random.randrange(65536)
            output = device.send_data(10.0 + 0.02 * k, number, 20_000 * k, count)
            assert all(type(item) in (ClockReset, Limitation, PacketRejected, Sample, SampleGap) for item in output)


ROUNDS = [(1, 255, 256), (0, 99, 65536), (1, 1000, 65536), (0, 249, 256), (0, 15, 256), (5, 204, 65536)]
"""Lowest and highest number of a round, and the number of values that was declared."""


@WITH_NUMBERS
@pytest.mark.parametrize("numbers", ROUNDS)
def test_where_the_numbers_start_again_is_learnt_from_two_rounds_and_named(
    name: str, numbers: tuple[int, int, int]
) -> None:
    low, high, declared = numbers
    if name == "coarse" and high < declared // 2:
        pytest.skip("numbers that go back though a clock does not are taken as damaged")
    count, output, missing = high - low + 1, list[list[Any]](), 0
    device, random = toy(evolve(KIND[name], sequence=declared)), Random(1)
    for k in range(6 * count):
        if k > 4 * count and random.random() < 0.03:
            missing += 1
            continue
        t, unit = k / RATE, 1000 if name == "coarse" else 1_000_000
        number = low + (k + count // 2) % count
        output.append(device.send_data(10.01 + t + 0.003 * random.random(), number, round(unit * t)))
    (limitation,) = said([item for items in output for item in items])
    assert f"the number goes from {high} to {low}" in limitation.what
    assert f"sequence={count} in the Driver" in limitation.what
    late = [item for items in output[2 * count :] for item in items]
    assert of(ClockReset, late) == of(PacketRejected, late) == []
    assert sum(gap.count for gap in of(SampleGap, late)) == pytest.approx(missing, abs=2)
    assert len(of(Sample, late)) == len(output) - 2 * count
    early = [item for items in output[: 2 * count] for item in items]
    assert len(of(SampleGap, early)) + len(of(ClockReset, early)) <= 4


@WITH_NUMBERS
def test_numbers_that_use_their_whole_round_teach_no_other_whatever_gets_lost(name: str) -> None:
    for seed in range(5):
        device, random, output, missing = toy(evolve(KIND[name], sequence=256)), Random(seed), list[Any](), 0
        for k in range(256 * 8):
            if k > 10 and random.random() < 0.2:
                missing += 1
                continue
            t, unit = k / RATE, 1000 if name == "coarse" else 1_000_000
            output += device.send_data(10.01 + t + 0.003 * random.random(), k % 256, round(unit * t))
        assert sum(gap.count for gap in of(SampleGap, output)) == pytest.approx(missing, abs=3)
        assert of(ClockReset, output) == []
