"""Emulated patients: what is limped, halted and shuffled is in the motion, and every true stride is in its truth."""

from __future__ import annotations

import numpy as np
import pytest
from commands import run

from solepath.types import Foot
from solepath_lab.command import main as lab
from solepath_lab.emulated.slow_walkers import GAITS, Found, Gait, patient

SLOW, SHUFFLING, LIMPING, STICK = GAITS


def swings(gait: Gait, seed: int) -> list[float]:
    """Return the median swing time of the left and the right foot, s."""
    one = patient(gait, seed)
    times = [(one.true_times(foot, "toe_off"), one.true_times(foot, "heel_strike")) for foot in Foot]
    return [float(np.median(np.subtract(end, start))) for start, end in times]


def test_who_limps_stands_shorter_on_one_leg_and_who_is_slow_on_both_alike() -> None:
    left, right = swings(SLOW, 4)
    assert left == pytest.approx(right, rel=0.1)
    left, right = swings(LIMPING, 4)
    assert max(left, right) > 1.2 * min(left, right)


@pytest.mark.parametrize("gait", GAITS, ids=[gait.name for gait in GAITS])
def test_a_foot_is_still_where_the_truth_says_that_it_stands(gait: Gait) -> None:
    one = patient(gait, 6)
    assert one.duration >= one.walker.duration - 1e-6
    for foot in Foot:
        flats, lifts = one.true_times(foot, "foot_flat")[:-1], one.true_times(foot, "heel_off")[1:]
        middle = 0.5 * (np.array(flats) + np.array(lifts))
        speed = np.linalg.norm(one.kinematics(foot, middle).velocity, axis=1)
        assert speed.max() < 0.02
        tops = 0.5 * (np.array(one.true_times(foot, "toe_off")) + np.array(one.true_times(foot, "heel_strike")))
        assert np.median(np.linalg.norm(one.kinematics(foot, tops).velocity, axis=1)) > 0.25


def test_scores_of_several_walks_add_up() -> None:
    total = Found(3, 2, 1, findings=("axes",)) + Found(true=4, found=4, walking=9.0, time=10.0)
    assert (total.true, total.found, total.invented, total.findings) == (7, 6, 1, ("axes",))
    assert total.walking / total.time == 0.9


def test_the_command_prints_a_row_of_each_gait_that_is_asked_for() -> None:
    options = ("--wearers", 1, "--only", "shuffling", "--rate", 50, "--processes", 1)
    done = run("emulated", "slow-walkers", *options, program=lab)
    title, _, row = done.stdout.splitlines()
    assert title.startswith("| 1 wearers each, 50 Hz | strides found |") and row.startswith("| shuffling | ")
