"""A turn has the angle of each foot that took strides in it, and of no other."""

from __future__ import annotations

import pytest
from strides import stride

from solepath.body.gait.turns import TurnDetector
from solepath.types import Foot


def test_a_foot_that_took_its_last_stride_before_the_turn_has_no_angle_in_it() -> None:
    turns = TurnDetector()
    turns.add_stride(stride(Foot.RIGHT, 1.5))
    found = [turns.add_stride(stride(Foot.LEFT, 10.0 + k, heading_change=0.6 if k < 3 else 0.0)) for k in range(6)]
    (turn,) = [one for one in found if one is not None]
    assert turn.t_start == pytest.approx(9.0) and turn.left == pytest.approx(1.8, abs=0.4) and turn.right is None


def test_a_stride_that_becomes_known_after_a_later_pivot_takes_nothing_from_the_turn() -> None:
    turns = TurnDetector()
    turns.add_pivot(Foot.LEFT, 9.0, 10.0, 1.0)
    turns.add_stride(stride(Foot.LEFT, 8.0))
    turned = turns.finish()
    assert turned is not None and turned.angle == 1.0
