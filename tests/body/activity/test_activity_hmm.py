"""The hidden Markov model that is followed online."""

from __future__ import annotations

from itertools import product
from math import exp, isclose

from hypothesis import given
from hypothesis import strategies as st

from solepath.papers.footstep_tracker.activity.hmm import bayes_update, forward, scaled_likelihoods

FIRST_CHANCES = (0.6, 0.3, 0.1)
CHAIN = ((0.9, 0.05, 0.05), (0.15, 0.8, 0.05), (0.15, 0.15, 0.7))


def probabilities_of(log_likelihoods: list[tuple[float, ...]]) -> tuple[float, ...]:
    """Return the probabilities after all of these log-likelihoods."""
    belief = bayes_update(FIRST_CHANCES, scaled_likelihoods(log_likelihoods[0]))
    for one in log_likelihoods[1:]:
        belief = forward(belief, CHAIN, scaled_likelihoods(one))
    return belief


def sum_over_courses(log_likelihoods: list[tuple[float, ...]]) -> list[float]:
    """Return the probability of each last state, summed over all courses."""
    probabilities = [0.0] * 3
    for course in product(range(3), repeat=len(log_likelihoods)):
        p = FIRST_CHANCES[course[0]]
        for before, after in zip(course, course[1:], strict=False):
            p *= CHAIN[before][after]
        for state, likely in zip(course, log_likelihoods, strict=True):
            p *= exp(likely[state])
        probabilities[course[-1]] += p
    return [p / sum(probabilities) for p in probabilities]


@given(st.lists(st.tuples(*[st.floats(-8.0, 0.0)] * 3), min_size=1, max_size=5))
def test_the_belief_is_that_of_all_courses_up_to_now(log_likelihoods: list[tuple[float, ...]]) -> None:
    assert all(
        isclose(a, b, rel_tol=1e-6, abs_tol=1e-9)
        for a, b in zip(probabilities_of(log_likelihoods), sum_over_courses(log_likelihoods), strict=True)
    )
