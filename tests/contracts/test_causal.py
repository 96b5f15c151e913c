"""Contracts 3, 4 and 9: causal, final, however it is cut, and plain records."""

from __future__ import annotations

from copy import deepcopy
from enum import Enum
from functools import cache
from typing import Any

import attrs
import pytest
from attrs import evolve
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from walks import NAMES, SHORT, Machine, insoles, machine_events, machines, of, pieces, run_machine, samples

from solepath import (
    ActivityChanged,
    FootFlat,
    FootMoved,
    HeelOff,
    HeelStrike,
    Packet,
    Placed,
    Sample,
    Session,
    Site,
    StrideTaken,
    ToeOff,
    TouchedDown,
)
from solepath.emulate.radio import CLEAN
from solepath.emulate.routes.route import Route
from solepath.events import LiveEvent
from solepath.link.decoder import Decoder

QUICK = settings(max_examples=2, phases=[Phase.generate])
"""A walk an example: few of them, and no shrinking."""


@cache
def fed_singly(name: str) -> tuple[Any, ...]:
    """Return the events item by item, without those at the end."""
    return tuple(event for events in machine_events(name)[:-1] for event in events)


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_known_before_it_was_or_after_the_item_that_settled_it(name: str) -> None:
    machine = machines()[name]
    decoders = {site: Decoder(site) for site in Site}
    for item, events in zip(machine.items, machine_events(name), strict=False):
        sampled = [s.t for s in of(Sample, decoders[item.site].feed(item))] if isinstance(item, Packet) else []
        newest = max([item.t, *sampled])
        for event in events:
            # a sample's own time may lie a little after its arrival while the clock's fit is young
            assert event.t <= event.known_at <= max(newest, event.t), event
            assert event.known_at == event.t or event.known_at in (item.t, *sampled), event


@pytest.mark.parametrize("name", NAMES)
@given(st.data())
@QUICK
def test_what_was_final_stays_when_more_comes(name: str, data: st.DataObject) -> None:
    machine = machines()[name]
    everything = fed_singly(name)
    one = machine.start()
    some = machine.items[: data.draw(st.integers(1, len(machine.items)))]
    early = [event for item in some for event in one.feed(item)]
    assert tuple(early) == everything[: len(early)]
    # live positions and places are never final, a touchdown not before the wearer's first heading is settled, an
    # activity as long as it may turn out to be another
    live = LiveEvent | Placed | TouchedDown | ActivityChanged | Sample
    assert all(event.final for event in early if not isinstance(event, live))


@pytest.mark.parametrize("name", [name for name in NAMES if name.startswith("session")])
def test_an_activity_that_is_final_is_never_replaced_and_a_revision_names_what_it_replaces(name: str) -> None:
    machine_events: list[ActivityChanged] = []
    for event in of(ActivityChanged, list(fed_singly(name))):
        assert not any(before.final and before.t >= event.t for before in machine_events), event
        if event.revises is not None:
            named = [before for before in machine_events if before.t == event.revises]
            assert named and not any(before.final for before in machine_events if before.t >= event.revises), event
            machine_events = [before for before in machine_events if before.t < event.revises]
        machine_events = [before for before in machine_events if before.t < event.t]
        machine_events.append(event)


@pytest.mark.parametrize("name", [name for name in NAMES if name.startswith("session")])
def test_events_of_a_foot_follow_each_other_and_times_never_run_back(name: str) -> None:
    follows = {HeelStrike: {ToeOff, HeelOff}, ToeOff: {HeelOff, FootFlat, HeelStrike}}
    machine_events = fed_singly(name)
    for foot in {event.foot for event in of(FootMoved, machine_events)}:
        phases = [
            e for e in machine_events if isinstance(e, HeelStrike | FootFlat | HeelOff | ToeOff) and e.foot is foot
        ]
        for before, after in zip(phases, phases[1:], strict=False):
            assert after.t >= before.t and after.known_at >= before.known_at
            assert type(before) in follows.get(type(after), {type(before)})
            assert type(before) is not type(after)
        steps = [event for event in of(StrideTaken, machine_events) if event.foot is foot]
        assert [step.number for step in steps] == list(range(1, len(steps) + 1))
        for step in steps:
            assert step.t_start < step.t_toe_off < step.t_end == step.t
            assert step.t_heel_strike is None or step.t_toe_off < step.t_heel_strike <= step.t_end
            assert any(flat.t == step.t for flat in of(FootFlat, phases))


