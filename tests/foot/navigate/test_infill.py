"""Gaps in the samples of one foot: the stride template stands in for them."""

from __future__ import annotations

from itertools import pairwise
from math import hypot, radians

import pytest
from attrs import evolve
from one_foot import PHASES, feed_new_session, walked, without
from walks import of

from solepath import Event, Foot, FootFlat, HeelOff, HeelStrike, Sample, SampleGap, Session, StrideTaken, ToeOff
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.truth import TrueStride
from solepath.foot.gaps.straight import StraightOn

GENTLE = {
    f"{degrees} degrees a stride": Route().stand(2.0).walk(6.0, 1.3).turn(radians(120), radius=radius).walk(4.0).stop()
    for degrees, radius in ((5, 15.5), (8, 9.7), (10, 7.8))
}
SHARP = {
    "about a corner": Route().stand(2.0).walk(6.0, 1.2).turn(radians(90), radius=0.8).walk(5.0).stop(),
    "to the right": Route().stand(2.0).walk(6.0, 1.2).turn(radians(-90), radius=1.0).walk(5.0).stop(),
}


def stride_at(strides: tuple[StrideTaken, ...] | list[StrideTaken], t: float) -> StrideTaken:
    """Return the stride that includes `t`, s."""
    (stride,) = (stride for stride in strides if stride.t_start < t <= stride.t_end)
    return stride


GAPS = [
    pytest.param(-0.10, 0.20, (ToeOff,), id="toe-off"),
    pytest.param(-0.10, 0.45, (ToeOff,), id="toe-off and swing"),
    pytest.param(0.10, 0.20, (), id="mid-swing"),
    pytest.param(0.22, 0.30, (HeelStrike,), id="heel-strike"),
    pytest.param(0.10, 0.38, (HeelStrike,), id="swing and heel-strike"),
    pytest.param(-0.06, 0.58, (ToeOff, HeelStrike), id="all of the swing"),
]
"""Start of the gap after toe-off, s, its duration, s, and the events in it."""


@pytest.mark.parametrize(("after", "duration", "hidden"), GAPS)
@pytest.mark.parametrize("number", [3, 5])
def test_events_that_a_gap_has_hidden_are_reported_in_order_with_times_in_the_gap(
    number: int, after: float, duration: float, hidden: tuple[type[Event], ...]
) -> None:
    samples, strides = walked()
    a = strides[number].t_toe_off + after
    events, _ = feed_new_session(without(samples, (a, a + duration)))
    (gap,) = of(SampleGap, events)
    end = gap.t + gap.duration
    hidden_events = [event for event in of(ToeOff | HeelStrike, events) if gap.t <= event.t <= end]
    assert tuple(type(event) for event in hidden_events) == hidden
    assert all(event.known_at >= end for event in hidden_events)
    stride = strides[number]
    for event in hidden_events:
        true = stride.t_toe_off if isinstance(event, ToeOff) else stride.t_heel_strike
        assert event.t == pytest.approx(true, abs=0.07)


@pytest.mark.parametrize(("after", "duration", "hidden"), GAPS)
def test_only_the_stride_with_a_gap_is_degraded(after: float, duration: float, hidden: tuple[type[Event], ...]) -> None:
    samples, strides = walked()
    a = strides[4].t_toe_off + after
    events, _ = feed_new_session(without(samples, (a, a + duration)))
    taken = of(StrideTaken, events)
    assert len(taken) == len(strides)
    assert [stride for stride in taken if stride.degraded] == [stride_at(taken, a + 0.5 * duration)]
    assert stride_at(taken, a + 0.5 * duration).length == pytest.approx(strides[4].length, rel=0.08)


