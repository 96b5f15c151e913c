"""Walking bouts of strides made by hand are those that were worked out by hand, as in the comments."""

from __future__ import annotations

from math import radians

import pytest
from strides import cycle, cycles

from solepath import TurnMade
from solepath.events import Event
from solepath.show.outcomes import walking_bouts
from solepath.types import Foot, Turn

L, R = Foot.LEFT, Foot.RIGHT


def turned(start: float, end: float, degrees: float) -> TurnMade:
    return TurnMade(t=end, known_at=end, t_start=start, angle=radians(degrees), turn=Turn.LEFT)


def test_two_strides_of_each_foot_are_the_shortest_bout() -> None:
    # contacts: left 10, 11, 12.2; right 10.5, 11.6, 12.6: six contacts, the "R-L-R-L-R-L" of Kluge et al. 2021
    (bout,) = walking_bouts([*cycles(L, 10.0, [1.0, 1.2], 1.1), *cycles(R, 10.5, [1.1, 1.0], 1.3)])
    assert (bout.number, bout.strides, bout.steps, bout.turns, bout.degraded) == (1, 4, 6, 0, 0)
    assert (bout.t_start, bout.t_end, bout.duration) == pytest.approx((10.0, 12.6, 2.6))
    # (1.0 + 1.2 + 1.1 + 1.0) / 4 = 1.075 s
    assert bout.stride_duration == pytest.approx(1.075)
    # (120 + 100 + 109.0909 + 120) / 4 = 112.2727 steps a minute: the mean of cadences, not 120 / 1.075 = 111.63
    assert bout.cadence == pytest.approx(112.272727)
    # (1.1 + 1.1 + 1.3 + 1.3) / 4 = 1.2 m
    assert bout.stride_length == pytest.approx(1.2)
    # (1.1 + 0.916667 + 1.181818 + 1.3) / 4 = 1.124621 m/s
    assert bout.walking_speed == pytest.approx(1.124621, abs=1e-6)


def test_three_strides_are_no_bout() -> None:
    assert walking_bouts([*cycles(L, 0.0, [1.0, 1.0]), cycle(R, 0.5, 1.0)]) == []
    assert walking_bouts([]) == []


def test_a_break_of_three_seconds_is_within_a_bout_and_a_longer_one_ends_it() -> None:
    # the last stride ends at 2.5 s (right foot); the next starts at 5.5 s, 3.0 s later, or at 5.51 s, 3.01 s later
    before = [*cycles(L, 0.0, [1.0, 1.0]), *cycles(R, 0.5, [1.0, 1.0])]
    (one,) = walking_bouts([*before, *cycles(L, 5.5, [1.0, 1.0]), *cycles(R, 6.0, [1.0, 1.0])])
    assert (one.strides, one.t_start, one.t_end) == (8, 0.0, 8.0)
    # contacts: left 0, 1, 2, 5.5, 6.5, 7.5; right 0.5, 1.5, 2.5, 6, 7, 8
    assert one.steps == 12
    two = walking_bouts([*before, *cycles(L, 5.51, [1.0, 1.0]), *cycles(R, 6.0, [1.0, 1.0])])
    assert [(bout.number, bout.t_start, bout.t_end, bout.steps) for bout in two] == [
        (1, 0.0, 2.5, 6),
        (2, 5.51, 8.0, 6),
    ]


def test_strides_that_are_too_short_long_or_small_do_not_count() -> None:
    # 0.2 s is out, 0.21 s in; 3.0 s in, 3.01 s out; 0.15 m out, 0.151 m and an unknown length in
    assert len(walking_bouts(cycles(L, 0.0, [0.21, 0.21, 0.21, 0.2]))) == 0
    assert walking_bouts(cycles(L, 0.0, [0.21, 0.21, 0.21, 0.21]))[0].strides == 4
    assert walking_bouts(cycles(L, 0.0, [3.0, 3.0, 3.0, 3.0]))[0].strides == 4
    assert walking_bouts(cycles(L, 0.0, [3.0, 3.0, 3.0, 3.01])) == []
    assert walking_bouts(cycles(L, 0.0, [1.0] * 4, 0.15)) == []
    assert walking_bouts(cycles(L, 0.0, [1.0] * 4, 0.151))[0].stride_length == pytest.approx(0.151)
    assert walking_bouts(cycles(L, 0.0, [1.0] * 4, None))[0].stride_length is None


def test_a_stride_left_out_makes_a_break_of_its_own_duration() -> None:
    # left strides end at 4 s, then a pause as one stride of 3.2 s, then on from 7.2 s: 3.2 s > 3 s
    assert [bout.t_start for bout in walking_bouts(cycles(L, 0.0, [1.0] * 4 + [3.2] + [1.0] * 4))] == [0.0, 7.2]


def test_runners_strides_belong_to_no_bout() -> None:
    # on the ground for 0.25 of 0.7 s: there is a flight, and walking always has a foot on the ground
    run = [cycle(L, 0.7 * k, 0.7, 2.0, stance_time=0.25) for k in range(8)]
    assert walking_bouts(run) == []


def test_a_bout_of_one_foot_counts_two_steps_for_each_contact() -> None:
    (bout,) = walking_bouts(cycles(R, 0.0, [1.0] * 5))
    assert (bout.strides, bout.steps) == (5, 12)


def test_turns_of_45_degrees_count_where_their_middle_is() -> None:
    walked = [*cycles(L, 10.0, [1.0] * 4), *cycles(R, 10.5, [1.0] * 4)]  # until 14.5 s
    turns: list[Event] = [turned(11.0, 12.0, 44.0), turned(12.0, 13.0, -46.0)]
    turns += [turned(13.6, 15.2, 180.0), turned(14.0, 15.2, 90.0)]
    # 44 degrees are too few; the middles are at 12.5 and 14.4 s, and at 14.6 s, after the bout
    assert walking_bouts([*turns, *walked])[0].turns == 2
