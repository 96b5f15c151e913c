"""Rules and their signals on gait events that are made here: hysteresis, refractory time, corrections, gaps, faults."""

from __future__ import annotations

from math import inf, nan
from typing import Any

import numpy as np
import pytest
from attrs import evolve, field, frozen
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath import (
    Activity,
    ActivityChanged,
    Defect,
    DefectFound,
    Disconnected,
    Event,
    Flaw,
    Foot,
    FootFlat,
    FootMoved,
    FootSilent,
    HeelOff,
    HeelStrike,
    Phase,
    SampleGap,
    Site,
    StreamStale,
    StrideFeatures,
    StrideTaken,
    ToeOff,
)
from solepath.feedback import EveryHeelStrike, Feedback, Rule, Signal, StanceLonger, StanceShorter, Value, WalkNow

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT
CYCLE = 1.1


def stride(t: float, foot: Foot = LEFT, *flaws: Flaw) -> StrideTaken:
    zero = (0.0, 0.0, 0.0)
    return StrideTaken(
        t=t, foot=foot, number=1, t_start=t - CYCLE, t_end=t, displacement=zero, position=zero, length=1.3,
        heading_change=0.0, height_change=0.0, covariance=(0.0,) * 6, features=StrideFeatures(0.1, 4.0, 1.0),
        flaws=flaws,
    )  # fmt: skip


def activity(t: float, what: Activity, revises: float | None = None) -> ActivityChanged:
    return ActivityChanged(t=t, final=False, activity=what, probability=0.9, revises=revises)


def moved(t: float, foot: Foot = LEFT) -> FootMoved:
    return FootMoved(t=t, foot=foot, position=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), phase=Phase.STATIONARY)


WALKING = [activity(0.0, Activity.WALKING), stride(0.0)]


def stance(t: float, time: float, foot: Foot = LEFT) -> list[Event]:
    """Return the events of a foot that comes down at `t` for `time` s, and then ends a stride."""
    return [
        HeelStrike(t=t, foot=foot), FootFlat(t=t + 0.1, foot=foot), stride(t + 0.1, foot),
        HeelOff(t=t + 0.6 * time, foot=foot), ToeOff(t=t + time, foot=foot),
    ]  # fmt: skip


def walk(*times: float) -> list[Event]:
    """Return the events of the left foot, with stances of these times, a cycle apart."""
    return [*WALKING, *[event for k, time in enumerate(times) for event in stance(1.0 + CYCLE * k, time)]]


def listen(events: list[Event], *rules: Rule) -> list[Signal]:
    return Feedback(rules).feed(events)


def test_a_signal_is_given_once_an_excursion_and_again_after_the_value_was_well_inside() -> None:
    signals = listen(walk(0.7, 0.8, 0.79, 0.74, 0.77, 0.7, 0.8), StanceLonger(LEFT, 0.75))
    assert [round(one.t - 1.0, 2) for one in signals] == [round(CYCLE * k + 0.75, 2) for k in (1, 6)]
    closer = listen(walk(0.7, 0.8, 0.79, 0.74, 0.77), StanceLonger(LEFT, 0.75, rearm=0.745))
    assert len(closer) == 2


def test_who_does_not_change_is_reminded_after_a_while_or_never() -> None:
    stances = [0.8] * 12
    assert len(listen(walk(*stances), StanceLonger(LEFT, 0.75))) == 3  # 5 s, which are five cycles
    assert len(listen(walk(*stances), StanceLonger(LEFT, 0.75, remind=None))) == 1
    assert len(listen(walk(*stances), StanceLonger(LEFT, 0.75, remind=0.5))) == 12


def test_between_two_signals_is_the_refractory_time() -> None:
    for pause, count in ((0.0, 12), (2.0, 6), (100.0, 1)):
        assert len(listen(walk(*[0.8] * 12), EveryHeelStrike(LEFT, pause=pause))) == count


@given(st.lists(st.floats(0.4, 1.0), max_size=40))
def test_whatever_the_stances_each_excursion_gives_one_signal(times: list[float]) -> None:
    rule = StanceShorter(LEFT, 0.6, rearm=0.7, remind=None)
    armed, expected = True, []
    for k, time in enumerate(times):
        armed = armed or time >= 0.7
        if armed and time < 0.6:
            expected.append(k)
            armed = False
    signals = listen(walk(*times), rule)
    near = any(abs(time - edge) < 1e-9 for time in times for edge in (0.6, 0.7))  # rounding decides
    assert near or [round((one.t - 1.0) / CYCLE - 0.3) for one in signals] == expected


