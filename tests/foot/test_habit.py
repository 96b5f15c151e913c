"""Gaps in the samples of one foot: what it is used to doing stands in for what nobody saw."""

from __future__ import annotations

import json
from functools import cache
from itertools import pairwise
from math import hypot, radians
from random import Random

import pytest
from attrs import evolve
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import of

from solepath import Event, Foot, FootFlat, HeelOff, HeelStrike, Sample, SampleGap, Session, StrideTaken, ToeOff
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.truth import TrueStep
from solepath.emulate.wearers.walker import Walker
from solepath.foot.gaps.gap import NoLeap, leap
from solepath.foot.gaps.moment import corrected, moments
from solepath.foot.gaps.straight import StraightOn
from solepath.foot.gaps.template import Habit
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.tracker import FootTracker
from solepath.saving import codec as machine
from solepath.types import Quat, Vec3
from solepath.types.vector import GRAVITY, IDENTITY, ZERO

PHASES = HeelStrike | FootFlat | HeelOff | ToeOff
STRAIGHT = Route().stand(2.0).walk(12.0, 1.3).stop(2.0)
GENTLE = {
    f"{degrees} degrees a stride": Route().stand(2.0).walk(6.0, 1.3).turn(radians(120), radius=radius).walk(4.0).stop()
    for degrees, radius in ((5, 15.5), (8, 9.7), (10, 7.8))
}
SHARP = {
    "about a corner": Route().stand(2.0).walk(6.0, 1.2).turn(radians(90), radius=0.8).walk(5.0).stop(),
    "to the right": Route().stand(2.0).walk(6.0, 1.2).turn(radians(-90), radius=1.0).walk(5.0).stop(),
}


@cache
def walked(route: Route = STRAIGHT, seed: int = 5) -> tuple[tuple[Sample, ...], tuple[TrueStep, ...]]:
    """The left foot at 100 Hz without cells, and its true steps."""
    walker = Walker(route, seed=seed)
    return tuple(walker.samples(Foot.LEFT, 100.0, LSM6DSOX)), walker.truth().steps(Foot.LEFT)


def without(samples: tuple[Sample, ...], *gaps: tuple[float, float]) -> list[Sample]:
    """What is left of them after gaps from one time to another, s."""
    return [sample for sample in samples if not any(a < sample.t < b for a, b in gaps)]


def heard(samples: list[Sample] | tuple[Sample, ...]) -> tuple[list[Event], Session]:
    session = Session()
    return session.feed(samples), session


def around(steps: tuple[StrideTaken, ...] | list[StrideTaken], t: float) -> StrideTaken:
    """The step that was under way at `t`, s."""
    (found,) = (step for step in steps if step.t_start < t <= step.t_end)
    return found


# --- a gap in a stride ------------------------------------------------------------------------------------------------

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
    told, _ = heard(without(samples, (a, a + duration)))
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
    told, _ = heard(without(samples, (a, a + duration)))
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
        told, _ = heard(without(samples, (a, a + duration)))
        (gap,) = of(SampleGap, told)
        for step in of(StrideTaken, told):
            within = min(gap.t + gap.duration, step.t_end) - max(gap.t, step.t_start)
            assert step.degraded or within <= 0.0101
            assert not step.degraded or within > -0.1  # what a cue looks back by
            seen.add(step.degraded)
    assert seen == {False, True}


def test_a_sample_at_the_end_of_its_range_degrades_the_step_it_is_in_even_when_flat_is_dated_back() -> None:
    samples, steps = walked()
    uncut = of(StrideTaken, heard(samples)[0])
    for k in range(12):
        t = steps[4].t_end - 0.03 + 0.01 * k
        told, _ = heard([evolve(sample, saturated=abs(sample.t - t) < 0.005) for sample in samples])
        taken = of(StrideTaken, told)
        assert len(taken) == len(uncut)
        (hit,) = (sample.t for sample in samples if abs(sample.t - t) < 0.005)
        assert all(step.degraded for step in taken if step.t_start < hit < step.t_end)


