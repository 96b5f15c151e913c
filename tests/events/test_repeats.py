"""Small troubles of a link that repeat are told together, and an app hears about gait and not about radio."""

from __future__ import annotations

import json
from collections import Counter
from decimal import Decimal
from math import fsum
from random import Random
from typing import Any

import numpy as np
import pytest
from attrs import evolve
from soak import soaked
from walks import LEFT, RIGHT, insoles, of, pieces, run_session

from solepath import (
    BatteryLevel,
    ClockReset,
    Disconnected,
    LinkEvent,
    Packet,
    PacketRejected,
    Sample,
    SampleGap,
    SampleRejected,
    Session,
    Site,
    StreamStale,
    StrideTaken,
)
from solepath.emulate.demo import RADIO, ROUTE
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import emulate

Troubles = SampleGap | PacketRejected | SampleRejected
WALK = Route().stand(3.0).walk(25.0, 1.3).stop(3.0)
"""A walk of 25 s: troubles are told together twice in it."""
STANDING = Route().stand(32.0)
PERIOD = 0.02
"""Time from one frame of an insole to the next, s."""


def test_in_the_demos_walk_fewer_than_one_event_in_seven_is_about_the_link() -> None:
    events = run_session(emulate(ROUTE, radio=RADIO, seed=1).packets)
    assert len(of(StrideTaken, events)) > 50 and sum(gap.count for gap in of(SampleGap, events)) > 200
    assert 7 * len(of(LinkEvent, events)) < len(events)


def frames_of(packets: tuple[Packet, ...], site: Site) -> list[Packet]:
    return [packet for packet in packets if packet.channel == "insole/frame" and packet.site is site]


def without(packets: tuple[Packet, ...], *times: float, site: Site = LEFT) -> list[Packet]:
    """Return the packets without one frame of the site at each of these times, s."""
    frames = frames_of(packets, site)
    lost = [next(frame for frame in frames if frame.t >= t) for t in times]
    return [packet for packet in packets if packet not in lost]


def spoilt(seed: int) -> tuple[list[Packet], Counter[Site], Counter[Any]]:
    """Return packets over a bad radio, and how many samples were lost and packets rejected, by site, and reason."""
    chances, packets, missing, rejected = Random(seed), list[Packet](), Counter[Site](), Counter[Any]()
    walk = insoles(WALK).packets
    run = dict.fromkeys((LEFT, RIGHT), 0)
    for k, packet in enumerate(walk):
        chance = chances.random()
        if packet.channel != "insole/frame" or not 200 < k < len(walk) - 200:
            packets.append(packet)
        elif run[packet.site] > 0 or chance < 0.06:
            run[packet.site] = chances.choice((0, 0, 0, 0, 0, 1, 6)) if run[packet.site] == 0 else run[packet.site] - 1
            missing[packet.site] += 1
        elif chance < 0.08:
            packets.append(evolve(packet, data=packet.data[:-3]))
            missing[packet.site] += 1
            rejected[packet.site, "truncated"] += 1
        else:
            packets += [packet] * (1 + (chance < 0.12))
            rejected[packet.site, "duplicate"] += chance < 0.12
    return packets, missing, rejected


def totals(events: list[Any]) -> tuple[Any, ...]:
    """Return the samples lost, gaps and longest gap of each site, and the rejections of each site and reason."""
    lost, gaps, longest, rejected = Counter[Site](), Counter[Site](), Counter[Site](), Counter[Any]()
    for gap in of(SampleGap, events):
        lost[gap.site] += gap.count
        gaps[gap.site] += gap.gaps
        longest[gap.site] = max(longest[gap.site], gap.longest)
    for one in of(PacketRejected, events):
        rejected[one.site, one.reason.value] += one.count
    return lost, gaps, longest, rejected


