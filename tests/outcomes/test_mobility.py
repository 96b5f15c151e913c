"""Mobility outcomes of bouts made by hand are those that were worked out by hand, as in the comments."""

from __future__ import annotations

import pytest
from attrs import asdict

from solepath.show.outcomes import WalkingBout, implausible, mobility_outcomes


def bout(number: int, duration: float, speed: float | None, length: float | None, **other: float) -> WalkingBout:
    """Return a bout of this duration, s, speed, m/s, and stride length, m, 100 s after the one before."""
    fields = {"cadence": 100.0, "stride_duration": 1.2, "steps": 20, "turns": 1, "strides": 18, "degraded": 0} | other
    start = 100.0 * number
    return WalkingBout(
        number=number, t_start=start, t_end=start + duration, walking_speed=speed, stride_length=length, **fields
    )  # type: ignore[arg-type]


BOUTS = [
    bout(1, 8.0, 0.8, 1.0, steps=10, turns=0),
    bout(2, 10.0, 0.9, 1.1, steps=14),
    bout(3, 20.0, 1.0, 1.2, steps=30),
    bout(4, 30.0, 1.1, 1.3, steps=50),
    bout(5, 40.0, 1.2, 1.4, cadence=110.0, stride_duration=1.1, steps=70, turns=2),
    bout(6, 92.0, 1.3, 1.5, cadence=120.0, stride_duration=1.0, steps=180, turns=3),
]


def test_outcomes_are_those_worked_by_hand() -> None:
    outcomes = mobility_outcomes(BOUTS)
    # 8 + 10 + 20 + 30 + 40 + 92 = 200 s; 10 + 14 + 30 + 50 + 70 + 180 = 354; 0 + 1 + 1 + 1 + 2 + 3 = 8
    assert (outcomes.walkdur_all_sum, outcomes.wbsteps_all_sum, outcomes.turns_all_sum) == (200.0, 354, 8)
    # more than 10 s: 20, 30, 40, 92; of them up to 30 s: 20, 30; more than 30 s: 40, 92; more than 60 s: 92
    assert (outcomes.wb_all_sum, outcomes.wb_10_sum, outcomes.wb_1030_sum) == (6, 4, 2)
    assert (outcomes.wb_30_sum, outcomes.wb_60_sum) == (2, 1)
    # the median is (20 + 30) / 2; the 90th percentile is at 0.9 * 5 = 4.5 of 0..5: 40 + 0.5 * (92 - 40) = 66
    assert (outcomes.wbdur_all_avg, outcomes.wbdur_all_p90) == pytest.approx((25.0, 66.0))
    # mean 33.3333; squares of deviations: 641.78 + 544.44 + 177.78 + 11.11 + 44.44 + 3441.78 = 4861.33;
    # / 5 = 972.27, whose root is 31.1812; / 33.3333 = 0.935436
    assert outcomes.wbdur_all_var == pytest.approx(0.935436, abs=1e-6)
    # (4 * 100 + 110 + 120) / 6 = 105; deviations 5, 5, 5, 5, 5, 15: 350 / 5 = 70, root 8.3666; / 105 = 0.0796819
    assert outcomes.cadence_all_avg == pytest.approx(105.0)
    assert outcomes.cadence_all_var == pytest.approx(0.0796819, abs=1e-7)
    # (4 * 1.2 + 1.1 + 1.0) / 6 = 1.15; squares: 4 * 0.0025 + 0.0025 + 0.0225 = 0.035; / 5, root 0.0836660; / 1.15
    assert (outcomes.strdur_all_avg, outcomes.strdur_all_var) == pytest.approx((1.15, 0.0727530), abs=1e-6)
    # 20 and 30 s: (1.0 + 1.1) / 2 and (1.2 + 1.3) / 2
    assert (outcomes.ws_1030_avg, outcomes.strlen_1030_avg) == pytest.approx((1.05, 1.25))
    # speeds 1.0, 1.1, 1.2, 1.3: at 0.9 * 3 = 2.7: 1.2 + 0.7 * 0.1
    assert outcomes.ws_10_p90 == pytest.approx(1.27)
    # 40 and 92 s: means; the 90th percentile is at 0.9; the standard deviation of two is their difference / root of 2
    assert (outcomes.ws_30_avg, outcomes.ws_30_p90) == pytest.approx((1.25, 1.29))
    assert (outcomes.ws_30_var, outcomes.strlen_30_var) == pytest.approx((0.0707107 / 1.25, 0.0707107 / 1.45), abs=1e-6)
    assert (outcomes.strlen_30_avg, outcomes.strdur_30_avg) == pytest.approx((1.45, 1.05))
    assert (outcomes.cadence_30_avg, outcomes.cadence_30_p90) == pytest.approx((115.0, 119.0))


def test_a_mean_out_of_its_limits_does_not_count_and_takes_the_speed_with_it() -> None:
    # 2.3 m is more than 2.19 m: length and speed of the bout are left out, its cadence and duration stay
    long = bout(7, 50.0, 2.0, 2.3, cadence=104.0)
    assert implausible(long) == ("stride_length",)
    outcomes = mobility_outcomes([*BOUTS, long])
    assert (outcomes.wb_30_sum, outcomes.ws_30_avg, outcomes.strlen_30_avg) == pytest.approx((3, 1.25, 1.45))
    # (110 + 120 + 104) / 3 = 111.3333
    assert outcomes.cadence_30_avg == pytest.approx(111.333333)
    # 39 steps a minute are fewer than 40: cadence and speed are left out, the length stays: (1.4 + 1.5 + 1.0) / 3 = 1.3
    slow = bout(8, 50.0, 0.325, 1.0, cadence=39.0, stride_duration=2.9)
    assert implausible(slow) == ("cadence",)
    outcomes = mobility_outcomes([*BOUTS, slow])
    assert (outcomes.ws_30_avg, outcomes.cadence_30_avg, outcomes.strlen_30_avg) == pytest.approx((1.25, 115.0, 1.3))
    # limits are included
    assert implausible(bout(9, 50.0, 2.22, 2.19, cadence=172.9, stride_duration=0.46)) == ()
    # own limits
    assert implausible(bout(9, 50.0, 1.0, 1.0), {"walking_speed": (1.1, 2.0)}) == ("walking_speed",)


def test_without_bouts_and_without_lengths_there_is_nothing_to_average() -> None:
    nothing = mobility_outcomes([])
    assert {value for value in asdict(nothing).values()} == {0, None}
    unknown = mobility_outcomes([bout(1, 40.0, None, None)])
    assert (unknown.ws_30_avg, unknown.strlen_30_avg, unknown.cadence_30_avg) == (None, None, 100.0)
    assert (unknown.wbdur_all_p90, unknown.wbdur_all_var) == (40.0, None)
