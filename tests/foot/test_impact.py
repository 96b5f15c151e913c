"""The middle of an impact, on pulses whose middle is known."""

from __future__ import annotations

from math import pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from solepath.foot.cues.impact import Impact
from solepath.types import Quat, Vec3
from solepath.types.vector import GRAVITY, ZERO, from_rotation_vector, rotate

LANDED, LASTS = 0.52, 0.03
"""When the ground's push of `felt` is half over, and how long it takes, s."""


def felt(rate: float, mounting: Quat = (1.0, 0.0, 0.0, 0.0)) -> Impact:
    """A swing of 0.6 s at 2 m/s that ends in a push of 40 m/s^2 upwards, as the sensor in this mounting has it."""
    impact = Impact()
    impact.begin(0.0)
    was: Vec3 | None = None
    for k in range(int(0.6 * rate)):
        t = k / rate
        share = (t - LANDED) / LASTS + 0.5
        push = 40.0 * sin(pi * share) if 0.0 < share < 1.0 else 0.0
        acc = rotate(mounting, (3.0 * sin(5.0 * t), 0.0, GRAVITY + push))
        if was is not None:
            impact.feel(t, 1.0 / rate, was, acc, 2.0, t > LANDED - LASTS)
        was = acc
    return impact


@pytest.mark.parametrize("rate", [50.0, 100.0, 200.0, 400.0])
def test_the_middle_of_an_impact_is_found_at_any_rate(rate: float) -> None:
    assert felt(rate).middle == pytest.approx(LANDED, abs=0.004 + 0.25 / rate)


@given(st.tuples(*[st.floats(-2.0, 2.0)] * 3))
def test_how_the_sensor_is_mounted_does_not_matter(turn: Vec3) -> None:
    assert felt(100.0, from_rotation_vector(turn)).middle == pytest.approx(felt(100.0).middle, abs=1e-6)


def test_the_jolt_of_leaving_the_ground_is_not_that_of_landing() -> None:
    impact = Impact()
    impact.begin(0.0)
    for k in range(1, 60):
        pushed, landed = 90.0 if k == 5 else 0.0, 20.0 if k == 50 else 0.0
        impact.feel(0.01 * k, 0.01, ZERO, (pushed, 0.0, landed), 1.0, False)
        assert (impact.hardest > 0.0) is (k >= 50)
    assert impact.jolted == pytest.approx(0.495)


@given(st.lists(st.tuples(st.floats(0.0, 1e6), *[st.floats(-1e300, 1e300)] * 3), max_size=20))
def test_no_force_and_no_time_step_makes_it_forget_how_to_count(told: list[tuple[float, float, float, float]]) -> None:
    impact, t, was = Impact(), 0.0, (0.0, 0.0, GRAVITY)
    impact.begin(t)
    for dt, x, y, z in told:
        t += dt
        impact.feel(t, dt, was, (x, y, z), 1.0, False)
        was = (x, y, z)
        assert 0.0 <= impact.middle <= t and 0.0 <= impact.shock < 1e300
