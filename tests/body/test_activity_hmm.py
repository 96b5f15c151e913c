"""The hidden Markov model that is followed online."""

from __future__ import annotations

from itertools import product
from math import exp, isclose, isfinite, log

from hypothesis import given
from hypothesis import strategies as st

from solepath.papers.footstep_tracker.activity.hmm import bayes_update, forward, scaled_likelihoods

FIRST_CHANCES = (0.6, 0.3, 0.1)
CHAIN = ((0.9, 0.05, 0.05), (0.15, 0.8, 0.05), (0.15, 0.15, 0.7))


def followed(seen: list[tuple[float, ...]]) -> tuple[float, ...]:
    """Return the probabilities after all of these log-likelihoods."""
    belief = bayes_update(FIRST_CHANCES, scaled_likelihoods(seen[0]))
    for one in seen[1:]:
        belief = forward(belief, CHAIN, scaled_likelihoods(one))
    return belief


def by_hand(seen: list[tuple[float, ...]]) -> list[float]:
    """Return the probability of each last state, summed over all courses."""
    found = [0.0] * 3
    for course in product(range(3), repeat=len(seen)):
        p = FIRST_CHANCES[course[0]]
        for before, after in zip(course, course[1:], strict=False):
            p *= CHAIN[before][after]
        for state, likely in zip(course, seen, strict=True):
            p *= exp(likely[state])
        found[course[-1]] += p
    return [p / sum(found) for p in found]


@given(st.lists(st.tuples(*[st.floats(-8.0, 0.0)] * 3), min_size=1, max_size=5))
def test_the_belief_is_that_of_all_courses_up_to_now(seen: list[tuple[float, ...]]) -> None:
    assert all(isclose(a, b, rel_tol=1e-6, abs_tol=1e-9) for a, b in zip(followed(seen), by_hand(seen), strict=True))


@given(st.lists(st.tuples(*[st.floats(allow_nan=True, allow_infinity=True)] * 3), min_size=1, max_size=20))
def test_any_input_gives_finite_probabilities(seen: list[tuple[float, ...]]) -> None:
    belief = followed(seen)
    assert isclose(sum(belief), 1.0, rel_tol=1e-9) and all(isfinite(p) and p > 0.0 for p in belief)


def test_nan_gives_no_evidence() -> None:
    assert scaled_likelihoods((float("nan"), log(0.5), 0.0)) == (1.0, 0.5, 1.0)
