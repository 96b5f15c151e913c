"""An app in the background: notifications come late, all at once, or never, and the phone's clock may stand still."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import pytest
from attrs import evolve
from quoted import PAGES, blocks
from walks import LEFT, RIGHT, insoles, of

from solepath import (
    ClockReset,
    Packet,
    PacketRejected,
    SampleGap,
    Session,
    Site,
    StreamResumed,
    StreamStale,
    StrideTaken,
)
from solepath.emulate import Route

CUT, TORN, FULL, BACKGROUND, *_ = blocks(PAGES["docs/app.md"], "python")[10:]
AWAY = 10.22
"""Time at which the app goes to the background, s."""


@cache
def walk() -> tuple[Packet, ...]:
    """Return the packets of a walk of 38 s."""
    route = Route().stand(2.0).walk(44.0, 1.3).stop(2.0)
    return insoles(route).packets


@cache
def strides() -> list[StrideTaken]:
    return of(StrideTaken, Session().feed(walk()))


def live(away: float, packets: tuple[Packet, ...]) -> list[Any]:
    """Return the events of an app that is in the background for `away` s and then gets all notifications at once."""
    session, now, back = Session(), 0.0, AWAY + away
    events: list[Any] = []
    for second in range(int(back) + 1):
        events += session.feed([packet for packet in packets if second <= packet.t < min(second + 1.0, AWAY)])
        events += session.advance(float(second + 1))
    for packet in packets:
        if packet.t >= AWAY:
            now = max(now + 1e-4, back, packet.t)  # 100 us to take one
            events += session.feed(evolve(packet, t=now))
    return events


@pytest.mark.soak
def test_a_walk_that_a_phone_held_back_has_all_its_strides_when_it_comes() -> None:
    events = live(20.0, walk())
    assert {event.site for event in of(StreamStale, events)} == {event.site for event in of(StreamResumed, events)}
    assert len(of(StreamStale, events)) == 2
    assert not [event for event in events if isinstance(event, SampleGap | ClockReset | PacketRejected)]
    found = of(StrideTaken, events)
    assert len(found) == len(strides())
    for stride, undisturbed in zip(found, strides(), strict=True):
        assert stride.foot is undisturbed.foot and not stride.degraded
        assert stride.t_end == pytest.approx(undisturbed.t_end, abs=0.02)
        assert stride.length == pytest.approx(undisturbed.length, abs=0.03)


@pytest.mark.soak
def test_where_nothing_is_delivered_the_strides_before_and_after_are_found_and_one_between_is_degraded() -> None:
    packets = tuple(packet for packet in walk() if not AWAY <= packet.t < AWAY + 15.0)
    events = live(15.0, packets)
    for site in (LEFT, RIGHT):
        (gap,) = [event for event in of(SampleGap, events) if event.site is site]
        assert gap.duration == pytest.approx(15.0, abs=0.05)
        own = [one for one in of(StrideTaken, events) if one.foot is site.foot]
        assert {one.degraded for one in own if one.t_start < gap.t < one.t_end} <= {True}
        assert [one.degraded for one in own if one.t_end < gap.t or one.t_start > gap.t + gap.duration].count(False) > 4
    assert len(of(StrideTaken, events)) == pytest.approx(len(strides()) - 2 * 14, abs=4)


def test_the_lines_of_the_page_stamp_what_comes_and_let_time_pass(run: Callable[..., dict[str, Any]]) -> None:
    names = run(CUT, TORN, FULL, BACKGROUND)
    session = names["session"]
    session.restart_clock(0.0)
    names["notified"](Site.LEFT_FOOT, "device/battery", bytearray(b"\x63"))
    names["writer"].close()
    assert session.now > 0.0 and names["every_second"]() is not None