@pytest.mark.parametrize(
    "duration", [0.05, 0.3, 0.9, *(pytest.param(one, marks=pytest.mark.soak) for one in (0.12, 0.5, 0.7, 1.2, 2.0))]
)
def test_every_stride_that_a_gap_touches_is_degraded(duration: float) -> None:
    samples, strides = walked()
    hidden_events = set[float]()
    before = strides[4].t_start - 0.03
    saved = feed_new_session([sample for sample in samples if sample.t < before])[1].pack()
    for k in range(27):  # all of a stride
        a = strides[4].t_start - 0.02 + 0.04 * k
        rest = [sample for sample in without(samples, (a, a + duration)) if before <= sample.t < a + duration + 2.5]
        events = Session.unpack(saved).feed(rest)
        (gap,) = of(SampleGap, events)
        for stride in of(StrideTaken, events):
            within = min(gap.t + gap.duration, stride.t_end) - max(gap.t, stride.t_start)
            assert stride.degraded or within <= 0.0101
            assert not stride.degraded or within > -0.1  # the longest time by which a cue looks back
            hidden_events.add(stride.degraded)
    assert hidden_events == {False, True}


def test_a_saturated_sample_degrades_its_stride_even_when_foot_flat_is_dated_back() -> None:
    samples, strides = walked()
    strides_without_gap = of(StrideTaken, feed_new_session(samples)[0])
    for k in range(12):
        t = strides[4].t_end - 0.03 + 0.01 * k
        events, _ = feed_new_session([evolve(sample, saturated=abs(sample.t - t) < 0.005) for sample in samples])
        taken = of(StrideTaken, events)
        assert len(taken) == len(strides_without_gap)
        (hit,) = (sample.t for sample in samples if abs(sample.t - t) < 0.005)
        assert all(stride.degraded for stride in taken if stride.t_start < hit < stride.t_end)


def test_a_foot_that_stands_through_a_gap_goes_nowhere() -> None:
    samples, strides = walked()
    last = strides[-1].t_end
    straight, strides_without_gap = feed_new_session(samples)
    # who has stood for longer than between two strides has halted, and takes none in a long gap either
    for a, b in ((0.8, 1.4), (last + 0.2, last + 0.5), (last + 0.8, last + 1.8)):
        events, session = feed_new_session(without(samples, (a, b)))
        assert of(SampleGap, events)
        assert len(of(StrideTaken, events)) == len(of(StrideTaken, straight)) == len(strides)
        swings = [type(event) for event in of(ToeOff | HeelStrike, straight)]
        assert [type(event) for event in of(ToeOff | HeelStrike, events)] == swings
        here, there = session.feet[Foot.LEFT].position, strides_without_gap.feet[Foot.LEFT].position
        assert hypot(here[0] - there[0], here[1] - there[1]) < 0.02


@pytest.mark.parametrize("duration", [1.1, 2.0, 3.0])
def test_a_gap_over_whole_strides_adds_no_strides(duration: float) -> None:
    samples, strides = walked()
    a = strides[3].t_toe_off
    events, _ = feed_new_session(without(samples, (a, a + duration)))
    assert len(strides) - 3 <= len(of(StrideTaken, events)) <= len(strides)
    (gap,) = of(SampleGap, events)
    assert len([stride for stride in of(StrideTaken, events) if gap.t < stride.t < gap.t + gap.duration]) <= 2


def test_a_gap_is_neither_stillness_nor_speed() -> None:
    """Both must last for some time, and a gap does not count for it."""
    samples, strides = walked()
    for number in range(2, len(strides) - 1):
        for share in (0.05, 0.3, 0.5, 0.7, 0.9):
            a = strides[number].t_start + share * (strides[number].t_end - strides[number].t_start)
            events, _ = feed_new_session(without(samples, (a, a + 0.12)))
            assert len(of(ToeOff, events)) == len(of(HeelStrike, events)) == len(strides)
            assert len(of(HeelOff, events)) == len(of(FootFlat, events)) == len(strides)


def test_only_phases_without_samples_are_inferred() -> None:
    samples, strides = walked()
    hidden = set[type[Event]]()
    for k in range(27):
        a = strides[4].t_start - 0.02 + 0.04 * k
        for duration in (0.3, 0.8):
            events, _ = feed_new_session(without(samples, (a, a + duration)))
            (gap,) = of(SampleGap, events)
            end = gap.t + gap.duration
            for event in of(PHASES, events):
                if event.inferred:
                    assert gap.t <= event.t <= end and event.known_at >= end
                    hidden.add(type(event))
                # a cue may look back into a gap, but not over half of it
                assert event.inferred or not gap.t + 0.01 < event.t < end - 0.16
    assert hidden == {HeelStrike, FootFlat, HeelOff, ToeOff}
    assert not any(event.inferred for event in of(PHASES, feed_new_session(samples)[0]))