LONGER = Route().stand(1.5).walk(14.0, 1.3).stop(1.0)


def late(kind: Any, machine_events: list[Any]) -> list[float]:
    """Return the latency of the events of a kind, s."""
    return [event.known_at - event.t for event in of(kind, machine_events)]


@pytest.mark.parametrize("cells", [96, 24, 0])
def test_at_100_hz_heel_strike_and_toe_off_are_known_within_60_ms_and_a_step_60_ms_after_its_foot_flat(
    cells: int,
) -> None:
    machine_events = Session().feed(insoles(LONGER, CLEAN, cells=cells).packets if cells else samples(LONGER, cells=0))
    for kind in (HeelStrike, ToeOff, FootFlat, StrideTaken):
        assert len(late(kind, machine_events)) >= 18
        assert max(late(kind, machine_events)) <= 0.060, kind


def test_live_position_comes_with_the_sample() -> None:
    session = Session(poses=True)
    for packet in insoles().packets:
        moved = of(FootMoved, session.feed(packet))
        assert len(moved) == (packet.channel == "insole/frame")
        for event in moved:
            assert event.known_at == max(packet.t, event.t)
            assert not event.final


FAR = st.integers(0, 399).map(lambda k: 400 - k)
"""The first that hypothesis tries is 400: items one by one are what others are compared with."""


@pytest.mark.parametrize("name", [name for name in NAMES if name.startswith("session")])
@given(st.lists(FAR, min_size=1, max_size=6), st.sampled_from([list, tuple, iter]))
@QUICK
def test_any_chunking_gives_the_same_events_bit_for_bit(name: str, sizes: list[int], form: Any) -> None:
    machine: Machine = machines()[name]
    session = machine.start()
    found = [event for piece in pieces(machine.items, sizes) for event in session.feed(form(piece))]
    assert exactly(found) == exactly(fed_singly(name))
    assert machine.save(session) == run_machine(name).fed


def exactly(machine_events: Any) -> list[str]:
    """Events to the last bit: == alone takes -0.0 for 0.0 and 1 for 1.0."""
    return [repr(event) for event in machine_events]


def test_packets_and_samples_may_come_mixed() -> None:
    left = [packet for packet in insoles().packets if packet.site.value == "left_foot"]
    right = [sample for sample in samples() if sample.site.value == "right_foot"]
    mixed = sorted([*left, *right], key=lambda item: item.t)
    one, other = Session(), Session()
    machine_events = one.feed(mixed)
    assert machine_events == [event for item in mixed for event in other.feed(item)]
    assert {step.foot.value for step in of(StrideTaken, machine_events)} == {"left", "right"}


PLAIN = (float, int, bool, str, type(None))


def plain(value: Any) -> bool:
    """Nothing but plain values all the way down: no array, no number of another library."""
    if type(value) is tuple:
        return all(plain(item) for item in value)
    if attrs.has(type(value)):
        return all(plain(getattr(value, f.name)) for f in attrs.fields(type(value)))
    return type(value) in PLAIN or isinstance(value, Enum)


@pytest.mark.parametrize("name", NAMES)
def test_events_and_samples_are_plain_frozen_and_equal_to_their_copies(name: str) -> None:
    for event in fed_singly(name)[::3]:
        assert plain(event), event
        copy = evolve(event)
        assert copy is not event and copy == event and hash(copy) == hash(event)
        assert event != evolve(event, t=event.t + 1.0)
        with pytest.raises(attrs.exceptions.FrozenInstanceError):
            event.t = 0.0


def test_packets_and_positions_are_plain_too() -> None:
    session = Session()
    session.feed(samples(SHORT))
    position = session.position
    assert plain(position) and position == deepcopy(position)
    packet = insoles().packets[5]
    assert packet == Packet(packet.t, packet.site, packet.channel, bytes(packet.data))
    assert len({packet, deepcopy(packet)}) == 1
