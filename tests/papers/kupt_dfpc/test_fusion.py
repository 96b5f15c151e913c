"""Double-foot position calibration, against the paper's equations worked by hand."""

from __future__ import annotations

from typing import Any

import pytest
from attrs import evolve
from strides import stride

from solepath.emulate.routes.route import Route
from solepath.events import StrideFeatures, StrideFused, StrideTaken
from solepath.papers.kupt_dfpc.fusion import POINTS, DoubleFoot, correlation, own_share, resample_cop
from solepath.types import Foot

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT
CENTRE = 0.14
COP_PATH = tuple((0.09 + 0.13 * k / 15, 0.0) for k in range(16))
"""A centre of pressure that rolls evenly from the arch to the toes."""


def stride_of(
    foot: Foot,
    end: float,
    length: float = 1.3,
    *,
    index: float | None = 0.1,
    cop: tuple[tuple[float, float], ...] = COP_PATH,
    lasts: float = 1.1,
    direction: tuple[float, float] = (1.0, 0.0),
    number: int = 1,
) -> StrideTaken:
    """Return a stride that ends at `end` s, with toe-off 50 % and heel-strike 10 % of its duration before the end."""
    features = StrideFeatures(0.1, 4.0, 1.0, 400.0, cop, index)
    way, off, strike = (length * direction[0], length * direction[1], 0.0), end - 0.5 * lasts, end - 0.1 * lasts
    made = stride(foot, end, way, number=number, t_start=end - lasts, t_toe_off=off, t_heel_strike=strike)
    return evolve(made, covariance=(1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4), features=features)


def walked(*steps: StrideTaken) -> tuple[DoubleFoot, list[StrideFused]]:
    body = DoubleFoot()
    return body, [body.add_stride(one, CENTRE) for one in steps]


def test_similarity_is_the_correlation_of_equation_9_worked_by_hand() -> None:
    # x - mean: -1.5 -0.5 0.5 1.5; y - mean: -0.5 -1.5 1.5 0.5; sum of products 3, sums of squares 5 and 5
    assert correlation((1.0, 2.0, 3.0, 4.0), (2.0, 1.0, 4.0, 3.0)) == pytest.approx(3.0 / 5.0)


def test_a_step_that_rolls_the_other_way_is_as_similar_since_9_takes_the_absolute_value() -> None:
    assert correlation((1.0, 2.0, 3.0, 4.0), (-2.0, -1.0, -4.0, -3.0)) == pytest.approx(3.0 / 5.0)
    assert correlation((1.0, 2.0, 3.0), (6.0, 4.0, 2.0)) == pytest.approx(1.0)


def test_the_centre_of_pressure_stays_at_the_foot_centre_while_the_foot_is_in_the_air() -> None:
    found = resample_cop(stride_of(LEFT, 10.0), CENTRE)  # 50 % on the ground, 40 % in the air, 10 % loading, left out
    ground = round(POINTS * 5 / 9)
    assert set(found[ground + 1 :]) == {CENTRE}
    assert list(found[:ground]) == sorted(found[:ground])
    assert 0.09 <= found[0] < found[ground - 1] <= 0.22


def test_the_coefficient_is_equation_11_worked_by_hand() -> None:
    # EI_R = 0.2, EI_L = 0.1, r_L = 0.8: (0.2 / 0.8) / (0.2 / 0.8 + 0.1) = 0.25 / 0.35
    assert own_share(0.8, 0.1, 0.2) == pytest.approx(0.25 / 0.35)


def test_the_worse_of_two_similar_steps_gets_less_than_half_of_the_weight() -> None:
    assert own_share(1.0, 0.3, 0.1) == pytest.approx(0.25)
    assert own_share(1.0, 0.1, 0.3) == pytest.approx(0.75)


def test_a_step_that_is_not_similar_keeps_its_own_length() -> None:
    assert own_share(0.0, 0.1, 0.1) == 1.0
    assert own_share(1e-9, 0.1, 0.1) == pytest.approx(1.0)
    assert own_share(None, 0.1, 0.1) == 1.0


