"""Closure of the velocity of a stride: the integration of the turns is exact, however few the samples."""

from __future__ import annotations

from math import cos, sin

import pytest

from solepath.body.checks.axes import NO_TURN, closure_residuals
from solepath.body.checks.stances import FORCE, TICK, TURN, ClosedStride
from solepath.types.vector import GRAVITY


@pytest.mark.parametrize("rate", [10.0, 50.0])
def test_a_fast_turn_that_leaves_the_sensor_in_its_place_closes_at_any_rate(rate: float) -> None:
    """The force of each interval is that of its middle, so that only the turns are integrated."""
    turn, duration, count = round(17.0 / rate / TURN), round(1.0 / (rate * TICK)), round(1.2 * rate)  # 17 rad/s
    angle = TURN * turn

    def upwards(turned: float) -> tuple[int, int, int]:
        return round(-sin(turned) * GRAVITY / FORCE), 0, round(cos(turned) * GRAVITY / FORCE)

    intervals = [(duration, 0, turn, 0, *upwards((i + 0.5) * angle)) for i in range(count)]
    x, y, z = upwards(count * angle)
    stride = ClosedStride(
        tuple(intervals), (0.0, 0.0, GRAVITY), (FORCE * x, FORCE * y, FORCE * z), 0.0, count * TICK * duration, 0.0
    )
    residuals = closure_residuals(stride)
    assert len(residuals) == NO_TURN + 1 and len(set(residuals)) > 2
    assert closure_residuals(stride, enough=0.5) == [residuals[0]] + [residuals[NO_TURN]] * NO_TURN
    assert residuals[0] < 3e-3