def test_a_foot_that_stands_through_a_gap_goes_nowhere() -> None:
    samples, steps = walked()
    last = steps[-1].t_end
    straight, uncut = heard(samples)
    # who has stood for longer than between two strides has halted, and takes none in a long gap either
    for a, b in ((0.8, 1.4), (last + 0.2, last + 0.5), (last + 0.8, last + 1.8)):
        told, session = heard(without(samples, (a, b)))
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
    told, _ = heard(without(samples, (a, a + duration)))
    assert len(steps) - 3 <= len(of(StrideTaken, told)) <= len(steps)
    (gap,) = of(SampleGap, told)
    assert len([step for step in of(StrideTaken, told) if gap.t < step.t < gap.t + gap.duration]) <= 2


def test_a_gap_is_neither_stillness_nor_speed() -> None:
    """Both must last to be believed, and what was not seen does not count."""
    samples, steps = walked()
    for number in range(2, len(steps) - 1):
        for share in (0.05, 0.3, 0.5, 0.7, 0.9):
            a = steps[number].t_start + share * (steps[number].t_end - steps[number].t_start)
            told, _ = heard(without(samples, (a, a + 0.12)))
            assert len(of(ToeOff, told)) == len(of(HeelStrike, told)) == len(steps)
            assert len(of(HeelOff, told)) == len(of(FootFlat, told)) == len(steps)


def test_phases_that_nobody_saw_say_so_and_all_others_that_they_were_seen() -> None:
    samples, steps = walked()
    hidden = set[type[Event]]()
    for k in range(27):
        a = steps[4].t_start - 0.02 + 0.04 * k
        for duration in (0.3, 0.8):
            told, _ = heard(without(samples, (a, a + duration)))
            (gap,) = of(SampleGap, told)
            end = gap.t + gap.duration
            for event in of(PHASES, told):
                if event.inferred:
                    assert gap.t <= event.t <= end and event.known_at >= end
                    hidden.add(type(event))
                # a cue may look back into a gap, but not over half of it
                assert event.inferred or not gap.t + 0.01 < event.t < end - 0.16
    assert hidden == {HeelStrike, FootFlat, HeelOff, ToeOff}
    assert not any(event.inferred for event in of(PHASES, heard(samples)[0]))


# --- heading ----------------------------------------------------------------------------------------------------------


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
    told, _ = heard(gapped(samples, steps, duration, 2))
    assert len(of(SampleGap, told)) >= 7
    assert turned(told) == pytest.approx(radians(120), abs=radians(within))


@pytest.mark.parametrize("name", SHARP)
@pytest.mark.parametrize(("duration", "within"), [(0.08, 10.0), (0.12, 10.0), (0.3, 20.0)])
def test_a_sharp_turn_is_hardly_straightened_by_gaps(name: str, duration: float, within: float) -> None:
    samples, steps = walked(SHARP[name])
    told, _ = heard(gapped(samples, steps, duration, 2))
    assert of(SampleGap, told)
    assert abs(turned(told)) == pytest.approx(abs(sum(step.heading_change for step in steps)), abs=radians(within))


@pytest.mark.parametrize("seed", [6, 7])
def test_who_turns_about_on_the_spot_is_not_taken_to_walk_on_in_a_short_gap(seed: int) -> None:
    """Nothing of the last stride is like it, so a straight line is the better guess."""
    route = Route().stand(2.0).walk(5.0, 1.2).stop(1.0).turn(radians(180)).walk(5.0).stop()
    samples, steps = walked(route, seed)
    told, _ = heard(gapped(samples, steps, 0.12, 2))
    assert of(SampleGap, told)
    assert turned(told) == pytest.approx(sum(step.heading_change for step in steps), abs=radians(8))


def test_a_turn_that_was_seen_is_not_taken_back_with_that_of_a_gap() -> None:
    line = StraightOn()
    for _ in range(3):
        line.footfall(0.0, 0.0, 0.0, 0.0)
    assert line.mend(0.09, 1.0, 0.0) < -0.05
    line.footfall(0.09, 0.0, 0.0, 0.0)
    assert line.mend(0.09, 1.0, 0.0) == 0.0


def test_who_goes_straight_on_keeps_the_heading_through_a_gap_in_every_stride() -> None:
    samples, steps = walked()
    told, _ = heard(gapped(samples, steps, 0.3, 1))
    assert len(of(SampleGap, told)) > 4
    assert turned(told) == pytest.approx(0.0, abs=radians(4))


