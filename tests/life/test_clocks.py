"""Time zones, a date that is set, and an app that stamps its packets with it."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from attrs import evolve
from quoted import PAGES, blocks
from walks import insoles, of

from solepath import ClockReset, Packet, PacketRejected, Rejection, Session, StreamStale, StrideTaken

CUT, TORN, FULL, _, REBOOTED, ZONE, _ = blocks(PAGES["docs/app_life.md"], "python")
PACKETS = insoles(cells=24).packets
HALF = len(PACKETS) // 2
EPOCH = 1.8e9
"""Time of an app that stamps with the date, s since 1970."""


@pytest.fixture
def move_to() -> Iterator[Callable[[str], None]]:
    """Return a function that changes the time zone of this process."""
    before = os.environ.get("TZ")

    def move(zone: str) -> None:
        os.environ["TZ"] = zone
        time.tzset()

    yield move
    os.environ.pop("TZ") if before is None else move(before)
    time.tzset()


def test_a_wearer_who_crosses_a_time_zone_walks_on_as_if_nothing_had_happened(move_to: Callable[[str], None]) -> None:
    undisturbed, session = Session(), Session()
    move_to("UTC0")
    events = session.feed(PACKETS[:HALF])
    move_to("EAST-9")
    session = Session.restore(session.snapshot())
    assert events + session.feed(PACKETS[HALF:]) == undisturbed.feed(PACKETS)
    assert session.pack() == undisturbed.pack()


def test_the_header_of_a_recording_gives_the_time_of_day_in_the_zone_of_whoever_reads_it(
    run: Callable[..., dict[str, Any]], move_to: Callable[[str], None]
) -> None:
    move_to("EAST-9")
    names = run(CUT, TORN, FULL, ZONE)
    names["writer"].close()
    now = names["time_of_day"](time.monotonic() + 3600.0, "today.jsonl")
    assert now.utcoffset() == timedelta(hours=9)
    assert abs(now - datetime.now(UTC) - timedelta(hours=1)) < timedelta(seconds=5)


def dated(by: float) -> list[Packet]:
    """Return the second half of the walk, stamped with a date that was changed by this time, s."""
    return [evolve(packet, t=packet.t + EPOCH + by) for packet in PACKETS[HALF:]]


@pytest.fixture
def session() -> Session:
    """Return the session of an app that stamps with the date, after half of the walk."""
    before = Session()
    before.feed([evolve(packet, t=packet.t + EPOCH) for packet in PACKETS[:HALF]])
    return before


@pytest.mark.parametrize("by", [-3600.0, -5.0])
def test_a_date_that_is_set_back_costs_nineteen_packets_of_each_foot_and_is_reported(
    session: Session, by: float
) -> None:
    packets = dated(by)
    events = session.feed(packets)
    rejections = of(PacketRejected, events)
    assert 37 <= len(rejections) <= 38 and {one.reason for one in rejections} == {Rejection.TIME_BACKWARDS}
    resets = of(ClockReset, events)
    assert len(resets) == 2 and all(abs(one.t - packets[0].t) < 0.3 for one in resets)
    assert session.now == packets[-1].t, "the session has the clock that was set, not the one before"
    strides = of(StrideTaken, events)
    assert len(strides) >= 2 and all(one.t_start >= packets[0].t for one in strides)
    assert len(of(StreamStale, session.advance(packets[-1].t + 5.0))) == 2


@pytest.mark.parametrize("by", [-3600.0, 3600.0])
def test_an_app_that_restarts_the_clock_loses_no_packet(session: Session, by: float) -> None:
    packets = dated(by)
    assert len(of(ClockReset, session.restart_clock(packets[0].t))) == 2
    events = session.feed(packets)
    assert not of(PacketRejected, events) and not of(ClockReset, events)
    assert len(of(StrideTaken, events)) >= 2