def test_a_long_stance_is_signalled_with_the_sample_that_shows_it_and_not_twice() -> None:
    samples = [moved(1.0 + 0.01 * k) for k in range(30, 100)]
    events = [*WALKING, *stance(1.0, 0.5)[:4], *samples]
    (signal,) = listen(events, StanceLonger(LEFT, 0.75))
    assert signal.t == 1.75 and signal.known_at == pytest.approx(1.76)
    assert signal.value == pytest.approx(0.76)


def test_on_both_feet_with_the_heel_down_one_stands_and_a_foot_that_swings_shows_a_walk() -> None:
    both: list[Event] = [*WALKING, HeelStrike(t=1.0, foot=LEFT), HeelStrike(t=1.5, foot=RIGHT)]
    samples: list[Event] = [moved(1.0 + 0.01 * k) for k in range(60, 90)]
    assert listen([*both, *samples], StanceLonger(LEFT, 0.75)) == []
    rocked = [*both, HeelOff(t=1.1, foot=LEFT), FootFlat(t=1.2, foot=LEFT), *samples]
    assert listen(rocked, StanceLonger(LEFT, 0.75)) == []
    swing: list[Event] = [*WALKING, HeelStrike(t=1.0, foot=LEFT), ToeOff(t=1.2, foot=RIGHT), *samples]
    assert len(listen(swing, StanceLonger(LEFT, 0.75))) == 1
    late: list[Event] = [*both, *samples, HeelOff(t=2.0, foot=LEFT), ToeOff(t=2.2, foot=LEFT)]
    assert listen(late, StanceLonger(LEFT, 0.75)) == [], "the deadline was at 1.95 s"


@pytest.mark.parametrize("pause", [0.0, 0.35])
def test_a_corrected_heel_strike_gives_no_second_signal_and_its_time_counts(pause: float) -> None:
    events: list[Event] = [
        *WALKING,
        HeelStrike(t=1.0, known_at=1.01, foot=LEFT, final=False),
        HeelStrike(t=1.02, known_at=1.07, foot=LEFT, revises=1.0),
        FootFlat(t=1.1, foot=LEFT),
        ToeOff(t=1.6, foot=LEFT),
    ]
    heel, short = listen(events, EveryHeelStrike(LEFT, pause=pause), StanceShorter(LEFT, 0.59))
    assert (heel.t, heel.known_at, short.value) == (1.0, 1.01, pytest.approx(0.58))


def test_a_foot_that_lands_flat_gives_its_signal_with_the_foot_flat() -> None:
    events: list[Event] = [
        *walk(0.6),
        FootFlat(t=2.1, foot=LEFT),
        HeelStrike(t=3.2, foot=LEFT),
        FootFlat(t=3.3, foot=LEFT),
    ]
    assert [one.t for one in listen(events, EveryHeelStrike(LEFT))] == [1.0, 2.1, 3.2]


def test_walking_that_was_withdrawn_gives_nothing_from_then_on() -> None:
    contacts: list[Event] = [HeelStrike(t=1.0 + 0.9 * k, foot=LEFT) for k in range(3)]
    assert len(listen([*WALKING, *contacts], EveryHeelStrike(LEFT))) == 3
    withdrawn = [*WALKING, contacts[0], activity(0.0, Activity.UNKNOWN, 0.0), *contacts[1:]]
    assert [one.t for one in listen(withdrawn, EveryHeelStrike(LEFT))] == [1.0]


def test_what_becomes_final_of_the_past_changes_nothing_and_a_stand_ends_an_excursion() -> None:
    events, rule = walk(0.8, 0.8, 0.8, 0.8), StanceLonger(LEFT, 0.75, remind=None)
    past = [activity(-9.0, Activity.STANDING, -9.0), activity(0.0, Activity.WALKING)]
    assert len(listen([*events[:12], *past, *events[12:]], rule)) == 1
    stand: list[Event] = [activity(4.0, Activity.STANDING), moved(5.0), activity(6.0, Activity.WALKING)]
    later = [evolve(event, t=event.t + 4.0, known_at=event.t + 4.0) for event in events[12:]]
    assert len(listen([*events[:12], *stand, stride(6.1), *later], rule)) == 2


