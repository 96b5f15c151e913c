"""Contract 1: `feed` accepts any data; rejected data change nothing; only errors of the caller raise exceptions."""

from __future__ import annotations

import json
from functools import cache
from math import inf, isfinite, nan
from typing import Any

import pytest
from attrs import evolve
from hypothesis import given, settings
from hypothesis import strategies as st
from walks import DEVICE_NAMES, LEFT, RIGHT, SAMPLE_NAMES, each_by_itself, insoles, machines, of, often, samples

from solepath import FootMoved, Packet, PacketRejected, Rejection, Sample, SampleRejected, Session, Site, StrideTaken
from solepath.link.catalogue import PROFILES

CHANNELS = sorted({channel.name for profile in PROFILES for channel in profile.channels})
SNAPSHOT_COUNT = 8
TIMES = st.sampled_from([nan, inf, -inf, 1e300, -1e300, 2e11])
COUNTS = ("links", "check")
"""Fields of a snapshot that count what was rejected, and its checksum."""


@cache
def cuts(name: str) -> list[tuple[int, Any]]:
    """Return (number of items fed, snapshot) of a machine at several moments of its input."""
    machine = machines()[name]
    session, snapshots = each_by_itself(machine.start()), []
    for k, item in enumerate(machine.items):
        if k % (len(machine.items) // SNAPSHOT_COUNT) == 3:
            snapshots.append((k, machine.save(session)))
        session.feed(item)
    return snapshots


def without_exceptions(state: Any) -> Any:
    """Return a snapshot without its checksum and the two fields that a rejected packet may change (decoder.py)."""
    return without(state, "backward_packets", "reassembly", *COUNTS)


def without(state: Any, *names: str) -> Any:
    """Return a snapshot without the fields of these names."""
    if isinstance(state, dict):
        return {key: without(value, *names) for key, value in state.items() if key not in names}
    return [without(value, *names) for value in state] if isinstance(state, list) else state


def check_times(events: list[Any]) -> None:
    """Check that every event has finite times, and `known_at` not before `t`."""
    for event in events:
        assert isfinite(event.t) and isfinite(event.known_at) and event.known_at >= event.t, event


@pytest.mark.parametrize("name", often([*DEVICE_NAMES, "session, kupt-dfpc", "session, walking-modes"]))
@given(st.data())
@settings(max_examples=4)
def test_any_bytes_anywhere_give_events_and_a_rejected_packet_changes_nothing(name: str, data: st.DataObject) -> None:
    machine = machines()[name]
    k, saved = data.draw(st.sampled_from(cuts(name)))
    now = max(item.t for item in machine.items[:k])
    packet = Packet(
        data.draw(st.one_of(TIMES, st.sampled_from([now, now + 0.01, now + 1e6, now - 1e-6, -7.0]))),
        data.draw(st.sampled_from(Site)),
        data.draw(st.sampled_from([*CHANNELS, "insole/frames", "toaster/crumbs", "", "/", "device/"])),
        data.draw(st.one_of(st.binary(max_size=24), st.binary(min_size=100, max_size=600))),
    )
    session = machine.load(saved)
    events = session.feed(packet)
    check_times(events)
    state_after = machine.save(session)
    if rejected := [event for event in events if isinstance(event, PacketRejected)]:
        is_counted = any(event.reason is Rejection.TIME_BACKWARDS for event in rejected)
        is_fragment = packet.channel == "insole/frame" and packet.data[:1] < b"\xe0"
        if is_counted:
            assert without_exceptions(state_after) == without_exceptions(saved)
        elif not is_fragment:
            assert without(state_after, *COUNTS) == without(saved, *COUNTS)
    check_times([event for item in machine.items[k : k + 20] for event in session.feed(item)] + session.finish())


def test_bytes_that_are_not_a_bytes_object_are_bytes_all_the_same() -> None:
    items = machines()["session, whole frames"].items[:300]
    plain = Session().feed(items)
    for kind in (bytearray, memoryview):
        assert Session().feed([evolve(item, data=kind(item.data)) for item in items]) == plain


def test_a_receiver_whose_clock_is_set_back_goes_on_finding_steps() -> None:
    walk = insoles()
    session = Session()
    first = session.feed(walk.packets)
    size = len(json.dumps(session.snapshot()))
    again = session.feed([evolve(packet, t=packet.t - 1e5) for packet in insoles(seed=2).packets])
    assert len(of(StrideTaken, again)) >= len(of(StrideTaken, first)) - 2
    check_times(again)
    settled = [event for event in again if isinstance(event, StrideTaken)]
    assert all(event.t < 0.0 and event.t_start < event.t_end for event in settled)
    assert len(json.dumps(session.snapshot())) < 1.2 * size


def spoilt(sample: Sample, last: Sample) -> dict[str, tuple[Sample, Rejection]]:
    """Return a sample made unusable in every way, with the reported reason; `last` is the foot's previous sample."""
    x = (0.0, 0.0, 9.8)
    return {
        "acc nan": (evolve(sample, acc=(0.0, nan, 9.8)), Rejection.NOT_FINITE),
        "acc inf": (evolve(sample, acc=(inf, 0.0, 9.8)), Rejection.NOT_FINITE),
        "acc absurd": (evolve(sample, acc=(0.0, 0.0, 1e4)), Rejection.ABSURD),
        "gyro nan": (evolve(sample, acc=x, gyro=(nan, nan, nan)), Rejection.NOT_FINITE),
        "gyro inf": (evolve(sample, acc=x, gyro=(0.0, -inf, 0.0)), Rejection.NOT_FINITE),
        "gyro absurd": (evolve(sample, acc=x, gyro=(-500.0, 0.0, 0.0)), Rejection.ABSURD),
        "time nan": (evolve(sample, t=nan), Rejection.NOT_FINITE),
        "time inf": (evolve(sample, t=inf), Rejection.NOT_FINITE),
        "time absurd": (evolve(sample, t=1e300), Rejection.ABSURD),
        "known nan": (evolve(sample, known_at=nan), Rejection.NOT_FINITE),
        "known absurd": (evolve(sample, known_at=1e300), Rejection.ABSURD),
        "the same time again": (evolve(sample, t=last.t), Rejection.DUPLICATE),
        "a tenth of a microsecond later": (evolve(sample, t=last.t + 1e-7), Rejection.DUPLICATE),
        "earlier": (evolve(sample, t=last.t - 0.5), Rejection.TIME_BACKWARDS),
        "much earlier": (evolve(sample, t=-1e9), Rejection.TIME_BACKWARDS),
    }


def around(items: tuple[Sample, ...], k: int) -> tuple[Sample, Sample]:
    """Return item k, and the previous item of the same site."""
    return items[k], next(item for item in reversed(items[:k]) if item.site is items[k].site)


@pytest.mark.parametrize("name", often(SAMPLE_NAMES))
def test_samples_that_cannot_be_used_change_nothing_and_are_named(name: str) -> None:
    machine = machines()[name]
    for k, saved in cuts(name)[1::4]:
        session = machine.load(saved)
        for kind, (bad, reason) in spoilt(*around(machine.items, k)).items():
            events = session.feed(bad)
            assert [(type(event), event.reason) for event in events] == [(SampleRejected, reason)], kind
            check_times(events)
        assert without(machine.save(session), *COUNTS) == without(saved, *COUNTS)


_FLOATS = st.floats(allow_nan=True, allow_infinity=True)
_VECTORS = st.none() | st.tuples(_FLOATS, _FLOATS, _FLOATS)
_SAMPLES = st.builds(
    Sample,
    t=st.one_of(_FLOATS, st.floats(0.0, 20.0)),
    site=st.sampled_from(Site),
    acc=_VECTORS,
    gyro=_VECTORS,
    pressure=st.none() | st.lists(_FLOATS, max_size=4).map(tuple),
    known_at=st.none() | _FLOATS,
    saturated=st.booleans(),
)


@pytest.mark.parametrize("name", often(SAMPLE_NAMES))
@given(st.sampled_from(range(SNAPSHOT_COUNT)), st.lists(_SAMPLES, max_size=12))
@settings(max_examples=8)
def test_any_samples_at_all_give_events(name: str, cut: int, fed: list[Sample]) -> None:
    machine = machines()[name]
    k, saved = cuts(name)[cut]
    session = machine.load(saved)
    check_times([event for sample in fed for event in session.feed(sample)])
    check_times([event for item in machine.items[k : k + 50] for event in session.feed(item)] + session.finish())
    machine.save(session)


def test_a_session_that_only_received_nonsense_is_as_new() -> None:
    session = Session(losses=True)
    session.feed(Packet(3.0, LEFT, "insole/frame", b"\xf5\x10"))
    session.feed(Packet(nan, RIGHT, "cc2650/movement", bytes(18)))
    session.feed(Sample(1.0, LEFT, acc=(nan, 0.0, 0.0), gyro=(0.0, 0.0, 0.0)))
    session.feed(Sample(nan, Site.PELVIS, acc=(1.0, 0.0, 0.0), gyro=(0.0, 0.0, 0.0)))
    assert without(session.snapshot(), *COUNTS) == without(Session(losses=True).snapshot(), *COUNTS)
    assert session.position is None and session.support is None


def test_a_sample_cannot_be_known_before_it_was() -> None:
    session = Session(poses=True)
    emitted = session.feed([evolve(sample, known_at=sample.t - 3.0) for sample in samples()])
    assert len(of(FootMoved, emitted)) > 500
    check_times(emitted)
