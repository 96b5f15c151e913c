"""Gaps in the samples of one foot: what it is used to doing stands in for what nobody saw."""

from __future__ import annotations

from itertools import pairwise
from math import hypot, radians

import pytest
from attrs import evolve
from one_foot import PHASES, feed_new_session, walked, without
from walks import of

from solepath import Event, Foot, FootFlat, HeelOff, HeelStrike, Sample, SampleGap, StrideTaken, ToeOff
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.truth import TrueStep
from solepath.foot.gaps.straight import StraightOn

GENTLE = {
    f"{degrees} degrees a stride": Route().stand(2.0).walk(6.0, 1.3).turn(radians(120), radius=radius).walk(4.0).stop()
    for degrees, radius in ((5, 15.5), (8, 9.7), (10, 7.8))
}
SHARP = {
    "about a corner": Route().stand(2.0).walk(6.0, 1.2).turn(radians(90), radius=0.8).walk(5.0).stop(),
    "to the right": Route().stand(2.0).walk(6.0, 1.2).turn(radians(-90), radius=1.0).walk(5.0).stop(),
}


def around(steps: tuple[StrideTaken, ...] | list[StrideTaken], t: float) -> StrideTaken:
    """The step that was under way at `t`, s."""
    (found,) = (step for step in steps if step.t_start < t <= step.t_end)
    return found


GAPS = [
    pytest.param(-0.10, 0.20, (ToeOff,), id="toe-off"),
    pytest.param(-0.10, 0.45, (ToeOff,), id="toe-off and swing"),
    pytest.param(0.10, 0.20, (), id="mid-swing"),
    pytest.param(0.22, 0.30, (HeelStrike,), id="heel-strike"),
    pytest.param(0.10, 0.38, (HeelStrike,), id="swing and heel-strike"),
    pytest.param(-0.06, 0.58, (ToeOff, HeelStrike), id="all of the swing"),
]
"""From when after toe-off, how long, s, and what happened in between."""


@pytest.mark.parametrize(("after", "duration", "hidden"), GAPS)
@pytest.mark.parametrize("number", [3, 5])
def test_what_a_gap_in_a_swing_has_hidden_is_told_in_order_and_dated_within_the_gap(
    number: int, after: float, duration: float, hidden: tuple[type[Event], ...]
) -> None:
    samples, steps = walked()
    a = steps[number].t_toe_off + after
    told, _ = feed_new_session(without(samples, (a, a + duration)))
    (gap,) = of(SampleGap, told)
    end = gap.t + gap.duration
    seen = [event for event in of(ToeOff | HeelStrike, told) if gap.t <= event.t <= end]
    assert tuple(type(event) for event in seen) == hidden
    assert all(event.known_at >= end for event in seen)
    step = steps[number]
    for event in seen:
        true = step.t_toe_off if isinstance(event, ToeOff) else step.t_heel_strike
        assert event.t == pytest.approx(true, abs=0.07)


@pytest.mark.parametrize(("after", "duration", "hidden"), GAPS)
def test_a_stride_with_a_gap_in_it_is_degraded_whole_and_no_other_is(
    after: float, duration: float, hidden: tuple[type[Event], ...]
) -> None:
    samples, steps = walked()
    a = steps[4].t_toe_off + after
    told, _ = feed_new_session(without(samples, (a, a + duration)))
    taken = of(StrideTaken, told)
    assert len(taken) == len(steps)
    assert [step for step in taken if step.degraded] == [around(taken, a + 0.5 * duration)]
    assert around(taken, a + 0.5 * duration).length == pytest.approx(steps[4].length, rel=0.08)