@pytest.mark.parametrize("what", sorted(set(Activity) - {Activity.WALKING}, key=str))
def test_only_while_somebody_walks(what: Activity) -> None:
    contacts: list[Event] = [HeelStrike(t=1.6 + k, foot=LEFT) for k in range(6)]
    assert listen([activity(0.0, what), stride(0.0), *contacts], EveryHeelStrike(LEFT)) == []


def test_the_contact_after_a_stride_belongs_to_the_walk_whatever_a_slow_stance_looks_like() -> None:
    events = walk(0.8, 0.8, 0.8)
    for what, count in ((Activity.UNKNOWN, 3), (Activity.STANDING, 3), (Activity.STAIRS_UP, 1)):
        provisional = [*events[:7], activity(1.5, what), *events[7:]]
        assert len(listen(provisional, EveryHeelStrike(LEFT))) == count


def test_on_stairs_if_the_app_says_so() -> None:
    events = [activity(0.0, Activity.STAIRS_UP), *walk(0.8, 0.8)[1:]]
    assert len(Feedback([EveryHeelStrike(LEFT)], [Activity.STAIRS_UP]).feed(events)) == 2
    with pytest.raises(ValueError, match="signals are for WALKING"):
        Feedback([], [Activity.UNKNOWN])


def test_before_a_stride_and_three_seconds_after_the_last_one_nobody_knows_of_a_walk() -> None:
    contacts: list[Event] = [HeelStrike(t=1.0 + k, foot=LEFT) for k in range(6)]
    assert listen([WALKING[0], *contacts], EveryHeelStrike(LEFT)) == []
    assert [one.t for one in listen([*WALKING, *contacts], EveryHeelStrike(LEFT))] == [1.0, 2.0, 3.0]
    impossible = [WALKING[0], stride(0.9, LEFT, Flaw.IMPOSSIBLE), *contacts]
    assert listen(impossible, EveryHeelStrike(LEFT)) == []
    with_gap = [WALKING[0], stride(0.9, LEFT, Flaw.GAP), *contacts]
    assert len(listen(with_gap, EveryHeelStrike(LEFT))) == 3


LOSSES: list[Event] = [
    SampleGap(t=1.2, site=Site.LEFT_FOOT, duration=0.1, count=9),
    StreamStale(t=1.2, site=Site.LEFT_FOOT, silent_for=1.0),
    Disconnected(t=1.2, site=Site.LEFT_FOOT),
    FootSilent(t=1.2, foot=LEFT, silent_for=1.0),
]


@pytest.mark.parametrize("loss", LOSSES, ids=lambda one: type(one).__name__)
def test_a_stance_in_which_something_is_lost_has_no_length(loss: Event) -> None:
    rules = (StanceLonger(LEFT, 0.75), StanceShorter(LEFT, 0.9, remind=0.1))
    first, *rest = stance(1.0, 0.8)
    samples: list[Event] = [moved(1.0 + 0.01 * k) for k in range(30, 80)]
    events = [*WALKING, first, loss, *samples, *rest, *stance(2.1, 0.8)]
    assert {round(one.t, 2) for one in listen(events, *rules)} == {2.85, 2.9}
    small = SampleGap(t=1.2, site=Site.LEFT_FOOT, duration=0.03, count=2)
    assert len(listen([*WALKING, first, small, *samples, *rest], *rules)) == 2


def test_what_was_inferred_in_a_gap_gives_no_signal() -> None:
    events: list[Event] = [*WALKING, HeelStrike(t=1.0, foot=LEFT, inferred=True), ToeOff(t=1.3, foot=LEFT)]
    ended: list[Event] = [*WALKING, HeelStrike(t=1.0, foot=LEFT), ToeOff(t=1.3, foot=LEFT, inferred=True)]
    rules = (EveryHeelStrike(LEFT), StanceShorter(LEFT, 0.6))
    assert listen(events, *rules) == []
    assert len(listen(ended, *rules)) == 1


def test_a_foot_whose_data_are_wrong_gives_none_until_a_sound_stride() -> None:
    def found(spoils: bool) -> Event:
        return DefectFound(t=1.0, site=Site.LEFT_FOOT, defect=Defect.ACC_UNIT, what="wrong", spoils=spoils)

    contacts: list[Event] = [
        HeelStrike(t=1.1, foot=LEFT), HeelStrike(t=1.6, foot=RIGHT), stride(2.0, LEFT, Flaw.DEFECT),
        HeelStrike(t=2.2, foot=LEFT), stride(2.3), HeelStrike(t=3.3, foot=LEFT),
    ]  # fmt: skip
    rules = (EveryHeelStrike(LEFT), EveryHeelStrike(RIGHT))
    assert [one.t for one in listen([*WALKING, found(True), *contacts], *rules)] == [1.6, 3.3]
    assert len(listen([*WALKING, found(False), *contacts], *rules)) == 4