@pytest.mark.parametrize("seed", [1, *soaked(2, 3, 4)])
def test_told_together_or_each_by_itself_the_same_is_lost_and_rejected(seed: int) -> None:
    packets, missing, rejected = spoilt(seed)
    each, together = run_session(packets, losses=True), run_session(packets)
    assert all(event.count == 1 for event in of(PacketRejected, each))
    assert 4 * len(of(Troubles, together)) < len(of(Troubles, each)) > 150
    assert totals(together) == totals(each)
    times = [fsum(gap.duration for gap in of(SampleGap, events)) for events in (together, each)]
    assert times[0] == pytest.approx(times[1], rel=1e-9)
    assert totals(together)[0] == missing and totals(together)[3] == rejected
    others = [[event for event in events if not isinstance(event, Troubles)] for events in (each, together)]
    assert others[0] == others[1]
    assert all(gap in together for gap in of(SampleGap, each) if gap.duration > 0.07), "a long gap is told as it is"


def test_what_is_told_together_does_not_depend_on_cuts_or_on_a_restart() -> None:
    packets, _, _ = spoilt(1)
    session, events, cuts = Session(), list[Any](), Random(1)
    for k, piece in enumerate(pieces(tuple(packets), [cuts.randint(1, 90) for _ in range(50)])):
        events += session.feed(piece)
        if k % 10 == 3:
            session = Session.restore(json.loads(json.dumps(session.snapshot())))
        elif k % 2:
            session = Session.unpack(session.pack())
    assert events + session.finish() == run_session(packets)


def test_the_first_gap_is_told_at_once_and_again_after_a_calm_time() -> None:
    packets = without(insoles(STANDING).packets, 1.0, 2.0, 3.0, 3.1, 25.0)
    told = of(SampleGap, Session().feed(packets))
    assert [gap.gaps for gap in told] == [1, 3, 1]
    assert [gap.known_at - gap.t for gap in told] == pytest.approx([2 * PERIOD, 9.0, 2 * PERIOD], abs=0.1)
    assert [gap.duration for gap in told] == pytest.approx([2 * PERIOD, 6 * PERIOD, 2 * PERIOD], abs=0.005)
    assert told[1].longest == pytest.approx(2 * PERIOD, abs=0.005) and told[1].count == 3


ENDS = {"silence": StreamStale, "disconnection": Disconnected, "another clock": ClockReset, "the end": None}


@pytest.mark.parametrize("name", ENDS)
def test_before_a_connection_ends_all_that_was_lost_is_told(name: str) -> None:
    session, packets = Session(), without(insoles(STANDING).packets, 1.0, 2.0, 2.5)
    before = session.feed([packet for packet in packets if packet.t < 3.0])
    assert sum(gap.gaps for gap in of(SampleGap, before)) == 1
    after = {
        "silence": lambda: session.advance(9.0),
        "disconnection": lambda: session.feed(Packet(3.0, LEFT, "receiver/disconnected", b"")),
        "another clock": lambda: session.restart_clock(0.0),
        "the end": session.finish,
    }[name]()
    (gap,) = of(SampleGap, after)
    end = ENDS[name]
    assert gap.gaps == 2 and gap.t == pytest.approx(2.0, abs=0.05)
    ends = [] if end is None else [k for k, event in enumerate(after) if isinstance(event, end) and event.site is LEFT]
    assert (end is None or len(ends) == 1) and all(after.index(gap) < k for k in ends)
    assert sum(gap.gaps for gap in of(SampleGap, session.finish())) == 0, "it is told once"


@pytest.mark.parametrize("name", ENDS)
def test_what_is_told_together_was_known_when_it_was_told(name: str) -> None:
    packets, told = spoilt(1)[0], list[Any]()
    session, cut = Session(), 21.0
    told += session.feed([packet for packet in packets if packet.t < cut])
    if name == "silence":
        told += session.advance(cut + 0.5) + session.advance(cut + 3.0)
    elif name == "disconnection":
        told += session.feed(Packet(cut + 0.3, LEFT, "receiver/disconnected", b""))
    elif name == "another clock":
        told += session.restart_clock(cut + 0.2)
    told += session.feed([evolve(packet, t=packet.t + 4.0) for packet in packets if packet.t >= cut])
    told += session.advance(session.now + 0.5) + session.finish()
    for site in (LEFT, RIGHT):
        times = [event.known_at for event in told if isinstance(event, LinkEvent) and event.site is site]
        assert len(times) > 10 and times == sorted(times)
    assert max(event.known_at for event in of(Troubles, told)) == session.now, "what was held is told at the end"