@pytest.mark.parametrize("duration", [0.05, 0.12, 0.3, 0.5, 0.7, 0.9, 1.2, 2.0])
def test_every_step_that_a_gap_reaches_into_is_degraded_wherever_in_the_stride_it_lies(duration: float) -> None:
    samples, steps = walked()
    seen = set[float]()
    for k in range(27):  # all of a stride
        a = steps[4].t_start - 0.02 + 0.04 * k
        told, _ = feed_new_session(without(samples, (a, a + duration)))
        (gap,) = of(SampleGap, told)
        for step in of(StrideTaken, told):
            within = min(gap.t + gap.duration, step.t_end) - max(gap.t, step.t_start)
            assert step.degraded or within <= 0.0101
            assert not step.degraded or within > -0.1  # what a cue looks back by
            seen.add(step.degraded)
    assert seen == {False, True}


def test_a_sample_at_the_end_of_its_range_degrades_the_step_it_is_in_even_when_flat_is_dated_back() -> None:
    samples, steps = walked()
    uncut = of(StrideTaken, feed_new_session(samples)[0])
    for k in range(12):
        t = steps[4].t_end - 0.03 + 0.01 * k
        told, _ = feed_new_session([evolve(sample, saturated=abs(sample.t - t) < 0.005) for sample in samples])
        taken = of(StrideTaken, told)
        assert len(taken) == len(uncut)
        (hit,) = (sample.t for sample in samples if abs(sample.t - t) < 0.005)
        assert all(step.degraded for step in taken if step.t_start < hit < step.t_end)


def test_a_foot_that_stands_through_a_gap_goes_nowhere() -> None:
    samples, steps = walked()
    last = steps[-1].t_end
    straight, uncut = feed_new_session(samples)
    # who has stood for longer than between two strides has halted, and takes none in a long gap either
    for a, b in ((0.8, 1.4), (last + 0.2, last + 0.5), (last + 0.8, last + 1.8)):
        told, session = feed_new_session(without(samples, (a, b)))
        assert of(SampleGap, told)
        assert len(of(StrideTaken, told)) == len(of(StrideTaken, straight)) == len(steps)
        swings = [type(event) for event in of(ToeOff | HeelStrike, straight)]
        assert [type(event) for event in of(ToeOff | HeelStrike, told)] == swings
        here, there = session.feet[Foot.LEFT].position, uncut.feet[Foot.LEFT].position
        assert hypot(here[0] - there[0], here[1] - there[1]) < 0.02


@pytest.mark.parametrize("duration", [1.1, 2.0, 3.0])
def test_a_gap_over_whole_strides_invents_no_more_of_them_than_there_were(duration: float) -> None:
    samples, steps = walked()
    a = steps[3].t_toe_off
    told, _ = feed_new_session(without(samples, (a, a + duration)))
    assert len(steps) - 3 <= len(of(StrideTaken, told)) <= len(steps)
    (gap,) = of(SampleGap, told)
    assert len([step for step in of(StrideTaken, told) if gap.t < step.t < gap.t + gap.duration]) <= 2


def test_a_gap_is_neither_stillness_nor_speed() -> None:
    """Both must last to be believed, and what was not seen does not count."""
    samples, steps = walked()
    for number in range(2, len(steps) - 1):
        for share in (0.05, 0.3, 0.5, 0.7, 0.9):
            a = steps[number].t_start + share * (steps[number].t_end - steps[number].t_start)
            told, _ = feed_new_session(without(samples, (a, a + 0.12)))
            assert len(of(ToeOff, told)) == len(of(HeelStrike, told)) == len(steps)
            assert len(of(HeelOff, told)) == len(of(FootFlat, told)) == len(steps)


def test_phases_that_nobody_saw_say_so_and_all_others_that_they_were_seen() -> None:
    samples, steps = walked()
    hidden = set[type[Event]]()
    for k in range(27):
        a = steps[4].t_start - 0.02 + 0.04 * k
        for duration in (0.3, 0.8):
            told, _ = feed_new_session(without(samples, (a, a + duration)))
            (gap,) = of(SampleGap, told)
            end = gap.t + gap.duration
            for event in of(PHASES, told):
                if event.inferred:
                    assert gap.t <= event.t <= end and event.known_at >= end
                    hidden.add(type(event))
                # a cue may look back into a gap, but not over half of it
                assert event.inferred or not gap.t + 0.01 < event.t < end - 0.16
    assert hidden == {HeelStrike, FootFlat, HeelOff, ToeOff}
    assert not any(event.inferred for event in of(PHASES, feed_new_session(samples)[0]))


