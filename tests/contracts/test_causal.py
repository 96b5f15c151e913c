"""Contracts 3, 4 and 9: events are causal and final, do not depend on chunking, and are plain records."""

from __future__ import annotations

from enum import Enum
from functools import cache
from typing import Any

import attrs
import pytest
from attrs import evolve
from hypothesis import Phase, settings
from walks import NAMES, insoles, machine_events, machines, of, often, samples

from solepath import (
    ActivityChanged,
    FootFlat,
    FootMoved,
    HeelOff,
    HeelStrike,
    Packet,
    Sample,
    Session,
    Site,
    StrideTaken,
    ToeOff,
)
from solepath.emulate.routes.route import Route
from solepath.link.decoder import Decoder

FEW_EXAMPLES = settings(max_examples=2, phases=[Phase.generate])
"""Settings for tests whose every example is a whole walk: few examples, without shrinking."""


@cache
def fed_singly(name: str) -> tuple[Any, ...]:
    """Return the events of feeding item by item, without those of `finish`."""
    return tuple(event for events in machine_events(name)[:-1] for event in events)


@pytest.mark.parametrize("name", often(NAMES))
def test_nothing_is_known_before_it_was_or_after_the_item_that_settled_it(name: str) -> None:
    machine = machines()[name]
    decoders = {site: Decoder(site) for site in Site}
    times: list[float] = []
    for item, events in zip(machine.items, machine_events(name), strict=False):
        before, times = times, [item.t]
        if isinstance(item, Packet):
            times += [sample.t for sample in of(Sample, decoders[item.site].feed(item))]
        for event in events:
            # a sample's own time may lie a little after its arrival while the clock's fit is young
            # an activity may have waited for this item since the one before
            settled = [event.t, *times, *(before if isinstance(event, ActivityChanged) else ())]
            assert event.t <= event.known_at and event.known_at in settled, event


@pytest.mark.parametrize("name", often(name for name in NAMES if name.startswith("session")))
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


@pytest.mark.parametrize("name", often(name for name in NAMES if name.startswith("session")))
def test_events_of_a_foot_follow_each_other_and_times_never_run_back(name: str) -> None:
    follows = {HeelStrike: {ToeOff, HeelOff}, ToeOff: {HeelOff, FootFlat, HeelStrike}}
    machine_events = fed_singly(name)
    for foot in {event.foot for event in of(FootMoved, machine_events)}:
        phases = [
            cue
            for cue in machine_events
            if isinstance(cue, HeelStrike | FootFlat | HeelOff | ToeOff) and cue.foot is foot
        ]
        for earlier, later in zip(phases, phases[1:], strict=False):
            assert later.t >= earlier.t and later.known_at >= earlier.known_at
            assert type(earlier) in follows.get(type(later), {type(earlier)})
            assert type(earlier) is not type(later)
        strides = [event for event in of(StrideTaken, machine_events) if event.foot is foot]
        assert [stride.number for stride in strides] == list(range(1, len(strides) + 1))
        for stride in strides:
            assert stride.t_start < stride.t_toe_off < stride.t_end == stride.t
            assert stride.t_heel_strike is None or stride.t_toe_off < stride.t_heel_strike <= stride.t_end
            assert any(flat.t == stride.t for flat in of(FootFlat, phases))


LONG_ROUTE = Route().stand(1.5).walk(14.0, 1.3).stop(1.0)


def latencies(kind: Any, machine_events: list[Any]) -> list[float]:
    """Return the latency of the events of a kind, s."""
    return [event.known_at - event.t for event in of(kind, machine_events)]


@pytest.mark.parametrize("cells", [96, 24, 0])
def test_at_100_hz_heel_strike_and_toe_off_are_known_within_60_ms_and_a_step_60_ms_after_its_foot_flat(
    cells: int,
) -> None:
    machine_events = Session().feed(
        insoles(LONG_ROUTE, cells=cells, rate=100.0).packets if cells else samples(LONG_ROUTE, cells=0, rate=100.0)
    )
    firsts = [event for event in of(StrideTaken, machine_events) if event.number == 1]
    assert all(event.known_at - event.t < 1.5 for event in firsts), "a bout is known by its second stride"
    later = [event for event in machine_events if event not in firsts]
    for kind in (HeelStrike, ToeOff, FootFlat, StrideTaken):
        assert len(latencies(kind, later)) >= 16
        assert max(latencies(kind, later)) <= 0.060, kind


def test_live_position_comes_with_the_sample() -> None:
    session = Session(poses=True)
    for packet in insoles().packets:
        moved = of(FootMoved, session.feed(packet))
        assert len(moved) == (packet.channel == "insole/frame")
        for event in moved:
            assert event.known_at == max(packet.t, event.t)
            assert not event.final


PLAIN_TYPES = (float, int, bool, str, type(None))


def plain(value: Any) -> bool:
    """Return whether a value consists of plain values at every depth, without arrays or numbers of another library."""
    if type(value) is tuple:
        return all(plain(item) for item in value)
    if attrs.has(type(value)):
        return all(plain(getattr(value, f.name)) for f in attrs.fields(type(value)))
    return type(value) in PLAIN_TYPES or isinstance(value, Enum)


@pytest.mark.parametrize("name", often(NAMES))
def test_events_and_samples_are_plain_frozen_and_equal_to_their_copies(name: str) -> None:
    for event in fed_singly(name)[::3]:
        assert plain(event), event
        copy = evolve(event)
        assert copy is not event and copy == event and hash(copy) == hash(event)
        assert event != evolve(event, t=event.t + 1.0)
        with pytest.raises(attrs.exceptions.FrozenInstanceError):
            event.t = 0.0