def test_an_absence_and_a_gap_that_spoils_a_stride_are_told_at_once_after_what_was_held() -> None:
    packets = without(insoles(STANDING).packets, 1.0, 2.0, *[4.0 + PERIOD * k for k in range(6)])
    told = of(SampleGap, Session().feed([packet for packet in packets if packet.t < 6.0]))
    assert [(gap.gaps, gap.count) for gap in told] == [(1, 1), (1, 1), (1, 6)]
    assert told[1].known_at == told[2].known_at < 4.3


def test_samples_in_the_wrong_unit_are_named_once_in_ten_seconds_and_all_are_counted() -> None:
    session, told = Session(), list[Any]()
    session.feed(Sample(t=-0.01, site=LEFT, acc=(0.0, 0.0, 9.81), gyro=(0.0, 0.0, 0.0)))
    for k in range(2500):
        told += session.feed(Sample(t=k * 0.01, site=LEFT, acc=(0.0, 0.0, 9810.0), gyro=(0.0, 0.0, 0.0)))
    assert len(of(SampleRejected, told)) == 3
    assert sum(event.count for event in of(SampleRejected, told + session.finish())) == 2500


@pytest.mark.parametrize("t", [10**400, Decimal("1.5"), np.float64(1.5), True])
def test_times_that_are_no_floats_are_times_also_while_something_is_held(t: Any) -> None:
    session = Session()
    for _ in range(3):
        session.feed(Packet(0.0, LEFT, "insole/nothing", b""))
    told = session.feed(Packet(t, LEFT, "device/battery", b"\x20"))
    told += session.feed(Sample(t=t, site=RIGHT, acc=(0.0, 0.0, 9.8), gyro=(0.0, 0.0, 0.0)))
    told += session.feed(Sample(t=2.0, known_at=None, site=RIGHT, acc=(0.0, 0.0, 9.8), gyro=(0.0, 0.0, 0.0)))
    is_absurd = type(t) is int
    assert [type(event) for event in told if isinstance(event, Troubles)] == [
        PacketRejected,
        SampleRejected,
    ] * is_absurd
    assert len(of(BatteryLevel, told)) == (not is_absurd)


def test_channels_without_end_are_told_one_by_one_and_nothing_of_them_is_kept() -> None:
    session = Session()
    session.feed(insoles(STANDING).packets[:200])
    size = len(session.pack())
    channels = [*[f"insole/{k}" for k in range(500)], "insole/\ud83d", "x" * 5000, *["toaster/crumbs"] * 100]
    told = [event for channel in channels for event in session.feed(Packet(5.0, LEFT, channel, b""))]
    assert len(session.pack()) < size + 5000 and Session.restore(session.snapshot()).pack() == session.pack()
    assert sum(event.count for event in of(PacketRejected, told + session.finish())) == len(channels)


def test_an_app_asks_how_good_each_link_is() -> None:
    session = Session()
    assert session.links == {}
    packets = [packet for packet in insoles(STANDING).packets if packet.t < 20.0]
    frames = frames_of(tuple(packets), LEFT)
    lost = [frame for k, frame in enumerate(frames) if k % 5 == 0 and k > 10]
    damaged = [frame for k, frame in enumerate(frames) if k % 10 == 1 and k > 10]
    for packet in packets:
        if packet not in lost:
            session.feed(evolve(packet, data=packet.data[:-1]) if packet in damaged else packet)
    left, right = session.links[LEFT], session.links[RIGHT]
    assert left.missing == pytest.approx(0.3, abs=0.02) and left.rejected == pytest.approx(1 / 8, abs=0.02)
    assert (right.missing, right.rejected) == (0.0, 0.0)
    assert right.last_arrival == frames_of(tuple(packets), RIGHT)[-1].t
    assert Session.restore(session.snapshot()).links == session.links
    session.advance(35.0)
    assert session.links[LEFT].missing is None and session.links[LEFT].last_arrival == left.last_arrival
