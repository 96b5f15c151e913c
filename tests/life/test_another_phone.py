"""A walk continues on another phone: another clock, and other identifiers of the same sensors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import dist
from pathlib import Path
from typing import Any

import pytest
from attrs import evolve
from quoted import PAGES, blocks
from recordings import recorded
from walks import insoles, of

from solepath import ClockReset, DefectFound, LayoutKnown, Packet, PacketRejected, Session, Site, StrideTaken

CUT, TORN, FULL, *_, PHONE = blocks(PAGES["docs/app.md"], "python")[10:]
PACKETS = insoles(cells=24).packets
HALF = len(PACKETS) // 2
OLD = {Site.LEFT_FOOT: "F0:5E:00:00:00:01", Site.RIGHT_FOOT: "F0:5E:00:00:00:02"}
NEW = {Site.LEFT_FOOT: "9C4E2A10-0001", Site.RIGHT_FOOT: "9C4E2A10-0002"}
"""Addresses of the sensors on the old phone, and identifiers of the same sensors on the new one."""


def on(identifiers: dict[Site, str], packets: Sequence[Packet], by: float = 0.0) -> list[Packet]:
    """Return the packets as a phone with these identifiers gets them, on a clock that differs by this time, s."""
    return [evolve(packet, t=packet.t + by, device=identifiers[packet.site]) for packet in packets]


def second_half(by: float) -> list[Packet]:
    """Return what the new phone gets: the values that it reads when it connects, then the rest of the walk."""
    start = PACKETS[HALF].t
    read = [evolve(packet, t=start) for packet in PACKETS if packet.channel != "insole/frame"]
    return on(NEW, [*read, *PACKETS[HALF:]], by)


def moved(by: float) -> Session:
    """Return the session that was unpacked on the new phone, whose clock differs by this time, s."""
    old = Session()
    old.feed(on(OLD, PACKETS[:HALF]))
    return Session.unpack(old.pack())


@pytest.mark.parametrize("by", [-1000.0, 5000.0])
def test_the_walk_goes_on_from_where_it_was_and_the_change_is_reported(by: float) -> None:
    session, undisturbed = moved(by), Session()
    undisturbed.feed(PACKETS)
    resets = of(ClockReset, session.restart_clock(PACKETS[HALF].t + by))
    assert {reset.site for reset in resets} == set(NEW)
    for site, identifier in NEW.items():
        session.bind(site, identifier)
    events = session.feed(second_half(by))
    assert len(of(LayoutKnown, events)) == 2
    assert not of(PacketRejected, events) and not of(DefectFound, events)
    assert len(of(StrideTaken, events)) >= 2
    end, expected = session.position, undisturbed.position
    assert end is not None and expected is not None
    assert dist(end.position[:2], expected.position[:2]) < 1.0 < dist(end.position[:2], (0.0, 0.0))


def test_the_lines_of_the_page_continue_on_the_new_phone_and_after_it_was_killed(
    run: Callable[..., dict[str, Any]],
) -> None:
    names = run(CUT, TORN, FULL, PHONE)
    names["writer"].close()
    assert {event.site for event in of(ClockReset, names["events"])} == set(NEW)
    session = names["session"]
    by = session.now - PACKETS[HALF].t
    packets = second_half(by)
    events = session.feed(packets)
    assert not of(PacketRejected, events) and len(of(StrideTaken, events)) >= 2
    recorded(Path(names["next_recording"]()), packets)
    assert len([*Path().glob("walk-*.jsonl")]) == 3, "this phone has walks of its own"
    assert names["resume"]().pack() == session.pack()
