"""Relations of a stream: cut, saved, doubled, reordered, later, interrupted; and what is counted of it."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf
from random import Random
from typing import Any

import pytest
from attrs import evolve
from soak import soaked
from transforms import CALIBRATION, CLIMBING, Change, differences, in_order, run, worn
from walks import LEFT, NAMES, RIGHT, each_by_itself, insoles, machine_events, machines, of, often, pieces, run_machine

from solepath import (
    ActivityChanged,
    ClockReset,
    FootFlat,
    FootMoved,
    HeelOff,
    HeelStrike,
    LayoutKnown,
    PacketRejected,
    Rejection,
    Sample,
    SampleGap,
    Session,
    StreamResumed,
    StrideTaken,
    ToeOff,
    recipes,
)

SESSIONS = [name for name in NAMES if name.startswith("session")]
COUNTED = ["fragments", "orphe", *soaked("whole frames", "four samples a frame", "dot")]
"""Devices that count their packets, so that one that comes twice is noticed."""
FEW = ("whole frames", "fragments", "cc2541", "thingy", "walking-modes", "samples with pressure", "particles")
"""Sessions that differ most from each other."""
OTHERS = ("footstep-tracker", "shoe-sensing", "walking-modes")
PHASES = (HeelStrike, FootFlat, HeelOff, ToeOff)
TURNING_POINTS = LayoutKnown | SampleGap | ClockReset | StreamResumed
"""Events after which a session is saved, the first of each kind."""


def exactly(events: Iterable[Any]) -> list[str]:
    """Return the texts of the events, which differ for -0.0 and 0.0 and for 1 and 1.0, unlike ==."""
    return [repr(event) for event in events]


@pytest.mark.parametrize("name", often(SESSIONS, FEW))
def test_cut_anywhere_the_events_are_the_same_bit_for_bit(name: str) -> None:
    machine, cuts = machines()[name], Random(name)
    session = machine.start()
    sizes = [cuts.randint(2, 300) for _ in range(9)]
    events = [
        event
        for k, piece in enumerate(pieces(machine.items, sizes))
        for event in session.feed([iter, list][k % 2](piece))
    ]
    assert exactly(events) == exactly(event for events in machine_events(name)[:-1] for event in events)
    assert machine.save(session) == run_machine(name).fed


@pytest.mark.parametrize("name", often(NAMES))
def test_saved_and_restored_anywhere_it_goes_on_as_if_nothing_had_happened(name: str) -> None:
    machine, straight = machines()[name], machine_events(name)
    seen: set[type] = set()
    points = {0, *Random(name).sample(range(len(machine.items)), 2)}
    for k, events in enumerate(straight[:-1]):
        kinds = {type(event) for event in of(TURNING_POINTS, [*events])} - seen
        points |= {k + 1} if kinds else set()
        seen |= kinds
    session, texts = machine.start(), []
    for k, item in enumerate(machine.items):
        if k in points:
            saved = machine.save(session)
            again, packed = machine.load(saved), machine.repacked(session)
            assert machine.save(again) == machine.save(packed) == saved
            session = again if k % 2 else packed
        texts += exactly(session.feed(item))
    assert machine.save(session) == run_machine(name).fed
    assert texts + exactly(session.finish()) == exactly(event for events in straight for event in events)


@pytest.mark.parametrize("name", often([name for name in NAMES if name.partition(", ")[2] not in recipes.NAMES], FEW))
def test_later_by_twelve_days_the_events_are_the_same_at_that_time(name: str) -> None:
    machine, later = machines()[name], Change(later=2.0**20)
    items = [
        later.sample(item) if isinstance(item, Sample) else evolve(item, t=item.t + later.later)
        for item in machine.items
    ]
    events, found = (
        [one for one in some if not isinstance(one, Sample)]
        for some in (machine.events(), machine.events(tuple(items)))
    )
    loose = {
        "": 1e-4,
        "cadence": 1e-2,
        "probability": 1e-3,
        "silent_for": 1e-6,
        "t": 1e-6,
        "known_at": 1e-6,
        "sampled_at": 1e-6,
        "weight": 1e-3,
    }
    assert differences(map(later.event, events), found, loose) == []


def state_of(session: Session) -> dict[str, Any]:
    """Return the state of a session but for its links, which count what was rejected."""
    state: Any = session.snapshot()["state"]
    return {name: value for name, value in state.items() if name != "links"}


@pytest.mark.parametrize("name", COUNTED)
def test_a_packet_that_comes_twice_is_rejected_and_changes_nothing(name: str) -> None:
    machine = machines()[f"session, {name}"]
    session, events = each_by_itself(machine.start()), []
    for k, item in enumerate(machine.items):
        used = session.feed(item)
        if of(FootMoved, used):
            before = state_of(session) if k % 97 == 0 else None
            (again,) = session.feed(item)
            assert isinstance(again, PacketRejected) and again.reason in (Rejection.DUPLICATE, Rejection.LATE), again
            assert before is None or state_of(session) == before
        events += used
    once = each_by_itself(machine.start())
    assert events + session.finish() == [event for item in machine.items for event in once.feed(item)] + once.finish()


@pytest.mark.parametrize("name", ["fragments", "cc2541", "thingy", "kupt-dfpc"])
def test_of_packets_of_one_time_either_foot_may_come_first(name: str) -> None:
    machine, found = machines()[f"session, {name}"], []
    items = [evolve(item, t=0.05 * (item.t // 0.05 + 1.0)) for item in machine.items]
    for site in (LEFT, RIGHT):
        events = machine.events(tuple(sorted(items, key=lambda item: (item.t, item.site is not site))))
        found.append(in_order(of((*PHASES, StrideTaken), events)))
    within = {"": 2e-3, "covariance": 1e-2, "position": 0.05, "displacement": 0.02, "length": 0.02}
    assert len(of(StrideTaken, found[0])) >= 4 and differences(*found, within) == []


GAIT = {"": inf, "t": 0.02, "length": 0.03, "height_change": 0.03, "heading_change": 0.02}
"""Tolerances between one who has learnt the sensors and the gait, and one who has not."""


def gait(events: list[Any], since: float) -> list[Any]:
    """Return the gait of the time from `since` on, where strides of both are from one foot-flat to the next."""
    taken = [event for event in of((*PHASES, StrideTaken), events) if event.t > since]
    return sorted(taken, key=lambda event: (type(event).__name__, event.foot.value, event.t))


@pytest.mark.parametrize("how", ["samples", *soaked("clock", "device")])
@pytest.mark.parametrize("recipe", ["default", "kupt-dfpc", *soaked(*OTHERS)])
def test_after_a_reset_a_walk_is_what_it_is_for_a_fresh_session(recipe: str, how: str) -> None:
    session, second = Session(recipes.by_name(recipe), calibration=CALIBRATION), worn(CLIMBING)
    session.feed(worn())
    if how == "clock":
        resets = session.restart_clock(0.0)
        assert [(event.site, event.t) for event in of(ClockReset, resets)] == [(LEFT, 0.0), (RIGHT, 0.0)]
    elif how == "device":
        for site in (LEFT, RIGHT):
            session.bind(site, "C0:FF:EE:00:00:01")
        second = [Change(later=60.0).sample(sample) for sample in second]
    else:
        second = [Change(later=60.0).sample(sample) for sample in second]
    fresh = run(recipe, second)
    found = session.feed(second) + session.finish()
    since = second[0].t + 3.6
    assert differences(gait(fresh, since), gait(found, since), GAIT) == []
    moved = [of(ActivityChanged, [one for one in events if one.t > since])[-1].activity for events in (fresh, found)]
    assert moved[0] is moved[1]


@pytest.mark.parametrize("recipe", often(recipes.NAMES))
def test_a_longer_silence_changes_nothing_but_its_own_length(recipe: str) -> None:
    found = []
    for silence in (60.0, 6000.0):
        session, pause = Session(recipes.by_name(recipe), calibration=CALIBRATION), Change(later=silence)
        session.feed(sample for sample in worn() if sample.t < 5.2)
        after = session.feed(pause.sample(sample) for sample in worn() if sample.t >= 5.2) + session.finish()
        start = 5.2 + silence
        found.append([one for one in after if one.t > start and getattr(one, "t_start", start) >= start])
    loose = {"": 1e-6, "covariance": inf, "heading_sigma": inf, "duration": inf, "silent_for": inf}
    # kupt-dfpc compares the first stride with one of the other foot that contains the silence
    loose |= {
        "stride_length": 1e-3,
        "similarity": 5e-3,
        "coefficient": 5e-3,
        "distance": 1e-3,
        "StrideFused.position": 1e-3,
    }
    assert differences(map(Change(later=5940.0).event, found[0]), found[1], loose) == []


@pytest.mark.parametrize("name", often(recipes.NAMES))
def test_every_sample_that_was_taken_is_used_or_rejected_or_missing(name: str) -> None:
    """Some packets are lost, some cut short, some come twice; each frame of the insole has one sample."""
    fate, session = Random(3), Session(recipes.by_name(name), poses=True)
    packets = insoles(rate=100.0).packets
    taken, spoilt, events = {LEFT: 0, RIGHT: 0}, {LEFT: 0, RIGHT: 0}, []
    for k, packet in enumerate(packets):
        if packet.channel != "insole/frame":
            events += session.feed(packet)
            continue
        taken[packet.site] += 1
        chance = fate.random() if 100 < k < len(packets) - 100 else 1.0
        if chance < 0.04:
            spoilt[packet.site] += 1
            events += session.feed(evolve(packet, data=packet.data[:-3]))
        elif chance > 0.08:
            events += session.feed(packet)
        if 0.08 < chance < 0.12:
            spoilt[packet.site] += 1
            events += session.feed(packet)
    events += session.finish()
    for site in (LEFT, RIGHT):
        used = sum(event.foot is site.foot for event in of(FootMoved, events))
        missing = sum(event.count for event in of(SampleGap, events) if event.site is site)
        assert missing > 20 and used + missing == taken[site]
        assert sum(event.count for event in of(PacketRejected, events) if event.site is site) == spoilt[site]