def test_the_further_a_footfall_turned_the_less_of_it_is_taken_for_the_gaps_doing() -> None:
    line = StraightOn()
    for _ in range(3):
        assert line.mend(0.1, 1.0, 0.0) == 0.0  # nothing is known of where this wearer is heading
        line.footfall(0.0, 0.0, 0.0, 0.0)
    taken_back = [-line.mend(turn, 1.0, 0.0) / turn for turn in (0.02, 0.1, 0.2, 0.4, 0.8)]
    assert taken_back[0] > 0.8
    assert all(a > b for a, b in pairwise(taken_back))
    assert taken_back[-1] < 0.01
    assert line.mend(0.1, 0.0, 0.0) == 0.0


# --- before anything is known -----------------------------------------------------------------------------------------


def test_before_any_whole_stride_a_moving_foot_leaves_nothing_to_go_by_and_a_still_one_has_stood() -> None:
    habit, at_rest = Habit(), ErrorStateFilter()
    at_rest.start(IDENTITY, 0.02)
    up: Vec3 = (0.0, 0.0, GRAVITY)
    assert leap(habit, at_rest, 1.0, 1.2, up, ZERO) is NoLeap.STOOD
    assert leap(habit, at_rest, 1.0, 1.2, up, (0.0, 4.0, 0.0)) is NoLeap.UNKNOWN
    habit.lift(0.9)
    assert leap(habit, at_rest, 1.0, 1.2, up, ZERO) is NoLeap.UNKNOWN


def test_a_gap_in_the_first_stride_is_bridged_by_a_straight_line() -> None:
    samples, steps = walked()
    a = steps[0].t_toe_off + 0.1
    tracker = FootTracker(Foot.LEFT, Session().recipe.detector, ErrorStateFilter())
    before = [sample for sample in samples if sample.t <= a]
    after = next(sample for sample in samples if sample.t >= a + 0.1)
    for sample in before:
        tracker.feed(sample)
    by_line = machine.load(ErrorStateFilter, machine.save(tracker.corrector))
    dt = after.t - before[-1].t
    assert by_line.bridge(dt) == dt
    acc, gyro = after.acc, after.gyro
    assert acc is not None and gyro is not None
    x, y, z = acc
    bx, by, bz = tracker.rest.bias
    k = tracker.rest.scale
    by_line.predict(dt, (x * k, y * k, z * k), (gyro[0] - bx, gyro[1] - by, gyro[2] - bz))
    tracker.feed(after)
    assert tracker.gait.habit.last is None
    assert tracker.corrector.position == by_line.position
    assert tracker.corrector.attitude == by_line.attitude


def test_a_stride_is_remembered_as_it_was_wherever_on_earth_it_was() -> None:
    habit, far = Habit(), 1e7
    habit.lift(1e9)
    for k in range(8):
        t = 0.032 * k
        velocity, position = (1.0, 0.1 * k, 0.0), (far + t, -far, 0.0)
        habit.keep(1e9 + t, IDENTITY, velocity, position, (0.0, 3.0, 4.0), (0.0, -5.0, 0.25))
    rows = moments(habit.now)
    assert [one.since for one in rows] == pytest.approx([0.032 * k for k in range(8)], abs=1e-6)
    assert rows[7].velocity == pytest.approx((1.0, 0.7, 0.0))
    assert rows[7].position == pytest.approx((0.224, 0.0, 0.0), abs=1e-7)
    assert rows[7].rate == (0.0, -5.0, 0.25) and rows[7].force == 5.0 and rows[7].attitude == IDENTITY
    assert corrected(habit.now) == pytest.approx(0.35 * 0.224, abs=1e-6)  # it went so far to the left, and is not there
    habit.keep(1e9 + 1.0, IDENTITY, (1e300, 0.0, 0.0), (far, far, 0.0), (0.0, 3.0, 4.0), ZERO)
    assert habit.now == [] and habit.lifted is None


def test_a_toe_off_or_heel_strike_at_one_of_the_moments_that_are_remembered_is_at_that_moment() -> None:
    """At 10 samples a second they often are, and rounding must not decide whether a gap has hidden them."""
    for start in range(100):
        habit, lifted = Habit(), 0.1 * start
        habit.lift(lifted)
        times = [lifted + 0.1 * k for k in range(10)]
        for t in times:
            habit.keep(t, IDENTITY, ZERO, ZERO, (0.0, 0.0, GRAVITY), ZERO)
        habit.flat(lifted + 1.0, times[2], times[7], 0.0, ZERO, 0.1)
        assert habit.last is not None
        kept = moments(habit.last.rows)
        assert (kept[2].since, kept[7].since) == (habit.last.toe_off, habit.last.heel_strike)


