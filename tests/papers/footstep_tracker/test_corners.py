"""The low-pass filter of turns: straight strides, curves, corners and gaps."""

from __future__ import annotations

from math import pi, radians

import pytest

from solepath.body.gait.turning_steps import TurningStrideFilter


def test_the_usual_turn_of_a_straight_step_is_no_turn_and_a_corner_is() -> None:
    turning = TurningStrideFilter()
    for _ in range(60):
        turning.turn(0.1)
    assert turning.straight_turn == pytest.approx(0.1, abs=0.01)
    assert turning.turn(0.15) == 0.0
    assert turning.turn(1.6) == pytest.approx(1.5, abs=0.02)
    assert turning.straight_turn == pytest.approx(0.1, abs=0.02)


def test_a_curve_stays_a_curve_and_a_corner_keeps_its_first_and_last_turn() -> None:
    """A circle of 24 strides of 15 degrees, most of which `turn` takes for straight; a corner of 5, 40, 40 and 5."""
    ours, printed = TurningStrideFilter(), TurningStrideFilter()
    circle = [radians(15.0)] * 24
    assert sum([ours.corner_turn(turn) for turn in circle]) == pytest.approx(2.0 * pi)
    assert sum([printed.turn(turn) for turn in circle]) < 0.3 * 2.0 * pi
    corner = [radians(turn) for turn in (0.0, 5.0, 40.0, 40.0, 5.0, 0.0)]
    turns = [ours.corner_turn(turn) for turn in corner]
    assert turns[:2] == [0.0, 0.0] and turns[5] == 0.0
    # the usual turn follows the first 5 degrees by a tenth: 5 + 39.5 + 39.5 + 4.5
    assert sum(turns) == pytest.approx(radians(88.5))


def test_a_stride_after_a_gap_does_not_end_the_corner_before_it() -> None:
    followed, parted = TurningStrideFilter(), TurningStrideFilter()
    assert followed.corner_turn(0.1) == parted.corner_turn(0.1) == 0.0
    parted.forget_corner()
    corner, usual = followed.corner_turn(1.0), 0.01
    assert corner == pytest.approx(1.0 - usual + 0.1, abs=0.02)
    assert parted.corner_turn(1.0) == pytest.approx(1.0 - usual, abs=0.02)
