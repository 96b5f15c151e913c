"""Infill of gaps: stride template, straight line before there is one, and limits of both."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import radians
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from one_foot import PHASES, feed_new_session, walked, without
from walks import of

from solepath import Event, Foot, Sample, Session, StrideTaken
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.truth import TrueStride
from solepath.emulate.wearers.walker import Walker


@cache
def there_and_back(rate: float) -> tuple[tuple[Sample, ...], tuple[TrueStride, ...]]:
    """Return exact samples of the left foot over a minute, and its true strides."""
    walker = Walker(Route().stand(2.0).walk(30.0).turn(radians(178), radius=1.0).walk(30.0).stop(1.0))
    return tuple(walker.samples(Foot.LEFT, rate)), walker.truth().strides(Foot.LEFT)


@pytest.mark.parametrize("rate", [20.0, 100.0])
@pytest.mark.parametrize("seed", [1])
def test_however_many_gaps_there_are_no_stride_is_longer_or_higher_than_a_stride_can_be(rate: float, seed: int) -> None:
    samples, strides = there_and_back(rate)
    random, holes, t = Random(seed), list[tuple[float, float]](), 8.0
    while t < 50.0:
        holes.append((t, t + random.choice([0.1, 0.2, 0.4, 0.7, 1.0])))
        t += random.uniform(0.3, 4.0)
    events, _ = feed_new_session(without(samples, *holes))
    longest = max(stride_taken.length for stride_taken in strides)
    for stride_taken in of(StrideTaken, events):
        if stride_taken.degraded:
            assert stride_taken.length < 2.5 * longest
            assert abs(stride_taken.height_change) < 0.85


holes = st.lists(st.tuples(st.floats(1.0, 13.0), st.floats(0.02, 1.5)), min_size=1, max_size=8)


@given(holes=holes)
@settings(max_examples=10)
def test_whatever_the_gaps_phases_follow_each_other_in_time_and_none_is_known_before_it_was(
    holes: list[tuple[float, float]],
) -> None:
    samples, _ = walked()
    remaining = without(samples, *((a, a + duration) for a, duration in holes))
    session = Session()
    events: list[Event] = []
    for sample in remaining:
        new = session.feed(sample)
        assert all(event.known_at >= event.t and event.known_at >= sample.t for event in new)
        events += new
    phases = of(PHASES, events)
    assert all(a.t <= b.t for a, b in pairwise(phases))
    assert all(type(a) is not type(b) for a, b in pairwise(phases))
    taken = of(StrideTaken, events)
    assert all(a.t_end <= b.t_start for a, b in pairwise(taken))
    for stride_taken in taken:
        assert stride_taken.t_start <= stride_taken.t_toe_off <= stride_taken.t_end
        assert (
            stride_taken.t_heel_strike is None
            or stride_taken.t_toe_off <= stride_taken.t_heel_strike <= stride_taken.t_end
        )
