"""The low-pass filter of turns: straight strides, curves, corners and gaps."""

from __future__ import annotations

from math import pi, radians

import pytest

from solepath.body.gait.turning_steps import TurningStrideFilter


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
