"""Variability and asymmetry: values worked out by hand, how often the intervals hold the truth, and strides needed."""

from __future__ import annotations

from math import sqrt
from random import Random

import pytest
from strides import cycle, cycles

from solepath.events import Event
from solepath.show.outcomes import asymmetry, variability
from solepath.show.outcomes.spread import steady_strides
from solepath.types import Foot

L, R = Foot.LEFT, Foot.RIGHT


def test_values_are_those_worked_by_hand() -> None:
    # the last stride of each foot has none after it, so it does not count
    left, right = [1.0, 1.1, 0.9, 1.1, 0.9], [1.2, 1.2, 1.3, 1.1, 1.2]
    events = [*cycles(L, 0.0, [*left, 5.0]), *cycles(R, 0.5, [*right, 5.0])]
    # means 1.0 and 1.2; variances (0 + 4 * 0.01) / 4 = 0.01 and (2 * 0.01) / 4 = 0.005
    one = variability(events, "stride_time")
    assert one is not None and one.strides == 10
    # root of (0.01 + 0.005) / 2, over 1.1
    assert one.value == pytest.approx(sqrt(0.0075) / 1.1)
    foot = variability(events, "stride_time", L)
    assert foot is not None and (foot.value, foot.strides) == pytest.approx((0.1, 5))
    # 2 * (1.2 - 1.0) / 2.2
    index = asymmetry(events, "stride_time")
    assert index is not None and index.value == pytest.approx(0.4 / 2.2)
    # autocorrelations: left -0.03 / 4 / (0.04 / 5), right -0.01 / 4 / (0.02 / 5): below zero, they count as 0
    # slope 4 / 2.2^2 = 0.826446; variance = (0.826446 * 1.2)^2 * 0.01 / 5 + (0.826446 * 1.0)^2 * 0.005 / 5
    #   = 0.001967078 + 0.000683013 = 0.002650092, root 0.0514790
    # degrees of freedom (Welch) = 0.002650092^2 / (0.001967078^2 / 4 + 0.000683013^2 / 4) = 6.4785; t = 2.4036
    assert index.high - index.value == pytest.approx(2.4036 * 0.0514790, rel=1e-4)
    # half width 2.4036 * 0.0514790 = 0.123738; strides for 2 percentage points: 10 * (0.123738 / 0.02)^2 = 382.8
    assert index.needed == 383


def test_only_steady_strides_of_walking_that_others_follow_count() -> None:
    walked = cycles(L, 0.0, [1.0] * 4)
    turning, run = cycle(L, 4.0, 1.0, steady=False), cycle(L, 5.0, 0.7, stance_time=0.2)
    after_a_pause = cycles(L, 9.0, [1.0, 1.0])
    assert steady_strides([*walked, turning, run, *after_a_pause]) == [*walked, after_a_pause[0]]


def test_with_too_few_strides_or_without_values_there_is_none() -> None:
    four = [*cycles(L, 0.0, [1.0, 1.1, 0.9, 1.0])]
    assert variability(four, "stride_time") is None  # three of them have a stride after them
    assert asymmetry(cycles(L, 0.0, [1.0, 1.1] * 9), "stride_time") is None
    assert variability(cycles(L, 0.0, [1.0, 1.1] * 9, None), "stride_length") is None
    assert variability(cycles(L, 0.0, [1.0] * 9), "stride_time") is None  # no variation at all
    flights: list[Event] = [cycle(f, float(k), 1.0, initial_double_support=-0.05) for f in Foot for k in range(9)]
    assert asymmetry(flights, "initial_double_support") is None


def _strides(rng: Random, foot: Foot, count: int, correlation: float, mean: float, sd: float) -> list[Event]:
    """Return strides whose speeds are an autoregressive process of order 1."""
    found: list[Event] = []
    state = rng.gauss(0.0, 1.0)
    for k in range(count + 1):
        found.append(cycle(foot, float(k), 1.0, speed=mean + sd * state))
        state = correlation * state + sqrt(1.0 - correlation**2) * rng.gauss(0.0, 1.0)
    return found


@pytest.mark.parametrize(("count", "correlation"), [(15, 0.6), (60, 0.0)])
@pytest.mark.soak
def test_intervals_hold_the_truth_19_times_in_20(count: int, correlation: float) -> None:
    rng, walks = Random(count), 600
    held = [0, 0]
    for _ in range(walks):
        events = [*_strides(rng, L, count, correlation, 1.0, 0.03), *_strides(rng, R, count, correlation, 1.04, 0.03)]
        one, index = variability(events, "speed"), asymmetry(events, "speed")
        assert one is not None and index is not None
        held[0] += one.low <= 0.03 / 1.02 <= one.high
        held[1] += index.low <= 2.0 * 0.04 / 2.04 <= index.high
    # 95 % of 600 walks is 570, with a standard deviation of 5.3
    assert min(held) > 550, held
