"""A rest shows by which rate the strides before it have turned the track, unless the bias has changed meanwhile."""

from __future__ import annotations

import numpy as np
import pytest

from solepath.body.fuse.common_error import FEET, NO_MOVE, CommonError
from solepath.foot.navigate.bias import Bias
from solepath.types import Foot

ON = 1.3 + 0.0j
"""A stride straight on, m."""
SURE = (1e-4, 0.0, 1e-4)


def bias_of(variance: float, spans: int, change: float = 0.0, device: int = 0) -> Bias:
    """Return what `spans` spans of rest have shown; `variance` is in (rad/s)^2, `change` in rad/s."""
    return Bias((0.0, 0.0, change), (variance, variance), 0.0, change, spans, device)


def error_of(*feet: Foot) -> CommonError:
    """Return the error of feet that have no drift, or of a foot alone, at its first stride, with a bias of 1 mrad/s."""
    error = CommonError()
    for row in FEET.values():
        error.covariance[row][row] = error.covariance[row + 1][row + 1] = 0.0
    for foot in feet:
        error.start_stride(foot, len(feet) == 1)
        assert error.add_rest(foot, 0.0, bias_of(1e-6, 4)) == NO_MOVE
    return error


def walk(error: CommonError, strides: int, *feet: Foot) -> float:
    """Walk on; return the duration, s."""
    for k in range(strides):
        foot = feet[k % len(feet)]
        error.start_stride(foot, len(feet) == 1)
        error.propagate(foot, 1.0, 0.0, 1.1, ON, SURE)
        assert error.add_rest(foot, 0.0, bias_of(1e-6, 4)) == NO_MOVE
    return 1.1 * strides


def is_covariance(error: CommonError) -> bool:
    p = np.array(error.covariance)
    scale = np.sqrt(np.maximum(np.diag(p), 1e-30))
    return bool(np.array_equal(p, p.T) and min(np.linalg.eigvalsh(p / np.outer(scale, scale))) > -1e-7)


@pytest.mark.parametrize("feet", [(Foot.LEFT,), (Foot.RIGHT,), tuple(Foot)])
def test_a_rest_after_a_walk_turns_the_track_back_by_what_its_bias_has_turned(feet: tuple[Foot, ...]) -> None:
    """100 strides straight on with a bias that is too large by 1 mrad/s, which a long rest of both feet shows."""
    error = error_of(*feet)
    t = walk(error, 100, *feet)
    turned, length = 1e-3 * t / len(feet), 130.0 / len(feet)
    moves = [error.add_rest(foot, 0.0, bias_of(1e-10, 5, -1e-3)) for foot in feet]
    y, heading = (sum(move[axis] for move in moves) for axis in (1, 2))
    assert heading == pytest.approx(turned, rel=0.05)
    assert y == pytest.approx(0.5 * turned * length, rel=0.1)
    assert error.estimates == pytest.approx([0.0] * 9, abs=2e-5), "the feet have removed it"
    assert error.heading_sigma < 0.3 * turned and is_covariance(error)