@given(st.randoms(use_true_random=False))
@settings(max_examples=15)
def test_in_any_order_of_events_no_signal_breaks_its_promises(random: Any) -> None:
    events = [*walk(*[0.8] * 8), *[moved(1.0 + 0.05 * k) for k in range(200)], *LOSSES]
    events += [event for k in range(8) for event in stance(1.5 + CYCLE * k, 0.6, RIGHT)]
    events.sort(key=lambda one: one.t + random.uniform(0.0, 0.5))
    rules = (EveryHeelStrike(LEFT), StanceLonger(LEFT, 0.7, remind=0.5), StanceShorter(RIGHT, 0.65, remind=0.5))
    newest: dict[Rule, float] = {}
    for signal in listen(events, *rules):
        assert signal.t <= signal.known_at <= signal.deadline
        assert signal.value is None or signal.rule.is_beyond(signal.value)
        assert signal.t - newest.get(signal.rule, -inf) >= signal.rule.pause - 1e-9
        newest[signal.rule] = signal.t


def test_time_that_has_passed_makes_what_comes_stale() -> None:
    feedback = Feedback([EveryHeelStrike(LEFT)])
    assert feedback.feed(WALKING) == []
    assert feedback.advance(1.15) == []
    (signal,) = feedback.feed([HeelStrike(t=1.0, foot=LEFT)])
    assert signal.to_dict() == {
        "signal": "EveryHeelStrike", "foot": "left", "t": 1.0, "known_at": 1.0, "deadline": 1.2, "value": None,
        "limit": None,
    }  # fmt: skip
    assert feedback.feed([HeelStrike(t=2.0, foot=LEFT)], 2.25) == []
    for wrong, kind in ((nan, ValueError), (inf, ValueError), ("now", TypeError)):
        with pytest.raises(kind):
            feedback.advance(wrong)  # type: ignore[arg-type]


def test_rules_that_cannot_be_are_refused_in_words() -> None:
    for make, words in (
        (lambda: StanceLonger(LEFT, -1.0), "limit is -1; it can be 0.05 to 10 s"),
        (lambda: StanceLonger(LEFT, nan), "limit is nan"),
        (lambda: StanceLonger(LEFT, 0.7, rearm=0.8), "wrong side"),
        (lambda: StanceShorter(LEFT, 0.7, rearm=0.6), "wrong side"),
        (lambda: EveryHeelStrike(LEFT, pause=-1.0), "pause is -1"),
        (lambda: EveryHeelStrike("left"), "foot is 'left'"),  # type: ignore[arg-type]
    ):
        with pytest.raises(ValueError, match=words):
            Feedback([make()])
    with pytest.raises(TypeError, match="derives from Rule"):
        Feedback([StanceLonger])  # type: ignore[list-item]
    assert type(Feedback([StanceLonger(LEFT, np.float64(0.75))]).rules[0].limit) is float


@frozen
class LowLift(Rule):
    """The foot is lifted less than `limit` m."""

    reads = (StrideTaken,)
    above = False

    limit: float = 0.2

    def measure(self, event: StrideTaken, walk: WalkNow) -> Value | None:
        return Value(event.t, event.foot, event.features.clearance)


def test_a_rule_of_ones_own_is_judged_and_saved_as_the_others_are() -> None:
    feedback = Feedback([LowLift()])
    assert not feedback.needs_poses
    (first,) = feedback.feed(walk(0.8, 0.8)[:6])
    assert (first.value, first.limit, first.foot) == (0.1, 0.2, LEFT)
    restored = Feedback.restore(feedback.snapshot(), [LowLift()])
    assert restored.feed(walk(0.8, 0.8)[6:]) == []


@frozen
class Hoards(EveryHeelStrike):
    """A rule with a memory of its own, which no snapshot of feedback would hold."""

    kept: list[float] = field(factory=list)


def test_a_rule_that_keeps_something_is_refused_with_the_way_out() -> None:
    with pytest.raises(TypeError, match="a rule keeps nothing, a part of the session may"):
        Feedback([Hoards(Foot.LEFT)])
