"""Runs of a phone that do not grow: clocks that were wrong, a number that fell over, old rows that come again."""

from __future__ import annotations

from attrs import evolve
from fleets import WEARER, shown, stepped, uses, walked
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.events import PacketRejected, Rejection, StrideTaken
from solepath.fleet import End, Fleet, NumberedEvent, NumbersMissing, Sent, SentRejected
from solepath.fleet.step.sent import MOST

FLEET, NARROW = Fleet(), Fleet(window=3)
AHEAD, NOW = 4_000_000_000_000, 1_790_000_000_000


def run(of: int, count: int, first: int = 0) -> list[Sent]:
    return [shown(number, of) for number in range(first, first + count)]


def used(told: list[NumberedEvent]) -> list[tuple[int | None, int | None]]:
    return [(of, number) for what, of, number, _ in uses(told) if what == "used"]


def test_a_phone_whose_clock_is_put_right_loses_a_window_of_rows_and_no_more() -> None:
    state, _ = FLEET.step(WEARER, None, run(AHEAD, 20))
    for again in (run(AHEAD, 20), []):
        _, told = FLEET.step(WEARER, state, [*again, *run(NOW, 400)])
        assert used(told) == [(NOW, number) for number in range(256, 400)]
        assert [one.event.count for one in told if isinstance(one.event, SentRejected)] == [2**k for k in range(9)]
        assert [one.event.count for one in told if isinstance(one.event, NumbersMissing)] == [256]
        assert [one.number for one in told] == list(range(20, 20 + len(told)))


def test_one_row_of_the_largest_run_there_is_does_not_silence_a_wearer() -> None:
    _, told = FLEET.step(WEARER, None, [*run(NOW, 20), shown(0, MOST), *run(NOW, 400, 20), *run(NOW + 1, 5)])
    there = [*range(20), *range(276, 420)]
    assert sorted(used(told)) == [*[(NOW, number) for number in there], *[(NOW + 1, k) for k in range(5)], (MOST, 0)]


def test_a_phone_whose_clock_was_ahead_for_a_hundred_restarts_is_heard_when_it_is_put_right() -> None:
    day = 86_400_000
    starts = [[NOW + day * k for k in range(100)], [AHEAD + day * k for k in range(100)], [NOW + day * 100]]
    state, told = stepped(NARROW, [run(start, 9) for some in starts for start in some])
    assert used(told)[-6:] == [(NOW + day * 100, number) for number in range(3, 9)]
    assert len(state) < 20_000


ROWS = st.builds(shown, st.integers(0, 9) | st.integers(0, MOST), st.integers(0, 3) | st.integers(0, MOST))
ENDS = st.builds(lambda number, of: Sent(WEARER, number, End(), of), st.integers(0, 9), st.integers(0, 3))


@settings(max_examples=60, deadline=None)
@given(before=st.lists(ROWS | ENDS, max_size=14), new=st.integers(0, 5) | st.integers(0, MOST))
def test_whatever_came_before_a_new_run_is_heard_but_for_a_window_of_rows(before: list[Sent], new: int) -> None:
    before = [one for one in before if one.run != new]
    _, told = NARROW.step(WEARER, None, [*before, *run(new, 20)])
    heard = [number for of, number in used(told) if of == new]
    assert len(heard) >= 17 and heard[-13:] == list(range(7, 20))


@settings(max_examples=60, deadline=None)
@given(late=st.lists(st.integers(0, 3), min_size=20, max_size=20), change=st.integers(1, 15))
def test_rows_that_the_next_run_overtakes_do_not_lead_back(late: list[int], change: int) -> None:
    ordered = [*run(0, change), *run(1, 20 - change)]
    arrived = [ordered[k] for k in sorted(range(20), key=lambda k: (k + late[k], k))]
    _, told = NARROW.step(WEARER, None, arrived)
    assert [number for of, number in used(told) if of == 1] == list(range(20 - change))
    assert not [one for one in told if isinstance(one.event, NumbersMissing) and one.event.run == 1]


def test_rows_of_all_that_was_ever_sent_come_again_and_none_is_used_twice() -> None:
    sent = [one for of in range(60) for one in run(5 * of, 9)]
    state, told = NARROW.step(WEARER, None, sent)
    assert len(used(told)) == len(sent)
    after, told = NARROW.step(WEARER, state, sent)
    assert used(told) == [] and all([isinstance(one.event, SentRejected) for one in told])
    assert len(after) < len(state) + 10


@settings(max_examples=30, deadline=None)
@given(arrived=st.lists(st.builds(shown, st.integers(0, 6), st.integers(0, 30)), max_size=200))
def test_with_any_number_of_runs_no_row_is_used_twice_and_little_is_remembered(arrived: list[Sent]) -> None:
    state, told = Fleet(window=1).step(WEARER, None, arrived)
    assert len(used(told)) == len(set(used(told)))
    assert len(Fleet(window=1).step(WEARER, state, [Sent(WEARER, 0, End(), 99)])[0]) < 500


def test_a_flood_of_rows_that_are_late_is_told_ever_more_seldom() -> None:
    state, _ = FLEET.step(WEARER, None, [*run(5, 3), shown(0, 9)])
    flood = [one for k in range(2000) for one in (shown(3 + k, 5), shown(1 + k, 9))]
    _, told = FLEET.step(WEARER, state, flood)
    assert [one.event.count for one in told if isinstance(one.event, SentRejected)] == [2**k for k in range(11)]
    assert len(used(told)) == 2000


def test_a_phone_that_goes_on_after_the_end_is_told_ever_more_seldom() -> None:
    _, told = FLEET.step(WEARER, None, [shown(0), Sent(WEARER, 1, End()), *run(0, 2000, 2)])
    assert [one.event.count for one in told[1:]] == [2**k for k in range(11)]


def test_a_phone_that_was_started_again_with_a_clock_at_nought_is_followed_after_19_packets_of_each_site() -> None:
    sent = walked().sent
    half = len(sent) // 2
    shifted = [evolve(one, what=evolve(one.what, t=one.what.t + 50_000.0)) for one in sent[:half]]
    state, _ = FLEET.step(WEARER, None, shifted)
    again = [evolve(one, number=number, run=1) for number, one in enumerate(sent[half:])]
    told = [one.event for one in FLEET.step(WEARER, state, again)[1]]
    assert [e.reason for e in told if isinstance(e, PacketRejected)].count(Rejection.TIME_BACKWARDS) == 2 * 19
    assert sum(isinstance(event, StrideTaken) for event in told) >= 2
