"""Walks from end to end, each against its truth: every step is found, none invented, its moment, length and turn."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import radians
from random import Random

import numpy as np
import pytest
from attrs import evolve
from soak import soaked
from walks import LEFT, RIGHT, of

from solepath import Event, Foot, FootFlat, HeelOff, HeelStrike, Sample, SampleGap, Session, StrideTaken, ToeOff
from solepath.emulate import CC2541, CC2650, EmulatedWalk, Insole, Route, emulate
from solepath.emulate.radio import CLEAN, Radio
from solepath.emulate.sensors.device import Device
from solepath.link.decoder import Decoder
from solepath.validate.comparison import FootComparison, compare
from solepath.validate.foot_run import FootRun
from solepath.walk import Walk

BAD = Radio(loss=0.05, jitter=0.05)
"""A radio that loses 5 % of the notifications and delays the others by up to 50 ms."""
START = Route().stand(2.0)
ROUTES = {
    "long": START.walk(40.0, 1.3).stop(2.0),
    "thirty": Route().stand(3.0).walk(30.0, 1.2).stop(3.0),
    "short": START.walk(12.0, 1.2).stop(1.5),
    "slow": START.walk(10.0, 0.7).stop(2.0),
    "fast": START.walk(20.0, 1.7).stop(2.0),
    "left": START.walk(6.0, 1.3).turn(radians(90), radius=1.5).walk(6.0).stop(2.0),
    "right": START.walk(6.0, 1.3).turn(radians(-90), radius=1.5).walk(6.0).stop(2.0),
    "about": START.walk(6.0, 1.2).stop(1.0).turn(radians(180)).walk(6.0).stop(2.0),
    "halts": START.walk(5.0, 1.2).stop(3.0).walk(5.0).stop(14.0).walk(5.0).stop(2.0),
    "standing": Route().stand(15.0),
}
Compared = tuple[list[Event], dict[Foot, FootComparison]]
SOAK = pytest.mark.soak
SEEDS = pytest.mark.parametrize("seed", [1, *soaked(2)])


def compared(walk: EmulatedWalk) -> Compared:
    """Return the events of a session for a walk, and their comparison with the truth, foot by foot."""
    session, found = Session(poses=True, losses=True), Walk(limit=None, keeps_all=True)
    events = session.feed(walk.packets) + session.finish()
    for event in events:
        found.add(event)
    return events, {one.foot: one for one in compare(walk.truth, {foot: FootRun.of(found, foot) for foot in Foot})}


@cache
def walked(name: str, radio: Radio = BAD, seed: int = 4, device: Device | None = None) -> Compared:
    worn = device or Insole(cells=24)
    return compared(emulate(ROUTES[name], devices={LEFT: worn, RIGHT: worn}, radio=radio, seed=seed))


def check_all_found(one: Compared, least: int) -> None:
    """Check that every true step is found and none invented."""
    for foot in one[1].values():
        assert foot.strides_true >= least
        assert (foot.strides_found, foot.strides_invented) == (foot.strides_true, 0), foot.foot


@SEEDS
@pytest.mark.soak
def test_every_step_over_a_bad_radio_is_found_in_its_time_and_length_and_says_what_is_missing(seed: int) -> None:
    events, feet = walked("long", seed=seed, device=Insole())
    check_all_found((events, feet), 25)
    for one in feet.values():
        assert one.length_errors.mean <= 0.03
        for kind in ("heel_strike", "foot_flat", "heel_off", "toe_off"):
            assert one.events[kind].f1 == pytest.approx(1.0, abs=0.01)
            offsets = sorted(abs(offset) for offset in one.events[kind].offsets)
            assert offsets[len(offsets) // 2] <= 0.040 and offsets[int(0.9 * len(offsets))] <= 0.060
    steps = of(StrideTaken, events)
    # one packet in twenty is lost, of a hundred in a step: something is missing of nearly all, and few have a flaw
    assert sum(0.0 < step.missing < 0.2 for step in steps) > 0.9 * len(steps)
    assert sum(step.degraded for step in steps) < 0.05 * len(steps)


@pytest.mark.parametrize(
    ("name", "turned"),
    [
        ("slow", 0),
        pytest.param("fast", 0, marks=SOAK),
        pytest.param("left", 90, marks=SOAK),
        pytest.param("right", -90, marks=SOAK),
        pytest.param("about", 180, marks=SOAK),
        pytest.param("halts", 0, marks=SOAK),
    ],
)
def test_slow_fast_halting_and_turning_walks_have_all_their_steps_which_add_up_to_the_turn(
    name: str, turned: float
) -> None:
    events, feet = walked(name)
    for foot, one in feet.items():
        if name == "about":  # small steps on the spot
            assert one.strides_found >= one.strides_true - 1 and one.strides_invented <= 1 and one.end_error < 0.5
        else:
            check_all_found((events, feet), 7)
            assert one.length_errors.mean <= 0.04
            assert one.events["heel_strike"].f1 == one.events["toe_off"].f1 == pytest.approx(1.0, abs=0.04)
        sums = sum(step.heading_change for step in of(StrideTaken, events) if step.foot is foot)
        assert sums == pytest.approx(radians(turned), abs=radians(8))


@pytest.mark.soak
def test_standing_has_no_step_and_a_walk_over_a_clean_radio_none_that_is_degraded() -> None:
    events, feet = walked("standing")
    assert of(StrideTaken | HeelStrike | FootFlat | HeelOff | ToeOff, events) == []
    assert all(one.strides_true == one.strides_invented == 0 for one in feet.values())
    steps = of(StrideTaken, walked("short", CLEAN)[0])
    assert len(steps) > 10 and not any(step.degraded for step in steps)


@pytest.mark.parametrize(
    "device",
    [
        Insole(cells=24, mtu=23, rate=50.0),
        pytest.param(Insole(cells=60, batch=4), marks=SOAK),
        pytest.param(Insole(cells=35, rate=50.0, quaternion=True), marks=SOAK),
        pytest.param(Insole(cells=24, rate=200.0, batch=8), marks=SOAK),
    ],
    ids=["fragments", "four a frame", "50 Hz", "200 Hz"],
)
def test_insoles_of_any_kind_find_every_step(device: Insole) -> None:
    check_all_found(walked("short", Radio(), 3, device), 8)


@pytest.mark.parametrize(
    ("device", "seeds", "least", "length_error", "contacts"),
    [
        pytest.param(CC2650(), range(1, 13), 0.99, 0.20, 0.85, marks=SOAK),
        pytest.param(CC2541(), (1, 2, 3), 0.97, 0.20, 0.0, marks=SOAK),
        pytest.param(CC2541(rate=20.0), (1,), 0.98, 0.15, 0.9, marks=SOAK),
    ],
    ids=["CC2650 at 10 Hz", "CC2541 at 10 Hz", "CC2541 at 20 Hz"],
)
def test_sensor_tags_find_the_steps_of_a_walk_and_when_the_foot_struck_and_left_the_ground(
    device: Device, seeds: Sequence[int], least: float, length_error: float, contacts: float
) -> None:
    feet = [foot for seed in seeds for foot in walked("thirty", Radio(), seed, device)[1].values()]
    assert f1(feet) >= least and sum(one.strides_invented for one in feet) <= 1
    assert all(one.strides_true >= 20 for one in feet)
    assert sum(one.length_errors.mean or 0.0 for one in feet) / len(feet) <= length_error
    for kind in ("heel_strike", "toe_off") if contacts else ():
        offsets = sorted(abs(t) for one in feet for t in one.events[kind].offsets)
        # a rate that ends at 250 degrees/s and comes ten times a second does not always show the end of a push-off
        assert len(offsets) >= contacts * sum(one.events[kind].n_true for one in feet)
        assert offsets[len(offsets) // 2] <= 0.060


def f1(feet: list[FootComparison]) -> float:
    """Return the F1 score of the steps: 2 found / (true + found + invented)."""
    found = sum(one.strides_found for one in feet)
    return 2.0 * found / sum(one.strides_true + one.strides_found + one.strides_invented for one in feet)


@pytest.mark.soak
def test_a_link_cut_nearly_once_a_second_loses_no_step_and_little_of_its_length() -> None:
    walk = emulate(ROUTES["thirty"], devices={site: Insole(cells=24) for site in (LEFT, RIGHT)}, seed=1)
    random, packets = Random(1), walk.packets
    for _ in range(round(0.9 * walk.truth.duration)):
        site, start = random.choice((LEFT, RIGHT)), random.uniform(8.0, walk.truth.duration)
        end = start + random.uniform(0.1, 0.6)
        packets = tuple(one for one in packets if one.site is not site or not start <= one.t < end)
    events, feet = compared(evolve(walk, packets=packets))
    assert f1(list(feet.values())) >= 0.98 and of(SampleGap, events)
    assert sum(step.degraded for step in of(StrideTaken, events)) > 10
    assert all(one.length_errors.mean <= 0.05 for one in feet.values())


@pytest.mark.parametrize(
    ("device", "rate"),
    [
        (Insole(cells=24, rate=30.0, batch=3), 30.0),
        (Insole(cells=99, mtu=65, quaternion=True), 100.0),
        (CC2650(), 10.0),
        (CC2541(rate=20.0), 20.0),
    ],
)
def test_decoded_samples_have_the_true_rate_and_the_true_motion(device: Device, rate: float) -> None:
    walk = emulate(ROUTES["short"], devices={LEFT: device}, radio=Radio(latency=0.001, jitter=0.002), seed=4)
    decoder = Decoder(LEFT)
    decoded = [one for packet in walk.packets for one in decoder.feed(packet)] + decoder.finish()
    samples = [one for one in decoded if isinstance(one, Sample)]
    t = np.array([one.t for one in samples])
    assert len(t) == pytest.approx((walk.truth.duration - 0.05) * rate, abs=0.02 * rate * walk.truth.duration + 3)
    assert np.median(np.diff(t)) == pytest.approx(1.0 / rate, rel=0.01)
    true = walk.walker.kinematics(Foot.LEFT, t, device.mounting).rate[:, 1]
    sway = np.array([one.gyro for one in samples])[:, 1]
    best = max(np.corrcoef(sway, np.interp(t - lag, t, true))[0, 1] for lag in np.arange(0.0, 0.02, 0.004))
    # a SensorTag saturates in swing, and its accelerometer sets the time
    assert best > (0.97 if rate >= 30.0 else 0.85)
    rest = np.array([one.acc for one in samples if one.t < 1.5])
    assert np.linalg.norm(rest, axis=1).mean() == pytest.approx(9.81, rel=0.2)