def turned(told: list[Event]) -> float:
    """Over all steps, rad."""
    return float(sum(step.heading_change for step in of(StrideTaken, told)))


def gapped(samples: tuple[Sample, ...], steps: tuple[TrueStep, ...], duration: float, every: int) -> list[Sample]:
    """A gap in every so many-th swing from the fourth on, at another part of it each time."""
    gaps = []
    for k, step in enumerate(steps):
        if k >= 3 and k % every == 0:
            a = step.t_toe_off + 0.08 * (k // every % 4)
            gaps.append((a, a + duration))
    return without(samples, *gaps)


@pytest.mark.parametrize("name", GENTLE)
@pytest.mark.parametrize(("duration", "within"), [(0.12, 15.0), (0.3, 20.0)])
def test_a_gentle_turn_stays_a_turn_through_a_gap_in_every_other_stride(
    name: str, duration: float, within: float
) -> None:
    samples, steps = walked(GENTLE[name])
    told, _ = feed_new_session(gapped(samples, steps, duration, 2))
    assert len(of(SampleGap, told)) >= 7
    assert turned(told) == pytest.approx(radians(120), abs=radians(within))


@pytest.mark.parametrize("name", SHARP)
@pytest.mark.parametrize(("duration", "within"), [(0.08, 10.0), (0.12, 10.0), (0.3, 20.0)])
def test_a_sharp_turn_is_hardly_straightened_by_gaps(name: str, duration: float, within: float) -> None:
    samples, steps = walked(SHARP[name])
    told, _ = feed_new_session(gapped(samples, steps, duration, 2))
    assert of(SampleGap, told)
    assert abs(turned(told)) == pytest.approx(abs(sum(step.heading_change for step in steps)), abs=radians(within))


@pytest.mark.parametrize("seed", [6, 7])
def test_who_turns_about_on_the_spot_is_not_taken_to_walk_on_in_a_short_gap(seed: int) -> None:
    """Nothing of the last stride is like it, so a straight line is the better guess."""
    route = Route().stand(2.0).walk(5.0, 1.2).stop(1.0).turn(radians(180)).walk(5.0).stop()
    samples, steps = walked(route, seed)
    told, _ = feed_new_session(gapped(samples, steps, 0.12, 2))
    assert of(SampleGap, told)
    assert turned(told) == pytest.approx(sum(step.heading_change for step in steps), abs=radians(8))


def test_a_turn_that_was_seen_is_not_taken_back_with_that_of_a_gap() -> None:
    line = StraightOn()
    for _ in range(3):
        line.footfall(0.0, 0.0, 0.0, 0.0)
    assert line.repair(0.09, 1.0, 0.0) < -0.05
    line.footfall(0.09, 0.0, 0.0, 0.0)
    assert line.repair(0.09, 1.0, 0.0) == 0.0


def test_who_goes_straight_on_keeps_the_heading_through_a_gap_in_every_stride() -> None:
    samples, steps = walked()
    told, _ = feed_new_session(gapped(samples, steps, 0.3, 1))
    assert len(of(SampleGap, told)) > 4
    assert turned(told) == pytest.approx(0.0, abs=radians(4))


def test_the_further_a_footfall_turned_the_less_of_it_is_taken_for_the_gaps_doing() -> None:
    line = StraightOn()
    for _ in range(3):
        assert line.repair(0.1, 1.0, 0.0) == 0.0  # nothing is known of where this wearer is heading
        line.footfall(0.0, 0.0, 0.0, 0.0)
    taken_back = [-line.repair(turn, 1.0, 0.0) / turn for turn in (0.02, 0.1, 0.2, 0.4, 0.8)]
    assert taken_back[0] > 0.8
    assert all(a > b for a, b in pairwise(taken_back))
    assert taken_back[-1] < 0.01
    assert line.repair(0.1, 0.0, 0.0) == 0.0
