"""Feedback on walks: what the wearer gets, when, and that nobody gets anything who does not walk."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from functools import cache
from typing import Any

import pytest
from attrs import evolve
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from soak import soaked
from walks import insoles, pieces, samples

from solepath import Event, Foot, Packet, Sample, Session, Site, SnapshotError
from solepath.emulate import Route
from solepath.feedback import (
    CadenceAbove,
    CadenceBelow,
    EveryHeelStrike,
    Feedback,
    Rule,
    Signal,
    StanceLonger,
    StanceShorter,
    StanceUneven,
    StrideLonger,
    StrideShorter,
)
from solepath_lab.emulated.other_motions import MOTIONS, samples_of

ROUTE = Route().stand(2.0).walk(16.0, 1.3).stop(3.0)
WALK = insoles(ROUTE)
HEEL_STRIKES = tuple(EveryHeelStrike(foot) for foot in Foot)
RULES: tuple[Rule, ...] = (
    *HEEL_STRIKES,
    *[rule for foot in Foot for rule in (StanceLonger(foot, 0.5, remind=0.1), StanceShorter(foot, 0.66))],
    StrideShorter(1.5), StrideLonger(1.2), CadenceBelow(150.0, remind=1.0), CadenceAbove(80.0), StanceUneven(0.0),
)  # fmt: skip
"""Rules of all kinds, of which a usual walk gives signals."""


def listen(items: Iterable[Packet | Sample], rules: Sequence[Rule] = RULES) -> list[Signal]:
    """Return the signals for packets or samples, one after the other."""
    feedback = Feedback(rules)
    session = Session(poses=feedback.needs_poses, impacts=True)
    return [signal for item in items for signal in feedback.feed(session.feed(item))]


@cache
def heard() -> tuple[Signal, ...]:
    return tuple(listen(WALK.packets))


@cache
def event_lists() -> tuple[tuple[Event, ...], ...]:
    """Return the events of each packet of the walk."""
    session = Session(poses=True)
    return tuple(tuple(session.feed(packet)) for packet in WALK.packets)


def of(kind: type[Rule], signals: Iterable[Signal], foot: Foot | None = None) -> list[Signal]:
    return [one for one in signals if isinstance(one.rule, kind) and foot in (None, one.foot)]


@pytest.mark.parametrize("foot", Foot)
def test_from_the_second_stride_on_each_heel_strike_gives_a_signal_at_once_and_no_other_moment_does(foot: Foot) -> None:
    contacts = WALK.truth.feet[foot].heel_strikes
    signals = of(EveryHeelStrike, heard(), foot)
    assert len(contacts) - 2 <= len(signals) <= len(contacts)
    for contact, signal in zip(contacts[len(contacts) - len(signals) :], signals, strict=True):
        assert signal.t == pytest.approx(contact, abs=0.05)
        assert signal.known_at - contact < 0.06 and signal.deadline == signal.t + 0.2


@pytest.mark.parametrize("foot", Foot)
def test_a_stance_that_gets_too_long_is_signalled_while_it_lasts(foot: Foot) -> None:
    true = WALK.truth.feet[foot]
    signals = of(StanceLonger, heard(), foot)
    assert len(signals) >= len(true.heel_strikes) - 3
    for signal in signals:
        contact = max(t for t in true.heel_strikes if t < signal.t)
        toe_off = min([t for t in true.toe_offs if t > contact], default=1e3)
        assert signal.t == pytest.approx(contact + 0.5, abs=0.05)
        assert signal.known_at < toe_off and signal.known_at - signal.t < 0.04
        assert signal.value is not None and 0.5 < signal.value < 0.55 and signal.limit == 0.5


def test_who_stops_and_stands_gets_no_signal_of_a_long_stance() -> None:
    longest = max(
        min(off for off in true.toe_offs if off > contact) - contact
        for true in WALK.truth.feet.values()
        for contact in true.heel_strikes[:-1]
    )
    assert listen(WALK.packets, [StanceLonger(foot, longest + 0.05) for foot in Foot]) == []


def test_all_other_rules_speak_of_the_walk_as_it_was() -> None:
    assert {type(signal.rule) for signal in heard()} == {type(rule) for rule in RULES}
    shorter, longer = of(StrideShorter, heard())[0], of(StrideLonger, heard())[0]
    assert shorter.value is not None and longer.value is not None and 1.2 < longer.value < shorter.value < 1.5
    slow, quick = of(CadenceBelow, heard())[0], of(CadenceAbove, heard())[0]
    assert slow.value == pytest.approx(111.0, abs=5.0) and quick.value == pytest.approx(111.0, abs=5.0)
    assert all(signal.t <= signal.known_at <= signal.deadline for signal in heard())


def test_no_rule_of_a_limit_that_is_kept_says_anything() -> None:
    kept = [StrideShorter(1.0), StrideLonger(1.6), CadenceBelow(90.0), CadenceAbove(140.0), StanceUneven(0.2)]
    assert listen(WALK.packets, [*kept, *[StanceShorter(foot, 0.4) for foot in Foot]]) == []


@given(st.lists(st.integers(1, 60), max_size=5))
@settings(max_examples=15, phases=[Phase.generate])
def test_in_any_cut_the_same_events_give_the_same_signals(sizes: list[int]) -> None:
    events = tuple(event for some in event_lists() for event in some)
    feedback = Feedback(RULES)
    assert tuple(one for some in pieces(events, sizes) for one in feedback.feed(some)) == heard()  # type: ignore[arg-type]


@given(st.integers(0, len(WALK.packets)))
@settings(max_examples=15, phases=[Phase.generate])
def test_saved_at_any_moment_it_goes_on_as_if_nothing_had_happened(moment: int) -> None:
    lists = event_lists()
    feedback = Feedback(RULES)
    signals = [one for events in lists[:moment] for one in feedback.feed(events)]
    saved = json.loads(json.dumps(feedback.snapshot(), allow_nan=False))
    assert len(json.dumps(saved)) < 12_000
    restored = Feedback.restore(saved, RULES)
    signals += [one for events in lists[moment:] for one in restored.feed(events)]
    assert tuple(signals) == heard()


def test_an_inertial_sensor_is_enough_and_one_foot_alone() -> None:
    left = [one for one in samples(ROUTE, cells=0, rate=100.0) if one.site is Site.LEFT_FOOT]
    signals = listen(left)
    contacts = WALK.truth.feet[Foot.LEFT].heel_strikes
    assert len(of(EveryHeelStrike, signals, Foot.LEFT)) >= len(contacts) - 3
    assert len(of(StanceLonger, signals, Foot.LEFT)) >= len(contacts) - 4
    assert of(EveryHeelStrike, signals, Foot.RIGHT) == [] and of(StanceUneven, signals) == []
    for signal in of(EveryHeelStrike, signals):
        contact = min(contacts, key=lambda t: abs(t - signal.t))
        assert signal.t == pytest.approx(contact, abs=0.03) and signal.known_at - contact < 0.04


NOT_WALKING = ["bicycling", "in a car, legs move", "sitting, legs move"]
MORE = ["driving a car", "in a bus, legs move", "inline skating", "in a wheelchair", "sitting, legs dangle",
        "sitting, feet tap", "marching on the spot"]  # fmt: skip


@pytest.mark.parametrize("name", [*NOT_WALKING, *soaked(*MORE)])
def test_who_does_not_walk_gets_no_signal(name: str) -> None:
    motion = evolve(next(one for one in MOTIONS if one.name == name), duration=40.0)
    rules = [*RULES, *[StanceLonger(foot, 0.2) for foot in Foot]]
    assert listen(samples_of(motion, 23, 50.0), rules) == []


@pytest.mark.soak
def test_recordings_of_a_bicycle_a_car_and_a_chair_give_no_signal(data_dir: Any) -> None:
    from solepath.recording.samples import load_samples

    for name in ("bicycling_01_04", "sitting_in_car_01_08", "sitting_02_00"):
        path = data_dir / "hugadb_daily" / f"{name}.npz"
        if not path.exists():
            pytest.skip("hugadb_daily is not there")
        assert listen(load_samples(path), RULES) == [], name


AWAY = (7.0, 8.6)
"""Time for which nothing arrives, s."""


def test_after_a_lost_link_nothing_is_signalled_of_what_was_before() -> None:
    packets = [packet for packet in WALK.packets if not AWAY[0] < packet.t < AWAY[1]]
    feedback, session = Feedback(RULES), Session(poses=True)
    signals, t = list[Signal](), 0.0
    for packet in packets:
        while packet.t - t > 0.1:  # the app lets time pass
            t += 0.1
            signals += feedback.feed(session.advance(t), t) + feedback.advance(t)
        signals += feedback.feed(session.feed(packet), packet.t)
        t = packet.t
    contacts = {foot: WALK.truth.feet[foot].heel_strikes for foot in Foot}
    assert not [one for one in signals if AWAY[0] + 0.1 < one.known_at < AWAY[1]]
    for signal in of(StanceLonger, signals):
        assert signal.foot is not None
        contact = min(contacts[signal.foot], key=lambda t: abs(t + 0.5 - signal.t))
        assert abs(contact + 0.5 - signal.t) < 0.1 and not AWAY[0] - 0.1 < contact < AWAY[1]
    after = [one for one in of(EveryHeelStrike, signals) if one.t > AWAY[1]]
    assert len(after) >= sum(t > AWAY[1] + 0.1 for times in contacts.values() for t in times) - 2


def test_lost_packets_that_are_reported_together_change_no_signal() -> None:
    feedback, alone = Feedback(RULES), Feedback(RULES)
    session, exact = Session(poses=True), Session(poses=True, losses=True)
    for k, packet in enumerate(WALK.packets):
        if k % 31:  # one packet in thirty-one is lost
            assert feedback.feed(session.feed(packet)) == alone.feed(exact.feed(packet))


def test_what_a_radio_held_back_is_dropped_and_what_is_new_is_not() -> None:
    packets = [evolve(one, t=8.5) if 7.0 < one.t < 8.5 else one for one in WALK.packets]
    signals = listen(packets, HEEL_STRIKES)
    assert not [one for one in signals if 7.0 < one.t < 8.28]
    assert len(signals) >= len(of(EveryHeelStrike, heard())) - 4


def test_a_host_that_gets_to_its_packets_too_late_drops_the_signals_and_those_alone() -> None:
    feedback = Feedback(HEEL_STRIKES)
    signals = [one for k, events in enumerate(event_lists()) for one in feedback.feed(events, WALK.packets[k].t + 0.3)]
    assert signals == []
    feedback = Feedback(HEEL_STRIKES)
    signals = [one for k, events in enumerate(event_lists()) for one in feedback.feed(events, WALK.packets[k].t + 0.1)]
    assert signals == of(EveryHeelStrike, heard())


def test_the_foot_that_falls_silent_falls_silent_alone() -> None:
    packets = [one for one in WALK.packets if one.site is Site.LEFT_FOOT or one.t < 7.0]
    signals = listen(packets)
    assert not [one for one in signals if one.foot is Foot.RIGHT and one.t > 7.1]
    assert len(of(EveryHeelStrike, signals, Foot.LEFT)) == len(of(EveryHeelStrike, heard(), Foot.LEFT))


def test_after_a_reboot_of_the_phone_the_signals_go_on_with_its_new_clock() -> None:
    feedback, session = Feedback(HEEL_STRIKES), Session(poses=True)
    before = [one for packet in WALK.packets if packet.t < 8.0 for one in feedback.feed(session.feed(packet), packet.t)]
    assert before
    shift = -7.5
    feedback.feed(session.restart_clock(8.0 + shift), 8.0 + shift)
    later = [evolve(packet, t=packet.t + shift) for packet in WALK.packets if packet.t >= 8.0]
    signals = [one for packet in later for one in feedback.feed(session.feed(packet), packet.t)]
    contacts = [t + shift for foot in Foot for t in WALK.truth.feet[foot].heel_strikes if t > 10.5]
    assert len(signals) >= len(contacts)
    assert all(min(abs(t - one.t) for t in contacts) < 0.06 for one in signals if one.t > 10.6 + shift)


def test_another_state_than_that_of_these_rules_is_refused() -> None:
    feedback = Feedback(RULES)
    saved = feedback.snapshot()
    for wrong, rules, words in (
        ({**saved, "feedback": 0}, RULES, "version 0"),
        (saved, HEEL_STRIKES, "with the rules"),
        ({**saved, "check": 1}, RULES, "damaged"),
        ({**saved, "state": {}}, RULES, "rules"),
        ([], RULES, "not a snapshot"),
    ):
        with pytest.raises(SnapshotError, match=words):
            Feedback.restore(wrong, rules)
