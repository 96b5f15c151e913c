"""The reference foot, and the other's touchdown: equations (1) to (6) and (8) of Gong et al. 2023 by hand."""

from __future__ import annotations

import pytest
from hypothesis import strategies as st

from solepath.papers.walking_modes.compensation import epsilon_p
from solepath.papers.walking_modes.touchdown import (
    FootState,
    Height,
    NetAcceleration,
    PressureTouchdown,
    ReferenceFoot,
    displace,
    v_change,
)
from solepath.types import Foot, WalkingMode

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT


def test_while_one_foot_is_down_the_other_is_seen_from_it() -> None:
    assert v_change((0.5, 0.1, 0.2), (0.1, -0.1, 0.0), RIGHT) == pytest.approx((0.4, 0.2, 0.2))  # (1)
    assert v_change((0.5, 0.1, 0.2), (0.1, -0.1, 0.0), LEFT) == pytest.approx((-0.4, -0.2, -0.2))  # (2)


def test_the_foot_in_the_air_is_the_change_and_the_compensation_away_from_the_one_that_is_down() -> None:
    assert displace((1.0, 2.0, 0.0), (0.4, 0.2, 0.2)) == pytest.approx((1.4, 2.2, 0.2))  # (3)
    assert displace((1.0, 2.0, 0.0), (0.4, 0.2, 0.2), (0.0055, -0.0034, 0.0)) == pytest.approx((1.4055, 2.1966, 0.2))


@pytest.mark.parametrize(
    ("direction", "expected"),
    [((1.0, 0.0), (0.03, 0.02, 0.0)), ((0.0, 1.0), (-0.02, 0.03, 0.0)), ((-1.0, 0.0), (-0.03, -0.02, 0.0))],
)
def test_the_compensation_is_ahead_and_to_the_left_wherever_the_wearer_walks(
    direction: tuple[float, float], expected: tuple[float, float, float]
) -> None:
    table = {RIGHT: {WalkingMode.STRAIGHT: (0.03, 0.02)}}  # (forward, left), m; walking along y, left is -x
    assert epsilon_p(table, RIGHT, WalkingMode.STRAIGHT, direction) == pytest.approx(expected)  # epsilon_P of (8)


def test_the_lower_foot_is_down() -> None:
    method = Height()
    assert method.update(0.0, FootState(height=-0.90), FootState(height=-0.85)) == (True, False)  # (4)
    assert method.update(0.1, FootState(height=-0.85), FootState(height=-0.90)) == (False, True)


def test_two_feet_at_one_height_leave_things_as_they_are() -> None:
    method = Height()
    method.update(0.0, FootState(height=-0.90), FootState(height=-0.85))
    assert method.update(0.1, FootState(height=-0.90), FootState(height=-0.905)) == (True, False)


def test_a_foot_without_net_acceleration_for_a_while_is_down() -> None:
    method = NetAcceleration()
    flags = [method.update(0.02 * k, FootState(acceleration=a), FootState(acceleration=5.0)) for k, a in _ACCELERATIONS]
    assert flags == [(down, False) for down in (False, False, False, True, True, True, False)]  # (5)


_ACCELERATIONS = list(enumerate((9.0, 0.9, 0.5, 0.2, 0.3, 0.8, 1.0)))


def test_a_foot_is_down_when_one_cell_bears_more_than_five_newtons() -> None:
    method = PressureTouchdown()
    assert method.update(0.0, FootState(pressure=5.1), FootState(pressure=4.9)) == (True, False)  # (6)


def test_a_cell_that_flickers_about_the_threshold_is_one_touchdown() -> None:
    method, reference = PressureTouchdown(), ReferenceFoot()
    came = []
    for k, force in enumerate((0.0, 0.0, 4.0, 5.5, 4.5, 5.5, 4.0, 20.0)):
        taken = reference.update(method.update(0.01 * k, FootState(pressure=force), FootState(pressure=50.0)))
        came.append(taken)
    assert came == [(RIGHT, False), None, None, (LEFT, True), None, None, None, None]


def test_in_walking_each_foot_is_the_reference_from_its_own_touchdown_to_the_others() -> None:
    reference = ReferenceFoot()
    walk = [(True, True), (False, True), (True, True), (True, False), (True, True), (False, True)]
    assert [reference.update(flags) for flags in walk] == [
        (LEFT, False),  # both stand
        (RIGHT, False),  # the left one has left
        (LEFT, True),  # and comes down
        None,
        (RIGHT, True),
        None,
    ]


values = st.none() | st.floats(-1e6, 1e6)