def turned(events: list[Event]) -> float:
    """Return the sum of the heading changes of all strides, rad."""
    return float(sum(stride.heading_change for stride in of(StrideTaken, events)))


def gapped(samples: tuple[Sample, ...], strides: tuple[TrueStride, ...], duration: float, every: int) -> list[Sample]:
    """Return the samples with a gap in each `every`-th swing from the fourth on, each in another part of it."""
    gaps = []
    for k, stride in enumerate(strides):
        if k >= 3 and k % every == 0:
            a = stride.t_toe_off + 0.08 * (k // every % 4)
            gaps.append((a, a + duration))
    return without(samples, *gaps)


@pytest.mark.parametrize("name", GENTLE)
@pytest.mark.parametrize(("duration", "within"), [(0.12, 15.0), (0.3, 20.0)])
def test_a_gentle_turn_stays_a_turn_through_a_gap_in_every_other_stride(
    name: str, duration: float, within: float
) -> None:
    samples, strides = walked(GENTLE[name])
    events, _ = feed_new_session(gapped(samples, strides, duration, 2))
    assert len(of(SampleGap, events)) >= 7
    assert turned(events) == pytest.approx(radians(120), abs=radians(within))


@pytest.mark.parametrize("name", SHARP)
@pytest.mark.parametrize(("duration", "within"), [(0.08, 10.0), (0.12, 10.0), (0.3, 20.0)])
def test_a_sharp_turn_is_hardly_straightened_by_gaps(name: str, duration: float, within: float) -> None:
    samples, strides = walked(SHARP[name])
    events, _ = feed_new_session(gapped(samples, strides, duration, 2))
    assert of(SampleGap, events)
    assert abs(turned(events)) == pytest.approx(
        abs(sum(stride.heading_change for stride in strides)), abs=radians(within)
    )


@pytest.mark.parametrize("seed", [6, 7])
def test_a_turn_on_the_spot_is_no_straight_walk_in_a_short_gap(seed: int) -> None:
    """No part of the last stride is like it, so a straight line is the better estimate."""
    route = Route().stand(2.0).walk(5.0, 1.2).stop(1.0).turn(radians(180)).walk(5.0).stop()
    samples, strides = walked(route, seed)
    events, _ = feed_new_session(gapped(samples, strides, 0.12, 2))
    assert of(SampleGap, events)
    assert turned(events) == pytest.approx(sum(stride.heading_change for stride in strides), abs=radians(8))


def test_a_turn_without_a_gap_is_not_repaired_with_that_of_a_gap() -> None:
    straight_on = StraightOn()
    for _ in range(3):
        straight_on.add_footfall(0.0, 0.0, 0.0, 0.0)
    assert straight_on.repair(0.09, 1.0, 0.0) < -0.05
    straight_on.add_footfall(0.09, 0.0, 0.0, 0.0)
    assert straight_on.repair(0.09, 1.0, 0.0) == 0.0


def test_a_straight_walk_keeps_its_heading_with_a_gap_in_every_stride() -> None:
    samples, strides = walked()
    events, _ = feed_new_session(gapped(samples, strides, 0.3, 1))
    assert len(of(SampleGap, events)) > 4
    assert turned(events) == pytest.approx(0.0, abs=radians(4))


def test_the_larger_the_turn_of_a_footfall_the_less_of_it_is_repaired() -> None:
    straight_on = StraightOn()
    for _ in range(3):
        assert straight_on.repair(0.1, 1.0, 0.0) == 0.0  # the heading of this wearer is unknown
        straight_on.add_footfall(0.0, 0.0, 0.0, 0.0)
    repaired_shares = [-straight_on.repair(turn, 1.0, 0.0) / turn for turn in (0.02, 0.1, 0.2, 0.4, 0.8)]
    assert repaired_shares[0] > 0.8
    assert all(a > b for a, b in pairwise(repaired_shares))
    assert repaired_shares[-1] < 0.01
    assert straight_on.repair(0.1, 0.0, 0.0) == 0.0
