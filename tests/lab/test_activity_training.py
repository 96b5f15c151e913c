"""Tests what the activities part learns of the order of activities."""

from __future__ import annotations

from math import isclose

from solepath.body.activity.chain import STAIRS_UP, WALK
from solepath.types import Activity
from solepath_lab.descriptions import read_rows
from solepath_lab.train import turns
from solepath_lab.train.activities_course import DEFAULT_CHANCES, LabelledCourse, chances, changes
from solepath_lab.train.hugadb import spans

STANDING, WALKING, STAIRS = Activity.STANDING, Activity.WALKING, Activity.STAIRS_UP


def test_turns_for_training_have_seeds_for_training() -> None:
    assert min(int(row["seed"]) for row in read_rows(turns.__file__, "turns.csv")) >= turns.FIRST_TRAINING_SEED


def test_labels_become_spans_and_a_gap_parts_them() -> None:
    t = [0.0, 0.1, 0.2, 0.3, 5.0, 5.1]
    done = spans(t, [STANDING, STANDING, WALKING, WALKING, WALKING, None])
    assert done == [(0.0, 0.1, STANDING), (0.2, 0.3, WALKING), (5.0, 5.0, WALKING)]
    assert changes(done) == [(0.2, STANDING, WALKING)]


def test_frequent_climbing_makes_stairs_likelier() -> None:
    done = [(10.0 * k, 10.0 * k + 10.0, (WALKING, STAIRS)[k % 2]) for k in range(100)]
    learnt = chances([LabelledCourse(0.0, {}, tuple(done))])
    assert all(isclose(sum(row), 1.0, abs_tol=1e-4) for row in learnt)
    assert (
        DEFAULT_CHANCES[WALK][STAIRS_UP] < learnt[WALK][STAIRS_UP] < 1.0 / 20.0 + 1e-3
    )  # ten seconds are twenty blocks
