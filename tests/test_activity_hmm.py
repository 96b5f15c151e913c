"""The hidden Markov model that is followed online."""

from __future__ import annotations

from itertools import product
from math import exp, isclose, isfinite, log

from hypothesis import given
from hypothesis import strategies as st

from solepath import machine
from solepath.body.activity.hmm import ForwardFilter, spread, staying

BEGIN = (0.6, 0.3, 0.1)
CHAIN = staying((0.9, 0.8, 0.7), ((0.0, 1.0, 1.0), (2.0, 0.0, 1.0), (1.0, 1.0, 0.0)))
likelihoods = st.lists(st.tuples(*[st.floats(-8.0, 0.0)] * 3), min_size=1, max_size=5)


def by_hand(seen: list[tuple[float, ...]], at: int) -> list[float]:
    """Probability of each state at step `at`, summed over all courses."""
    found = [0.0] * 3
    for course in product(range(3), repeat=len(seen)):
        p = BEGIN[course[0]]
        for before, after in zip(course, course[1:], strict=False):
            p *= CHAIN[before][after]
        for state, likely in zip(course, seen, strict=True):
            p *= exp(likely[state])
        found[course[at]] += p
    return [p / sum(found) for p in found]


@given(likelihoods)
def test_the_belief_is_that_of_all_courses_up_to_now(seen: list[tuple[float, ...]]) -> None:
    chain = ForwardFilter(BEGIN, CHAIN)
    for one in seen:
        belief = chain.update(one)
    assert all(isclose(a, b, rel_tol=1e-6, abs_tol=1e-9) for a, b in zip(belief, by_hand(seen, -1), strict=True))


@given(likelihoods)
def test_with_a_lag_it_is_that_of_all_courses_through_an_earlier_state(seen: list[tuple[float, ...]]) -> None:
    chain = ForwardFilter(BEGIN, CHAIN, lag=2)
    for one in seen:
        chain.update(one)
    if len(seen) <= 2:
        assert chain.settled is None
    else:
        settled = chain.settled
        assert settled is not None
        assert all(isclose(a, b, rel_tol=1e-6, abs_tol=1e-9) for a, b in zip(settled, by_hand(seen, -3), strict=True))


@given(st.lists(st.tuples(*[st.floats(allow_nan=True, allow_infinity=True)] * 3), max_size=20))
def test_whatever_it_is_told_it_believes_in_numbers(seen: list[tuple[float, ...]]) -> None:
    chain = ForwardFilter(BEGIN, CHAIN, lag=3)
    for one in seen:
        belief = chain.update(one)
        assert isclose(sum(belief), 1.0, rel_tol=1e-9) and all(isfinite(p) and p > 0.0 for p in belief)
    assert machine.load(ForwardFilter, machine.save(chain)) == chain


def test_rows_of_transitions_add_up_to_one_and_keep_what_was_asked() -> None:
    assert all(isclose(sum(row), 1.0) for row in CHAIN)
    assert [row[i] for i, row in enumerate(CHAIN)] == [0.9, 0.8, 0.7]
    assert isclose(CHAIN[1][0], 2.0 * CHAIN[1][2])


def test_what_is_no_number_says_nothing() -> None:
    assert spread((float("nan"), log(0.5), 0.0)) == (1.0, 0.5, 1.0)