def test_a_stride_with_a_gap_or_round_a_corner_is_not_the_habit() -> None:
    pose: tuple[Quat, Vec3, Vec3] = (IDENTITY, ZERO, ZERO)
    up: Vec3 = (0.0, 0.0, GRAVITY)

    def stride(habit: Habit, t: float, turn: float, duration: float = 0.7, unseen: float = 0.0) -> None:
        habit.lift(t)
        for k in range(int(duration / 0.01)):
            if t + 0.01 * k >= habit.due:
                habit.keep(t + 0.01 * k, *pose, up, ZERO)
        if unseen:
            habit.guess(t, unseen)
        habit.flat(t + duration, t + 0.2, t + 0.6, turn, (1.3, 0.0, 0.0), 0.01)

    habit = Habit()
    stride(habit, 1.0, 0.0)
    kept = habit.last
    assert kept is not None and kept.lasted < 0.7
    assert (kept.toe_off, kept.heel_strike) == pytest.approx((0.2, 0.6))
    stride(habit, 2.0, 0.0, unseen=0.2)
    assert habit.last is kept
    stride(habit, 3.0, 0.5)
    assert habit.last is kept
    for k in range(habit.old):
        stride(habit, 4.0 + k, 0.5)
    assert habit.last is not kept  # who does nothing but turn has turning for a habit
    stride(habit, 40.0, 0.0, duration=3.0)  # too slow to be kept whole, and memory is bounded
    assert len(habit.now) <= habit.most


# --- what is possible -------------------------------------------------------------------------------------------------


def test_a_stride_that_zero_velocity_had_to_put_right_is_not_the_habit() -> None:
    habit, up = Habit(), (0.0, 0.0, GRAVITY)

    def stride(t: float, speed: float) -> None:
        habit.lift(t)
        for k in range(20):
            habit.keep(t + 0.035 * k, IDENTITY, (speed, 0.0, 0.0), (2.0 * 0.035 * k, 0.0, 0.0), up, ZERO)
        habit.flat(t + 0.7, t + 0.2, t + 0.6, 0.0, (1.33, 0.0, 0.0), 0.01)

    stride(1.0, -5.0)
    assert habit.last is None
    stride(2.0, 2.0)
    assert habit.last is not None


@pytest.mark.parametrize("way", [(3.3, 0.0, 0.0), (1.3, 0.0, 1.18), (1.3, 0.5, -1.18), (-40.0, 9.0, 7.0)])
@pytest.mark.parametrize("filled", [True, False])
def test_a_stride_with_a_gap_goes_hardly_further_than_those_before_and_no_higher_than_two_stairs(
    way: Vec3, filled: bool
) -> None:
    habit, up = Habit(), (0.0, 0.0, GRAVITY)
    for n in range(2):
        habit.lift(1.2 * n + 0.4)
        for k in range(20):
            habit.keep(habit.due, IDENTITY, (2.0, 0.0, 0.0), (2.0 * 0.032 * k, 0.0, 0.0), up, ZERO)
        t = 1.2 * (n + 1)
        habit.flat(t, t - 0.5, t - 0.1, 0.0, (1.3, 0.0, 0.0), 0.01)
    assert habit.last is not None
    habit.lift(2.8)
    if filled:
        habit.guess(2.8, 0.3)
    else:
        habit.cross()
    mended = habit.flat(3.6, 3.1, 3.5, 0.0, way, 0.01)
    assert mended is not None
    assert hypot(mended.way[0], mended.way[1]) <= 1.25 * 1.3 * 1.2
    assert abs(mended.way[2]) <= 0.5


