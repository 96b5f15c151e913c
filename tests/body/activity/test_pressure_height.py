"""Air pressure as evidence of activities: two barometers that drift apart, noise, and whole stretches."""

from __future__ import annotations

from math import exp, sqrt

import numpy as np
import pytest

from solepath.body.activity.chain import (
    ELEVATOR_CREEPS_DOWN,
    ELEVATOR_CREEPS_UP,
    ELEVATOR_MOVES_DOWN,
    ELEVATOR_MOVES_UP,
    STAIRS_DOWN,
    STAIRS_UP,
    STAND,
)
from solepath.body.activity.pressure_height import PressureHeight, ride_evidence, stairs_evidence
from solepath.body.height.barometric import SCALE_HEIGHT, STANDARD_PRESSURE
from solepath.types import Foot

BLOCK = 0.5


def pressure(height: float) -> float:
    return STANDARD_PRESSURE * exp(-height / SCALE_HEIGHT)


def standing(noise: float, apart: float, seed: int, blocks: int = 240) -> list[tuple[float, ...]]:
    """Return the scores of all states in each block of a wearer who stands, whose feet are read in turn.

    `noise` is that of a reading, m; the right barometer comes to read `apart` m more than the left one."""
    rng = np.random.default_rng(seed)
    heights, scores = PressureHeight(walked=True), []
    for k in range(blocks):
        foot, offset = (Foot.LEFT, 0.0) if k % 2 else (Foot.RIGHT, apart * k / blocks)
        heights.add(foot, k, pressure(offset + noise * float(rng.standard_normal())))
        if k >= 20:
            scores.append(heights.score_slope(k - 2, BLOCK))
    return scores


@pytest.mark.parametrize(("noise", "apart"), [(0.1, 0.0), (0.5, 0.0), (0.1, 3.0), (0.5, 3.0)])
def test_whoever_stands_is_not_on_stairs_whatever_the_noise_and_however_far_barometers_drift_apart(
    noise: float, apart: float
) -> None:
    scores = [one for seed in range(5) for one in standing(noise, apart, seed)]
    assert np.mean([one[STAND] for one in scores]) > -0.2
    assert np.mean([one[STAND] >= max(one[STAIRS_UP], one[STAIRS_DOWN]) for one in scores]) > 0.5


@pytest.mark.parametrize("noise", [0.05, 0.1, 0.5, 1.0])
def test_the_noise_of_readings_is_measured_also_in_a_lift(noise: float) -> None:
    rng, heights = np.random.default_rng(3), PressureHeight()
    for k in range(200):
        heights.add(Foot.LEFT, k, pressure(0.75 * max(0, min(k - 120, 20)) + noise * float(rng.standard_normal())))
    assert sqrt(heights.noise) == pytest.approx(noise, rel=0.35)


def test_a_second_barometer_starts_at_the_height_of_the_first() -> None:
    heights = PressureHeight()
    for k in range(40):
        heights.add(Foot.LEFT, k, pressure(0.1 * k))
    for k in range(40, 48):
        heights.add(Foot.RIGHT, k, pressure(50.0 + 0.1 * k))
    before, after = heights.height(41, 42), heights.height(45, 46)
    assert before is not None and after is not None
    assert after[0] - before[0] == pytest.approx(0.4, abs=0.03)
    assert before[0] == pytest.approx(4.1, abs=0.2)


def test_a_noisy_barometer_shows_the_direction_of_a_flight_from_its_ends() -> None:
    noise = 0.5
    up, down = [], []
    for seed in range(40):
        rng, heights = np.random.default_rng(seed), PressureHeight()
        start = end = None
        for k in range(60):
            height = 0.5 * 0.3 * max(0, min(k - 30, 18))  # nine seconds of stairs up
            heights.add(Foot.LEFT, k, pressure(height + noise * float(rng.standard_normal())))
            if k == 30:
                start = heights.height(k - 3, k - 1)
            if k == 52:
                end = heights.height(k - 3, k - 1)
        up.append(stairs_evidence(start, end, 1.0, 9.0))
        down.append(stairs_evidence(start, end, -1.0, 9.0))
    assert np.mean(np.array(up) > np.array(down)) >= 0.95
    assert np.mean(up) > 1.5 and np.mean(np.array(up) - np.array(down)) > 2.0


def test_a_ride_without_a_change_of_pressure_is_none() -> None:
    still, storey = (0.0, 0.05), (3.4, 0.05)
    assert ride_evidence(still, still, 1.0) < -2.5
    assert ride_evidence(still, storey, 1.0) > 2.5
    assert ride_evidence(still, storey, -1.0) == pytest.approx(0.0, abs=0.01)  # neither explains it
    assert ride_evidence(None, storey, 1.0) == ride_evidence(still, None, 1.0) == 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_flights_of_any_usual_speed_are_flights_in_their_direction(sign: float) -> None:
    for speed in (0.2, 0.3, 0.4):
        gained = sign * speed * 8.0
        assert stairs_evidence((0.0, 0.05), (gained, 0.05), sign, 8.0) > 1.0
        assert stairs_evidence((0.0, 0.05), (gained, 0.05), -sign, 8.0) < 0.1
    assert stairs_evidence((0.0, 0.05), (0.0, 0.05), sign, 8.0) < -1.0


def test_a_block_on_stairs_favours_their_direction() -> None:
    heights = PressureHeight(walked=True)
    for k in range(12):
        heights.add(Foot.LEFT, k, pressure(0.15 * k))
    scores = heights.score_slope(8, BLOCK)
    assert scores[STAIRS_UP] > scores[STAND] and scores[STAIRS_UP] > scores[STAIRS_DOWN]
    assert scores[STAIRS_UP] - scores[STAIRS_DOWN] > 0.5


@pytest.mark.parametrize("speed", [0.25, -0.25])
def test_air_pressure_that_changes_as_on_an_escalator_does_not_speak_against_standing(speed: float) -> None:
    heights = PressureHeight(walked=True)
    for k in range(12):
        heights.add(Foot.LEFT, k, pressure(speed * BLOCK * k))
    scores = heights.score_slope(8, BLOCK)
    rides = (ELEVATOR_MOVES_UP, ELEVATOR_MOVES_DOWN, ELEVATOR_CREEPS_UP, ELEVATOR_CREEPS_DOWN)
    assert scores[STAND] >= max([scores[state] for state in rides])


@pytest.mark.parametrize("late", [0, 1, 3])
def test_readings_of_a_foot_that_come_late_count_in_their_own_block(late: int) -> None:
    heights = PressureHeight(walked=True)
    for k in range(400):
        for foot, number in ((Foot.LEFT, k), (Foot.RIGHT, k - 10 * late)):
            if number >= 0:
                heights.add(foot, number // 25, pressure(0.006 * number))
    numbers = [number for number, _, _ in heights.blocks]
    assert numbers == sorted(set(numbers)) and len(numbers) >= 9
    assert heights.score_slope(12, BLOCK)[STAIRS_UP] == 0.0 > heights.score_slope(12, BLOCK)[STAND]


def test_another_barometer_on_a_foot_starts_at_the_height_of_the_first() -> None:
    heights = PressureHeight()
    for k in range(20):
        heights.add(Foot.LEFT, k, pressure(3.0))
    before = heights.height(16, 18)
    heights.restart(Foot.LEFT)
    for k in range(20, 30):
        heights.add(Foot.LEFT, k, pressure(90.0))
    after = heights.height(26, 28)
    assert before is not None and after is not None and after[0] == pytest.approx(before[0], abs=1e-6)
