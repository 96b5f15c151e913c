"""Devices whose clock or rate is another than was declared: nothing is lost by that, and the true one is named."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from random import Random
from typing import Any

import pytest
from attrs import evolve
from soak import longer
from toys import BOTH, TICKING, Toy, times, toy
from walks import of

from solepath.events import ClockReset, Limitation, SampleGap
from solepath.link.driver import Driver

RATE = 100.0
CLOCKS = [1000.0, 1024.0, 32768.0, 1e6]
"""Ticks a second of clocks that boards have."""


def send(device: Toy, moments: Iterable[float], ticks: Callable[[float], float], seed: int = 1) -> list[list[Any]]:
    """Send a packet for each of these moments, s, some milliseconds late; return what each gives."""
    random, output, arrival = Random(seed), [], 0.0
    for k, t in enumerate(moments):
        arrival = max(arrival, 10.0 + t + 0.01 * random.random())
        output.append(device.send_data(arrival, 65_530 + k, int(ticks(t))))
    return output


def flat(output: list[list[Any]]) -> list[Any]:
    return [item for items in output for item in items]


def lost(output: list[list[Any]]) -> int:
    return sum(gap.count for gap in of(SampleGap, flat(output)))


def steady(rate: float, seconds: float, start: float = 0.0) -> list[float]:
    return [start + k / rate for k in range(round(rate * seconds))]


@pytest.mark.parametrize("true", [20.0, 33.0, 50.0, 75.0, 150.0, 200.0, 400.0])
def test_a_rate_that_is_another_from_the_start_loses_nothing_and_is_named_within_seconds(true: float) -> None:
    output = send(toy(TICKING), steady(true, 10.0), lambda t: 1e6 * t)
    assert lost(output) == 0 and of(ClockReset, flat(output)) == []
    (limitation,) = of(Limitation, flat(output))
    assert limitation.what.startswith(f"{true:.3g} samples a second arrive, not the 100 that were set")
    assert limitation.t < 15.0


@pytest.mark.parametrize(("before", "after"), [(100.0, 50.0), (100.0, 25.0), (50.0, 100.0), (25.0, 100.0)])
def test_a_rate_that_changes_loses_one_packet_at_most_and_is_named_within_seconds(before: float, after: float) -> None:
    device = toy(evolve(TICKING, profile=evolve(TICKING.profile, nominal_rate=before)))
    output = send(device, steady(before, 15.0) + steady(after, 10.0, 15.0), lambda t: 1e6 * t)
    assert lost(output) <= max(0.0, before / after - 1.0)
    (limitation,) = of(Limitation, flat(output))
    assert limitation.what.startswith(f"{after:.3g} samples a second arrive, not the {before:.3g}")
    assert limitation.t < 32.0


@pytest.mark.parametrize("base", [TICKING, *longer(BOTH)])
@pytest.mark.parametrize("true", CLOCKS)
@pytest.mark.parametrize("declared", CLOCKS)
def test_a_clock_with_another_unit_is_named_within_seconds_and_then_gives_the_times(
    base: Driver, true: float, declared: float
) -> None:
    if base is BOTH and declared < 20 * RATE:
        return  # its numbers give the times
    moments = steady(RATE, 20.0)
    output = send(toy(evolve(base, tick_rate=declared)), moments, lambda t: true * t)
    found = of(Limitation, flat(output))
    assert lost(output) == 0
    if abs(true / declared - 1.0) < 0.1:  # a clock may be so wrong, and its fit follows
        assert found == []
    else:
        (limitation,) = found
        assert f"{true:.6g} ticks a second arrive, not the {declared:.6g}" in limitation.what and limitation.t < 17.0
    late = times(flat(output))[-1000:]
    assert late[-1] - late[0] == pytest.approx(9.99, rel=0.02), "what the first seconds cost is slewed by 2 %"


@pytest.mark.parametrize("share", [0.05, 0.3])
def test_losses_are_all_counted_however_many_there_are(share: float) -> None:
    for seed in range(5):
        random = Random(seed)
        moments = [t for t in steady(RATE, 30.0) if t < 0.05 or random.random() >= share]
        output = send(toy(TICKING), moments, lambda t: 1e6 * t, seed)
        assert lost(output) == pytest.approx(round(moments[-1] * RATE) + 1 - len(moments), abs=3)
        assert of(Limitation, flat(output)) == []


def test_packets_that_catch_up_and_a_clock_that_was_set_show_no_other_unit_or_rate() -> None:
    device, output = toy(TICKING), []
    for k, t in enumerate(steady(RATE, 30.0)):
        late = 2.0 - 0.6 * (t - 10.0) if 10.0 <= t < 10.0 + 2.0 / 0.6 else 0.0
        ticks = 1e6 * (t + (3600.0 if t >= 20.0 else 0.0))
        output.append(device.send_data(10.0 + t + late, k, int(ticks)))
    assert lost(output) == 0 and of(Limitation, flat(output)) == []
    assert len(of(ClockReset, flat(output))) == 1