@pytest.mark.parametrize("duration", [0.15, 0.3, 0.6, 1.2, 2.0])
def test_in_a_gap_no_foot_goes_faster_than_feet_go_and_a_long_one_is_not_filled(duration: float) -> None:
    samples, steps = walked()
    tracker = FootTracker(Foot.LEFT, Session().recipe.detector, ErrorStateFilter())
    a = steps[4].t_toe_off + 0.1
    before = [sample for sample in samples if sample.t <= a]
    for sample in before:
        tracker.feed(sample)
    after = next(sample for sample in samples if sample.t >= a + duration)
    assert after.acc is not None and after.gyro is not None
    for speed in (3.0, 60.0):
        x, y, z = tracker.corrector.position
        tracker.corrector.velocity = (speed, 0.0, -speed)
        dt = after.t - before[-1].t
        found = leap(tracker.gait.habit, tracker.corrector, before[-1].t, after.t, after.acc, after.gyro)
        assert (duration > 1.5) == (found is NoLeap.UNKNOWN) or speed == 60.0
        if not isinstance(found, NoLeap):
            u, v, w = found.position
            assert hypot(u - x, v - y, w - z) <= 4.0 * dt + 1e-9
            assert hypot(*found.velocity) < 9.0


@pytest.mark.parametrize("rate", [20.0, 100.0])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_however_many_gaps_there_are_no_stride_is_longer_or_higher_than_a_stride_can_be(rate: float, seed: int) -> None:
    walker = Walker(Route().stand(2.0).walk(30.0).turn(radians(178), radius=1.0).walk(30.0).stop(1.0))
    random, holes, t = Random(seed), list[tuple[float, float]](), 8.0
    while t < 50.0:
        holes.append((t, t + random.choice([0.1, 0.2, 0.4, 0.7, 1.0])))
        t += random.uniform(0.3, 4.0)
    told, _ = heard(without(tuple(walker.samples(Foot.LEFT, rate)), *holes))
    longest = max(step.length for step in walker.truth().steps(Foot.LEFT))
    for step in of(StrideTaken, told):
        if step.degraded:
            assert step.length < 2.5 * longest
            assert abs(step.height_change) < 0.85


# --- contracts --------------------------------------------------------------------------------------------------------


def test_a_session_restored_anywhere_about_a_gap_goes_on_the_same() -> None:
    samples, steps = walked()
    gaps = [(step.t_toe_off + 0.1, step.t_toe_off + 0.4) for step in steps[3:]]
    left = without(samples, *gaps)
    straight, _ = heard(left)
    for a, b in gaps[:2]:
        for t in (a - 0.15, a, b, b + 0.05, b + 0.3):
            head = [sample for sample in left if sample.t <= t]
            told, session = heard(head)
            restored = Session.restore(json.loads(json.dumps(session.snapshot())))
            assert told + restored.feed(left[len(head) :]) == straight


holes = st.lists(st.tuples(st.floats(1.0, 13.0), st.floats(0.02, 1.5)), min_size=1, max_size=8)


@given(holes=holes)
@settings(max_examples=25, deadline=None)
def test_whatever_the_gaps_phases_follow_each_other_in_time_and_none_is_known_before_it_was(
    holes: list[tuple[float, float]],
) -> None:
    samples, _ = walked()
    left = without(samples, *((a, a + duration) for a, duration in holes))
    session = Session()
    told: list[Event] = []
    for sample in left:
        new = session.feed(sample)
        assert all(event.known_at >= event.t and event.known_at >= sample.t for event in new)
        told += new
    phases = of(PHASES, told)
    assert all(a.t <= b.t for a, b in pairwise(phases))
    assert all(type(a) is not type(b) for a, b in pairwise(phases))
    taken = of(StrideTaken, told)
    assert all(a.t_end <= b.t_start for a, b in pairwise(taken))
    for step in taken:
        assert step.t_start <= step.t_toe_off <= step.t_end
        assert step.t_heel_strike is None or step.t_toe_off <= step.t_heel_strike <= step.t_end


@given(holes=holes, share=st.floats(0.1, 0.9))
@settings(max_examples=15, deadline=None)
def test_nothing_that_was_final_is_said_otherwise_when_more_is_heard(
    holes: list[tuple[float, float]], share: float
) -> None:
    samples, _ = walked()
    left = without(samples, *((a, a + duration) for a, duration in holes))
    k = int(share * len(left))
    early, session = heard(left[:k])
    snapshot = repr(early)
    whole, _ = heard(left)
    later = session.feed(left[k:])
    assert repr(early) == snapshot and early + later == whole
    final = [event for event in whole if event.final]
    assert len({(type(event), event.t, getattr(event, "number", None)) for event in final}) == len(final)
