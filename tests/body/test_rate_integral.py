"""Turn of a foot over the last seconds."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.body.worn.rate_integral import INSTANT, RateIntegral
from solepath.body.worn.sides import MAX_GAP, MAX_INSTANTS
from solepath.types import Vec3

RATES = st.tuples(*[st.floats(-30.0, 30.0)] * 3)


@given(st.floats(0.0, 1e6), st.lists(st.tuples(st.floats(0.015, MAX_GAP), RATES), min_size=1, max_size=60))
@settings(max_examples=40)
def test_the_turn_of_a_foot_is_the_integral_of_its_rate(start: float, rates: list[tuple[float, Vec3]]) -> None:
    integral = RateIntegral()
    integral.restart(start)
    t, times, turns = start, [start], [(0.0, 0.0, 0.0)]
    for dt, gyro in rates:
        t += dt
        integral.add(t, dt, gyro, 100)
        times.append(t)
        turns.append(tuple(a + dt * rate for a, rate in zip(turns[-1], gyro, strict=True)))  # type: ignore[arg-type]
    assert integral.times() == pytest.approx(times, abs=1e-4)
    near = next((k for k, turn in enumerate(turns) if max(map(abs, turn)) > 3.9), len(turns))
    for stored, true in zip(integral.turns_between(0, near), turns, strict=False):
        assert stored == pytest.approx(true, abs=3e-4)


def test_of_a_foot_that_never_lands_only_the_newest_instants_are_kept() -> None:
    integral = RateIntegral()
    integral.restart(0.0)
    for k in range(1, 1000):
        integral.add(0.02 * k, 0.02, (9.0, -9.0, 0.0), MAX_INSTANTS)
        assert len(integral.instants) <= MAX_INSTANTS * INSTANT.size
    times = integral.times()
    assert times[-1] == 0.02 * 999 and times[-1] - times[0] > 1.3
    *_, last = integral.turns_between(len(times) - 11, len(times))
    assert last == pytest.approx((1.8, -1.8, 0.0), abs=3e-4)
    integral.keep_newest()
    assert integral.times() == [0.02 * 999]
    integral.clear()
    assert integral.times() == [] and integral.t is None
