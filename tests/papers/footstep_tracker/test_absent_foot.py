"""What is assumed of a foot that takes no stride stays when its clock was set back."""

from __future__ import annotations

import pytest
from strides import stride

from solepath.papers.footstep_tracker.footsteps import Footsteps
from solepath.types import SITE_OF_FOOT, Foot


def test_what_was_assumed_of_an_absent_foot_stays_when_its_clock_was_set_back() -> None:
    body, right = Footsteps(), Foot.RIGHT
    body.paths[right].has_samples = True
    body.add_stride(stride(right, 0.5, (1.0, 0.0, 0.0)))
    for k in range(10):
        body.add_stride(stride(Foot.LEFT, 1.0 + k, (1.0, 0.0, 0.0)))
    went = body.paths[right].displacement[0]
    assert went > 5.0, "it counts as if it had moved with the left foot"
    body.reset(SITE_OF_FOOT[right])
    body.add_stride(stride(right, 0.4, (1.4, 0.0, 0.0), t_start=0.1))
    assert body.paths[right].displacement[0] == pytest.approx(went + 1.4)
