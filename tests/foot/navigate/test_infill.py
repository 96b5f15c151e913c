"""Gaps in the samples of one foot: the stride template stands in for them."""

from __future__ import annotations

from math import hypot, radians

import pytest
from one_foot import feed_new_session, walked, without
from walks import of

from solepath import Event, Foot, HeelStrike, Sample, SampleGap, StrideTaken, ToeOff
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.truth import TrueStride

GENTLE = {
    f"{degrees} degrees a stride": Route().stand(2.0).walk(6.0, 1.3).turn(radians(120), radius=radius).walk(4.0).stop()
    for degrees, radius in ((5, 15.5), (8, 9.7), (10, 7.8))
}
SHARP = {
    "about a corner": Route().stand(2.0).walk(6.0, 1.2).turn(radians(90), radius=0.8).walk(5.0).stop(),
    "to the right": Route().stand(2.0).walk(6.0, 1.2).turn(radians(-90), radius=1.0).walk(5.0).stop(),
}


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
@pytest.mark.parametrize("number", [5])
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


@pytest.mark.parametrize("duration", [1.1, 3.0])
def test_a_gap_over_whole_strides_adds_no_strides(duration: float) -> None:
    samples, strides = walked()
    a = strides[3].t_toe_off
    events, _ = feed_new_session(without(samples, (a, a + duration)))
    assert len(strides) - 3 <= len(of(StrideTaken, events)) <= len(strides)
    (gap,) = of(SampleGap, events)
    assert len([stride for stride in of(StrideTaken, events) if gap.t < stride.t < gap.t + gap.duration]) <= 2


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
@pytest.mark.parametrize(("duration", "within"), [(0.08, 10.0), (0.3, 20.0)])
def test_a_sharp_turn_is_hardly_straightened_by_gaps(name: str, duration: float, within: float) -> None:
    samples, strides = walked(SHARP[name])
    events, _ = feed_new_session(gapped(samples, strides, duration, 2))
    assert of(SampleGap, events)
    assert abs(turned(events)) == pytest.approx(
        abs(sum(stride.heading_change for stride in strides)), abs=radians(within)
    )


@pytest.mark.parametrize("seed", [6])
def test_a_turn_on_the_spot_is_no_straight_walk_in_a_short_gap(seed: int) -> None:
    """No part of the last stride is like it, so a straight line is the better estimate."""
    route = Route().stand(2.0).walk(5.0, 1.2).stop(1.0).turn(radians(180)).walk(5.0).stop()
    samples, strides = walked(route, seed)
    events, _ = feed_new_session(gapped(samples, strides, 0.12, 2))
    assert of(SampleGap, events)
    assert turned(events) == pytest.approx(sum(stride.heading_change for stride in strides), abs=radians(8))


def test_a_straight_walk_keeps_its_heading_with_a_gap_in_every_stride() -> None:
    samples, strides = walked()
    events, _ = feed_new_session(gapped(samples, strides, 0.3, 1))
    assert len(of(SampleGap, events)) > 4
    assert turned(events) == pytest.approx(0.0, abs=radians(4))