def test_two_steps_without_error_share_as_two_of_equal_error_do() -> None:
    assert own_share(0.8, 0.0, 0.0) == own_share(0.8, 0.5, 0.5) == pytest.approx(1.0 / 1.8)
    assert own_share(0.0, 0.0, 0.0) == 1.0
    assert own_share(0.8, 0.3, 0.0) == 0.0
    assert own_share(0.8, 0.0, 0.3) == 1.0


def test_the_calibrated_stride_is_equation_12_worked_by_hand() -> None:
    _, fused = walked(stride_of(LEFT, 2.0, 1.2, index=0.3), stride_of(RIGHT, 2.55, 1.4, index=0.1))
    r = fused[1].similarity
    assert r == pytest.approx(1.0)
    # Calicoef_R = 0.3 / (0.3 + 0.1) = 0.75; D = 1.4 * 0.75 + 1.2 * 0.25
    assert fused[1].coefficient == pytest.approx(0.75)
    assert fused[1].stride_length == pytest.approx(1.35)
    assert fused[1].own_length == 1.4


def test_each_step_is_calibrated_by_the_step_before_it_as_the_other_foot_measured_it() -> None:
    # fig. 9: L1 calibrates R1, R1 calibrates L2, with d and not with D
    _, fused = walked(
        stride_of(LEFT, 2.0, 1.2, index=0.1),
        stride_of(RIGHT, 2.55, 1.4, index=0.1),
        stride_of(LEFT, 3.1, 1.2, index=0.1, number=2),
    )
    assert [one.stride_length for one in fused] == pytest.approx([1.2, 1.3, 1.3])


def test_half_a_stride_is_not_similar_to_a_whole_one_as_at_both_ends_of_the_walk_of_figure_11() -> None:
    _, fused = walked(stride_of(LEFT, 2.0, 0.65, index=0.1), stride_of(RIGHT, 2.55, 1.3, index=0.1))
    assert (fused[1].similarity, fused[1].coefficient, fused[1].stride_length) == (0.0, 1.0, 1.3)


def test_a_stride_without_an_error_index_counts_for_neither_foot_in_equation_13() -> None:
    body, fused = walked(stride_of(LEFT, 2.0, index=None), stride_of(RIGHT, 2.55, index=0.1))
    assert body.error_balance == 0.0 and fused[1].coefficient == 1.0


def test_the_choice_of_the_foot_is_the_sign_of_equation_13_worked_by_hand() -> None:
    pairs = [(0.3, 0.1, 1.1, 1.4), (0.1, 0.2, 1.2, 1.2), (0.1, 0.5, 1.2, 1.2)]
    body, expected, chosen = DoubleFoot(), 0.0, set[Foot]()
    for k, (left, right, d_left, d_right) in enumerate(pairs):
        t = 2.0 + 1.1 * k
        a = body.add_stride(stride_of(LEFT, t, d_left, index=left, number=k + 1), CENTRE)
        b = body.add_stride(stride_of(RIGHT, t + 0.55, d_right, index=right, number=k + 1), CENTRE)
        expected += (left - right) * 0.5 * (a.stride_length + b.stride_length)
        assert body.error_balance == pytest.approx(expected)
        assert b.chosen is (RIGHT if expected > 0.0 else LEFT)
        chosen.add(b.chosen)
    assert chosen == {LEFT, RIGHT}


WALK = Route().stand(1.5).walk(14.0, 1.25).stop(1.5)


def numbers_in(value: Any) -> list[float]:
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        return [number for item in value for number in numbers_in(item)]
    return [float(value)] if isinstance(value, int | float) else []


def test_a_path_goes_where_its_strides_go_by_their_calibrated_lengths() -> None:
    ways = [(LEFT, 1.0, 1.3), (RIGHT, 1.6, 1.2), (LEFT, 2.2, 1.25), (RIGHT, 2.8, 1.3)]
    body, fused = walked(*(stride_of(foot, end, length, direction=(0.6, 0.8)) for foot, end, length in ways))
    for foot in Foot:
        walked_length = sum(one.stride_length for one in fused if one.foot is foot)
        assert body.paths[foot].end == pytest.approx((0.6 * walked_length, 0.8 * walked_length, 0.0))
