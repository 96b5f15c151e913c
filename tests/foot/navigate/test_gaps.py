"""Infill of gaps: stride template, straight line before there is one, and limits of both."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import hypot, radians
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
from solepath.foot.gaps.gap import NoInfill, find_infill
from solepath.foot.gaps.moment import MOMENT, correction_distance, unpack_moments
from solepath.foot.gaps.template import LARGEST_TEMPLATE_AGE, MOST_MOMENTS, StrideTemplate
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.tracker import FootTracker
from solepath.saving import codec
from solepath.types import Quat, Vec3
from solepath.types.vector import GRAVITY, IDENTITY, ZERO


def test_without_a_template_a_moving_foot_gets_no_infill_and_a_still_one_has_stood() -> None:
    template, at_rest = StrideTemplate(), ErrorStateFilter()
    at_rest.start(IDENTITY, 0.02)
    up: Vec3 = (0.0, 0.0, GRAVITY)
    assert find_infill(template, at_rest, 1.0, 1.2, up, ZERO) is NoInfill.STOOD
    assert find_infill(template, at_rest, 1.0, 1.2, up, (0.0, 4.0, 0.0)) is NoInfill.UNKNOWN
    template.start_stride(0.9)
    assert find_infill(template, at_rest, 1.0, 1.2, up, ZERO) is NoInfill.UNKNOWN


def test_a_gap_in_the_first_stride_is_bridged_by_a_straight_line() -> None:
    samples, strides = walked()
    a = strides[0].t_toe_off + 0.1
    tracker = FootTracker(Foot.LEFT, Session().recipe.detector, ErrorStateFilter())
    before = [sample for sample in samples if sample.t <= a]
    after = next(sample for sample in samples if sample.t >= a + 0.1)
    for sample in before:
        tracker.feed(sample)
    bridged_corrector = codec.load(ErrorStateFilter, codec.save(tracker.corrector))
    dt = after.t - before[-1].t
    assert bridged_corrector.bridge(dt) == dt
    acc, gyro = after.acc, after.gyro
    assert acc is not None and gyro is not None
    x, y, z = acc
    bx, by, bz = tracker.rest.bias
    k = tracker.rest.scale
    bridged_corrector.predict(dt, (x * k, y * k, z * k), (gyro[0] - bx, gyro[1] - by, gyro[2] - bz))
    tracker.feed(after)
    assert tracker.gait.template.last_stride is None
    assert tracker.corrector.position == bridged_corrector.position
    assert tracker.corrector.attitude == bridged_corrector.attitude


def test_a_stride_is_stored_exactly_at_any_time_and_position() -> None:
    template, distance = StrideTemplate(), 1e7
    template.start_stride(1e9)
    for k in range(8):
        t = 0.032 * k
        velocity, position = (1.0, 0.1 * k, 0.0), (distance + t, -distance, 0.0)
        template.add_moment(1e9 + t, IDENTITY, velocity, position, (0.0, 3.0, 4.0), (0.0, -5.0, 0.25))
    rows = unpack_moments(template.moments)
    assert [one.since for one in rows] == pytest.approx([0.032 * k for k in range(8)], abs=1e-6)
    assert rows[7].velocity == pytest.approx((1.0, 0.7, 0.0))
    assert rows[7].position == pytest.approx((0.224, 0.0, 0.0), abs=1e-7)
    assert rows[7].rate == (0.0, -5.0, 0.25) and rows[7].force == 5.0 and rows[7].attitude == IDENTITY
    assert correction_distance(template.moments) == pytest.approx(
        0.35 * 0.224, abs=1e-6
    )  # the velocity to the left did not move the foot
    template.add_moment(1e9 + 1.0, IDENTITY, (1e300, 0.0, 0.0), (distance, distance, 0.0), (0.0, 3.0, 4.0), ZERO)
    assert template.moments == b"" and template.t_heel_off is None


def test_a_toe_off_or_heel_strike_at_a_stored_moment_has_the_time_of_that_moment() -> None:
    """At 10 samples a second this is common, and rounding must not decide whether a gap has hidden them."""
    for start in range(100):
        template, t_heel_off = StrideTemplate(), 0.1 * start
        template.start_stride(t_heel_off)
        times = [t_heel_off + 0.1 * k for k in range(10)]
        for t in times:
            template.add_moment(t, IDENTITY, ZERO, ZERO, (0.0, 0.0, GRAVITY), ZERO)
        template.end_stride(t_heel_off + 1.0, times[2], times[7], 0.0, ZERO, 0.1)
        assert template.last_stride is not None
        stored = unpack_moments(template.last_stride.moments)
        assert (stored[2].since, stored[7].since) == (template.last_stride.toe_off, template.last_stride.heel_strike)


def test_a_stride_with_a_gap_or_round_a_corner_is_no_template() -> None:
    motion: tuple[Quat, Vec3, Vec3] = (IDENTITY, ZERO, ZERO)
    up: Vec3 = (0.0, 0.0, GRAVITY)

    def stride(template: StrideTemplate, t: float, turn: float, duration: float = 0.7, unseen: float = 0.0) -> None:
        template.start_stride(t)
        for k in range(int(duration / 0.01)):
            if t + 0.01 * k >= template.t_next_moment:
                template.add_moment(t + 0.01 * k, *motion, up, ZERO)
        if unseen:
            template.add_infill(t, unseen)
        template.end_stride(t + duration, t + 0.2, t + 0.6, turn, (1.3, 0.0, 0.0), 0.01)

    template = StrideTemplate()
    stride(template, 1.0, 0.0)
    stored = template.last_stride
    assert stored is not None and stored.duration < 0.7
    assert (stored.toe_off, stored.heel_strike) == pytest.approx((0.2, 0.6))
    stride(template, 2.0, 0.0, unseen=0.2)
    assert template.last_stride is stored
    stride(template, 3.0, 0.5)
    assert template.last_stride is stored
    for k in range(LARGEST_TEMPLATE_AGE):
        stride(template, 4.0 + k, 0.5)
    assert template.last_stride is not stored  # after many turns a turn becomes the template
    stride(template, 40.0, 0.0, duration=3.0)  # too slow to be stored as a whole, and memory is bounded
    assert len(template.moments) <= MOST_MOMENTS * MOMENT.size


def test_a_stride_with_a_large_zero_velocity_correction_is_no_template() -> None:
    template, up = StrideTemplate(), (0.0, 0.0, GRAVITY)

    def stride(t: float, speed: float) -> None:
        template.start_stride(t)
        for k in range(20):
            template.add_moment(t + 0.035 * k, IDENTITY, (speed, 0.0, 0.0), (2.0 * 0.035 * k, 0.0, 0.0), up, ZERO)
        template.end_stride(t + 0.7, t + 0.2, t + 0.6, 0.0, (1.33, 0.0, 0.0), 0.01)

    stride(1.0, -5.0)
    assert template.last_stride is None
    stride(2.0, 2.0)
    assert template.last_stride is not None


@pytest.mark.parametrize("displacement", [(3.3, 0.0, 0.0), (1.3, 0.0, 1.18), (1.3, 0.5, -1.18), (-40.0, 9.0, 7.0)])
@pytest.mark.parametrize("filled", [True, False])
def test_a_stride_with_a_gap_goes_hardly_further_than_those_before_and_no_higher_than_two_stairs(
    displacement: Vec3, filled: bool
) -> None:
    template, up = StrideTemplate(), (0.0, 0.0, GRAVITY)
    for n in range(2):
        template.start_stride(1.2 * n + 0.4)
        for k in range(20):
            template.add_moment(
                template.t_next_moment, IDENTITY, (2.0, 0.0, 0.0), (2.0 * 0.032 * k, 0.0, 0.0), up, ZERO
            )
        t = 1.2 * (n + 1)
        template.end_stride(t, t - 0.5, t - 0.1, 0.0, (1.3, 0.0, 0.0), 0.01)
    assert template.last_stride is not None
    template.start_stride(2.8)
    if filled:
        template.add_infill(2.8, 0.3)
    else:
        template.mark_bridged()
    repair = template.end_stride(3.6, 3.1, 3.5, 0.0, displacement, 0.01)
    assert repair is not None
    assert hypot(repair.displacement[0], repair.displacement[1]) <= 1.25 * 1.3 * 1.2
    assert abs(repair.displacement[2]) <= 0.5


@pytest.mark.parametrize("duration", [0.15, 0.3, 0.6, 1.2, 2.0])
def test_infill_limits_the_speed_of_a_foot_and_long_gaps_get_none(duration: float) -> None:
    samples, strides = walked()
    tracker = FootTracker(Foot.LEFT, Session().recipe.detector, ErrorStateFilter())
    a = strides[4].t_toe_off + 0.1
    before = [sample for sample in samples if sample.t <= a]
    for sample in before:
        tracker.feed(sample)
    after = next(sample for sample in samples if sample.t >= a + duration)
    assert after.acc is not None and after.gyro is not None
    for speed in (3.0, 60.0):
        x, y, z = tracker.corrector.position
        tracker.corrector.velocity = (speed, 0.0, -speed)
        dt = after.t - before[-1].t
        infill = find_infill(tracker.gait.template, tracker.corrector, before[-1].t, after.t, after.acc, after.gyro)
        assert (duration > 1.5) == (infill is NoInfill.UNKNOWN) or speed == 60.0
        if not isinstance(infill, NoInfill):
            u, v, w = infill.position
            assert hypot(u - x, v - y, w - z) <= 4.0 * dt + 1e-9
            assert hypot(*infill.velocity) < 9.0


@cache
def there_and_back(rate: float) -> tuple[tuple[Sample, ...], tuple[TrueStride, ...]]:
    """Return exact samples of the left foot over a minute, and its true strides."""
    walker = Walker(Route().stand(2.0).walk(30.0).turn(radians(178), radius=1.0).walk(30.0).stop(1.0))
    return tuple(walker.samples(Foot.LEFT, rate)), walker.truth().strides(Foot.LEFT)


@pytest.mark.parametrize("rate", [20.0, 100.0])
@pytest.mark.parametrize("seed", [1, 2, 3])
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
@settings(max_examples=25)
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
